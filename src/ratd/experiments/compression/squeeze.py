"""Clusters that are compressed: the stage `compress` of the pipeline, and its words of progress."""

from ratd.engine.leapfrog import leapfrog
from ratd.engine.semi_implicit import semi_implicit
from ratd.experiments.compression.files import read_cluster, run_row
from ratd.experiments.compression.run import Cluster, compress
from ratd.laws.jkr_with_springs import jkr
from ratd.pipeline.jobs import duration

__all__ = ["integrator_of", "law_of", "run", "squeezed"]


def law_of(settings):
    """Contact law from settings: the constant damping ``k_n``."""
    return jkr(damping="constant", constant_damping=settings["k_n"])


def integrator_of(settings, time_unit):
    """Integrator from settings, the one place where it is chosen.

    Parameters
    ----------
    settings : dict
        ``timestep_factor`` of the explicit step, and ``semi_implicit``: None, or a dict with ``longest`` in t_0,
        ``displacement`` and ``travel`` [m], and ``calming``.
    time_unit : float
        t_0 [s].
    """
    own = settings["semi_implicit"]
    if own is None:
        return leapfrog(timestep_factor=settings["timestep_factor"])
    return semi_implicit(**own | {"longest": own["longest"] * time_unit})


def squeezed(grain, settings, **options):
    """Compress a cluster as settings say, xarray.Dataset."""
    how = {name: settings[name] for name in ("strain_rate", "until_phi", "scheme", "snapshots")}
    integrator = integrator_of(settings, Cluster(grain).time_unit)
    # the semi-implicit step has another mass matrix, and so no balance of the true energy
    balance = settings["semi_implicit"] is None
    return compress(grain, law=law_of(settings), integrator=integrator, balance=balance, **how, **options)


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
