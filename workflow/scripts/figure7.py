"""Draw figure 7."""

from ratd.base.materials import Material
from ratd.experiments.spin_up.figures import figure7, save
from ratd.pipeline import io
from ratd.pipeline.jobs import Job

with Job(snakemake) as job:
    table = io.read_table(snakemake.input.table)
    fit = io.read_fit(snakemake.input.fit)
    materials = {name: Material(**constants) for name, constants in job.settings["materials"].items()}
    grown = io.read_table(snakemake.input.grown) if snakemake.input.grown else None
    figure = figure7(table, fit, drive=job.settings["drive"], materials=materials, grown=grown)
    save(figure, *snakemake.output)
