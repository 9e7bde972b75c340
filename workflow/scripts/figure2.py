"""Draw figure 2."""

from ratd.experiments.spin_up.figures import figure2, save
from ratd.pipeline import io
from ratd.pipeline.jobs import Job

with Job(snakemake) as job:
    table = io.read_table(snakemake.input[0])
    save(figure2(table, drive=job.settings["drive"]), *snakemake.output)
