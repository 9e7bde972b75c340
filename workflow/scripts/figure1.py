"""Draw figure 1."""

from ratd.experiments.spin_up.figures import figure1, save
from ratd.pipeline import io
from ratd.pipeline.jobs import Job

with Job(snakemake) as job:
    grains = [grain for path in snakemake.input for grain in io.read_grains(path)]
    save(figure1([grain for grain in grains if grain.seed == job.settings["seed"]]), *snakemake.output)
