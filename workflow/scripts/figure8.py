"""Draw figure 8."""

from ratd.base.materials import Material
from ratd.experiments.spin_up.figures import figure8, save
from ratd.pipeline import io
from ratd.pipeline.jobs import Job

with Job(snakemake) as job:
    table = io.read_table(snakemake.input.table)
    grown = io.read_table(snakemake.input.grown) if snakemake.input.grown else None
    settings = job.settings
    materials = {name: Material(**constants) for name, constants in settings["materials"].items()}
    which = settings["material"], settings["type"], settings["scaled_at"], settings["drive"]
    save(figure8(table, *which, materials, grown), *snakemake.output)
