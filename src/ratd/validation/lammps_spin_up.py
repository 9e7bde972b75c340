"""A queue of grains that ratd and LAMMPS spin up, up to 550 nm; ratd waits as in production, and does not wait.

    python -m ratd.validation.lammps_spin_up                # go on where it was, until all is done
    python -m ratd.validation.lammps_spin_up --minutes 30
    python -m ratd.validation.lammps_spin_up --list         # what there is and what is left

Each grain becomes a row of a small table in docs/validation/data/lammps_spin_up, a file a material and type. A grain of
550 nm takes LAMMPS hours: what it had reached stands in the folder `UNFINISHED` there, and goes with the row. Of the
grains of the check against LAMMPS (config/validation.yaml, `ratd.validation.lammps`) only the spin-up of production is
made here: what LAMMPS found stands in docs/validation/data/lammps.nc. The others (`LARGE`) LAMMPS drives in its turning
frame as there, with epsilon = ln(`STEP`)/(2 pi `ROTATIONS`), and ratd in the inertial frame in the same steps of omega.
To be affordable it is different in two ways: the first step has `FIRST` times the omega at which the spin-up of
production loses its first mass (and `FIRST` times as much where a grain has lost mass there already), and the spheres
stand in `CLASSES` classes of radius, one atom type each. `CONTROLS` are grains of lammps.nc that are driven once more
in this way.
"""

import sys
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr

from ratd.aggregates.growth import grow
from ratd.base.errors import InputError
from ratd.base.materials import MATERIALS
from ratd.base.measured import geometric_mean, median
from ratd.base.units import NM
from ratd.experiments.relax import relax
from ratd.experiments.spin_up.cells import GRAIN, TYPES, size_key, sort_cells
from ratd.experiments.spin_up.cut_bound import cut_bound
from ratd.experiments.spin_up.marks import disruption
from ratd.experiments.spin_up.run import spin_up
from ratd.pipeline import io
from ratd.pipeline.blocks import rows
from ratd.pipeline.kinds import MATERIAL, ROW, Kind, Variable, over, register, row_sizes
from ratd.pipeline.provenance import source_hash
from ratd.pipeline.queue import Table, Task, command, key
from ratd.validation import peer_lammps
from ratd.validation.lammps import MARKS, TURNING, InLammps, InRatd, driven, threshold
from ratd.validation.lammps_checkpoint import once
from ratd.validation.lammps_findings import SHORT, of_each
from ratd.validation.plan import Checks

__all__ = [
    "CONTROLS", "DATA", "HELD", "KIND", "LARGE", "both", "driven_from_below", "findings", "grains_of_check", "main",
    "one_each", "spun", "tables_of", "tasks", "thresholds",
]  # fmt: skip

CONFIG = ("config/validation.yaml",)
DATA = "docs/validation/data/lammps_spin_up"
UNFINISHED = "unfinished"
"""Folder in it of the checkpoints."""
EXTENT = "full"
"""Of the config: whose grains of the check against LAMMPS are taken."""
STEP = 1.02
"""Ratio of two omega that are tried."""
ROTATIONS = 0.064
"""How long each is held, which is an epsilon of 0.049."""
FIRST = 0.7
"""First omega that is looked at, over that of the first loss in production; there the load is half as much."""
CLASSES = 32
"""Classes of radius in LAMMPS: 7 % wide each."""
LARGE = tuple((material, kind, 200, 0) for material in ("co-S", "a-C") for kind in TYPES) + tuple(
    ("q-S", kind, size, 0) for size in (300, 550) for kind in TYPES[::-1]
)
"""Material, type, size [nm] and seed of the grains that are driven in LAMMPS here, beside `CONTROLS`; of a size the
short ones first."""
CONTROLS = tuple(("q-S", kind, 200, 0) for kind in TYPES)
NEAR = 0.05
"""Part by which the median of LAMMPS may be off the spin-up of production, see `findings`."""
CODES = ("ratd", "LAMMPS")
"""Who drives; the flag in a file is the place in this list."""
_HOLD = ("code", "omega", "mass_left", "timestep")
_OMEGA = {"first loss": "omega_first_loss", "25 % of the mass": "omega_mass_75"}
"""Mark of `MARKS` -> the same of a spin-up."""

HELD = over(
    ("hold",),
    {
        "omega": ("rad s-1", "angular velocity that was held"),
        "mass_left": ("1", "mass of the largest fragment over that of the grain at its end"),
    },
)
"""Variables of a file: what was held, and what came of it."""
KIND = register(
    "lammps_spin_up",
    Kind(
        "Grains spun up by ratd and by LAMMPS",
        {
            **MATERIAL,
            **over(
                (ROW,),
                {"a_eff": ("m", "effective radius"), "cut_bound": ("rad s-1", "bound on omega of the grain as grown")},
            ),
            **over(
                (ROW,),
                {
                    "omega_first_loss": ("rad s-1", "first loss of mass in the spin-up of production"),
                    "omega_mass_75": ("rad s-1", "loss of 25 % of the mass in it"),
                },
                nan=True,
            ),
            **over(
                (ROW,),
                {"seed": ("1", "seed"), "n_monomers": ("1", "monomers"), "n_contacts": ("1", "contacts")},
                dtype="i8",
            ),
            "version": Variable((ROW,), "str", "", "version of LAMMPS, empty where it did not drive"),
            "source": Variable((ROW,), "str", "", "hash of the source"),
            **row_sizes(("hold",)),
            "code": Variable(("hold",), "i1", "", "who drives", flags=CODES),
            **HELD,
            **over(("hold",), {"timestep": ("s", "time step")}),
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
    source = source_hash(modules=["ratd.validation.lammps_spin_up"])
    timestep_factor = plan.config[EXTENT]["lammps"]["timestep_factor"]
    wanted = list(dict.fromkeys((*grains_of_check(plan), *CONTROLS, *LARGE)))
    settings = {"step": STEP, "rotations": ROTATIONS, "first": FIRST, "classes": CLASSES}
    tables = tables_of(wanted, data, KIND, settings | {"timestep_factor": timestep_factor})
    return [
        Task(
            tables[grain[:2]],
            key(grain[2] * NM, grain[3]),
            partial(
                spun,
                *grain,
                timestep_factor,
                grain in (*CONTROLS, *LARGE),
                source,
                Path(data, UNFINISHED, "_".join(map(str, grain))),
            ),
        )
        for grain in wanted
    ]


def grains_of_check(plan):
    """Material, type, size [nm] and seed of the grains of the check against LAMMPS."""
    own = plan.config[EXTENT]["lammps"]
    return [
        (own["material"], grains["type"], grains["size_nm"], seed)
        for grains in own["grains"]
        for seed in range(grains["seeds"])
    ]


def tables_of(wanted, data, kind, settings):
    """Material and type of grains -> the table with their rows.

    Parameters
    ----------
    wanted : list of tuple
        Material, type, size and seed of each.
    data : path-like
        Folder of the tables.
    kind : str
        Of the files.
    settings : dict
        What the rows depend on.

    Returns
    -------
    dict of tuple to ratd.pipeline.queue.Table
    """
    return {
        pair: Table(Path(data, "_".join(pair) + ".nc"), kind, ("a_eff", "seed"), MATERIALS[pair[0]], settings)
        for pair in dict.fromkeys(grain[:2] for grain in wanted)
    }


def spun(material, kind, size, seed, timestep_factor, drive, source="", checkpoint=None):
    """One grain as a row of a table.

    Parameters
    ----------
    material, kind : str
    size : float
        Effective radius [nm].
    seed : int
    timestep_factor : float
        f of the relaxation before, and of the runs of ratd that do not wait.
    drive : bool
        Whether both codes drive it; else there is the spin-up of production alone.
    source : str
        Hash of the source.
    checkpoint : path-like, optional
        See `both`.

    Returns
    -------
    row : xarray.Dataset
        Of the kind ``lammps_spin_up``.
    sentence : str
    """
    grain = grow(kind, size * NM, material, seed)
    marks = disruption(spin_up(grain))
    found = {mark: marks[name].item() for mark, name in _OMEGA.items()}
    if drive:
        holds = both(grain, found["first loss"], timestep_factor, checkpoint=checkpoint, source=source)
    else:
        holds = {name: np.empty(0) for name in _HOLD}
    row = xr.Dataset(
        {name: ("hold", np.asarray(values, dtype="i1" if name == "code" else float)) for name, values in holds.items()},
        attrs={"material": material, "type": kind},
    ).assign(
        a_eff=size * NM,
        seed=seed,
        n_monomers=grain.n_monomers,
        n_contacts=grain.n_contacts,
        cut_bound=cut_bound(grain),
        version=peer_lammps.version() if drive else "",
        source=source,
        **{name: found[mark] for mark, name in _OMEGA.items()},
    )
    said = [f"{material} {kind} {size:g} nm seed {seed}: ratd {found['first loss']:.4g} rad/s"]
    for number, code in enumerate(CODES if drive else ()):
        own = holds["code"] == number
        low, high = threshold(holds["omega"][own], holds["mass_left"][own], MARKS["first loss"])
        said.append(f"{code} driven {low:.4g} to {high:.4g}")
    return row, ", ".join(said)


def both(grain, unit, timestep_factor, *, first=FIRST, classes=CLASSES, checkpoint=None, source=""):
    """What both codes do with a grain that is driven, as the variables of the kind along ``hold``.

    Parameters
    ----------
    grain : ratd.Grain
    unit : float
        [rad/s]
    timestep_factor : float
    first : float
        First omega that is looked at, over `unit`.
    classes : int or None
        See `ratd.validation.peer_lammps.sort_by_radius`.
    checkpoint : path-like, optional
        Where LAMMPS, which takes hours for a large grain, keeps its last hold, see `ratd.validation.lammps.driven`, and
        where the holds of ratd are kept meanwhile.
    source : str
        Hash of the source, which these holds of ratd belong to.

    Returns
    -------
    dict of str to (k,) array
    """
    state = relax(grain, timestep_factor=timestep_factor)
    makers = {
        "ratd": lambda: InRatd(state, timestep_factor),
        "LAMMPS": partial(InLammps, state, grain.material, turning=True, classes=classes),
    }
    kept = {"ratd": None, "LAMMPS": checkpoint}
    done = {"ratd": None if checkpoint is None else Path(f"{checkpoint}_ratd_{source}.npy"), "LAMMPS": None}
    parts = []
    for code, make in makers.items():
        with make() as example:
            timestep = example.timestep
        held = once(done[code], partial(driven_from_below, make, unit, first, kept[code]))
        number = np.full(len(held), CODES.index(code))
        parts.append((number, held[:, 0], held[:, 3], np.full(len(held), timestep)))
    if checkpoint is not None:
        done["ratd"].unlink()
    return dict(zip(_HOLD, map(np.concatenate, zip(*parts, strict=True)), strict=True))


def driven_from_below(make, unit, first, checkpoint=None):
    """Holds of `ratd.validation.lammps.driven` in steps of `STEP`, the first of which the grain survives whole.

    Parameters
    ----------
    make, unit, checkpoint
        See there.
    first : float
        First omega that is looked at, over `unit`; `FIRST` times as much where a grain has lost mass there already.

    Returns
    -------
    (k, 4) array
    """
    while True:
        # a checkpoint belongs to one start
        own = None if checkpoint is None else f"{checkpoint}_{first:.3g}"
        held = np.array(driven(make, unit, STEP, ROTATIONS, first, own))
        if held[0, 3] >= MARKS["first loss"]:
            return held
        first *= FIRST


def thresholds(folder, check):
    """Angular velocities of both marks, by both codes.

    Parameters
    ----------
    folder : path-like
        Of the tables of this module.
    check : pandas.DataFrame
        Rows of the check ``lammps``, which has the driven runs of its grains; see `ratd.validation.tables`.

    Returns
    -------
    pandas.DataFrame
        A row a grain, mark and ``types`` (of atoms in LAMMPS: "own" or "classes"): material, type, a_eff, seed,
        n_monomers; ``waits``, the omega of the spin-up of production; ``ratd`` and ``LAMMPS``, the geometric mean of
        the bracket of each where both are driven, NaN where there is none.

    Raises
    ------
    InputError
        If the check is of other grains.
    """
    found = []
    for path in sorted(Path(folder).glob("*.nc")):
        file = io.read(path, KIND)
        for row in rows(file, KIND):
            grain = {name: row[name].item() for name in ("a_eff", "seed", "n_monomers", "cut_bound", *_OMEGA.values())}
            grain = {**row.attrs, **grain}
            of_check = _of_check(check, grain)
            for types, held in (("classes", _own_holds(row)), ("own", of_check)):
                found += [_marks(grain, types, held, mark) for mark in MARKS if held]
    table = sort_cells(pd.DataFrame(found))
    if not len(table):
        raise InputError(f"{folder}: holds no grains.")
    return table


def _own_holds(row):
    """code -> (omega, mass left) of the driven runs of a row; empty where there are none."""
    codes = row["code"].values
    return {
        code: (row["omega"].values[codes == number], row["mass_left"].values[codes == number])
        for number, code in enumerate(CODES)
        if (codes == number).any()
    }


def _of_check(check, grain):
    """The same from the check."""
    own = check[(check["study"] == "rotation") & (check["path"] == "driven")]
    for name in ("material", "type", "seed"):
        own = own[own[name] == grain[name]]
    own = own[size_key(own["a_eff"]) == size_key(pd.Series([grain["a_eff"]]))[0]]
    if len(own) and not np.allclose(own["cut_bound"], grain["cut_bound"], rtol=1e-6):
        raise InputError(
            f"the check against LAMMPS has another grain {grain['material']} {grain['type']} "
            f"{grain['a_eff'] / NM:.0f} nm seed {grain['seed']}: its cut bound differs"
        )
    names = {"ratd": "ratd", "LAMMPS": TURNING}
    parts = {code: own[own["code"] == name] for code, name in names.items() if len(own)}
    return {code: (part["omega"].to_numpy(), part["mass_left"].to_numpy()) for code, part in parts.items()}


def _marks(grain, types, held, mark):
    """A row of `thresholds`."""
    middle = {code: float(np.sqrt(np.prod(threshold(*runs, MARKS[mark])))) for code, runs in held.items()}
    kept = {name: value for name, value in grain.items() if name not in _OMEGA.values()}
    return kept | {"mark": mark, "types": types, "waits": grain[_OMEGA[mark]]} | middle


def one_each(table):
    """Rows of `thresholds` with their ``ratio``, LAMMPS over the spin-up of production, as the ``way`` "default".

    Of a grain that was driven with both sorts of types those of own types alone.
    """
    one = table.sort_values("types", ascending=False, kind="stable").drop_duplicates([*GRAIN, "mark"])
    return one.assign(way="default", ratio=one["LAMMPS"] / one["waits"])


def findings(table):
    """What a document says of it.

    Parameters
    ----------
    table : pandas.DataFrame
        Of `thresholds`.

    Returns
    -------
    dict
        Slots ``lammps_spin_up.GROUP MARK ...``, GROUP being a type, a size such as ``300 nm``, a material, or ``all``,
        MARK ``first`` or ``quarter``: the median of LAMMPS over the spin-up of production; with ``mean`` behind it
        the geometric mean; with ``driven`` behind it,
        over ratd driven alike; with ``waits`` behind it, of ratd driven over the spin-up of production. Errors by
        bootstrap over grains, of at least three; ``GROUP MARK grains`` is their number. Of a grain that was driven with
        both sorts of types that with own types counts, and ``twice MARK`` has both, with own types first.
        ``later quarter within`` and ``known``: of the quarters that are not lost with the first mass.
        ``verdict``: whether the median of all at the first loss is within `NEAR`, ``limit.median``; ``GROUP MARK
        least`` and so on: single grains, see `ratd.validation.lammps_findings.of_each`.
    """
    size = [f"{size / NM:.0f} nm" for size in table["a_eff"]]
    table = table.assign(size=size, ratio=table["LAMMPS"] / table["waits"])
    one = one_each(table)
    values = {
        "lammps_spin_up.grains": len(one.drop_duplicates(GRAIN)),
        "lammps_spin_up.most monomers": int(one["n_monomers"].max()),
        "lammps_spin_up.small": int((one.drop_duplicates(GRAIN)["n_monomers"] < 100).sum()),
    }
    groups = {"all": one}
    for column in ("type", "size", "material"):
        groups |= {name: one[one[column] == name] for name in one[column].drop_duplicates()}
    for mark, short in SHORT.items():
        for name, group in groups.items():
            own = group[group["mark"] == mark]
            slot = f"lammps_spin_up.{name} {short}"
            values[slot] = median(own["ratio"])
            values[f"{slot} mean"] = geometric_mean(own["ratio"])
            values[f"{slot} driven"] = median(own["LAMMPS"] / own["ratd"])
            values[f"{slot} waits"] = median(own["ratd"] / own["waits"])
            values[f"{slot} grains"] = int(np.isfinite(own["ratio"]).sum())
            values |= of_each(slot, own["ratio"].dropna())
        both_types = table[table["mark"] == mark].pivot_table(index=GRAIN, columns="types", values="ratio")
        if {"own", "classes"} <= set(both_types):
            both_types = both_types.dropna()
            values[f"lammps_spin_up.twice {short}"] = ", ".join(
                f"{kind} {own:.2f} and {classes:.2f}"
                for kind, own, classes in zip(
                    both_types.index.get_level_values("type"), both_types["own"], both_types["classes"], strict=True
                )
            )
    values |= of_each("lammps_spin_up.later quarter", _later(one)["ratio"])
    off = abs(values["lammps_spin_up.all first"].value - 1.0)
    values |= {"limit.median": NEAR, "lammps_spin_up.verdict": "met" if off < NEAR else "missed"}
    return values


def _later(one):
    """Quarters in rows of `one_each` that LAMMPS does not lose with the first mass: losses of their own."""
    first, quarter = (one[one["mark"] == mark].dropna(subset="ratio") for mark in SHORT)
    both = quarter.merge(first[[*GRAIN, "LAMMPS"]], on=GRAIN, suffixes=("", "_first"))
    return both[~np.isclose(both["LAMMPS"], both["LAMMPS_first"], rtol=1e-6, atol=0.0)]


def main(words=None):
    """The command; returns the exit status, see `ratd.pipeline.queue.command`."""
    return command(
        words, module=sys.modules[__name__], what="grains", config=CONFIG, data=DATA, load=Checks, tasks=tasks
    )


if __name__ == "__main__":
    sys.exit(main())
