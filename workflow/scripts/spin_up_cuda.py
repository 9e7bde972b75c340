"""Spin up all grains of one material and type on a GPU."""

from pathlib import Path

from ratd import io
from ratd.cuda.spin_up import spin_up_many
from ratd.jobs import Job, seeds_of
from ratd.partial import Block

with Job(snakemake) as job:
    blocks, grains, settings = [], {}, {}
    for path, target, own in zip(snakemake.input, snakemake.output, job.settings, strict=True):
        file = io.read(path, "grains")
        wanted = seeds_of(Path(target).stem.removeprefix("seeds_"))
        found = {grain.seed: grain for grain in io.grains(file) if grain.seed in wanted}
        blocks.append(Block(Path(target), io.material_of(file), list(found), job.provenance_of(own, [path])))
        grains[target], settings[target] = found, own

    def make(waiting, done):
        places = [(str(block.target), seed) for block, seed in waiting]
        common = job.settings[0]
        spin_up_many(
            [grains[target][seed] for target, seed in places],
            checkpoints=[block.checkpoint(seed) for block, seed in waiting],
            progress=[job.progress(seed, f"{block.target.parent.name} ") for block, seed in waiting],
            done=lambda number, run: done(number, io.run_row(run)),
            failed=lambda number, reason: done(number, failure=reason),
            snapshots=[k for k, (target, seed) in enumerate(places) if seed in settings[target]["snapshot_seeds"]],
            snapshot_every=max(own["snapshot_every"] for own in job.settings),
            **{name: common[name] for name in ("drive", "epsilon", "angular_acceleration")},
            **{name: common[name] for name in ("timestep_factor", "max_steps", "records")},
        )

    job.blocks(blocks, "spinup", make)
