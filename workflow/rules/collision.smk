# Collisions: clusters built, brought to rest, shot at each other; tables and figures.
from ratd.experiments.collision import plan as collision

CELL = {
    name: COLLISIONS.pattern(name)
    for name in ("law", "cluster", "sample", "velocity", "impact")
}
COLLISION_TABLES = {
    "collision_table": "Collisions",
    "collision_thresholds": "Collisions: fragmentation velocities",
    "collision_clusters": "Collisions: clusters",
    "collision_likeness": "Collisions: equal spheres like the MRN law",
}


rule build_clusters:
    output:
        collision.BUILT,
    log:
        "<results>/logs/collision/built/{material}/{cluster}.log",
    benchmark:
        "<results>/benchmarks/collision/built/{material}/{cluster}.tsv"
    wildcard_constraints:
        material=COLLISIONS.pattern("material"),
        cluster=CELL["cluster"],
    conda:
        "../envs/ratd.yaml"
    params:
        task=task("run", "ratd.experiments.collision.stages:build", "built_clusters"),
        settings=lambda w: COLLISIONS.build(w.material, w.cluster),
    message:
        "Build clusters {wildcards.cluster} of {wildcards.material}"
    script:
        "../scripts/run.py"


rule relax_clusters:
    input:
        lambda w: collision.BUILT.format(
            material=COLLISIONS.material_of(w.law).name, cluster=w.cluster
        ),
    output:
        collision.RELAXED,
    log:
        "<results>/logs/collision/relaxed/{law}/{cluster}.log",
    benchmark:
        "<results>/benchmarks/collision/relaxed/{law}/{cluster}.tsv"
    wildcard_constraints:
        law=CELL["law"],
        cluster=CELL["cluster"],
    conda:
        "../envs/ratd.yaml"
    params:
        task=task("run", "ratd.experiments.collision.stages:relax", "built_clusters"),
        settings=lambda w: {"law": COLLISIONS.law(w.law)},
    message:
        "Bring clusters {wildcards.cluster} to rest, law {wildcards.law}"
    script:
        "../scripts/run.py"


rule collide:
    input:
        collision.RELAXED,
    output:
        collision.RUNS,
    log:
        "<results>/logs/collision/runs/{law}/{cluster}/sample_{sample}/{velocity}mps_b{impact}.log",
    benchmark:
        "<results>/benchmarks/collision/runs/{law}/{cluster}/sample_{sample}/{velocity}mps_b{impact}.tsv"
    wildcard_constraints:
        **CELL,
    # the longest first
    priority: lambda w: COLLISIONS.work(w)
    conda:
        "../envs/ratd.yaml"
    resources:
        runtime=10080,
    params:
        task=task("run", "ratd.experiments.collision.stages:collide_all", "collisions"),
        settings=lambda w: COLLISIONS.collide(w),
    message:
        "Collide {wildcards.cluster} at {wildcards.velocity} m/s, law {wildcards.law}, sample {wildcards.sample}"
    script:
        "../scripts/run.py"


rule collision_tables:
    input:
        runs=COLLISIONS.run_files(collision.RUNS),
        clusters=COLLISIONS.clusters_files(collision.RELAXED),
    output:
        **{name: f"<results>/collision/tables/{name}.nc" for name in COLLISION_TABLES},
        **{
            f"{name}_csv": report(
                f"<results>/collision/tables/{name}.csv",
                caption="../report/collision_tables.rst",
                category="Tables",
                labels={"table": COLLISION_TABLES[name]},
            )
            for name in COLLISION_TABLES
        },
    log:
        "<results>/logs/collision/tables.log",
    benchmark:
        "<results>/benchmarks/collision/tables.tsv"
    conda:
        "../envs/ratd.yaml"
    resources:
        mem_mb=3000,
        runtime=60,
    params:
        task=task(
            "analyse", "ratd.experiments.collision.tables:analyse", *COLLISION_TABLES
        ),
        settings=COLLISIONS.analysis,
    message:
        "Tabulate the collisions"
    script:
        "../scripts/analyse.py"


for name in COLLISIONS.figures:

    rule:
        name:
            f"collision_{name}"
        input:
            **COLLISIONS.figure_input(name),
        output:
            **{
                form: report(
                    f"<results>/collision/figures/{name}.{form}",
                    caption=f"../report/collision_{name}.rst",
                    category="Collision",
                    labels=figure_labels(name, collision.TITLES[name], form),
                )
                for form in ("pdf", "png")
            },
        log:
            f"<results>/logs/collision/figures/{name}.log",
        benchmark:
            f"<results>/benchmarks/collision/figures/{name}.tsv"
        conda:
            "../envs/ratd.yaml"
        params:
            task=task(
                "figure",
                f"ratd.experiments.collision.figures.{COLLISIONS.figure_module(name)}:draw",
            ),
            settings=COLLISIONS.figure(name),
        message:
            f"Draw {name} of the collisions"
        script:
            "../scripts/figure.py"


rule collision_page:
    input:
        runs=COLLISIONS.figure_input("page")["runs"],
    output:
        page=report(
            "<results>/collision/figures/collision.html",
            caption="../report/collision_page.rst",
            category="Interactive",
            labels={"page": "one collision", "drive": "none"},
        ),
    log:
        "<results>/logs/collision/figures/collision.log",
    benchmark:
        "<results>/benchmarks/collision/figures/collision.tsv"
    conda:
        "../envs/ratd.yaml"
    params:
        task=task("analyse", "ratd.experiments.collision.figures.page:page"),
        settings=COLLISIONS.figure("page"),
    message:
        "Make the page of one collision"
    script:
        "../scripts/analyse.py"


rule collision:
    input:
        "<results>/config.yaml",
        rules.collision_tables.output,
        expand(
            "<results>/collision/figures/{figure}.{form}",
            figure=COLLISIONS.figures,
            form=["pdf", "png"],
        ),
        ["<results>/collision/figures/collision.html"] if COLLISIONS.pictures else [],
