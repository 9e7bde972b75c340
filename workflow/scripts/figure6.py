"""Draw figure 6."""

from ratd import io
from ratd.figures import figure6, save
from ratd.jobs import Job

with Job(snakemake) as job:
    table = io.read_table(snakemake.input[0])
    settings = job.settings
    figure = figure6(table, settings["material"], settings["sizes"], drive=settings["drive"])
    save(figure, *snakemake.output)
