"""Kinds of files: which variables a file has, with dimensions, type, units and meaning.

This module knows none of them. Each module that makes a kind of file registers it under a name (`register`), and
`kind_of` finds it, importing the module that `HOMES` names if nobody did so before.

A file may hold one *row* a grain (dimension ``row``). What has another length for each grain (monomers, records) then
stands one grain after the other along a sample dimension, as CF-1.11 lays out contiguous ragged arrays: for the sample
dimension ``monomer`` the variable ``row_size_monomer(row)``, with the attribute ``sample_dimension``, says how many
elements belong to each grain.

Everything is in SI units. A dataset is checked against its kind before it is written and after it was read.
"""

import hashlib
from dataclasses import dataclass
from importlib import import_module

import numpy as np

from ratd.base.errors import FileError, InputError

FORMAT = 1
"""Version of the layout of the files. Raise it when `ratd.pipeline.io` lays out the same variables in another way."""

ROW = "row"
"""Dimension along which the grains of a file stand."""

HOMES = {
    "grains": "ratd.aggregates.files",
    **dict.fromkeys(("spinup", "disruption", "table", "cells", "fit", "spun_up"), "ratd.experiments.spin_up.files"),
    **dict.fromkeys(("clusters", "compression", "stretched"), "ratd.experiments.compression.files"),
    **dict.fromkeys(("compression_set", "compression_snapshots"), "ratd.experiments.compression.tables"),
    **dict.fromkeys(("pressed", "tension_set"), "ratd.experiments.compression.pull"),
    **dict.fromkeys(("table1", "table2"), "ratd.experiments.spin_up.composition"),
    "parameters": "ratd.experiments.spin_up.parameters",
    "calibration": "ratd.experiments.spin_up.calibration",
    "formulae": "ratd.experiments.spin_up.formulae",
    "pairs": "ratd.experiments.spin_up.pairs",
    "firm_bounds": "ratd.experiments.spin_up.firm_bound",
    "static_limits": "ratd.experiments.spin_up.static_limit",
    "pulled": "ratd.experiments.spin_up.pulled",
    "shapes": "ratd.experiments.spin_up.shapes",
    **dict.fromkeys(("built_clusters", "collisions"), "ratd.experiments.collision.files"),
    **dict.fromkeys(
        ("collision_table", "collision_thresholds", "collision_clusters"), "ratd.experiments.collision.tables"
    ),
    "collision_likeness": "ratd.experiments.collision.likeness",
    "lammps_spin_up": "ratd.validation.lammps_spin_up",
    "lammps_single": "ratd.validation.lammps_single",
    **{
        f"validation_{check}": f"ratd.validation.{check}"
        for check in (
            "quasi_static",
            "remnant",
            "pull_off",
            "damping",
            "literal",
            "theory",
            "mark_rules",
            "compression",
            "box_at_rest",
            "spring_back",
            "dense",
            "growth",
            "relaxation",
            "energy",
            "energy_step",
            "collision_step",
            "frames",
            "forces",
            "lammps",
        )
    },
}
"""Name of a kind -> the module that registers it."""

_known = {}  # name -> Kind


@dataclass(frozen=True)
class Variable:
    """One variable of a file.

    Parameters
    ----------
    dims : tuple of str
        Dimensions in the file.
    dtype : str
        ``"f8"``, ``"i8"``, ``"u8"``, ``"i4"``, ``"i1"`` or ``"str"`` (text, UTF-8, in a file an array of characters).
    units : str
        In the notation of UDUNITS, ``"1"`` for pure numbers, ``""`` for text and flags.
    long_name : str
    nan : bool
        Whether NaN (undefined) is allowed.
    flags : tuple of str
        For ``"i1"``: what 0, 1, ... stand for.
    """

    dims: tuple
    dtype: str
    units: str
    long_name: str
    nan: bool = False
    flags: tuple = ()

    @property
    def attributes(self):
        """CF attributes of the variable in a file, dict of str."""
        attributes = {"long_name": self.long_name}
        if self.units:
            attributes["units"] = self.units
        if self.flags:
            attributes["flag_values"] = np.arange(len(self.flags), dtype="i1")
            attributes["flag_meanings"] = " ".join(flag.replace(" ", "_") for flag in self.flags)
        return attributes


@dataclass(frozen=True)
class Kind:
    """One kind of file.

    Parameters
    ----------
    title : str
        Becomes the global attribute ``title``.
    variables : dict of str to Variable
        In the order in which they stand in the file.
    attributes : tuple of str
        Global attributes that the file must have, next to those of `ratd.pipeline.provenance`.
    ragged : tuple of str
        Its sample dimensions.
    of_row : tuple of str
        Variables along `ROW` that are attributes of the row of a grain, not variables of it.
    references : str
        Becomes the global attribute ``references``; empty for none.
    places : tuple of str
        Ends of the paths of its files, whose fields they must agree with, see `ratd.pipeline.places`.
    """

    title: str
    variables: dict
    attributes: tuple = ()
    ragged: tuple = ()
    of_row: tuple = ()
    references: str = ""
    places: tuple = ()


def register(name, kind):
    """Make a kind of file known.

    Parameters
    ----------
    name : str
    kind : Kind

    Returns
    -------
    str
        The name.
    """
    _known[name] = kind
    return name


def kind_of(name):
    """A kind of file by its name.

    Parameters
    ----------
    name : str

    Returns
    -------
    Kind

    Raises
    ------
    InputError
        If nobody makes such files.
    """
    if name not in _known and name in HOMES:
        import_module(HOMES[name])
    if name not in _known:
        raise InputError(f"{name!r} is no kind of file; allowed: {', '.join(sorted({*HOMES, *_known}))}")
    return _known[name]


def over(dims, table, dtype="f8", **options):
    """Variables with the same dimensions and type, from a table of name -> (units, meaning)."""
    return {name: Variable(dims, dtype, units, meaning, **options) for name, (units, meaning) in table.items()}


def entries(columns, dimension="entry"):
    """Variables of a table, one a column; text where it has no units.

    Parameters
    ----------
    columns : dict of str to tuple of str
        Column -> (units, meaning).
    dimension : str, optional
        Along which its rows stand.

    Returns
    -------
    dict of str to Variable
    """
    return {
        name: Variable((dimension,), "f8" if units else "str", units, meaning, nan=bool(units))
        for name, (units, meaning) in columns.items()
    }


def as_dataset(table):
    """A table with the columns of `entries`, pandas.DataFrame, as a dataset."""
    return table.rename_axis("entry").to_xarray().drop_vars("entry")


def row_sizes(dimensions):
    """The variables that say how many elements along each sample dimension belong to each grain."""
    return {
        f"row_size_{name}": Variable((ROW,), "i8", "1", f"number of elements along {name} that belong to the grain")
        for name in dimensions
    }


MATERIAL = over(
    (),
    {
        "surface_energy": ("J m-2", "surface energy gamma"),
        "youngs_modulus": ("Pa", "Young's modulus E"),
        "poisson_number": ("1", "Poisson number nu"),
        "density": ("kg m-3", "density rho of the bulk material"),
        "critical_rolling_displacement": ("m", "critical rolling displacement xi_c"),
        "viscous_time": ("s", "viscous time T_vis"),
    },
)
"""Constants of the material, scalars in every file of grains of one material."""


def fingerprint(name):
    """Hash of the layout of one kind of file: changes when its variables, or `FORMAT`, change.

    Parameters
    ----------
    name : str

    Returns
    -------
    str
        16 hexadecimal digits.
    """
    layout = kind_of(name)
    lines = [f"{name} {FORMAT} {layout.attributes} {layout.ragged} {layout.references}"]
    lines += [f"{variable} {about!r}" for variable, about in layout.variables.items()]
    return hashlib.sha256("\n".join(lines).encode()).hexdigest()[:16]


def check(dataset, name, where, error=FileError):
    """Raise an error unless a dataset is laid out as its kind of file demands.

    Parameters
    ----------
    dataset : xarray.Dataset
        With all values in memory.
    name : str
        Of the kind.
    where : str
        What the dataset is, for the message: usually the name of its file.
    error : type, optional
        What is raised.

    Raises
    ------
    FileError
        One sentence: a variable is missing or unknown, or has other dimensions, another type, other units, NaN where
        NaN is not allowed; an attribute is missing; the row sizes do not add up.
    """
    layout = kind_of(name)
    for attribute in layout.attributes:
        if attribute not in dataset.attrs:
            raise error(f"{where}: the attribute {attribute!r} of a file of {name} is missing")
    for found in dataset.variables:
        if found not in layout.variables:
            raise error(f"{where}: a file of {name} has no variable {found!r}")
    for wanted, variable in layout.variables.items():
        if wanted not in dataset.variables:
            raise error(f"{where}: the variable {wanted!r} of a file of {name} is missing")
        _check_variable(dataset[wanted], wanted, variable, where, error)
    for dimension in layout.ragged:
        sizes = dataset[f"row_size_{dimension}"].values
        if (sizes < 0).any() or sizes.sum() != dataset.sizes[dimension]:
            raise error(
                f"{where}: the row sizes along {dimension!r} add up to {sizes.sum()}, "
                f"but the dimension has {dataset.sizes[dimension]} elements"
            )


def _check_variable(array, name, variable, where, error):
    """Raise an error unless one variable has the dimensions, type, units and values of its kind."""
    if array.dims != variable.dims:
        raise error(f"{where}: {name!r} has the dimensions {array.dims}, but must have {variable.dims}")
    if variable.dtype == "str":
        if array.dtype.kind != "U":
            raise error(f"{where}: {name!r} is of type {array.dtype}, but must be text")
    elif array.dtype != np.dtype(variable.dtype):
        raise error(f"{where}: {name!r} is of type {array.dtype}, but must be {np.dtype(variable.dtype)}")
    units = array.attrs.get("units", "")
    if units != variable.units:
        raise error(f"{where}: {name!r} has the units {units!r}, but must have {variable.units!r}")
    if variable.dtype == "f8" and not variable.nan and not np.isfinite(array.values).all():
        raise error(f"{where}: {name!r} holds values that are not finite (NaN or infinite)")
    if variable.flags and not np.isin(array.values, np.arange(len(variable.flags))).all():
        raise error(f"{where}: {name!r} holds a flag that is none of {list(range(len(variable.flags)))}")
