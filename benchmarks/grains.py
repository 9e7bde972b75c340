"""Aggregates of a given number of monomers, grown or read from a file."""

import numpy as np

from ratd import Grain
from ratd.aggregates.growth import grow_with_radii
from ratd.aggregates.radii import RadiusDistribution
from ratd.base.errors import FileError, InputError


def draw_radii(n, seed):
    """n radii from the default distribution, no matter what effective radius they give [m]."""
    distribution = RadiusDistribution()
    rng = np.random.Generator(np.random.PCG64(seed))
    radii = np.empty(0)
    while len(radii) < n:
        drawn = rng.lognormal(np.log(distribution.median), distribution.sigma_ln, 2 * n)
        kept = drawn[(drawn >= distribution.smallest) & (drawn <= distribution.largest)]
        radii = np.concatenate([radii, kept])
    return radii[:n]


def grown(kind, n, seed=0, material="q-S"):
    """Aggregate of n monomers.

    Parameters
    ----------
    kind : {"BA", "BAM1", "BAM2"}
    n : int
        Number of monomers.
    seed : int
    material : str

    Returns
    -------
    ratd.Grain
    """
    return grow_with_radii(kind, draw_radii(n, seed), material, seed)


def read(path, material="q-S"):
    """Aggregate of a text file with one line ``x y z a`` [m] for each monomer.

    Parameters
    ----------
    path : path-like
    material : str

    Returns
    -------
    ratd.Grain

    Raises
    ------
    FileError
        If the file cannot be read or is laid out otherwise.
    """
    try:
        table = np.loadtxt(path, ndmin=2)
    except (OSError, ValueError) as error:
        raise FileError(f"{path}: cannot be read as lines 'x y z a' in metres ({error})") from error
    if table.shape[1] != 4:
        raise FileError(f"{path}: has {table.shape[1]} columns; it must have four, x y z a in metres")
    try:
        return Grain(table[:, :3], table[:, 3], material)
    except InputError as error:
        raise FileError(f"{path}: {error}") from error
