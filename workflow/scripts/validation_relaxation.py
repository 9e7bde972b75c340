"""Compute one piece of the check relaxation."""

from ratd.pipeline.jobs import Job
from ratd.validation.relaxation import KIND, compute
from ratd.validation.tables import write_table

with Job(snakemake) as job:
    rows = compute(job.settings, progress=job.log.info)
    write_table(snakemake.output[0], rows, KIND, job.provenance)
