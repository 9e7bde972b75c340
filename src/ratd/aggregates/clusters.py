"""Clusters grown by ballistic cluster-cluster aggregation (BCCA): fluffy, of a fractal dimension near 1.9."""

import numpy as np

from ratd.aggregates.cluster_growth import join_clusters
from ratd.aggregates.grain import Grain
from ratd.aggregates.growth import seed_sequence
from ratd.aggregates.radii import radii_array
from ratd.base.checks import check_seed, is_number
from ratd.base.errors import InputError
from ratd.base.materials import get_material
from ratd.base.units import NM

__all__ = ["MONOMER_RADIUS", "grow_bcca"]

MONOMER_RADIUS = {"ice": 100 * NM, "silicate": 600 * NM}
"""Radii [m] of the monomers of Table 1 of Kataoka et al. (2013), by material."""
LARGEST = 2**24
"""Number of monomers at most: growing so many takes gigabytes."""


def grow_bcca(n, material="ice", seed=0, *, radius=None, radii=None, copies=False):
    """Grow a cluster by ballistic cluster-cluster aggregation.

    Parameters
    ----------
    n : int
        Number of monomers, a power of 2 from 2 to 2^24.
    material : str or Material
        What the monomers are made of.
    seed : int
        Number of the cluster, at least 0. The random numbers depend on n and seed alone, so that clusters of several
        materials have the same shape.
    radius : float, optional
        Radius of all monomers [m]; not needed for ice (0.1 um) and silicate (0.6 um).
    radii : (n,) array_like, optional
        Radii of the single monomers [m] instead. They join in a random order.
    copies : bool
        Whether each cluster meets a copy of itself, turned at random (as recalled of Okuzumi et al. 2009, ApJ 707,
        1247), in place of an independent one.

    Returns
    -------
    Grain
        With its centre of mass in the origin, of the type "BCCA".

    Raises
    ------
    InputError
        If an argument is not one of those allowed.

    Notes
    -----
    Two clusters of n/2 monomers, turned at random, meet on a straight line. The impact parameter is uniform over a disc
    of the radius R_1 + R_2, where R_k is that of the sphere around the centre of mass that holds all of cluster k.
    Misses are drawn again. They stick at first touch, which is a distance of a_i + a_j - delta_0: the contact is free
    of force, and the cluster is at rest. It is a tree but for spheres that come to touch others by chance.
    """
    material = get_material(material)
    n = _check_number(n)
    seed = check_seed(seed)
    if not isinstance(copies, bool):
        raise InputError(f"copies is {copies!r}; it must be True or False.")
    rng = np.random.Generator(np.random.PCG64(seed_sequence("BCCA", n, seed)))
    if radii is None:
        each = np.full(n, _check_radius(radius, material))
    elif radius is not None:
        raise InputError("radius and radii are both given; allowed is one of them.")
    elif copies:
        raise InputError("copies and radii are both given; a cluster that meets its copy has equal monomers only.")
    else:
        each = rng.permutation(radii_array(radii, n))
    position = join_clusters(each, material.surface_energy, material.reduced_modulus, copies, rng)
    return Grain(position, each, material, type="BCCA", seed=seed)


def _check_number(n):
    whole = isinstance(n, int | np.integer) and not isinstance(n, bool) and n >= 2
    if not whole or n & (n - 1):
        below = f" ({1 << (int(n).bit_length() - 1)} or {1 << int(n).bit_length()})" if whole else ""
        raise InputError(
            f"n is {n!r}; it must be a power of 2 from 2 on{below}, a whole number: clusters of equal number join."
        )
    if n > LARGEST:
        raise InputError(f"n is {n}; it must be at most {LARGEST}: growing so many takes gigabytes.")
    return int(n)


def _check_radius(radius, material):
    if radius is None and material.name in MONOMER_RADIUS:
        return MONOMER_RADIUS[material.name]
    number = is_number(radius) and radius > 0.0
    if not number:
        known = ", ".join(MONOMER_RADIUS)
        raise InputError(
            f"radius is {radius!r}; it must be a number above 0, in m, and may be left out for {known} only."
        )
    return float(radius)
