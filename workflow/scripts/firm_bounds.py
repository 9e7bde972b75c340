"""Bounds of grown grains from cuts whose contacts hold sideways and push as well."""

import pandas as pd

from ratd.experiments.spin_up.firm_bound import FIRM_BOUND_COLUMNS, firm_bound
from ratd.pipeline import io
from ratd.pipeline.jobs import Job

with Job(snakemake) as job:
    rows = []
    for path in snakemake.input:
        for grain in io.read_grains(path):
            own = (grain.material.name, grain.type, grain.a_eff, float(grain.seed), firm_bound(grain))
            rows.append(dict(zip(FIRM_BOUND_COLUMNS, own, strict=True)))
        job.log.info(f"{len(rows)} grains, the last ones from {path}")
    dataset = pd.DataFrame(rows).rename_axis("entry").to_xarray().drop_vars("entry")
    io.write(snakemake.output[0], dataset.assign_attrs(job.provenance), "firm_bounds")
