# Spin-up: one job a block of grains.


rule spin_up:
    input:
        "<results>/grains/{material}/{type}/{size}nm/seeds_{seeds}.nc",
    output:
        "<results>/spinup/{drive}/{material}/{type}/{size}nm/seeds_{seeds}.nc",
    log:
        "<results>/logs/spinup/{drive}/{material}/{type}/{size}nm/seeds_{seeds}.log",
    benchmark:
        "<results>/benchmarks/spinup/{drive}/{material}/{type}/{size}nm/seeds_{seeds}.tsv"
    priority: lambda w: float(w.size)
    conda:
        "../envs/ratd.yaml"
    threads: 1
    resources:
        mem_mb=1500,
        runtime=10080,
    params:
        code=CODE["spin_up"],
        settings=lambda w: PLAN.spin_up(w.drive, w.material, w.type, w.size, w.seeds),
    message:
        "Spin up {wildcards.material} {wildcards.type} {wildcards.size} nm, seeds {wildcards.seeds} ({wildcards.drive})"
    script:
        "../scripts/spin_up.py"


rule spinups:
    input:
        [
            f"<results>/spinup/{drive}/{material}/{type}/{size}nm/seeds_{seeds}.nc"
            for drive in PLAN.config["drives"]
            for material, type, size in PLAN.cells
            for seeds in PLAN.blocks
        ],
