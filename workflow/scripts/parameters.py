"""Spin up the grains of one type and size with other rolling displacements and viscous times."""

from ratd.experiments.spin_up.marks import disruption
from ratd.experiments.spin_up.same_grains import spin_up_ways
from ratd.pipeline.jobs import Job

with Job(snakemake) as job:
    spin_up_ways(job, snakemake.output, job.settings, "disruption", disruption)
