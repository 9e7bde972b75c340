"""Spin up pairs of equal monomers of one material."""

import pandas as pd

from ratd.base.materials import Material
from ratd.experiments.spin_up.pairs import pairs
from ratd.pipeline import io
from ratd.pipeline.jobs import Job

with Job(snakemake) as job:
    settings = dict(job.settings)
    material = Material(**settings.pop("material"))
    table = pd.DataFrame(pairs(material, **settings, progress=job.log.info))
    dataset = table.rename_axis("entry").to_xarray().drop_vars("entry")
    io.write(snakemake.output[0], dataset.assign_attrs(job.provenance), "pairs")
