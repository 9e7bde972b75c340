"""Tabulate grains spun up with single formulae as printed."""

from ratd.experiments.spin_up.formulae import formula_table
from ratd.pipeline import io
from ratd.pipeline.jobs import Job

with Job(snakemake) as job:
    files = list(zip(job.settings["formulae"], map(io.read_marks, snakemake.input), strict=True))
    table = formula_table(files)
    dataset = table.rename_axis("entry").to_xarray().drop_vars("entry")
    io.write(snakemake.output.nc, dataset.assign_attrs(job.provenance), "formulae")
    io.write_text(snakemake.output.csv, table.to_csv(index=False, float_format="%.9g"))
    job.log.info(f"{len(table)} runs written to {snakemake.output.nc}")
