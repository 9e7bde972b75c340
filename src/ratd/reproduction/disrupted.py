"""Rows of the spin-up: the course of a disruption, shapes, omega_disr, pairs."""

import numpy as np

from ratd.beyond import oblate_counts, slopes
from ratd.ensemble import cell_statistics
from ratd.figures.figure8 import predictions
from ratd.figures.figure10 import relative_error
from ratd.marks import disruption
from ratd.reproduction.paper import PRINTED
from ratd.reproduction.text import (
    Answer,
    Row,
    answer,
    between,
    drive_rows,
    interval,
    mean_and_error,
    number,
    over,
    range_answer,
    with_error,
)
from ratd.schema import END_REASONS
from ratd.units import NM
from ratd.validation.statistics import median_of

LEVEL = (
    "A grain that turns as a whole cannot hold the printed omega (see below); the printed equations hardly make it "
    "turn."
)
BAM = ("BAM1", "BAM2")


def rows(data):
    """Rows that need spin-ups, list of Row in the order of the paper."""
    return [_terminal(data), *_course(data), *_shapes(data), *_omega(data), *_parameters(data), *_pairs(data)]


def _terminal(data):
    def evaluate(table, printed):
        kept = int((table["end_reason"] == END_REASONS[1]).sum())
        missing = int(table["omega_disr"].isna().sum())
        return Answer(f"{kept} of {len(table)} reached it; {missing} without omega_disr")

    return drive_rows("terminal", data.tables, evaluate)


def _median(values, printed):
    """Answer with the median of some values and its bootstrap error."""
    found = median_of(values)
    return answer(found["median"], found["error"], printed) if found["n"] else None


def _of_cell(data):
    """Drive -> table of the grains of the cell of Fig. 4."""
    own = data.plan.config["figures"]["figure4"]
    if own is None:
        return {}
    return {
        drive: table[
            (table["material"] == own["material"])
            & (table["type"] == own["type"])
            & np.isclose(table["a_eff"], own["size_nm"] * NM, rtol=1e-6)
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
            text = f"median {np.median(values):.3f} ({values.min():.3f}–{values.max():.3f})"
            return Answer(text, over(float(np.median(values)), printed.value) if printed.value else "–")

        return evaluate

    return [
        drive_rows("onset", cell, lambda t, p: _median(t["omega_first_loss"], p), LEVEL),
        drive_rows(
            "decade",
            cell,
            lambda t, p: _median(t["omega_end"] / t["omega_first_loss"], p),
            "The end is one contact left; the last two monomers of a grain can hold to many times omega_disr.",
        ),
        drive_rows(
            "gain",
            {drive: table[table["type"] == "BAM2"] for drive, table in data.tables.items()},
            lambda t, p: _median(t["n_contacts_max"] / t["n_contacts"], p),
        ),
        drive_rows("quarter", data.tables, lambda t, p: _median(t["omega_mass_75"] / t["omega_disr"], p)),
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


def _mass_at(run, omega):
    """Part of the mass that the largest fragment holds at the first record from omega [rad/s] on."""
    if not np.isfinite(omega):
        return np.nan
    k = min(int(np.searchsorted(run["omega"].values, omega * (1 - 1e-12))), run.sizes["record"] - 1)
    return float(run["mass"].values[k]) / run.attrs["initial_mass"]


def _blocks(part, printed):
    if not len(part):
        return None
    share = part.loc[part["fragment_n_monomers"] == 1, "mass_fraction"].sum() / part["mass_fraction"].sum()
    return Answer(number(share), over(share, printed.value))


def _shapes(data):
    tables = data.tables

    def oblate(when, size=None, types=None):
        def evaluate(table, printed):
            if size is not None:
                table = table[np.isclose(table["a_eff"], size * NM, rtol=1e-6)]
            if types is not None:
                table = table[table["type"].isin(types)]
            if not len(table):
                return None
            counts = oblate_counts(table.assign(all="all"), by=("all",)).iloc[0]
            k, n = counts[f"{when}_oblate"], counts[f"{when}_known"]
            if not n:
                return None
            text = f"{k} of {n}: {interval(k / n, counts[f'{when}_low'], counts[f'{when}_high'])}"
            return Answer(text, over(k / n, printed.value) if printed.value else "–")

        return evaluate

    def slender(table, printed):
        here = table[np.isin(np.round(table["a_eff"] / NM), (350, 500))]
        ratio = (here["axis_c_start"] / here["axis_b_start"]).dropna()
        return Answer(f"{int((ratio < 1.7).sum())} of {len(ratio)}") if len(ratio) else None

    def flattest(table, printed):
        here = table[table["type"].isin(BAM)]
        ratio = (here["axis_b_disr"] / here["axis_a_disr"]).dropna()
        if not len(ratio):
            return None
        text = f"{ratio.max():.3g} (median {ratio.median():.3g})"
        return Answer(text, over(ratio.max(), printed.value))

    def loosened(types):
        def evaluate(table, printed):
            here = table[table["type"].isin(types)]
            change = mean_and_error(here["porosity_disr"] - here["porosity_start"])
            return Answer(with_error(*change)) if np.isfinite(change[0]) else None

        return evaluate

    early = "Slow grains break before they deform much; the literal ones are shaken rather than turned."
    return [
        *(drive_rows(f"oblate_start_{size}", tables, oblate("start", size)) for size in (200, 350, 500)),
        drive_rows("c_over_b", tables, slender),
        drive_rows("oblate_disr", tables, oblate("disr", types=BAM)),
        drive_rows("oblate_disr_BA", tables, oblate("disr", 200, ("BA",))),
        drive_rows("b_over_a", tables, flattest, early),
        drive_rows("porosity_change_BA", tables, loosened(("BA",))),
        drive_rows("porosity_change_BAM", tables, loosened(BAM)),
    ]


def _omega(data):
    def spread(table, printed):
        values = table["omega_disr"].dropna()
        return range_answer(values.min(), values.max(), printed) if len(values) else None

    def means(table, printed):
        values = cell_statistics(table)["omega_disr_mean"].dropna()
        return range_answer(values.min(), values.max(), printed, " (means of the cells)") if len(values) else None

    def flattening(table, printed):
        found = slopes(table)
        parts = [
            f"{row['type']} {with_error(row['above'], row['above_error'])}"
            for _, row in found.iterrows()
            if np.isfinite(row["above"])
        ]
        return Answer("; ".join(parts)) if parts else None

    return [
        drive_rows("order", data.tables, means, LEVEL),
        drive_rows("range", data.tables, spread, LEVEL + " Eq. 33 with Table 3 itself goes below 5e8 (Fig. 7)."),
        drive_rows("flattening", data.tables, flattening, "See Beyond the paper."),
        drive_rows("withstand", data.tables, lambda t, p: _over_strengths(data, t, p)),
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
    return Answer(text, over(ratio.max(), printed.value))


def _parameters(data):
    """Rows of Fig. 9: each grain over itself with the paper's xi_c and T_vis."""

    def last(column, kinds):
        def evaluate(table, printed):
            here = table[table["type"].isin(kinds) & table["omega_disr_ratio"].notna()]
            here = here[np.isclose(here[column], table[column].max())]
            return _median(here["omega_disr_ratio"], printed)

        return evaluate

    return [
        drive_rows("rolling", data.parameters, last("critical_rolling_displacement", ("BA", "BAM2"))),
        drive_rows("viscous", data.parameters, last("viscous_time", ("BAM2",))),
    ]


def _pairs(data):
    if data.pairs is None:
        return [Row("pairs")]
    table = data.pairs.assign(error=np.abs(relative_error(data.pairs)))
    damped, undamped = (table[table["start"] == start] for start in ("damped", "undamped"))
    against = np.abs(1 - damped["parting_omega"] / damped["eq35_omega"]).max()
    text = (
        f"undamped pairs {100 * undamped['error'].max():.2g} %; damped ones {100 * damped['error'].max():.2g} % "
        f"against sqrt(3 pi gamma/2m), and {100 * against:.2g} % against Eq. 35"
    )
    return [
        Row(
            "pairs",
            {"prescribed": Answer(text, over(undamped["error"].max(), PRINTED["pairs"].value))},
            "Eq. 35 takes 5/9 of the pull-off force, the end of the branch, which a damped pair under a slow load "
            "does not need; an undamped pair that vibrates nearly reaches it.",
        )
    ]
