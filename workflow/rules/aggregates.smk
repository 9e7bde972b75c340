# Aggregates: one job a block of seeds of one material, type and size.
from ratd.experiments.spin_up.plan import GRAINS

NAMES = {
    "drive": PLAN.pattern("drives"),
    "material": PLAN.pattern("materials"),
    "type": PLAN.pattern("types"),
    "size": PLAN.pattern("sizes"),
    "seeds": PLAN.pattern("blocks"),
}


rule grow:
    output:
        GRAINS,
    log:
        "<results>/logs/grains/{material}/{type}/{size}nm/seeds_{seeds}.log",
    benchmark:
        "<results>/benchmarks/grains/{material}/{type}/{size}nm/seeds_{seeds}.tsv"
    wildcard_constraints:
        **NAMES,
    # the largest grains take longest: they are begun first
    priority: lambda w: float(w.size)
    conda:
        "../envs/ratd.yaml"
    resources:
        mem_mb=1000,
        runtime=120,
    params:
        task=task("run", "ratd.experiments.spin_up.grow:block", "grains"),
        settings=lambda w: PLAN.grow(w.material, w.type, w.size),
    message:
        "Grow {wildcards.material} {wildcards.type} {wildcards.size} nm, seeds {wildcards.seeds}"
    script:
        "../scripts/run.py"


rule grains:
    input:
        PLAN.files(GRAINS),
