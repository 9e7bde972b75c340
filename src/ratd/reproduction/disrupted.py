"""Rows of the spin-up: the course of a disruption, shapes, omega_disr, pairs."""

from dataclasses import replace

import numpy as np

from ratd.beyond import binomial_interval, oblate_counts, slopes
from ratd.ensemble import cell_of, cell_statistics
from ratd.figures.figure8 import predictions
from ratd.figures.figure10 import relative_error
from ratd.marks import disruption
from ratd.reproduction.argument import is_calibrated
from ratd.reproduction.paper import PRINTED
from ratd.reproduction.text import (
    NEAR,
    ROUGHLY,
    Answer,
    Row,
    answer,
    between,
    beyond,
    drive_rows,
    interval,
    near,
    number,
    over,
    range_answer,
    with_error,
)
from ratd.schema import END_REASONS
from ratd.statistics import mean_of, median_of
from ratd.units import NM

LEVEL = (
    "prescribed: a grain that turns as a whole cannot hold the printed omega (What the contacts can hold). literal: it "
    "hardly turns, and omega follows d omega/dt and the step (What the literal drive does)."
)
BAM = ("BAM1", "BAM2")


def rows(data):
    """Rows that need spin-ups, list of Row in the order of the paper."""
    return [_terminal(data), *_course(data), *_shapes(data), *_omega(data), *_parameters(data), *_pairs(data)]


def _terminal(data):
    def evaluate(table, printed):
        kept = int((table["end_reason"] == END_REASONS[1]).sum())
        missing = int(table["omega_disr"].isna().sum())
        return Answer(f"{kept} of {len(table)} reached it; {missing} without omega_disr", holds=not kept + missing)

    return drive_rows("terminal", data.tables, evaluate)


def _median(values, printed, factor=NEAR, holds=None, cell=None):
    """Answer with the median of some values and its bootstrap error; `holds` of (median, error) decides if given."""
    found = median_of(values, cell=cell)
    if not found["n"]:
        return None
    value, error = found["median"], found["error"]
    own = answer(value, error, printed, factor)
    # what `holds` leaves open stays open, however near the value is
    return own if holds is None else replace(own, holds=holds(value, error))


def _of_cell(data):
    """Drive -> table of the grains of the cell of Fig. 4."""
    own = data.plan.config["figures"]["figure4"]
    if own is None:
        return {}
    return {
        drive: table[
            (table["material"] == own["material"])
            & (table["type"] == own["type"])
            & np.isclose(table["a_eff"], own["size_nm"] * NM, rtol=1e-6, atol=0)
        ]
        for drive, table in data.tables.items()
    }


def _course(data):
    cell = _of_cell(data)
    course = {drive: [(run, disruption(run)) for run in runs] for drive, runs in data.course.items()}

    def whole(part):
        def evaluate(runs, printed):
            values = [_mass_at(run, part * float(mark["omega_disr"])) for run, mark in runs]
            values = np.array([value for value in values if np.isfinite(value)])
            if not len(values):
                return None
            middle = float(np.median(values))
            text = f"median {middle:.3f} ({values.min():.3f}–{values.max():.3f})"
            if printed.value:
                return Answer(text, over(middle, printed.value), bool(middle > 1 - 1e-9))
            return Answer(text, holds=bool(middle < 1 - 1e-9))

        return evaluate

    return [
        _onset(data, cell),
        drive_rows(
            "decade",
            cell,
            lambda t, p: _median(t["omega_end"] / t["omega_first_loss"], p, ROUGHLY),
            "The end is one contact left; the last two monomers of a grain can hold to many times omega_disr.",
        ),
        drive_rows(
            "gain",
            {drive: table[table["type"] == "BAM2"] for drive, table in data.tables.items()},
            lambda t, p: _median(
                t["n_contacts_max"] / t["n_contacts"], p, holds=lambda v, e: bool(v > 1), cell=cell_of(t)
            ),
            "The median of all BAM2 grains; monomers of a grain that breaks at its weakest cut hardly move before.",
        ),
        drive_rows(
            "quarter", data.tables, lambda t, p: _median(t["omega_mass_75"] / t["omega_disr"], p, cell=cell_of(t))
        ),
        *(drive_rows(key, course, whole(part)) for key, part in (("whole_01", 0.1), ("whole_08", 0.8))),
        drive_rows("whole_10", course, whole(1.0), "Slow spin-up breaks a grain at its weakest cut."),
        drive_rows(
            "blocks",
            {drive: table[table["half"] & table["type"].isin(BAM)] for drive, table in data.fragments.items()},
            _blocks,
            "Of the first half of the mass that leaves. The paper's run ends when all is apart; pieces that have left "
            "are not spun up further in either.",
        ),
    ]


def _onset(data, cell):
    """Where mass loss begins in Fig. 4, which decides nothing about a drive that was fixed on it."""
    row = drive_rows("onset", cell, lambda t, p: _median(t["omega_first_loss"], p), LEVEL)
    own = row.answers.get("literal")
    if own is None or not is_calibrated(data):
        return row
    fixed = replace(own, text=f"{own.text} (fixed on this)", holds=None)
    return replace(row, answers=row.answers | {"literal": fixed})


def _mass_at(run, omega):
    """Part of the mass that the largest fragment holds at the first record from omega [rad/s] on."""
    if not np.isfinite(omega):
        return np.nan
    k = min(int(np.searchsorted(run["omega"].values, omega * (1 - 1e-12))), run.sizes["record"] - 1)
    return float(run["mass"].values[k]) / run.attrs["initial_mass"]


def _blocks(part, printed):
    if not len(part):
        return None
    mass = part["weight"] * part["mass_fraction"]
    share = mass[part["fragment_n_monomers"] == 1].sum() / mass.sum()
    return Answer(number(share), over(share, printed.value), near(share, printed.value))


def _shapes(data):
    tables = data.tables

    def oblate(when, judge, size=None, types=None):
        def evaluate(table, printed):
            if size is not None:
                table = table[np.isclose(table["a_eff"], size * NM, rtol=1e-6, atol=0)]
            if types is not None:
                table = table[table["type"].isin(types)]
            if not len(table):
                return None
            counts = oblate_counts(table.assign(all="all"), by=("all",)).iloc[0]
            k, n = counts[f"{when}_oblate"], counts[f"{when}_known"]
            if not n:
                return None
            text = f"{k} of {n}: {interval(k / n, counts[f'{when}_low'], counts[f'{when}_high'])}"
            ends = counts[f"{when}_low"], counts[f"{when}_high"]
            return Answer(text, over(k / n, printed.value) if printed.value else "–", judge(*ends))

        return evaluate

    def half(low, high):
        return bool(low <= 0.5 <= high)

    def below(low, high):
        return True if high < 0.5 else False if low > 0.5 else None

    def above(low, high):
        return None if below(low, high) is None else not below(low, high)

    def slender(table, printed):
        here = table[np.isin(np.round(table["a_eff"] / NM), (350, 500))]
        ratio = (here["axis_c_start"] / here["axis_b_start"]).dropna()
        k, n = int((ratio < 1.7).sum()), len(ratio)
        return Answer(f"{k} of {n}", holds=above(*binomial_interval(k, n))) if n else None

    def flattest(table, printed):
        here = table[table["type"].isin(BAM)]
        ratio = (here["axis_b_disr"] / here["axis_a_disr"]).dropna()
        if not len(ratio):
            return None
        text = f"{ratio.max():.3g} (median {ratio.median():.3g})"
        return Answer(text, over(ratio.max(), printed.value), near(ratio.max(), printed.value))

    def loosened(types, increase):
        def evaluate(table, printed):
            here = table[table["type"].isin(types)]
            change = mean_of(here["porosity_disr"] - here["porosity_start"], cell_of(here))
            if not np.isfinite(change[0]):
                return None
            found = beyond(*change, 0.0)
            return Answer(with_error(*change), holds=found if increase else not found)

        return evaluate

    # the shape of a grain hardly changes when it comes to rest
    grown = data.grown.assign(**{f"axis_{name}_start": data.grown[f"axis_{name}"] for name in "abc"})
    early = "A grain that breaks at its weakest cut keeps its shape up to then."
    return [
        drive_rows("oblate_start_200", {"": grown}, oblate("start", half, 200)),
        *(drive_rows(f"oblate_start_{size}", {"": grown}, oblate("start", below, size)) for size in (350, 500)),
        drive_rows("c_over_b", {"": grown}, slender),
        drive_rows("oblate_disr", tables, oblate("disr", above, types=BAM), early),
        drive_rows("oblate_disr_BA", tables, oblate("disr", below, 200, ("BA",))),
        drive_rows("b_over_a", tables, flattest, early),
        drive_rows("porosity_change_BA", tables, loosened(("BA",), False)),
        drive_rows("porosity_change_BAM", tables, loosened(BAM, True), early),
    ]


def _omega(data):
    def spread(table, printed):
        values = table["omega_disr"].dropna()
        return range_answer(values.min(), values.max(), printed, ROUGHLY) if len(values) else None

    def means(table, printed):
        values = cell_statistics(table)["omega_disr_mean"].dropna()
        if not len(values):
            return None
        return range_answer(values.min(), values.max(), printed, ROUGHLY, more=" (means of the cells)")

    def flattening(table, printed):
        found = slopes(table)
        parts = [
            f"{row['type']} {with_error(row['above'], row['above_error'])}"
            for _, row in found.iterrows()
            if np.isfinite(row["above"])
        ]
        if not parts:
            return None
        flat = [beyond(row["above"], row["above_error"], 0.0) is None for _, row in found.iterrows()]
        return Answer("; ".join(parts), holds=all(flat))

    return [
        drive_rows("order", data.tables, means, LEVEL),
        drive_rows("range", data.tables, spread, LEVEL + " Eq. 33 with Table 3 itself goes below 5e8 (Fig. 7)."),
        drive_rows("flattening", data.tables, flattening, "See Beyond the paper."),
        drive_rows(
            "withstand",
            data.tables,
            lambda t, p: _over_strengths(data, t, p),
            "The models are scaled at one size: only how omega_disr falls with size counts.",
        ),
    ]


def _over_strengths(data, table, printed):
    """omega_disr over the scaled strength models of Fig. 8 at the largest size."""
    own = data.plan.config["figures"]["figure8"]
    if own is None:
        return None
    here = table[(table["material"] == own["material"]) & (table["type"] == own["type"])]
    if not len(here):
        return None
    cells = cell_statistics(here)
    curves, anchor = predictions(cells, data.plan.materials[own["material"]], own["scaled_at_nm"] * NM)
    ratio = (cells["omega_disr_mean"] / curves.drop(columns="absolute").T).T.iloc[-1].dropna()
    if not len(ratio):
        return None
    text = f"{between(ratio.min(), ratio.max())} ({len(ratio)} models, {cells['a_eff'].iloc[-1] / NM:g} nm)"
    return Answer(text, over(ratio.max(), printed.value), near(ratio.max(), printed.value, ROUGHLY))


def _parameters(data):
    """Rows of Fig. 9: each grain over itself with the paper's xi_c and T_vis."""

    def unchanged(value, error):
        return None if not np.isfinite(error) else bool(abs(value - 1.0) < max(2 * error, 0.02))

    def raised(value, error):
        if not np.isfinite(error):
            return None
        as_printed, none = (abs(value - level) < 2 * error for level in (PRINTED["viscous"].value, 1.0))
        return None if as_printed and none else bool(as_printed)

    def last(column, kinds, holds):
        def evaluate(table, printed):
            here = table[table["type"].isin(kinds) & table["omega_disr_ratio"].notna()]
            here = here[np.isclose(here[column], table[column].max(), rtol=1e-6, atol=0)]
            return _median(here["omega_disr_ratio"], printed, holds=holds)

        return evaluate

    return [
        drive_rows("rolling", data.parameters, last("critical_rolling_displacement", ("BA", "BAM2"), unchanged)),
        drive_rows("viscous", data.parameters, last("viscous_time", ("BAM2",), raised), _weakened(data)),
    ]


def _weakened(data):
    """Words on the step of Fig. 9, which weakens what T_vis stands for."""
    own = data.plan.config["figures"]["figure9"]
    if own is None:
        return ""
    step = {"prescribed": own["timestep_factor"], "literal": own["literal"]["timestep_factor"]}
    steps = ", ".join(f"{step[drive]:g} ({drive})" for drive in data.parameters)
    return (
        "The scheme weakens the damping of the lightest monomers, less so the shorter the step (docs/model.md, The "
        f"scheme): f = {steps}. The paper does not say how it takes the damping, which its Eq. 29 lacks."
    )


def _pairs(data):
    if data.pairs is None:
        return [Row("pairs")]
    table = data.pairs.assign(error=np.abs(relative_error(data.pairs)))
    damped, undamped = (table[table["start"] == start] for start in ("damped", "undamped"))
    against = np.abs(1 - damped["parting_omega"] / damped["eq35_omega"]).max()
    worst = undamped["error"].max()
    text = (
        f"undamped pairs {100 * undamped['error'].max():.2g} %; damped ones {100 * damped['error'].max():.2g} % "
        f"against sqrt(3 pi gamma/2m), and {100 * against:.2g} % against Eq. 35"
    )
    return [
        Row(
            "pairs",
            {"prescribed": Answer(text, over(worst, PRINTED["pairs"].value), bool(worst < PRINTED["pairs"].value))},
            "Eq. 35 takes 5/9 of the pull-off force, the end of the branch, which a damped pair under a slow load "
            "does not need; an undamped pair that vibrates nearly reaches it.",
        )
    ]
