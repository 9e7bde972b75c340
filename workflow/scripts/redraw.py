"""Write docs/reproduction.md."""

from pathlib import Path

from ratd import io
from ratd.jobs import Job
from ratd.reproduction.data import Data
from ratd.reproduction.report import report

with Job(snakemake) as job:
    captions = {
        int(Path(path).stem.removeprefix("figure")): Path(path).read_text(encoding="utf-8")
        for path in snakemake.input.captions
    }
    data = Data(job.settings["folder"])
    io.write_text(snakemake.output[0], report(data, job.settings["pictures"], captions))
