"""Every variable of every file that the pipeline writes: dimensions, type, units, meaning.

A file of kind ``grains``, ``spinup`` or ``disruption`` holds one *row* a grain (dimension ``row``). What has another
length for each grain (monomers, records, fragments lost, snapshots) stands one grain after the other along a sample
dimension, as CF-1.11 lays out contiguous ragged arrays: for the sample dimension ``monomer`` the variable
``row_size_monomer(row)``, with the attribute ``sample_dimension``, says how many elements belong to each grain.

Everything is in SI units. A dataset is checked against this registry before it is written and after it was read.
"""

import hashlib
from dataclasses import dataclass

import numpy as np

from ratd.base.errors import FileError
from ratd.experiments.spin_up import (
    calibration,
    composition,
    firm_bound,
    formulae,
    fragmentation,
    grain_table,
    marks,
    pairs,
    parameters,
    records,
)

FORMAT = 1
"""Version of the layout of the files. Raise it when `ratd.pipeline.io` lays out the same variables in another way."""

ROW = "row"
"""Dimension along which the grains of a file stand."""


@dataclass(frozen=True)
class Variable:
    """One variable of a file.

    Parameters
    ----------
    dims : tuple of str
        Dimensions in the file.
    dtype : str
        ``"f8"``, ``"i8"``, ``"i4"``, ``"i1"`` or ``"str"`` (text, UTF-8, in a file an array of characters).
    units : str
        In the notation of UDUNITS, ``"1"`` for pure numbers, ``""`` for text and flags.
    long_name : str
    nan : bool
        Whether NaN (undefined) is allowed.
    flags : tuple of str
        For ``"i1"``: what 0, 1, ... stand for.
    optional : bool
        Whether a file may lack it.
    """

    dims: tuple
    dtype: str
    units: str
    long_name: str
    nan: bool = False
    flags: tuple = ()
    optional: bool = False

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
    """

    title: str
    variables: dict
    attributes: tuple = ()
    ragged: tuple = ()


def _over(dims, table, dtype="f8", **options):
    """Variables with the same dimensions and type from a table of name -> (units, meaning)."""
    return {name: Variable(dims, dtype, units, meaning, **options) for name, (units, meaning) in table.items()}


def _row_sizes(dimensions):
    """The variables that say how many elements along each sample dimension belong to each grain."""
    return {
        f"row_size_{name}": Variable((ROW,), "i8", "1", f"number of elements along {name} that belong to the grain")
        for name in dimensions
    }


MATERIAL = {
    "surface_energy": ("J m-2", "surface energy gamma"),
    "youngs_modulus": ("Pa", "Young's modulus E"),
    "poisson_number": ("1", "Poisson number nu"),
    "density": ("kg m-3", "density rho of the bulk material"),
    "critical_rolling_displacement": ("m", "critical rolling displacement xi_c"),
    "viscous_time": ("s", "viscous time T_vis"),
}
"""Constants of the material, scalars in every file of one material."""

_SHAPE = {
    "moment_1": ("kg m2", "greatest principal moment of inertia I_1 about the centre of mass"),
    "moment_2": ("kg m2", "middle principal moment of inertia I_2"),
    "moment_3": ("kg m2", "least principal moment of inertia I_3"),
}
_SHAPE_NAN = {
    "axis_a": ("m", "shortest semi-axis of the ellipsoid with the same moments of inertia"),
    "axis_b": ("m", "middle semi-axis of the ellipsoid with the same moments of inertia"),
    "axis_c": ("m", "longest semi-axis of the ellipsoid with the same moments of inertia"),
    "porosity": ("1", "porosity P = 1 - a_eff^3/(a b c)"),
}
_FRACTAL = {
    "fractal_dimension": ("1", "fractal dimension D_f from the monomer density against distance"),
    "fractal_dimension_error": ("1", "standard error of the fractal dimension"),
}

_GRAINS_RAGGED = ("monomer",)
_GRAINS = {
    **_over((), MATERIAL),
    "seed": Variable((ROW,), "i8", "1", "seed of the grain"),
    **_row_sizes(_GRAINS_RAGGED),
    **_over((ROW,), {"a_eff": ("m", "effective radius, (sum of a_i^3)^(1/3)")}),
    **_over(
        (ROW,),
        {"n_monomers": ("1", "number of monomers N_mon"), "n_contacts": ("1", "number of contacts N_con")},
        dtype="i8",
    ),
    **_over((ROW,), {"mean_monomer_radius": ("m", "mean radius of the monomers <a_mon>")}),
    **_over((ROW,), {"enclosing_radius": ("m", "radius of the smallest sphere around all monomers")}),
    **_over((ROW,), _SHAPE),
    **_over((ROW,), _SHAPE_NAN | _FRACTAL, nan=True),
    **_over((ROW,), {"cut_bound": ("rad s-1", "angular velocity above which no cut of the grain can hold")}),
    **_over(
        ("monomer",),
        {
            "x": ("m", "position of the centre along x"),
            "y": ("m", "position of the centre along y"),
            "z": ("m", "position of the centre along z"),
            "radius": ("m", "radius of the monomer"),
        },
    ),
}

END_REASONS = ("one contact left", "omega_RAT reached", "max_steps reached")
"""Why a spin-up ended; the flag in a file is the place in this list."""

RUN_VALUES = {
    "seed": Variable((ROW,), "i8", "1", "seed of the grain"),
    "a_eff": Variable((ROW,), "f8", "m", "effective radius of the grain"),
    "steps": Variable((ROW,), "i8", "1", "number of time steps"),
    "timestep": Variable((ROW,), "f8", "s", "first time step"),
    "end_reason": Variable((ROW,), "i1", "", "why the run ended", flags=END_REASONS),
    "angular_acceleration": Variable((ROW,), "f8", "rad s-2", "angular acceleration at the start"),
    "cut_bound": Variable((ROW,), "f8", "rad s-1", "angular velocity above which no cut of the grain can hold"),
    "initial_n_monomers": Variable((ROW,), "i8", "1", "number of monomers after relaxation at rest"),
    "initial_n_contacts": Variable((ROW,), "i8", "1", "number of contacts after relaxation at rest"),
    "initial_mass": Variable((ROW,), "f8", "kg", "mass after relaxation at rest"),
    "initial_axis_a": Variable((ROW,), "f8", "m", "shortest semi-axis after relaxation at rest", nan=True),
    "initial_axis_b": Variable((ROW,), "f8", "m", "middle semi-axis after relaxation at rest", nan=True),
    "initial_axis_c": Variable((ROW,), "f8", "m", "longest semi-axis after relaxation at rest", nan=True),
    "initial_porosity": Variable((ROW,), "f8", "1", "porosity after relaxation at rest", nan=True),
}
"""Numbers of a run, one a grain: attributes of the dataset of a run, variables of the file of a block."""

RUN_SETTINGS = ("material", "type", "drive", "spin_up_law", "epsilon", "coriolis", "damping", "timestep_factor")
"""Attributes of the dataset of a run that are the same for all grains of a block: global attributes of its file."""

_SPINUP_RAGGED = ("record", "fragment", "snapshot", "monomer", "snapshot_monomer")
_SPINUP = {
    **_over((), MATERIAL),
    **RUN_VALUES,
    **_row_sizes(_SPINUP_RAGGED),
    **{
        name: Variable(("record",), dtype, units, meaning, nan=name in _SHAPE_NAN)
        for name, (units, meaning, dtype) in records.RECORDS.items()
    },
    **{
        name: Variable(("fragment",), "i4" if name == "fragment_n_monomers" else "f8", units, meaning)
        for name, (units, meaning) in records.FRAGMENTS.items()
    },
    **_over(("snapshot",), {"snapshot_omega": ("rad s-1", "angular velocity")}),
    **_over(("monomer",), {"monomer_radius": ("m", "radius")}),
    **_over(
        ("snapshot_monomer",),
        {
            "snapshot_x": ("m", "position along x in the turning frame"),
            "snapshot_y": ("m", "position along y in the turning frame"),
            "snapshot_z": ("m", "position along z in the turning frame"),
        },
        nan=True,
    ),
    "snapshot_fragment": Variable(
        ("snapshot_monomer",), "i4", "1", "fragment: 0 the largest, 1, 2, ... others, -1 dropped"
    ),
    "snapshot_normal_force": Variable(
        ("snapshot_monomer",), "f8", "N", "normal force of greatest magnitude on the monomer, > 0 pushing", nan=True
    ),
}
_DISRUPTION = {
    **_over((), MATERIAL),
    **RUN_VALUES,
    **_over((ROW,), marks.VARIABLES, nan=True),
    "missing_marks": Variable((ROW,), "str", "", "marks that the run does not contain, and why"),
}

_TEXT_COLUMNS = ("material", "type", "drive", "end_reason", "missing_marks")


def _column(name, dimension, units, meaning):
    """Variable of a column of the table of all grains."""
    if name in _TEXT_COLUMNS:
        return Variable((dimension,), "str", "", meaning)
    if name == "seed":
        return Variable((dimension,), "i8", units, meaning)
    return Variable((dimension,), "f8", units, meaning, nan=True)


_TABLE = {name: _column(name, "grain", *about) for name, about in grain_table.COLUMNS.items()}

_CELLS = {name: _column(name, "cell", *grain_table.COLUMNS[name]) for name in ("material", "type", "a_eff")}
_CELLS["n_grains"] = Variable(("cell",), "i8", "1", "grains in the cell")
for _name, (_units, _meaning) in grain_table.COLUMNS.items():
    if _name not in (*_TEXT_COLUMNS, "a_eff", "seed"):
        for _statistic in ("mean", "minimum", "maximum"):
            _CELLS[f"{_name}_{_statistic}"] = _column(_name, "cell", _units, f"{_statistic} of: {_meaning}")
        _CELLS[f"{_name}_count"] = Variable(("cell",), "i8", "1", f"grains with a value of: {_meaning}")

_PAIR = ("material", "type")
_FIT = {
    "mean_radius": Variable(("mean_radius",), "str", "", "reading of the mean monomer radius in Eq. 33"),
    "material": Variable(("material",), "str", "", "material of the monomers"),
    "type": Variable(("type",), "str", "", "growth: BA, BAM1 or BAM2"),
    **_over(
        ("mean_radius", *_PAIR),
        {
            "A": ("1", "fit parameter A of Eq. 33"),
            "A_low": ("1", "lower end of the confidence interval of A"),
            "A_high": ("1", "upper end of the confidence interval of A"),
            "alpha": ("1", "fit parameter alpha of Eq. 33"),
            "alpha_low": ("1", "lower end of the confidence interval of alpha"),
            "alpha_high": ("1", "upper end of the confidence interval of alpha"),
            "scatter": ("1", "standard deviation of the residuals of ln omega"),
        },
        nan=True,
    ),
    **_over(_PAIR, {"n_grains": ("1", "grains in the fit"), "n_sizes": ("1", "sizes in the fit")}, dtype="i4"),
    **_over(
        _PAIR,
        {
            "A_printed": ("1", "A as printed in Table 3 of the paper"),
            "alpha_printed": ("1", "alpha as printed in Table 3 of the paper"),
        },
        nan=True,
    ),
}


_FRAGMENTS_RAGGED = ("fragment",)
_FRAGMENTS = {
    **{
        name: Variable(
            (ROW,), "i8" if name == "seed" else "f8" if units else "str", units, meaning, nan=name.endswith("_disr")
        )
        for name, (units, meaning) in fragmentation.COLUMNS.items()
    },
    **_row_sizes(_FRAGMENTS_RAGGED),
    **{
        name: Variable(("fragment",), "i4" if name == "fragment_n_monomers" else "f8", units, meaning)
        for name, (units, meaning) in fragmentation.FRAGMENT_COLUMNS.items()
    },
}


def _entries(columns):
    """Variables of a table that is no ensemble of grains, one a column; text where it has no units."""
    return {
        name: Variable(("entry",), "f8" if units else "str", units, meaning, nan=bool(units))
        for name, (units, meaning) in columns.items()
    }


KINDS = {
    "grains": Kind("Grains of monomers", _GRAINS, ("material", "type"), _GRAINS_RAGGED),
    "spinup": Kind("Spin-up of grains", _SPINUP, RUN_SETTINGS, _SPINUP_RAGGED),
    "disruption": Kind("Disruption of grains", _DISRUPTION, RUN_SETTINGS),
    "table": Kind("All grains of an ensemble", _TABLE),
    "cells": Kind("Grains of an ensemble, averaged per material, type and size", _CELLS),
    "fit": Kind("Fit of Eq. 33 to an ensemble, beside Table 3 of the paper", _FIT, ("drive",)),
    "table1": Kind("Table 1: ratios of elements in co-S", _entries(composition.TABLE_1_COLUMNS)),
    "table2": Kind("Table 2: properties of the materials", _entries(composition.TABLE_2_COLUMNS)),
    "fragments": Kind("Fragments that leave grains", _FRAGMENTS, ("drive",), _FRAGMENTS_RAGGED),
    "parameters": Kind(
        "Grains spun up with other rolling displacements and viscous times", _entries(parameters.PARAMETER_COLUMNS)
    ),
    "calibration": Kind(
        "Onset of mass loss with the literal drive, and the calibrated angular acceleration",
        _entries(calibration.CALIBRATION_COLUMNS) | _over((), calibration.FIT_VALUES, nan=True),
    ),
    "formulae": Kind("Grains spun up with single formulae as printed", _entries(formulae.FORMULA_COLUMNS)),
    "pairs": Kind("Pairs of equal monomers that part", _entries(pairs.PAIR_COLUMNS)),
    "firm_bounds": Kind(
        "Bounds from cuts whose contacts hold sideways and push", _entries(firm_bound.FIRM_BOUND_COLUMNS)
    ),
}
"""Kind of file -> its layout."""


def fingerprint(kind):
    """Hash of the layout of one kind of file: changes when its variables, or `FORMAT`, change.

    Parameters
    ----------
    kind : str
        A key of `KINDS`.

    Returns
    -------
    str
        16 hexadecimal digits.
    """
    layout = KINDS[kind]
    lines = [f"{kind} {FORMAT} {layout.attributes} {layout.ragged}"]
    lines += [f"{name} {variable!r}" for name, variable in layout.variables.items()]
    return hashlib.sha256("\n".join(lines).encode()).hexdigest()[:16]


def check(dataset, kind, where, error=FileError):
    """Raise an error unless a dataset is laid out as its kind of file demands.

    Parameters
    ----------
    dataset : xarray.Dataset
        With all values in memory.
    kind : str
        A key of `KINDS`.
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
    layout = KINDS[kind]
    for name in layout.attributes:
        if name not in dataset.attrs:
            raise error(f"{where}: the attribute {name!r} of a file of {kind} is missing")
    for name in dataset.variables:
        if name not in layout.variables:
            raise error(f"{where}: a file of {kind} has no variable {name!r}")
    for name, variable in layout.variables.items():
        if name not in dataset.variables:
            if variable.optional:
                continue
            raise error(f"{where}: the variable {name!r} of a file of {kind} is missing")
        _check_variable(dataset[name], name, variable, where, error)
    for dimension in layout.ragged:
        sizes = dataset[f"row_size_{dimension}"].values
        if (sizes < 0).any() or sizes.sum() != dataset.sizes[dimension]:
            raise error(
                f"{where}: the row sizes along {dimension!r} add up to {sizes.sum()}, "
                f"but the dimension has {dataset.sizes[dimension]} elements"
            )


def _check_variable(array, name, variable, where, error):
    """Raise an error unless one variable has the dimensions, type, units and values that the registry names."""
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
