"""Rows of the shapes: oblate or prolate, axis ratios, porosity, at rest and at disruption (Sect. 7.3 and Fig. 6)."""

import numpy as np

from ratd.beyond import is_oblate, oblate_share
from ratd.ensemble import cell_of
from ratd.reproduction.bounds import sizes_of, split_sizes
from ratd.reproduction.course import BAM
from ratd.reproduction.text import (
    NOTHING,
    Answer,
    all_of,
    drive_rows,
    lies_between,
    lies_in,
    near,
    number,
    over,
    with_error,
)
from ratd.statistics import mean_of, median_of
from ratd.units import NM

ABOUT_HALF = (0.4, 0.6)
"""Shares that count as a half."""
ALIKE = 0.05
"""Difference of two mean porosities that counts as none."""
REMNANTS = (
    "Median and mean. The largest fragment is less porous than the grain where mass has left, which lowers the mean."
)


LONGER = " Where both grow alike, a grain becomes longer, but no more oblate."


def rows(data):
    """Rows of the shapes, list of Row."""
    # the shape of a grain hardly changes when it comes to rest
    at_rest = data.at_rest
    grown = {"": at_rest.assign(**{f"axis_{name}_start": at_rest[f"axis_{name}"] for name in "abc"})}
    tables, deformed = data.tables, _deformation(data.tables)
    return [
        drive_rows("half", grown, _oblate("start", *ABOUT_HALF), _off_half(grown[""])),
        drive_rows("oblate_start_200", grown, _oblate("start", *ABOUT_HALF, 200)),
        *(
            drive_rows(f"oblate_start_{size}", grown, _oblate("start", 0.3, 0.5, size), _more_prolate(grown[""], size))
            for size in (350, 500)
        ),
        drive_rows("c_over_b", grown, _slender),
        drive_rows("oblate_disr", tables, _oblate("disr", 0.5, 1.0, types=BAM), deformed + LONGER),
        drive_rows("oblate_disr_BA", tables, _oblate("disr", 0.0, 0.5, 200, ("BA",))),
        drive_rows("more_oblate", tables, more_oblate, deformed + LONGER),
        drive_rows("b_over_a", tables, _flattest, deformed),
        drive_rows("b_over_a_BA", tables, _less_flat, "Arms of BA grains swing out and stretch before they part."),
        drive_rows("porosity_change_BA", tables, _loosened(("BA",), -np.inf, 0.0), REMNANTS),
        drive_rows("porosity_change_BAM", tables, _loosened(BAM, 0.0, np.inf), REMNANTS),
        drive_rows("porosity_alike", tables, _alike),
        drive_rows("variation", tables, _variation, "Mean distance from the mean of the cell."),
    ]


def _off_half(table):
    """A sentence, if the share of oblate grains at rest is a half by the rule, but not within its error."""
    share, error, *_ = oblate_share(table, "start")
    if not lies_in(share, error, *ABOUT_HALF) or abs(share - 0.5) <= 2 * error:
        return ""
    side = "prolate" if share < 0.5 else "oblate"
    return f"About a half by the rule, yet {abs(share - 0.5) / error:.0f} errors from it: more grains are {side}."


def _more_prolate(table, size):
    """A sentence: by how much the share of oblate grains at rest differs from that of 200 nm."""
    (here, error), (there, other) = (oblate_share(_chosen(table, own), "start")[:2] for own in (size, 200))
    return f"Less that of 200 nm it is {with_error(here - there, np.hypot(error, other))}." if here == here else ""


def _deformation(tables):
    """A sentence: by how much the axis ratios of BAM grains have grown at omega_disr, for each drive."""
    parts = []
    for drive, table in tables.items():
        known = _chosen(table, types=BAM).dropna(subset=["axis_c_disr"])
        types = [f"{kind} {_growth(own, 'b', 'a')} and {_growth(own, 'c', 'b')}" for kind, own in known.groupby("type")]
        parts += [f"{drive} {', '.join(types)}"] if types else []
    if not parts:
        return ""
    return f"From rest to omega_disr b/a and c/b grow, in the median, by factors of {'; '.join(parts)}."


def _growth(table, long, short):
    """Median factor, text, by which an axis over another has grown at omega_disr."""
    ratio = {when: table[f"axis_{long}_{when}"] / table[f"axis_{short}_{when}"] for when in ("start", "disr")}
    return number(median_of(ratio["disr"] / ratio["start"], cell=cell_of(table))["median"])


def _chosen(table, sizes=None, types=None):
    if sizes is not None:
        table = table[np.isin(np.round(table["a_eff"] / NM), sizes)]
    return table if types is None else table[table["type"].isin(types)]


def _oblate(when, low, high, size=None, types=None):
    """What evaluates the share of oblate grains, which is to lie between `low` and `high`."""

    def evaluate(table, printed):
        table = _chosen(table, size, types)
        share, error, n_oblate, n = oblate_share(table, when)
        if not n:
            return None
        by = "type" if types == BAM or table["material"].nunique() == 1 else "material"
        parts = ", ".join(f"{name} {oblate_share(part, when)[2]}" for name, part in table.groupby(by, sort=False))
        text = f"{with_error(share, error)} (raw count {n_oblate} of {n}: {parts})"
        if table["a_eff"].nunique() > 1:
            sides = [(sizes_of(part), oblate_share(part, when)) for part in split_sizes(table)]
            text += "; " + ", ".join(f"{sizes} {with_error(*own[:2])}" for sizes, own in sides)
        ratio = over(share, printed.value) if printed.value else NOTHING
        return Answer(text, ratio, lies_in(share, error, low, high))

    return evaluate


def more_oblate(table, printed):
    """Mean change of being oblate from rest to omega_disr, of the grains whose shape is known at both.

    Parameters
    ----------
    table : pandas.DataFrame
        One row a grain, of one drive.
    printed : ratd.reproduction.paper.Printed or None
        What the paper says; not needed.

    Returns
    -------
    Answer or None
        None without BAM grains of known shapes.
    """
    shapes = {when: [table[f"axis_{axis}_{when}"].to_numpy(float) for axis in "abc"] for when in ("start", "disr")}
    known = np.all([np.isfinite(axes).all(axis=0) & (axes[0] > 0) for axes in shapes.values()], axis=0)
    became = is_oblate(*shapes["disr"]).astype(int) - is_oblate(*shapes["start"])
    own = table.assign(became=became)[known]
    bam = own[own["type"].isin(BAM)]
    if not len(bam):
        return None
    value = mean_of(bam["became"], cell_of(bam))
    types = ", ".join(
        f"{kind} {with_error(*mean_of(part['became'], cell_of(part)))}"
        for kind, part in own.groupby("type", sort=False)
    )
    return Answer(f"{with_error(*value)} ({types})", holds=lies_between(*value, 0.0))


def _slender(table, printed):
    here = _chosen(table, (350, 500))
    ratio = here["axis_c_start"] / here["axis_b_start"]
    known = here[ratio.notna()]
    if not len(known):
        return None
    share, error = mean_of(ratio[ratio.notna()] < 1.7, cell_of(known))
    return Answer(f"{int((ratio < 1.7).sum())} of {len(known)}", holds=lies_in(share, error, 0.5))


def _flatness(table, types):
    """b/a of the largest fragments at omega_disr, and the cell of each, of the grains of some types."""
    here = _chosen(table, types=types)
    here = here[here["axis_b_disr"].notna()]
    return here["axis_b_disr"] / here["axis_a_disr"], cell_of(here)


def _flattest(table, printed):
    ratio, cell = _flatness(table, BAM)
    if not len(ratio):
        return None
    text = f"{ratio.max():.3g} (median {median_of(ratio, cell=cell)['median']:.3g})"
    return Answer(text, over(ratio.max(), printed.value), near(ratio.max(), printed.value))


def _less_flat(table, printed):
    both = [_flatness(table, types) for types in (("BA",), BAM)]
    if not all(len(ratio) for ratio, _ in both):
        return None
    ba, bam = (median_of(ratio, cell=cell) for ratio, cell in both)
    value = ba["median"] / bam["median"]
    error = value * np.hypot(ba["error"] / ba["median"], bam["error"] / bam["median"])
    text = f"{with_error(value, error)} (BA up to {both[0][0].max():.3g})"
    return Answer(text, holds=lies_in(value, error, 0.0, 1.0))


def _loosened(types, low, high):
    """What evaluates median and mean change of the porosity of each type, which are to lie between `low` and `high`."""

    def evaluate(table, printed):
        parts, verdicts = [], []
        for kind, own in _chosen(table, types=types).groupby("type", sort=False):
            change, cell = own["porosity_disr"] - own["porosity_start"], cell_of(own)
            found, mean = median_of(change, cell=cell), mean_of(change, cell)
            if not found["n"]:
                continue
            median = found["median"], found["error"]
            parts.append(f"{kind} {with_error(*median)}, {with_error(*mean)}")
            verdicts += [lies_in(*value, low, high) for value in (median, mean)]
        return Answer("; ".join(parts), holds=all_of(verdicts)) if parts else None

    return evaluate


def _variation(table, printed):
    """Mean distance of the porosity from the mean of its cell at omega_disr less that at rest, of each type."""
    parts, verdicts = [], []
    for kind, own in _chosen(table, types=BAM).groupby("type", sort=False):
        own = own[own["porosity_disr"].notna()]
        own = own.assign(cell=cell_of(own)).groupby("cell").filter(lambda part: len(part) > 1)
        cells = own.groupby("cell")
        off = {
            when: (own[f"porosity_{when}"] - cells[f"porosity_{when}"].transform("mean")).abs()
            for when in ("disr", "start")
        }
        value = mean_of(off["disr"] - off["start"], own["cell"])
        if np.isfinite(value[0]):
            at_rest = mean_of(off["start"], own["cell"])[0]
            parts.append(f"{kind} {with_error(*value)} (at rest {number(at_rest)})")
            verdicts.append(lies_between(*value, 0.0))
    return Answer("; ".join(parts), holds=all_of(verdicts)) if parts else None


def _alike(table, printed):
    """Mean porosity of BAM1 less that of BAM2 at omega_disr, and at rest."""
    differences = []
    for when in ("disr", "start"):
        one, two = (_chosen(table, types=(kind,)) for kind in BAM)
        means = [mean_of(own[f"porosity_{when}"], cell_of(own)) for own in (one, two)]
        differences.append((means[0][0] - means[1][0], np.hypot(means[0][1], means[1][1])))
    at_disr, at_rest = differences
    if not np.isfinite(at_disr[0]):
        return None
    return Answer(f"{with_error(*at_disr)} (at rest {with_error(*at_rest)})", holds=lies_in(*at_disr, -ALIKE, ALIKE))
