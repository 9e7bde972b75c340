"""Rows of omega_disr: its level and how it goes with size, the parameters of Fig. 9, pairs."""

import numpy as np
import pandas as pd

from ratd.beyond import LEFT_OUT, SEPARATE, SPLIT, cross_validation, eq33_omega, fitted_numbers, slopes
from ratd.ensemble import cell_of, cell_statistics, radius_of_reading, size_key
from ratd.figures.figure10 import PAPER_ERROR, relative_error
from ratd.markdown import plural
from ratd.parameters import MARKS
from ratd.reproduction import course, peak, shapes
from ratd.reproduction.bounds import printed_slopes, sizes_of, table3_omega
from ratd.reproduction.course import BAM, LEVEL
from ratd.reproduction.paper import PRINTED
from ratd.reproduction.rate import is_calibrated
from ratd.reproduction.text import (
    ROUGHLY,
    Answer,
    Row,
    all_of,
    between,
    drive_rows,
    lies_between,
    lies_in,
    near,
    number,
    over,
    range_answer,
    with_error,
)
from ratd.schema import END_REASONS
from ratd.statistics import mean_of, median_of
from ratd.tensile import predictions
from ratd.units import NM
from ratd.validation.show import convergence, damping, literal

FLAT = 0.25
"""Slope d ln omega/d ln a_eff that counts as none."""
INDEPENDENT = 0.1
"""Power of d omega/dt that counts as none."""
NO_TREND = PAPER_ERROR
"""Change of omega with xi_c that counts as none: that of App. A, “comparable to the range we observe” for it."""
MATCHES = 0.1
"""Distance of a mean from a fit, over the fit, up to which the fit matches very well."""
FOLDINGS = 5
"""How often the random folds are drawn anew."""
NO_BETTER = 0.95
"""Scatter over that of another fit from which on it is no better than that."""


def rows(data):
    """Rows that need spin-ups, list of Row."""
    own = [_coverage(data), _terminal(data), _drag_time(data), *_omega(data), *_fit(data), *_parameters(data)]
    return [*own, *course.rows(data), *peak.rows(data), *shapes.rows(data)]


def _coverage(data):
    total = PRINTED["ensemble"].value
    found = {drive: Answer(str(len(table)), number(len(table) / total)) for drive, table in data.tables.items()}
    return Row("ensemble", found, "What two cores compute; see the coverage by cell.")


def _terminal(data):
    def evaluate(table, printed):
        kept = int((table["end_reason"] == END_REASONS[1]).sum())
        missing = int(table["omega_disr"].isna().sum())
        return Answer(f"{kept} of {len(table)} reached it; {missing} without omega_disr", holds=not kept + missing)

    return drive_rows("terminal", data.tables, evaluate)


def _drag_time(data):
    """How omega_disr goes with the rate of the spin-up, from the checks of the validation."""

    def prescribed(table, printed):
        found = [
            (kind, size, *convergence.rate_exponent(shift))
            for kind, size, shift in convergence.large_shifts(table, "omega_disr")
        ]
        if not found:
            return None
        text = "; ".join(f"{kind} {size:g} nm {with_error(*value)}" for kind, size, *value in found)
        return Answer(text, holds=all_of(lies_in(*value, -INDEPENDENT, INDEPENDENT) for _, _, *value in found))

    def of_literal(table, printed):
        found = literal.rate_exponent(table, "omega_disr")
        value = found["median"], found["error"]
        return Answer(with_error(*value), holds=lies_in(*value, -INDEPENDENT, INDEPENDENT)) if found["n"] else None

    sources = {"prescribed": (prescribed, data.study("convergence")), "literal": (of_literal, data.study("literal"))}
    sources = {drive: own for drive, own in sources.items() if own[1] is not None and drive in data.tables}
    return drive_rows(
        "drag_time",
        sources,
        lambda source, printed: source[0](source[1], printed),
        "prescribed: at the rate of the ensemble, large grains that were spun up slower as well, of which a single one "
        "has no error; it goes to 0 as the spin-up gets slower. literal: explicit Coriolis term, see What the literal "
        "drive does.",
    )


def _omega(data):
    def spread(table, printed):
        values = table["omega_disr"].dropna()
        if not len(values):
            return None
        ends = values.min(), values.max()
        return range_answer(*ends, printed, near(ends, printed.value, ROUGHLY))

    def means(table, printed):
        values = cell_statistics(table)["omega_disr_mean"].dropna()
        if not len(values):
            return None
        low, high = printed.value
        inside = bool(low <= values.min() and values.max() <= high)
        return range_answer(values.min(), values.max(), printed, inside, " (means of the cells)")

    def flattening(table, printed):
        found = slopes(table)
        found = found[found["above"].notna()]
        if not len(found):
            return None
        verdicts = [lies_in(row["above"], row["above_error"], -FLAT, FLAT) for _, row in found.iterrows()]
        return Answer(told_slopes(found), holds=all_of(verdicts))

    materials = data.plan.materials
    fixed = " The level of literal was fixed on Fig. 4." if is_calibrated(data) else ""
    known = table3_omega(data.grown, materials).dropna()
    itself = (
        f" Eq. 33 with Table 3 itself spans {between(known.min(), known.max())} for our grains." if len(known) else ""
    )
    fit = told_slopes(printed_slopes(data.grown, materials))
    return [
        drive_rows("order", data.tables, means, LEVEL + fixed),
        drive_rows("easier", data.tables, _easier, "Geometric means of all sizes."),
        drive_rows("range", data.tables, spread, LEVEL + itself),
        drive_rows(
            "flattening",
            data.tables,
            flattening,
            f"The paper gives no slope. Its own fit, Eq. 33 with Table 3, has {fit} above {SPLIT / NM:g} nm for our "
            "grains: it has no limit either. See In short and Beyond the paper.",
        ),
        drive_rows(
            "withstand",
            data.tables,
            lambda t, p: _over_strengths(data, t, p),
            "The models are scaled at one size: only how omega_disr falls with size counts.",
        ),
    ]


def told_slopes(found):
    """Slopes above `SPLIT` from `ratd.beyond.slopes`, such as "BA -1.97 ± 0.33; BAM1 ...", text."""
    parts = [
        f"{row['type']} {with_error(row['above'], row['above_error'])}"
        for _, row in found.iterrows()
        if np.isfinite(row["above"])
    ]
    return "; ".join(parts)


def _easier(table, printed):
    """omega_disr of BA over that of the other types: geometric means, and in how many cells it is less."""
    own = table[table["omega_disr"].notna()]
    own = own.assign(log=np.log(own["omega_disr"]), size=size_key(own["a_eff"]))
    cell = ["material", "size"]
    parts, verdicts = [], []
    for kind in BAM:
        both = own[own["type"].isin(("BA", kind))]
        both = both[both.groupby(cell)["type"].transform("nunique") == 2]
        if not len(both):
            return None
        means = [mean_of(part["log"], cell_of(part)) for _, part in both.groupby("type")]  # BA, then the other
        ratio = np.exp(means[0][0] - means[1][0])
        value = ratio, ratio * np.hypot(means[0][1], means[1][1])
        of_cell = both.pivot_table(index=cell, columns="type", values="log")
        below = int((of_cell["BA"] < of_cell[kind]).sum())
        parts.append(f"{kind} {with_error(*value)} (below 1 in {below} of {len(of_cell)} cells)")
        verdicts.append(lies_between(*value, high=1.0))
    return Answer("; ".join(parts), holds=all_of(verdicts))


def _over_strengths(data, table, printed):
    """omega_disr over the scaled strength models of Fig. 8 at the largest size."""
    own = data.plan.config["figures"]["figure8"]
    if own is None:
        return None
    here = table[(table["material"] == own["material"]) & (table["type"] == own["type"])]
    if not len(here):
        return None
    cells = cell_statistics(here)
    curves, anchor = predictions(cells, data.plan.materials[own["material"]], own["scaled_at_nm"] * NM, data.grown)
    ratio = (cells["omega_disr_mean"] / curves.drop(columns="absolute").T).T.iloc[-1].dropna()
    if not len(ratio):
        return None
    last = cells.iloc[-1]
    of = f"{len(ratio)} models, {plural(int(last['n_grains']), 'grain')} of {last['a_eff'] / NM:g} nm"
    scatter = np.log(here["omega_disr"]).groupby(cell_of(here)).std().pow(2).mean() ** 0.5
    n = np.array([last["n_grains"], cells.loc[np.isclose(cells["a_eff"], anchor[ratio.idxmax()]), "n_grains"].sum()])
    greatest = ratio.max(), ratio.max() * scatter * np.sqrt(np.sum(1 / n))
    text = f"{number(ratio.min())} to {with_error(*greatest)} ({of})"
    holds = lies_in(*greatest, printed.value / ROUGHLY, printed.value * ROUGHLY)
    return Answer(text, over(ratio.max(), printed.value), holds)


def _fit(data):
    """Rows on Eq. 33 fitted to our grains: whether it follows their means, and separate exponents do so better."""
    materials = data.plan.materials

    def match(source, printed):
        table, fit = source
        reading = str(fit["mean_radius"].values[0])
        fitted = eq33_omega(table, fitted_numbers(fit, reading), radius_of_reading(reading), materials)
        own = table.assign(over=np.log(table["omega_disr"] / fitted))
        parts, verdicts = [], []
        for kind, rows in own[own["over"].notna()].groupby("type", sort=False):
            sizes = [
                (part["a_eff"].iloc[0], *mean_of(part["over"], cell_of(part)))
                for _, part in rows.groupby(size_key(rows["a_eff"]))
            ]
            spread, error = _beyond_errors(*np.array([one[1:] for one in sizes]).T)
            verdicts.append(lies_in(spread, error, high=MATCHES**2))
            ends = [end(sizes, key=lambda one: one[1]) for end in (min, max)]
            told = [f"{with_error(np.exp(mean), np.exp(mean) * off)} ({size / NM:g} nm)" for size, mean, off in ends]
            parts.append(f"{kind} {number(100 * np.sqrt(max(spread, 0.0)))} %: {' to '.join(told)}")
        return Answer("; ".join(parts), holds=all_of(verdicts)) if parts else None

    def separate(table, printed):
        found = {by: _over_one_exponent(table, by) for by in LEFT_OUT}
        value = found["fold"].pop("all")
        if not np.isfinite(value[0]):
            return None
        types = ", ".join(f"{kind} {with_error(*own)}" for kind, own in found["fold"].items())
        beyond = f"{with_error(*found['size']['all'])} with {LEFT_OUT['size']}"
        return Answer(f"{with_error(*value)} ({types}); {beyond}", holds=lies_in(*value, NO_BETTER))

    return [
        drive_rows(
            "match",
            {drive: (data.tables[drive], fit) for drive, fit in data.fits.items()},
            match,
            "Root mean square of the distances of the sizes' geometric means from the fit, less what their errors "
            "make of it; and the least and the greatest mean over the fit. Means without an error (one grain a cell) "
            "are left out of it. A and alpha of Table 3 below, with its first <a_mon>.",
        ),
        drive_rows(
            "exponents",
            data.tables,
            separate,
            "Root mean squares of ln omega_disr of grains that were left out of the fit, for with more numbers a fit "
            "always comes nearer to its own grains. Three exponents leave the power of size free.",
        ),
    ]


def _beyond_errors(values, errors):
    """Mean square of values less that of their errors, and its own error; values without an error are left out."""
    known = np.isfinite(values) & np.isfinite(errors)
    if not known.any():
        return np.nan, np.nan
    values, errors = values[known], errors[known]
    spread = np.mean(values**2 - errors**2)
    return spread, np.sqrt(np.sum(4 * values**2 * errors**2 + 2 * errors**4)) / len(values)


def _over_one_exponent(table, by):
    """Type, or "all", -> scatter with separate exponents over that with one, and its error.

    Random folds are drawn several times: the mean, and what they differ by counts as error too.
    """
    found = []
    for seed in range(FOLDINGS if by == "fold" else 1):
        one = cross_validation(table, by=by, seed=seed, predictors=("Eq. 33", SEPARATE))
        found.append(one[one["predictor"] == SEPARATE].set_index("type")[["over_first", "over_first_error"]])
    ratio, error = (pd.DataFrame([one[name] for one in found]) for name in ("over_first", "over_first_error"))
    spread = ratio.std() if len(found) > 1 else 0.0
    total = np.hypot(error.mean(), spread)
    return {kind: (ratio[kind].mean(), total[kind]) for kind in ratio}


def _parameters(data):
    """Rows of Fig. 9: each grain over itself with the paper's xi_c and T_vis."""

    def with_setting(column, kinds, limits, decides=MARKS[0]):
        def evaluate(table, printed):
            here = table[np.isclose(table[column], printed.setting, rtol=1e-6, atol=0)]
            parts, verdicts = [], []
            for kind, own in here[here["type"].isin(kinds)].groupby("type", sort=False):
                for mark, name in MARK_NAMES.items():
                    found = median_of(own[f"{mark}_ratio"])
                    if found["n"]:
                        value = found["median"], found["error"]
                        parts.append(f"{kind} {name}{with_error(*value)}")
                        if mark == decides:
                            verdicts.append(lies_in(*value, *limits))
            if not parts:
                return None
            grains = here[here["type"].isin(kinds)].drop_duplicates(["type", "a_eff", "seed"])
            return Answer(
                f"{'; '.join(parts)} ({plural(len(grains), 'grain')} of {sizes_of(grains)})", holds=all_of(verdicts)
            )

        return evaluate

    rise = PRINTED["viscous"].value
    none, half = (1 - NO_TREND, 1 + NO_TREND), (rise - 1) / 2
    of_rolling = "critical_rolling_displacement", ("BA", "BAM2"), none
    rolling, by_mass = with_setting(*of_rolling), with_setting(*of_rolling, decides="omega_mass_75")
    found = {drive: by_mass(table, PRINTED["rolling"]) for drive, table in data.parameters.items()}
    moved = [drive for drive, answer in found.items() if answer is not None and answer.holds is False]
    reason = "Medians; omega_disr decides. Single BA grains change more."
    if moved:
        reason += f" The loss of a quarter of the mass, which scatters less, does move ({', '.join(moved)})."
    viscous = with_setting("viscous_time", ("BAM2",), (rise - half, rise + half))
    return [
        drive_rows("rolling", data.parameters, rolling, reason),
        drive_rows("viscous_rise", data.parameters, _viscous_rise, "Its sign alone: how much, in the next row."),
        drive_rows("viscous", data.parameters, viscous, _weakened(data)),
    ]


def _viscous_rise(table, printed):
    """Each grain with the longest T_vis over itself with the shortest."""
    key = ["type", "material", "a_eff", "seed"]
    short, long = (
        table[np.isclose(table["viscous_time"], value, rtol=1e-6, atol=0)]
        for value in (table["viscous_time"].min(), PRINTED["viscous"].setting)
    )
    both = long.merge(short, on=key, suffixes=("", "_short"))
    parts, verdicts = [], []
    for kind, own in both.groupby("type", sort=False):
        for mark, name in MARK_NAMES.items():
            found = median_of(own[mark] / own[f"{mark}_short"])
            if found["n"]:
                parts.append(f"{kind} {name}{with_error(found['median'], found['error'])}")
                if mark == "omega_disr":
                    verdicts.append(lies_between(found["median"], found["error"], low=1.0))
    if not parts:
        return None
    text = f"{'; '.join(parts)} ({plural(len(both), 'grain')} of {sizes_of(both)})"
    return Answer(text, holds=all_of(verdicts))


MARK_NAMES = dict(zip(MARKS, ("", "(25 % of the mass) "), strict=True))
"""Marks of Fig. 9; the paper's is omega_disr, which decides."""


def _weakened(data):
    """Words on the step of Fig. 9, which weakens what T_vis stands for."""
    own = data.plan.config["figures"]["figure9"]
    if own is None:
        return ""
    step = {"prescribed": own["timestep_factor"], "literal": own["literal"]["timestep_factor"]}
    steps = ", ".join(f"{step[drive]:g} ({drive})" for drive in data.parameters)
    return (
        "The scheme weakens the damping of the lightest monomers, less so the shorter the step (docs/model.md, The "
        f"scheme): f = {steps}. {_resolved(data)}The paper does not say how it takes the damping, which its Eq. 29 "
        "lacks."
    )


def _resolved(data):
    """A sentence: the rise of Fig. 9 with the damping resolved, from a check of the validation."""
    table = data.study("damping")
    if table is None:
        return ""
    own = table[table["type"] == "BAM2"]
    best = _rise_in_words(damping.resolved_rise(own))
    if not best:
        return ""
    f = damping.finest(own)["timestep_factor"].iloc[0]
    words = (
        f"Resolved, with explicit damping and f = {f:g}, it is {best} ({plural(own['seed'].nunique(), 'grain')} of "
        f"{damping.sizes(own)}; docs/validation.md, Damping)"
    )
    by_rate = damping.rise_by_rate(own)
    told = [f"{text} at epsilon = {e:g}" for e, found in by_rate.items() if (text := _rise_in_words(found))]
    return f"{words}; it goes with the rate: {told[0]}, {told[-1]}. " if len(told) > 1 else f"{words}. "


def _rise_in_words(found):
    return "; ".join(f"{MARK_NAMES[mark]}{with_error(s['median'], s['error'])}" for mark, s in found.items() if s["n"])


def pairs(data):
    """Rows of Fig. 10, list of Row; they have no drive to choose."""
    if data.pairs is None:
        return [Row("pairs"), Row("pairs_trend"), Row("pairs_damped")]
    signed = relative_error(data.pairs)
    table = data.pairs.assign(error=np.abs(signed), signed=signed)
    damped, undamped = (table[table["start"] == start] for start in ("damped", "undamped"))
    against = np.abs(1 - damped["parting_omega"] / damped["eq35_omega"])
    exact = f"; {100 * damped['error'].max():.2g} % against sqrt(3 pi gamma/2m)"
    return [
        _of_pairs(
            "pairs", undamped["error"], "",
            "A pair that vibrates nearly reaches the end of the branch, whose force Eq. 35 takes. With the drive "
            "prescribed; see The pairs of Fig. 10 under the printed equations.",
        ),
        _trend(undamped),
        _of_pairs(
            "pairs_damped", against, exact,
            "Eq. 35 takes 5/9 of the pull-off force, that of the end of the branch, which a damped pair under a slow "
            "load does not need: it holds up to the greatest pull. Printed once; whether it is of damped pairs is not "
            "said.",
        ),
    ]  # fmt: skip


def _trend(pairs):
    """Row with the mean signed error of the undamped pairs."""
    error = pairs["signed"].dropna()
    value = mean_of(error)
    text = f"{with_error(*(100 * each for each in value))} % ({between(100 * error.min(), 100 * error.max())} %)"
    return Row("pairs_trend", {"": Answer(text, holds=lies_in(*value, 0.0))})


def _of_pairs(key, error, more, reason):
    """Row with the greatest error of some pairs; a pair that never parted agrees with nothing."""
    printed, kept = PRINTED[key].value, int(error.isna().sum())
    text = f"{100 * error.max():.2g} %{more}" + (f"; {kept} never parted" if kept else "")
    return Row(key, {"": Answer(text, over(error.max(), printed), bool(error.max() <= printed and not kept))}, reason)
