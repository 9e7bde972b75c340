"""Write down the config that the results were made with."""

import yaml

from ratd import io
from ratd.jobs import Job

with Job(snakemake) as job:
    io.write_text(snakemake.output[0], yaml.safe_dump(job.settings, sort_keys=False, allow_unicode=True))
