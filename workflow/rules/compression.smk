# Static compression: clusters, runs, tables of runs that differ in their seeds alone, pulls, figures.
from ratd.experiments.compression import plan as compression

COMPRESSION_NAMES = {
    "set": any_of(COMPRESSION.config["sets"]),
    "pull": any_of(COMPRESSION.config["pulls"]),
    "seed": r"\d+",
    "phi": r"[\d.]+",
}


rule grow_cluster:
    output:
        compression.CLUSTER,
    log:
        "<results>/logs/clusters/{set}/seed_{seed}.log",
    benchmark:
        "<results>/benchmarks/clusters/{set}/seed_{seed}.tsv"
    wildcard_constraints:
        **COMPRESSION_NAMES,
    conda:
        "../envs/ratd.yaml"
    params:
        task=task("run", "ratd.experiments.compression.grow:cluster", "clusters"),
        settings=lambda w: COMPRESSION.grow(w.set),
    message:
        "Grow cluster {wildcards.seed} of the set {wildcards.set}"
    script:
        "../scripts/run.py"


rule compress:
    input:
        compression.CLUSTER,
    output:
        compression.RUN,
    log:
        "<results>/logs/compression/{set}/seed_{seed}.log",
    benchmark:
        "<results>/benchmarks/compression/{set}/seed_{seed}.tsv"
    wildcard_constraints:
        **COMPRESSION_NAMES,
    # the longest runs are begun first
    priority: lambda w: COMPRESSION.work(w.set)
    conda:
        "../envs/ratd.yaml"
    resources:
        runtime=10080,
    params:
        task=task("run", "ratd.experiments.compression.squeeze:run", "compression"),
        settings=lambda w: COMPRESSION.compress(w.set),
    message:
        "Compress cluster {wildcards.seed} of the set {wildcards.set}"
    script:
        "../scripts/run.py"


rule compression_set:
    input:
        clusters=lambda w: COMPRESSION.files(compression.CLUSTER, w.set),
        runs=lambda w: COMPRESSION.files(compression.RUN, w.set),
    output:
        compression_set=compression.TABLE,
    log:
        "<results>/logs/compression/{set}.log",
    benchmark:
        "<results>/benchmarks/compression/{set}.tsv"
    wildcard_constraints:
        **COMPRESSION_NAMES,
    priority: 10000
    conda:
        "../envs/ratd.yaml"
    params:
        task=task(
            "analyse",
            "ratd.experiments.compression.tables:run_set",
            "compression_set",
        ),
        settings=lambda w: COMPRESSION.grow(w.set),
    message:
        "Tabulate the set {wildcards.set}"
    script:
        "../scripts/analyse.py"


rule compression_snapshots:
    input:
        run=lambda w: COMPRESSION.snapshots()[0],
    output:
        compression_snapshots=compression.SNAPSHOTS,
    log:
        "<results>/logs/compression/snapshots.log",
    benchmark:
        "<results>/benchmarks/compression/snapshots.tsv"
    conda:
        "../envs/ratd.yaml"
    params:
        task=task(
            "analyse",
            "ratd.experiments.compression.tables:snapshots",
            "compression_snapshots",
        ),
        settings=lambda w: COMPRESSION.snapshots()[1],
    message:
        "Take out the snapshots of figure 3"
    script:
        "../scripts/analyse.py"


rule press:
    input:
        compression.CLUSTER,
    output:
        pressed=compression.PRESSED,
    log:
        "<results>/logs/pressed/{set}/phi_{phi}_seed_{seed}.log",
    benchmark:
        "<results>/benchmarks/pressed/{set}/phi_{phi}_seed_{seed}.tsv"
    wildcard_constraints:
        **COMPRESSION_NAMES,
    conda:
        "../envs/ratd.yaml"
    resources:
        runtime=1440,
    params:
        task=task("run", "ratd.experiments.compression.pull:press", "pressed"),
        settings=lambda w: COMPRESSION.press(w.set),
    message:
        "Compress cluster {wildcards.seed} of the set {wildcards.set} to phi = {wildcards.phi}"
    script:
        "../scripts/run.py"


rule stretch:
    input:
        lambda w: compression.PRESSED.format(
            set=COMPRESSION.config["pulls"][w.pull]["set"], phi=w.phi, seed=w.seed
        ),
    output:
        tension_set=compression.PULL,
    log:
        "<results>/logs/tension/{pull}/phi_{phi}_seed_{seed}.log",
    benchmark:
        "<results>/benchmarks/tension/{pull}/phi_{phi}_seed_{seed}.tsv"
    wildcard_constraints:
        **COMPRESSION_NAMES,
    conda:
        "../envs/ratd.yaml"
    resources:
        runtime=1440,
    params:
        task=task("run", "ratd.experiments.compression.pull:run", "tension_set"),
        settings=lambda w: COMPRESSION.stretch(w.pull),
    message:
        "Pull cluster {wildcards.seed} at phi = {wildcards.phi} ({wildcards.pull})"
    script:
        "../scripts/run.py"


for name in compression.FIGURES:

    rule:
        name:
            f"compression_{name}"
        input:
            unpack(lambda w, name=name: COMPRESSION.figure_input(name)),
        output:
            **{
                form: report(
                    f"<results>/figures/compression_{name}.{form}",
                    caption="../report/compression.rst",
                    category="Compression",
                    labels=figure_labels(name, compression.TITLES[name], form),
                )
                for form in ("pdf", "png")
            },
        log:
            f"<results>/logs/figures/compression_{name}.log",
        benchmark:
            f"<results>/benchmarks/figures/compression_{name}.tsv"
        conda:
            "../envs/ratd.yaml"
        params:
            task=task("figure", f"ratd.experiments.compression.figures.{name}:draw"),
            settings={},
        message:
            f"Draw the {name} of the compression"
        script:
            "../scripts/figure.py"


rule compression_page:
    input:
        run=lambda w: COMPRESSION.snapshots()[0],
    output:
        page=report(
            "<results>/figures/compression.html",
            caption="../report/compression_page.rst",
            category="Interactive",
            labels={"page": "one compression", "drive": "none"},
        ),
    log:
        "<results>/logs/figures/compression_page.log",
    benchmark:
        "<results>/benchmarks/figures/compression_page.tsv"
    conda:
        "../envs/ratd.yaml"
    params:
        task=task("analyse", "ratd.experiments.compression.figures.page:page"),
        settings={},
    message:
        "Make the page of one compression"
    script:
        "../scripts/analyse.py"


rule compression_tables:
    input:
        COMPRESSION.tables,


rule compression:
    input:
        "<results>/config.yaml",
        expand(
            "<results>/figures/compression_{figure}.{form}",
            figure=COMPRESSION.figures,
            form=["pdf", "png"],
        ),
        ["<results>/figures/compression.html"]
        if "figure3" in COMPRESSION.figures
        else [],
