"""One table of all grains: how each was grown, and how it was disrupted."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr

from ratd.aggregates.files import CUT_BOUND
from ratd.aggregates.grain import Grain
from ratd.base.errors import InputError
from ratd.experiments.spin_up.cells import GRAIN, as_frame, size_key, sort_cells
from ratd.experiments.spin_up.marks import VARIABLES as MARK_COLUMNS
from ratd.pipeline import io
from ratd.pipeline.kinds import kind_of

__all__ = [
    "COLUMNS",
    "GRAIN_COLUMNS",
    "RUN_COLUMNS",
    "grain_table",
    "spun_up_files",
    "spun_up_table",
    "table_dataset",
]

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
    "cut_bound": CUT_BOUND,
    "spin_share": ("1", "share of the monomers' own moments of inertia in I_1"),
}
"""Units and meaning of what is known before the spin-up."""

RUN_COLUMNS = {
    "drive": ("", "what turns the grain: prescribed, torque or literal"),
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
        If there is nothing to tabulate, a column of `GRAIN` is missing, two rows name the same grain, or a mark has
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


def spun_up_files(folder):
    """Files of the queue of spin-ups.

    Parameters
    ----------
    folder : path-like
        Of one drive, below that of `ratd.experiments.spin_up.study`.

    Returns
    -------
    list of xarray.Dataset
    """
    return [io.read(path, "spun_up") for path in sorted(Path(folder).glob("*.nc"))]


def spun_up_table(files, grown=None):
    """Table of the grains that the queue of spin-ups has finished.

    Parameters
    ----------
    files : list of xarray.Dataset
        From `spun_up_files`.
    grown : pandas.DataFrame, optional
        Table of grains as grown, which may hold more of them; what each was as grown is taken from it then.

    Returns
    -------
    pandas.DataFrame
        As `grain_table` makes it.
    """
    marks = pd.concat([_spun_up(file) for file in files])
    if grown is None:
        return grain_table(marks=marks)
    table = grain_table(grown[list(GRAIN_COLUMNS)], grain_table(marks=marks))
    return table[table["drive"] != ""].reset_index(drop=True)


def _spun_up(file):
    """Table of a file of the queue, without the fragments."""
    table = file.drop_dims("fragment").to_dataframe().reset_index(drop=True)
    reasons = kind_of("spun_up").variables["end_reason"].flags
    table["end_reason"] = [reasons[value] for value in table["end_reason"]]
    return table.assign(**{name: file.attrs[name] for name in ("material", "type", "drive")})


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


def _frame(rows, what):
    """DataFrame of whatever form of rows `grain_table` takes."""
    if isinstance(rows, pd.DataFrame):
        return rows.copy()
    if isinstance(rows, xr.Dataset):
        return as_frame(rows, "grain_table", ())
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
        "spin_share": shape.spin_share,
        **_of_monomers(grain.radius),
    }


def _of_monomers(radius):
    """What the radii (n,) [m] of the monomers say."""
    return {"n_monomers": len(radius), "mean_monomer_radius": np.mean(radius)}


def _keyed(table, what):
    """Table with an index that names the grain, checked to be unique."""
    for name in GRAIN:
        if name not in table:
            raise InputError(f"grain_table: the {what} have no '{name}'")
    table.index = pd.MultiIndex.from_arrays(
        [table["material"], table["type"], size_key(table["a_eff"]), table["seed"]], names=GRAIN
    )
    if table.index.has_duplicates:
        material, kind, picometres, seed = table.index[table.index.duplicated()][0]
        raise InputError(
            f"grain_table: the {what} hold {material} {kind} {picometres / 1e3:g} nm seed {seed} more than once"
        )
    return table
