"""Draw one check and write its section."""

from importlib import import_module

from ratd import io
from ratd.figures.style import save
from ratd.jobs import Job
from ratd.validation.show import (  # noqa: F401  (source hash)
    convergence,
    energy,
    energy_step,
    forces,
    frames,
    growth,
    lammps,
    literal,
    pull_off,
    theory,
)
from ratd.validation.tables import read_tables

with Job(snakemake) as job:
    check = snakemake.wildcards.check
    table = read_tables(snakemake.input, import_module(f"ratd.validation.{check}").KIND)
    show = import_module(f"ratd.validation.show.{check}")
    save(show.draw(table), snakemake.output.pdf, snakemake.output.png)
    io.write_text(snakemake.output.text, f"{show.tell(table)}\n\n![{check}]({check}.png)\n")
