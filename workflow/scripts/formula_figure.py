"""Draw what single formulae change when they are used as printed."""

from ratd.experiments.spin_up.figures import formulae, save
from ratd.pipeline import io
from ratd.pipeline.jobs import Job

with Job(snakemake) as job:
    save(formulae(io.read(snakemake.input[0], "formulae").to_dataframe()), *snakemake.output)
