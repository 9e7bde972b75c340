"""Rows of what is known before the spin-up: radii, porosity, fractal dimension, time step."""

from dataclasses import replace

import numpy as np

from ratd.beyond import SPLIT
from ratd.ensemble import PAPER_MEAN_RADIUS, cell_of, size_key
from ratd.growth import RadiusDistribution
from ratd.reproduction.argument import printed_porosity
from ratd.reproduction.bounds import PM, whole_nm
from ratd.reproduction.pair_test import printed_step
from ratd.reproduction.paper import GRAINS, MOST, PRINTED
from ratd.reproduction.text import (
    NOTHING,
    Answer,
    Row,
    all_of,
    answer,
    between,
    lies_in,
    near,
    number,
    over,
    with_error,
)
from ratd.statistics import mean_of, median_of
from ratd.units import NM

STAGNATES = 0.05
"""Change of the mean porosity from `SPLIT` on that counts as none."""
COMPACT = 3.0
"""Fractal dimension above which a fit means nothing: that of a solid body."""
OF_FIG_1 = {"N_mon": "n_monomers", "N_con": "n_contacts", "a_out [nm]": "enclosing_radius"}
"""What Fig. 1 tells of each grain -> column of the table of grains."""


def rows(data):
    """Rows that need no spin-up, list of Row."""
    table = data.grown
    mean = mean_of(table["mean_monomer_radius"], cell_of(table))
    printed, growth = PRINTED["mean_radius"], data.plan.config["growth"]
    radius = Row(
        "mean_radius",
        {"": replace(answer(*mean, printed), text=f"{with_error(*(value / NM for value in mean))} nm")},
        f"With monomers of {PAPER_MEAN_RADIUS / NM:g} nm a grain of 500 nm would hold "
        f"{(500 * NM / PAPER_MEAN_RADIUS) ** 3:.0f} of them, where Fig. 1 has {GRAINS['BA', 500][0]}; median "
        f"{growth['median_nm']:g} nm with sigma_ln {growth['sigma_ln']:g} gives the numbers of Fig. 1.",
    )
    return [radius, _deviation(data), *_porosity(data), *_fractal(data.at_rest), *_step(data)]


def _deviation(data):
    """Row of the standard deviation of the radii, which follows from their distribution."""
    radii = RadiusDistribution(**data.plan.radii)
    value, printed = np.sqrt(radii.moment(2) - radii.moment(1) ** 2), PRINTED["deviation"]
    found = Answer(f"{number(value / NM)} nm", over(value, printed.value), near(value, printed.value))
    reason = "With it nearly all monomers would have the mean radius, and a grain far too many of them, as for 20 nm."
    return Row("deviation", {"": found}, reason)


def _porosity(data):
    table = data.at_rest
    reason = (
        "Mean of each size; the least is that of the smallest. With 15/(8 pi) in Eq. 3; the printed 5/(4 pi), which "
        f"gives a solid sphere P = {printed_porosity(0.0):.2f}, would make all of it lower. Why it is higher than "
        "printed in large grains, where it is, is not known."
    )
    result = []
    for kind, own in table.groupby("type", sort=False):
        means = {
            size * PM / NM: mean_of(part["porosity"], cell_of(part))
            for size, part in own.groupby(size_key(own["a_eff"]))
        }
        least, greatest = min(means.values()), max(means.values())
        single = data.grown.loc[data.grown["type"] == kind, "porosity"]
        for key in (f"porosity_{kind}", f"porosity_{kind}_text"):
            if key in PRINTED:
                low, high = PRINTED[key].value
                verdicts = {size: lies_in(*mean, 0.9 * low, 1.1 * high) for size, mean in means.items()}
                outside = ", ".join(f"{size:g}" for size, verdict in verdicts.items() if verdict is False)
                text = f"{with_error(*least)} to {with_error(*greatest)} (single grains "
                text += between(single.min(), single.max())
                text += f"; outside at {outside} nm)" if outside else ")"
                found = Answer(text, over((least[0], greatest[0]), PRINTED[key].value), all_of(verdicts.values()))
                result.append(Row(key, {"": found}, reason))
    changes = _changes(table, "porosity", SPLIT, mean_of)
    holds = all_of(lies_in(*change, -STAGNATES, STAGNATES) for _, _, change in changes)
    before = [f"{kind} {number(_before(table, kind))}" for kind, _, _ in changes]
    reason = f"From the smallest size to {SPLIT / NM:g} nm it changes by {', '.join(before)}."
    return [*result, Row("porosity_slope", {"": Answer(_told(changes), holds=holds)}, reason)]


def _fractal(table):
    known = table[table["fractal_dimension"].notna()]
    own = known[known["type"] == "BA"]
    fractal = median_of(own["fractal_dimension"], cell=cell_of(own))
    many = f"{int((known['fractal_dimension'] > COMPACT).sum())} of {len(known)}"
    reason = (
        f"Median. The paper says this of ballistic growth in general; Eq. 8 leaves the range of distances of the fit "
        f"open. {many} fits, of grains of few monomers, give more than {COMPACT:g}, which means nothing."
    )
    share = table["fractal_dimension"].notna().groupby(size_key(table["a_eff"])).mean()
    from_size = share.index[share == 1].min() * PM  # nothing where no size has it for all
    changes = _changes(known, "fractal_dimension", SPLIT, _median)
    holds = all_of(lies_in(*change, 0.0) for _, _, change in changes)
    smaller = _changes(known, "fractal_dimension", from_size, _median)
    return [
        Row("fractal_BA", {"": answer(fractal["median"], fractal["error"], PRINTED["fractal_BA"])}, reason),
        Row(
            "fractal_slope",
            {"": Answer(_told(changes), holds=holds)},
            f"From the smallest size at which every grain has a fit, of few monomers: {_told(smaller)}.",
        ),
    ]


def _changes(table, column, start, statistic):
    """(type, sizes in nm, (change, error)) of a column, from the size nearest to `start` to the greatest of each type.

    `statistic` makes value and error of the grains of a size.
    """
    found = []
    for kind, own in table.groupby("type", sort=False):
        sizes = size_key(own["a_eff"])
        known = np.unique(sizes)
        ends = known[np.argmin(np.abs(known * PM - start))], known[-1]
        if np.isfinite(start) and ends[0] < ends[1]:
            first, last = (statistic(own.loc[sizes == end, column]) for end in ends)
            found.append((kind, [end * PM / NM for end in ends], (last[0] - first[0], np.hypot(first[1], last[1]))))
    return found


def _median(values):
    found = median_of(values)
    return found["median"], found["error"]


def _told(changes):
    parts = [f"{kind} {with_error(*change)} ({ends[0]:g} to {ends[1]:g} nm)" for kind, ends, change in changes]
    return "; ".join(parts) or NOTHING


def _before(table, kind):
    """Change of the mean porosity of a type from its smallest size to the one nearest to `SPLIT`."""
    own = table[table["type"] == kind]
    means = own["porosity"].groupby(size_key(own["a_eff"])).mean()
    return means.iloc[np.argmin(np.abs(means.index * PM - SPLIT))] - means.iloc[0]


def _step(data):
    steps = [printed_step(data.plan.materials[name], 10 * NM) for name in data.plan.config["materials"]]
    printed = PRINTED["step"]
    ends = (min(steps), max(steps))
    text = f"{between(*(1e12 * end for end in ends))} ps"
    found = Answer(text, over(ends, printed.value), near(ends, printed.value))
    return [Row("step", {"": found}, "Eq. 31 as printed gives parts of a ps; “ns” does not follow from it.")]


def figure1_table(data):
    """The nine grains of Fig. 1: head and rows of a table in Markdown, and where the printed ones lie among ours.

    Returns
    -------
    head : list of str
        type, size, and for each of `OF_FIG_1`: printed, ours, range of `MOST` of our grains of that type and size.
    rows : list of list of str
    outside : list of str
        Printed values outside that range, such as "a_out of BAM1 350 nm".
    """
    head = ["type", "size [nm]"]
    head += [f"{what}{of}" for what in OF_FIG_1 for of in (", printed", ", ours", ", 95 % of ours")]
    ours = {(grain.type, round(grain.a_eff / NM)): grain for grain in data.grains}
    size = whole_nm(data.grown)
    rows, outside = [], []
    for (kind, nm), printed in GRAINS.items():
        grain, all_ours = ours.get((kind, nm)), data.grown[(data.grown["type"] == kind) & (size == nm)]
        cells = [kind, str(nm)]
        for (what, column), value in zip(OF_FIG_1.items(), printed, strict=True):
            unit = NM if column == "enclosing_radius" else 1
            low, high = all_ours[column].quantile(MOST) / unit if len(all_ours) else (np.nan, np.nan)
            cells += [f"{value:g}", f"{getattr(grain, column) / unit:.4g}" if grain else NOTHING, between(low, high)]
            if value < low or value > high:
                outside.append(f"{what.split()[0]} of {kind} {nm} nm ({'below' if value < low else 'above'})")
        rows.append(cells)
    return head, rows, outside


def contacts_over_printed(data):
    """N_con/N_mon of the grains of Fig. 1 over the printed, list of float; those of the paper's sizes only."""
    over = []
    for grain in data.grains:
        key = (grain.type, round(grain.a_eff / NM))
        if key in GRAINS:
            monomers, contacts, _ = GRAINS[key]
            over.append(grain.n_contacts / grain.n_monomers / (contacts / monomers))
    return over
