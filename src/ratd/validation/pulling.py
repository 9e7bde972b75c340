"""A queue of grains of the spin-up that are pulled until they come apart, which may be stopped at any time.

    python -m ratd.validation.pulling                # go on where it was, until all is done
    python -m ratd.validation.pulling --minutes 30
    python -m ratd.validation.pulling --list         # what there is and what is left

The grains are those of the ensemble, grown anew. Each becomes a row of a small table in docs/reproduction/data/pulled,
a file a material and type, and holds all its pulls (`BOX`, `ENDS`). A row that is there is never computed again, also
not with other source: it says itself which source it is of.

*Box*: turned with its longest axis along x, the grain lies in a cube as long as itself and touches its copies there.
The cube shrinks until it is filled as densely as the grain was, by which time there are contacts across all faces; then
it rests and the cube grows along x. *Ends*: the relaxed grain is taken by its two ends (`ratd.validation.by_ends`).
"""

import sys
from functools import partial
from pathlib import Path

import numpy as np
import xarray as xr

from ratd.base.units import NM
from ratd.engine.contacts import get_image
from ratd.engine.layout import CONTACTS
from ratd.experiments.compression.run import Cluster, compress
from ratd.experiments.compression.steps import LongSteps
from ratd.experiments.compression.strain import state_of
from ratd.experiments.compression.stretch import stretch
from ratd.experiments.relax import relax
from ratd.experiments.spin_up import plan as plans
from ratd.experiments.spin_up.cells import TYPES
from ratd.experiments.spin_up.grow import grown
from ratd.experiments.spin_up.pulled import AXES, KIND, VARIANTS, WAYS, outer_radius
from ratd.geometry.shape import principal_axes
from ratd.pipeline.provenance import source_hash
from ratd.pipeline.queue import Table, Task, command, key
from ratd.validation.by_ends import HELD, lever, pull_by_ends

__all__ = ["BOX", "DATA", "ENDS", "by_its_ends", "in_the_box", "main", "pulled", "tasks"]

CONFIG = ("config/config.yaml", "config/spin_up.yaml")
DATA = "docs/reproduction/data/pulled"
MATERIALS = ("q-S", "a-C")
SIZES_NM = (200, 300, 400)
SEEDS = range(4)
BOX = {
    "usual": {"part": 1.0, "squeeze_rate": 5e-6, "strain_rate": 3e-6, "up_to_nm": 400},
    "slow": {"part": 1.0, "squeeze_rate": 2e-6, "strain_rate": 1e-6, "up_to_nm": 300},
    "less": {"part": 0.8, "squeeze_rate": 5e-6, "strain_rate": 3e-6, "up_to_nm": 300},
    "more": {"part": 1.2, "squeeze_rate": 5e-6, "strain_rate": 3e-6, "up_to_nm": 300},
}
"""Pulls in the box: filling factor over that of the grain, the strain rates C_v, and the largest grains."""
ENDS = {
    "usual": {"part": HELD, "strain_rate": 1e-6},
    "slow": {"part": HELD, "strain_rate": 3e-7},
    "less": {"part": 0.15, "strain_rate": 1e-6},
    "more": {"part": 0.35, "strain_rate": 1e-6},
}
"""Pulls by the ends: part of the mass held at each, and the strain rate; the usual one along all three axes."""
DENSEST = 0.62
"""Filling factor above which no grain is squeezed."""
STEPS = LongSteps(strain=6e-6, until_phi=1.0)
"""Steps in the box: the smallest monomers would make explicit ones far too short."""
FIRST_STEPS = {"longest": 3.0, "displacement": 0.5, "calming": 0.1, "until_phi": 1.0}
"""The long steps that the first rows were made with, and that the tables are known by. Those of `STEPS` give
1.04 +- 0.10 times the strength of 12 grains of 200 nm, geometric mean, so that rows of both stand in a table."""
_AXIS = {"shortest": 2, "middle": 0, "longest": 1}
"""Coordinates of a relaxed grain along its axes, see `ratd.experiments.relax.relax`."""


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
    source = source_hash(modules=["ratd.validation.pulling"])
    tables = {(material, kind): _table(plan, data, material, kind) for material in MATERIALS for kind in TYPES}
    return [
        Task(
            tables[material, kind], key(size * NM, seed), partial(pulled, plan.grow(material, kind, size), seed, source)
        )
        for seed in SEEDS
        for size in SIZES_NM
        for material in MATERIALS
        for kind in TYPES
    ]


def _table(plan, data, material, kind):
    """The table of a material and type."""
    settings = {"growth": plan.growth(material, kind), "box": BOX, "ends": ENDS, "steps": FIRST_STEPS}
    return Table(Path(data, f"{material}_{kind}.nc"), KIND, ("a_eff", "seed"), plan.materials[material], settings)


def pulled(growth, seed, source=""):
    """All pulls of one grain, as a row of a table.

    Parameters
    ----------
    growth : dict
        As `ratd.experiments.spin_up.grow.grown` takes it.
    seed : int
    source : str
        Hash of the source.

    Returns
    -------
    row : xarray.Dataset
        Of the kind ``pulled``.
    sentence : str
    """
    grain = grown(growth, seed)
    pulls = in_the_box(grain) + by_its_ends(grain)
    row = xr.Dataset(
        {name: ("pull", np.array([pull[name] for pull in pulls])) for name in pulls[0]},
        attrs={"material": grain.material.name, "type": grain.type},
    )
    for name, words in (("way", WAYS), ("axis", AXES), ("variant", VARIANTS)):
        row[name] = ("pull", np.array([words.index(word) for word in row[name].values], dtype="i1"))
    own = {
        "a_eff": growth["a_eff"],
        "seed": seed,
        "filling_factor": grain.shape.filling_factor,
        "mean_monomer_radius": float(np.mean(grain.radius)),
        "n_monomers": grain.n_monomers,
        "n_contacts": grain.n_contacts,
        "source": source,
    }
    row = row.assign(own)
    by_way = {pull["way"]: pull["strength"] for pull in pulls if _counts(pull)}
    return row, (
        f"{grain.material.name} {grain.type} {grain.a_eff / NM:.0f} nm seed {seed}: "
        + ", ".join(f"{way} {strength:.3g} Pa" for way, strength in by_way.items())
    )


def _counts(pull):
    return pull["variant"] == "usual" and pull["axis"] == "longest"


def _pull(**values):
    """A pull, NaN where it has no value."""
    names = ("squeeze_rate", "peak", "residual", "kept", "new", "across", "unequal", "omega")
    return dict.fromkeys(names, np.nan) | values


def in_the_box(grain, variants=BOX):
    """Pulls of a grain in the growing box.

    Parameters
    ----------
    grain : ratd.Grain
    variants : dict
        As `BOX`.

    Returns
    -------
    list of dict
        The variants that are wanted of a grain of this size, and possible with its filling factor.
    """
    grain = lengthwise(grain)
    own = grain.shape.filling_factor
    found = []
    for name, how in variants.items():
        phi = how["part"] * own
        if grain.a_eff > 1.001 * how["up_to_nm"] * NM or phi > DENSEST:
            continue
        squeezed = compress(grain, how["squeeze_rate"], phi, snapshots=(), balance=False, long_steps=STEPS)
        run = stretch(squeezed, how["strain_rate"], long_steps=STEPS)
        about = run.attrs
        found.append(
            _pull(
                way="box",
                axis="longest",
                variant=name,
                **{word: how[word] for word in ("part", "squeeze_rate", "strain_rate")},
                phi=about["phi_start"],
                strength=about["tensile_strength"],
                strain=float(np.log(about["phi_start"] / about["phi_strength"])),
                peak=float(run["tension"].max()),
                residual=about["residual_pressure"],
                steps=float(squeezed.attrs["steps"] + about["steps"]),
                **became(grain, squeezed),
            )
        )
    return found


def lengthwise(grain):
    """The same grain, turned so that its longest axis lies along x."""
    _, axes = principal_axes(grain.position, grain.mass, grain.radius)
    return grain.replace(position=grain.position @ axes[[2, 0, 1]].T)


def became(grain, squeezed):
    """What became of the contacts of a grain in the box.

    Parameters
    ----------
    grain : ratd.Grain
        Before.
    squeezed : xarray.Dataset
        What `ratd.compress` returned for it.

    Returns
    -------
    dict
        kept, new, across: see `ratd.experiments.spin_up.pulled`.
    """
    state = state_of(squeezed)
    number = state.counter[CONTACTS]
    image = np.array([get_image(state, k) for k in range(number)]).reshape(-1, 3)
    pairs = np.sort(state.identity[np.stack([state.pair_i, state.pair_j], axis=1)[:number].astype(int)], axis=1)
    inside = {tuple(pair) for pair in pairs[(image == 0).all(axis=1)].tolist()}
    before = {tuple(pair) for pair in grain.contacts.tolist()}
    return {
        "kept": len(inside & before) / len(before),
        "new": len(inside - before) / len(before),
        "across": float((image[:, 0] != 0).sum()),
    }


def by_its_ends(grain, variants=ENDS):
    """Pulls of a grain by its ends.

    Parameters
    ----------
    grain : ratd.Grain
    variants : dict
        As `ENDS`.

    Returns
    -------
    list of dict
    """
    state = relax(grain)
    unit = Cluster(grain).time_unit
    phi = grain.shape.filling_factor
    area = np.pi * outer_radius(grain.a_eff, phi) ** 2
    found = []
    for name, how in variants.items():
        for axis in AXES if name == "usual" else ("longest",):
            # the box of the same strain rate grows by 2 C_v/t_0
            pull = pull_by_ends(state, _AXIS[axis], 2.0 * how["strain_rate"] / unit, held=how["part"])
            found.append(
                _pull(
                    way="ends",
                    axis=axis,
                    variant=name,
                    **how,
                    phi=phi,
                    strength=pull.force / area,
                    strain=pull.strain,
                    unequal=pull.unequal,
                    omega=float(np.sqrt(pull.force / lever(state, _AXIS[axis]))),
                    steps=float(pull.steps),
                )
            )
    return found


def main(words=None):
    """The command; returns the exit status, see `ratd.pipeline.queue.command`."""
    return command(
        words, module=sys.modules[__name__], what="grains", config=CONFIG, data=DATA, load=plans.load, tasks=tasks
    )


if __name__ == "__main__":
    sys.exit(main())
