"""Make tables or texts from files: the function of the rule gives a dict, name of an output -> what it holds."""

from ratd.pipeline.jobs import Job

with Job(snakemake) as job:
    for name, content in job.function(job.input, job.settings, job.log.info).items():
        job.write(name, content)
