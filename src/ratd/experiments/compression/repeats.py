"""Clusters that were squeezed or pulled once more, beside the first time."""

import numpy as np

from ratd.base.measured import Measured, geometric_mean
from ratd.base.statistics import mean_of
from ratd.experiments.compression.strength import measured, of_means, of_same_clusters
from ratd.experiments.compression.tables import nearest_phi, shared_bins

__all__ = ["near", "of_repeats", "parted", "pull_keys"]

REPEATED_AT = (0.05, 0.1, 0.2, 0.3, 0.48)
"""Filling factors at which clusters that were made once more are set beside the first ones."""
PULL_KEYS = {"n_monomers": 0, "seed": 0, "phi_compressed": 4, "strain_rate": 9, "n_axes": 0, "unloaded": 0}
"""What tells a pull from others, and to how many decimals: a filling factor is met to a part of a step of time."""


def near(table, phi):
    """Pressures of single clusters near a filling factor, (seeds,)."""
    k = nearest_phi(table["phi"].values, phi)
    return table["pressure"].values[:, max(k - 2, 0) : k + 3].mean(axis=1)


def parted(table, other, phi):
    """Root mean square of P over that of the same cluster in another run, less 1, near a filling factor."""
    own, other = (near(each, phi) for each in of_same_clusters([table, other]))
    return float(np.sqrt(np.mean((own / other - 1.0) ** 2)))


def of_repeats(sets, repeats, entries=None, pulled=None):
    """Pressures and strengths of clusters that were made once more, by another state of the code, over the first ones.

    Parameters
    ----------
    sets, repeats : dict of str to xarray.Dataset
    entries, pulled : xarray.Dataset, optional
        Of the kind ``tension_set``.

    Returns
    -------
    dict
        Of each set how many, ``SET.repeated``, the mean over the first one, ``SET.over_first_PHI``, and by how much
        single clusters part, ``SET.parted_PHI``. Of all sets together ``repeats.sets``, ``repeats.clusters``,
        ``repeats.same``, how many came out the same to the last bit, and the geometric means of the others, as if these
        were independent, ``repeats.over_first_PHI``; of the pulls ``repeats.pulls`` and ``repeats.strength``.
    """
    found = {"repeats.sets": len(repeats), "repeats.clusters": 0, "repeats.same": 0}
    every = {phi: [] for phi in REPEATED_AT}
    for name, table in repeats.items():
        pair = of_same_clusters([sets[name], table])
        found[f"{name}.repeated"] = pair[0].sizes["seed_number"]
        found["repeats.clusters"] += found[f"{name}.repeated"]
        other = _differ(*pair)
        found["repeats.same"] += int((~other).sum())
        for phi in REPEATED_AT:
            both = np.stack([near(each, phi) for each in pair], axis=1)
            if phi < sets[name]["phi"].values[-1] and np.isfinite(both).all():
                every[phi].extend(both[other, 1] / both[other, 0])
                if len(both) > 1:
                    found[f"{name}.over_first_{phi:g}"] = measured(of_means(both, lambda mean: mean[1] / mean[0]))
                found[f"{name}.parted_{phi:g}"] = parted(*pair, phi)
    found |= {f"repeats.over_first_{phi:g}": geometric_mean(ratios) for phi, ratios in every.items() if ratios}
    if entries is not None and pulled is not None:
        ratios = _strengths(entries, pulled)
        found |= {"repeats.pulls": len(ratios), "repeats.strength": Measured(*mean_of(ratios))}
    return found


def _differ(first, again):
    """Which clusters have another pressure anywhere, (seeds,) bool."""
    places = shared_bins(first, again)
    own, other = (each["pressure"].values[:, at] for each, at in zip((first, again), places, strict=True))
    both = np.isfinite(own) & np.isfinite(other)
    return (both & (own != other)).any(axis=1)


def _strengths(entries, pulled):
    """Strengths of pulls over those of the same pulls of the same clusters the first time, (k,)."""
    first, again = (dict(zip(pull_keys(each), each["strength"].values, strict=True)) for each in (entries, pulled))
    both = [key for key in again if first.get(key, 0.0) > 0.0]
    return np.array([again[key] / first[key] for key in both])


def pull_keys(table):
    """What tells each pull of a table from the others, list of tuple."""
    columns = (np.round(table[name].values, decimals).tolist() for name, decimals in PULL_KEYS.items())
    return list(zip(*columns, strict=True))
