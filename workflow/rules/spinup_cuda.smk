# Spin-up on a GPU: one job all grains of one material and type, the same files as those of spinup.smk.

for drive in PLAN.config["drives"]:
    for material in PLAN.config["materials"]:
        for kind in PLAN.config["types"]:
            # size and block of seeds of this drive, and the block of grown grains that it is in
            wanted = [
                (cell[2], block, PLAN.grown_block(cell, block))
                for cell in PLAN.cells_of(drive)
                if cell[:2] == (material, kind)
                for block in PLAN.blocks(cell, drive)
            ]
            if not wanted:
                continue

            rule:
                name:
                    f"spin_up_cuda_{drive}_{material}_{kind}"
                input:
                    [
                        f"<results>/grains/{material}/{kind}/{size}nm/seeds_{grown}.nc"
                        for size, _, grown in wanted
                    ],
                output:
                    [
                        f"<results>/spinup/{drive}/{material}/{kind}/{size}nm/seeds_{seeds}.nc"
                        for size, seeds, _ in wanted
                    ],
                log:
                    f"<results>/logs/spinup/{drive}/{material}/{kind}.log",
                benchmark:
                    f"<results>/benchmarks/spinup/{drive}/{material}/{kind}.tsv"
                conda:
                    "../envs/ratd_gpu.yaml"
                threads: 1
                resources:
                    gpu=1,
                    mem_mb=8000,
                    runtime=1440,
                params:
                    code=CODE["spin_up_cuda"],
                    script="spin_up_cuda",
                    settings=[
                        PLAN.spin_up(drive, material, kind, size, seeds)
                        for size, seeds, _ in wanted
                    ],
                message:
                    f"Spin up {material} {kind}, all sizes and seeds, on the GPU ({drive})"
                script:
                    "../scripts/spin_up_cuda.py"


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
