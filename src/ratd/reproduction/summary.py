"""The head of the document: what holds and what does not."""

import numpy as np

from ratd import formula_table
from ratd.beyond import PREDICTORS, SPLIT, slopes
from ratd.composition import table1, table2
from ratd.ensemble import PAPER_MEAN_RADIUS, cell_of, size_key
from ratd.markdown import markdown_table, plural
from ratd.reproduction import grown, pair_test
from ratd.reproduction.argument import by_frame_and_type, by_size, lammps_over_ratd, over_strength, printed_above
from ratd.reproduction.bounds import (
    PM,
    printed_slopes,
    ratios,
    same_grains,
    shown_sizes,
    sizes_of,
    split_sizes,
    table3_omega,
)
from ratd.reproduction.open_questions import least_of
from ratd.reproduction.paper import ABOUT
from ratd.reproduction.rate import is_calibrated, printed_rate
from ratd.reproduction.text import NOTHING, all_of, between, lies_in, number, with_error
from ratd.statistics import median_of
from ratd.units import NM
from ratd.validation.show import lammps, literal
from ratd.validation.show.convergence import large_shifts, percent

OF_DRIVE, PRINTED_FIT = "omega_disr, drive `{}`", "Eq. 33 with the printed Table 3"
MAIN = {
    "easier": "BA break most easily",
    "order": "the order of magnitude of omega_disr (fixed on Fig. 4 for `literal`)",
    "flattening": "an asymptotic limit for large grains",
    "abrupt": "mass that is lost continuously",
    "blocks": "fragments of single monomers",
    "gain": "BAM2 that gain contacts",
    "more_oblate": "BAM that become oblate",
    "quarter": "a quarter of the mass lost at about omega_disr",
    "viscous_rise": "more omega_disr with a longer viscous time, however little",
}
"""Main findings of the paper on the spin-up, by key of `ratd.reproduction.paper.PRINTED`, in a few words."""
PREDICTED = {name: name for name in PREDICTORS} | {"Eq. 33": "Eq. 33 fitted anew"}
"""What the predictors are called, so that none is taken for Eq. 33 as printed."""
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
        *_grains(data),
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
        _listed("What the paper says, counted", [*_verdicts(rows, list(data.tables)), _composition()]),
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
    """omega_disr over the printed one, a line a drive."""
    tables = {drive: ratios(table, data.plan.materials) for drive, table in data.tables.items()}
    return [
        _level(f"Drive `{drive}`{_rate(data, drive)}", table) + _fixed(data, drive) + _before(table)
        for drive, table in tables.items()
    ]


def answer(data):
    """What it comes to, for someone who reads no further.

    Parameters
    ----------
    data : ratd.reproduction.data.Data

    Returns
    -------
    list of str
        A list in Markdown; none where a drive is missing.
    """
    if len(data.tables) < 2:
        return []
    consistent, printed = (ratios(data.tables[drive], data.plan.materials) for drive in ("prescribed", "literal"))
    small, *_, large = shown_sizes(consistent)
    ends = [_ends_of_types(consistent, size) for size in (small, large)]
    level = number(_over_printed(printed)["median"])
    points = [
        "A grain that turns as a whole (drive `prescribed`) comes apart below the printed omega_disr, and the farther "
        f"below it the larger it is: medians of the types are {between(*ends[0])} times it at {small * PM / NM:g} nm "
        f"and {between(*ends[1])} times at {large * PM / NM:g} nm, where the load, going as omega², is "
        f"{between(ends[1][1] ** -2, ends[1][0] ** -2)} times lower.",
        _independent(data),
        "The equations as printed (drive `literal`) have no torque that could turn the grain. With the Coriolis force "
        "half a step late, as assumed here, its omega_disr depends on d omega/dt and on the time step. With d omega/dt "
        f"fixed on Fig. 4, omega_disr lies at {level} times the printed one in the median, the level of the cell of "
        "Fig. 4 by construction, and falls less with size than Table 3.",
        _exactly(data),
    ]
    return ["\n".join(["**The answer**:", *(f"- {point}" for point in points if point)])]


def _independent(data):
    """A sentence: what says so besides the spin-ups of this code."""
    told = []
    count, known, _ = printed_above(ratios(data.grown, data.plan.materials), "printed_over_firm")
    if count > NEARLY_ALL * known:
        told.append(
            "what the contacts of a grain as grown can bear at most lies below the printed value for nearly all"
        )
    table = data.study("lammps")
    if table is not None:
        grains = table[table["study"] == "rotation"]
        ratio = lammps_over_ratd(lammps.thresholds(table))["median"]
        told.append(
            f"LAMMPS, an independent code, lets grains of {sizes_of(grains)} part at {number(ratio)} times the omega "
            "at which this one does, in the median"
        )
    words = "; ".join(told)
    return f"{words[0].upper()}{words[1:]}." if told else ""


def _exactly(data):
    """A sentence: what an exact Coriolis force makes of the drive `literal`."""
    study = data.study("literal")
    if study is None:
        return ""
    medians, single = literal.exact_over_consistent(study)
    over = exact_over_printed(data, study)
    printed = f", {between(over.min(), over.max())} times the printed omega_disr" if len(over) else ""
    return (
        f"With the Coriolis force exact, grains of {sizes_of(study)} lose their first mass at {between(*medians)} "
        f"times the omega of the consistent model{printed}, in medians of types and sizes; the least single one has "
        f"{number(single[0])} times the former."
    )


def _ends_of_types(table, size):
    """Least and greatest median of the types at a size of omega_disr over the printed one."""
    here = table[size_key(table["a_eff"]) == size]
    medians = [_over_printed(part)["median"] for _, part in here.groupby("type")]
    return min(medians), max(medians)


def exact_over_printed(data, study):
    """omega of the first loss with the exact Coriolis term over Eq. 33 with the printed Table 3 for the same grain.

    Parameters
    ----------
    data : ratd.reproduction.data.Data
    study : pandas.DataFrame
        The check of the literal drive.

    Returns
    -------
    pandas.Series
        Median of each type and size, over the runs that lost mass of grains that the ensemble has; may be empty.
    """
    exact = (study["drive"] == "literal") & (study["coriolis"] == "exact")
    runs = study[exact & study["omega_first_loss"].notna()]
    grown = data.grown.assign(printed=table3_omega(data.grown, data.plan.materials))
    both = same_grains(runs, grown, ("", "_grown"))
    return (both["omega_first_loss"] / both["printed"]).groupby([both["type"], both["nm"]]).median()


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
    return [*lines, *_main_findings(rows, drives)]


UNSEEN = "seen in none", "not decided, or not seen"
"""What is said of a finding that no drive shows, after those that one shows."""


def _main_findings(rows, drives):
    """A line: in which drives the main findings of the paper are seen."""
    found = {row.key: row.answers for row in rows}
    groups = {}
    for key, words in MAIN.items():
        answers = found.get(key, {})
        if not all(drive in answers for drive in drives):
            continue
        verdicts = [answers[drive].holds for drive in drives]
        seen = [f"`{drive}`" for drive, verdict in zip(drives, verdicts, strict=True) if verdict]
        if seen:
            outcome = "seen with " + " and ".join(seen)
        else:
            outcome = UNSEEN[0] if all(verdict is False for verdict in verdicts) else UNSEEN[1]
        groups.setdefault(outcome, []).append(words)
    if not groups:
        return []
    ordered = sorted(groups.items(), key=lambda group: UNSEEN.index(group[0]) if group[0] in UNSEEN else -1)
    told = "; ".join(f"{outcome}: {', '.join(words)}" for outcome, words in ordered)
    return [f"**Its main findings** on the spin-up: {told}. The other rows stand under The spin-up."]


def _rate(data, drive):
    """Words on the free number of the drive `literal`."""
    rate = printed_rate(data) if drive == "literal" else None
    return "" if rate is None else f" with d omega/dt = {number(rate)} rad/s² at the printed step"


def _fixed(data, drive):
    if drive != "literal" or not is_calibrated(data):
        return ""
    return (
        " This d omega/dt was fixed, within an error, on the onset of mass loss in Fig. 4, which sets the level; how "
        "omega_disr changes with size, material and type was not."
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
    counts = ", ".join(f"{len(own)} {kind}" for kind, own in largest.groupby("type", sort=False))
    words = f" The values of {sizes_of(largest)} are medians of {counts} grains."
    for kind, median in medians.items():
        if median < FAR_BELOW:
            own = large[large["type"] == kind]
            quarter = own["omega_mass_75"] / own["omega_disr"] * own["found_over_printed"]
            levels = [median_of(values, cell=cell_of(own))["median"] for values in (quarter, own["found_over_printed"])]
            words += (
                f" In {kind} grains of {sizes_of(large)} the first mass leaves at {number(median)} times omega_disr, "
                f"which there is that of a remnant: a quarter of the mass is lost at {number(levels[0])} times Eq. 33, "
                f"where omega_disr lies at {number(levels[1])} times."
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
    grains = table[table["study"] == "rotation"].drop_duplicates(["type", "a_eff", "seed"])
    untried = [kind for kind in dict.fromkeys(data.grown["type"]) if kind not in set(grains["type"])]
    if grains["a_eff"].max() < data.grown["a_eff"].max() * (1 - 1e-9):
        untried.append(f"grains of more than {grains['a_eff'].max() / NM:g} nm, for which print and model differ most")
    rest = f" Not tried: {', '.join(untried)}." if untried else ""
    rows = lammps.thresholds(table)
    return [
        "**LAMMPS**, an independent code, lets the same grains come apart at nearly the same omega. LAMMPS over "
        f"this code, medians: {by_frame_and_type(rows)}. In the inertial frame contacts of LAMMPS lose some of their "
        "load as the grain turns, in one that turns with the grain they do not (docs/validation.md). By size, all of "
        f"these together: {by_size(rows)}. These are {plural(len(grains), 'grain')} of up to "
        f"{int(grains['n_monomers'].max())} monomers.{rest}"
    ]


def _strength(data):
    """The tensile strength beside the consistent model and Table 3."""
    if "prescribed" not in data.tables:
        return []
    found = [values for *_, values in over_strength(data)]
    model, printed = ([values[k] for values in found] for k in (0, 1))
    nearer = max(map(abs, np.log(model))) < min(map(abs, np.log(printed)))
    return [
        "**The tensile strength** of pulled aggregates (Tatsuuma et al. 2019), which knows nothing of this code, gives "
        f"an omega of {between(min(model), max(model))} times the omega_disr of the drive `prescribed`, and "
        f"{between(min(printed), max(printed))} times Eq. 33 with Table 3, in medians of types and sizes"
        f"{': it is nearer to the consistent model' if nearer else ''}."
    ]


def _formulae(data):
    """How much single formulae as printed change."""
    table = data.formulae
    if table is None:
        return []
    rest, undamped = [], []
    for mark in ("omega_disr", "omega_mass_75"):
        found = formula_table.formula_effects(table, mark).query("type == 'all'")
        without = found["formula"] == formula_table.DAMPING
        rest += found.loc[~without, "median"].tolist() if mark == "omega_disr" else []
        undamped.append(
            ", ".join(
                f"{with_error(each['median'], each['error'])} ({each['nm']:g} nm)"
                for each in found[without].to_dict("records")
            )
        )
    told = ""
    if rest:
        told = f"those of the contacts move the median omega_disr of a size to {between(min(rest), max(rest))} times"
    if undamped[0]:
        told += (
            f"{'; ' if told else ''}no damping, as in Eq. 29, moves it to {undamped[0]} times, and the omega of the "
            f"loss of a quarter of the mass to {undamped[1]} times"
        )
    grains = table.drop_duplicates(["type", "a_eff", "seed"])
    return [
        f"**Each printed formula alone**: {told} that of the consistent model (all types together; "
        f"{plural(len(grains), 'grain')} of {', '.join(grains['material'].unique())} of {sizes_of(table)}; "
        "larger ones were not tried)."
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
    misses = [
        f"{with_error(row['scatter'], row['error'])} ({PREDICTED[row['predictor']]})" for _, row in own.iterrows()
    ]
    best = least_of(own)
    verdict = f"the least is that of {best}" if best else "which is the least is not decided"
    return (
        f"**Drive `{drive}`**: for sizes left out of the fit the prediction of ln omega_disr is off by "
        f"{', '.join(misses)}; {verdict}."
    )


def _flattening(data):
    """Slopes above `SPLIT` of what there is, a table."""
    materials = data.plan.materials
    sources = {OF_DRIVE.format(drive): slopes(without_thin_cells(table)) for drive, table in data.tables.items()}
    sources["the cut bound"] = slopes(data.grown, "cut_bound")
    sources[PRINTED_FIT] = printed_slopes(data.grown, materials)
    types = list(dict.fromkeys(data.grown["type"]))
    rows = []
    for name, found in sources.items():
        own = {row["type"]: with_error(row["above"], row["above_error"]) for _, row in found.iterrows()}
        rows.append([name, *(own.get(kind, NOTHING) for kind in types)])
    parts = [
        f"**Flattening**: the paper speaks of an asymptotic limit of omega_disr above {SPLIT / NM:g} nm. The power of "
        f"size there is{f', in cells of {FEW} grains and more,' if _thin(data) else ''}",
        markdown_table(["", *types], rows),
        _between_limit_and_fit(data, sources) + _with_thin_cells(data),
    ]
    return "\n\n".join(part for part in parts if part)


def without_thin_cells(table):
    """Grains of a table but those of large cells (from `ratd.beyond.SPLIT` on) of fewer than `FEW` grains."""
    cell = cell_of(table)
    thin = np.bincount(cell)[cell] < FEW
    return table[~(thin & table.index.isin(split_sizes(table)[-1].index))]


def _thin(data):
    """Drive -> number of large cells that `without_thin_cells` leaves out, where there are any."""
    count = {drive: table.drop(without_thin_cells(table).index) for drive, table in data.tables.items()}
    return {drive: len(np.unique(cell_of(part))) for drive, part in count.items() if len(part)}


def _with_thin_cells(data):
    """Sentences: the powers of size with all cells, for each drive that has some of few grains."""
    words = []
    for drive, thin in _thin(data).items():
        powers = slopes(data.tables[drive])
        told = [
            f"{row['type']} {with_error(row['above'], row['above_error'])}"
            for _, row in powers[powers["above"].notna()].iterrows()
        ]
        words.append(
            f" {thin} of the large cells of the drive `{drive}` have fewer than {FEW} grains each; with them, "
            f"each counting as much as the others, the power is {', '.join(told)}."
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
    """That the grains are like those of the paper: contacts a monomer of those of Fig. 1, and what is unlike ours."""
    over = grown.contacts_over_printed(data)
    if not over:
        return []
    *_, outside = grown.figure1_table(data)
    rest = f", but for {', '.join(outside)} of the printed ones; why is not known" if outside else ""
    return [
        "**Not the grains**: their numbers of monomers follow Fig. 1, from which the radii of the monomers were taken, "
        "as the printed mean radius gives far more monomers than the figure has (The grains of the text). Those of "
        f"Fig. 1 have {between(min(over), max(over))} times the printed contacts a monomer "
        f"({plural(len(over), 'grain')}), and numbers and outer radii as printed within 95 % of ours{rest}."
    ]
