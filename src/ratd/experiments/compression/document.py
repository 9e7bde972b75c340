"""docs/compression.md, its appendix and their figures, drawn again from the data beside them.

python -m ratd.experiments.compression.document collect RESULTS    take tables or new seeds from a folder of results
python -m ratd.experiments.compression.document redraw             figures and text, in seconds
"""

import sys
from importlib import import_module
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr

from ratd.base.errors import FileError, InputError
from ratd.base.words import plural
from ratd.experiments.compression.figures.monomers import name_of
from ratd.experiments.compression.figures.tension import read_entries
from ratd.experiments.compression.figures.spring_back import spring_back
from ratd.experiments.compression.findings import findings
from ratd.experiments.compression.plan import load
from ratd.experiments.compression.repeats import pull_keys
from ratd.experiments.compression.tables import joined
from ratd.experiments.compression.tension_findings import spun_up
from ratd.pictures.style import save
from ratd.pipeline import io
from ratd.pipeline.atomic import atomic, write_text
from ratd.pipeline.documents import command, fill
from ratd.pipeline.provenance import together

__all__ = ["collect", "main", "read_data", "redraw"]

DATA = Path("docs/compression/data")
PULLS, AGAIN = "tension.nc", "again"
"""File of the pulls, and folder of what was made once more, in the data."""
FIGURES = Path("docs/compression")
DOCUMENTS = {
    Path("docs/templates/compression.md"): Path("docs/compression.md"),
    Path("docs/templates/compression_appendix.md"): Path("docs/compression_appendix.md"),
}
CONFIGS = (
    "config/config.yaml",
    "config/spin_up.yaml",
    "config/compression.yaml",
    "config/compression_default.yaml",
    "config/compression_steps.yaml",
    "config/compression_large.yaml",
)
SPUN = Path("docs/reproduction/data/driven.csv")
"""Table of the ensemble of the spin-up, for the strengths that it implies."""
PEER = Path("docs/validation/data")
"""Folder of what LAMMPS found, taken there by ``python -m ratd.validation.document collect``."""


def collect(results, data=DATA):
    """Take the tables of a folder of results beside the document, those that are finished.

    Positions stay where those that are there are of a larger cluster. What is made in pieces grows: the clusters of a
    new table are added to those that are there, or take the place of those with the same seeds; so do pulls.

    Parameters
    ----------
    results : path-like
        Such as ``results/compression_default``.
    data : path-like

    Raises
    ------
    FileError
        If there are no tables.
    InputError
        If the table that is there has clusters that a new one lacks, and was made in another way, such as with other
        steps.
    """
    results, data = Path(results), Path(data)
    names = [path.name for path in sorted((results / "compression").glob("*.nc")) if path.is_file()]
    pulls = sorted(path for path in (results / "tension").rglob("phi_*.nc") if path.is_file())
    if not names and not pulls:
        raise FileError(f"{results}: holds no tables of the compression; run the target compression_tables first")
    for name in names:
        kind = "compression_snapshots" if name == "snapshots.nc" else "compression_set"
        target = data / name if kind == "compression_snapshots" else data / "sets" / name
        table = io.read(results / "compression" / name, kind)
        if kind == "compression_snapshots" and target.is_file():
            there = io.read(target, kind)
            if there.sizes["monomer"] > table.sizes["monomer"]:
                continue
        if kind == "compression_set" and target.is_file():
            there = io.read(target, kind)
            left = ~np.isin(there["seed"].values, table["seed"].values)
            if left.any():
                try:
                    both = joined(there.isel(seed_number=left), table)
                except InputError as error:
                    raise InputError(
                        f"{target}: has {plural(left.sum(), 'cluster')} that the new table lacks, and {error} Make "
                        "these anew too, or delete the file first."
                    ) from None
                io.write(target, both, kind)
                continue
        with atomic(target) as temporary:
            temporary.write_bytes((results / "compression" / name).read_bytes())
    if pulls:
        target = data / PULLS
        entries = read_entries(pulls)
        if target.is_file():
            entries = _added(io.read(target, "tension_set"), entries)
        io.write(target, entries, "tension_set")


def _added(there, new):
    """Pulls that are there, but for those that are made anew, and new ones behind them."""
    anew = set(pull_keys(new))
    kept = [key not in anew for key in pull_keys(there)]
    both = xr.concat([there.isel(entry=kept), new], "entry", combine_attrs="drop")
    return both.assign_attrs(together([there.attrs, new.attrs]))


def read_data(data=DATA, spun=SPUN, peer=PEER):
    """The data beside the document.

    Returns
    -------
    sets : dict of str to xarray.Dataset
    entries : xarray.Dataset or None
        Pulled clusters.
    grains : dict or None
        See `ratd.experiments.compression.tension_findings.spun_up`.
    lammps, box, dense, springs : pandas.DataFrame or None
        See `ratd.experiments.compression.beside_lammps` and `ratd.experiments.compression.springs`.
    repeats : dict of str to xarray.Dataset
        Sets that were made once more.
    pulled : xarray.Dataset or None
        Pulls that were made once more.
    """
    data = Path(data)
    sets, repeats = (
        {path.stem: io.read(path, "compression_set") for path in sorted(folder.glob("*.nc")) if path.name != PULLS}
        for folder in (data / "sets", data / AGAIN)
    )
    if "base" not in sets:
        raise FileError(f"{data / 'sets'}: holds no base.nc, which all sets are compared with")
    entries, pulled = (
        io.read(path, "tension_set") if path.is_file() else None for path in (data / PULLS, data / AGAIN / PULLS)
    )
    grains = spun_up(pd.read_csv(spun)) if Path(spun).is_file() else None
    beside = []
    for name in ("compression", "box_at_rest", "dense", "spring_back"):
        path = Path(peer, f"{name}.nc")
        beside.append(io.read(path, f"validation_{name}").to_dataframe() if path.is_file() else None)
    return sets, entries, grains, *beside, repeats, pulled


def redraw(folder=".", into=None):
    """Write the document, its appendix and their figures.

    Parameters
    ----------
    folder : path-like
        Where the project is.
    into : path-like, optional
        Where to write them instead.
    """
    folder = Path(folder)
    into = folder if into is None else Path(into)
    sets, entries, grains, *beside, springs, repeats, pulled = read_data(folder / DATA, folder / SPUN, folder / PEER)
    plan = load(*(folder / path for path in CONFIGS), schemas=folder / "config/schema")
    for name in plan.figures:
        figure = draw(name, plan, sets, entries, grains, folder / DATA)
        if figure is not None:
            save(figure, into / FIGURES / f"{name}.png")
    if springs is not None:
        save(spring_back(springs), into / FIGURES / "spring_back.png")
    values = findings(sets, entries, grains, *beside, springs, repeats, pulled)
    for template, document in DOCUMENTS.items():
        text = (folder / template).read_text(encoding="utf-8")
        write_text(into / document, fill(text, values, str(template)))


def draw(name, plan, sets, entries, grains, data):
    """One figure from the data that there are, or None where these do not show anything."""
    module = import_module(f"ratd.experiments.compression.figures.{name}")
    if name == "tension":
        return None if entries is None else module.tension(entries, grains)
    if name == "figure3":
        path = data / "snapshots.nc"
        return module.figure3(io.read(path, "compression_snapshots")) if path.is_file() else None
    tables = [sets[wanted] for wanted in plan.sets_of(name) if wanted in sets]
    if not tables:
        return None
    if name == "monomers":
        equal, *others = tables
        return module.monomers(equal, others, [name_of(table) for table in others])
    drawn = getattr(module, name)
    return drawn(tables[0]) if "set" in plan.config["figures"][name] else drawn(tables)


def main(words):
    """The command line; returns the exit code."""
    return command(words, __doc__, collect, redraw)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
