"""Tables of the checks: one row a case, the same columns in memory and in netCDF."""

import numpy as np
import pandas as pd
import xarray as xr

from ratd.base.errors import InputError
from ratd.pipeline import io
from ratd.pipeline.kinds import Kind, entries, kind_of, register

CASE = "case"
"""Dimension along which the cases of a file stand."""
GRAIN_COLUMNS = {
    "material": ("", "material"),
    "type": ("", "growth: BA, BAM1 or BAM2"),
    "a_eff": ("m", "effective radius"),
    "seed": ("1", "seed of the grain"),
    "n_monomers": ("1", "monomers"),
}
"""Columns that say which grain a case is of, for `table_kind`; `grain_values` gives their values."""


def grain_values(grain):
    """Values of `GRAIN_COLUMNS`.

    Parameters
    ----------
    grain : ratd.Grain

    Returns
    -------
    dict
    """
    return dict(
        material=grain.material.name,
        type=grain.type,
        a_eff=grain.effective_radius,
        seed=grain.seed,
        n_monomers=grain.n_monomers,
    )


def table_kind(name, title, columns):
    """Register a kind of file with a variable a column, see `ratd.pipeline.kinds`.

    Parameters
    ----------
    name : str
        Name of the check.
    title : str
    columns : dict of str to tuple of str
        Column -> (units, meaning); units "" mark a column of text.

    Returns
    -------
    str
        Name of the kind, for `read_tables` and `as_dataset`.
    """
    return register(f"validation_{name}", Kind(title, entries(columns, CASE)))


def empty_row(columns):
    """A case without values: "" in a column of text, NaN in any other.

    Parameters
    ----------
    columns : dict of str to tuple of str
        As of `table_kind`.

    Returns
    -------
    dict
    """
    return {name: np.nan if units else "" for name, (units, _) in columns.items()}


def as_dataset(rows, kind):
    """The cases of a check as a dataset.

    Parameters
    ----------
    rows : list of dict
        One a case, all with the columns of the kind.
    kind : str
        From `table_kind`.

    Returns
    -------
    xarray.Dataset

    Raises
    ------
    InputError
        If there is no case, or a case has other columns than the kind.
    """
    columns = kind_of(kind).variables
    if not rows:
        raise InputError(f"a file of {kind} needs at least one case")
    for row in rows:
        if row.keys() != columns.keys():
            raise InputError(f"a case of {kind} has the columns {sorted(row)}, but needs {sorted(columns)}")
    return xr.Dataset(
        {
            name: (CASE, [str(row[name]) if variable.dtype == "str" else float(row[name]) for row in rows])
            for name, variable in columns.items()
        }
    )


def read_tables(paths, kind):
    """Cases of some files of a check, one after the other.

    Parameters
    ----------
    paths : iterable of path-like
    kind : str
        From `table_kind`.

    Returns
    -------
    pandas.DataFrame
    """
    return pd.concat([io.read(path, kind).to_dataframe() for path in paths], ignore_index=True)


def table(files, settings, say):
    """All cases of a check, the output ``csv`` of a job of the pipeline, from the files of its pieces."""
    return {"csv": read_tables(files, settings["kind"])}
