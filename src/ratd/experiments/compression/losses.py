"""Where the energy of a compression goes: what each way dissipates, and which of them leads."""

import numpy as np

from ratd.experiments.compression.strength import crossing, of_clusters, of_means
from ratd.observables.energy import DISSIPATED

__all__ = ["WAYS", "lost_from", "overtakes", "part_of_work", "rates", "share_at", "total_at"]

WAYS = ("rolling", "twisting", "sliding", "damping", "made")
"""Ways of losing energy whose shares are told; "made" is what a new contact radiates as it forms."""


def rates(table, ways, own=slice(None)):
    """Energy dissipated per step in ln phi [J], by way, mean over seeds.

    Parameters
    ----------
    table : xarray.Dataset
    ways : sequence of str
    own : indices, optional
        Of the clusters; all of them by default.

    Returns
    -------
    phi : (k,) array
        Between every fourth bin and the next.
    rate : dict of str to (k,) array
    """
    every = np.arange(0, table.sizes["phi_bin"], 4)
    phi = table["phi"].values[every]
    found = {}
    for way in ways:
        energy = table[f"dissipated_{way}"].values[own][:, every]
        found[way] = np.diff(energy, axis=1).mean(axis=0) / np.diff(np.log(phi))
    return np.sqrt(phi[1:] * phi[:-1]), found


def total_at(table, name, phi):
    """What has been stored or lost of an energy up to phi, straight in ln phi between bins, of each cluster, (seeds,).

    NaN for clusters without one of the two bins beside it.
    """
    x = np.log(table["phi"].values)
    return np.array([np.interp(np.log(phi), x, own, left=np.nan, right=np.nan) for own in table[name].values])


def share_at(table, way, phi):
    """Part of all the energy lost up to phi that went one way, `Fit` of one number."""
    lost = np.stack([total_at(table, f"dissipated_{name}", phi) for name in DISSIPATED], axis=1)
    return of_means(lost[np.isfinite(lost).all(axis=1)], lambda mean: mean[DISSIPATED.index(way)] / mean.sum())


def part_of_work(table, way, low, high):
    """Energy lost one way between two filling factors over the work of the box there, `Fit` of one number."""
    both = [[total_at(table, name, phi) for name in (f"dissipated_{way}", "work")] for phi in (low, high)]
    grown = np.diff(np.array(both), axis=0)[0].T
    return of_means(grown[np.isfinite(grown).all(axis=1)], lambda mean: mean[0] / mean[1])


def lost_from(table, way, energy):
    """Filling factor at which clusters have lost an energy [J] one way, `Fit` of one number; NaN where they do not."""
    phi = table["phi"].values
    lost = table[f"dissipated_{way}"].values

    def reached(own):
        mean = np.where(np.isfinite(lost[own]).all(axis=0), lost[own].mean(axis=0), 0.0)
        reaching = np.flatnonzero(mean >= energy)
        if not len(reaching):
            return np.nan
        first = reaching[0]
        if first == 0 or mean[first - 1] <= 0.0:
            return phi[first]
        return crossing(phi[first - 1 : first + 1], np.log(mean[first - 1 : first + 1]), np.log(energy))

    return of_clusters(len(lost), reached)


def overtakes(table, first, second, low=0.02):
    """Filling factor from which on one way dissipates faster than another; NaN where it never does.

    Returns
    -------
    Fit
        Of one number. Where it was behind before, the logarithm of the ratio is taken as straight in ln phi between the
        last rates at which it is behind and the first at which it is ahead.
    """

    def ahead_from(own):
        phi, rate = rates(table, (first, second), own)
        good = np.isfinite(rate[first]) & np.isfinite(rate[second]) & (phi > low)
        phi, one, other = phi[good], rate[first][good], rate[second][good]
        behind = np.flatnonzero(one <= other)
        last = behind.max() if len(behind) else -1
        if last == len(phi) - 1:
            return np.nan
        if last < 0 or one[last] <= 0.0 or other[last + 1] <= 0.0:
            return phi[last + 1]
        ahead = np.log(one[last : last + 2] / other[last : last + 2])
        return crossing(phi[last : last + 2], ahead, 0.0)

    return of_clusters(table.sizes["seed_number"], ahead_from)
