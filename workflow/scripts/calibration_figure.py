"""Draw the calibration of the drive literal."""

from ratd.experiments.spin_up.calibration import CALIBRATION_COLUMNS, FIT_VALUES
from ratd.experiments.spin_up.figures import calibration, save
from ratd.pipeline import io
from ratd.pipeline.jobs import Job

with Job(snakemake) as job:
    file = io.read(snakemake.input[0], "calibration")
    save(calibration(file[list(CALIBRATION_COLUMNS)].to_dataframe(), file[list(FIT_VALUES)]), *snakemake.output)
