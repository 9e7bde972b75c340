"""Spin up the grains of the calibration at one angular acceleration and step, by the equations as printed."""

from ratd.io import run_row
from ratd.jobs import Job
from ratd.variations import spin_up_ways

with Job(snakemake) as job:
    spin_up_ways(job, snakemake.output, job.settings, "spinup", run_row)
