"""The head of the document: what holds and what does not."""

import numpy as np
import pandas as pd

from ratd import formula_table
from ratd.beyond import SPLIT, slopes
from ratd.composition import table1, table2
from ratd.ensemble import PAPER_MEAN_RADIUS, cell_of, size_key
from ratd.markdown import markdown_table, plural
from ratd.reproduction import grown, pair_test
from ratd.reproduction.argument import lammps_over_ratd, over_strength, printed_above, ratios_to_ratd
from ratd.reproduction.bounds import PM, printed_slopes, ratios, shown_sizes, sizes_of, split_sizes
from ratd.reproduction.open_questions import least_of
from ratd.reproduction.paper import ABOUT
from ratd.reproduction.rate import calibrated_grains, is_calibrated, printed_rate
from ratd.reproduction.text import NOTHING, all_of, between, lies_in, number, with_error
from ratd.statistics import median_of
from ratd.units import NM
from ratd.validation.show import lammps, literal
from ratd.validation.show.convergence import large_shifts, percent

OF_DRIVE, PRINTED_FIT = "omega_disr, drive `{}`", "Eq. 33 with the printed Table 3"
FAR_BELOW = 0.9
"""omega of the first loss over omega_disr below which most of a type lose mass well before."""
FEW = 3
"""Grains of a cell below which it is said what it does to the powers of size."""
NEARLY_ALL = 0.9
"""Part of all grains that is called so."""


def summary(data, rows):
    """What holds and what does not, from the numbers, in Markdown.

    Parameters
    ----------
    data : ratd.reproduction.data.Data
    rows : list of Row
        The printed numbers with our answers.

    Returns
    -------
    str
    """
    differ = [
        _bound(ratios(data.grown, data.plan.materials)),
        *_lammps(data),
        *pair_test.in_short(data),
        *_strength(data),
        *_formulae(data),
    ]
    parts = [
        _listed("omega_disr beside the printed one", [*_levels(data), *_spin_up_rate(data), *_table3(data)]),
        _flattening(data),
        _listed("Why they differ", differ),
        _listed("What the paper says, counted", [*_verdicts(rows, list(data.tables)), _composition(), *_grains(data)]),
        _listed(
            "What predicts omega_disr", [_prediction(drive, data.predictions[drive]["size"]) for drive in data.tables]
        ),
    ]
    return "\n\n".join(part for part in parts if part)


def _listed(head, lines):
    """A part of the summary: its head and its lines; nothing without any."""
    lines = [f"- {line}" for line in lines if line]
    return f"### {head}\n\n" + "\n".join(lines) if lines else ""


def _levels(data):
    """omega_disr over the printed one, a line a drive, and one for the calibrated rate where that is known."""
    tables = {drive: ratios(table, data.plan.materials) for drive, table in data.tables.items()}
    lines = [
        _level(f"Drive `{drive}`{_rate(data, drive)}", table) + _fixed(data, drive) + _before(table)
        for drive, table in tables.items()
    ]
    calibrated = calibrated_grains(data)
    if calibrated is not None and calibrated["found_over_printed"].notna().any():
        name = (
            f"Drive `literal` at exactly the calibrated {number(data.calibration['calibrated'].item())} rad/s², not "
            "run, but predicted for a solid grain from the grains of `prescribed` (What the literal drive does)"
        )
        lines.append(_level(name, calibrated))
    return lines


def answer(data):
    """What it comes to, for someone who reads no further.

    Parameters
    ----------
    data : ratd.reproduction.data.Data

    Returns
    -------
    list of str
        A paragraph of Markdown; none where a drive is missing.
    """
    if len(data.tables) < 2:
        return []
    count, known, _ = printed_above(ratios(data.grown, data.plan.materials), "printed_over_firm")
    held = (
        "; what the contacts of a grain as grown can bear at most lies below the printed value for nearly all of them"
        if count > NEARLY_ALL * known
        else ""
    )
    level = {
        drive: number(_over_printed(ratios(table, data.plan.materials))["median"])
        for drive, table in data.tables.items()
    }
    study = data.study("literal")
    exact = ""
    if study is not None:
        medians, single = literal.exact_over_consistent(study)
        exact = f", {between(*medians)} times in medians of small ones ({between(*single)} in single runs)"
    return [
        "**The answer**: a grain that turns as a whole (drive `prescribed`) comes apart well below the printed "
        f"omega_disr, at {level['prescribed']} times it in the median, and the farther below it the larger it is"
        f"{held}. Another code lets small grains part where this one does. The equations as printed (`literal`) have "
        "no torque that could turn the grain. With the Coriolis force half a step late, as assumed here, its "
        "omega_disr depends on d omega/dt and on the time step; with it exact, grains part only far above the omega "
        f"of the consistent model{exact}. With it late and d omega/dt fixed on Fig. 4, omega_disr lies at "
        f"{level['literal']} times the printed one in the median, the level of the cell of Fig. 4 by construction, and "
        "falls less with size than Table 3."
    ]


def _verdicts(rows, drives):
    """How many of the printed values hold, a line a part of the document, and what holds in no drive."""
    lines = []
    for about, what in ABOUT.items():
        part = [row for row in rows if row.printed.about == about and row.printed.rule]
        keys = drives if about == "spin-up" else [""]
        counts = []
        for key in keys:
            found = [row.answers[key].holds for row in part if key in row.answers]
            words = f"{found.count(True)} seen here, {found.count(False)} not, {found.count(None)} left open"
            counts.append(f"drive `{key}` {words}" if key else words)
        lines.append(f"**{len(part)} printed values and findings on {what}**, with a rule each: {'; '.join(counts)}.")
    own = [row for row in rows if row.printed.about == "spin-up" and row.answers]

    def named(chosen):
        return "; ".join(f"{row.printed.what} ({row.printed.text})" for row in chosen) or "none"

    seen = {drive: [row for row in own if drive in row.answers and row.answers[drive].holds] for drive in drives}
    both = [row for row in own if all(row in rows for rows in seen.values())]
    if len(drives) > 1:
        none = [row for row in own if all(answer.holds is False for answer in row.answers.values())]
        lines += [f"**Seen in neither drive**: {named(none)}.", f"**Seen in both drives**: {named(both)}."]
    for drive, rows in seen.items():
        alone = [row for row in rows if row not in both] if len(drives) > 1 else rows
        lines.append(f"**Seen with the drive `{drive}`{' alone' if len(drives) > 1 else ''}**: {named(alone)}.")
    return lines


def _rate(data, drive):
    """Words on the free number of the drive `literal`."""
    rate = printed_rate(data) if drive == "literal" else None
    return "" if rate is None else f" with d omega/dt = {number(rate)} rad/s² at the printed step"


def _fixed(data, drive):
    if drive != "literal" or not is_calibrated(data):
        return ""
    return (
        " This d omega/dt was fixed, within an error, on the onset of mass loss in Fig. 4, which sets the level; how "
        "it changes with size, material and type was not."
    )


def _level(name, table):
    """omega_disr over Eq. 33 with the printed Table 3, of all grains and by type and size."""

    found = _over_printed(table)
    sizes, shown = size_key(table["a_eff"]), shown_sizes(table)
    sides = ", ".join(f"{sizes_of(part)} {number(_over_printed(part)['median'])}" for part in split_sizes(table))
    own_radius = table["found_over_printed"] * np.sqrt(table["mean_monomer_radius"] / PAPER_MEAN_RADIUS)
    own = median_of(own_radius, cell=cell_of(table))["median"]
    by_type = [
        f"{kind} {' → '.join(number(_over_printed(part[sizes[part.index] == size])['median']) for size in shown)}"
        for kind, part in table.groupby("type", sort=False)
    ]
    return (
        f"**{name}**: omega_disr is {with_error(found['median'], found['error'])} times Eq. 33 with the printed Table "
        f"3 in the median of {plural(found['n'], 'grain')} (middle two thirds {between(found['low'], found['high'])}; "
        f"{sides}), and at {', '.join(f'{size * PM / NM:g}' for size in shown)} nm {', '.join(by_type)}. With the "
        f"grains' own mean radius for <a_mon> in Eq. 33 it is {number(own)} times."
    )


def _over_printed(part):
    """omega_disr over Eq. 33 with the printed Table 3, see `ratd.statistics.median_of`; all cells count alike."""
    return median_of(part["found_over_printed"], cell=cell_of(part))


def _before(table):
    """Sentences: how few the largest grains are, and where large ones lose their first mass far below omega_disr."""
    large = split_sizes(table)[-1]
    largest = table[size_key(table["a_eff"]) == size_key(table["a_eff"]).max()]
    ratio = large["omega_first_loss"] / large["omega_disr"]
    medians = {
        kind: median_of(ratio[own.index], cell=cell_of(own))["median"]
        for kind, own in large.groupby("type", sort=False)
    }
    far = [f"{kind} at {number(median)}" for kind, median in medians.items() if median < FAR_BELOW]
    counts = ", ".join(f"{len(own)} {kind}" for kind, own in largest.groupby("type", sort=False))
    words = f" The values of {sizes_of(largest)} are medians of {counts} grains."
    if far:
        words += (
            f" The first mass leaves grains of {sizes_of(large)} far below omega_disr, {', '.join(far)} times it: "
            "there omega_disr is that of a remnant."
        )
    return words


def _bound(table):
    count, known, load = printed_above(table, "printed_over_firm")
    if not known:
        return ""
    return (
        "**What the contacts can hold**: the printed Table 3 lies above the firm bound, with everything counted that "
        f"the contacts of a cut can bear, for {count} of {plural(known, 'grain')} as grown; at that omega the cut "
        f"would have to bear {number(load)} times as much, in the median of all."
    )


def _lammps(data):
    table = data.study("lammps")
    if table is None:
        return []
    thresholds = lammps.thresholds(table)
    found, ratio = lammps_over_ratd(thresholds), pd.Series(ratios_to_ratd(thresholds), dtype=float)
    grains = table[table["study"] == "rotation"].drop_duplicates(["type", "a_eff", "seed"])
    return [
        "**LAMMPS**, an independent code, agrees in the median to about a step of the omega that were tried: it lets "
        f"the same grains come apart at {with_error(found['median'], found['error'])} times the omega of this one "
        f"(median of {plural(found['n'], 'threshold')} of {plural(len(grains), 'grain')} of up to "
        f"{int(grains['n_monomers'].max())} monomers; single ones {between(ratio.min(), ratio.max())}, "
        f"{int((np.abs(ratio - 1) > lammps.GOAL).sum())} of them farther off than {100 * lammps.GOAL:g} %). Larger "
        "grains, for which print and model differ most, were not tried: LAMMPS is too slow for them."
    ]


def _strength(data):
    """The tensile strength beside the consistent model and Table 3."""
    if "prescribed" not in data.tables:
        return []
    found = [values for *_, values in over_strength(data)]
    model, printed = ([values[k] for values in found] for k in (0, 1))
    return [
        "**Tensile strength** (Tatsuuma et al. 2019): its omega is "
        f"{between(min(model), max(model))} times the omega_disr of the drive `prescribed` and "
        f"{between(min(printed), max(printed))} times Eq. 33 with Table 3, in medians of types and sizes."
    ]


def _formulae(data):
    """How much single formulae as printed change."""
    table = data.formulae
    if table is None:
        return []
    found = formula_table.formula_effects(table, "omega_disr").query("type == 'all'").to_dict("records")
    ends = [pick(found, key=lambda each: each["median"]) for pick in (min, max)]
    told = " to ".join(f"{with_error(each['median'], each['error'])} ({plural(each['n'], 'grain')})" for each in ends)
    return [
        "**Each printed formula alone** moves the median omega_disr of a size, all types together, to "
        f"{told} times that of the consistent model, in grains of {sizes_of(table)}; larger ones were not tried."
    ]


def _spin_up_rate(data):
    """How far the spin-ups of large grains are from slow ones, where that was tried."""
    found = large_shifts(data.study("convergence"), "omega_disr")
    if not found or "prescribed" not in data.tables:
        return []
    parts = [f"{kind} of {size:g} nm {percent(shift)} % ({plural(shift['n'], 'grain')})" for kind, size, shift in found]
    return [
        "**Spin-up rate, drive `prescribed`**: omega_disr lies above that of an infinitely slow spin-up, in the large "
        f"grains that were tried: {', '.join(parts)}; of smaller ones docs/validation.md (Convergence) tells. That "
        "is in no ± of this document."
    ]


def _prediction(drive, found):
    """What predicts omega_disr of sizes that were left out."""
    own = found[(found["type"] == "all") & found["scatter"].notna()]
    if not len(own):
        return ""
    misses = [f"{with_error(row['scatter'], row['error'])} ({row['predictor']})" for _, row in own.iterrows()]
    best = least_of(own)
    verdict = f"the least is that of {best}" if best else "which is the least is not decided"
    return (
        f"**Drive `{drive}`**: for sizes left out of the fit the prediction of ln omega_disr is off by "
        f"{', '.join(misses)}; {verdict}."
    )


def _flattening(data):
    """Slopes above `SPLIT` of what there is, a table."""
    materials = data.plan.materials
    sources = {OF_DRIVE.format(drive): slopes(table) for drive, table in data.tables.items()}
    sources["the cut bound"] = slopes(data.grown, "cut_bound")
    sources[PRINTED_FIT] = printed_slopes(data.grown, materials)
    types = list(dict.fromkeys(data.grown["type"]))
    rows = []
    for name, found in sources.items():
        own = {row["type"]: with_error(row["above"], row["above_error"]) for _, row in found.iterrows()}
        rows.append([name, *(own.get(kind, NOTHING) for kind in types)])
    parts = [
        f"**Flattening**: the paper speaks of an asymptotic limit of omega_disr above {SPLIT / NM:g} nm. The power of "
        "size there is",
        markdown_table(["", *types], rows),
        _between_limit_and_fit(data, sources) + _without_thin_cells(data),
    ]
    return "\n\n".join(part for part in parts if part)


def _without_thin_cells(data):
    """Sentences: the powers of size without cells of fewer than `FEW` grains, for each drive that has some."""
    words = []
    for drive, table in data.tables.items():
        large = split_sizes(table)[-1]
        cell = cell_of(large)
        count = np.bincount(cell)
        thin, kept = np.count_nonzero(count < FEW), large[count[cell] >= FEW]
        if not thin:
            continue
        powers = slopes(kept)
        told = [
            f"{row['type']} {with_error(row['above'], row['above_error'])} "
            f"({sizes_of(kept[kept['type'] == row['type']])})"
            for _, row in powers[powers["above"].notna()].iterrows()
        ]
        if told:
            words.append(
                f" {thin} of the large cells of the drive `{drive}` have fewer than {FEW} grains, and count as much as "
                f"the others; without them the power is {', '.join(told)}."
            )
    return "".join(words)


def _between_limit_and_fit(data, sources):
    """A paragraph: where the powers of size of the drives lie to the two that the paper gives."""
    fit = sources[PRINTED_FIT]["above"]
    if not fit.max() < 0:
        return ""
    words = []
    for drive in data.tables:
        own = sources[OF_DRIVE.format(drive)]
        powers = list(zip(own["above"], own["above_error"], strict=True))
        told = f"the drive `{drive}` ({between(own['above'].min(), own['above'].max())})"
        if all_of(lies_in(*power, fit.max(), 0.0) for power in powers):
            words.append(f"{told} lies between the two")
        elif all_of(lies_in(*power, -np.inf, fit.min()) for power in powers):
            words.append(f"{told} falls more steeply than either")
    if not words:
        return ""
    return (
        f"The paper's two statements do not agree: a limit is a power of 0, its own fit has "
        f"{between(fit.min(), fit.max())}. Here {'; '.join(words)}."
    )


def _table3(data):
    """In how many cases alpha agrees with the printed one, a line a drive; <a_mon> in its first reading."""
    lines = []
    for drive, fit in data.fits.items():
        best = fit.isel(mean_radius=0)
        value, printed = best["alpha"].values, best["alpha_printed"].values
        inside = (best["alpha_low"].values <= printed) & (printed <= best["alpha_high"].values)
        known = np.isfinite(value) & np.isfinite(printed)
        if known.any():
            lines.append(
                f"**Table 3, drive `{drive}`**: alpha is {between(value[known].min(), value[known].max())}, printed "
                f"{between(printed[known].min(), printed[known].max())}; its interval holds the printed value in "
                f"{int(inside[known].sum())} of {plural(int(known.sum()), 'case')}."
            )
    return lines


def _composition():
    one, two = table1(), table2()
    of_co_s = two.set_index("material").loc["co-S"]
    names = ("youngs_modulus", "poisson_number", "density")
    off = [np.abs(row["abundance"] - row["abundance_printed"]) > row["abundance_rounding"] for _, row in one.iterrows()]
    off += [np.abs(of_co_s[name] - of_co_s[f"{name}_printed"]) > of_co_s[f"{name}_rounding"] for name in names]
    over = [of_co_s[f"{name}_over_printed"] for name in names]
    ends = one["abundance_over_printed"]
    return (
        f"**Tables 1 and 2** follow from the minerals of co-S to a few per cent, computed over printed "
        f"{between(ends.min(), ends.max())} and, for E, nu and rho of co-S, {between(min(over), max(over))}; "
        f"{sum(off)} of {len(off)} values lie outside the rounding of the printed ones."
    )


def _grains(data):
    """Contacts a monomer of the grains of Fig. 1, which scatter in size does not touch, and what is unlike ours."""
    over = grown.contacts_over_printed(data)
    if not over:
        return []
    *_, outside = grown.figure1_table(data)
    rest = f"; printed, but outside of 95 % of ours: {', '.join(outside)}; why is not known" if outside else ""
    return [
        f"**The grains of Fig. 1** have {between(min(over), max(over))} times the printed contacts a monomer "
        f"({plural(len(over), 'grain')}), which follows from their types{rest}."
    ]
