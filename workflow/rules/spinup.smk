# Spin-up: one job a block of grains.


rule spin_up:
    input:
        # a drive may want fewer seeds than are grown
        lambda w: PLAN.file(
            "<results>/grains/{material}/{type}/{size}nm/seeds_{seeds}.nc",
            (w.material, w.type, w.size),
            seeds=PLAN.grown_block((w.material, w.type, w.size), w.seeds),
        ),
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
            path
            for drive in PLAN.config["drives"]
            for path in PLAN.files(
                f"<results>/spinup/{drive}/{{material}}/{{type}}/{{size}}nm/seeds_{{seeds}}.nc",
                drive,
            )
        ],
