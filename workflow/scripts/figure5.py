"""Draw figure 5."""

from ratd.experiments.spin_up.figures import figure5, save
from ratd.pipeline import io
from ratd.pipeline.jobs import Job

with Job(snakemake) as job:
    runs = {run.attrs["seed"]: run for run in io.read_runs(snakemake.input[0])}
    save(figure5(runs[job.settings["seed"]], drive=job.settings["drive"]), *snakemake.output)
