"""Draw figure 9."""

from ratd import io
from ratd.figures import figure9, save
from ratd.jobs import Job

with Job(snakemake) as job:
    table = io.read(snakemake.input[0], "parameters").to_dataframe()
    save(figure9(table), *snakemake.output)
