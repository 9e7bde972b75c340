"""Rows of what is known before the spin-up: the ensemble, radii, porosity, time step."""

import numpy as np

from ratd.beyond import SPLIT
from ratd.calibration import PRINTED_STEP
from ratd.ensemble import cell_statistics
from ratd.laws.jkr import dissipation_time
from ratd.materials import equilibrium_contact_radius, reduced_radius
from ratd.reproduction.paper import GRAINS, PRINTED
from ratd.reproduction.text import (
    NOTHING,
    Answer,
    Row,
    answer,
    between,
    near,
    number,
    over,
    range_answer,
    with_error,
)
from ratd.statistics import mean_of, median_of
from ratd.units import NM

POROSITY_REASON = (
    "With 15/(8 pi) in Eq. 3; the printed 5/(4 pi) gives a solid sphere P = -0.84. Single grains spread, small ones "
    "most; “holds” looks at the means of the sizes, to a tenth."
)


def rows(data):
    """Rows that need no spin-up, list of Row."""
    result = [_coverage(data), *_step(data)]
    table = data.grown
    cells = cell_statistics(table, by=("type", "a_eff"))
    mean = mean_of(table["mean_monomer_radius"] / NM)
    printed = PRINTED["mean_radius"]
    result.append(
        Row(
            "mean_radius",
            {
                "": Answer(
                    f"{with_error(*mean)} nm",
                    over(mean[0] * NM, printed.value),
                    near(mean[0] * NM, printed.value),
                )
            },
            "As printed a grain of 500 nm would hold 15 000 monomers; median 20 nm with sigma_ln 0.844 gives the "
            "numbers of Fig. 1.",
        )
    )
    for kind in ("BA", "BAM1", "BAM2"):
        here, own = cells[cells["type"] == kind], table[table["type"] == kind]
        if not len(own):
            continue
        means = between(here["porosity_mean"].min(), here["porosity_mean"].max())
        low, high = own["porosity"].min(), own["porosity"].max()
        keys = [f"porosity_{kind}"] + ["porosity_BAM2_text"] * (kind == "BAM2")
        for key in keys:
            inside = bool(here["porosity_mean"].min() > 0.9 * PRINTED[key].value[0]) and bool(
                here["porosity_mean"].max() < 1.1 * PRINTED[key].value[1]
            )
            found = range_answer(low, high, PRINTED[key], more=f" (means of the sizes {means})", holds=inside)
            result.append(Row(key, {"": found}, POROSITY_REASON))
    result += [Row("porosity_slope", {"": Answer(_porosity_change(table))})]
    fractal = median_of(table.loc[table["type"] == "BA", "fractal_dimension"])
    result.append(
        Row(
            "fractal_BA",
            {"": answer(fractal["median"], fractal["error"], PRINTED["fractal_BA"])},
            "Median; Eq. 8 leaves the fitted range of distances open.",
        )
    )
    return result


def _coverage(data):
    total = PRINTED["ensemble"].value
    found = {drive: Answer(str(len(table)), number(len(table) / total)) for drive, table in data.tables.items()}
    return Row("ensemble", found, "What two cores compute; see the coverage by cell.")


def _step(data):
    radius = 10 * NM
    steps = []
    for name in data.plan.config["materials"]:
        material = data.plan.materials[name]
        R = reduced_radius(radius, radius)
        r0 = equilibrium_contact_radius(R, material.surface_energy, material.reduced_modulus)
        mass = 4 / 3 * np.pi * material.density * radius**3
        steps.append(PRINTED_STEP * dissipation_time(mass, R, r0, material.surface_energy))
    printed = PRINTED["step"]
    ends = (min(steps), max(steps))
    text = f"{between(*(1e12 * end for end in ends))} ps"
    found = Answer(text, over(ends, printed.value), near(ends, printed.value))
    return [Row("step", {"": found}, "Eq. 31 as printed gives parts of a ps; “ns” does not follow from it.")]


def _porosity_change(table):
    """Change of the mean porosity from the sizes around `SPLIT` to the largest size of each type."""
    parts = []
    for kind, own in table.groupby("type", sort=False):
        sizes = own["a_eff"].round(13)
        largest = sizes.max()
        start = min(set(sizes), key=lambda size: abs(size - SPLIT))
        if start == largest:
            start = sizes.min()
        first, last = (mean_of(own.loc[sizes == size, "porosity"]) for size in (start, largest))
        change = with_error(last[0] - first[0], np.hypot(first[1], last[1]))
        parts.append(f"{kind} {change} ({start / NM:g} to {largest / NM:g} nm)")
    return "; ".join(parts)


def figure1_rows(data):
    """Cells of a table in Markdown: the nine grains of Fig. 1, printed and ours, one each.

    Returns
    -------
    list of list of str
        type, size; N_mon, N_con, a_out: printed, ours, ratio.
    """
    result = []
    ours = {(grain.type, round(grain.a_eff / NM)): grain for grain in data.grains}
    for (kind, size), printed in GRAINS.items():
        grain = ours.get((kind, size))
        cells = [kind, str(size)]
        values = (grain.n_monomers, grain.n_contacts, grain.enclosing_radius / NM) if grain else (np.nan,) * 3
        for own, value in zip(values, printed, strict=True):
            cells += [f"{value:g}", f"{own:.4g}" if grain else NOTHING, number(own / value)]
        result.append(cells)
    return result


def contacts_over_printed(data):
    """N_con/N_mon of the grains of Fig. 1 over the printed, list of float; those of the paper's sizes only."""
    over = []
    for grain in data.grains:
        key = (grain.type, round(grain.a_eff / NM))
        if key in GRAINS:
            monomers, contacts, _ = GRAINS[key]
            over.append(grain.n_contacts / grain.n_monomers / (contacts / monomers))
    return over
