"""How well Eq. 33, the cut bound and a power of size predict omega of disruption of grains they were not fitted to."""

import numpy as np
import pandas as pd

from ratd.base.errors import InputError
from ratd.base.statistics import drawn_counts, equal_weights, mean_of, weighted_line
from ratd.experiments.spin_up.cells import N_BOOTSTRAP, cell_of, size_key
from ratd.experiments.spin_up.size_law import SPLIT, size_law_unit

__all__ = ["LEFT_OUT", "PREDICTORS", "SEPARATE", "cross_validation"]


PREDICTORS = {
    "Eq. 33": "its A and alpha fitted anew for each material and type, 18 numbers for the paper's grains",
    "cut bound": "c times the cut bound, one c for all grains",
    "cut bound by type": "c times the cut bound, one c a type, 3 numbers",
    "power of size": f"C sqrt(gamma/(rho a³)) (a_eff/a)^-p, a = {SPLIT * 1e9:g} nm, C and p of each type, 6 numbers",
}
"""What is compared out of sample, and what each of them fits."""

SEPARATE = "Eq. 33, separate exponents"
"""Eq. 33 with an exponent each for <N_con>, N_mon and phi, of which the paper says that it fits no better."""

LEFT_OUT = {"size": "one size left out", "fold": "a fifth of the grains left out"}
"""Ways to leave grains out of a fit, in words."""


def cross_validation(
    table, mark="omega_disr", by="size", folds=5, seed=0, predictors=tuple(PREDICTORS), materials=None
):
    """How well Eq. 33, the cut bound and a power of size predict omega of grains that they were not fitted to.

    Parameters
    ----------
    table : pandas.DataFrame
        One row a grain, of one drive.
    mark : str
        What is predicted [rad s-1].
    by : {"size", "fold"}
        Which grains are left out together: all of one size, so that a prediction goes beyond the sizes of the fit, or
        those of random folds.
    folds : int
        Number of random folds.
    seed : int
        Of the folds and of the bootstrap.
    predictors : sequence of str
        Of `PREDICTORS` and `SEPARATE`.
    materials : optional
        Table of materials, handed to `ratd.base.materials.get_material`.

    Returns
    -------
    pandas.DataFrame
        A row for each of `predictors` and for each type and "all": scatter (root mean square of the residuals of
        ln omega out of sample), error (bootstrap over grains), bias (mean residual, found - predicted), more (scatter
        less that of the predictor with the least) with more_error, over_first (scatter over that of the first
        predictor) with over_first_error (both from the same draws for the two), n_grains. Only grains count that all
        predictors predict; all cells count alike.

    Raises
    ------
    InputError
        If `by` or a predictor is none of these.
    """
    if by not in LEFT_OUT:
        raise InputError(f"cross_validation: by is {by!r}, allowed are {' and '.join(map(repr, LEFT_OUT))}")
    for name in predictors:
        if name not in _PREDICT:
            raise InputError(f"cross_validation: predictor is {name!r}, allowed are {', '.join(map(repr, _PREDICT))}")
    needed = [mark, "cut_bound", "n_monomers", "n_contacts", "filling_factor", "a_eff"]
    table = table[(table[needed].astype(float) > 0).all(axis=1)]
    grains = _Grains(table, mark, materials)
    rng = np.random.Generator(np.random.PCG64(seed))
    group = grains.size if by == "size" else rng.permutation(len(table)) % folds
    residual = np.full((len(table), len(predictors)), np.nan)
    for value in np.unique(group):
        out = group == value
        if out.all():
            continue
        for k, name in enumerate(predictors):
            residual[out, k] = (np.log(grains.omega) - _PREDICT[name](grains, ~out))[out]
    known = ~np.isnan(residual).any(axis=1)
    rows = []
    for kind in [*dict.fromkeys(grains.type), "all"]:
        chosen = known if kind == "all" else known & (grains.type == kind)
        found = _scatter(residual[chosen], equal_weights(grains.cell[chosen]), rng)
        rows += [{"type": kind, "predictor": name, **own, "n_grains": int(chosen.sum())}
                 for name, own in zip(predictors, found, strict=True)]  # fmt: skip
    return pd.DataFrame(rows)


class _Grains:
    """What is predicted of the grains of a table, and what from, as arrays, of which a part is quickly taken."""

    def __init__(self, table, mark, materials):
        self.omega, self.a_eff, self.cut_bound = table[[mark, "a_eff", "cut_bound"]].to_numpy(float).T
        self.contacts, self.monomers, self.filling = (
            table[["n_contacts", "n_monomers", "filling_factor"]].to_numpy(float).T
        )
        self.type = table["type"].to_numpy()
        self.series = pd.MultiIndex.from_frame(table[["material", "type"]]).factorize()[0]
        self.size, self.cell = size_key(table["a_eff"]).to_numpy(), cell_of(table)
        self.unit = size_law_unit(table, materials)

    def common(self):
        """ln(N_con phi), shape (n, 1)."""
        return np.log(self.contacts * self.filling)[:, None]

    def separate(self):
        """ln of <N_con>, N_mon and phi, shape (n, 3)."""
        return np.log(np.column_stack([self.contacts / self.monomers, self.monomers, self.filling]))


def _by_powers(logarithms):
    """What predicts ln omega of grains as a constant and powers of some quantities over a_eff.

    `logarithms` makes the logarithms of these quantities of `_Grains`, shape (n, k). What predicts takes them and which
    of them it is fitted to. Each material and type has a fit of its own, as `eq33.fit_ensemble` makes it, of
    which the constants of the material only change the level.
    """

    def predict(grains, train):
        x, y = logarithms(grains), np.log(grains.omega * grains.a_eff)
        predicted = np.full(len(y), np.nan)
        for series in np.unique(grains.series):
            rows = grains.series == series
            own = rows & train
            size = grains.size[own]
            if len(np.unique(size)) < 2 or len(size) < x.shape[1] + 2 or not np.ptp(x[own], axis=0).any():
                continue
            weights = equal_weights(size)
            middle, level = np.average(x[own], axis=0, weights=weights), np.average(y[own], weights=weights)
            # of least norm about the means, where grains leave a power open, as <N_con> of grains without loops does
            root = np.sqrt(weights)
            powers = np.linalg.lstsq((x[own] - middle) * root[:, None], (y[own] - level) * root, rcond=1e-9)[0]
            predicted[rows] = level + (x[rows] - middle) @ powers - np.log(grains.a_eff[rows])
        return predicted

    return predict


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


_PREDICT = {
    **dict(zip(PREDICTORS, (_by_powers(_Grains.common), _by_cut_bound, _by_cut_bound_of_type, _by_size), strict=True)),
    SEPARATE: _by_powers(_Grains.separate),
}


def _scatter(residual, weights, rng):
    """Root mean square of each column with its bootstrap error, its mean, how it compares with the least and first."""
    n, columns = residual.shape
    if n < 2:
        names = ("scatter", "error", "bias", "more", "more_error", "over_first", "over_first_error")
        return [dict.fromkeys(names, np.nan)] * columns
    scatter = np.sqrt(np.average(residual**2, axis=0, weights=weights))
    often = drawn_counts(rng, N_BOOTSTRAP, n) * weights
    drawn = np.sqrt(often @ residual**2 / often.sum(axis=1, keepdims=True))
    more = drawn - drawn[:, [scatter.argmin()]]
    with np.errstate(invalid="ignore", divide="ignore"):  # the first may be exact
        over_first, drawn_over_first = scatter / scatter[0], drawn / drawn[:, [0]]
    return [
        {
            "scatter": float(scatter[k]),
            "error": float(np.std(drawn[:, k], ddof=1)),
            "bias": float(np.average(residual[:, k], weights=weights)),
            "more": float(scatter[k] - scatter.min()),
            "more_error": float(np.std(more[:, k], ddof=1)),
            "over_first": float(over_first[k]),
            "over_first_error": float(np.std(drawn_over_first[:, k], ddof=1)),
        }
        for k in range(columns)
    ]
