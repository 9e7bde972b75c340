"""Grains spun up with one formula as printed: the stage `formulae` of the pipeline."""

from ratd.experiments.spin_up.formulae import use

__all__ = ["run"]


def run(job):
    """Spin up the grains of one formula.

    Parameters
    ----------
    job : ratd.pipeline.jobs.Job
        Its wildcard `formula` names the formula.
    """
    use(job.wildcards.formula, job.settings[0]["grain"]["material"]["poisson_number"])
    # what this loads is compiled with the formula chosen
    from ratd.experiments.spin_up.variations import vary

    vary(job)
