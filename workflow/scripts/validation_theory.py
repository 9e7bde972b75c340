"""Compute one piece of the check theory."""

from ratd.pipeline.jobs import Job
from ratd.validation.tables import write_table
from ratd.validation.theory import KIND, compute

with Job(snakemake) as job:
    rows = compute(job.settings, progress=job.log.info)
    write_table(snakemake.output[0], rows, KIND, job.provenance)
