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


# A study for docs/reproduction.md: what the contacts of all grown grains hold at most.
rule firm_bounds:
    input:
        lambda w: [
            path
            for path in PLAN.all_files(
                "<results>/grains/{material}/{type}/{size}nm/seeds_{seeds}.nc"
            )
            if f"/{w.material}/{w.type}/" in path
        ],
    output:
        "<results>/firm_bounds/{material}/{type}.nc",
    log:
        "<results>/logs/firm_bounds/{material}/{type}.log",
    benchmark:
        "<results>/benchmarks/firm_bounds/{material}/{type}.tsv"
    conda:
        "../envs/ratd.yaml"
    threads: 1
    resources:
        mem_mb=1000,
        runtime=60,
    params:
        code=CODE["firm_bounds"],
        settings={},
    message:
        "Bounds of {wildcards.material} {wildcards.type} from what contacts hold pulled, sideways and pushed"
    script:
        "../scripts/firm_bounds.py"


rule grains:
    input:
        PLAN.files("<results>/grains/{material}/{type}/{size}nm/seeds_{seeds}.nc"),
