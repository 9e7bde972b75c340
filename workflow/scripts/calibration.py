"""Tabulate the runs of the calibration and fit the onset of mass loss."""

from ratd.experiments.spin_up.calibration import calibrate, calibration_table
from ratd.pipeline import io
from ratd.pipeline.jobs import Job

with Job(snakemake) as job:
    table = calibration_table([run for path in snakemake.input for run in io.read_runs(path)])
    fit = calibrate(table, job.settings["omega_onset"])
    dataset = table.rename_axis("entry").to_xarray().drop_vars("entry").merge(fit)
    io.write(snakemake.output.nc, dataset.assign_attrs(job.provenance), "calibration")
    io.write_text(snakemake.output.csv, table.to_csv(index=False, float_format="%.9g"))
    job.log.info(f"calibrated d omega/dt: {float(fit['calibrated']):.3g} rad/s2")
