"""Blocks of grains that are spun up: the stage `spin_up` of the pipeline, and its words of progress."""

from ratd.aggregates.files import grains
from ratd.experiments.spin_up.contact_law import contact_law
from ratd.experiments.spin_up.run import spin_up
from ratd.experiments.spin_up.run_files import run_row
from ratd.pipeline import io
from ratd.pipeline.blocks import material_of
from ratd.pipeline.jobs import duration

__all__ = ["arguments", "block", "told", "turn"]

_HOW = ("drive", "stretch", "epsilon", "angular_acceleration", "timestep_factor", "max_steps", "records")


def told(say):
    """Callback for `ratd.spin_up` that tells how far a run is.

    Parameters
    ----------
    say : callable
        From `ratd.pipeline.jobs.Job.progress`.

    Returns
    -------
    callable
        ``progress(omega, mass_fraction, seconds_to_go, steps)``.
    """

    def progress(omega, mass_fraction, seconds_to_go, steps):
        say(
            lambda: (
                f"omega {omega:.3g} rad/s, mass left {100 * mass_fraction:.0f} %, {duration(seconds_to_go)} to go, "
                f"{steps} steps"
            )
        )

    return progress


def arguments(settings):
    """What `turn` takes of the settings of a job: how to spin up, and ``law`` where one is named."""
    how = {name: settings[name] for name in _HOW}
    return how | {"law": settings["law"]} if "law" in settings else how


def turn(grain, how, **options):
    """Spin up a grain as a config says.

    Parameters
    ----------
    grain : ratd.Grain
    how : dict
        Arguments of `ratd.spin_up`, but ``law`` in words, see `contact_law`.
    **options
        Further ones, which stand over those.

    Returns
    -------
    xarray.Dataset
    """
    law = contact_law(how.get("law"), grain.material.poisson_number)
    return spin_up(grain, **how | {"law": law} | options)


def block(job):
    """Spin up the grains of one block, one after another.

    Parameters
    ----------
    job : ratd.pipeline.jobs.Job
    """
    file = io.read(job.input[0], "grains")
    of_seed = {grain.seed: grain for grain in grains(file)}
    settings = job.settings
    how = arguments(settings)

    def make(seed, checkpoint):
        every = settings["snapshot_every"] if seed in settings["snapshot_seeds"] else 0
        progress = told(job.progress(f"seed {seed}"))
        return run_row(turn(of_seed[seed], how, snapshot_every=every, checkpoint=checkpoint, progress=progress))

    job.block(job.output[0], "spinup", material_of(file), list(of_seed), make)
