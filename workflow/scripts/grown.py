"""Tabulate all grains of the config as grown, those too that no drive spins up."""

from ratd.pipeline import io
from ratd.experiments.spin_up.grain_table import grain_table, table_dataset
from ratd.pipeline.jobs import Job

with Job(snakemake) as job:
    table = grain_table([row for path in snakemake.input for row in io.read_grain_columns(path)])
    io.write(snakemake.output.table, table_dataset(table, "grain").assign_attrs(job.provenance), "table")
    io.write_text(snakemake.output.table_csv, table.to_csv(index=False, float_format="%.9g"))
    job.log.info(f"{len(table)} grains")
