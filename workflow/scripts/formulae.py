"""Spin up grains with one formula as printed."""

from ratd.experiments.spin_up.formulae import use

use(snakemake.wildcards.formula, snakemake.params.settings[0]["grain"]["material"]["poisson_number"])

from ratd.experiments.spin_up.marks import disruption  # noqa: E402
from ratd.experiments.spin_up.same_grains import spin_up_ways  # noqa: E402
from ratd.pipeline.jobs import Job  # noqa: E402 - what follows loads the engine, with the formula chosen

with Job(snakemake) as job:
    spin_up_ways(job, snakemake.output, job.settings, "disruption", disruption)
