"""What to use for omega_disr: the consistent model in a few numbers, and how far they can be trusted."""

import numpy as np

from ratd.beyond import SPLIT, size_law
from ratd.ensemble import cell_of
from ratd.markdown import markdown_table
from ratd.reproduction.bounds import sizes_of, whole_nm
from ratd.reproduction.open_questions import least_of
from ratd.reproduction.text import NOTHING, between, number, with_error
from ratd.statistics import mean_of, median_of
from ratd.units import NM
from ratd.validation.show.convergence import large_shifts, percent

NAMES = {"omega_mass_75": "loss of a quarter of the mass", "omega_disr": "omega_disr"}
"""Marks that are told of, in the order in which they are recommended."""
BY_TYPE = "cut bound by type"
"""Of `ratd.beyond.PREDICTORS`."""
SURE = 10
"""Grains of a cell below which its median is marked."""


def recommended_section(data):
    """Numbers for whoever needs omega_disr of a grain that turns as a whole, paragraphs of Markdown.

    Parameters
    ----------
    data : ratd.reproduction.data.Data

    Returns
    -------
    list of str
        Empty without the drive `prescribed`.
    """
    table = data.tables.get("prescribed")
    if table is None:
        return []
    medians = _medians(table)
    legend = f" (*: fewer than {SURE} grains)" if "*" in medians else ""
    return [
        "For a grain that radiation spins up as a whole take the drive `prescribed`: omega = C sqrt(gamma/(rho a³)) "
        f"(a_eff/a)^-p with a = {SPLIT / NM:g} nm, gamma and rho from Table 2, and",
        _laws(data, table),
        _trust(data, table),
        *_with_a_grain(data, table),
        f"The median omega of each cell, in 1e6 rad/s, at the {NAMES['omega_mass_75']} and, in brackets, at omega_disr"
        f"{legend}:",
        medians,
    ]


def _laws(data, table):
    rows = []
    for mark, name in NAMES.items():
        for _, law in size_law(table, mark, data.plan.materials).iterrows():
            values = [with_error(law[key], law[f"{key}_error"]) for key in ("C", "p")]
            rows.append([name, law["type"], *values, f"{np.exp(law['scatter']):.2f}", str(law["n_grains"])])
    head = ["mark", "type", "C", "p", "single grains are off by a factor of", "grains"]
    return markdown_table(head, rows)


def _trust(data, table):
    """A paragraph: for what grains the numbers hold, and what is known to be wrong with them."""
    low, high = table["mean_monomer_radius"].quantile([0.16, 0.84]) / NM
    words = (
        f"It holds for {sizes_of(table)} and grains grown as here, whose monomers have mean radii of "
        f"{between(low, high)} nm (middle two thirds of the grains). "
    )
    found = data.predictions["prescribed"]["size"].query("type == 'all'").set_index("predictor")
    misses = [
        f"{with_error(*found.loc[name, ['scatter', 'error']])} ({what})"
        for name, what in (("power of size", "this law"), ("Eq. 33", "Eq. 33, A and alpha fitted anew"))
        if np.isfinite(found.loc[name, "scatter"])
    ]
    if misses:
        words += f"For sizes left out of the fit ln omega_disr is off by {', '.join(misses)}. "
    shifts = [
        f"{percent(shift)} % ({kind} of {size:g} nm)"
        for kind, size, shift in large_shifts(data.study("convergence"), "omega_disr")
    ]
    if shifts:
        words += f"The spin-up is not slow enough for large grains: omega_disr is too high by {', '.join(shifts)}. "
    return words + (
        "The loss of a quarter of the mass is the better mark where the two differ, which is in large BA grains: their "
        "stress peaks in a remnant."
    )


def _with_a_grain(data, table):
    """A paragraph: for which types the cut bound of a grain tells more than its size, and what it is to be times."""
    found = data.predictions["prescribed"]["size"]
    kinds = [kind for kind, part in found.groupby("type", sort=False) if least_of(part) == BY_TYPE and kind != "all"]
    if not kinds:
        return []
    told = []
    for kind in kinds:
        own = table[table["type"] == kind]
        cell = cell_of(own)
        means = [np.exp(mean_of(np.log(own[mark] / own["cut_bound"]), cell)[0]) for mark in NAMES]
        told.append(f"{kind} {' and '.join(map(number, means))}")
    return [
        "Where the contacts of a grain are known, its cut bound (`ratd.bound.cut_bound`) tells more than its size "
        f"does, for {' and '.join(kinds)}: {' and '.join(NAMES.values())} lie at so many times it, in geometric means: "
        f"{'; '.join(told)}."
    ]


def _medians(table):
    sizes = np.unique(whole_nm(table))
    rows = []
    for (material, kind), part in table.groupby(["material", "type"], sort=False):
        cells = []
        for size in sizes:
            own = part[whole_nm(part) == size]
            quarter, peak = (median_of(own[mark] / 1e6)["median"] for mark in NAMES)
            few = "*" if 0 < len(own) < SURE else ""
            cells.append(f"{number(quarter)} ({number(peak)}){few}" if len(own) else NOTHING)
        rows.append([material, kind, *cells])
    return markdown_table(["material", "type", *(f"{size} nm" for size in sizes)], rows)
