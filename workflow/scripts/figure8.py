"""Draw figure 8."""

from ratd import io
from ratd.figures import figure8, save
from ratd.jobs import Job
from ratd.materials import Material

with Job(snakemake) as job:
    table = io.read_table(snakemake.input[0])
    settings = job.settings
    materials = {name: Material(**constants) for name, constants in settings["materials"].items()}
    figure = figure8(table, settings["material"], settings["type"], settings["scaled_at"], settings["drive"], materials)
    save(figure, *snakemake.output)
