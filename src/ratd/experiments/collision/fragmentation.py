"""What is left of a collision: the two largest pieces, all others, and where fragmentation begins."""

import numpy as np
import pandas as pd
import xarray as xr

from ratd.base.checks import check_seed, is_number, whole_number
from ratd.base.errors import InputError
from ratd.base.materials import sphere_mass

__all__ = [
    "STICKING",
    "agglomeration",
    "bootstrap_means",
    "crossings",
    "fragmentation",
    "fragmentation_number",
    "fragmentation_velocities",
    "fragmentation_velocity",
    "mean_and_error",
    "means",
]

STICKING = 0.15
"""X above which two clusters are said to stick (Kalweit & Drikakis 2006; Umstaetter & Urbassek 2020, Sect. 3.1)."""


def fragmentation_number(largest, second, whole):
    """N_s = 1 - (M_1 + M_2)/(2 M) [1], `whole` being the mass 2 M of both clusters (Eq. 9)."""
    return 1.0 - (largest + second) / whole


def agglomeration(largest, second, whole):
    """X = (M_1 - M_2)/(2 M) [1], `whole` being the mass 2 M of both clusters (Eq. 10)."""
    return (largest - second) / whole


def fragmentation(run):
    """N_s, X and the pieces at the end of a collision.

    Parameters
    ----------
    run : xarray.Dataset
        From `ratd.collide`.

    Returns
    -------
    xarray.Dataset
        `N_s`, mass outside of the two largest pieces over that of all, and `X`, mass of the largest piece less that of
        the second over that of all. Along ``piece``, the heaviest first, `piece_mass` [kg], `piece_members`,
        `piece_largest_radius` [m], `piece_of_a` (part of the mass that came with the first cluster). Single spheres are
        pieces too.

    Raises
    ------
    InputError
        If it is no such run.
    """
    names = run.variables if isinstance(run, xr.Dataset) else ()
    lacks = [name for name in ("radius", "piece", "cluster") if name not in names]
    if lacks:
        already = "; what ratd.read_runs gives of a file of ratd has its N_s and X already" if "N_s" in names else ""
        raise InputError(
            f"run is {type(run).__name__} without {', '.join(lacks)}; it must be what ratd.collide returns{already}."
        )
    mass = sphere_mass(run["radius"].values, run.attrs["density"])
    label = run["piece"].values
    number = label.max() + 1
    masses = np.bincount(label, mass, number)
    members = np.bincount(label, minlength=number)
    of_a = np.bincount(label, mass * (run["cluster"].values == 0), number) / masses
    largest = np.zeros(number)
    np.maximum.at(largest, label, run["radius"].values)
    order = np.argsort(-masses, kind="stable")
    first, second = (*masses[order], 0.0)[:2]
    whole = masses[order].sum()  # of the pieces, so that nothing is missing by rounding where all is in two of them
    return xr.Dataset(
        {
            "N_s": (
                (),
                fragmentation_number(first, second, whole),
                {"units": "1", "long_name": "mass outside of the two largest pieces over that of all"},
            ),
            "X": (
                (),
                agglomeration(first, second, whole),
                {"units": "1", "long_name": "mass of the largest piece less that of the second over that of all"},
            ),
            "piece_mass": ("piece", masses[order], {"units": "kg", "long_name": "mass of a piece"}),
            "piece_members": ("piece", members[order], {"units": "1", "long_name": "spheres of a piece"}),
            "piece_largest_radius": (
                "piece",
                largest[order],
                {"units": "m", "long_name": "radius of the largest sphere of a piece"},
            ),
            "piece_of_a": (
                "piece",
                of_a[order],
                {"units": "1", "long_name": "part of the mass that came with the first cluster"},
            ),
        }
    )


def fragmentation_velocity(table, *, limit=STICKING, samples=1000, seed=0):
    """Velocity at which the mean X falls through a limit, with a bootstrap error.

    Parameters
    ----------
    table : pandas.DataFrame
        One row a collision: `velocity` [m/s] and `X`; where there are several clusters of a kind, `sample` as well.
    limit : float
        X of the threshold.
    samples, seed : int
        Of the bootstrap, see `bootstrap_means`.

    Returns
    -------
    pandas.Series
        velocity [m/s], error (standard deviation of the bootstrap), low, high (its 16 and 84 %), found (part of its
        samples with a threshold), below, above (the velocities that were tried on both sides of it). NaN where X stays
        on one side; error, low and high also where there is one collision on each side.

    Raises
    ------
    InputError
        If a column is missing or holds no numbers, there are no collisions, or another argument is wrong.

    Notes
    -----
    Mean X, over samples of the means of each, is interpolated linearly between the velocities. Where it falls through
    the limit more than once, the last time counts: from there on clusters come apart.
    """
    table = _checked(table)
    if not is_number(limit):
        raise InputError(f"limit is {limit!r}; it must be a number.")
    samples, seed = whole_number(samples, "samples", 1), check_seed(seed)
    velocities, mean, _ = means(table, "X")
    middle = _crossing(velocities, mean, limit)
    rng = np.random.Generator(np.random.PCG64(seed))
    drawn_means = bootstrap_means(table, "X", velocities, samples, rng)
    drawn = np.array([_crossing(velocities, one, limit) for one in drawn_means.T])
    there = np.isfinite(drawn)
    spread = drawn[there] if there.sum() > 1 else np.full(2, np.nan)
    low, high = np.quantile(spread, [0.16, 0.84])
    known = velocities[np.isfinite(mean)]
    below = known[known <= middle].max(initial=-np.inf)
    above = known[known > middle].min(initial=np.inf)
    ends = {"below": below, "above": above} if np.isfinite(middle) else {"below": np.nan, "above": np.nan}
    error = np.std(spread, ddof=1)
    beside = table[table["velocity"].isin([below, above])]
    if len(beside) == 2 and len(np.unique(_samples(table))) == 1:
        # one collision on each side does not tell how others would end
        error = low = high = np.nan
    values = {"velocity": middle, "error": error, "low": low, "high": high, "found": there.mean()}
    return pd.Series(values | ends)


def fragmentation_velocities(table):
    """`fragmentation_velocity` [m/s] of each sample of a table on its own, (k,) array."""
    each = table.groupby("sample")[["velocity", "X"]]
    # the least bootstrap: its errors are not told
    return np.array([fragmentation_velocity(part, samples=2)["velocity"] for _, part in each])


def mean_and_error(part, column):
    """Mean of a column and its standard error; the error is NaN for a single collision.

    Where there are several samples of a cluster the mean is that of their means, and the error is that over samples:
    rotations of one sample are no draws of the law of the radii. A table without samples has one.
    """
    values = part[column].to_numpy(dtype=float)
    there = np.isfinite(values)
    return mean_over_samples(values[there], _samples(part)[there]) if there.any() else (np.nan, np.nan)


def mean_over_samples(values, samples):
    """Mean over collisions and its standard error, see `mean_and_error`.

    Parameters
    ----------
    values : (n, ...) array
        Of each collision, at least one.
    samples : (n,) array
        Sample of the cluster of each.

    Returns
    -------
    mean, error : (...) arrays
    """
    _, place, count = np.unique(samples, return_inverse=True, return_counts=True)
    if len(count) > 1:
        values = np.array([values[place == k].mean(axis=0) for k in range(len(count))])
    mean = values.mean(axis=0)
    return mean, values.std(axis=0, ddof=1) / np.sqrt(len(values)) if len(values) > 1 else np.nan * mean


def means(table, column):
    """Mean of a column at each velocity with its standard error, see `mean_and_error`.

    Returns
    -------
    velocity, mean, error : (k,) arrays
        The error is 0 where there is one collision.
    """
    found = [(velocity, *mean_and_error(own, column)) for velocity, own in table.groupby("velocity")]
    velocity, mean, error = (np.array(values, dtype=float) for values in zip(*found, strict=True))
    return velocity, mean, np.nan_to_num(error)


def _samples(table):
    """The sample of each collision of a table; all one where it does not say."""
    return table["sample"].to_numpy() if "sample" in table else np.zeros(len(table))


def bootstrap_means(table, column, velocities, count, rng):
    """Means of a column at some velocities, drawn anew.

    Samples of the cluster are drawn with replacement, the same at all velocities, each with the mean of all its
    rotations: rotations of one sample are no draws of the law of the radii. Of a single sample rotations are drawn.
    Draws of n differ from their mean by sqrt(1 - 1/n) of what the mean of n is uncertain by, so that all differences
    are made greater by sqrt(n/(n - 1)).

    Parameters
    ----------
    table : pandas.DataFrame
        One row a collision: `velocity`, the column, and `sample` where there is more than one.
    column : str
    velocities : (k,) array_like
        Each with at least one collision.
    count : int
        Number of draws.
    rng : numpy.random.Generator

    Returns
    -------
    (k, count) float64 array
        NaN where none of the samples drawn has the velocity.
    """
    own = pd.DataFrame({"velocity": table["velocity"], "sample": _samples(table), "value": table[column]}).dropna()
    by_sample = own.groupby(["velocity", "sample"])["value"].mean().unstack().reindex(velocities)
    names = len(by_sample.columns)
    chosen = rng.integers(max(names, 1), size=(count, names))
    drawn_means = np.full((len(velocities), count), np.nan)
    for row, velocity in zip(drawn_means, velocities, strict=True):
        values = by_sample.loc[velocity].to_numpy()
        if not np.isfinite(values).any():
            continue
        if np.isfinite(values).sum() > 1:
            picked = values[chosen]
        else:
            values = own.loc[own["velocity"] == velocity, "value"].to_numpy()
            picked = values[rng.integers(len(values), size=(count, len(values)))]
        there = np.isfinite(picked)
        n = np.isfinite(values).sum()
        with np.errstate(invalid="ignore"):
            means_of_draws = np.where(there, picked, 0.0).sum(axis=1) / there.sum(axis=1)
        wider = np.sqrt(n / (n - 1)) if n > 1 else 1.0
        row[:] = np.nanmean(values) + wider * (means_of_draws - np.nanmean(values))
    return drawn_means


def _checked(table):
    """The table of `fragmentation_velocity` with numbers in its columns."""
    if not isinstance(table, pd.DataFrame):
        raise InputError(f"The table is a {type(table).__name__}; it must be a pandas.DataFrame, one row a collision.")
    table = table.copy()
    for column in ("velocity", "X"):
        if column not in table:
            raise InputError(f"The table has no column {column!r}; it must have velocity and X.")
        try:
            table[column] = [float(value) for value in table[column]]
        except (TypeError, ValueError) as error:
            raise InputError(f"The column {column!r} of the table does not hold numbers alone.") from error
    if not len(table):
        raise InputError("The table has no collisions; it must have at least one row.")
    wrong = table.index[~(np.isfinite(table["velocity"]) & (table["velocity"] > 0.0))]
    if len(wrong):
        raise InputError(
            f"velocity of the row {wrong[0]} is {table.loc[wrong[0], 'velocity']:g}; it must be a number above 0, in "
            "m/s."
        )
    return table


def crossings(velocity, mean, limit):
    """Where values at ascending velocities fall through a limit, (k,) [m/s]; `velocity` and `mean` are (n,) arrays."""
    velocity, mean = velocity[np.isfinite(mean)], mean[np.isfinite(mean)]
    k = np.flatnonzero((mean[:-1] >= limit) & (mean[1:] < limit))
    part = (mean[k] - limit) / (mean[k] - mean[k + 1])
    return velocity[k] + part * (velocity[k + 1] - velocity[k])


def _crossing(velocity, mean, limit):
    """The last of `crossings`; NaN for none."""
    falls = crossings(velocity, mean, limit)
    return falls[-1] if len(falls) else np.nan
