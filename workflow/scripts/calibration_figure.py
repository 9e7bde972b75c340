"""Draw the calibration of the drive literal."""

from ratd import io
from ratd.calibration import CALIBRATION_COLUMNS, FIT_VALUES
from ratd.figures import calibration, save
from ratd.jobs import Job

with Job(snakemake) as job:
    file = io.read(snakemake.input[0], "calibration")
    save(calibration(file[list(CALIBRATION_COLUMNS)].to_dataframe(), file[list(FIT_VALUES)]), *snakemake.output)
