"""omega of disruption over the size of a grain: a power of it, and whether it flattens."""

import math

import numpy as np
import pandas as pd

from ratd.base.materials import get_material
from ratd.base.statistics import drawn_counts, equal_weights, slope_error, slope_of, weighted_line, weighted_parabola
from ratd.experiments.spin_up.cells import N_BOOTSTRAP, cell_of, size_key

__all__ = ["SPLIT", "curved_law", "curved_law_value", "size_law", "size_law_unit", "slopes", "unit_of"]

SPLIT = 300e-9
"""Size [m] from which on omega_disr flattens in the paper (Sect. 8)."""


def unit_of(material):
    """sqrt(gamma/(rho a^3)) of a material with a = `SPLIT` [rad s-1], the unit of omega of `size_law`."""
    return math.sqrt(material.surface_energy / (material.density * SPLIT**3))


def size_law_unit(table):
    """`unit_of` the material of each grain of a table [rad s-1]."""
    unit = {name: unit_of(get_material(name)) for name in table["material"].unique()}
    return table["material"].map(unit).to_numpy(float)


def size_law(table, mark="omega_disr"):
    """omega of each type as a power of size, for whoever has no grain at hand.

    omega = C sqrt(gamma/(rho a^3)) (a_eff/a)^-p with a = `SPLIT`, by least squares of ln omega; all cells count alike.
    As in Eq. 33 of Reissl et al. (2024) the material only sets the unit; the contacts and the filling factor, which
    that has as well, go with size and type.

    Parameters
    ----------
    table : pandas.DataFrame
        One row a grain, of one drive.
    mark : str
        omega [rad s-1].

    Returns
    -------
    pandas.DataFrame
        A row a type of at least two sizes: C, p with `_error`; scatter, the root mean square of the residuals of
        ln omega; n_grains.
    """
    return _laws(table, mark, "Cp", weighted_line)


def curved_law(table, mark="omega_mass_75"):
    """omega of each type as a curve over size, for whoever has no grain at hand.

    omega = C sqrt(gamma/(rho a^3)) (a_eff/a)^(-p - q ln(a_eff/a)) with a = `SPLIT`, by least squares of ln omega; all
    cells count alike. It is `size_law` with a power that changes by 2 q where the size changes by a factor e, and is
    meant for the sizes of the table, not beyond.

    Parameters
    ----------
    table : pandas.DataFrame
        One row a grain, of one drive.
    mark : str
        omega [rad s-1].

    Returns
    -------
    pandas.DataFrame
        A row a type of at least three sizes: C, p, q with `_error`; scatter, the root mean square of the residuals of
        ln omega; n_grains.
    """
    return _laws(table, mark, "Cpq", weighted_parabola)


def _laws(table, mark, names, fit):
    """`size_law` and `curved_law`: a row a type, `fit` being what finds as many numbers as there are names."""
    table = table[table[mark].astype(float) > 0]
    rng = np.random.Generator(np.random.PCG64(0))
    rows = []
    for kind, part in table.groupby("type", sort=False):
        if size_key(part["a_eff"]).nunique() < len(names):
            continue
        x = np.log(part["a_eff"].to_numpy(float) / SPLIT)
        y = np.log(part[mark].to_numpy(float) / size_law_unit(part))
        weights = equal_weights(cell_of(part))
        powers = fit(x, y, weights)
        drawn = fit(x, y, drawn_counts(rng, N_BOOTSTRAP, len(x)) * weights)
        row = {"type": kind}
        for name, value, values in zip(names, _numbers(powers), _numbers(drawn), strict=True):
            # a replicate may have drawn too few sizes
            row |= {name: float(value), f"{name}_error": float(np.nanstd(values, ddof=1))}
        residual = y - sum(power * x**k for k, power in enumerate(reversed(powers)))
        row["scatter"] = float(np.sqrt(np.average(residual**2, weights=weights)))
        rows.append(row | {"n_grains": len(part)})
    return pd.DataFrame(rows)


def _numbers(powers):
    """C, p, ... of the factors of the powers of ln a_eff, the highest first."""
    *higher, level = powers
    return [np.exp(level), *(-power for power in reversed(higher))]


def curved_law_value(a_eff, C, p, q=0.0):
    """omega in units of sqrt(gamma/(rho a^3)), C (a_eff/a)^(-p - q ln(a_eff/a)) with a = `SPLIT`.

    Parameters
    ----------
    a_eff : array_like
        Effective radius [m].
    C, p, q : float
        From `curved_law`; with q = 0 that of `size_law`.

    Returns
    -------
    numpy.ndarray or float
    """
    x = np.log(np.asarray(a_eff, dtype=float) / SPLIT)
    return C * np.exp(-p * x - q * x**2)


def slopes(table, mark="omega_disr", split=SPLIT):
    """d ln omega/d ln a_eff below and above a size, and their difference: whether omega flattens.

    Parameters
    ----------
    table : pandas.DataFrame
        One row a grain, of one drive.
    mark : str
        omega [rad s-1].
    split : float
        Size [m]; grains of this size count on both sides.

    Returns
    -------
    pandas.DataFrame
        A row a type: below, above, change (above - below) with `_error` (`ratd.base.statistics.slope_error`, NaN where
        a side has too few grains for one); sizes_below, sizes_above, n_grains. Materials are taken together, each with
        a level of its own, and all cells of a side count alike. NaN where a side has fewer than two sizes.
    """
    table = table[table[mark].astype(float) > 0]
    rows = []
    for kind, part in table.groupby("type", sort=False):
        size = size_key(part["a_eff"]).to_numpy()
        edge = size_key(pd.Series([split])).iloc[0]
        cell, material = cell_of(part), pd.factorize(part["material"])[0]
        x, y = np.log(part["a_eff"].to_numpy(float)), np.log(part[mark].to_numpy(float))
        row = {"type": kind, "n_grains": len(part)}
        influence = {}
        for side, chosen in {"below": size <= edge, "above": size >= edge}.items():
            influence[side] = np.zeros(len(part))
            row[f"sizes_{side}"] = len(np.unique(size[chosen]))
            row[side], influence[side][chosen] = slope_of(
                x[chosen], y[chosen], material[chosen], equal_weights(cell[chosen])
            )
        row["change"] = row["above"] - row["below"]
        influence["change"] = influence["above"] - influence["below"]
        row |= {f"{name}_error": slope_error(values) for name, values in influence.items()}
        if not np.isfinite([row["below_error"], row["above_error"]]).all():
            row["change_error"] = np.nan  # that of one side alone is not that of the difference
        rows.append(row)
    return pd.DataFrame(rows)
