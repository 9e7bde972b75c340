"""Grow or run grains, which the function of the rule writes block by block."""

from ratd.pipeline.jobs import Job

with Job(snakemake) as job:
    job.function(job)
