"""Which equal spheres does a cluster behave like? By N_s, X and the energy left, each on its own.

At each velocity a quantity of equal spheres is a function of their radius, linear in its logarithm between the radii
that there are. The radius that a cluster is like is the one at which it misses the cluster's means by least, over all
velocities that both have.
"""

import numpy as np
import pandas as pd

from ratd.experiments.collision.fragmentation import bootstrap_means, means
from ratd.pipeline.kinds import Kind, entries, register

__all__ = ["COLUMNS", "QUANTITIES", "is_equal", "likeness", "likeness_table", "of_equal_spheres"]

QUANTITIES = {"X": "X", "N_s": "N_s", "energy_half": "energy left at 0.5 us"}
"""Column of `ratd.experiments.collision.tables.COLUMNS` -> what it is called."""
COLUMNS = {
    "law": ("", "name of the law in the config"),
    "cluster": ("", "name of the cluster in the config"),
    "quantity": ("", "by what it is compared: X, N_s or energy_half"),
    "velocities": ("1", "number of velocities that both have"),
    "radius": ("m", "radius of the equal spheres that it is most like"),
    "radius_low": ("m", "16 % of the bootstrap"),
    "radius_high": ("m", "84 % of the bootstrap"),
    "misfit": ("1", "root mean square difference that is left"),
    "at_end": ("1", "1 where the best radius is the least or the greatest that there is"),
}
register("collision_likeness", Kind("Which equal spheres a cluster is like", entries(COLUMNS)))
FEWEST = 3
"""Radii that must have a velocity for it to count."""
POINTS = 201
"""Radii that are tried, evenly in the logarithm."""


def is_equal(table):
    """Whether collisions are of equal spheres: Series of bool of a table, bool of one of its rows."""
    return table["largest_radius"] <= table["mean_sphere_radius"] * (1.0 + 1e-9)


def of_equal_spheres(table):
    """Collisions of equal spheres whose clusters have the most usual part of second contacts, of a table of them."""
    equal = table[is_equal(table)]
    return equal[equal["second_contact"].isin(equal["second_contact"].mode()[:1])]


def likeness(cluster, equal, quantity, samples=500):
    """Radius of the equal spheres that a cluster is most like.

    Parameters
    ----------
    cluster : pandas.DataFrame
        Collisions of the cluster, `velocity` and the quantity.
    equal : dict of float to pandas.DataFrame
        Radius [m] -> collisions of equal spheres; two radii at least.
    quantity : str
        A column.
    samples : int
        Of the bootstrap, see `ratd.experiments.collision.fragmentation.bootstrap_means`.

    Returns
    -------
    dict
        velocities, radius, radius_low, radius_high, misfit, at_end; NaN without a velocity that all have.
    """
    radii = np.sort(list(equal))
    common = set(cluster.loc[cluster[quantity].notna(), "velocity"])
    for table in equal.values():
        common &= set(table.loc[table[quantity].notna(), "velocity"])
    common = sorted(common)
    if not common or len(radii) < 2:
        nothing = dict.fromkeys(("radius", "radius_low", "radius_high", "misfit", "at_end"), np.nan)
        return {"velocities": len(common)} | nothing
    tables = [cluster, *(equal[radius] for radius in radii)]
    grid = np.geomspace(radii[0], radii[-1], POINTS)

    def best(means):
        own, *others = means
        curve = [np.interp(np.log(grid), np.log(radii), values) for values in np.transpose(others)]
        misfit = np.sqrt(np.mean((np.array(curve) - own[:, None]) ** 2, axis=0))
        k = int(np.argmin(misfit))
        return grid[k], misfit[k]

    radius, misfit = best([means(table[table["velocity"].isin(common)], quantity)[1] for table in tables])
    rng = np.random.Generator(np.random.PCG64(0))
    drawn = np.stack([bootstrap_means(table, quantity, common, samples, rng) for table in tables])
    # a draw of samples that lack a velocity says nothing
    whole = np.flatnonzero(np.isfinite(drawn).all(axis=(0, 1)))
    low, high = np.quantile([best(drawn[:, :, k])[0] for k in whole], [0.16, 0.84])
    at_end = float(radius in (grid[0], grid[-1]))
    ends = {"radius_low": low, "radius_high": high}
    return {"velocities": len(common), "radius": radius, **ends, "misfit": misfit, "at_end": at_end}


def _with_common_velocities(own, equal):
    """Collisions of a cluster, and of the radii that have all of the velocities that at least `FEWEST` radii share."""
    shared = [
        v for v in own["velocity"].unique() if sum((one["velocity"] == v).any() for one in equal.values()) >= FEWEST
    ]
    chosen = {radius: one for radius, one in equal.items() if set(shared) <= set(one["velocity"])}
    return own[own["velocity"].isin(shared)], chosen


def likeness_table(table, samples=500):
    """`COLUMNS` for every law and every cluster of unequal spheres of a table of central collisions.

    Parameters
    ----------
    table : pandas.DataFrame
        `ratd.experiments.collision.tables.COLUMNS`.
    samples : int
        Of the bootstrap.
    """
    table = table[table["impact_parameter"] == 0.0]
    same = is_equal(table)
    found = []
    for law, part in table.groupby("law", sort=False):
        alike = of_equal_spheres(part)
        equal = dict(list(alike.groupby(alike["largest_radius"].round(12))))
        for cluster, own in part[~same.loc[part.index]].groupby("cluster", sort=False):
            own, wanted = _with_common_velocities(own, equal)
            for quantity in QUANTITIES:
                row = likeness(own, wanted, quantity, samples)
                found.append(row | {"law": law, "cluster": cluster, "quantity": quantity})
    types = {name: float if units else object for name, (units, _) in COLUMNS.items()}
    return pd.DataFrame(found, columns=list(COLUMNS)).astype(types)
