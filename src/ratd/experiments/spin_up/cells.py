"""Cells of the ensemble, one (material, type, size) each: their order, and statistics of the grains in them.

Sizes are told apart to the picometre: 2e-7 and 200 * 1e-9 are the same size.
"""

import numpy as np
import pandas as pd
import xarray as xr

from ratd.base.errors import InputError

__all__ = ["GRAIN", "as_frame", "cell_of", "cell_statistics", "joined", "size_key", "sort_cells"]

MATERIALS = ("a-C", "q-S", "co-S")
"""Materials in the order of the paper."""
TYPES = ("BA", "BAM1", "BAM2")
"""Types of grains in the order of the paper."""
GRAIN = ["material", "type", "a_eff", "seed"]
"""The columns that together name one grain."""
N_BOOTSTRAP = 1000
"""Samples of a bootstrap over grains."""


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
    table = as_frame(table, "cell_statistics", by)
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
    for name, order in (("material", MATERIALS), ("type", TYPES)):
        if name in table:
            rank = {value: k for k, value in enumerate(order)}
            keys[f"{name}_rank"] = [rank.get(value, len(rank)) for value in table[name]]
            keys[name] = table[name].astype(str)
    if "a_eff" in table:
        keys["a_eff"] = size_key(table["a_eff"])
    if "seed" in table:
        keys["seed"] = table["seed"]
    if keys.empty or not len(keys.columns):
        return table
    return table.loc[keys.sort_values(list(keys.columns), kind="stable").index].reset_index(drop=True)


def cell_of(table):
    """Number of the cell (material, type, size) of each grain of a table, array of int."""
    cell = np.zeros(len(table), dtype=np.int64)
    for key in (table["material"], table["type"], size_key(table["a_eff"])):
        cell = pd.factorize(cell * len(table) + pd.factorize(key)[0])[0]
    return cell


def size_key(a_eff):
    """Sizes [m], a Series, as whole picometres, so that rounding in the last digit makes no new size."""
    return np.rint(a_eff.astype(float) / 1e-12).astype(np.int64)


def joined(table, other, columns, how="inner", suffix="_other"):
    """Rows of a table with columns of the same grain (material, type, size, seed) in another.

    Parameters
    ----------
    table, other : pandas.DataFrame
        With the columns material, type, a_eff [m] and seed; a grain is in `other` once at most.
    columns : sequence of str
        Of `other`.
    how : str
        ``"inner"``, or ``"left"``: rows of grains that `other` does not have stay, with NaN.
    suffix : str
        Appended to the name of a column that `table` has as well.

    Returns
    -------
    pandas.DataFrame
        In the order of `table`, with the column size [pm], see `size_key`.

    Raises
    ------
    pandas.errors.MergeError
        If `other` has a grain twice.
    """
    key = ["material", "type", "size", "seed"]
    left, right = (own.assign(size=size_key(own["a_eff"])) for own in (table, other))
    return left.merge(right[[*key, *columns]], on=key, how=how, suffixes=("", suffix), validate="many_to_one")


def as_frame(table, where, columns):
    """DataFrame of a table that may be a Dataset over one dimension; checks that the columns exist."""
    if isinstance(table, xr.Dataset):
        if len(table.sizes) != 1:
            raise InputError(f"{where}: the Dataset has the dimensions {list(table.sizes)}, but must have exactly one")
        dim = next(iter(table.sizes))
        table = table.to_dataframe().reset_index(drop=dim not in table.coords)
    for name in columns:
        if name not in table:
            raise InputError(f"{where}: the table has no column '{name}'")
    return table
