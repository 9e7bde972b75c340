"""Make the page on which a grain is turned and steps through its disruption."""

from ratd.pictures.grain_page import grain_page
from ratd.pipeline import io
from ratd.pipeline.jobs import Job

with Job(snakemake) as job:
    runs = {run.attrs["seed"]: run for run in io.read_runs(snakemake.input[0])}
    page = grain_page(runs[job.settings["seed"]], drive=job.settings["drive"])
    with io.atomic(snakemake.output[0]) as part:
        part.write_text(page, encoding="utf-8")
