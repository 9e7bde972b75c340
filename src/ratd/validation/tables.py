"""Tables of the checks: one row a case, the same columns in memory and in netCDF."""

import pandas as pd
import xarray as xr

from ratd.base.errors import InputError
from ratd.pipeline import io, schema

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
    """Make a kind of file known to `ratd.pipeline.schema`, with a variable a column.

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
        Name of the kind, for `read_tables` and `write_table`.
    """
    kind = f"validation_{name}"
    schema.KINDS[kind] = schema.Kind(
        title,
        {
            column: schema.Variable((CASE,), "f8" if units else "str", units, meaning, nan=bool(units))
            for column, (units, meaning) in columns.items()
        },
    )
    return kind


def write_table(path, rows, kind, provenance):
    """Write the cases of a check.

    Parameters
    ----------
    path : path-like
    rows : list of dict
        One a case, all with the columns of the kind.
    kind : str
        From `table_kind`.
    provenance : dict
        Global attributes, from `ratd.pipeline.provenance.provenance`.

    Raises
    ------
    InputError
        If there is no case, or a case has other columns than the kind.
    """
    columns = schema.KINDS[kind].variables
    if not rows:
        raise InputError(f"{path}: a file of {kind} needs at least one case")
    for row in rows:
        if row.keys() != columns.keys():
            raise InputError(f"{path}: a case of {kind} has the columns {sorted(row)}, but needs {sorted(columns)}")
    dataset = xr.Dataset(
        {
            name: (CASE, [str(row[name]) if variable.dtype == "str" else float(row[name]) for row in rows])
            for name, variable in columns.items()
        },
        attrs=provenance,
    )
    io.write(path, dataset, kind)


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
