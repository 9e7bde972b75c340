"""What the paper leaves open, asked of the table of all grains and of the fragments.

Every function takes the table of one drive (`ratd.experiments.spin_up.ensemble.grain_table`) and returns plain tables with errors.
"""

import math
from statistics import NormalDist

import numpy as np
import pandas as pd

from ratd.base.errors import InputError
from ratd.base.materials import get_material
from ratd.base.statistics import drawn_counts, equal_weights, mean_of, slope_error, slope_of
from ratd.experiments.spin_up.ensemble import cell_of, eq33, size_key

SPLIT = 300e-9
"""Size [m] from which on omega_disr flattens in the paper (Sect. 8)."""
N_BOOTSTRAP = 1000
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


def eq33_omega(table, numbers, mean_radius, materials=None):
    """omega of Eq. 33 for each grain, with the A and alpha of its material and type.

    Parameters
    ----------
    table : pandas.DataFrame
        One row a grain.
    numbers : dict
        (material, type) -> (A, alpha).
    mean_radius : float or None
        <a_mon> [m], None for the mean radius of each grain's own monomers, as of `ratd.experiments.spin_up.ensemble.radius_of_reading`.
    materials : optional
        Table of materials, handed to `ratd.base.materials.get_material`.

    Returns
    -------
    pandas.Series
        omega [rad s-1], NaN where there are no numbers.
    """
    result = pd.Series(np.nan, index=table.index)
    for cell, rows in table.groupby(["material", "type"]):
        if cell not in numbers:
            continue
        material = get_material(cell[0], materials)
        radius = rows["mean_monomer_radius"] if mean_radius is None else mean_radius
        scale = rows["a_eff"], material.surface_energy, material.density, radius
        result[rows.index] = eq33(*scale, rows["n_contacts"], rows["filling_factor"], *numbers[cell])
    return result


def fitted_numbers(fit, reading):
    """A and alpha of a fit (`ratd.experiments.spin_up.ensemble.fit_ensemble`) for one reading of <a_mon>, for `eq33_omega`."""
    best = fit.sel(mean_radius=reading)
    return {
        (material, kind): (best["A"].sel(material=material, type=kind).item(),
                           best["alpha"].sel(material=material, type=kind).item())
        for material in fit["material"].values.tolist() for kind in fit["type"].values.tolist()
    }  # fmt: skip


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
    of them it is fitted to. Each material and type has a fit of its own, as `ratd.experiments.spin_up.ensemble.fit_ensemble` makes it, of
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
            level, power = _line(x[own], y[own], equal_weights(grains.cell[own]))
            predicted[rows] = level + power * x[rows] + np.log(grains.unit[rows])
    return predicted


def _line(x, y, weights):
    """Level at x = 0 and slope of straight lines by least squares; `weights` has the shape (n,) or (lines, n)."""
    whole = weights.sum(axis=-1)
    mean_x, mean_y = weights @ x / whole, weights @ y / whole
    slope = (weights @ (x * y) / whole - mean_x * mean_y) / (weights @ (x * x) / whole - mean_x**2)
    return mean_y - slope * mean_x, slope


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


def size_law_unit(table, materials=None):
    """sqrt(gamma/(rho a^3)) with a = `SPLIT` [rad s-1], the unit of omega of `size_law`, of each grain of a table."""
    unit = {}
    for name in table["material"].unique():
        material = get_material(name, materials)
        unit[name] = math.sqrt(material.surface_energy / (material.density * SPLIT**3))
    return table["material"].map(unit).to_numpy(float)


def size_law(table, mark="omega_disr", materials=None, seed=0):
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
    materials : optional
        Table of materials, handed to `ratd.base.materials.get_material`.
    seed : int
        Of the bootstrap over grains.

    Returns
    -------
    pandas.DataFrame
        A row a type of at least two sizes: C, p with `_error`; scatter, the root mean square of the residuals of
        ln omega; n_grains.
    """
    table = table[table[mark].astype(float) > 0]
    rng = np.random.Generator(np.random.PCG64(seed))
    rows = []
    for kind, part in table.groupby("type", sort=False):
        if size_key(part["a_eff"]).nunique() < 2:
            continue
        x = np.log(part["a_eff"].to_numpy(float) / SPLIT)
        y = np.log(part[mark].to_numpy(float) / size_law_unit(part, materials))
        weights = equal_weights(cell_of(part))
        level, slope = _line(x, y, weights)
        levels, drawn_slopes = _line(x, y, drawn_counts(rng, N_BOOTSTRAP, len(x)) * weights)
        rows.append(
            {
                "type": kind,
                "C": float(np.exp(level)),
                "C_error": float(np.std(np.exp(levels), ddof=1)),
                "p": float(-slope),
                "p_error": float(np.std(drawn_slopes, ddof=1)),
                "scatter": float(np.sqrt(np.average((y - level - slope * x) ** 2, weights=weights))),
                "n_grains": len(part),
            }
        )
    return pd.DataFrame(rows)


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
        A row a type: below, above, change (above - below) with `_error` (`ratd.base.statistics.slope_error`, NaN where a
        side has too few grains for one); sizes_below, sizes_above, n_grains. Materials are taken together, each with a
        level of its own, and all cells of a side count alike. NaN where a side has fewer than two sizes.
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


def binomial_interval(k, n, confidence=0.95):
    """Wilson's interval of a probability, k of n.

    Parameters
    ----------
    k, n : int
    confidence : float

    Returns
    -------
    tuple of float
        Low and high; NaN for n = 0.
    """
    if n == 0:
        return math.nan, math.nan
    z = NormalDist().inv_cdf(0.5 + confidence / 2)
    p = k / n
    centre = (p + z * z / (2 * n)) / (1 + z * z / n)
    half = z / (1 + z * z / n) * math.sqrt(p * (1 - p) / n + z * z / (4 * n * n))
    # exact at both ends, where the difference is left with rounding
    return 0.0 if k == 0 else centre - half, 1.0 if k == n else centre + half


def is_oblate(a, b, c):
    """Whether ellipsoids of semi-axes a < b < c are oblate, b/a > c/b; False where an axis is not known."""
    return np.square(b) > np.multiply(a, c)


def oblate_share(table, when):
    """Share of oblate grains, all cells counting alike.

    Parameters
    ----------
    table : pandas.DataFrame
        One row a grain, of one drive.
    when : {"start", "disr"}
        At rest, or the largest fragment at omega_disr.

    Returns
    -------
    share, error : float
        See `ratd.base.statistics.mean_of`; NaN where no shape is known.
    n_oblate, n : int
        Oblate grains, and those whose shape is known.
    """
    known, oblate = _shapes(table, when)
    return *mean_of(oblate[known], cell_of(table[known])), int(oblate.sum()), int(known.sum())


def _shapes(table, when):
    """Whether the shape of each grain is known, and whether it is oblate."""
    axes = [table[f"axis_{axis}_{when}"].to_numpy(float) for axis in "abc"]
    known = np.isfinite(axes).all(axis=0) & (axes[0] > 0)
    return known, known & is_oblate(*axes)


def oblate_counts(table, by=("type",), confidence=0.95):
    """Oblate grains (b/a > c/b) at rest and at disruption.

    Parameters
    ----------
    table : pandas.DataFrame
        One row a grain, of one drive.
    by : sequence of str
        Columns that make a row.
    confidence : float
        Of the intervals.

    Returns
    -------
    pandas.DataFrame
        The columns of `by`; for `start` and `disr`: NAME_oblate, NAME_known (grains with a shape), NAME_low, NAME_high.
    """
    rows = []
    for keys, part in table.groupby(list(by), sort=False):
        row = dict(zip(by, keys, strict=True))
        for when in ("start", "disr"):
            n, k = (int(np.sum(chosen)) for chosen in _shapes(part, when))
            low, high = binomial_interval(k, n, confidence)
            row |= {f"{when}_oblate": k, f"{when}_known": n, f"{when}_low": low, f"{when}_high": high}
        rows.append(row)
    return pd.DataFrame(rows)


MONOMER_BINS = (1, 2, 4, 11, np.inf)
"""Edges of classes of fragments by number of monomers: 1, 2-3, 4-10, 11 and more."""
MONOMER_CLASSES = ("1 monomer", "2–3", "4–10", "more than 10")


def fragment_shares(fragments, stage, seed=0):
    """Shares of fragments of different size in the mass and the number of those that left.

    Parameters
    ----------
    fragments : pandas.DataFrame
        From `ratd.experiments.spin_up.fragmentation.fragment_table`.
    stage : str
        One of `ratd.experiments.spin_up.fragmentation.STAGES`.
    seed : int
        Of the bootstrap over grains.

    Returns
    -------
    pandas.DataFrame
        A row a type and class: mass_share and number_share with `_error`, NaN for one grain; n_fragments, n_grains
        (that lost any). Each fragment has the weight of its grain.
    """
    rng = np.random.Generator(np.random.PCG64(seed))
    rows = []
    chosen = fragments[fragments[stage]]
    for kind, part in chosen.groupby("type"):
        which = np.digitize(part["fragment_n_monomers"], MONOMER_BINS) - 1
        grain = pd.factorize(part["grain"])[0]
        n = grain.max() + 1
        mass, number = np.zeros((n, len(MONOMER_CLASSES))), np.zeros((n, len(MONOMER_CLASSES)))
        np.add.at(mass, (grain, which), part["weight"] * part["mass_fraction"])
        np.add.at(number, (grain, which), part["weight"])
        drawn = rng.integers(n, size=(N_BOOTSTRAP, n))
        shares = {}
        for name, values in (("mass_share", mass), ("number_share", number)):
            total = values[drawn].sum(axis=1)
            error = np.std(total / total.sum(axis=1, keepdims=True), axis=0, ddof=1)
            shares[name] = values.sum(axis=0) / values.sum()
            shares[f"{name}_error"] = error if n > 1 else np.full_like(error, np.nan)
        for k, label in enumerate(MONOMER_CLASSES):
            own = {name: float(values[k]) for name, values in shares.items()}
            rows.append({"type": kind, "class": label, **own, "n_fragments": len(part), "n_grains": int(n)})
    return pd.DataFrame(rows)


def power_law(sizes, largest, seed=0, replicates=200):
    """Power law p(n) ~ n^-s of the monomers of fragments, n from 1 to the largest possible, and whether it fits.

    Parameters
    ----------
    sizes : array_like of int
        Monomers of each fragment.
    largest : int
        Greatest possible number.
    seed : int
    replicates : int
        Made-up samples of the fitted law, for the probability.

    Returns
    -------
    dict
        exponent (greatest likelihood) and its error; distance (Kolmogorov and Smirnov); probability that a sample of
        the law lies as far from its own fit, low where the law is not justified; n. NaN for fewer than 10 fragments.

    References
    ----------
    Clauset, Shalizi & Newman (2009), SIAM Review 51, 661.
    """
    sizes = np.asarray(sizes, dtype=np.int64)
    if len(sizes) < 10 or len(np.unique(sizes)) < 2:
        return {"exponent": np.nan, "error": np.nan, "distance": np.nan, "probability": np.nan, "n": len(sizes)}
    n = np.arange(1, int(max(largest, sizes.max())) + 1)
    counts = np.bincount(sizes, minlength=len(n) + 1)[1:]
    exponent, distance, law = _fit_power_law(counts, n)
    spread = np.sum(law * np.log(n) ** 2) - np.sum(law * np.log(n)) ** 2
    rng = np.random.Generator(np.random.PCG64(seed))
    made = [_fit_power_law(rng.multinomial(len(sizes), law), n)[1] for _ in range(replicates)]
    return {
        "exponent": exponent,
        "error": 1.0 / math.sqrt(spread * len(sizes)),
        "distance": distance,
        "probability": float(np.mean(np.array(made) >= distance)),
        "n": len(sizes),
    }


def _fit_power_law(counts, n):
    """Exponent of greatest likelihood, distance, probabilities.

    The condition is that the mean of ln n be that of the sample. It falls with the exponent, its derivative is the
    variance: Newton's steps, with bisection where one leaves the bracket.
    """
    share, log_n = counts / counts.sum(), np.log(n)
    wanted = share @ log_n
    low, high = -5.0, 15.0
    exponent, step = 1.5, np.inf
    while abs(step) > 1e-12 and high - low > 1e-12:
        law = np.exp(-exponent * log_n)
        law /= law.sum()
        mean = law @ log_n
        low, high = (exponent, high) if mean > wanted else (low, exponent)
        step = (mean - wanted) / (law @ (log_n - mean) ** 2)
        exponent = exponent + step if low < exponent + step < high else 0.5 * (low + high)
    return exponent, float(np.max(np.abs(np.cumsum(share) - np.cumsum(law)))), law
