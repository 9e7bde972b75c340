"""Draw the figure that the function of the rule gives, into every output."""

from ratd.pictures.style import save
from ratd.pipeline.jobs import Job

with Job(snakemake) as job:
    save(job.function(job.input, job.settings), *job.output)
