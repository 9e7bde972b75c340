# The document, from the collisions that are committed with it: seconds, and no collision is computed.
STUDIED = sorted(map(str, Path("docs/collision/data").glob("*/*.nc")))
STUDY_RUNS = [path for path in STUDIED if "/pictures/" not in path]
STUDY_TABLES = "results/collision_study/{name}.nc"
STUDY_SETTINGS = {"law": "velocity", "mrn": "mrn100", "twin": "314nm"}
STUDY_FIGURES = {
    "figure3": ("snapshots", "figure3", {"rotation": 0, "spacing": 1.0e-7}),
    "figure4": ("snapshots", "figure4", {"rotation": 0, "spacing": 1.5e-7}),
    "figure5": ("figure5", "table", STUDY_SETTINGS),
    "figure6": ("figure6", "table", STUDY_SETTINGS),
    "figure7": ("figure7", "runs", STUDY_SETTINGS),
    "figure8": ("figure8", "table", STUDY_SETTINGS),
    "dissipation": ("dissipation", "table", STUDY_SETTINGS),
    "masses": ("masses", "runs", STUDY_SETTINGS),
    "scaling": ("scaling", "thresholds", {}),
    "question": ("question", "table", {"velocities": [15.0, 30.0]}),
}
STUDY_SAMPLES = ("figure1", "figure2")


def study_input(source):
    """Files that a figure of the document is drawn from."""
    if source in ("figure3", "figure4"):
        return {"runs": [f"docs/collision/data/pictures/{source}.nc"]}
    if source == "runs":
        return {"runs": STUDY_RUNS}
    return {source: STUDY_TABLES.format(name=f"collision_{source}")}


rule study_tables:
    input:
        runs=STUDY_RUNS,
    output:
        **{
            name: STUDY_TABLES.format(name=name)
            for name in COLLISION_TABLES
            if name != "collision_clusters"
        },
        **{
            f"{name}_csv": f"results/collision_study/{name}.csv"
            for name in COLLISION_TABLES
            if name != "collision_clusters"
        },
    log:
        "results/collision_study/logs/tables.log",
    benchmark:
        "results/collision_study/benchmarks/tables.tsv"
    conda:
        "../envs/ratd.yaml"
    params:
        task=task(
            "analyse",
            "ratd.experiments.collision.tables:findings",
            *(name for name in COLLISION_TABLES if name != "collision_clusters"),
        ),
        settings={"bootstrap": 2000},
    message:
        "Tabulate the collisions of the document"
    script:
        "../scripts/analyse.py"


rule study_samples:
    output:
        "results/collision_study/samples.nc",
    log:
        "results/collision_study/logs/samples.log",
    benchmark:
        "results/collision_study/benchmarks/samples.tsv"
    conda:
        "../envs/ratd.yaml"
    params:
        task=task("run", "ratd.experiments.collision.stages:build", "clusters"),
        settings=COLLISIONS.cluster(COLLISIONS.materials["silica"], "mrn")
        | {"samples": [1, 2, 3]},
    message:
        "Build the MRN clusters of the document"
    script:
        "../scripts/run.py"


for name in (*STUDY_FIGURES, *STUDY_SAMPLES):
    drawn_by, source, settings = STUDY_FIGURES.get(name, (name, "built", {}))
    files = (
        {"built": ["results/collision_study/samples.nc"]}
        if source == "built"
        else study_input(source)
    )

    rule:
        name:
            f"study_{name}"
        input:
            **files,
        output:
            png=f"docs/collision/{name}.png",
        log:
            f"results/collision_study/logs/{name}.log",
        benchmark:
            f"results/collision_study/benchmarks/{name}.tsv"
        conda:
            "../envs/ratd.yaml"
        params:
            task=task("figure", f"ratd.experiments.collision.figures.{drawn_by}:draw"),
            settings=settings,
        message:
            f"Draw {name} of the document on collisions"
        script:
            "../scripts/figure.py"


rule collision_document:
    input:
        [f"docs/collision/{name}.png" for name in (*STUDY_FIGURES, *STUDY_SAMPLES)],
        table=STUDY_TABLES.format(name="collision_table"),
        thresholds=STUDY_TABLES.format(name="collision_thresholds"),
        likeness=STUDY_TABLES.format(name="collision_likeness"),
        template="docs/collision/template.md",
    output:
        document="docs/collision.md",
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
        "Write docs/collision.md"
    script:
        "../scripts/analyse.py"
