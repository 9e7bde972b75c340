"""Write docs/validation.md and draw its figures."""

from pathlib import Path

from ratd import io
from ratd.figures.style import save
from ratd.jobs import Job
from ratd.validation.data import whole_tables
from ratd.validation.show.report import SHOWN, report

with Job(snakemake) as job:
    output, settings = snakemake.output, job.settings
    folder, tables = settings["folder"], whole_tables(settings["folder"], settings["checks"])
    text = report(folder, tables, Path(output.figures[0]).parent.name, settings["command"])
    for (check, table), picture in zip(tables.items(), output.figures, strict=True):
        save(SHOWN[check].draw(table), picture)
    io.write_text(output.text, text)
