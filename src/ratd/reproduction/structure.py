"""Rows of how the monomers lie in a grain as grown: how densely, which of them inside, and its fractal dimension."""

import numpy as np

from ratd.ensemble import size_key
from ratd.reproduction.bounds import PM
from ratd.reproduction.course import BAM
from ratd.reproduction.text import Answer, Row, all_of, lies_between, lies_in, with_error
from ratd.statistics import mean_of, rank_correlation, rank_correlation_error
from ratd.units import NM

CORRELATED = 0.3
"""Rank correlation from which on two things are well correlated."""
FEWEST = 10
"""Grains of a size below which nothing is said of it."""


def rows(data):
    """Rows of the structure, list of Row."""
    growth, migration = data.study("growth"), data.plan.config["growth"]["migration"]
    return [_compact(growth, migration, data.at_rest), _deeper(data.alike), _fractal_shape(data.at_rest)]


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
            parts.append(f"{kind} {_at_ends(told)}")
        verdicts += [lies_between(*value, high=0.0) for value in told.values()]
    reason = (
        "The smallest and the greatest size of which all grains have as many monomers as some aggregates of equal ones "
        "(docs/validation.md, Growth), between which the logarithm of the number is interpolated; the verdict counts "
        "the sizes between as well."
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


def _deeper(alike):
    """Whether smaller monomers lie deeper in BAM grains than in BA grains, which do not migrate."""
    if alike is None:
        return Row("deeper")
    sizes = size_key(alike["a_eff"])
    found = {key: mean_of(part) for key, part in alike.groupby(["type", sizes])["depth_correlation"]}
    parts, verdicts = [], []
    for kind in BAM:
        told = {}
        for size in (size for other, size in found if other == kind and ("BA", size) in found):
            (mean, error), (plain, plain_error) = found[kind, size], found["BA", size]
            told[size] = mean - plain, np.hypot(error, plain_error)
        parts += [f"{kind} {_at_ends(told)}"] if told else []
        verdicts += [lies_between(*value, low=0.0) for value in told.values()]
    if not verdicts:
        return Row("deeper")
    plain = {size: value for (kind, size), value in found.items() if kind == "BA"}
    reason = f"The correlation itself is {_at_ends(plain)} in BA; the verdict counts the sizes between as well."
    return Row("deeper", {"": Answer("; ".join(parts), holds=all_of(verdicts))}, reason)


def _at_ends(values):
    """Values with errors at the smallest and the greatest size, text."""
    ends = sorted({min(values), max(values)})
    return ", ".join(f"{with_error(*values[size])} ({size * PM / NM:g} nm)" for size in ends)


def _fractal_shape(table):
    """Rank correlation of the fractal dimension with c/a within each size; mean over the sizes of a type.

    These sizes are meant: by how much they differ is no uncertainty.
    """
    known = table[table["fractal_dimension"].notna()]
    parts, verdicts = [], []
    for kind, own in known.groupby("type", sort=False):
        sizes = [part for _, part in own.groupby(size_key(own["a_eff"])) if len(part) >= FEWEST]
        if len(sizes) < 2:
            continue
        found = [rank_correlation(part["fractal_dimension"], part["axis_c"] / part["axis_a"]) for part in sizes]
        errors = rank_correlation_error(found, [len(part) for part in sizes])
        value = np.mean(found), np.linalg.norm(errors) / len(sizes)
        parts.append(f"{kind} {with_error(*value)}")
        verdicts.append(lies_in(*value, -CORRELATED, CORRELATED))
    answers = {"": Answer("; ".join(parts), holds=all_of(verdicts))} if parts else {}
    return Row("fractal_shape", answers, "Spearman's, of the grains of one type and size; mean over the sizes.")
