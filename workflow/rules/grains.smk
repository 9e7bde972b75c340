# Growth: one job a block of seeds of one material, type and size.


rule grow:
    output:
        "<results>/grains/{material}/{type}/{size}nm/seeds_{seeds}.nc",
    log:
        "<results>/logs/grains/{material}/{type}/{size}nm/seeds_{seeds}.log",
    benchmark:
        "<results>/benchmarks/grains/{material}/{type}/{size}nm/seeds_{seeds}.tsv"
    # the largest grains take longest: they are begun first
    priority: lambda w: float(w.size)
    conda:
        "../envs/ratd.yaml"
    threads: 1
    resources:
        mem_mb=1000,
        runtime=120,
    params:
        code=CODE["grow"],
        settings=lambda w: PLAN.grow(w.material, w.type, w.size),
    message:
        "Grow {wildcards.material} {wildcards.type} {wildcards.size} nm, seeds {wildcards.seeds}"
    script:
        "../scripts/grow.py"


rule grains:
    input:
        PLAN.files("<results>/grains/{material}/{type}/{size}nm/seeds_{seeds}.nc"),
