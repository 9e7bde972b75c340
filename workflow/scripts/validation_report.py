"""Join the sections of all checks, and put their figures beside the text."""

import shutil
from pathlib import Path

from ratd import io
from ratd.jobs import Job
from ratd.validation.show.report import report

with Job(snakemake) as job:
    sections = [Path(path).read_text(encoding="utf-8") for path in snakemake.input.sections]
    for source, target in zip(snakemake.input.figures, snakemake.output.figures, strict=True):
        with io.atomic(target) as temporary:
            shutil.copyfile(source, temporary)
    io.write_text(snakemake.output.text, report(sections, **job.settings))
