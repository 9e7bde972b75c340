"""A queue of grains that ratd drives as LAMMPS does, from several starts: what parts the two in single grains?

    python -m ratd.validation.lammps_single                # go on where it was, until all is done
    python -m ratd.validation.lammps_single --list         # what there is and what is left

Two things could: chaos, and the limits of sliding, rolling and twisting, which follow the load in LAMMPS. So the grains
of `ratd.validation.lammps_spin_up`, but for those of 550 nm, are driven in ratd in the inertial frame with both sorts
of limits (`LAWS`), in the steps of omega that LAMMPS had, without waiting. All springs begin at rest, as they do there.
Each runs from `STARTS` starts, in all but the first of which every monomer is moved by about `SHIFT` at random. A grain
becomes a row of a small table in docs/validation/data/lammps_single, a file a material and type.
"""

import sys
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr

from ratd.aggregates.growth import grow
from ratd.base.errors import InputError
from ratd.base.measured import median
from ratd.base.units import NM
from ratd.engine.fragments import contact_pairs
from ratd.engine.layout import RADIUS, X
from ratd.engine.leapfrog import leapfrog
from ratd.engine.state import monomer_rows, new_state
from ratd.experiments.relax import relax
from ratd.experiments.spin_up.cells import GRAIN
from ratd.experiments.spin_up.cut_bound import cut_bound
from ratd.experiments.spin_up.findings.beside import NEAR_LAMMPS, beside_all_starts
from ratd.experiments.spin_up.marks import disruption
from ratd.experiments.spin_up.run import spin_up
from ratd.geometry.box import open_space
from ratd.laws.jkr_as_in_lammps import jkr_as_in_lammps
from ratd.laws.jkr_with_springs import jkr
from ratd.pipeline import io
from ratd.pipeline.blocks import rows
from ratd.pipeline.kinds import MATERIAL, ROW, Kind, Variable, over, register, row_sizes
from ratd.pipeline.provenance import source_hash
from ratd.pipeline.queue import Task, command, key
from ratd.validation.lammps import FIRST_OMEGA, MARKS, InRatd, driven, threshold
from ratd.validation.lammps_findings import SHORT
from ratd.validation.lammps_spin_up import (
    CONFIG,
    EXTENT,
    FIRST,
    HELD,
    LARGE,
    ROTATIONS,
    STEP,
    driven_from_below,
    grains_of_check,
    tables_of,
)
from ratd.validation.plan import Checks

__all__ = ["DATA", "KIND", "LAWS", "STARTS", "beside", "findings", "from_starts", "main", "one", "tasks"]

DATA = "docs/validation/data/lammps_single"
LARGEST = 300
"""Greatest size [nm]."""
LAWS = {"ratd": jkr(), "limits of LAMMPS": jkr_as_in_lammps()}
"""Whose limits -> the law; the flag in a file is the place in this mapping."""
STARTS = 6
SHIFT = 1e-12
"""Standard deviation [m] of what a monomer is moved by along each axis."""
_SLOT = {"ratd": "own", "limits of LAMMPS": "limits"}

KIND = register(
    "lammps_single",
    Kind(
        "Grains spun up by ratd from several starts, with its limits and with those of LAMMPS",
        {
            **MATERIAL,
            **over(
                (ROW,), {"a_eff": ("m", "effective radius"), "unit": ("rad s-1", "what omega begins with a part of")}
            ),
            **over((ROW,), {"seed": ("1", "seed"), "n_monomers": ("1", "monomers")}, dtype="i8"),
            "source": Variable((ROW,), "str", "", "hash of the source"),
            **row_sizes(("hold",)),
            "law": Variable(("hold",), "i1", "", "whose limits", flags=tuple(LAWS)),
            **over(("hold",), {"start": ("1", "number of the start")}, dtype="i8"),
            **HELD,
        },
        attributes=("material", "type"),
        ragged=("hold",),
    ),
)


def tasks(plan, data):
    """What is to be done, in order.

    Parameters
    ----------
    plan : ratd.validation.plan.Checks
    data : path-like
        Folder of the tables.

    Returns
    -------
    list of ratd.pipeline.queue.Task
    """
    source = source_hash(modules=["ratd.validation.lammps_single"])
    own = plan.config[EXTENT]["lammps"]
    steps = {"timestep_factor": own["timestep_factor"], "step": own["step"], "rotations": own["rotations"]["driven"]}
    large = [grain for grain in LARGE if grain[2] <= LARGEST]
    wanted = list(dict.fromkeys((*grains_of_check(plan), *large)))
    tables = tables_of(wanted, data, KIND, _settings(steps))
    return [
        Task(
            tables[grain[:2]],
            key(grain[2] * NM, grain[3]),
            partial(one, *grain, **steps, large=grain in large, source=source),
        )
        for grain in wanted
    ]


def _settings(steps):
    """What all rows depend on: the large ones are driven in steps of their own."""
    large = {"step": STEP, "rotations": ROTATIONS, "first": FIRST}
    return {**steps, "first": FIRST_OMEGA, "large": large, "starts": STARTS, "shift": SHIFT}


def one(material, kind, size, seed, *, timestep_factor, step, rotations, large, source=""):
    """One grain as a row of a table.

    Parameters
    ----------
    material, kind : str
    size : float
        Effective radius [nm].
    seed : int
    timestep_factor : float
        f of the relaxation before, and of the runs.
    step, rotations : float
        Of the check against LAMMPS, see `ratd.validation.lammps.driven`.
    large : bool
        Whether it is driven as in `ratd.validation.lammps_spin_up`, else as in the check.
    source : str
        Hash of the source.

    Returns
    -------
    row : xarray.Dataset
        Of the kind ``lammps_single``.
    sentence : str
    """
    grain = grow(kind, size * NM, material, seed)
    unit = disruption(spin_up(grain))["omega_first_loss"].item() if large else cut_bound(grain)

    def drive(make):
        if large:
            return driven_from_below(make, unit, FIRST)
        return np.array(driven(make, unit, step, rotations, FIRST_OMEGA))

    holds = from_starts(grain, timestep_factor, drive)
    row = xr.Dataset(
        {name: ("hold", values) for name, values in holds.items()}, attrs={"material": material, "type": kind}
    ).assign(a_eff=size * NM, seed=seed, n_monomers=grain.n_monomers, unit=unit, source=source)
    said = [f"{material} {kind} {size:g} nm seed {seed}: first loss"]
    for law, omega in _middles(row, MARKS["first loss"]).items():
        said.append(f"{law} {np.nanmin(omega):.4g} to {np.nanmax(omega):.4g} rad/s")
    return row, ", ".join(said)


def from_starts(grain, timestep_factor, drive):
    """Holds of a grain with each law and from each start, as the variables of the kind along ``hold``.

    Parameters
    ----------
    grain : ratd.Grain
    timestep_factor : float
    drive : callable
        A maker of `ratd.validation.lammps.InRatd` -> (k, 4) array, the holds of `ratd.validation.lammps.driven`.

    Returns
    -------
    dict of str to (n,) array
    """
    relaxed = relax(grain, timestep_factor=timestep_factor)
    spheres, pairs = monomer_rows(relaxed), contact_pairs(relaxed)
    integrator = leapfrog(timestep_factor=timestep_factor)
    parts = []
    for number, law in enumerate(LAWS.values()):
        for start in range(STARTS):
            position, radius = spheres[:, X : X + 3].copy(), spheres[:, RADIUS].copy()
            if start:
                position += np.random.default_rng(start).normal(0.0, SHIFT, position.shape)
            state = new_state(position, radius, grain.material, pairs, law, open_space(), integrator)
            held = drive(partial(InRatd, state, timestep_factor, law))
            parts.append((np.full(len(held), number, dtype="i1"), np.full(len(held), start), held[:, 0], held[:, 3]))
    return dict(zip(("law", "start", "omega", "mass_left"), map(np.concatenate, zip(*parts, strict=True)), strict=True))


def _middles(row, limit):
    """Whose limits -> the threshold of each start [rad/s], NaN where there is none."""
    found = {}
    for number, law in enumerate(LAWS):
        own = [(row["law"].values == number) & (row["start"].values == start) for start in range(STARTS)]
        brackets = [threshold(row["omega"].values[which], row["mass_left"].values[which], limit) for which in own]
        found[law] = np.sqrt(np.prod(brackets, axis=1))
    return found


def beside(folder, one_each):
    """LAMMPS over ratd driven alike, of the grains that both have driven.

    Parameters
    ----------
    folder : path-like
        Of the tables of this module.
    one_each : pandas.DataFrame
        Of `ratd.validation.lammps_spin_up.one_each`.

    Returns
    -------
    pandas.DataFrame
        A row a grain, mark and ``limits`` (of `LAWS`): LAMMPS over the omega of ratd, with ``least``, ``median`` and
        ``most`` over the starts, and the one ``nearest`` to 1. NaN where a start has none.

    Raises
    ------
    InputError
        If there is no grain, or one that LAMMPS has not driven.
    """
    theirs = {
        (each.material, each.type, *key(each.a_eff, each.seed), each.mark): each.LAMMPS
        for each in one_each.itertuples()
    }
    found = []
    for path in sorted(Path(folder).glob("*.nc")):
        file = io.read(path, KIND)
        for row in rows(file, KIND):
            grain = {**row.attrs, **{name: row[name].item() for name in ("a_eff", "seed", "n_monomers")}}
            name = (grain["material"], grain["type"], *key(grain["a_eff"], grain["seed"]))
            if any((*name, mark) not in theirs for mark in MARKS):
                raise InputError(f"{path}: LAMMPS has not driven {' '.join(map(str, name))}.")
            for mark, limit in MARKS.items():
                for law, omega in _middles(row, limit).items():
                    # NaN where a start has no threshold
                    ratio = theirs[*name, mark] / omega
                    nearest = ratio[np.argmin(np.abs(ratio - 1.0))]
                    spread = (ratio.min(), np.median(ratio), ratio.max(), nearest)
                    found.append(
                        {each: grain[each] for each in (*GRAIN, "n_monomers")}
                        | {"mark": mark, "limits": law}
                        | dict(zip(("least", "median", "most", "nearest"), spread, strict=True))
                    )
    if not found:
        raise InputError(f"{folder}: holds no grains.")
    return pd.DataFrame(found)


def findings(table):
    """What a document says of it.

    Parameters
    ----------
    table : pandas.DataFrame
        Of `beside`.

    Returns
    -------
    dict
        Slots ``lammps_single.LAW MARK`` with LAW ``own`` or ``limits``, MARK ``first`` or ``quarter``: the median over
        grains of LAMMPS over the median of the starts; with more words behind it: ``known``,
        grains that have one in both codes; ``near``, those of them in which LAMMPS is within `NEAR_LAMMPS` of the
        median of the starts; ``reached``, within that of one of them;
        ``least`` and ``most``, LAMMPS over the median; ``spread``, the greatest ratio of two starts of one grain;
        ``mean``, ``below`` and ``above``, see `ratd.experiments.spin_up.findings.beside.beside_all_starts`;
        ``same``, grains of which all starts have the same mark.
        ``starts`` is their number; ``verdict``, whether all are near at both marks with the limits of LAMMPS.
    """
    values = {"lammps_single.grains": len(table.drop_duplicates(GRAIN)), "lammps_single.starts": STARTS}
    for (law, mark), part in table.dropna(subset=["median"]).groupby(["limits", "mark"]):
        slot = f"lammps_single.{_SLOT[law]} {SHORT[mark]}"
        values[f"{slot} known"] = len(part)
        for name, column in (("near", "median"), ("reached", "nearest")):
            values[f"{slot} {name}"] = int(((part[column] - 1.0).abs() <= NEAR_LAMMPS).sum())
        values[slot] = median(part["median"])
        values |= {f"{slot} {name}": found for name, found in beside_all_starts(part).items()}
        values[f"{slot} least"], values[f"{slot} most"] = part["median"].min(), part["median"].max()
        values[f"{slot} same"] = int(np.isclose(part["most"], part["least"], atol=0.0).sum())
        values[f"{slot} spread"] = (part["most"] / part["least"]).max()
    limited = table[table["limits"] == "limits of LAMMPS"].dropna(subset="median")
    near = ((limited["median"] - 1.0).abs() <= NEAR_LAMMPS).all()
    return values | {"lammps_single.verdict": "met" if near else "missed"}


def main(words=None):
    """The command; returns the exit status, see `ratd.pipeline.queue.command`."""
    return command(
        words, module=sys.modules[__name__], what="grains", config=CONFIG, data=DATA, load=Checks, tasks=tasks
    )


if __name__ == "__main__":
    sys.exit(main())
