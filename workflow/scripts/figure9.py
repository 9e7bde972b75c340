"""Draw figure 9."""

from ratd.experiments.spin_up.figures import figure9, save
from ratd.pipeline import io
from ratd.pipeline.jobs import Job

with Job(snakemake) as job:
    table = io.read(snakemake.input[0], "parameters").to_dataframe()
    save(figure9(table), *snakemake.output)
