"""A queue of spin-ups that are looked at on their way, for their fractal dimension: it may be stopped at any time.

    python -m ratd.experiments.spin_up.shapes                # go on where it was, until all is done
    python -m ratd.experiments.spin_up.shapes --minutes 30
    python -m ratd.experiments.spin_up.shapes --list         # what there is and what is left

The grains are those of the ensemble, grown and spun up anew in the same way. Each becomes a row of a small table in
docs/reproduction/data/shapes, a file a material and type: the shape of its largest fragment at each of `LOOKS`. A row
that is there is never computed again, also not with other source: it says itself which source it is of.
"""

import sys
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr

from ratd.base.errors import InputError
from ratd.base.units import NM
from ratd.experiments.spin_up import plan as plans
from ratd.experiments.spin_up.cells import TYPES, sort_cells
from ratd.experiments.spin_up.grow import grown
from ratd.experiments.spin_up.marks import ROUNDING, disruption
from ratd.experiments.spin_up.spin import arguments, turn
from ratd.experiments.spin_up.study import settings_of
from ratd.geometry.shape import fractal_dimension
from ratd.pipeline import io
from ratd.pipeline.blocks import rows
from ratd.pipeline.kinds import MATERIAL, ROW, Kind, Variable, over, register, row_sizes
from ratd.pipeline.provenance import source_hash
from ratd.pipeline.queue import Table, Task, command, key

__all__ = ["DATA", "KIND", "LOOKS", "looks", "main", "read_shapes", "shape", "tasks"]

CONFIG = ("config/config.yaml", "config/spin_up.yaml")
DATA = "docs/reproduction/data/shapes"
DRIVE = "prescribed"
MATERIAL_NAME = "q-S"
SIZES_NM = (450,)
"""Some 1300 monomers: with fewer than a hundred a fractal dimension is uncertain by 0.4 or more."""
SEEDS = range(30)
LOOKS = ("rest", "before loss", "disruption")
"""At rest; the last record in which the grain is whole; at omega_disr. The flag in a file is the place in this list."""

_LOOK = {
    "omega": ("rad s-1", "angular velocity"),
    "mass_fraction": ("1", "mass of the largest fragment over that of the grain"),
    "porosity": ("1", "its porosity P = 1 - a_eff^3/(a b c)"),
    "fractal_dimension": ("1", "its fractal dimension (Eq. 8)"),
    "fractal_dimension_error": ("1", "standard error of that"),
}
"""Numbers of a look: units and meaning; NaN where the fragment has too few monomers for a fractal dimension."""

KIND = register(
    "shapes",
    Kind(
        "Shapes of grains that are spun up",
        {
            **MATERIAL,
            "a_eff": Variable((ROW,), "f8", "m", "effective radius"),
            **over((ROW,), {"seed": ("1", "seed"), "n_monomers": ("1", "monomers")}, dtype="i8"),
            "source": Variable((ROW,), "str", "", "hash of the source that spun it up"),
            **row_sizes(("look",)),
            "when": Variable(("look",), "i1", "", "when it was looked at", flags=LOOKS),
            **over(("look",), _LOOK, nan=True),
        },
        attributes=("material", "type"),
        ragged=("look",),
    ),
)


def tasks(plan, data):
    """What is to be done, in order: one seed of all cells comes before the next.

    Parameters
    ----------
    plan : ratd.experiments.spin_up.plan.Plan
    data : path-like
        Folder of the tables.

    Returns
    -------
    list of ratd.pipeline.queue.Task
    """
    source = source_hash(modules=["ratd.experiments.spin_up.shapes"])
    tables = {kind: _table(plan, data, kind) for kind in TYPES}
    found = []
    for seed in SEEDS:
        for size in SIZES_NM:
            for kind, table in tables.items():
                cell = (MATERIAL_NAME, kind, size)
                how = arguments(plan.spin_up(DRIVE, *cell, f"{seed}-{seed}"))
                make = partial(shape, plan.grow(*cell), how, seed, source)
                found.append(Task(table, key(size * NM, seed), make))
    return found


def _table(plan, data, kind):
    """The table of a type."""
    settings = settings_of(plan, DRIVE, MATERIAL_NAME, kind)
    path = Path(data, f"{MATERIAL_NAME}_{kind}.nc")
    return Table(path, KIND, ("a_eff", "seed"), plan.materials[MATERIAL_NAME], settings)


def shape(growth, how, seed, source=""):
    """One grain, grown, spun up and looked at, as a row of a table.

    Parameters
    ----------
    growth : dict
        As `ratd.experiments.spin_up.grow.grown` takes it.
    how : dict
        As `ratd.experiments.spin_up.spin.turn` takes it.
    seed : int
    source : str
        Hash of the source.

    Returns
    -------
    row : xarray.Dataset
        Of the kind ``shapes``.
    sentence : str
    """
    grain = grown(growth, seed)
    found = looks(turn(grain, how, snapshot_every=1))
    row = xr.Dataset(
        {name: ("look", np.array([look[name] for look in found.values()])) for name in _LOOK},
        attrs={"material": grain.material.name, "type": grain.type},
    )
    row["when"] = ("look", np.array([LOOKS.index(when) for when in found], dtype="i1"))
    row = row.assign(a_eff=growth["a_eff"], seed=seed, n_monomers=grain.n_monomers, source=source)
    return row, f"{grain.material.name} {grain.type} {grain.a_eff / NM:.0f} nm seed {seed}: " + ", ".join(
        f"{when} D_f {look['fractal_dimension']:.2f}" for when, look in found.items()
    )


def looks(run):
    """What is seen of a grain at each of `LOOKS`.

    Parameters
    ----------
    run : xarray.Dataset
        From `ratd.spin_up` with snapshots at all records.

    Returns
    -------
    dict of str to dict
        One of `LOOKS` -> name of `_LOOK` -> number; without one that the run does not have.
    """
    omega, whole = run["omega"].values, run["mass"].values / run.attrs["initial_mass"]
    at = {"rest": 0}
    kept = np.flatnonzero(whole >= 1.0 - ROUNDING)
    if len(kept):
        at["before loss"] = kept[-1]
    found = disruption(run)["omega_disr"].item()
    if np.isfinite(found):
        at["disruption"] = np.flatnonzero(omega == found)[0]
    result = {}
    for when, record in at.items():
        picture = run.isel(snapshot=np.flatnonzero(run["snapshot_omega"].values == omega[record])[0])
        largest = picture["snapshot_fragment"].values == 0
        position = np.stack([picture[f"snapshot_{axis}"].values[largest] for axis in "xyz"], axis=1)
        # all of one material: masses go as the cubes of the radii
        dimension, error = fractal_dimension(position, picture["monomer_radius"].values[largest] ** 3)
        result[when] = {
            "omega": omega[record],
            "mass_fraction": whole[record],
            "porosity": run["porosity"].values[record],
            "fractal_dimension": dimension,
            "fractal_dimension_error": error,
        }
    return result


def read_shapes(folder):
    """Table of all looks.

    Parameters
    ----------
    folder : path-like
        Of the queue.

    Returns
    -------
    pandas.DataFrame
        A row a look, in the order of the paper, with what is known of its grain: material, type, a_eff, seed,
        n_monomers; ``when`` is one of `LOOKS`.

    Raises
    ------
    InputError
        If there are no files.
    """
    found = []
    for path in sorted(Path(folder).glob("*.nc")):
        for row in rows(io.read(path, KIND), KIND):
            grain = {name: row[name].item() for name in ("a_eff", "seed", "n_monomers")}
            own = row[["when", *_LOOK]].to_dataframe()
            found.append(own.assign(material=row.attrs["material"], type=row.attrs["type"], **grain))
    if not found:
        raise InputError(f"{folder}: holds no shapes.")
    table = sort_cells(pd.concat(found, ignore_index=True))
    table["when"] = np.array(LOOKS)[table["when"]]
    return table


def main(words=None):
    """The command; returns the exit status, see `ratd.pipeline.queue.command`."""
    return command(
        words, module=sys.modules[__name__], what="grains", config=CONFIG, data=DATA, load=plans.load, tasks=tasks
    )


if __name__ == "__main__":
    sys.exit(main())
