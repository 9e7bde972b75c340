"""Collect the data that docs/reproduction.md is drawn from."""

from pathlib import Path

from ratd.config import check
from ratd.jobs import Job
from ratd.reproduction.collect import Collection
from ratd.reproduction.data import FIRM_BOUNDS

with Job(snakemake) as job:
    files, settings = snakemake.input, job.settings
    plan = check(settings["config"])
    collection = Collection(Path(snakemake.output[0]).parent, plan, job.provenance)
    collection.grown(*files.grown)
    for drive in plan.config["drives"]:
        runs = [path for path in files.runs if f"/spinup/{drive}/" in path]
        collection.runs(runs, drive)
        job.log.info(f"drive {drive}: {len(runs)} files collected")
    for path in files.pairs:
        collection.copy(path, f"pairs/{Path(path).name}", f"pairs of Fig. 10, {Path(path).stem}")
    if files.grains:
        collection.grains(files.grains, plan.config["figures"]["figure1"]["seed"])
    for name, (path,) in settings["studies"].items():  # a path and its hash each
        collection.copy(path, name, "a study of the reproduction")
    if files.firm_bounds:
        collection.tables(files.firm_bounds, "firm_bounds", FIRM_BOUNDS, "firm bounds of all grains as grown")
    collection.finish(settings["command"])
    job.log.info(f"{len(collection.written)} files in {collection.folder}")
