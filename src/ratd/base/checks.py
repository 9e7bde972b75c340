"""What counts as a number, as an array of numbers, and as the size of a grain of dust."""

import math
from numbers import Integral, Real

import numpy as np

from ratd.base.errors import InputError

__all__ = [
    "GREATEST_SEED",
    "check_radii",
    "check_seed",
    "far_apart",
    "is_dust",
    "is_number",
    "is_whole",
    "likely_unit",
    "not_dust",
    "number_array",
    "whole_number",
]

SMALLEST_RADIUS, LARGEST_RADIUS = 1e-10, 1e-3
"""Radii of monomers [m], from an atom to a grain of sand: what lies outside was given in another unit."""
_USUAL_RADIUS = 1e-7
"""About the radius of monomers [m], to guess the unit by."""
FAR = 1e4
"""Spheres that lie apart by more than this many times the length of all of them in a row do not belong together."""
_UNITS = {"nm": 1e-9, "µm": 1e-6, "mm": 1e-3}
GREATEST_SEED = 2**53
"""Seeds are kept in files as whole numbers, and in tables as floating-point ones, which tell them apart up to here."""


def is_number(value):
    """Whether a value is a finite real number, numpy's included; True and False are none."""
    if not isinstance(value, Real) or isinstance(value, bool):
        return False
    try:
        return math.isfinite(value)
    except OverflowError:  # a whole number that no float holds
        return False


def is_whole(value):
    """Whether a value is a whole number, numpy's included; True and False are none."""
    return isinstance(value, Integral) and not isinstance(value, bool)


def check_seed(seed):
    """A seed as an int; an error for one that is none."""
    if not (is_whole(seed) and 0 <= seed <= GREATEST_SEED):
        raise InputError(f"seed is {seed!r}; it must be a whole number of at least 0 and at most {GREATEST_SEED}.")
    return int(seed)


def whole_number(value, name, least):
    """A whole number of at least so many as an int, also one that is written as 1e3; an error for one that is none."""
    if not (is_number(value) and value == int(value) and value >= least):
        raise InputError(f"{name} is {value!r}; it must be a whole number of at least {least}.")
    return int(value)


def number_array(values, name, unit="m"):
    """A contiguous float64 copy of an array of real numbers.

    Parameters
    ----------
    values : array_like
    name : str
        For the message.
    unit : str, optional
        For the message.

    Returns
    -------
    float64 array

    Raises
    ------
    InputError
        If it holds text, complex numbers or anything else, or its rows differ in length.
    """
    try:
        array = np.asarray(values)
    except (TypeError, ValueError):
        array = np.asarray("")
    if array.dtype.kind not in "iuf" and array.size:
        raise InputError(f"{name} is not an array of numbers; it must hold finite numbers in {unit}.")
    return np.array(array, dtype=np.float64, order="C")


def check_radii(radius):
    """Raise an error for radii that no dust has, with the factor that would make them such.

    Parameters
    ----------
    radius : (n,) float64 array
        Radii above 0 [m].

    Raises
    ------
    InputError
        One sentence with the factor.
    """
    if is_dust(radius):
        return
    unit = likely_unit(radius, _UNITS)
    hint = ""
    if unit is not None:
        hint = f"; multiply those in {unit} by {_UNITS[unit]:g}"
    elif is_dust(radius * 1e9):
        hint = "; multiply these by 1e+09, which they may have been divided by twice"
    raise InputError(f"{not_dust(radius)}{hint}.")


def not_dust(radius):
    """What a message says of radii [m] that no dust has, without an end."""
    return (
        f"radius has the median {float(np.median(radius)):g}; lengths are in m, and the radii of dust lie between "
        f"{SMALLEST_RADIUS:g} and {LARGEST_RADIUS:g} m"
    )


def likely_unit(radius, units):
    """The name in `units` (name -> m) in which some numbers would most likely be radii of dust; None where in none."""
    fits = [unit for unit, factor in units.items() if is_dust(radius * factor)]
    middle = np.median(radius)
    return min(fits, key=lambda unit: abs(np.log10(middle * units[unit] / _USUAL_RADIUS)), default=None)


def far_apart(position, radius):
    """A hint where spheres are so far apart that positions and radii must be in different units, else empty."""
    spread = float(np.max(np.ptp(position, axis=0), initial=0.0))
    if spread < FAR * float(np.sum(2 * radius)):
        return ""
    return f" Positions reach over {spread:g}, in m: multiply those in nm by 1e-09."


def is_dust(radius):
    """Whether radii [m] are those of dust."""
    return SMALLEST_RADIUS <= np.min(radius) and np.max(radius) <= LARGEST_RADIUS
