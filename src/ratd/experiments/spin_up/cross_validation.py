"""How well Eq. 33, the cut bound and a power of size predict omega of disruption of grains they were not fitted to."""

import numpy as np
import pandas as pd

from ratd.base.statistics import drawn_counts, equal_weights, mean_of, weighted_line
from ratd.experiments.spin_up.cells import N_BOOTSTRAP, cell_of, size_key
from ratd.experiments.spin_up.size_law import SPLIT, size_law_unit

__all__ = ["PREDICTORS", "cross_validation"]


PREDICTORS = {
    "Eq. 33": "its A and alpha fitted anew for each material and type, 18 numbers for the paper's grains",
    "cut bound": "c times the cut bound, one c for all grains",
    "cut bound by type": "c times the cut bound, one c a type, 3 numbers",
    "power of size": f"C sqrt(gamma/(rho a³)) (a_eff/a)^-p, a = {SPLIT * 1e9:g} nm, C and p of each type, 6 numbers",
}
"""What is compared out of sample, and what each of them fits."""


def cross_validation(table, mark="omega_disr"):
    """How well Eq. 33, the cut bound and a power of size predict omega of grains of a size they were not fitted to.

    One size after the other is left out, so that a prediction goes beyond the sizes of the fit.

    Parameters
    ----------
    table : pandas.DataFrame
        One row a grain, of one drive.
    mark : str
        What is predicted [rad s-1].

    Returns
    -------
    pandas.DataFrame
        A row for each of `PREDICTORS` and for each type and "all": scatter (root mean square of the residuals of
        ln omega out of sample), error (bootstrap over grains), n_grains. Only grains count that all predictors
        predict; all cells count alike.
    """
    needed = [mark, "cut_bound", "n_monomers", "n_contacts", "filling_factor", "a_eff"]
    table = table[(table[needed].astype(float) > 0).all(axis=1)]
    grains = _Grains(table, mark)
    rng = np.random.Generator(np.random.PCG64(0))
    residual = np.full((len(table), len(PREDICTORS)), np.nan)
    for size in np.unique(grains.size):
        out = grains.size == size
        if out.all():
            continue
        for k, predict in enumerate(_PREDICT):
            residual[out, k] = (np.log(grains.omega) - predict(grains, ~out))[out]
    known = ~np.isnan(residual).any(axis=1)
    rows = []
    for kind in [*dict.fromkeys(grains.type), "all"]:
        chosen = known if kind == "all" else known & (grains.type == kind)
        found = _scatter(residual[chosen], equal_weights(grains.cell[chosen]), rng)
        rows += [{"type": kind, "predictor": name, **own, "n_grains": int(chosen.sum())}
                 for name, own in zip(PREDICTORS, found, strict=True)]  # fmt: skip
    return pd.DataFrame(rows)


class _Grains:
    """What is predicted of the grains of a table, and what from, as arrays, of which a part is quickly taken."""

    def __init__(self, table, mark):
        self.omega, self.a_eff, self.cut_bound = table[[mark, "a_eff", "cut_bound"]].to_numpy(float).T
        self.contacts, self.monomers, self.filling = (
            table[["n_contacts", "n_monomers", "filling_factor"]].to_numpy(float).T
        )
        self.type = table["type"].to_numpy()
        self.series = pd.MultiIndex.from_frame(table[["material", "type"]]).factorize()[0]
        self.size, self.cell = size_key(table["a_eff"]).to_numpy(), cell_of(table)
        self.unit = size_law_unit(table)


def _by_contacts(grains, train):
    """ln omega as a constant and a power of N_con phi, over a_eff.

    Each material and type has a fit of its own, as `eq33.fit_ensemble` makes it, of which the constants of the material
    only change the level.
    """
    x, y = np.log(grains.contacts * grains.filling), np.log(grains.omega * grains.a_eff)
    predicted = np.full(len(y), np.nan)
    for series in np.unique(grains.series):
        rows = grains.series == series
        own = rows & train
        size = grains.size[own]
        if len(np.unique(size)) > 1 and len(size) > 2 and np.ptp(x[own]):
            power, level = weighted_line(x[own], y[own], equal_weights(size))
            predicted[rows] = level + power * x[rows] - np.log(grains.a_eff[rows])
    return predicted


def _by_cut_bound(grains, train):
    """ln omega as a constant times the cut bound."""
    return np.log(grains.cut_bound) + _over_bound(grains, train)


def _by_cut_bound_of_type(grains, train):
    """ln omega as a constant of its type times the cut bound."""
    over = {kind: _over_bound(grains, train & (grains.type == kind)) for kind in dict.fromkeys(grains.type)}
    return np.log(grains.cut_bound) + np.array([over[kind] for kind in grains.type])


def _by_size(grains, train):
    """ln omega as a constant and a power of size of its type, see `size_law`."""
    x, y = np.log(grains.a_eff / SPLIT), np.log(grains.omega / grains.unit)
    predicted = np.full(len(y), np.nan)
    for kind in dict.fromkeys(grains.type):
        rows = grains.type == kind
        own = rows & train
        if len(np.unique(grains.size[own])) > 1:
            power, level = weighted_line(x[own], y[own], equal_weights(grains.cell[own]))
            predicted[rows] = level + power * x[rows] + np.log(grains.unit[rows])
    return predicted


def _over_bound(grains, chosen):
    """Mean ln of omega over the cut bound; all cells count alike."""
    return mean_of(np.log(grains.omega[chosen] / grains.cut_bound[chosen]), grains.cell[chosen])[0]


_PREDICT = (_by_contacts, _by_cut_bound, _by_cut_bound_of_type, _by_size)


def _scatter(residual, weights, rng):
    """Root mean square of each column, with its bootstrap error."""
    n, columns = residual.shape
    if n < 2:
        return [dict.fromkeys(("scatter", "error"), np.nan)] * columns
    scatter = np.sqrt(np.average(residual**2, axis=0, weights=weights))
    often = drawn_counts(rng, N_BOOTSTRAP, n) * weights
    drawn = np.sqrt(often @ residual**2 / often.sum(axis=1, keepdims=True))
    return [{"scatter": float(scatter[k]), "error": float(np.std(drawn[:, k], ddof=1))} for k in range(columns)]
