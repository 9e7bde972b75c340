"""Files of the pipeline: netCDF that is complete and checked, or not there.

A file is written under another name, closed, read again and compared, flushed to the disk, and only then given its
own name. It holds no time, host or path, so the same content gives the same bytes. What a file holds says its kind, see
`ratd.pipeline.kinds`.
"""

import hashlib
from pathlib import Path

import numpy as np
import xarray as xr

from ratd import __version__
from ratd.base.errors import FileError, InputError
from ratd.pipeline import kinds
from ratd.pipeline.atomic import atomic, reason, write_text
from ratd.pipeline.places import contradiction

__all__ = ["atomic", "is_made_with", "read", "read_made_with", "write", "write_text"]

CONVENTIONS = "CF-1.11"
REMEDY = "remove it, and the same command makes it anew"
COMPRESSED_FROM = 512
"""Arrays of this many elements or more are compressed; for fewer the bookkeeping takes more room than it saves."""


def write(path, dataset, kind):
    """Write a dataset as one kind of file, in one step.

    Parameters
    ----------
    path : path-like
        The file to write.
    dataset : xarray.Dataset
        Values of all variables of the kind, which adds units and meaning. Attributes become global ones.
    kind : str
        A kind of file, see `ratd.pipeline.kinds`.

    Raises
    ------
    InputError
        If the dataset is not laid out as the kind demands.
    FileError
        If the file cannot be written, or does not hold afterwards what was written. An older file stays as it was.
    """
    path = Path(path)
    dataset = _described(dataset, kind, str(path))
    if wrong := contradiction(dataset, kinds.kind_of(kind).places, path):
        raise InputError(f"{path}: {wrong}")
    with atomic(path) as temporary:
        try:
            dataset.to_netcdf(temporary, engine="netcdf4", format="NETCDF4", encoding=_encoding(dataset, kind))
        except RuntimeError as error:  # of the HDF5 library, e.g. on a full disk
            raise FileError(f"{path}: cannot be written ({reason(error, path)})") from error
        try:
            intact = read(temporary, kind).identical(dataset)
        except FileError as error:
            raise FileError(f"{path}: does not hold what was written into it ({error})") from error
        if not intact:
            raise FileError(f"{path}: does not hold what was written into it")


def _described(dataset, kind, where):
    """Copy of a dataset in the order of its kind, with all attributes that a file has."""
    layout = kinds.kind_of(kind)
    for name in dataset.variables:
        if name not in layout.variables:
            raise InputError(f"{where}: a file of {kind} has no variable {name!r}")
    result = xr.Dataset()
    for name, variable in layout.variables.items():
        if name not in dataset.variables:
            continue
        array = dataset[name]
        units = array.attrs.get("units", variable.units)
        if units != variable.units:
            raise InputError(f"{where}: {name!r} has the units {units!r}, but must have {variable.units!r}")
        attributes = dict(variable.attributes)
        if name.startswith("row_size_"):
            attributes["sample_dimension"] = name.removeprefix("row_size_")
        result[name] = (array.dims, _typed(array.values, name, variable, where), attributes)
    attributes = {
        "Conventions": CONVENTIONS,
        "title": layout.title,
        "source": f"ratd {__version__}",
        # without a time: the same content gives the same bytes
        "history": f"made by ratd {__version__} from the settings, source and inputs named here",
        "file_kind": kind,
        "file_format": kinds.FORMAT,
    }
    if layout.references:
        attributes["references"] = layout.references
    attributes |= {name: dataset.attrs[name] for name in layout.attributes if name in dataset.attrs}
    attributes |= {name: dataset.attrs[name] for name in sorted(dataset.attrs) if name not in attributes}
    attributes["content_hash"] = _content_hash(result)
    result.attrs = {name: _plain(value) for name, value in attributes.items()}
    kinds.check(result, kind, where, error=InputError)
    return result


def _content_hash(dataset):
    """Hash of all values of a dataset, which tells damage that the file format does not notice."""
    digest = hashlib.sha256()
    for name in sorted(dataset.variables):
        values = dataset[name].values
        digest.update(f"{name}\0{values.shape}\0".encode())
        if values.dtype.kind == "U":
            digest.update("\0".join(values.ravel()).encode())
        else:
            digest.update(np.ascontiguousarray(values).tobytes())
    return digest.hexdigest()[:16]


def _typed(values, name, variable, where):
    """Values in the type of the kind; only a change that keeps every value is made."""
    values = np.asarray(values)
    if variable.dtype == "str":
        return values.astype(str) if values.size else values.astype("U1")
    if values.dtype.kind not in "biuf":
        raise InputError(f"{where}: {name!r} is of type {values.dtype}, but must be {np.dtype(variable.dtype)}")
    typed = values.astype(variable.dtype)
    if not np.array_equal(typed, values, equal_nan=values.dtype.kind == "f" and typed.dtype.kind == "f"):
        raise InputError(f"{where}: {name!r} holds values that {np.dtype(variable.dtype)} cannot hold")
    return typed


def _plain(value):
    """An attribute as a Python number or text, arrays as they are."""
    return value.item() if isinstance(value, np.generic) else value


def _encoding(dataset, kind):
    """How each variable is laid out in the file."""
    encoding = {}
    for name, variable in kinds.kind_of(kind).variables.items():
        if name not in dataset.variables:
            continue
        if variable.dtype == "str":
            encoding[name] = {"dtype": "S1", "char_dim_name": f"{name}_length"}
        else:
            encoding[name] = {"dtype": variable.dtype, "_FillValue": np.nan if variable.nan else None}
        if dataset[name].size >= COMPRESSED_FROM:
            encoding[name] |= {"zlib": True, "complevel": 4, "shuffle": True}
    return encoding


def read(path, kind):
    """Read a file and check that it is complete and of the kind wanted.

    Parameters
    ----------
    path : path-like
    kind : str
        A kind of file, see `ratd.pipeline.kinds`.

    Returns
    -------
    xarray.Dataset
        All values in memory, the file closed.

    Raises
    ------
    FileError
        One sentence that names the file and what is wrong: not there, damaged, not netCDF, not written by ratd, of
        another kind, or not laid out as its kind says.
    """
    path = Path(path)
    if not path.is_file():
        raise FileError(f"{path}: there is no such file")
    try:
        with xr.open_dataset(path, engine="netcdf4", decode_times=False, mask_and_scale=False) as opened:
            dataset = opened.load()
    except Exception as error:  # a damaged file can make the libraries raise almost anything
        raise FileError(f"{path}: is damaged or no netCDF file ({error}): if ratd wrote it, {REMEDY}") from error
    found = dataset.attrs.get("file_kind")
    if found is None:
        raise FileError(f"{path}: was not written by ratd, a file of {kind} is needed")
    if found != kind:
        raise FileError(f"{path}: is a file of {found}, but one of {kind} is needed")
    if dataset.attrs.get("file_format") != kinds.FORMAT:
        raise FileError(
            f"{path}: has the format {dataset.attrs.get('file_format')}, but this ratd reads format {kinds.FORMAT}"
        )
    for array in dataset.variables.values():
        array.attrs.pop("_FillValue", None)
        array.encoding = {}
    dataset = dataset.reset_coords()
    for name, array in dataset.variables.items():
        if array.dtype.kind in "OS":  # texts, which come in several types, e.g. if all of them are empty
            dataset[name] = (array.dims, array.values.astype(str), array.attrs)
    dataset.attrs = {name: _plain(value) for name, value in dataset.attrs.items()}
    dataset.encoding = {}
    kinds.check(dataset, kind, str(path))
    if dataset.attrs.get("content_hash") != _content_hash(dataset):
        raise FileError(f"{path}: is damaged (its values do not agree with its content_hash): {REMEDY}")
    if wrong := contradiction(dataset, kinds.kind_of(kind).places, path):
        raise FileError(f"{path}: {wrong}: {REMEDY}")
    return dataset


def read_made_with(path, kind, attributes):
    """Read a file, if it is there, whole, and made with the same source, settings, inputs and versions.

    Parameters
    ----------
    path : path-like
    kind : str
    attributes : dict
        From `ratd.pipeline.provenance.provenance`.

    Returns
    -------
    xarray.Dataset or None
        See `read`. None for a damaged file too: the caller makes it anew.
    """
    try:
        found = read(path, kind)
    except FileError:
        return None
    return found if is_made_with(found, attributes) else None


def is_made_with(found, attributes):
    """Whether a dataset that was read has all these attributes, see `read_made_with`."""
    return all(found.attrs.get(name) == value for name, value in attributes.items())
