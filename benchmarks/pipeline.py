"""Part (d): how much of the pipeline's time over small sizes goes into anything but growing and spinning up grains.

The grains of one material are grown and spun up one after the other in this process, without files. Then Snakemake
makes the same grains, down to their marks of disruption, in a folder of its own and on the same core. What its run
takes longer is imports, reading compiled code, files, hashes, and Snakemake itself. Code is compiled before either.
"""

import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import yaml

from benchmarks import tables
from benchmarks.cost import arguments_of, grain_of
from ratd import spin_up
from ratd.base.errors import FileError
from ratd.experiments.spin_up.cut_bound import cut_bound

DRIVE = "prescribed"
PARTS = ("config", "profiles", "workflow", "Snakefile")
"""What Snakemake needs of the repository, next to the installed library."""


def measure(out, plan, *, root, sizes, warm, about, say):
    """Measure and write ``pipeline.csv``, a row a size.

    Parameters
    ----------
    out : pathlib.Path
        Folder of the results.
    plan : ratd.experiments.spin_up.plan.Plan
        The config; its first material and all its types and seeds are made.
    root : pathlib.Path
        Folder of the repository.
    sizes : list of str
        Sizes, a subset of those of the plan.
    warm : bool
        Whether Snakemake runs once before, so that no code is compiled while it is timed.
    about : dict
        Columns that each row gets: the machine and the versions.
    say : callable
        Told how far it is.

    Raises
    ------
    FileError
        If Snakemake fails.
    """
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        for name in PARTS:
            copy = shutil.copytree if (root / name).is_dir() else shutil.copy
            copy(root / name, folder / name)
        _work(plan, sizes[0], 1)  # compiles, as does the next line
        if warm:
            _snakemake(folder, plan, sizes[0], seeds=1, results="warm")
        material = plan.config["materials"][0]
        for size in sizes:
            seconds = _work(plan, size, len(plan.seeds))
            wall = _snakemake(folder, plan, size, seeds=len(plan.seeds), results=f"at_{size}")
            row = {
                "drive": DRIVE,
                "material": material,
                "size_nm": size,
                "grains": len(plan.seeds) * len(plan.config["types"]),
                "blocks": sum(len(plan.blocks((material, kind, size))) for kind in plan.config["types"]),
                "seconds_of_work": seconds,
                "seconds_of_pipeline": wall,
            }
            rows.append(row | about)
            say(f"pipeline: {size} nm: {seconds:.1f} s of work in {wall:.1f} s")
    tables.write(out / "pipeline.csv", rows)


def _work(plan, size, seeds):
    """Time that growing and spinning up alone takes [s]."""
    start = time.perf_counter()
    for kind in plan.config["types"]:
        arguments = arguments_of(plan, DRIVE, kind, 1)
        for seed in plan.seeds[:seeds]:
            grain = grain_of(plan, (plan.config["materials"][0], kind, size), seed)
            cut_bound(grain)
            spin_up(grain, **arguments)
    return time.perf_counter() - start


def _snakemake(folder, plan, size, *, seeds, results):
    """Time that Snakemake takes for the same grains [s]."""
    config = plan.config | {
        "materials": plan.config["materials"][:1],
        "sizes_nm": [float(size)],
        "seeds": plan.config["seeds"] | {"number": seeds},
        "drives": [DRIVE],
        "snapshots": plan.config["snapshots"] | {"grains": []},
        "figures": dict.fromkeys(plan.config["figures"]),
    }
    (folder / "small.yaml").write_text(yaml.safe_dump({"results": results, "spin_up": config}))
    command = [sys.executable, "-m", "snakemake", "--cores", "1", "disruptions", "--configfile", "small.yaml"]
    start = time.perf_counter()
    done = subprocess.run(
        command, cwd=folder, env=os.environ, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False
    )
    if done.returncode:
        raise FileError(f"snakemake failed at {size} nm: {done.stdout.strip().splitlines()[-1]}")
    return time.perf_counter() - start
