"""Draw figure 4."""

from ratd.experiments.spin_up.figures import figure4, save
from ratd.pipeline import io
from ratd.pipeline.jobs import Job

with Job(snakemake) as job:
    runs = [run for path in snakemake.input for run in io.read_runs(path)]
    save(figure4(runs, drive=job.settings["drive"]), *snakemake.output)
