"""Slots of docs/collision.md that set samples or single collisions beside each other, and what samples are."""

import numpy as np
import pandas as pd
from scipy.stats import norm as normal
from scipy.stats import t as student

from ratd.aggregates.mrn import free_samples, mrn, sample_length, sample_moment
from ratd.base.statistics import mean_of
from ratd.base.units import NM
from ratd.experiments.collision.document_texts import with_error
from ratd.experiments.collision.fragmentation import (
    fragmentation_velocities,
    fragmentation_velocity,
    mean_and_error,
    means,
)
from ratd.experiments.collision.likeness import is_equal, likeness_table

__all__ = [
    "at_own_v_frag",
    "by_sample",
    "chance_of_change",
    "change_by",
    "change_by_half",
    "halved",
    "largest",
    "of_same_samples",
    "radius_by_half",
    "samples_of_the_law",
    "together",
    "with_and_without",
]

SPHERES = 5000
"""Of a sample of the MRN law (Sect. 2.3)."""
MASS_UNIT = 1e-13
"""[kg]"""


def with_and_without(table, columns):
    """Values of collisions of the same radii and rotations, with all spheres of MRN and without those below 100 nm.

    ``both X velocity mrn 30`` and ``both X velocity mrn100 30``; ``both velocity 30``: how many; ``gain X velocity
    30``: by how much the mean of a sample is greater with them, mean over the samples.
    """
    alike = ["law", "velocity", "sample", "seed"]
    table = table[table["impact_parameter"] == 0]
    parts = {cluster: table[table["cluster"] == cluster] for cluster in ("mrn", "mrn100")}
    pairs = parts["mrn"][alike].merge(parts["mrn100"][alike])
    found = {}
    for cluster, part in parts.items():
        for (law, velocity), own in part.merge(pairs).groupby(["law", "velocity"]):
            found[f"both {law} {velocity:g}"] = str(len(own))
            for column in columns:
                found[f"both {column} {law} {cluster} {velocity:g}"] = with_error(*mean_and_error(own, column))
    with_all, without = (part.merge(pairs).groupby(alike[:3])[list(columns)].mean() for part in parts.values())
    for (law, velocity), own in (with_all - without).groupby(alike[:2]):
        for column in columns:
            found[f"gain {column} {law} {velocity:g}"] = with_error(*mean_of(own[column].to_numpy()))
    return found


def of_same_samples(table):
    """Values of MRN above 0.1 um with rate friction, of the samples that another cluster or law has.

    ``beside X velocity mrn100_tree 15`` and ``beside X spring mrn100 15``; ``change X ...``: what the other one has
    more, mean and error over the samples.
    """
    table = table[table["impact_parameter"] == 0]
    base = table[(table["law"] == "velocity") & (table["cluster"] == "mrn100")]
    found = {}
    for law, cluster in (("velocity", "mrn100_tree"), ("spring", "mrn100")):
        other = table[(table["law"] == law) & (table["cluster"] == cluster)]
        for velocity, part in base[base["sample"].isin(other["sample"].unique())].groupby("velocity"):
            for column in ("X", "N_s"):
                key = f"{column} {law} {cluster} {velocity:g}"
                found[f"beside {key}"] = with_error(*mean_and_error(part, column))
                changed = other[other["velocity"] == velocity].groupby("sample")[column].mean()
                more = (changed - part.groupby("sample")[column].mean()).dropna()
                if len(more) > 1:
                    found[f"change {key}"] = with_error(*mean_of(more.to_numpy()))
    return found


def halved(table):
    """What half the step changes in the same collisions: mean, and its error over samples, else over pairs.

    ``halved X CLUSTER``, ``halved N_s CLUSTER``; ``halved n CLUSTER``: how many pairs; ``halved scatter CLUSTER``:
    standard deviation of the change of N_s between them; ``halved chance COLUMN CLUSTER``: in one case of how many
    chance alone makes so great a mean change, see `chance_of_change`; ``halved chance together``: the same of N_s of
    all clusters (`together`); ``halved v_frag CLUSTER``: v_frag [m/s] if X is changed by the mean wherever pairs were
    done, and ``halved v_frag each CLUSTER``, by what it changes at each velocity.
    """
    found, chances = {}, []
    for cluster in sorted(table.loc[table["law"] == "half_step", "cluster"].unique()):
        for column in ("X", "N_s"):
            pairs = change_by_half(table, column, cluster)
            mean, error = mean_and_error(pairs, "change")
            chance = chance_of_change(pairs)
            found[f"halved {column} {cluster}"] = with_error(mean, error)
            found[f"halved chance {column} {cluster}"] = f"{1.0 / chance:.0f}"
            if column == "N_s":
                chances.append((mean, chance))
        for name, each in (("", False), (" each", True)):
            row = fragmentation_velocity(_by_half(table, "X", cluster, each), samples=2)
            found[f"halved v_frag{name} {cluster}"] = f"{row['velocity']:.1f}"
        found[f"halved n {cluster}"] = str(len(pairs))
        found[f"halved scatter {cluster}"] = f"{pairs['change'].std(ddof=1):.2f}"
    if chances:
        found["halved chance together"] = f"{1.0 / together(chances):.0f}"
    return found


def _by_half(table, column, cluster, each=False):
    """Collisions of a cluster with a column changed as half the step changes it, in the mean or at each velocity."""
    pairs = change_by_half(table, column, cluster)
    own = table[(table["law"] == "velocity") & (table["cluster"] == cluster) & (table["impact_parameter"] == 0)]
    if each:
        by_velocity = {velocity: mean_and_error(part, "change")[0] for velocity, part in pairs.groupby("velocity")}
        change = own["velocity"].map(by_velocity).fillna(0.0)
    else:
        near = own["velocity"].between(pairs["velocity"].min(), pairs["velocity"].max())
        change = np.where(near, mean_and_error(pairs, "change")[0], 0.0)
    return own.assign(**{column: own[column] + change})


def radius_by_half(table, cluster):
    """``halved radius X CLUSTER``: radius [nm] of the equal spheres that a cluster is like if half the step changes X.

    Or N_s; by the mean change, wherever pairs were done.
    """
    central = table[(table["law"] == "velocity") & (table["impact_parameter"] == 0)]
    found = {}
    for column in ("X", "N_s"):
        own = _by_half(table, column, cluster)
        # the least bootstrap: its errors are not told
        rows = likeness_table(pd.concat([own, central[is_equal(central)]]), samples=2)
        for _, row in rows[(rows["cluster"] == cluster) & (rows["quantity"] == column)].iterrows():
            found[f"halved radius {column} {cluster}"] = f"{row['radius'] / NM:.0f}"
    return found


def together(chances):
    """Probability, both sides, that independent tests come out so by chance, all counted alike (Stouffer 1949).

    Parameters
    ----------
    chances : list of tuple of float
        Of each test what is found, for its sign, and its probability of both sides.
    """
    z = [np.sign(value) * normal.isf(0.5 * chance) for value, chance in chances]
    return float(2.0 * normal.sf(abs(np.sum(z)) / np.sqrt(len(z))))


def at_own_v_frag(table, clusters):
    """``own N_s CLUSTER`` and ``own n_pieces CLUSTER``: of each sample at its own v_frag, mean and error over samples.

    Straight between velocities.
    """
    central = table[(table["law"] == "velocity") & (table["impact_parameter"] == 0)]
    found = {}
    for cluster in clusters:
        part = central[central["cluster"] == cluster]
        speeds = fragmentation_velocities(part) if len(part) else []
        for column, digits in (("N_s", 2), ("n_pieces", 0)) if len(speeds) else ():
            at = [
                np.interp(speed, *means(own, column)[:2])
                for speed, (_, own) in zip(speeds, part.groupby("sample"), strict=True)
            ]
            found[f"own {column} {cluster}"] = with_error(*mean_of(np.array(at)), digits)
    return found


def chance_of_change(pairs):
    """Probability of a mean ``change`` as far from 0 if half the step changes nothing (Student's t, both sides).

    Over samples where there are several, as the error of `fragmentation.mean_and_error`, else over pairs.
    """
    samples = pairs["sample"].nunique()
    mean, error = mean_and_error(pairs, "change")
    if mean == 0.0:
        return 1.0
    return float(2.0 * student.sf(abs(mean) / error, (samples if samples > 1 else len(pairs)) - 1))


def change_by(law, table, column, cluster):
    """Central collisions of a cluster that were done again under another law, and the ``change`` of a column."""
    own = table[(table["impact_parameter"] == 0) & (table["cluster"] == cluster)]
    again, before = (own[own["law"] == name] for name in (law, "velocity"))
    pairs = again.merge(before, on=["velocity", "sample", "seed"], suffixes=("", " before"))
    return pairs.assign(change=pairs[column] - pairs[f"{column} before"])


def change_by_half(table, column, cluster):
    """The same of collisions that were done again with half the step."""
    return change_by("half_step", table, column, cluster)


def largest(table):
    """``shares LAW CLUSTER``: parts of the mass in the largest sphere of each sample; ``ceilings``: one less that.

    ``mass LAW CLUSTER``: mass of both clusters [`MASS_UNIT`]; ``samples ...``: how many; ``by sample X ...``: means.
    """
    found = {}
    for (law, cluster), part in table.groupby(["law", "cluster"]):
        found[f"samples {law} {cluster}"] = str(part["sample"].nunique())
        for velocity, own in part[part["impact_parameter"] == 0].groupby("velocity"):
            means = np.sort(own.groupby("sample")["X"].mean().to_numpy())
            found[f"by sample X {law} {cluster} {velocity:g}"] = ", ".join(f"{mean:.2f}" for mean in means)
        each = part.groupby("sample")[["largest_share", "mass"]].first()
        numbers = {"shares": each["largest_share"], "ceilings": 1.0 - each["largest_share"]}
        for name, values in (numbers | {"mass": each["mass"] / MASS_UNIT}).items():
            ends = dict.fromkeys(f"{end:.2f}" for end in (values.min(), values.max()))
            found[f"{name} {law} {cluster}"] = " to ".join(ends)
    return found


def by_sample(table, law, cluster):
    """``sample 1 share``, ``sample 1 L_5`` [nm] and so on: what a sample is, and the equal spheres that it is like.

    ``sample 1 radius X`` [nm] and ``sample 1 q X``: their radius, and the moment of its own radii that has this length.
    """
    own = table[(table["law"] == law) & ((table["cluster"] == cluster) | is_equal(table))]
    one = own["cluster"] == cluster
    found = {}
    for sample in sorted(own.loc[one, "sample"].astype(int).unique()):
        # the least bootstrap: its errors are not told
        alike = likeness_table(own[~one | (own["sample"] == sample)], samples=2)
        alike = alike[alike["cluster"] == cluster]
        radii = mrn(SPHERES, int(sample))
        found[f"sample {sample} share"] = f"{_largest_share(radii):.2f}"
        found |= {f"sample {sample} L_{q:g}": f"{sample_length(radii, q) / NM:.0f}" for q in (4.6, 5.0)}
        for quantity, radius in zip(alike["quantity"], alike["radius"], strict=True):
            found[f"sample {sample} radius {quantity}"] = f"{radius / NM:.0f}"
            found[f"sample {sample} q {quantity}"] = f"{sample_moment(radius, radii):.1f}"
    return found


def samples_of_the_law():
    """What samples of the MRN law scatter by, as texts: share of the largest sphere, L_4.6 [um], 16 to 84 %.

    ``free share`` and ``free length`` of whatever comes, ``ruled share`` of those that the rule of drawing takes.
    """
    free = free_samples(SPHERES)
    ruled = [mrn(SPHERES, seed) for seed in range(200)]
    parts = {
        "free share": [_largest_share(radii) for radii in free],
        "free length": [sample_length(radii, 4.6) * 1e6 for radii in free],
        "ruled share": [_largest_share(radii) for radii in ruled],
    }
    ends = {name: np.quantile(values, [0.16, 0.84]) for name, values in parts.items()}
    return {name: f"{low:.2f} to {high:.2f}" for name, (low, high) in ends.items()}


def _largest_share(radii):
    """Part of the mass in the largest of some spheres."""
    return (radii.max() ** 3 / np.sum(radii**3)).item()
