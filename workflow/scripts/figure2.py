"""Draw figure 2."""

from ratd import io
from ratd.figures import figure2, save
from ratd.jobs import Job

with Job(snakemake) as job:
    table = io.read_table(snakemake.input[0])
    save(figure2(table, drive=job.settings["drive"]), *snakemake.output)
