"""Samples of the law of Mathis, Rumpl & Nordsieck, n(r) ~ r^-3.5, and the lengths that stand for it."""

import numpy as np

from ratd.aggregates.radii import mrn_moment, mrn_radii
from ratd.base.checks import check_radii, check_seed, is_number, is_whole
from ratd.base.errors import InputError

__all__ = [
    "LARGEST",
    "SMALLEST",
    "free_samples",
    "moment_of_length",
    "mrn",
    "mrn_length",
    "part_above",
    "sample_length",
    "sample_moment",
]

SMALLEST, LARGEST = 50e-9, 2.5e-6
"""Ends of the distribution [m] (Umstaetter & Urbassek 2020, Sect. 2.2)."""
MASS_WITHIN, LENGTH_WITHIN = 0.02, 0.05
"""A sample is taken whose mass and L_5 are so near to those of the law itself."""
LENGTH_OF = 5.0
"""q of the length L_q that a sample is to have."""
MOST_DRAWS = 200_000
"""Samples that are drawn before one is said to be out of reach."""


def mrn(n, seed, *, smallest=SMALLEST, largest=LARGEST, mass_within=MASS_WITHIN, length_within=LENGTH_WITHIN):
    """Radii of n spheres by the law of Mathis, Rumpl & Nordsieck.

    Parameters
    ----------
    n : int
        At least 2.
    seed : int
        At least 0.
    smallest, largest : float
        Ends of the distribution [m].
    mass_within, length_within : float or None
        Samples are drawn until their mass and their L_5 are within such parts of those of the law; None for whatever
        comes.

    Returns
    -------
    (n,) float64 array
        Radii [m], descending.

    Raises
    ------
    InputError
        If an argument is wrong, or no sample of so few spheres is near enough to the law.

    Notes
    -----
    Some 0.05 % of the spheres, two or three of 5000, hold 43 % of the mass. The mass of a free sample of 5000 scatters
    by 37 %, its L_5 by a quarter, so that one free sample says little about the law. Some hundreds of spheres
    cannot have the L_5 of the law: a single one would need all the mass. Of 800 there still is a sample, of 500 none.
    """
    if not is_whole(n) or n < 2:
        raise InputError(f"n is {n!r}; it must be a whole number of at least 2.")
    check_seed(seed)
    if not (is_number(smallest) and is_number(largest) and 0.0 < smallest < largest):
        raise InputError(
            f"smallest and largest are {smallest!r} and {largest!r}; they must be numbers above 0, in m, in order."
        )
    check_radii(np.array([smallest, largest]))
    for name, value in (("mass_within", mass_within), ("length_within", length_within)):
        if value is not None and not (is_number(value) and value > 0.0):
            raise InputError(f"{name} is {value!r}; it must be a number above 0, or None.")
    rng = np.random.Generator(np.random.PCG64(np.random.SeedSequence([int(n), int(seed)])))
    cube = mrn_moment(3.0, smallest, largest)
    length = mrn_length(LENGTH_OF, smallest, largest)
    for _ in range(MOST_DRAWS):
        radii = mrn_radii(rng.random(int(n)), smallest, largest)
        if mass_within is not None and abs(np.mean(radii**3) / cube - 1.0) > mass_within:
            continue
        if length_within is None or abs(sample_length(radii, LENGTH_OF) / length - 1.0) <= length_within:
            return np.sort(radii)[::-1].copy()
    raise InputError(
        f"None of {MOST_DRAWS} samples of {n} radii between {smallest:g} m and {largest:g} m is near enough to the "
        f"law: mass_within is {mass_within}, length_within is {length_within}; take more spheres, or more there."
    )


def mrn_length(q, smallest=SMALLEST, largest=LARGEST):
    """L_q = <r^q>^(1/q) [m] of the law (Umstaetter & Urbassek 2020, Eqs. 5, 6), q above 0.

    L_5 is the geometric mean of the ends (Eq. 8).
    """
    return mrn_moment(float(q), smallest, largest) ** (1.0 / q)


def sample_length(radii, q):
    """L_q = <r^q>^(1/q) [m] of some radii [m]."""
    radii = np.asarray(radii, dtype=float)
    scale = radii.max()
    return float(scale * np.mean((radii / scale) ** q) ** (1.0 / q))


def sample_moment(length, radii):
    """q whose L_q of some radii [m] is a length [m], the inverse of `sample_length`; NaN outside L_0.5 to L_40."""
    q = np.linspace(0.5, 40.0, 801)
    lengths = np.array([sample_length(radii, value) for value in q])
    return float(np.interp(length, lengths, q, left=np.nan, right=np.nan))


def free_samples(n, number=400, smallest=SMALLEST, largest=LARGEST):
    """Samples of n radii each, of whatever mass comes, list of (n,) array [m]; what they scatter by is no choice."""
    law = {"smallest": smallest, "largest": largest, "mass_within": None, "length_within": None}
    return [mrn(n, seed, **law) for seed in range(number)]


def part_above(radius, smallest=SMALLEST, largest=LARGEST):
    """Part of the spheres of the law that are larger than a radius [m]."""
    end = (largest / smallest) ** -2.5
    return ((radius / smallest) ** -2.5 - end) / (1.0 - end)


def moment_of_length(length, smallest=SMALLEST, largest=LARGEST):
    """q whose L_q is a length [m]; NaN outside L_0.5 to L_40."""
    q = np.linspace(0.5, 40.0, 8001)
    lengths = np.array([mrn_length(value, smallest, largest) for value in q])
    return float(np.interp(length, lengths, q, left=np.nan, right=np.nan))
