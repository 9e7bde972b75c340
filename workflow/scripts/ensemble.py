"""Tabulate all grains, average them per cell, and fit Eq. 33 beside Table 3."""

from ratd.experiments.spin_up.cells import cell_statistics
from ratd.experiments.spin_up.eq33 import fit_as_configured, table3, table3_dataset
from ratd.experiments.spin_up.grain_table import grain_table, table_dataset
from ratd.pipeline import io
from ratd.pipeline.jobs import Job

with Job(snakemake) as job:
    output, settings = snakemake.output, job.settings
    grains = [row for path in snakemake.input.grains for row in io.read_grain_columns(path)]
    marks = [row for path in snakemake.input.marks for row in io.read_marks(path)]
    table = grain_table(grains, marks)
    # another drive may want more grains than this one
    table = table[table["drive"] == settings["drive"]].reset_index(drop=True)
    cells = cell_statistics(table)
    fit = fit_as_configured(table, settings)
    io.write(output.table, table_dataset(table, "grain").assign_attrs(job.provenance), "table")
    io.write(output.cells, table_dataset(cells, "cell").assign_attrs(job.provenance), "cells")
    io.write(output.fit, table3_dataset(fit).assign_attrs(job.provenance), "fit")
    for path, frame in ((output.table_csv, table), (output.cells_csv, cells), (output.fit_csv, table3(fit))):
        io.write_text(path, frame.to_csv(index=False, float_format="%.9g"))
    job.log.info(f"{len(table)} grains in {len(cells)} cells; {fit.attrs['missing_fits'] or 'all fits made'}")
