"""Grains spun up with one formula as printed: the stage `formulae` of the pipeline."""

from ratd.experiments.spin_up.contact_law import printed_factors
from ratd.experiments.spin_up.marks import disruption
from ratd.experiments.spin_up.same_grains import spin_up_ways
from ratd.laws.jkr_with_springs import jkr

__all__ = ["run"]


def run(job):
    """Spin up the grains of one formula, the wildcard `formula`.

    Parameters
    ----------
    job : ratd.pipeline.jobs.Job
    """
    factors = printed_factors(job.wildcards.formula, job.settings[0]["grain"]["material"]["poisson_number"])
    spin_up_ways(job, job.output, job.settings, "disruption", disruption, law=jkr(**factors))
