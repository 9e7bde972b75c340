"""Rows of how the monomers lie in a grain as grown: how densely, which of them inside, and its fractal dimension."""

import numpy as np

from ratd.ensemble import size_key
from ratd.reproduction.bounds import PM
from ratd.reproduction.course import BAM
from ratd.reproduction.text import Answer, Row, all_of, lies_between, lies_in, number, with_error
from ratd.statistics import mean_of
from ratd.units import NM

CORRELATED = 0.3
"""Rank correlation from which on two things are well correlated."""
BEYOND = 1.5
"""Factor in the number of monomers to which the curve of aggregates of equal ones is continued."""
FEWEST = 10
"""Grains of a size below which nothing is said of it."""


def rows(data):
    """Rows of the structure, list of Row."""
    return [_compact(data.study("growth")), _deeper(data.grains), _fractal_shape(data.grown)]


def _compact(table):
    """Porosity of grains with the radii of the ensemble, less that of as many equal monomers."""
    if table is None:
        return Row("compact")
    table = table[(table["migration"] == "nearest") & table["type"].isin(BAM)]
    parts, verdicts = [], []
    for kind, own in table.groupby("type", sort=False):
        equal, grains = (own[own["study"] == study] for study in ("aggregates", "grains"))
        if equal["n_monomers"].nunique() < 3:
            continue
        scatter = equal.groupby("n_monomers")["porosity"].transform("std")
        curve, covariance = np.polyfit(np.log(equal["n_monomers"]), equal["porosity"], 2, w=1 / scatter, cov="unscaled")
        grains = grains[grains["n_monomers"].between(equal["n_monomers"].min(), BEYOND * equal["n_monomers"].max())]
        told = []
        for size, part in grains.groupby(size_key(grains["a_eff"])):
            if len(part) < FEWEST:
                continue
            place = np.vander(np.log(part["n_monomers"]), 3)
            less, mean = part["porosity"] - place @ curve, place.mean(axis=0)
            value = less.mean(), np.hypot(less.sem(), np.sqrt(mean @ covariance @ mean))
            told.append(f"{with_error(*value)} ({size * PM / NM:g} nm)")
            verdicts.append(lies_between(*value, high=0.0))
        parts.append(f"{kind} {', '.join(told)}")
    reason = (
        "Grains like those of Fig. 1, but not of the ensemble, against a parabola in ln N_mon through aggregates of "
        "equal monomers (docs/validation.md, Growth), as far as these go; all migrate to the nearest place."
    )
    return Row("compact", {"": Answer("; ".join(parts), holds=all_of(verdicts))} if verdicts else {}, reason)


def _deeper(grains):
    """Whether smaller monomers lie deeper in the BAM grains of Fig. 1 than in its BA grains, which do not migrate."""
    found = {}
    for grain in grains:
        found.setdefault(grain.type, []).append(_rank_correlation(grain.radius, _depth(grain)))
    means = {kind: mean_of(values) for kind, values in found.items()}
    parts, verdicts = [], []
    for kind in BAM:
        if {"BA", kind} <= set(means):
            value = means[kind][0] - means["BA"][0], np.hypot(means[kind][1], means["BA"][1])
            parts.append(f"{kind} {with_error(*value)}")
            verdicts.append(lies_between(*value, low=0.0))
    answers = {"": Answer("; ".join(parts), holds=all_of(verdicts))} if parts else {}
    all_types = ", ".join(f"{kind} {number(mean)}" for kind, (mean, _) in means.items())
    return Row("deeper", answers, f"Grains of Fig. 1, ± from how they differ. The correlation itself is {all_types}.")


def _depth(grain):
    """Distance of each monomer from the centre of mass [m], shape (n,)."""
    centre = np.average(grain.position, axis=0, weights=grain.radius**3)
    return np.linalg.norm(grain.position - centre, axis=1)


def _rank_correlation(x, y):
    """Spearman's correlation of two samples of equal length, without regard to ties."""
    return float(np.corrcoef(np.argsort(np.argsort(x)), np.argsort(np.argsort(y)))[0, 1])


def _fractal_shape(table):
    """Rank correlation of the fractal dimension with c/a within each size; mean over the sizes of a type."""
    known = table[table["fractal_dimension"].notna()]
    parts, verdicts = [], []
    for kind, own in known.groupby("type", sort=False):
        sizes = [part for _, part in own.groupby(size_key(own["a_eff"])) if len(part) >= FEWEST]
        if len(sizes) < 2:
            continue
        found = [_rank_correlation(part["fractal_dimension"], part["axis_c"] / part["axis_a"]) for part in sizes]
        value = mean_of(found)
        parts.append(f"{kind} {with_error(*value)}")
        verdicts.append(lies_in(*value, -CORRELATED, CORRELATED))
    answers = {"": Answer("; ".join(parts), holds=all_of(verdicts))} if parts else {}
    return Row("fractal_shape", answers, "Spearman's, of the grains of one type and size; mean over the sizes.")
