"""Rows of how the monomers lie in a grain as grown: how densely, which of them inside, and its fractal dimension."""

import numpy as np

from ratd.ensemble import size_key
from ratd.reproduction.bounds import PM
from ratd.reproduction.course import BAM
from ratd.reproduction.text import Answer, Row, all_of, lies_between, lies_in, number, with_error
from ratd.statistics import mean_of, rank_correlation
from ratd.units import NM
from ratd.validation.growth import NOT

CORRELATED = 0.3
"""Rank correlation from which on two things are well correlated."""
FEWEST = 10
"""Grains of a size below which nothing is said of it."""


def rows(data):
    """Rows of the structure, list of Row."""
    growth, migration = data.study("growth"), data.plan.config["growth"]["migration"]
    return [_compact(growth, migration, data.grown), _deeper(growth, migration), _fractal_shape(data.grown)]


def _compact(growth, migration, grown):
    """Porosity of the grown BAM grains, less that of as many equal monomers that migrated alike."""
    if growth is None:
        return Row("compact")
    equal = growth[(growth["study"] == "aggregates") & (growth["migration"] == migration)]
    parts, verdicts = [], []
    for kind in BAM:
        curve = equal[equal["type"] == kind].groupby("n_monomers")["porosity"].agg(["mean", "sem"])
        told = {}
        for size, part in grown[grown["type"] == kind].groupby(size_key(grown["a_eff"])):
            inside = part["n_monomers"].between(curve.index.min(), curve.index.max())
            if inside.all() and len(part) >= FEWEST:
                told[size] = _less(part, curve)
        if told:
            ends = sorted({min(told), max(told)})
            parts.append(f"{kind} {', '.join(f'{with_error(*told[size])} ({size * PM / NM:g} nm)' for size in ends)}")
        verdicts += [lies_between(*value, high=0.0) for value in told.values()]
    reason = (
        "The ensemble as grown, the smallest and the greatest size of whose grains all have as many monomers as some "
        "aggregates of equal ones (docs/validation.md, Growth), between which the logarithm of the number is "
        "interpolated; the verdict counts the sizes between as well."
    )
    return Row("compact", {"": Answer("; ".join(parts), holds=all_of(verdicts))} if verdicts else {}, reason)


def _less(grains, curve):
    """Mean porosity of grains less that of a curve at as many monomers, and its standard error.

    Parameters
    ----------
    grains : pandas.DataFrame
    curve : pandas.DataFrame
        Number of monomers -> mean porosity and its standard error, straight against the logarithm between.
    """
    at = np.log(curve.index)
    # how much each point of the curve counts in the interpolated porosity of each grain
    share = np.column_stack([np.interp(np.log(grains["n_monomers"]), at, unit) for unit in np.eye(len(at))])
    less = grains["porosity"] - share @ curve["mean"].to_numpy()
    return less.mean(), float(np.hypot(less.sem(), np.linalg.norm(share.mean(axis=0) * curve["sem"])))


def _deeper(growth, migration):
    """Whether smaller monomers lie deeper in BAM grains than in BA grains, which do not migrate."""
    if growth is None:
        return Row("deeper")
    own = growth[(growth["study"] == "grains") & growth["migration"].isin([migration, NOT])]
    found = {key: mean_of(part) for key, part in own.groupby(["type", size_key(own["a_eff"])])["depth_correlation"]}
    parts, verdicts = [], []
    for kind in BAM:
        told = []
        for size in sorted(size for other, size in found if other == kind and ("BA", size) in found):
            (mean, error), (plain, plain_error) = found[kind, size], found["BA", size]
            value = mean - plain, np.hypot(error, plain_error)
            told.append(f"{with_error(*value)} ({size * PM / NM:g} nm)")
            verdicts.append(lies_between(*value, low=0.0))
        parts += [f"{kind} {', '.join(told)}"] if told else []
    answers = {"": Answer("; ".join(parts), holds=all_of(verdicts))} if verdicts else {}
    plain = ", ".join(
        f"{number(mean)} ({size * PM / NM:g} nm)" for (kind, size), (mean, _) in found.items() if kind == "BA"
    )
    return Row(
        "deeper", answers, f"Grains that are grown as those of the ensemble. The correlation itself is {plain} in BA."
    )


def _fractal_shape(table):
    """Rank correlation of the fractal dimension with c/a within each size; mean over the sizes of a type."""
    known = table[table["fractal_dimension"].notna()]
    parts, verdicts = [], []
    for kind, own in known.groupby("type", sort=False):
        sizes = [part for _, part in own.groupby(size_key(own["a_eff"])) if len(part) >= FEWEST]
        if len(sizes) < 2:
            continue
        found = [rank_correlation(part["fractal_dimension"], part["axis_c"] / part["axis_a"]) for part in sizes]
        value = mean_of(found)
        parts.append(f"{kind} {with_error(*value)}")
        verdicts.append(lies_in(*value, -CORRELATED, CORRELATED))
    answers = {"": Answer("; ".join(parts), holds=all_of(verdicts))} if parts else {}
    return Row("fractal_shape", answers, "Spearman's, of the grains of one type and size; mean over the sizes.")
