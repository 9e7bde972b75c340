"""Draw what single formulae change when they are used as printed."""

from ratd import io
from ratd.figures import formulae, save
from ratd.jobs import Job

with Job(snakemake) as job:
    save(formulae(io.read(snakemake.input[0], "formulae").to_dataframe()), *snakemake.output)
