"""Draw figure 10."""

import pandas as pd

from ratd.experiments.spin_up.figures import figure10, save
from ratd.pipeline import io
from ratd.pipeline.jobs import Job

with Job(snakemake) as job:
    table = pd.concat([io.read(path, "pairs").to_dataframe() for path in snakemake.input], ignore_index=True)
    save(figure10(table), *snakemake.output)
