"""Medians, means and slopes with their uncertainty, of values of which some cells may have more than others."""

from functools import lru_cache

import numpy as np
import pandas as pd

__all__ = [
    "drawn_counts",
    "equal_weights",
    "jackknife_error",
    "mean_of",
    "median_of",
    "slope_error",
    "slope_of",
    "weighted_line",
    "weighted_parabola",
]

N_BOOTSTRAP = 2000


def equal_weights(cell):
    """Weights with which all cells count alike, however many values each of them has.

    Parameters
    ----------
    cell : array_like, shape (n,)
        Cell of each value.

    Returns
    -------
    numpy.ndarray, shape (n,)
        1 in the mean, and exactly 1 each where all cells have as many values.
    """
    _, place, count = np.unique(np.asarray(cell), return_inverse=True, return_counts=True)
    return len(place) / (len(count) * count[place])


def _of_sorted(values, weights, n, probabilities):
    """Quantiles (rows, k) of ascending values with weights (rows, values), each row a sample of n (rows,).

    They are those of `numpy.quantile` of a sample of n in which each value stands as often as its weight says, 1 in the
    mean (Harrell's wtd.quantile, type "quantile"): the weights need not be whole.
    """
    n = np.asarray(n, dtype=float)[..., None]
    last = np.cumsum(weights, axis=-1)  # the last place in the sample that each value takes, times something
    last *= n / last[..., -1:]
    place = 1.0 + (n - 1.0) * probabilities
    whole = np.floor(place)
    # so far below each place that rounding does not tell
    edge = np.stack([whole, np.minimum(whole + 1.0, n)], axis=-1) - 1e-9 * n[..., None]
    low, high = np.moveaxis(values[np.sum(last[..., None, None, :] < edge[..., None], axis=-1)], -1, 0)
    return low + (place - whole) * (high - low)


def median_of(values, group=None, seed=0, cell=None):
    """Median, spread, and standard error of the median by bootstrap.

    Parameters
    ----------
    values : array_like, shape (n,)
        NaN are left out.
    group : array_like, shape (n,), optional
        Values of the same group are drawn together (runs of the same grain); default: each value alone.
    seed : int
        Of the bootstrap.
    cell : array_like, shape (n,), optional
        Values of all cells count alike (`equal_weights`); default: each value does.

    Returns
    -------
    dict
        median, error (standard deviation of the medians of the bootstrap), low, high (16 % and 84 % of the values),
        n. NaN where there is no value, error NaN for fewer than three groups. The bootstrap draws from all values
        together, so that cells with a single one count as uncertain too; where cells differ by themselves, the error
        takes in these differences and is an upper limit.
    """
    values = np.asarray(values, dtype=float)
    group = np.arange(len(values)) if group is None else np.asarray(group)
    there = np.isfinite(values)
    weights = np.ones(there.sum()) if cell is None else equal_weights(np.asarray(cell)[there])
    values, member = values[there], pd.factorize(group[there])[0]
    if not len(values):
        return dict(median=np.nan, error=np.nan, low=np.nan, high=np.nan, n=0)
    order = np.argsort(values, kind="stable")
    values, weights, member = values[order], weights[order], member[order]
    low, median, high = _of_sorted(values, weights, len(values), np.array([0.16, 0.5, 0.84]))
    n_groups = member.max() + 1
    error = np.nan
    if n_groups > 2:  # the middle of two draws of two is nearly always one of three values
        often = _bootstrap(n_groups, seed)[:, member]
        medians = _of_sorted(values, often * weights, often.sum(axis=1), np.array([0.5]))
        error = float(np.std(medians, ddof=1))
    return dict(median=float(median), error=error, low=float(low), high=float(high), n=len(values))


@lru_cache(maxsize=64)  # a document has many medians of as many values
def _bootstrap(n, seed):
    """How often each of n is drawn in each of the bootstrap's samples, shape (N_BOOTSTRAP, n)."""
    return drawn_counts(np.random.Generator(np.random.PCG64(seed)), N_BOOTSTRAP, n).astype(np.int16)


def drawn_counts(rng, samples, n):
    """How often each of n is drawn in each of some bootstrap samples.

    Parameters
    ----------
    rng : numpy.random.Generator
    samples, n : int

    Returns
    -------
    numpy.ndarray of int, shape (samples, n)
    """
    return np.array([np.bincount(draw, minlength=n) for draw in rng.integers(n, size=(samples, n))])


def mean_of(values, cell=None):
    """Mean and its standard error.

    Parameters
    ----------
    values : array_like, shape (n,)
        What is not finite is left out.
    cell : array_like, shape (n,), optional
        Values of all cells count alike (`equal_weights`); default: one cell.

    Returns
    -------
    mean, error : float
        NaN without values. The error comes from the scatter within the cells: those that there are are meant, and by
        how much they differ is no uncertainty of their mean. A cell with a single value is taken to scatter as the
        others do on average; NaN where no cell has two.
    """
    values = np.asarray(values, dtype=float)
    there = np.isfinite(values)
    values = values[there]
    if not len(values):
        return np.nan, np.nan
    _, cell = np.unique(np.zeros(len(values)) if cell is None else np.asarray(cell)[there], return_inverse=True)
    count = np.bincount(cell)
    mean_in = np.bincount(cell, values) / count
    square = np.bincount(cell, (values - mean_in[cell]) ** 2)
    several = count > 1
    if not several.any():
        return float(mean_in.mean()), np.nan
    scatter = np.full(len(count), square.sum() / (count - 1).sum())
    scatter[several] = square[several] / (count[several] - 1)
    return float(mean_in.mean()), float(np.sqrt(np.sum(scatter / count)) / len(count))


def jackknife_error(left_out):
    """Standard error of an estimate from those without one group after the other.

    Parameters
    ----------
    left_out : array_like, shape (n,)
        The estimate without group 1 ... n.

    Returns
    -------
    float
        Root of (n - 1)/n times the sum of squares about their mean (Quenouille 1956, Tukey 1958): for a mean the
        textbook's. NaN for fewer than two groups, and where an estimate is not finite.
    """
    left_out = np.asarray(left_out, dtype=float)
    n = len(left_out)
    return float(np.sqrt((n - 1) / n * np.sum((left_out - left_out.mean()) ** 2))) if n > 1 else np.nan


def slope_of(x, y, group=None, weights=None):
    """Slope of a straight line by least squares, and what it owes to each point.

    Parameters
    ----------
    x, y : array_like, shape (n,)
    group : array_like, shape (n,), optional
        Lines of all groups have one slope, and each its own level; default: one line.
    weights : array_like, shape (n,), optional
        Default: 1 each.

    Returns
    -------
    slope : float
        NaN where no group has two different x.
    influence : numpy.ndarray, shape (n,)
        By how much the slope would be lower without the point; 0 for the only one of its group. `slope_error` makes
        the standard error of them.

    Notes
    -----
    The leave-one-out differences are exact: w x e/(S (1 - h)), with x from the mean of its group, S = sum of w x^2,
    residual e and leverage h = w (1/sum of the weights of the group + x^2/S).
    """
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    _, group = np.unique(np.zeros(len(x)) if group is None else np.asarray(group), return_inverse=True)
    weights = np.ones(len(x)) if weights is None else np.asarray(weights, dtype=float)
    level = np.bincount(group, weights)
    x = x - (np.bincount(group, weights * x) / level)[group]
    y = y - (np.bincount(group, weights * y) / level)[group]
    spread = np.sum(weights * x * x)
    if not spread > 1e-20:
        return np.nan, np.full(len(x), np.nan)
    slope = np.sum(weights * x * y) / spread
    free = 1.0 - weights * (1.0 / level[group] + x * x / spread)
    influence = np.zeros(len(x))
    # a point that makes its line pass through it has no residual, and tells nothing of the error
    known = free > 1e-9
    influence[known] = (weights * x * (y - slope * x))[known] / (spread * free[known])
    return float(slope), influence


def slope_error(influence):
    """Standard error of a slope, or of the difference of two, from influences of `slope_of` (or their difference).

    The root of the sum of squares is the error HC3 of MacKinnon & White (1985, J. Econometrics 29, 305), which needs
    neither the same scatter everywhere nor several points at one x. NaN where no three points have an influence.
    """
    return float(np.sqrt(np.sum(influence**2))) if np.count_nonzero(influence) > 2 else np.nan


def weighted_line(x, y, weights):
    """Straight lines by least squares.

    Parameters
    ----------
    x, y, weights : array_like, shape (..., n)
        A line along the last axis; the shapes broadcast.

    Returns
    -------
    slope, level : numpy.ndarray, shape (...)
        Of y = level + slope x; NaN for a line of equal x.
    """
    total = weights.sum(axis=-1, keepdims=True)
    x_mean, y_mean = ((weights * v).sum(axis=-1, keepdims=True) / total for v in (x, y))
    spread = np.sum(weights * (x - x_mean) ** 2, axis=-1)
    # a replicate of a bootstrap may draw equal x only, which leaves rounding: no slope
    slope = np.sum(weights * (x - x_mean) * (y - y_mean), axis=-1) / np.where(spread > 1e-20, spread, np.nan)
    return slope, y_mean[..., 0] - slope * x_mean[..., 0]


def weighted_parabola(x, y, weights):
    """Parabolas by least squares.

    Parameters
    ----------
    x, y, weights : array_like, shape (..., n)
        A parabola along the last axis; the shapes broadcast.

    Returns
    -------
    bend, slope, level : numpy.ndarray, shape (...)
        Of y = level + slope x + bend x^2; NaN for a parabola of fewer than three different x.
    """
    # What x^2 adds to a straight line in x is what tells of the bend.
    square = np.square(x)
    slope_of_square, level_of_square = weighted_line(x, square, weights)
    beyond = square - level_of_square[..., None] - slope_of_square[..., None] * x
    spread = np.sum(weights * beyond**2, axis=-1)
    bend = np.sum(weights * beyond * y, axis=-1) / np.where(spread > 1e-20, spread, np.nan)
    slope, level = weighted_line(x, y - bend[..., None] * square, weights)
    return bend, slope, level
