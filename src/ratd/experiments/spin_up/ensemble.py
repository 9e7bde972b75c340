"""The ensemble of grains: one table of all grains, statistics per cell, the fit of Eq. 33 beside the printed Table 3.

A cell is one (material, type, size). Sizes are told apart to the picometre: 2e-7 and 200 * 1e-9 are the same size.
"""

import hashlib
from collections.abc import Mapping

import numpy as np
import pandas as pd
import xarray as xr

from ratd.aggregates.grain import Grain
from ratd.base.errors import InputError
from ratd.base.materials import Material, get_material
from ratd.base.statistics import equal_weights
from ratd.experiments.spin_up.marks import VARIABLES as MARK_COLUMNS
from ratd.experiments.spin_up.printed import PAPER_MEAN_RADIUS, TABLE_3, TABLE_3_SOURCE

KEYS = ("material", "type", "a_eff", "seed")
"""The columns that together name one grain."""

GRAIN_COLUMNS = {
    "material": ("", "material of the monomers"),
    "type": ("", "growth: BA, BAM1 or BAM2"),
    "a_eff": ("m", "effective radius (Eq. 2)"),
    "seed": ("1", "random seed"),
    "n_monomers": ("1", "number of monomers"),
    "n_contacts": ("1", "number of contacts"),
    "porosity": ("1", "porosity (Eq. 7)"),
    "filling_factor": ("1", "volume filling factor phi = 1 - porosity"),
    "mean_monomer_radius": ("m", "mean monomer radius <a_mon>"),
    "fractal_dimension": ("1", "fractal dimension (Eq. 8)"),
    "fractal_dimension_error": ("1", "standard error of the fractal dimension"),
    "enclosing_radius": ("m", "radius of the smallest enclosing sphere"),
    "axis_a": ("m", "shortest semi-axis as grown (Eq. 4)"),
    "axis_b": ("m", "middle semi-axis as grown (Eq. 5)"),
    "axis_c": ("m", "longest semi-axis as grown (Eq. 6)"),
    "cut_bound": ("rad s-1", "angular velocity at which the weakest cut through the contacts gives way"),
    "spin_share": ("1", "share of the monomers' own moments of inertia in I_1"),
}
"""Units and meaning of what is known before the spin-up."""
RUN_COLUMNS = {
    "drive": ("", "what turns the grain: prescribed or literal"),
    "steps": ("1", "time steps of the spin-up"),
    "timestep": ("s", "first time step of the spin-up"),
    "end_reason": ("", "why the spin-up ended"),
    "missing_marks": ("", "marks that the run does not contain, with the reason"),
}
"""Units and meaning of what is taken from the attributes of a run."""
COLUMNS = {**GRAIN_COLUMNS, **RUN_COLUMNS, **MARK_COLUMNS}
"""Units and meaning of every column of the grain table, in order."""

_TEXT = ("material", "type", "drive", "end_reason", "missing_marks")
# What a run knows about its grain at rest, used when the grown grain itself is not at hand.
_FROM_RUN = {
    "n_monomers": "initial_n_monomers",
    "n_contacts": "initial_n_contacts",
    "porosity": "initial_porosity",
    "axis_a": "initial_axis_a",
    "axis_b": "initial_axis_b",
    "axis_c": "initial_axis_c",
}


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


def spin_share(radius, density, moment_1):
    """Share of the monomers' own moments of inertia in that of the whole, I_spin/(I_orbit + I_spin).

    Parameters
    ----------
    radius : array_like, shape (n,)
        Radii of the monomers [m].
    density : float
        [kg m-3].
    moment_1 : float
        Greatest moment of inertia I_1 of the grain, that of the monomers included [kg m2].

    Returns
    -------
    float
        sum(2/5 m_i a_i^2)/I_1 (docs/model.md, The two drives).
    """
    return float(np.sum(8.0 / 15.0 * np.pi * density * np.asarray(radius) ** 5) / moment_1)


def grain_table(grains=None, marks=None):
    """One row a grain: how it was grown, and how it was disrupted.

    Parameters
    ----------
    grains : optional
        The grown grains: `ratd.Grain` objects, or mappings or Datasets (one each, of which scalars, attributes and
        the `radius` of the monomers count), or a DataFrame, or a Dataset over one dimension, with the columns of
        `GRAIN_COLUMNS`. What is not there becomes NaN.
    marks : optional
        What `ratd.disruption` returned for them, in any of the forms above.

    Returns
    -------
    pandas.DataFrame
        The columns of `COLUMNS`, sorted by material, type, size and seed, whatever the order of the input. A grain
        without marks keeps its row. Without `grains` the values of the relaxed grain at rest stand in.

    Raises
    ------
    InputError
        If there is nothing to tabulate, a column of `KEYS` is missing, two rows name the same grain, or a mark has
        no grain.
    """
    if grains is None and marks is None:
        raise InputError("grain_table: give grains, marks or both")
    left = None if grains is None else _keyed(_frame(grains, "grains"), "grains")
    right = None if marks is None else _keyed(_frame(marks, "marks"), "marks")
    if right is not None:
        for name, source in _FROM_RUN.items():
            if left is None and source in right:
                right[name] = right[source]
    if left is None:
        table = right
    elif right is None:
        table = left
    else:
        stray = right.index.difference(left.index)
        if len(stray):
            material, kind, picometres, seed = stray[0]
            raise InputError(
                f"grain_table: {material} {kind} {picometres / 1e3:g} nm seed {seed} has marks but no grain"
            )
        # A run repeats the names of its grain; the grown grain is the one that counts.
        table = left.join(right.drop(columns=[name for name in right if name in left]), how="left")
    if "filling_factor" not in table and "porosity" in table:
        table["filling_factor"] = 1 - table["porosity"]
    table = table.reset_index(drop=True).reindex(columns=list(COLUMNS))
    for name in COLUMNS:
        if name in _TEXT:
            table[name] = table[name].astype(object).where(table[name].notna(), "")
        elif name != "seed":
            table[name] = table[name].astype(float)
    return sort_cells(table)


def cell_statistics(table, by=("material", "type", "a_eff")):
    """Mean, minimum, maximum and count of every number in each cell.

    Parameters
    ----------
    table : pandas.DataFrame or xarray.Dataset
        One row a grain, see `grain_table`.
    by : sequence of str
        The columns that make a cell; ("type", "a_eff") pools the materials, as in Fig. 2 of the paper.

    Returns
    -------
    pandas.DataFrame
        One row a cell: the columns of `by`, `n_grains`, and for each number NAME the columns `NAME_mean`,
        `NAME_minimum`, `NAME_maximum` (NaN left out) and `NAME_count` (grains for which it is not NaN).

    Raises
    ------
    InputError
        If a column of `by` is missing.
    """
    table = _as_frame(table, "cell_statistics", by)
    numbers = [name for name in table.select_dtypes("number") if name not in (*by, "seed")]
    keys = [size_key(table[name]).rename(name) if name == "a_eff" else table[name] for name in by]
    groups = table.groupby(keys, sort=False, dropna=False)
    parts = {name: groups[name].first() for name in by}
    parts["n_grains"] = groups.size()
    for name in numbers:
        column = groups[name]
        parts[f"{name}_mean"] = column.mean()
        parts[f"{name}_minimum"] = column.min()
        parts[f"{name}_maximum"] = column.max()
        parts[f"{name}_count"] = column.count()
    return sort_cells(pd.DataFrame({name: part.to_numpy() for name, part in parts.items()}))


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
    table = _as_frame(table, "fit_ensemble", ("material", "type", "a_eff", "n_contacts", mark))
    if len(table) == 0:
        raise InputError("fit_ensemble: the table has no rows")
    drive = _one_drive(table)
    if n_bootstrap < 1 or not 0 < confidence < 1:
        raise InputError("fit_ensemble: n_bootstrap must be 1 or more, and confidence between 0 and 1")
    if "filling_factor" not in table:
        if "porosity" not in table:
            raise InputError("fit_ensemble: the table has neither a column 'filling_factor' nor 'porosity'")
        table = table.assign(filling_factor=1 - table["porosity"])
    readings = _readings(mean_monomer_radius)
    if "own" in readings.values() and "mean_monomer_radius" not in table:
        raise InputError("fit_ensemble: the table has no column 'mean_monomer_radius', needed for \"own\"")

    sizes = ["material", "type"]
    kinds = sort_cells(table[sizes].drop_duplicates())
    materials_here, types_here = list(dict.fromkeys(kinds["material"])), list(dict.fromkeys(kinds["type"]))
    shape = (len(readings), len(materials_here), len(types_here))
    result = {
        name: np.full(shape, np.nan) for name in ("A", "A_low", "A_high", "alpha", "alpha_low", "alpha_high", "scatter")
    }
    n_grains, n_sizes = np.zeros(shape[1:], np.int32), np.zeros(shape[1:], np.int32)
    missing = []
    quantile = [(1 - confidence) / 2, (1 + confidence) / 2]

    table = sort_cells(table)  # random draws must not depend on the order of the rows
    needed = ["a_eff", "n_contacts", "filling_factor", mark]
    if "own" in readings.values():
        needed.append("mean_monomer_radius")
    usable = (table[needed].astype(float) > 0).all(axis=1) & np.isfinite(table[needed].astype(float)).all(axis=1)
    for i, material_name in enumerate(materials_here):
        material = get_material(material_name, materials)
        for j, kind in enumerate(types_here):
            rows = table[usable & (table["material"] == material_name) & (table["type"] == kind)]
            size = size_key(rows["a_eff"]).to_numpy()
            n_grains[i, j], n_sizes[i, j] = len(rows), len(np.unique(size))
            x = np.log(rows["n_contacts"].to_numpy(float) * rows["filling_factor"].to_numpy(float))
            if len(rows) < 3 or n_sizes[i, j] < 2 or np.ptp(x) == 0:
                missing.append(f"{material_name} {kind}: {len(rows)} usable grains of {n_sizes[i, j]} sizes")
                continue
            weights = equal_weights(size)
            generator = _generator(seed, material_name, kind)
            drawn = generator.integers(len(rows), size=(n_bootstrap, len(rows)))
            for k, reading in enumerate(readings.values()):
                radius = rows["mean_monomer_radius"].to_numpy(float) if reading == "own" else reading
                unit = eq33(
                    rows["a_eff"].to_numpy(float), material.surface_energy, material.density, radius, 1, 1, 1, 0
                )
                y = np.log(rows[mark].to_numpy(float) / unit)
                alpha, log_a = _line(x, y, weights)
                result["A"][k, i, j], result["alpha"][k, i, j] = np.exp(log_a), alpha
                residual = y - log_a - alpha * x
                result["scatter"][k, i, j] = np.sqrt(np.sum(weights * residual**2) / (len(y) - 2))
                alphas, log_as = _line(x[drawn], y[drawn], weights[drawn])
                result["A_low"][k, i, j], result["A_high"][k, i, j] = np.exp(np.nanquantile(log_as, quantile))
                result["alpha_low"][k, i, j], result["alpha_high"][k, i, j] = np.nanquantile(alphas, quantile)

    fit = xr.Dataset(
        coords={
            "mean_radius": ("mean_radius", list(readings), {"long_name": "<a_mon> in Eq. 33"}),
            "material": ("material", materials_here, {"long_name": "material"}),
            "type": ("type", types_here, {"long_name": "growth"}),
        },
        attrs={
            "drive": drive,
            "mark": mark,
            "equation": "omega = A/a_eff sqrt(gamma/(rho <a_mon>)) (N_con phi)^alpha, Reissl et al. (2024), Eq. 33",
            "n_bootstrap": n_bootstrap,
            "confidence": confidence,
            "bootstrap_seed": seed,
            "missing_fits": "; ".join(missing),
        },
    )
    for name, values in result.items():
        fit[name] = (("mean_radius", "material", "type"), values, {"units": "1", "long_name": _FIT_MEANING[name]})
    fit["n_grains"] = (("material", "type"), n_grains, {"units": "1", "long_name": "grains in the fit"})
    fit["n_sizes"] = (("material", "type"), n_sizes, {"units": "1", "long_name": "sizes in the fit"})
    return fit


_FIT_MEANING = {
    "A": "fit parameter A of Eq. 33",
    "A_low": "lower end of the confidence interval of A",
    "A_high": "upper end of the confidence interval of A",
    "alpha": "fit parameter alpha of Eq. 33",
    "alpha_low": "lower end of the confidence interval of alpha",
    "alpha_high": "upper end of the confidence interval of alpha",
    "scatter": "standard deviation of the residuals of ln omega",
}


def fit_as_configured(table, settings):
    """Fit Eq. 33 as a config says.

    Parameters
    ----------
    table : pandas.DataFrame or xarray.Dataset
        See `fit_ensemble`.
    settings : dict
        From `ratd.pipeline.config.Plan.ensemble`.

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


def table_dataset(table, dim="grain"):
    """A table of grains or of cells as a Dataset, with units and meaning on each variable.

    Parameters
    ----------
    table : pandas.DataFrame
        What `grain_table` or `cell_statistics` returns.
    dim : str
        Name of the one dimension.

    Returns
    -------
    xarray.Dataset
        One variable a column, over `dim`.
    """
    result = xr.Dataset()
    for name in table.columns:
        values = table[name].to_numpy()
        if not pd.api.types.is_numeric_dtype(table[name].dtype):
            values = values.astype(str).astype(object)
        result[name] = (dim, values, _describe(name))
    return result


def sort_cells(table):
    """Sort rows by material and type in the paper's order, then by size and seed, as far as these columns exist.

    Parameters
    ----------
    table : pandas.DataFrame

    Returns
    -------
    pandas.DataFrame
        Sorted copy with a fresh index. Names that the paper does not have come last, by the alphabet.
    """
    table = table.reset_index(drop=True)  # of tables put together an index may name several grains
    keys = pd.DataFrame(index=table.index)
    for name, order in (("material", [m for m, _ in TABLE_3]), ("type", [t for _, t in TABLE_3])):
        if name in table:
            rank = {value: k for k, value in enumerate(dict.fromkeys(order))}
            keys[f"{name}_rank"] = [rank.get(value, len(rank)) for value in table[name]]
            keys[name] = table[name].astype(str)
    if "a_eff" in table:
        keys["a_eff"] = size_key(table["a_eff"])
    if "seed" in table:
        keys["seed"] = table["seed"]
    if keys.empty or not len(keys.columns):
        return table
    return table.loc[keys.sort_values(list(keys.columns), kind="stable").index].reset_index(drop=True)


def _describe(name):
    """Attributes of a column of the grain table, or of a statistic of one."""
    if name == "n_grains":
        return {"units": "1", "long_name": "grains in the cell"}
    base, _, statistic = name.rpartition("_")
    if name not in COLUMNS and base in COLUMNS:
        units, meaning = COLUMNS[base]
        if statistic == "count":
            return {"units": "1", "long_name": f"grains with a value of: {meaning}"}
        return {"units": units, "long_name": f"{statistic} of: {meaning}"}
    units, meaning = COLUMNS.get(name, ("", name))
    return {"units": units, "long_name": meaning} if units else {"long_name": meaning}


def cell_of(table):
    """Number of the cell (material, type, size) of each grain of a table, array of int."""
    cell = np.zeros(len(table), dtype=np.int64)
    for key in (table["material"], table["type"], size_key(table["a_eff"])):
        cell = pd.factorize(cell * len(table) + pd.factorize(key)[0])[0]
    return cell


def size_key(a_eff):
    """Sizes [m], a Series, as whole picometres, so that rounding in the last digit makes no new size."""
    return np.rint(a_eff.astype(float) / 1e-12).astype(np.int64)


def _frame(rows, what):
    """DataFrame of whatever form of rows `grain_table` takes."""
    if isinstance(rows, pd.DataFrame):
        return rows.copy()
    if isinstance(rows, xr.Dataset):
        return _as_frame(rows, "grain_table", ())
    return pd.DataFrame([_row(row, what) for row in rows])


def _row(row, what):
    """One grain, one Dataset or one mapping as a dict of scalars."""
    if isinstance(row, Grain):
        return _grown(row)
    if isinstance(row, xr.Dataset):
        scalars = {name: variable.item() for name, variable in row.variables.items() if variable.ndim == 0}
        if "radius" in row:  # a row of a file of grains, which has the monomers themselves
            scalars |= _of_monomers(row["radius"].values)
        return {**row.attrs, **scalars}
    if isinstance(row, Mapping | pd.Series):
        return dict(row)
    raise InputError(f"grain_table: one of the {what} is a {type(row).__name__}, not a Grain, mapping or Dataset")


def _grown(grain):
    """What a Grain says about itself."""
    shape = grain.shape
    return {
        "material": grain.material.name,
        "type": grain.type,
        "a_eff": grain.a_eff,
        "seed": grain.seed,
        "n_contacts": grain.n_contacts,
        "porosity": shape.porosity,
        "fractal_dimension": shape.fractal_dimension,
        "fractal_dimension_error": shape.fractal_dimension_error,
        "enclosing_radius": shape.enclosing_radius,
        "axis_a": shape.a,
        "axis_b": shape.b,
        "axis_c": shape.c,
        "spin_share": spin_share(grain.radius, grain.material.density, shape.moments[0]),
        **_of_monomers(grain.radius),
    }


def _of_monomers(radius):
    """What the radii (n,) [m] of the monomers say."""
    return {"n_monomers": len(radius), "mean_monomer_radius": np.mean(radius)}


def _keyed(table, what):
    """Table with an index that names the grain, checked to be unique."""
    for name in KEYS:
        if name not in table:
            raise InputError(f"grain_table: the {what} have no '{name}'")
    table.index = pd.MultiIndex.from_arrays(
        [table["material"], table["type"], size_key(table["a_eff"]), table["seed"]], names=KEYS
    )
    if table.index.has_duplicates:
        material, kind, picometres, seed = table.index[table.index.duplicated()][0]
        raise InputError(
            f"grain_table: the {what} hold {material} {kind} {picometres / 1e3:g} nm seed {seed} more than once"
        )
    return table


def _as_frame(table, where, columns):
    """DataFrame of a table that may be a Dataset over one dimension; checks that the columns exist."""
    if isinstance(table, xr.Dataset):
        if len(table.sizes) != 1:
            raise InputError(f"{where}: the Dataset has the dimensions {list(table.sizes)}, but must have exactly one")
        dim = next(iter(table.sizes))
        table = table.to_dataframe().reset_index()
        if dim not in COLUMNS:
            table = table.drop(columns=dim)
    for name in columns:
        if name not in table:
            raise InputError(f"{where}: the table has no column '{name}'")
    return table


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
    readings = {}
    for value in given:
        if isinstance(value, str):
            if value != "own":
                raise InputError(f"fit_ensemble: mean_monomer_radius is '{value}', allowed are a radius in m and 'own'")
            readings["own"] = "own"
        elif value > 0:
            readings[f"{value * 1e9:g} nm"] = float(value)
        else:
            raise InputError(f"fit_ensemble: mean_monomer_radius is {value}, but must be above zero")
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


def _line(x, y, weights):
    """Slope and intercept of the least-squares line along the last axis."""
    total = weights.sum(axis=-1, keepdims=True)
    x_mean, y_mean = ((weights * v).sum(axis=-1, keepdims=True) / total for v in (x, y))
    spread = np.sum(weights * (x - x_mean) ** 2, axis=-1)
    # a replicate may draw equal x only, which leaves rounding: no slope
    slope = np.sum(weights * (x - x_mean) * (y - y_mean), axis=-1) / np.where(spread > 1e-20, spread, np.nan)
    return slope, y_mean[..., 0] - slope * x_mean[..., 0]
