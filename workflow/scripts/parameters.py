"""Spin up the grains of one type and size with other rolling displacements and viscous times."""

from ratd.jobs import Job
from ratd.marks import disruption
from ratd.variations import spin_up_ways

with Job(snakemake) as job:
    spin_up_ways(job, snakemake.output, job.settings, "disruption", disruption)
