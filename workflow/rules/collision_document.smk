# docs/collision.md and its appendix from the collisions that are committed with them: seconds, nothing is computed.
from ratd.experiments.collision import document_plan as page

PAGE_TABLES = [name for name in COLLISION_TABLES if name != "collision_clusters"]


rule study_tables:
    input:
        runs=page.run_files(),
    output:
        **{name: page.TABLES.format(name=name) for name in PAGE_TABLES},
        **{f"{name}_csv": f"results/collision_study/{name}.csv" for name in PAGE_TABLES},
    log:
        "results/collision_study/logs/tables.log",
    benchmark:
        "results/collision_study/benchmarks/tables.tsv"
    conda:
        "../envs/ratd.yaml"
    params:
        task=task("analyse", "ratd.experiments.collision.tables:findings", *PAGE_TABLES),
        settings={"bootstrap": 2000},
    message:
        "Tabulate the collisions of the document"
    script:
        "../scripts/analyse.py"


rule study_samples:
    output:
        page.SAMPLES,
    log:
        "results/collision_study/logs/samples.log",
    benchmark:
        "results/collision_study/benchmarks/samples.tsv"
    conda:
        "../envs/ratd.yaml"
    params:
        task=task("run", "ratd.experiments.collision.stages:build", "built_clusters"),
        settings=lambda w: page.samples_settings(),
    message:
        "Build the MRN clusters of the document"
    script:
        "../scripts/run.py"


for name in page.FIGURES:

    rule:
        name:
            f"study_{name}"
        input:
            **page.figure_input(name),
        output:
            png=f"docs/collision/{name}.png",
        log:
            f"results/collision_study/logs/{name}.log",
        benchmark:
            f"results/collision_study/benchmarks/{name}.tsv"
        conda:
            "../envs/ratd.yaml"
        params:
            task=task(
                "figure",
                f"ratd.experiments.collision.figures.{page.figure_module(name)}:draw",
            ),
            settings=page.figure_settings(name),
        message:
            f"Draw {name} of the document on collisions"
        script:
            "../scripts/figure.py"


rule study_page:
    input:
        **page.figure_input("figure4"),
    output:
        page=page.PAGE,
    log:
        "results/collision_study/logs/page.log",
    benchmark:
        "results/collision_study/benchmarks/page.tsv"
    conda:
        "../envs/ratd.yaml"
    params:
        task=task("analyse", "ratd.experiments.collision.figures.page:page"),
        settings={"rotation": page.figure_settings("figure4")["rotation"]},
    message:
        "Make the page of a collision of the document"
    script:
        "../scripts/analyse.py"


rule collision_document:
    input:
        page.PAGE,
        [f"docs/collision/{name}.png" for name in page.FIGURES],
        table=page.TABLES.format(name="collision_table"),
        thresholds=page.TABLES.format(name="collision_thresholds"),
        likeness=page.TABLES.format(name="collision_likeness"),
        document_template="docs/templates/collision.md",
        appendix_template="docs/templates/collision_appendix.md",
    output:
        document="docs/collision.md",
        appendix="docs/collision_appendix.md",
    log:
        "results/collision_study/logs/document.log",
    benchmark:
        "results/collision_study/benchmarks/document.tsv"
    conda:
        "../envs/ratd.yaml"
    params:
        task=task("analyse", "ratd.experiments.collision.document:document"),
        settings={},
    message:
        "Write docs/collision.md and its appendix"
    script:
        "../scripts/analyse.py"
