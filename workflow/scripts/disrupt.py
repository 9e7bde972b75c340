"""Find where the grains of one material, type and size are disrupted."""

from ratd.experiments.spin_up.marks import disruption
from ratd.pipeline import io
from ratd.pipeline.jobs import Job

with Job(snakemake) as job:
    files = [io.read(path, "spinup") for path in snakemake.input]
    marks = [disruption(run) for file in files for run in io.runs(file)]
    for mark in marks:
        if mark.attrs["missing_marks"]:
            job.log.info(f"seed {mark.attrs['seed']}: {mark.attrs['missing_marks']}")
    io.write(
        snakemake.output[0],
        io.block(marks, "disruption", io.material_of(files[0]), job.provenance),
        "disruption",
    )
    job.log.info(f"{len(marks)} grains written to {snakemake.output[0]}")
