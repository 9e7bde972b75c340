"""Spin up the grains of one block."""

from ratd.experiments.spin_up.run import spin_up
from ratd.pipeline import io
from ratd.pipeline.jobs import Job

with Job(snakemake) as job:
    file = io.read(snakemake.input[0], "grains")
    grains = {grain.seed: grain for grain in io.grains(file)}
    settings = job.settings

    def make(seed, checkpoint):
        run = spin_up(
            grains[seed],
            drive=settings["drive"],
            epsilon=settings["epsilon"],
            angular_acceleration=settings["angular_acceleration"],
            timestep_factor=settings["timestep_factor"],
            max_steps=settings["max_steps"],
            records=settings["records"],
            snapshot_every=settings["snapshot_every"] if seed in settings["snapshot_seeds"] else 0,
            checkpoint=checkpoint,
            progress=job.progress(seed),
        )
        return io.run_row(run)

    job.block(snakemake.output[0], "spinup", io.material_of(file), list(grains), make)
