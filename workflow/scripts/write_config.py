"""Write down the config that the results were made with."""

import yaml

from ratd.pipeline import io
from ratd.pipeline.jobs import Job

with Job(snakemake) as job:
    io.write_text(snakemake.output[0], yaml.safe_dump(job.settings, sort_keys=False, allow_unicode=True))
