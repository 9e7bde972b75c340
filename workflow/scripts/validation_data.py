"""Collect the tables that docs/validation.md is written from."""

from ratd.pipeline.jobs import Job
from ratd.validation.data import collect, finish

with Job(snakemake) as job:
    folder, checks = job.settings["folder"], job.settings["checks"]
    for check, pieces in checks.items():
        paths = snakemake.input.get(check, [])
        collect(folder, check, paths, pieces)
        job.log.info(f"{check}: {len(paths)} of {len(pieces)} pieces are new")
    finish(folder, checks, job.settings["command"])
