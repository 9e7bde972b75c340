"""Draw figure 6."""

from ratd.experiments.spin_up.figures import figure6, save
from ratd.pipeline import io
from ratd.pipeline.jobs import Job

with Job(snakemake) as job:
    table = io.read_table(snakemake.input[0])
    settings = job.settings
    figure = figure6(table, settings["material"], settings["sizes"], drive=settings["drive"])
    save(figure, *snakemake.output)
