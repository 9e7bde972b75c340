"""Spin up grains with one formula as printed."""

from ratd.experiments.spin_up.formulae import printed_factors
from ratd.experiments.spin_up.marks import disruption
from ratd.experiments.spin_up.same_grains import spin_up_ways
from ratd.laws.jkr_with_springs import jkr
from ratd.pipeline.jobs import Job

with Job(snakemake) as job:
    factors = printed_factors(snakemake.wildcards.formula, job.settings[0]["grain"]["material"]["poisson_number"])
    spin_up_ways(job, snakemake.output, job.settings, "disruption", disruption, law=jkr(**factors))
