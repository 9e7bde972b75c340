"""Clusters that are compressed: the stage `compress` of the pipeline, and its words of progress."""

from ratd.experiments.compression.files import read_cluster, run_row
from ratd.experiments.compression.run import compress, compression_law
from ratd.experiments.compression.steps import LongSteps
from ratd.pipeline.jobs import duration

__all__ = ["run", "squeezed"]


def squeezed(grain, settings, **options):
    """Compress a cluster as settings say, xarray.Dataset."""
    names = ("strain_rate", "until_phi", "scheme", "snapshots", "timestep_factor")
    how = {name: settings[name] for name in names}
    own = settings["long_steps"]
    steps = None if own is None else LongSteps(**own)
    return compress(grain, law=compression_law(settings["k_n"]), long_steps=steps, **how, **options)


def told(say):
    """Callback for `ratd.compress` that tells how far a run is."""

    def progress(phi, pressure, seconds_to_go):
        say(lambda: f"phi {phi:.3g}, P {pressure:.3g} Pa, {duration(seconds_to_go)} to go")

    return progress


def run(job):
    """Compress one cluster.

    Parameters
    ----------
    job : ratd.pipeline.jobs.Job
    """
    grain = read_cluster(job.input[0])

    def make(seed, checkpoint):
        progress = told(job.progress(f"seed {seed}"))
        return run_row(squeezed(grain, job.settings, checkpoint=checkpoint, progress=progress))

    job.block(job.output[0], "compression", grain.material, [grain.seed], make)
