# Disruption: one file a material, type and size, with all seeds.


rule disrupt:
    input:
        lambda w: [
            f"<results>/spinup/{w.drive}/{w.material}/{w.type}/{w.size}nm/seeds_{seeds}.nc"
            for seeds in PLAN.blocks((w.material, w.type, w.size), w.drive)
        ],
    output:
        "<results>/disruption/{drive}/{material}/{type}/{size}nm.nc",
    log:
        "<results>/logs/disruption/{drive}/{material}/{type}/{size}nm.log",
    benchmark:
        "<results>/benchmarks/disruption/{drive}/{material}/{type}/{size}nm.tsv"
    # a matter of seconds, and a result
    priority: 10000
    conda:
        "../envs/ratd.yaml"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=30,
    params:
        code=CODE["disrupt"],
        settings={},
    message:
        "Find where {wildcards.material} {wildcards.type} {wildcards.size} nm is disrupted ({wildcards.drive})"
    script:
        "../scripts/disrupt.py"


rule disruptions:
    input:
        [
            f"<results>/disruption/{drive}/{material}/{type}/{size}nm.nc"
            for drive in PLAN.config["drives"]
            for material, type, size in PLAN.cells_of(drive)
        ],
