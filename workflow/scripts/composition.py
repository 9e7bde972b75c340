"""Tabulate what the monomers are made of: Tables 1 and 2, computed and as printed."""

from ratd.experiments.spin_up.composition import table1, table2, tell
from ratd.pipeline import io
from ratd.pipeline.jobs import Job

with Job(snakemake) as job:
    for number, table, text in zip((1, 2), (table1(), table2()), tell(), strict=True):
        output = {suffix: snakemake.output[f"table{number}_{suffix}"] for suffix in ("nc", "csv", "md")}
        dataset = table.rename_axis("entry").to_xarray().drop_vars("entry")
        io.write(output["nc"], dataset.assign_attrs(job.provenance), f"table{number}")
        io.write_text(output["csv"], table.to_csv(index=False, float_format="%.9g"))
        io.write_text(output["md"], text + "\n")
    job.log.info("Tables 1 and 2 written")
