"""Files of grains as grown: what they hold, and how a grain is written and read.

The pipeline finds the kind ``grains`` here, see `ratd.pipeline.kinds`.
"""

import numpy as np
import xarray as xr

from ratd.aggregates.grain import Grain
from ratd.pipeline import io
from ratd.pipeline.blocks import material_of, rows
from ratd.pipeline.kinds import MATERIAL, ROW, Kind, Variable, over, register, row_sizes

__all__ = ["grain_row", "grains", "read_grains"]

CUT_BOUND = ("rad s-1", "angular velocity up to which the pulls of its contacts hold the grain as it stands")
"""Units and meaning of `ratd.cut_bound` in files."""
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
register(
    "grains",
    Kind(
        "Grains of monomers",
        {
            **MATERIAL,
            "seed": Variable((ROW,), "i8", "1", "seed of the grain"),
            **row_sizes(("monomer",)),
            **over((ROW,), {"a_eff": ("m", "effective radius, (sum of a_i^3)^(1/3)")}),
            **over(
                (ROW,),
                {"n_monomers": ("1", "number of monomers N_mon"), "n_contacts": ("1", "number of contacts N_con")},
                dtype="i8",
            ),
            **over((ROW,), {"mean_monomer_radius": ("m", "mean radius of the monomers <a_mon>")}),
            **over((ROW,), {"enclosing_radius": ("m", "radius of the smallest sphere around all monomers")}),
            **over((ROW,), _SHAPE),
            **over((ROW,), _SHAPE_NAN | _FRACTAL, nan=True),
            **over((ROW,), {"cut_bound": CUT_BOUND}),
            **over(
                ("monomer",),
                {
                    "x": ("m", "position of the centre along x"),
                    "y": ("m", "position of the centre along y"),
                    "z": ("m", "position of the centre along z"),
                    "radius": ("m", "radius of the monomer"),
                },
            ),
        },
        attributes=("material", "type"),
        ragged=("monomer",),
        places=("grains/{material}/{type}/{size}nm/seeds_{seeds}.nc",),
    ),
)


def grain_row(grain, cut_bound):
    """Row of a grain in a file of grains.

    Parameters
    ----------
    grain : Grain
    cut_bound : float
        Angular velocity up to which the pulls of its contacts hold the grain as it stands [rad s-1].

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
        From `ratd.pipeline.io.read`.

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


def read_grains(path):
    """Grains of a file of the pipeline.

    Parameters
    ----------
    path : path-like

    Returns
    -------
    list of ratd.Grain

    Raises
    ------
    FileError
        If there is none, it is damaged, or not one of grains.
    """
    return grains(io.read(path, "grains"))
