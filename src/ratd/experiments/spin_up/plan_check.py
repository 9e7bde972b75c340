"""What a config of the spin-up must hold beyond its schema: cells, seeds and materials that there are."""

import math

from ratd.aggregates.growth import MOST_MONOMERS, smallest_a_eff
from ratd.aggregates.radii import RadiusDistribution
from ratd.base.errors import InputError
from ratd.base.units import NM
from ratd.experiments.spin_up.seeds import cell_of

__all__ = ["check"]

_WHERE = "config: spin_up"


def check(plan, materials_file):
    """Raise InputError, with one sentence, for the first key of a plan that is wrong.

    Parameters
    ----------
    plan : ratd.experiments.spin_up.plan.Plan
    materials_file : str
        Where a user adds materials, for the message.
    """
    for k, name in enumerate(plan.config["materials"]):
        if name not in plan.materials:
            raise InputError(
                f"{_WHERE}.materials[{k}] is {name!r}; "
                f"allowed: {', '.join(plan.materials)}, or a material added to {materials_file}"
            )
    _check_sizes(plan)
    _check_paces(plan)
    _check_fewer(plan)
    for k, grain in enumerate(plan.config["snapshots"]["grains"]):
        _find_cell(plan, grain, f"snapshots.grains[{k}]")
        _find_seed(grain["seed"], plan.seeds_of(cell_of(grain)), f"snapshots.grains[{k}].seed")
    for name, check_own in _FIGURES.items():
        own = plan.config["figures"][name]
        if own is not None:
            check_own(plan, own, f"figures.{name}")


def _check_sizes(plan):
    try:
        radii = RadiusDistribution(**plan.radii)
    except InputError as error:
        raise InputError(f"{_WHERE}.growth: {error}") from error
    largest = (MOST_MONOMERS * radii.moment(3)) ** (1 / 3) / NM
    for k, size in enumerate(plan.config["sizes_nm"]):
        where = f"{_WHERE}.sizes_nm[{k}] is {size!r}"
        if size > largest:
            raise InputError(
                f"{where}; allowed: at most {math.floor(largest)} nm, the size of {MOST_MONOMERS} monomers"
            )
        for kind in plan.config["types"]:
            smallest = smallest_a_eff(kind, radii) / NM
            # the size itself has no room for different radii: all monomers would have to be of the smallest one
            if not size > smallest * (1 + 1e-9):
                raise InputError(
                    f"{where}; allowed: above {math.ceil(100 * smallest) / 100:g} nm, the size of the fewest monomers "
                    f"that {kind} is made of"
                )


def _check_paces(plan):
    for drive in plan.config["drives"]:
        where = "run and literal together" if drive == "literal" else "run"
        for kind in plan.config["types"]:
            laws = {key: plan.spin_up_of(drive, kind)[key] for key in ("stretch", "epsilon", "angular_acceleration")}
            if drive == "literal" and laws["stretch"] is not None or drive == "torque" and laws["stretch"] is None:
                raise InputError(
                    f"{_WHERE}: {where} give {laws} for the drive {drive}; allowed: "
                    + ("null for stretch, since it does not wait" if drive == "literal" else "a number for stretch")
                )
            if sum(value is not None for value in laws.values()) != 1:
                raise InputError(
                    f"{_WHERE}: {where} give {laws} for {kind}; "
                    "allowed: a number for one of them and null for the others"
                )


def _check_fewer(plan):
    """Raise InputError unless `seeds.fewer` names what the ensemble has, and leaves each drive a grain."""
    for k, entry in enumerate(plan.fewer):
        where = f"seeds.fewer[{k}]"
        for key in ("drives", "materials", "types", "sizes_nm"):
            _find_each(plan, entry.get(key, ()), key, f"{where}.{key}")
        if entry["number"] > len(plan.seeds):
            raise InputError(f"{_WHERE}.{where}.number is {entry['number']}; allowed: 0 to {len(plan.seeds)}")
    for drive in plan.config["drives"]:
        if not plan.cells_of(drive):
            raise InputError(
                f"{_WHERE}.seeds.fewer leaves no grain for the drive {drive}; allowed: at least one cell with seeds"
            )


def _check_figure1(plan, own, where):
    _find(plan, own["material"], "materials", f"{where}.material")
    _find_each(plan, own["sizes_nm"], "sizes_nm", f"{where}.sizes_nm")
    _find_seed(own["seed"], plan.seeds, f"{where}.seed")


def _check_figure4(plan, own, where):
    _find_cell(plan, own, where)
    for drive in plan.config["drives"]:
        if not plan.seeds_of(cell_of(own), drive):
            raise InputError(
                f"{_WHERE}.{where} is a cell that seeds.fewer leaves out for the drive {drive}; "
                "allowed: a cell with grains for every drive, or null"
            )


def _check_figure5(plan, own, where):
    if own not in plan.config["snapshots"]["grains"]:
        raise InputError(f"{_WHERE}.{where} is {own}; allowed: one of snapshots.grains, or null")
    for drive in plan.config["drives"]:
        _find_seed(own["seed"], plan.seeds_of(cell_of(own), drive), f"{where}.seed (drive {drive})")


def _check_figure6(plan, own, where):
    _find(plan, own["material"], "materials", f"{where}.material")
    _find_each(plan, own["sizes_nm"], "sizes_nm", f"{where}.sizes_nm")


def _check_figure8(plan, own, where):
    for name, key in (("material", "materials"), ("type", "types"), ("scaled_at_nm", "sizes_nm")):
        _find(plan, own[name], key, f"{where}.{name}")


def _check_formulae(plan, own, where):
    _find(plan, own["material"], "materials", f"{where}.material")
    for key in ("types", "sizes_nm"):
        _find_each(plan, own[key], key, f"{where}.{key}")


def _check_figure9(plan, own, where):
    _check_formulae(plan, own, where)
    _find_each(plan, plan.parameter_sizes("literal"), "sizes_nm", f"{where}.literal.sizes_nm")


def _check_calibration(plan, own, where):
    _find_cell(plan, own, where)
    labels = plan.calibration_labels
    for k, label in enumerate(labels):
        if label in labels[:k]:
            raise InputError(
                f"{_WHERE}.{where}.runs[{k}] has the angular_acceleration and timestep_factor of an earlier one; "
                "allowed: each pair once, for whichever seeds"
            )


_FIGURES = {
    "figure4": _check_figure4,
    "figure6": _check_figure6,
    "figure1": _check_figure1,
    "figure5": _check_figure5,
    "figure8": _check_figure8,
    "figure9": _check_figure9,
    "formulae": _check_formulae,
    "calibration": _check_calibration,
}
"""Key of `figures` -> what checks it; of figure 10 its schema says all."""


def _find(plan, value, key, where):
    """Raise InputError unless a value is one of those that the ensemble has under a key."""
    allowed = plan.config[key]
    if value not in allowed:
        raise InputError(f"{_WHERE}.{where} is {value!r}; allowed: one of the {key}, {', '.join(map(str, allowed))}")


def _find_each(plan, values, key, where):
    """Raise InputError unless each of a list is one of those that the ensemble has under a key."""
    for k, value in enumerate(values):
        _find(plan, value, key, f"{where}[{k}]")


def _find_seed(seed, seeds, where):
    """Raise InputError unless a seed is one of a range."""
    if seed not in seeds:
        allowed = f"{seeds[0]} to {seeds[-1]}" if seeds else "none, seeds.fewer leaves the cell out"
        raise InputError(f"{_WHERE}.{where} is {seed}; allowed: {allowed}")


def _find_cell(plan, cell, where):
    """Raise InputError unless the ensemble has a cell, a dict with material, type and size_nm."""
    for name, key in (("material", "materials"), ("type", "types"), ("size_nm", "sizes_nm")):
        _find(plan, cell[name], key, f"{where}.{name}")
