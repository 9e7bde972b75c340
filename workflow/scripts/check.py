"""Compute one piece of a check, whose cases the function of the rule gives."""

from ratd.pipeline.jobs import Job
from ratd.validation.tables import as_dataset

with Job(snakemake) as job:
    (kind,) = job.output.keys()
    job.write(kind, as_dataset(job.function(job.settings, progress=job.log.info), kind))
