"""Collect the data that docs/reproduction.md is drawn from."""

from pathlib import Path

from ratd.jobs import Job
from ratd.reproduction.collect import Collection
from ratd.reproduction.data import GROWN
from ratd.validation import lammps, literal

with Job(snakemake) as job:
    files, settings = snakemake.input, job.settings
    collection = Collection(Path(snakemake.output[0]).parent, settings["config"], job.provenance)
    for drive in settings["config"]["drives"]:
        for name in ("grains", "table3"):
            what = "all grains" if name == "grains" else "fit of Eq. 33"
            source = next(path for path in files.ensemble if path.endswith(f"{drive}/{name}.nc"))
            collection.copy(source, f"ensemble/{drive}/{name}.nc", f"{what}, drive {drive}")
        collection.runs([path for path in files.runs if f"/spinup/{drive}/" in path], drive)
        job.log.info(f"drive {drive}: collected")
    collection.copy(files.grown, GROWN, "all grains of the config as grown")
    for path in files.pairs:
        collection.copy(path, f"pairs/{Path(path).name}", f"pairs of Fig. 10, {Path(path).stem}")
    if files.grains:
        collection.grains(files.grains, settings["config"]["figures"]["figure1"]["seed"])
    for name, path in settings["studies"].items():
        collection.copy(path, name, "a study of the reproduction")
    for check in (lammps, literal):
        name = check.KIND.removeprefix("validation_")
        if settings["validation"].get(name):
            what = f"cases of the check {name} of docs/validation.md"
            collection.tables(settings["validation"][name], check.KIND, f"validation/{name}.nc", what)
    collection.finish(settings["command"])
    job.log.info(f"{len(collection.written)} files in {collection.folder}")
