"""Files of one row a grain: rows are joined into the dataset of a file, and taken apart again.

A *row* is what belongs to one grain, as a dataset of scalars and of arrays along the sample dimensions of its kind (see
`ratd.pipeline.kinds`).
"""

import numpy as np
import xarray as xr

from ratd.base.errors import InputError
from ratd.base.materials import Material
from ratd.pipeline.kinds import MATERIAL, ROW, kind_of


def block(rows, kind, material, attributes=None):
    """Join the rows of some grains of one material.

    Parameters
    ----------
    rows : list of xarray.Dataset
        One a grain, with the variables of the kind: scalars, which may be attributes, and arrays along its sample
        dimensions. Attributes of the whole file must be the same in every row.
    kind : str
        A kind of file, see `ratd.pipeline.kinds`.
    material : Material
        What the monomers are made of; its constants are written into the file.
    attributes : dict, optional
        Further global attributes, from `ratd.pipeline.provenance.provenance`.

    Returns
    -------
    xarray.Dataset
        To be written by `write`.

    Raises
    ------
    InputError
        If there are no rows, a row lacks a variable or has an unknown one, or two rows contradict each other.
    """
    if not rows:
        raise InputError(f"block: a file of {kind} needs at least one grain")
    layout = kind_of(kind)
    over_row = [name for name, variable in layout.variables.items() if variable.dims == (ROW,)]
    common = {name: value for name, value in rows[0].attrs.items() if name not in over_row}
    for row in rows:
        for name in row.variables:
            if name not in layout.variables:
                raise InputError(f"block: a file of {kind} has no variable {name!r}")
        own = {name: value for name, value in row.attrs.items() if name not in over_row}
        if not _same(own, common):
            names = sorted(own.keys() | common.keys())
            other = [
                name for name in names
                if not _same({name: own.get(name)}, {name: common.get(name)})
            ]  # fmt: skip
            raise InputError(f"block: the grains of one file of {kind} must have the same {', '.join(other)}")
    result = xr.Dataset(attrs=common | (attributes or {}))
    for name, variable in layout.variables.items():
        if name in MATERIAL:
            result[name] = ((), getattr(material, name))
        elif name.startswith("row_size_"):
            dimension = name.removeprefix("row_size_")
            result[name] = (ROW, np.array([row.sizes.get(dimension, 0) for row in rows], dtype="i8"))
        elif variable.dims == (ROW,):
            values = [_flagged(_value(row, name, kind), variable) for row in rows]
            result[name] = (ROW, np.array(values, dtype=None if variable.dtype == "str" else variable.dtype))
        else:
            parts = [_part(row, name, variable) for row in rows]
            result[name] = (variable.dims, np.concatenate(parts))
    return result


def _same(some, other):
    """Whether two dicts of attributes are the same, NaN being equal to NaN."""
    return some.keys() == other.keys() and all(
        some[name] == other[name] or (some[name] != some[name] and other[name] != other[name]) for name in some
    )


def _value(row, name, kind):
    """A number of one grain, a scalar variable or an attribute of its row."""
    if name in row.variables:
        return row[name].item()
    if name in row.attrs:
        return row.attrs[name]
    raise InputError(f"block: a row of {kind} lacks {name!r}")


def _flagged(value, variable):
    """The number that stands for a text in a file."""
    if not variable.flags:
        return value
    if value not in variable.flags:
        raise InputError(f"block: {value!r} is none of {', '.join(variable.flags)}")
    return variable.flags.index(value)


def _part(row, name, variable):
    """What one grain adds to an array along a sample dimension; nothing if its row lacks the dimension."""
    if name not in row.variables:
        if variable.dims[0] in row.dims:
            raise InputError(f"block: a row lacks {name!r}")
        return np.empty(0, variable.dtype)
    return row[name].values


def rows(dataset, kind):
    """Take the dataset of a file apart into the rows of its grains.

    Parameters
    ----------
    dataset : xarray.Dataset
        From `read`.
    kind : str
        A kind of file, see `ratd.pipeline.kinds`.

    Returns
    -------
    list of xarray.Dataset
        One a grain. What the kind names in `of_row`, and its global attributes, are attributes.
    """
    layout = kind_of(kind)
    bounds = {
        name: np.concatenate([[0], np.cumsum(dataset[f"row_size_{name}"].values)]).astype(int) for name in layout.ragged
    }
    wanted = [
        (name, variable, dataset[name].values, _texts(dataset[name]))
        for name, variable in layout.variables.items()
        if name not in MATERIAL and not name.startswith("row_size_")
    ]
    result = []
    for k in range(dataset.sizes[ROW]):
        # all variables at once: one after the other xarray would copy the dataset each time
        found, attributes = {}, {name: dataset.attrs[name] for name in layout.attributes}
        for name, variable, values, texts in wanted:
            if variable.dims != (ROW,):
                first, last = bounds[variable.dims[0]][k : k + 2]
                found[name] = (variable.dims, values[first:last].copy(), dict(texts))
            elif name in layout.of_row:
                attributes[name] = variable.flags[values[k]] if variable.flags else values[k].item()
            else:
                found[name] = ((), values[k], dict(texts))
        result.append(xr.Dataset(found, attrs=attributes))
    return result


def _texts(array):
    """Unit and meaning of a variable."""
    return {key: array.attrs[key] for key in ("units", "long_name") if key in array.attrs}


def material_of(dataset):
    """Material of a file.

    Parameters
    ----------
    dataset : xarray.Dataset
        From `read`.

    Returns
    -------
    Material
    """
    return Material(dataset.attrs["material"], **{name: dataset[name].item() for name in MATERIAL})
