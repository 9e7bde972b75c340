# Spin-up on a GPU: one job all grains of one material and type, the same files as those of spinup.smk.

SPINUPS = expand(
    "{{material}}/{{type}}/{size}nm/seeds_{seeds}.nc",
    size=PLAN.sizes,
    seeds=PLAN.blocks,
)


rule spin_up_cuda:
    input:
        [f"<results>/grains/{path}" for path in SPINUPS],
    output:
        [f"<results>/spinup/{{drive}}/{path}" for path in SPINUPS],
    log:
        "<results>/logs/spinup/{drive}/{material}/{type}.log",
    benchmark:
        "<results>/benchmarks/spinup/{drive}/{material}/{type}.tsv"
    conda:
        "../envs/ratd_gpu.yaml"
    threads: 1
    resources:
        gpu=1,
        mem_mb=8000,
        runtime=1440,
    params:
        code=CODE["spin_up_cuda"],
        settings=lambda w: [
            PLAN.spin_up(w.drive, w.material, w.type, size, seeds)
            for size in PLAN.sizes
            for seeds in PLAN.blocks
        ],
    message:
        "Spin up {wildcards.material} {wildcards.type}, all sizes and seeds, on the GPU ({wildcards.drive})"
    script:
        "../scripts/spin_up_cuda.py"


rule spinups:
    input:
        [
            f"<results>/spinup/{drive}/{material}/{type}/{size}nm/seeds_{seeds}.nc"
            for drive in PLAN.config["drives"]
            for material, type, size in PLAN.cells
            for seeds in PLAN.blocks
        ],
