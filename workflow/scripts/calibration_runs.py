"""Spin up the grains of the calibration at one angular acceleration and step, by the equations as printed."""

from ratd.experiments.spin_up.same_grains import spin_up_ways
from ratd.pipeline.io import run_row
from ratd.pipeline.jobs import Job

with Job(snakemake) as job:
    spin_up_ways(job, snakemake.output, job.settings, "spinup", run_row)
