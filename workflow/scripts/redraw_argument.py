"""Draw the figures of docs/reproduction.md that the paper does not have."""

from pathlib import Path

from ratd.figures import calibration, formulae, save
from ratd.jobs import Job
from ratd.reproduction import figures
from ratd.reproduction.data import Data
from ratd.validation.show import lammps, literal

with Job(snakemake) as job:
    data = Data(job.settings["folder"])
    draw = {
        "overview": lambda: figures.overview(data.grown, data.tables, data.plan.materials),
        "bound": lambda: figures.bound(data.grown, data.tables, data.plan.materials),
        "fragments": lambda: figures.fragments(data.fragments),
        "calibration": lambda: calibration(data.calibration.to_dataframe(), data.calibration),
        "formulae": lambda: formulae(data.formulae),
        "lammps": lambda: lammps.draw(data.study("lammps")),
        "literal": lambda: literal.draw(data.study("literal")),
    }
    for path in snakemake.output:
        save(draw[Path(path).stem](), path)
