"""What a config of the spin-up must hold beyond its schema: cells, seeds and materials that there are."""

import math

from ratd.aggregates.growth import MOST_MONOMERS, check_a_eff, smallest_a_eff
from ratd.aggregates.radii import RadiusDistribution
from ratd.base.checks import GREATEST_SEED
from ratd.base.errors import InputError
from ratd.base.units import NM
from ratd.experiments.spin_up.seeds import cell_of, size_label
from ratd.pipeline.config import left_out

__all__ = ["check", "leave_out_absent"]

_WHERE = "config: spin_up"


def check(plan, materials_file):
    """Raise InputError, with a sentence for each key of a plan that is wrong.

    Parameters
    ----------
    plan : ratd.experiments.spin_up.plan.Plan
    materials_file : str
        Where a user adds materials, for the message.
    """
    mistakes = [
        *_materials(plan, materials_file),
        *_sizes(plan),
        *_paces(plan),
        *_seeds(plan),
        *_fewer(plan),
        *(mistake for k in range(len(plan.snapshot_grains)) for mistake in _snapshot(plan, k)),
        *(mistake for name in plan.config["figures"] for mistake in _figure(plan, name)),
    ]
    if mistakes:
        raise InputError("\n".join(f"{_WHERE}{mistake}" for mistake in mistakes))


def leave_out_absent(plan, base):
    """Leave out figures and snapshots that stand in the base file and name cells which the config does not have.

    Parameters
    ----------
    plan : ratd.experiments.spin_up.plan.Plan
        Its config is changed.
    base : dict
        Keys of the spin-up in the file that comes with ratd.

    Returns
    -------
    list of str
        A sentence for each part that is left out.
    """
    config = plan.config
    absent = [
        k
        for k, grain in enumerate(plan.snapshot_grains)
        if grain in base["snapshots"]["grains"] and any(_snapshot(plan, k))
    ]
    notes = [left_out(f"spin_up.snapshots.grains[{k}]", next(_snapshot(plan, k))) for k in absent]
    if absent:
        grains = [grain for k, grain in enumerate(plan.snapshot_grains) if k not in absent]
        config["snapshots"] = config["snapshots"] | {"grains": grains}
    for name, own in config["figures"].items():
        mistake = next(_figure(plan, name), None)
        if mistake and own == base["figures"].get(name):
            config["figures"] = config["figures"] | {name: None}
            notes.append(left_out(f"spin_up.figures.{name}", mistake))
    return notes


def _materials(plan, materials_file):
    for k, name in enumerate(plan.config["materials"]):
        if name not in plan.materials:
            known = f"{', '.join(plan.materials)}, or a material added to {materials_file}"
            yield f".materials[{k}] is {name!r}; allowed: {known}"


def _sizes(plan):
    try:
        radii = RadiusDistribution(**plan.radii)
    except InputError as error:
        yield f".growth: {error}"
        return
    largest = (MOST_MONOMERS * radii.moment(3)) ** (1 / 3) / NM
    sizes = plan.config["sizes_nm"]
    labels, keys = list(map(size_label, sizes)), [round(1e3 * size) for size in sizes]
    for k, size in enumerate(sizes):
        where = f".sizes_nm[{k}] is {size!r}"
        if labels[k] in labels[:k]:
            yield f"{where}, which is the size {labels[k]} nm again; allowed: different sizes"
        elif keys[k] in keys[:k]:
            yield f"{where}, which is within a picometre of another; allowed: sizes that differ by more"
        if size > largest:
            yield f"{where}; allowed: at most {math.floor(largest)} nm, the size of {MOST_MONOMERS} monomers"
            continue
        for kind in plan.config["types"]:
            smallest = smallest_a_eff(kind, radii) / NM
            # the size itself has no room for different radii: all monomers would have to be of the smallest one
            if not size > smallest * (1 + 1e-9):
                yield (
                    f"{where}; allowed: above {math.ceil(100 * smallest) / 100:g} nm, the size of the fewest monomers "
                    f"that {kind} is made of"
                )
                continue
            try:
                check_a_eff(size * NM, kind, radii)
            except InputError as error:
                yield f"{where}: {error}"
                break


def _paces(plan):
    for drive in plan.config["drives"]:
        where = "run and literal together" if drive == "literal" else "run"
        for kind in plan.config["types"]:
            laws = {key: plan.spin_up_of(drive, kind)[key] for key in ("stretch", "epsilon", "angular_acceleration")}
            if drive == "literal" and laws["stretch"] is not None or drive == "torque" and laws["stretch"] is None:
                wanted = "null for stretch, since it does not wait" if drive == "literal" else "a number for stretch"
                yield f": {where} give {laws} for the drive {drive}; allowed: {wanted}"
                break
            if sum(value is not None for value in laws.values()) != 1:
                yield f": {where} give {laws} for {kind}; allowed: a number for one of them and null for the others"
                break  # it is much the same for the other types


def _seeds(plan):
    if plan.seeds[-1] > GREATEST_SEED:
        yield f".seeds: the last one is {plan.seeds[-1]}; allowed: seeds up to {GREATEST_SEED}"


def _fewer(plan):
    """What is wrong where `seeds.fewer` names what the ensemble does not have, or leaves a drive no grain."""
    for k, entry in enumerate(plan.fewer):
        where = f".seeds.fewer[{k}]"
        for key in ("drives", "materials", "types", "sizes_nm"):
            yield from _missing_ones(plan, entry.get(key, ()), key, f"{where}.{key}")
        if entry["number"] > len(plan.seeds):
            yield f"{where}.number is {entry['number']}; allowed: 0 to {len(plan.seeds)}"
    for drive in plan.config["drives"]:
        if not plan.cells_of(drive):
            yield f".seeds.fewer leaves no grain for the drive {drive}; allowed: at least one cell with seeds"


def _snapshot(plan, k):
    grain, where = plan.snapshot_grains[k], f".snapshots.grains[{k}]"
    yield from _missing_cell(plan, grain, where)
    yield from _missing_seed(grain["seed"], plan.seeds_of(cell_of(grain)), f"{where}.seed")


def _figure(plan, name):
    """What is wrong with one figure."""
    own = plan.config["figures"][name]
    if own is not None and name in _FIGURES:
        yield from _FIGURES[name](plan, own, f".figures.{name}")


def _figure1(plan, own, where):
    yield from _missing(plan, own["material"], "materials", f"{where}.material")
    yield from _missing_ones(plan, own["sizes_nm"], "sizes_nm", f"{where}.sizes_nm")
    yield from _missing_seed(own["seed"], plan.seeds, f"{where}.seed")


def _figure4(plan, own, where):
    yield from _missing_cell(plan, own, where)
    for drive in plan.config["drives"]:
        if not plan.seeds_of(cell_of(own), drive):
            yield (
                f"{where} is a cell that seeds.fewer leaves out for the drive {drive}; "
                "allowed: a cell with grains for every drive, or null"
            )


def _figure5(plan, own, where):
    key = (cell_of(own), own["seed"])
    if key not in [(cell_of(grain), grain["seed"]) for grain in plan.snapshot_grains]:
        yield f"{where} is {own}; allowed: one of snapshots.grains, or null"
        return
    for drive in plan.config["drives"]:
        yield from _missing_seed(own["seed"], plan.seeds_of(cell_of(own), drive), f"{where}.seed (drive {drive})")


def _figure6(plan, own, where):
    yield from _missing(plan, own["material"], "materials", f"{where}.material")
    yield from _missing_ones(plan, own["sizes_nm"], "sizes_nm", f"{where}.sizes_nm")


def _figure8(plan, own, where):
    for name, key in (("material", "materials"), ("type", "types"), ("scaled_at_nm", "sizes_nm")):
        yield from _missing(plan, own[name], key, f"{where}.{name}")


def _formulae(plan, own, where):
    yield from _missing(plan, own["material"], "materials", f"{where}.material")
    for key in ("types", "sizes_nm"):
        yield from _missing_ones(plan, own[key], key, f"{where}.{key}")


def _figure9(plan, own, where):
    yield from _formulae(plan, own, where)
    if "sizes_nm" in own["literal"]:
        yield from _missing_ones(plan, own["literal"]["sizes_nm"], "sizes_nm", f"{where}.literal.sizes_nm")


def _calibration(plan, own, where):
    yield from _missing_cell(plan, own, where)
    labels = plan.calibration_labels
    for k, label in enumerate(labels):
        if label in labels[:k]:
            yield (
                f"{where}.runs[{k}] has the angular_acceleration and timestep_factor of an earlier one; "
                "allowed: each pair once, for whichever seeds"
            )


_FIGURES = {
    "figure4": _figure4,
    "figure6": _figure6,
    "figure1": _figure1,
    "figure5": _figure5,
    "figure8": _figure8,
    "figure9": _figure9,
    "formulae": _formulae,
    "calibration": _calibration,
}
"""Key of `figures` -> what checks it; of figure 10 its schema says all."""


def _missing(plan, value, key, where):
    """A sentence where a value is none of those that the ensemble has under a key; sizes by their labels."""
    allowed = plan.config[key]
    label = size_label if key == "sizes_nm" else str
    if label(value) not in map(label, allowed):
        yield f"{where} is {value!r}; allowed: one of the {key}, {', '.join(map(str, allowed))}"


def _missing_ones(plan, values, key, where):
    """Sentences for those of a list that the ensemble does not have under a key."""
    for k, value in enumerate(values):
        yield from _missing(plan, value, key, f"{where}[{k}]")


def _missing_seed(seed, seeds, where):
    """A sentence where a seed is none of a range."""
    if seed not in seeds:
        allowed = f"{seeds[0]} to {seeds[-1]}" if seeds else "none, seeds.fewer leaves the cell out"
        yield f"{where} is {seed}; allowed: {allowed}"


def _missing_cell(plan, cell, where):
    """Sentences where the ensemble does not have a cell, a dict with material, type and size_nm."""
    for name, key in (("material", "materials"), ("type", "types"), ("size_nm", "sizes_nm")):
        yield from _missing(plan, cell[name], key, f"{where}.{name}")
