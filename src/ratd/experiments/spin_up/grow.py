"""Blocks of grains that are grown for the spin-up: the stage `grow` of the pipeline."""

from ratd.aggregates.files import grain_row
from ratd.aggregates.growth import grow
from ratd.aggregates.radii import RadiusDistribution
from ratd.base.materials import Material
from ratd.experiments.spin_up.cut_bound import cut_bound
from ratd.pipeline.places import seeds_of

__all__ = ["block", "grown"]


def grown(settings, seed):
    """The grain of a seed, as the ensemble has it.

    Parameters
    ----------
    settings : dict
        material, type, a_eff, radii, migration.
    seed : int

    Returns
    -------
    ratd.Grain
    """
    return grow(
        settings["type"],
        settings["a_eff"],
        Material(**settings["material"]),
        seed,
        distribution=RadiusDistribution(**settings["radii"]),
        migration=settings["migration"],
    )


def block(job):
    """Grow the grains of one block, one after another.

    Parameters
    ----------
    job : ratd.pipeline.jobs.Job
    """

    def make(seed, checkpoint):
        grain = grown(job.settings, seed)
        return grain_row(grain, cut_bound(grain))

    material = Material(**job.settings["material"])
    job.block(job.output[0], "grains", material, seeds_of(job.wildcards.seeds), make)
