"""Numbers with their standard errors."""

import math
from typing import NamedTuple

import numpy as np

from ratd.base.statistics import mean_of, median_of

__all__ = ["Measured", "geometric_mean", "median", "quotient"]


class Measured(NamedTuple):
    """A number with its standard error, NaN where it has none."""

    value: float
    error: float = math.nan


def quotient(one, other):
    """One number over another whose error is independent of its own, `Measured`; both are (value, error)."""
    (value, error), (below, error_below) = one, other
    found = value / below
    return Measured(found, math.hypot(error, found * error_below) / abs(below))


def median(values, cell=None, group=None):
    """Median of values, `Measured`; cell and group are those of `ratd.base.statistics.median_of`."""
    found = median_of(values, group, cell=cell)
    return Measured(found["median"], found["error"])


def geometric_mean(values, cell=None):
    """Geometric mean of positive values, `Measured`, with the error of the mean of ln of them.

    Parameters
    ----------
    values, cell
        See `ratd.base.statistics.mean_of`: all cells count alike.
    """
    mean, error = mean_of(np.log(np.asarray(values, dtype=float)), cell)
    return Measured(math.exp(mean), math.exp(mean) * error)
