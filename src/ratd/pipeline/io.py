"""Files of the pipeline: netCDF that is complete and checked, or not there.

A file is written under another name, closed, read again and compared, flushed to the disk, and only then given its
own name. It holds no time, host or path, so the same content gives the same bytes. The layout of every kind of file
stands in `ratd.pipeline.schema`.

A *row* is what belongs to one grain, as a dataset of scalars and of arrays along the sample dimensions of its kind;
`block` joins rows into the dataset of a file, `rows` takes them apart again. `grain_row` and `run_row` make rows of a
`ratd.Grain` and of what `ratd.spin_up` returns, `grains` and `runs` turn them back.
"""

import hashlib
import os
from contextlib import contextmanager, suppress
from importlib import metadata
from pathlib import Path

import numpy as np
import xarray as xr

from ratd.aggregates.grain import Grain
from ratd.base.errors import FileError, InputError
from ratd.base.materials import Material
from ratd.geometry.shape import spin_share
from ratd.pipeline import schema

CONVENTIONS = "CF-1.11"
REFERENCES = "Reissl et al. (2024), A&A 692, A60, arXiv:2301.12889"
COMPRESSED_FROM = 512
"""Arrays of this many elements or more are compressed; for fewer the bookkeeping takes more room than it saves."""


@contextmanager
def atomic(path):
    """A name to write a file under, which becomes `path` when everything went well.

    Parameters
    ----------
    path : path-like
        The file to write. Its folder is made if needed.

    Yields
    ------
    Path
        ``NAME.<process number>.tmp`` in the same folder. On success it is flushed to the disk and renamed in one step;
        on failure it is removed and `path` stays as it was. What killed processes left behind is removed first.

    Raises
    ------
    FileError
        If the file cannot be written, e.g. because the disk is full.
    """
    path = Path(path)
    temporary = path.with_name(f"{path.name}.{os.getpid()}.tmp")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        _remove_left_over(path)
        yield temporary
        with open(temporary, "rb") as handle:
            os.fsync(handle.fileno())
        os.replace(temporary, path)
        folder = os.open(path.parent, os.O_RDONLY)
        try:
            os.fsync(folder)
        finally:
            os.close(folder)
    except OSError as error:
        if isinstance(error, FileError):
            raise
        raise FileError(f"{path}: cannot be written ({error.strerror or error})") from error
    finally:
        with suppress(OSError):
            temporary.unlink()


def _remove_left_over(path):
    """Remove the temporary files of this path whose processes have ended."""
    for other in path.parent.glob(f"{_literal(path.name)}.*.tmp"):
        number = other.name[len(path.name) + 1 : -len(".tmp")]
        if number.isdigit() and int(number) != os.getpid() and not _is_alive(int(number)):
            other.unlink(missing_ok=True)


def _literal(name):
    """Pattern of glob that matches this name alone."""
    return "".join(f"[{letter}]" if letter in "*?[" else letter for letter in name)


def _is_alive(process):
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except OSError:  # it is somebody else's
        return True
    return True


def write_text(path, text):
    """Write a text file in one step, see `atomic`.

    Parameters
    ----------
    path : path-like
    text : str
    """
    with atomic(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


def write(path, dataset, kind):
    """Write a dataset as one kind of file, in one step.

    Parameters
    ----------
    path : path-like
        The file to write.
    dataset : xarray.Dataset
        Values of all variables of the kind; `ratd.pipeline.schema` adds units and meaning. Attributes become global ones.
    kind : str
        A key of `ratd.pipeline.schema.KINDS`.

    Raises
    ------
    InputError
        If the dataset is not laid out as the kind demands.
    FileError
        If the file cannot be written, or does not hold afterwards what was written. An older file stays as it was.
    """
    path = Path(path)
    dataset = _described(dataset, kind, str(path))
    with atomic(path) as temporary:
        try:
            dataset.to_netcdf(temporary, engine="netcdf4", format="NETCDF4", encoding=_encoding(dataset, kind))
        except RuntimeError as error:  # of the HDF5 library, e.g. on a full disk
            raise FileError(f"{path}: cannot be written ({error})") from error
        try:
            intact = read(temporary, kind).identical(dataset)
        except FileError as error:
            raise FileError(f"{path}: does not hold what was written into it ({error})") from error
        if not intact:
            raise FileError(f"{path}: does not hold what was written into it")


def _described(dataset, kind, where):
    """Copy of a dataset in the order of the registry, with all attributes that a file has."""
    layout = schema.KINDS[kind]
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
        "source": f"ratd {metadata.version('ratd')}",
        "references": REFERENCES,
        "file_kind": kind,
        "file_format": schema.FORMAT,
    }
    attributes |= {name: dataset.attrs[name] for name in layout.attributes if name in dataset.attrs}
    attributes |= {name: dataset.attrs[name] for name in sorted(dataset.attrs) if name not in attributes}
    attributes["content_hash"] = _content_hash(result)
    result.attrs = {name: _plain(value) for name, value in attributes.items()}
    schema.check(result, kind, where, error=InputError)
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
    """Values in the type of the registry; only a change that keeps every value is made."""
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
    for name, variable in schema.KINDS[kind].variables.items():
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
        A key of `ratd.pipeline.schema.KINDS`.

    Returns
    -------
    xarray.Dataset
        All values in memory, the file closed.

    Raises
    ------
    FileError
        One sentence that names the file and what is wrong: not there, damaged, not netCDF, not written by ratd, of
        another kind, or not laid out as `ratd.pipeline.schema` says.
    """
    path = Path(path)
    if not path.is_file():
        raise FileError(f"{path}: there is no such file")
    try:
        with xr.open_dataset(path, engine="netcdf4", decode_times=False, mask_and_scale=False) as opened:
            dataset = opened.load()
    except Exception as error:  # a damaged file can make the libraries raise almost anything
        raise FileError(f"{path}: is damaged or no netCDF file ({error})") from error
    found = dataset.attrs.get("file_kind")
    if found is None:
        raise FileError(f"{path}: was not written by ratd, a file of {kind} is needed")
    if found != kind:
        raise FileError(f"{path}: is a file of {found}, but one of {kind} is needed")
    if dataset.attrs.get("file_format") != schema.FORMAT:
        raise FileError(
            f"{path}: has the format {dataset.attrs.get('file_format')}, but this ratd reads format {schema.FORMAT}"
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
    schema.check(dataset, kind, str(path))
    if dataset.attrs.get("content_hash") != _content_hash(dataset):
        raise FileError(f"{path}: is damaged (its values do not agree with its content_hash)")
    return dataset


def read_made_with(path, kind, attributes):
    """Read a file, if it is there, whole, and made with the same source, settings and inputs.

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
    return found if all(found.attrs.get(name) == value for name, value in attributes.items()) else None


def join_tables(parts):
    """Tables one below the other.

    Parameters
    ----------
    parts : list of xarray.Dataset
        Of one kind and one dimension.

    Returns
    -------
    xarray.Dataset
        Without attributes of the whole.
    """
    return xr.concat(parts, dim=next(iter(parts[0].sizes)), data_vars="all").drop_attrs()


def block(rows, kind, material, attributes=None):
    """Join the rows of some grains of one material.

    Parameters
    ----------
    rows : list of xarray.Dataset
        One a grain, with the variables of the kind: scalars, and arrays along its sample dimensions. What belongs to
        `ratd.pipeline.schema.RUN_VALUES` may be an attribute. Attributes of the whole file must be the same in every row.
    kind : str
        A key of `ratd.pipeline.schema.KINDS`.
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
    layout = schema.KINDS[kind]
    over_row = [name for name, variable in layout.variables.items() if variable.dims == (schema.ROW,)]
    common = {name: value for name, value in rows[0].attrs.items() if name not in over_row}
    for row in rows:
        for name in row.variables:
            if name not in layout.variables:
                raise InputError(f"block: a file of {kind} has no variable {name!r}")
        if not _same({name: value for name, value in row.attrs.items() if name not in over_row}, common):
            raise InputError(f"block: the grains of one file of {kind} must have the same attributes {sorted(common)}")
    result = xr.Dataset(attrs=common | (attributes or {}))
    for name, variable in layout.variables.items():
        if name in schema.MATERIAL:
            result[name] = ((), getattr(material, name))
        elif name.startswith("row_size_"):
            dimension = name.removeprefix("row_size_")
            result[name] = (schema.ROW, np.array([row.sizes.get(dimension, 0) for row in rows], dtype="i8"))
        elif variable.dims == (schema.ROW,):
            values = [_flagged(_value(row, name, kind), variable) for row in rows]
            result[name] = (schema.ROW, np.array(values, dtype=None if variable.dtype == "str" else variable.dtype))
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
        A key of `ratd.pipeline.schema.KINDS`.

    Returns
    -------
    list of xarray.Dataset
        One a grain. `ratd.pipeline.schema.RUN_VALUES` and the global attributes of the kind are attributes.
    """
    layout = schema.KINDS[kind]
    bounds = {
        name: np.concatenate([[0], np.cumsum(dataset[f"row_size_{name}"].values)]).astype(int) for name in layout.ragged
    }
    result = []
    for k in range(dataset.sizes[schema.ROW]):
        row = xr.Dataset(attrs={name: dataset.attrs[name] for name in layout.attributes})
        for name, variable in layout.variables.items():
            if name in schema.MATERIAL or name.startswith("row_size_"):
                continue
            array = dataset[name]
            attributes = {key: array.attrs[key] for key in ("units", "long_name") if key in array.attrs}
            if variable.dims == (schema.ROW,):
                value = array.values[k]
                if name in schema.RUN_VALUES and kind != "grains":
                    row.attrs[name] = variable.flags[value] if variable.flags else value.item()
                else:
                    row[name] = ((), value, attributes)
            else:
                dimension = variable.dims[0]
                first, last = bounds[dimension][k : k + 2]
                row[name] = (variable.dims, array.values[first:last].copy(), attributes)
        result.append(row)
    return result


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
    return Material(dataset.attrs["material"], **{name: dataset[name].item() for name in schema.MATERIAL})


def grain_row(grain, cut_bound):
    """Row of a grain in a file of grains.

    Parameters
    ----------
    grain : Grain
    cut_bound : float
        From `ratd.experiments.spin_up.cut_bound.cut_bound` [rad s-1].

    Returns
    -------
    xarray.Dataset
    """
    shape = grain.shape
    values = {
        "seed": grain.seed,
        "a_eff": grain.a_eff,
        "n_monomers": grain.n_monomers,
        "n_contacts": grain.n_contacts,
        "mean_monomer_radius": grain.radius.mean(),
        "enclosing_radius": shape.enclosing_radius,
        "axis_a": shape.a,
        "axis_b": shape.b,
        "axis_c": shape.c,
        "porosity": shape.porosity,
        "fractal_dimension": shape.fractal_dimension,
        "fractal_dimension_error": shape.fractal_dimension_error,
        "cut_bound": cut_bound,
    }
    values |= {f"moment_{k + 1}": moment for k, moment in enumerate(shape.moments)}
    row = xr.Dataset(values, attrs={"material": grain.material.name, "type": grain.type or ""})
    for axis, coordinate in zip("xyz", grain.position.T, strict=True):
        row[axis] = ("monomer", coordinate)
    row["radius"] = ("monomer", grain.radius)
    return row


def grains(dataset):
    """Grains of a file of grains.

    Parameters
    ----------
    dataset : xarray.Dataset
        From `read`.

    Returns
    -------
    list of Grain
    """
    material = material_of(dataset)
    return [
        Grain(
            np.stack([row[axis].values for axis in "xyz"], axis=1),
            row["radius"].values,
            material,
            type=row.attrs["type"],
            a_eff=row["a_eff"].item(),
            seed=row["seed"].item(),
        )
        for row in rows(dataset, "grains")
    ]


def run_row(run):
    """Row of a spin-up run in a file of spin-ups.

    Parameters
    ----------
    run : xarray.Dataset
        From `ratd.spin_up`.

    Returns
    -------
    xarray.Dataset
        The run, with what is over (snapshot, monomer) along one dimension `snapshot_monomer`.
    """
    flat = [name for name in run.variables if run[name].dims == ("snapshot", "monomer")]
    row = run.drop_vars(flat)
    for name in flat:
        row[name] = ("snapshot_monomer", run[name].values.ravel(), run[name].attrs)
    return row


def runs(dataset):
    """Runs of a file of spin-ups.

    Parameters
    ----------
    dataset : xarray.Dataset
        From `read`.

    Returns
    -------
    list of xarray.Dataset
        As `ratd.spin_up` returns them.
    """
    result = []
    for row in rows(dataset, "spinup"):
        flat = [name for name in row.variables if row[name].dims == ("snapshot_monomer",)]
        run = row.drop_vars(flat)
        if row.sizes["snapshot"] == 0:
            run = run.drop_dims(["snapshot", "monomer"])
        else:
            shape = row.sizes["snapshot"], row.sizes["monomer"]
            for name in flat:
                run[name] = (("snapshot", "monomer"), row[name].values.reshape(shape), row[name].attrs)
        result.append(run)
    return result


def read_grains(path):
    """Grains of a file, list of `ratd.Grain`; see `read` for the errors."""
    return grains(read(path, "grains"))


def read_runs(path):
    """Spin-up runs of a file, list of datasets as `ratd.spin_up` returns them; see `read` for the errors."""
    return runs(read(path, "spinup"))


def read_marks(path):
    """Marks of the grains of a file, list of datasets as `ratd.disruption` returns them; see `read` for the errors."""
    return rows(read(path, "disruption"), "disruption")


def read_grain_columns(path):
    """What a file of grains says of each, without its monomers: list of datasets of scalars, with material and type.

    The share of the monomers in the moment of inertia, `ratd.geometry.shape.spin_share`, is added: it needs their radii.
    """
    file = read(path, "grains")
    return [
        row.drop_dims("monomer").assign(
            spin_share=spin_share(row["radius"].values, file["density"].item(), row["moment_1"].item())
        )
        for row in rows(file, "grains")
    ]


def read_table(path):
    """Table of all grains as `ratd.experiments.spin_up.grain_table.grain_table` made it, pandas.DataFrame; see `read` for the errors."""
    return read(path, "table").to_pandas()


def read_fit(path):
    """Fit as `ratd.experiments.spin_up.eq33.table3_dataset` made it, xarray.Dataset; see `read` for the errors."""
    return read(path, "fit")
