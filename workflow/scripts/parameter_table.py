"""Tabulate the grains of figure 9 beside the same grains with their material as it is."""

from ratd.experiments.spin_up.parameters import parameter_table
from ratd.pipeline import io
from ratd.pipeline.jobs import Job

with Job(snakemake) as job:
    files = []
    for parameter, path in zip(job.settings["parameters"], snakemake.input, strict=True):
        file = io.read(path, "disruption")
        files.append((parameter, io.material_of(file), io.rows(file, "disruption")))
    table = parameter_table(files)
    dataset = table.rename_axis("entry").to_xarray().drop_vars("entry")
    io.write(snakemake.output.nc, dataset.assign_attrs(job.provenance), "parameters")
    io.write_text(snakemake.output.csv, table.to_csv(index=False, float_format="%.9g"))
    job.log.info(f"{len(table)} runs written to {snakemake.output.nc}")
