"""What compressions say of the compressive strength: ratios to P_0 phi^3, fits, and the number of neighbours."""

import warnings
from typing import NamedTuple

import numpy as np
import xarray as xr

from ratd.base.checks import is_number
from ratd.base.errors import InputError
from ratd.base.measured import Measured
from ratd.base.statistics import jackknife_error
from ratd.experiments.compression.tables import BIN, bins, in_bins, shared_bins

__all__ = [
    "FIT_RANGE",
    "Fit",
    "anisotropy",
    "compressive_strength",
    "crossing",
    "crosses_line",
    "fit_power_law",
    "fit_with_limit",
    "led_by",
    "mean_pressure",
    "measured",
    "of_means",
    "of_same_clusters",
    "phi_at",
    "power_at",
    "ratio_at",
    "slope_of_structure",
]

FIT_RANGE = (0.03, 0.12)
"""Filling factors between which the power law is fitted."""
LIMIT_RANGE = (0.1, 0.5)
"""Filling factors between which the law with a greatest filling factor is fitted."""
FARTHEST = 4
"""Distances of N(<r) over which the slope far away is taken."""
FEWEST_BINS = 3
"""Bins with a mean pressure above 0 that a fit needs."""
UNEQUAL = 1.2
"""Greatest ratio of the P_0 of two clusters whose unequal monomers are drawn from one law."""
ALIKE = ("material", "n_monomers", "strain_rate", "scheme", "law")
"""Attributes that are the same in runs that differ in their seeds alone."""
SAME_SIZE = 1e-5
"""Part by which the radii of gyration of runs of one aggregate differ at most."""
NEAR = 1.11
"""A value at phi is that of all bins from phi/NEAR to phi NEAR."""


class Fit(NamedTuple):
    """Numbers fitted to the mean over seeds, with standard errors by leaving out one seed at a time.

    Attributes
    ----------
    value, error : (k,) float64 array
        The error is NaN for a single seed.
    n : int
        Number of seeds.
    """

    value: np.ndarray
    error: np.ndarray
    n: int


def measured(fit):
    """The first number of a `Fit` with its error."""
    return several(fit)[0]


def several(fit):
    """The numbers of a `Fit` with their errors, list of `Measured`."""
    return [Measured(float(value), float(error)) for value, error in zip(fit.value, fit.error, strict=True)]


def of_means(pressure, fit):
    """A `Fit` of ``fit(mean pressure)``, with pressures (seeds, bins), or other numbers of each seed."""
    return of_clusters(len(pressure), lambda own: fit(pressure[own].mean(axis=0)))


def of_clusters(n, fit):
    """A `Fit` of ``fit(own)``, one number or several of the clusters `own` (indices) of n."""
    every = np.arange(n)
    value = np.atleast_1d(fit(every))
    if n < 2:
        return Fit(value, np.full(len(value), np.nan), n)
    left = np.array([np.atleast_1d(fit(np.delete(every, k))) for k in range(n)])
    return Fit(value, np.array([jackknife_error(column) for column in left.T]), n)


def _reaching(table, low, high):
    """Bins inside a range of filling factors, and seeds that reach all of them: two arrays of bool."""
    phi = table["phi"].values
    inside = (phi >= low) & (phi <= high)
    whole = np.isfinite(table["pressure"].values[:, inside]).all(axis=1)
    covered = phi.min() / BIN <= low * NEAR and phi.max() * BIN >= high / NEAR
    if not inside.any() or not whole.any() or not covered:
        raise InputError(
            f"no run covers the filling factors from {low:g} to {high:g}; take a low and a high between "
            f"{phi.min():.3g} and {phi.max():.3g}."
        )
    return inside, whole


def _within(table, low, high):
    """Filling factors of bins inside a range, and pressures there, (seeds, bins), of seeds that reach all of them."""
    inside, whole = _reaching(table, low, high)
    return table["phi"].values[inside], table["pressure"].values[np.ix_(whole, inside)]


def fit_power_law(table, low=FIT_RANGE[0], high=FIT_RANGE[1]):
    """Exponent n and prefactor of P = c P_0 phi^n, and c where n is 3.

    Parameters
    ----------
    table : xarray.Dataset
        Of the kind ``compression_set``.
    low, high : float
        Range of phi.

    Returns
    -------
    Fit
        Of (n, c, c_3): c of a free exponent is told at phi = 0.1, where it is P/(P_0 phi^3); c_3 is the geometric mean
        of P/(P_0 phi^3) over the bins. Least squares in ln P, every bin with the same weight.

    Notes
    -----
    P may be negative in a bin of a small cluster; such bins of the mean are left out.
    """
    phi, pressure = _within(table, low, high)
    ratio = pressure / table["rolling_pressure"].values[0] / phi**3

    def fit(mean):
        good = mean > 0.0
        if good.sum() < FEWEST_BINS:
            raise InputError(
                f"between the filling factors {low:g} and {high:g} the pressure is above 0 in {good.sum()} bins; a "
                f"power law needs {FEWEST_BINS} at least."
            )
        x, y = np.log(phi[good] / 0.1), np.log(mean[good])
        slope, constant = np.polyfit(x, y, 1)
        return np.array([3.0 + slope, np.exp(constant), np.exp(y.mean())])

    return of_means(ratio, fit)


def fit_with_limit(table, low=LIMIT_RANGE[0], high=LIMIT_RANGE[1]):
    """c and phi_max of P = c P_0 (1/phi - 1/phi_max)^-3.

    Returns
    -------
    Fit
        Of (c, phi_max): (P_0/P)^(1/3) is a straight line in 1/phi, fitted with weights that make relative errors of P
        count alike.
    """
    phi, pressure = _within(table, low, high)
    P_0 = table["rolling_pressure"].values[0]

    def fit(mean):
        y = np.cbrt(P_0 / mean)
        slope, constant = np.polyfit(1.0 / phi, y, 1, w=1.0 / y)
        return np.array([slope**-3.0, -slope / constant])

    return of_means(pressure, fit)


def ratio_at(table, phi):
    """P/(P_0 phi^3) at a filling factor, from a parabola in ln phi through the bins near it; `Fit` of one number.

    A straight line would be too high where the curve bends, by 4 % about 0.3. It is taken all the same near an end of
    the table, where bins on one side are missing and a parabola is not held.
    """
    there, pressure = _within(table, phi / NEAR, phi * NEAR)
    x = np.log(there / phi)
    degree = 2 if min(-x.min(), x.max()) > np.log(BIN) else 1
    ratio = pressure / table["rolling_pressure"].values[0] / there**3
    return of_means(ratio, lambda mean: np.polyval(np.polyfit(x, mean, degree), 0.0))


def power_at(table, phi):
    """d ln P/d ln phi at a filling factor, from the same bins as `ratio_at`; `Fit` of one number, NaN where P < 0."""
    there, pressure = _within(table, phi / NEAR, phi * NEAR)
    x = np.log(there / phi)
    degree = 2 if min(-x.min(), x.max()) > np.log(BIN) else 1

    def power(mean):
        return np.polyfit(x, np.log(mean), degree)[-2] if (mean > 0.0).all() else np.nan

    return of_means(pressure, power)


def led_by(table, phi, k):
    """Part of the pressure of all clusters near a filling factor that the `k` bear which are pressed most."""
    _, pressure = _within(table, phi / NEAR, phi * NEAR)
    single = np.sort(pressure.mean(axis=1))
    return float(single[-k:].sum() / single.sum())


def scatter_at(table, phi):
    """Standard deviation of P over its mean between single clusters near a filling factor, `Fit` of one number."""
    phi, pressure = _within(table, phi / NEAR, phi * NEAR)
    single = (pressure / phi**3).mean(axis=1)

    def scatter(values):
        return values.std(ddof=1) / values.mean() if len(values) > 1 else np.nan

    return of_clusters(len(single), lambda own: scatter(single[own]))


def mean_pressure(table, *, alone=False):
    """Mean over seeds of P [Pa] and its standard error, (bins,) each.

    Parameters
    ----------
    table : xarray.Dataset
    alone : bool
        Whether runs that begin at a higher filling factor count with P = 0 before, as in Fig. 6 of the paper: their
        clusters do not touch each other yet. Else bins are NaN that some run lacks.
    """
    pressure = table["pressure"].values.copy()
    if alone:
        before = np.cumsum(np.isfinite(pressure), axis=1) == 0
        pressure[before] = 0.0
    n = len(pressure)
    error = pressure.std(axis=0, ddof=1) / np.sqrt(n) if n > 1 else np.full(pressure.shape[1], np.nan)
    return pressure.mean(axis=0), error


def phi_at(table, pressure, high=0.45):
    """Filling factor between 0.05 and `high` at which the mean pressure reaches a value [Pa], `Fit` of one number.

    NaN where it is above or below all the way.
    """
    phi, all_pressures = _within(table, 0.05, high)

    def fit(mean):
        rising = np.maximum.accumulate(np.maximum(mean, 1e-300))
        return np.exp(np.interp(np.log(pressure), np.log(rising), np.log(phi), left=np.nan, right=np.nan))

    return of_means(all_pressures, fit)


def crosses_line(table, high):
    """Filling factor between 0.05 and `high` from which on the mean pressure is above P_0 phi^3, `Fit` of one number.

    NaN where it is above or below all the way.
    """
    phi, pressure = _within(table, 0.05, high)
    ratio = pressure / table["rolling_pressure"].values[0] / phi**3

    def fit(mean):
        below = np.flatnonzero(mean <= 1.0)
        if not len(below) or below[-1] == len(phi) - 1:
            return np.nan
        pair = slice(below[-1], below[-1] + 2)
        return crossing(phi[pair], mean[pair], 1.0)

    return of_means(ratio, fit)


def crossing(phi, values, wanted):
    """Where values that rise, straight in ln phi between two filling factors, are the wanted one."""
    return np.exp(np.interp(wanted, values, np.log(phi)))


def anisotropy(table, own=slice(None)):
    """Standard deviation of P_xx, P_yy, P_zz, root mean square over seeds, over the mean pressure, (bins,).

    NaN where the mean pressure is not above 0. `own` are indices of clusters, all of them by default.
    """
    axes = np.stack([table[f"pressure_{name}"].values[own] for name in ("xx", "yy", "zz")])
    mean = table["pressure"].values[own].mean(axis=0)
    return np.sqrt((axes.std(axis=0, ddof=1) ** 2).mean(axis=0)) / np.where(mean > 0.0, mean, np.nan)


def anisotropy_at(table, phi):
    """Mean of `anisotropy` near a filling factor, `Fit` of one number."""
    near = np.abs(np.log(table["phi"].values / phi)) < np.log(NEAR)
    return of_clusters(table.sizes["seed_number"], lambda own: anisotropy(table, own)[near].mean())


def along_axes(table, phi):
    """Mean P_xx, P_yy and P_zz over the mean pressure near a filling factor, `Fit` of three numbers."""
    place = np.abs(np.log(table["phi"].values / phi)) < np.log(NEAR)
    axes = [table[f"pressure_{name}"].values[:, place].mean(axis=1) for name in ("xx", "yy", "zz")]
    return of_means(np.stack(axes, axis=1), lambda mean: mean / mean.mean())


def of_same_clusters(tables):
    """The tables with the seeds alone that all of them have, in the same order."""
    rows = [{seed: k for k, seed in enumerate(table["seed"].values.tolist())} for table in tables]
    common = sorted(set.intersection(*map(set, rows)))
    return [table.isel(seed_number=[row[seed] for seed in common]) for table, row in zip(tables, rows, strict=True)]


def compared(table, other, low=FIT_RANGE[0], high=FIT_RANGE[1]):
    """P/(P_0 phi^3) of a set over that of another, of the seeds that reach all of the range in both.

    Parameters
    ----------
    table, other, low, high
        As for `fit_power_law`.

    Returns
    -------
    Fit
        Of (ratio, difference of the exponents): the geometric mean of the ratio over the bins, from the mean pressures
        of the seeds, and its slope in ln phi. The error leaves out one seed of both at a time.
    """
    # a cluster counts where both of its runs reach all bins: one that a table alone lacks would shift the others
    pair = of_same_clusters([each.isel(seed_number=_reaching(each, low, high)[1]) for each in (table, other)])
    both = []
    for each, at in zip(pair, shared_bins(*pair), strict=True):
        phi, pressure = _within(each.isel(phi_bin=at), low, high)
        both.append(pressure / each["rolling_pressure"].values[0] / phi**3)

    def fit(mean):
        good = (mean > 0.0).all(axis=0)
        y = np.log(mean[0, good] / mean[1, good])
        return np.array([np.exp(y.mean()), np.polyfit(np.log(phi[good]), y, 1)[0]])

    return of_means(np.stack(both, axis=1), fit)


def far_slope_of_structure(table, snapshot):
    """`slope_of_structure` over the `FARTHEST` greatest distances within which half of the monomers of the box are."""
    number = table["number_within"].values[:, snapshot]
    there = number[np.isfinite(number).any(axis=1)]
    if not len(there):
        return log_slope(table["distance"].values[:0], number[:, :0])
    inside = there.mean(axis=0) < 0.5 * table["n_monomers"].item()
    last = np.flatnonzero(inside & np.isfinite(there).all(axis=0))[-FARTHEST:]
    return log_slope(table["distance"].values[last], number[:, last])


def slope_of_structure(table, snapshot, low=2.5, high=8.0):
    """d ln N(<r)/d ln r between two distances in r_0, `Fit` of one number."""
    distance = table["distance"].values
    inside = (distance >= low) & (distance <= high)
    return log_slope(distance[inside], table["number_within"].values[:, snapshot, inside])


def log_slope(x, y):
    """d ln y/d ln x of the mean of rows y over what is finite, `Fit` of one number; NaN for fewer than two points."""
    y = y[np.isfinite(y).any(axis=1)]
    there = np.isfinite(y).all(axis=0) if len(y) else np.zeros(len(x), dtype=bool)
    if there.sum() < 2:
        return Fit(np.full(1, np.nan), np.full(1, np.nan), len(y))
    return of_means(y[:, there], lambda mean: np.polyfit(np.log(x[there]), np.log(mean), 1)[0])


def compressive_strength(run, low=FIT_RANGE[0], high=FIT_RANGE[1]):
    """Strength of compressed clusters against P_0 phi^3.

    Parameters
    ----------
    run : xarray.Dataset or list of xarray.Dataset
        What `ratd.compress` returned, for one cluster or for some that differ in their seeds alone.
    low, high : float
        Filling factors between which the power law is fitted.

    Returns
    -------
    dict
        ``exponent``; ``prefactor``, P/(P_0 phi^3) at phi = 0.1 from the fit; ``ratio``, the geometric mean of
        P/(P_0 phi^3) in the range; each with ``_error`` beside it, NaN for a single run, and for runs of one aggregate,
        moved by a hair each, whose scatter says nothing of others; ``n``, number of runs.

    Raises
    ------
    InputError
        If there is no run, one is no compression, they differ in more than their seeds, one is given twice, or none
        covers the range, with some pressure above 0.

    Warns
    -----
    UserWarning
        If a run is not static from `low` on, or if all runs are of one aggregate.
    """
    found = list(run) if isinstance(run, list | tuple) else [run]
    _check_runs(found)
    if not (is_number(low) and is_number(high) and 0.0 < low < high):
        raise InputError(f"low and high are {low!r} and {high!r}; they must be numbers above 0, the lower one first.")
    static = max(each.attrs.get("static_from", 0.0) for each in found)
    if static > low:
        warnings.warn(
            f"the compression is static from phi = {static:.2g} on: between low = {low:g} and there inertia presses.",
            UserWarning,
            stacklevel=2,
        )
    first = min(bins(each["phi_mean"].values[:1])[0] for each in found)
    last = max(bins(each["phi_mean"].values[-1:])[0] for each in found)
    table = xr.Dataset({"phi": ("phi_bin", BIN ** (np.arange(first, last + 1) + 0.5))})
    table["pressure"] = (
        ("seed_number", "phi_bin"),
        # clusters of unequal monomers have each a P_0 of their own
        np.array([in_bins(each, first, last)["pressure"] / each.attrs["rolling_pressure"] for each in found]),
    )
    table["rolling_pressure"] = ("seed_number", np.ones(len(found)))
    fit = fit_power_law(table, low, high)
    names = ("exponent", "prefactor", "ratio")
    values = dict(zip(names, fit.value.tolist(), strict=True))
    sizes = [each.attrs.get("radius_of_gyration", np.nan) for each in found]
    one = len(found) > 1 and max(sizes) - min(sizes) < SAME_SIZE * max(sizes)
    if one:
        warnings.warn(
            f"the {len(found)} runs are of one aggregate, moved by a hair each: what they differ by is no error of the "
            "mean, and errors are told as NaN; other aggregates of the same kind differ by more.",
            UserWarning,
            stacklevel=2,
        )
    error = np.full(len(names), np.nan) if one else fit.error
    errors = dict(zip([f"{name}_error" for name in names], error.tolist(), strict=True))
    return {**values, **errors, "n": fit.n}


def _check_runs(runs):
    """Raise InputError unless there are runs of `ratd.compress`, all of the same rolling pressure."""
    allowed = "it must be what ratd.compress returned, or a list of these"
    if not runs:
        raise InputError(f"run is an empty list; {allowed}.")
    for one in runs:
        needed = {"phi_mean", "pressure", "pressure_tensor"}
        if not isinstance(one, xr.Dataset) or "rolling_pressure" not in one.attrs or not needed <= set(one):
            what = "the Dataset of something else" if isinstance(one, xr.Dataset) else f"of type {type(one).__name__}"
            raise InputError(f"run is {what}; {allowed}.")
        if not one.sizes["record"]:
            raise InputError("run has no records: it ended before the first one, and tells no pressure.")
    every = sorted({float(one.attrs["rolling_pressure"]) for one in runs})
    if every[-1] > UNEQUAL * every[0]:
        raise InputError(
            f"the runs have P_0 from {every[0]:.4g} to {every[-1]:.4g} Pa; they may differ in their seeds alone, not "
            "in material or radius."
        )
    for name in ALIKE:
        values = list(dict.fromkeys(one.attrs[name] for one in runs if name in one.attrs))
        if len(values) > 1:
            raise InputError(
                f"the runs have {name} {values[0]!r} and {values[1]!r}; they may differ in their seeds alone."
            )
    for number, one in enumerate(runs):
        same = next((k for k in range(number) if _is_same(runs[k], one)), None)
        if same is not None:
            raise InputError(f"the runs {same} and {number} are the same one; each may be given once.")


def _is_same(one, other):
    """Whether two runs are one: clusters of other seeds never have the same pressures."""
    return one["pressure"].equals(other["pressure"])
