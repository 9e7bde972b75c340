"""Aggregates grown monomer by monomer: of an exact effective radius, or of given radii (Sect. 3)."""

import hashlib
import math

import numpy as np

from ratd.aggregates.ballistic import place_monomers
from ratd.aggregates.grain import Grain
from ratd.aggregates.radii import RadiusDistribution, draw_radii, radii_array
from ratd.base.checks import check_seed, is_number
from ratd.base.errors import InputError
from ratd.base.materials import get_material
from ratd.geometry.shape import centre_of_mass

__all__ = ["MIGRATIONS", "TYPES", "check_a_eff", "grain_radii", "grow", "grow_with_radii", "smallest_a_eff"]

TYPES = {"BA": 0, "BAM1": 1, "BAM2": 2}
"""Aggregation models by name, with the number of times that a monomer migrates after its first touch."""

MIGRATIONS = ("random", "nearest")
"""How a monomer rolls on: in a random direction, or the shortest way to a place of more contacts."""

MOST_MONOMERS = 1_000_000
"""Greatest expected number of monomers that `grow` accepts."""


def smallest_a_eff(type, distribution=None):
    """Effective radius of the fewest monomers that a type needs, all of the smallest radius [m].

    BA needs two monomers, BAM1 three, BAM2 four: with fewer, no monomer makes the contacts that name the type.
    """
    distribution = RadiusDistribution() if distribution is None else distribution
    return (TYPES[_check_type(type)] + 2) ** (1.0 / 3.0) * distribution.smallest


def grow(type, a_eff, material, seed, *, distribution=None, migration="random"):
    """Grow an aggregate of an exact effective radius.

    Parameters
    ----------
    type : str
        "BA", "BAM1" or "BAM2".
    a_eff : float
        Effective radius [m]: sum a_i^3 = a_eff^3 to 1e-12.
    material : str or Material
        What the monomers are made of.
    seed : int
        Number of the grain, at least 0. The random numbers depend on material name, type, a_eff and seed, so that
        another grain of the ensemble changes nothing in this one.
    distribution : RadiusDistribution, optional
        Distribution of the monomer radii.
    migration : str, optional
        "random" (as in the paper) or "nearest", see `grow_with_radii`.

    Returns
    -------
    Grain
        With its centre of mass in the origin; monomers in the order in which they arrived.

    Raises
    ------
    InputError
        If an argument is not one of those allowed, or if no radii of the distribution add up to a_eff in a number
        that the type needs.

    Notes
    -----
    Sect. 3 of Reissl et al. 2024. The radii are those of `draw_radii`: small grains hold few monomers, and the radii
    are drawn again until their number allows the type (BA at least 2, BAM1 at least 3, BAM2 at least 4).
    """
    material = get_material(material)
    distribution = RadiusDistribution() if distribution is None else distribution
    if not isinstance(distribution, RadiusDistribution):
        raise InputError(f"distribution is {distribution!r}; it must be a ratd.aggregates.radii.RadiusDistribution.")
    migrations = TYPES[_check_type(type)]
    a_eff = check_a_eff(a_eff, type, distribution)
    seed = check_seed(seed)
    radius = grain_radii(type, a_eff, material.name, seed, distribution)
    position = _place(radius, material, migrations, migration, _grain_seeds(type, a_eff, material.name, seed)[1])
    return Grain(position, radius, material, type=type, a_eff=a_eff, seed=seed)


def grain_radii(type, a_eff, material, seed, distribution):
    """Radii of the monomers of the grain that `grow` makes, without growing it.

    Parameters
    ----------
    type : str
        A name of `TYPES`.
    a_eff : float
        Effective radius [m].
    material : str
        Name of the material.
    seed : int
    distribution : RadiusDistribution

    Returns
    -------
    (n,) float64 array
        [m], in the order in which the monomers arrive.
    """
    rng = np.random.Generator(np.random.PCG64(_grain_seeds(type, a_eff, material, seed)[0]))
    return draw_radii(a_eff, TYPES[type] + 2, distribution, rng)


def _grain_seeds(type, a_eff, material, seed):
    """Seeds of the radii of a grain and of their places."""
    return seed_sequence(material, type, round(a_eff / 1e-12), seed).spawn(2)


def grow_with_radii(type, radii, material, seed, *, migration="random"):
    """Grow an aggregate of given monomers.

    Parameters
    ----------
    type : str
        "BA", "BAM1" or "BAM2".
    radii : (n,) array_like
        Radii of the monomers in the order in which they arrive [m], n >= 2.
    material : str or Material
        What the monomers are made of.
    seed : int
        At least 0.
    migration : str, optional
        "random": BAM1 rolls off in a uniformly random direction, BAM2 then in a random one of the two senses.
        "nearest": both go the shortest way to a place of one contact more, as in Shen et al. 2008.

    Returns
    -------
    Grain
        With its centre of mass in the origin.

    Raises
    ------
    InputError
        If an argument is not one of those allowed.

    Notes
    -----
    Each monomer comes in on a straight line of uniformly random direction and of a uniformly random impact parameter
    over the disc that a sphere around the aggregate, widened by the monomer's radius, presents. It stops at first
    touch, then rolls (BAM1, BAM2) over the monomer hit until it touches a second, then (BAM2) over those two until it
    touches a third. A monomer that misses, or that can roll all the way round without touching another, comes in
    again. The third monomer is the first that needs a second contact, the fourth the first that needs a third.

    Touching means a distance of a_i + a_j - delta_0, so that every contact made here is at rest; no two monomers are
    closer than that. In a few aggregates of three to five monomers of very different size no place with three
    contacts exists (a small one hides in the gap between two large ones): a monomer that has found none in 20 000
    hits stays at one with two contacts.
    """
    material = get_material(material)
    migrations = TYPES[_check_type(type)]
    seed = check_seed(seed)
    radius = radii_array(radii)
    position = _place(radius, material, migrations, migration, seed_sequence(material.name, type, "radii", seed))
    return Grain(position, radius, material, type=type, seed=seed)


def _place(radius, material, migrations, migration, seed):
    if migration not in MIGRATIONS:
        raise InputError(f"migration is {migration!r}; allowed are {', '.join(MIGRATIONS)}.")
    rng = np.random.Generator(np.random.PCG64(seed))
    position = place_monomers(
        radius, material.surface_energy, material.reduced_modulus, migrations, migration == "nearest", rng
    )
    return position - centre_of_mass(position, radius**3)


def seed_sequence(*key):
    """SeedSequence of any key, the same on every machine."""
    digest = hashlib.sha256("|".join(str(part) for part in key).encode()).digest()
    return np.random.SeedSequence(np.frombuffer(digest, dtype="<u4").tolist())


def _check_type(type):
    if not isinstance(type, str) or type not in TYPES:
        raise InputError(f"The type of aggregate is {type!r}; allowed are {', '.join(TYPES)}.")
    return type


def check_a_eff(a_eff, type, distribution):
    """a_eff [m] as a float; InputError where no grain of the type can have it, with monomers of the distribution."""
    value = float(a_eff) if is_number(a_eff) else math.nan
    low = smallest_a_eff(type, distribution)
    high = (MOST_MONOMERS * distribution.moment(3)) ** (1.0 / 3.0)
    if not low < value <= high:
        raise InputError(
            f"a_eff is {a_eff!r} m; for {type} it must be above {low:.4g} m ({TYPES[type] + 2} monomers of the "
            f"smallest radius) and at most {high:.3g} m."
        )
    # A narrow distribution leaves gaps between what n and n + 1 monomers can fill.
    most = math.floor(value**3 / distribution.smallest**3 * (1.0 + 1e-12))
    if most * distribution.largest**3 < value**3:
        raise InputError(
            f"a_eff is {a_eff!r} m, which no number of monomers of {distribution.smallest:g} m to "
            f"{distribution.largest:g} m can give; choose another size or a wider range of radii."
        )
    return value
