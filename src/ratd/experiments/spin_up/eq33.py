"""Eq. 33, the paper's law for omega of disruption: its fit to the grains, beside the printed Table 3."""

import hashlib

import numpy as np
import pandas as pd
import xarray as xr

from ratd.base.checks import check_seed, is_dust, is_number, is_whole, not_dust
from ratd.base.errors import InputError
from ratd.base.materials import Material, get_material
from ratd.base.statistics import equal_weights, weighted_line
from ratd.experiments.spin_up.cells import as_frame, size_key, sort_cells
from ratd.experiments.spin_up.printed import PAPER_MEAN_RADIUS, TABLE_3, TABLE_3_SOURCE

__all__ = [
    "eq33",
    "eq33_omega",
    "fit_as_configured",
    "fit_ensemble",
    "fitted_numbers",
    "radius_of_reading",
    "table3",
    "table3_dataset",
]


def eq33(a_eff, surface_energy, density, mean_monomer_radius, n_contacts, filling_factor, A, alpha):
    """Angular velocity of disruption of a polydisperse aggregate, omega = A/a_eff sqrt(gamma/(rho a)) (N phi)^alpha.

    Parameters
    ----------
    a_eff : array_like
        Effective radius [m].
    surface_energy : array_like
        gamma [J m-2].
    density : array_like
        Density rho of the monomers [kg m-3].
    mean_monomer_radius : array_like
        <a_mon> [m].
    n_contacts : array_like
        Number N of contacts of the grain as grown.
    filling_factor : array_like
        Volume filling factor phi of the grain as grown.
    A, alpha : array_like
        Fit parameters.

    Returns
    -------
    numpy.ndarray or float
        omega_disr [rad s-1], shape by broadcasting.

    References
    ----------
    Reissl et al. (2024), A&A 692, A60, Eq. 33, in the form of its footnote, <N_con> N_mon phi = N_con phi.
    """
    scale = np.sqrt(surface_energy / (density * np.asarray(mean_monomer_radius))) / np.asarray(a_eff)
    return A * scale * (np.asarray(n_contacts) * np.asarray(filling_factor)) ** alpha


def eq33_omega(table, numbers, mean_radius, materials=None):
    """omega of Eq. 33 for each grain, with the A and alpha of its material and type.

    Parameters
    ----------
    table : pandas.DataFrame
        One row a grain.
    numbers : dict
        (material, type) -> (A, alpha).
    mean_radius : float or None
        <a_mon> [m], None for the mean radius of each grain's own monomers, as of `eq33.radius_of_reading`.
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


def fit_ensemble(
    table,
    mean_monomer_radius=(PAPER_MEAN_RADIUS, "own"),
    *,
    mark="omega_disr",
    n_bootstrap=2000,
    confidence=0.95,
    seed=0,
    materials=None,
):
    """Fit Eq. 33 to the grains of each (material, type).

    ln(omega a_eff sqrt(rho <a_mon>/gamma)) = ln A + alpha ln(N_con phi) is solved by least squares over the grains.
    All sizes count alike, as in the paper, where each has 30 grains: a law that does not hold exactly would else depend
    on how many grains of each size there happen to be. The confidence intervals are percentiles of a bootstrap that
    draws grains anew from all sizes, so that a size with a single grain counts as uncertain, too.

    Parameters
    ----------
    table : pandas.DataFrame or xarray.Dataset
        One row a grain with material, type, a_eff, n_contacts, filling_factor (or porosity), mean_monomer_radius (for
        "own") and the mark. Rows in which one of them is NaN or not above zero are left out.
    mean_monomer_radius : float or "own", or a sequence of them
        <a_mon> [m] in Eq. 33, or "own" for the mean radius of each grain's own monomers.
    mark : str
        The column that is fitted [rad s-1].
    n_bootstrap : int
        Replicates, at least 1.
    confidence : float
        Probability inside the intervals.
    seed : int
        Seed of the bootstrap. Each (material, type) has random numbers of its own, so that a further one in the
        table changes no other.
    materials : optional
        Table of materials, handed to `ratd.base.materials.get_material`.

    Returns
    -------
    xarray.Dataset
        Over (mean_radius, material, type), mean_radius being "20 nm" or "own": A, A_low, A_high, alpha, alpha_low,
        alpha_high, scatter (standard deviation of the residuals of ln omega); over (material, type): n_grains,
        n_sizes. A fit needs three grains of two sizes at least; where it is not possible it is NaN and the attribute
        `missing_fits` says why.

    Raises
    ------
    InputError
        If a column is missing, the table is empty or mixes drives, or an argument is out of range.
    """
    if not (is_whole(n_bootstrap) and n_bootstrap >= 1 and is_number(confidence) and 0 < confidence < 1):
        raise InputError("fit_ensemble: n_bootstrap must be 1 or more, a whole number, and confidence between 0 and 1")
    check_seed(seed)
    readings = _readings(mean_monomer_radius)
    table, drive = _fitted_rows(table, readings, mark)
    kinds = sort_cells(table[["material", "type"]].drop_duplicates())
    materials_here, types_here = (list(dict.fromkeys(kinds[name])) for name in ("material", "type"))
    shape = len(readings), len(materials_here), len(types_here)
    result = {name: np.full(shape, np.nan) for name in _FIT_MEANING}
    n_grains, n_sizes = np.zeros(shape[1:], np.int32), np.zeros(shape[1:], np.int32)
    missing = []
    for i, name in enumerate(materials_here):
        material = get_material(name, materials)
        for j, kind in enumerate(types_here):
            rows = table[table["usable"] & (table["material"] == name) & (table["type"] == kind)]
            n_grains[i, j], n_sizes[i, j] = len(rows), size_key(rows["a_eff"]).nunique()
            if len(rows) < 3 or n_sizes[i, j] < 2 or np.ptp(_abscissa(rows)) == 0:
                missing.append(f"{name} {kind}: {len(rows)} usable grains of {n_sizes[i, j]} sizes")
                continue
            drawn = _generator(seed, name, kind).integers(len(rows), size=(n_bootstrap, len(rows)))
            for k, reading in enumerate(readings.values()):
                for key, value in _fit_one(rows, mark, material, reading, drawn, confidence).items():
                    result[key][k, i, j] = value
    attrs = {"drive": drive, "mark": mark, "equation": _EQUATION, "n_bootstrap": n_bootstrap, "confidence": confidence}
    attrs |= {"bootstrap_seed": seed, "missing_fits": "; ".join(missing)}
    variables = {name: (values, _FIT_MEANING[name]) for name, values in result.items()}
    variables |= {"n_grains": (n_grains, "grains in the fit"), "n_sizes": (n_sizes, "sizes in the fit")}
    dims = "mean_radius", "material", "type"
    return xr.Dataset(
        # the counts are the same for every reading of the mean radius
        {name: (dims[-v.ndim :], v, {"units": "1", "long_name": words}) for name, (v, words) in variables.items()},
        coords={
            "mean_radius": ("mean_radius", list(readings), {"long_name": "<a_mon> in Eq. 33"}),
            "material": ("material", materials_here, {"long_name": "material"}),
            "type": ("type", types_here, {"long_name": "growth"}),
        },
        attrs=attrs,
    )


_EQUATION = "omega = A/a_eff sqrt(gamma/(rho <a_mon>)) (N_con phi)^alpha, Reissl et al. (2024), Eq. 33"
_FIT_MEANING = {
    "A": "fit parameter A of Eq. 33",
    "A_low": "lower end of the confidence interval of A",
    "A_high": "upper end of the confidence interval of A",
    "alpha": "fit parameter alpha of Eq. 33",
    "alpha_low": "lower end of the confidence interval of alpha",
    "alpha_high": "upper end of the confidence interval of alpha",
    "scatter": "standard deviation of the residuals of ln omega",
}


def _fitted_rows(table, readings, mark):
    """The table in an order of its own, with a column `usable`, and its drive."""
    if not isinstance(table, pd.DataFrame | xr.Dataset):
        raise InputError(f"fit_ensemble: the table is a {type(table).__name__}; it must be a table of grains")
    table = as_frame(table, "fit_ensemble", ("material", "type", "a_eff", "n_contacts", mark))
    if len(table) == 0:
        raise InputError("fit_ensemble: the table has no rows")
    if "filling_factor" not in table:
        if "porosity" not in table:
            raise InputError("fit_ensemble: the table has neither a column 'filling_factor' nor 'porosity'")
        table = table.assign(filling_factor=1 - table["porosity"])
    needed = ["a_eff", "n_contacts", "filling_factor", mark]
    if "own" in readings.values():
        if "mean_monomer_radius" not in table:
            raise InputError("fit_ensemble: the table has no column 'mean_monomer_radius', needed for \"own\"")
        needed.append("mean_monomer_radius")
    try:
        numbers = table[needed].astype(float)
    except (TypeError, ValueError) as error:
        raise InputError(f"fit_ensemble: the columns {', '.join(needed)} must hold numbers ({error})") from None
    if "own" in readings.values() and not (numbers["mean_monomer_radius"] > 0).any():
        raise InputError(
            "fit_ensemble: no row has a 'mean_monomer_radius', needed for \"own\"; give mean_monomer_radius=20e-9 "
            "[m], or a table that tells of the grains as grown"
        )
    for name in needed:
        if name in ("a_eff", "mean_monomer_radius"):
            _check_size(numbers[name].to_numpy(), f"the column {name!r}")
    usable = ((numbers > 0) & np.isfinite(numbers)).all(axis=1)
    # random draws must not depend on the order of the rows; those that are not used may have no size to sort by
    return sort_cells(table.assign(a_eff=numbers["a_eff"].where(usable, 0.0), usable=usable)), _one_drive(table)


def _check_size(radius, what):
    """Raise InputError for radii [m] that no dust has, as those in nm."""
    radius = radius[(radius > 0) & np.isfinite(radius)]
    if radius.size and not is_dust(radius):
        raise InputError(f"fit_ensemble: {what} is not in m, it seems: {not_dust(radius)}")


def _abscissa(rows):
    """ln(N_con phi) of grains, (n,)."""
    return np.log(rows["n_contacts"].to_numpy(float) * rows["filling_factor"].to_numpy(float))


def _fit_one(rows, mark, material, reading, drawn, confidence):
    """Name of `_FIT_MEANING` -> value, for the grains of one material and type; `drawn` (replicates, n) says which."""
    radius = rows["mean_monomer_radius"].to_numpy(float) if reading == "own" else reading
    unit = eq33(rows["a_eff"].to_numpy(float), material.surface_energy, material.density, radius, 1, 1, 1, 0)
    x, y = _abscissa(rows), np.log(rows[mark].to_numpy(float) / unit)
    weights = equal_weights(size_key(rows["a_eff"]).to_numpy())
    alpha, log_a = weighted_line(x, y, weights)
    residual = y - log_a - alpha * x
    alphas, log_as = weighted_line(x[drawn], y[drawn], weights[drawn])
    ends = [(1 - confidence) / 2, (1 + confidence) / 2]
    found = {"A": np.exp(log_a), "alpha": alpha, "scatter": np.sqrt(np.sum(weights * residual**2) / (len(y) - 2))}
    found |= zip(("A_low", "A_high"), np.exp(np.nanquantile(log_as, ends)), strict=True)
    found |= zip(("alpha_low", "alpha_high"), np.nanquantile(alphas, ends), strict=True)
    return found


def fit_as_configured(table, settings):
    """Fit Eq. 33 as a config says.

    Parameters
    ----------
    table : pandas.DataFrame or xarray.Dataset
        See `fit_ensemble`.
    settings : dict
        From `ratd.experiments.spin_up.settings.Settings.ensemble`.

    Returns
    -------
    xarray.Dataset
        See `fit_ensemble`.
    """
    return fit_ensemble(
        table,
        settings["mean_monomer_radius"],
        n_bootstrap=settings["bootstrap"],
        confidence=settings["confidence"],
        seed=settings["seed"],
        materials={name: Material(**constants) for name, constants in settings["materials"].items()},
    )


def fitted_numbers(fit, reading):
    """A and alpha of a fit (`eq33.fit_ensemble`) for one reading of <a_mon>, for `eq33_omega`."""
    best = fit.sel(mean_radius=reading)
    return {
        (material, kind): (best["A"].sel(material=material, type=kind).item(),
                           best["alpha"].sel(material=material, type=kind).item())
        for material in fit["material"].values.tolist() for kind in fit["type"].values.tolist()
    }  # fmt: skip


def table3_dataset(fit):
    """Put the printed values of Table 3 beside a fit.

    Parameters
    ----------
    fit : xarray.Dataset
        What `fit_ensemble` returns.

    Returns
    -------
    xarray.Dataset
        The fit with `A_printed` and `alpha_printed` over (material, type), NaN for what the paper does not have.
    """
    names = [[(m, t) for t in fit["type"].values] for m in fit["material"].values]
    printed = np.array([[TABLE_3.get(name, (np.nan, np.nan)) for name in row] for row in names], dtype=float)
    result = fit.copy()
    for k, name in enumerate(("A", "alpha")):
        attrs = {"units": "1", "long_name": f"{name} as printed", "source": TABLE_3_SOURCE}
        result[f"{name}_printed"] = (("material", "type"), printed[..., k], attrs)
    return result


def table3(fit):
    """The fit and the printed Table 3 as one table, a row for each reading of <a_mon>, material and type.

    Parameters
    ----------
    fit : xarray.Dataset
        What `fit_ensemble` returns.

    Returns
    -------
    pandas.DataFrame
        Columns mean_radius, material, type, A, A_low, A_high, A_printed, alpha, alpha_low, alpha_high, alpha_printed,
        scatter, n_grains, n_sizes, drive.
    """
    table = table3_dataset(fit).to_dataframe(dim_order=["mean_radius", "material", "type"]).reset_index()
    table["drive"] = fit.attrs["drive"]
    order = ["mean_radius", "material", "type", "A", "A_low", "A_high", "A_printed"]
    order += ["alpha", "alpha_low", "alpha_high", "alpha_printed", "scatter", "n_grains", "n_sizes", "drive"]
    return table[order]


def _one_drive(table):
    """The one drive of a table, an empty string if it does not say."""
    drives = sorted({str(value) for value in table.get("drive", ()) if pd.notna(value) and value != ""})
    if len(drives) > 1:
        raise InputError(f"fit_ensemble: the table mixes the drives {', '.join(drives)}; fit one at a time")
    return drives[0] if drives else ""


def _readings(mean_monomer_radius):
    """Label -> value of each reading of <a_mon>."""
    given = mean_monomer_radius
    if isinstance(given, str) or np.ndim(given) == 0:
        given = [given]
    if len(given) == 0:
        raise InputError("fit_ensemble: mean_monomer_radius is empty; give a radius in m, or 'own'")
    readings = {}
    for value in given:
        if isinstance(value, str):
            if value != "own":
                raise InputError(f"fit_ensemble: mean_monomer_radius is '{value}', allowed are a radius in m and 'own'")
            readings["own"] = "own"
        elif is_number(value) and value > 0:
            _check_size(np.array([value]), "mean_monomer_radius")
            readings[f"{value * 1e9:g} nm"] = float(value)
        else:
            raise InputError(f"fit_ensemble: mean_monomer_radius is {value}, but must be above zero, in m")
    return readings


def radius_of_reading(reading):
    """Value of a label of the dimension mean_radius of a fit.

    Parameters
    ----------
    reading : str
        Such as "20 nm", or "own".

    Returns
    -------
    float or None
        <a_mon> [m], None for "own".
    """
    return None if reading == "own" else float(str(reading).removesuffix(" nm")) * 1e-9


def _generator(seed, material, kind):
    """Random numbers of one (material, type)."""
    key = int.from_bytes(hashlib.sha256(f"{material}/{kind}".encode()).digest()[:8], "little")
    return np.random.Generator(np.random.PCG64(np.random.SeedSequence([seed, key])))
