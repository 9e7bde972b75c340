"""Medians with their uncertainty."""

import numpy as np

N_BOOTSTRAP = 2000


def median_of(values, group=None, seed=0):
    """Median, spread, and standard error of the median by bootstrap.

    Parameters
    ----------
    values : array_like, shape (n,)
        NaN are left out.
    group : array_like, shape (n,), optional
        Values of the same group are drawn together (runs of the same grain); default: each value alone.
    seed : int
        Of the bootstrap.

    Returns
    -------
    dict
        median, error (standard deviation of the medians of the bootstrap), low, high (16 % and 84 % of the values),
        n. NaN where there is no value, error NaN for fewer than two groups.
    """
    values = np.asarray(values, dtype=float)
    group = np.arange(len(values)) if group is None else np.asarray(group)
    there = np.isfinite(values)
    values, group = values[there], group[there]
    if not len(values):
        return dict(median=np.nan, error=np.nan, low=np.nan, high=np.nan, n=0)
    low, median, high = np.quantile(values, [0.16, 0.5, 0.84])
    members = [values[group == name] for name in dict.fromkeys(group.tolist())]
    error = np.nan
    if len(members) > 1:
        rng = np.random.Generator(np.random.PCG64(seed))
        draws = rng.integers(len(members), size=(N_BOOTSTRAP, len(members)))
        error = float(np.std([np.median(np.concatenate([members[k] for k in draw])) for draw in draws], ddof=1))
    return dict(median=float(median), error=error, low=float(low), high=float(high), n=len(values))
