"""Grow the grains of one block."""

from ratd.aggregates.growth import grow
from ratd.aggregates.radii import RadiusDistribution
from ratd.base.materials import Material
from ratd.experiments.spin_up.cut_bound import cut_bound
from ratd.pipeline import io
from ratd.pipeline.jobs import Job

with Job(snakemake) as job:
    material = Material(**job.settings["material"])
    radii = RadiusDistribution(**job.settings["radii"])
    first, last = (int(seed) for seed in snakemake.wildcards.seeds.split("-"))

    def make(seed, checkpoint):
        grain = grow(
            job.settings["type"],
            job.settings["a_eff"],
            material,
            seed,
            distribution=radii,
            migration=job.settings["migration"],
        )
        return io.grain_row(grain, cut_bound(grain))

    job.block(snakemake.output[0], "grains", material, range(first, last + 1), make)
