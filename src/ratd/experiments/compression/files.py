"""Files of the compression: clusters and runs.

The pipeline finds these kinds here, see `ratd.pipeline.kinds`.
"""

import numpy as np
import xarray as xr

from ratd.aggregates.grain import Grain
from ratd.base.materials import sphere_mass
from ratd.experiments.compression.strain import LABELS, RECORDS
from ratd.experiments.made_with import constants_of
from ratd.observables.structure import radius_of_gyration
from ratd.pipeline import io
from ratd.pipeline.blocks import material_of, rows
from ratd.pipeline.kinds import MATERIAL, ROW, Kind, Variable, over, register, row_sizes

__all__ = [
    "MONOMER",
    "REFERENCE",
    "RUN",
    "cluster_row",
    "read_cluster",
    "read_pulls",
    "read_runs",
    "run_row",
    "runs",
    "stretched_row",
]

REFERENCE = "Kataoka et al. (2013), A&A 554, A4"
MONOMER = {
    "x": ("m", "position of the centre along x"),
    "y": ("m", "position of the centre along y"),
    "z": ("m", "position of the centre along z"),
    "radius": ("m", "radius of the monomer"),
}
RUN = {
    "monomer_radius": ("m", "radius r_0 of the equal monomers, or that of the monomer of mean volume"),
    "time_unit": ("s", "t_0"),
    "rolling_pressure": ("Pa", "P_0 = E_roll/r_0^3"),
    "strain_rate": ("1", "C_v"),
    "timestep": ("s", "time step at the end"),
    "phi_start": ("1", "filling factor at the start"),
    "static_from": ("1", "filling factor from which on the compression is static"),
    "radius_of_gyration": ("m", "radius of gyration of the cluster"),
}
PULL = {
    **{name: RUN[name] for name in ("monomer_radius", "time_unit", "strain_rate")},
    "phi_start": ("1", "filling factor at which the pulling began"),
    "tensile_strength": ("Pa", "greatest tension in a mean over 2 % in length, 0 where there is none"),
    "greatest_record": ("Pa", "greatest tension in a single record"),
    "inertial_tension": ("Pa", "tension by which the inertia of the aggregate resists the growing box"),
    "phi_strength": ("1", "filling factor there, nan where there is no tension"),
    "residual_pressure": ("Pa", "pressure left at rest before the pulling"),
}
register(
    "clusters",
    Kind(
        "Clusters of monomers",
        {
            **MATERIAL,
            "seed": Variable((ROW,), "i8", "1", "seed of the cluster"),
            **row_sizes(("monomer",)),
            **over((ROW,), {"radius_of_gyration": ("m", "radius of gyration")}),
            **over(("monomer",), MONOMER),
        },
        attributes=("material",),
        ragged=("monomer",),
    ),
)


def _record_variables():
    """Variables along ``record`` of a file of runs."""
    found = {}
    for name, (dimension, units, meaning) in RECORDS.items():
        dims = ("record", dimension) if dimension else ("record",)
        found[name] = Variable(dims, "i8" if name == "n_contacts" else "f8", units, meaning)
    return found


register(
    "compression",
    Kind(
        "Clusters compressed in a periodic box",
        {
            **MATERIAL,
            "seed": Variable((ROW,), "i8", "1", "seed of the cluster"),
            **row_sizes(("record", "snapshot", "snapshot_monomer", "monomer")),
            **over((ROW,), {"n_monomers": ("1", "number of monomers"), "steps": ("1", "number of steps")}, dtype="i8"),
            **over((ROW,), RUN),
            **_record_variables(),
            **over(
                ("snapshot",),
                {
                    "snapshot_phi": ("1", "filling factor of the snapshot"),
                    "snapshot_box_length": ("m", "edge of the box at the snapshot"),
                },
            ),
            "snapshot_position": Variable(
                ("snapshot_monomer", "axis"), "f8", "m", "centres at the snapshots, one after the other, not wrapped"
            ),
            **over(("monomer",), {"radius": MONOMER["radius"]}),
        },
        attributes=("material", "law", "integrator", "scheme"),
        ragged=("record", "snapshot", "snapshot_monomer", "monomer"),
        of_row=("seed", "n_monomers", "steps", *RUN),
        references=REFERENCE,
    ),
)
register(
    "stretched",
    Kind(
        "Aggregates compressed to a filling factor and pulled until they come apart",
        {
            **MATERIAL,
            "seed": Variable((ROW,), "i8", "1", "seed of the cluster"),
            **row_sizes(("record",)),
            **over((ROW,), {"n_monomers": ("1", "number of monomers"), "steps": ("1", "number of steps")}, dtype="i8"),
            **over((ROW,), PULL),
            **over((ROW,), {"phi_strength": PULL["phi_strength"]}, nan=True),
            **_record_variables(),
            **over(("record",), {"tension": ("Pa", "tension along the pulled axes")}),
        },
        attributes=("material", "law", "integrator", "axes"),
        ragged=("record",),
        of_row=("seed", "n_monomers", "steps", *PULL),
    ),
)


def cluster_row(grain):
    """Row of a cluster in a file of clusters, xarray.Dataset."""
    row = xr.Dataset(attrs={"material": grain.material.name, "seed": grain.seed})
    row["radius_of_gyration"] = ((), radius_of_gyration(grain.position, grain.mass))
    for axis, coordinate in zip("xyz", grain.position.T, strict=True):
        row[axis] = ("monomer", coordinate)
    row["radius"] = ("monomer", grain.radius)
    return row


def read_cluster(path):
    """The first cluster of a file, `ratd.Grain`; see `ratd.pipeline.io.read` for the errors."""
    file = io.read(path, "clusters")
    row = rows(file, "clusters")[0]
    position = np.stack([row[axis].values for axis in "xyz"], axis=1)
    return Grain(position, row["radius"].values, material_of(file), type="BCCA", seed=row["seed"].item())


def run_row(run):
    """Row of a compression in a file of runs, without the state at its end.

    Parameters
    ----------
    run : xarray.Dataset
        From `ratd.compress`.
    """
    row = xr.Dataset(
        attrs=_kept(run.attrs, {"seed", "n_monomers", "steps", *RUN, "law", "integrator", "scheme", "material"})
    )
    for name in (*RECORDS, "snapshot_phi", "snapshot_box_length", "radius"):
        row[name] = run[name].drop_vars([dim for dim in run[name].dims if dim in LABELS])
    position = run["snapshot_position"]
    row["snapshot_position"] = (("snapshot_monomer", "axis"), position.values.reshape(-1, 3), position.attrs)
    return row


def stretched_row(run):
    """Row of a pull in a file, without the state at its end.

    Parameters
    ----------
    run : xarray.Dataset
        From `ratd.stretch`.
    """
    names = {"seed", "n_monomers", "steps", *PULL, "law", "integrator", "axes", "material"}
    row = xr.Dataset(attrs=_kept(run.attrs, names))
    for name in (*RECORDS, "tension"):
        row[name] = run[name].drop_vars([dim for dim in run[name].dims if dim in LABELS])
    return row


def _kept(attributes, names):
    return {name: value for name, value in attributes.items() if name in names}


def runs(dataset):
    """Runs of a file, list of xarray.Dataset, as `ratd.compress` returns them but for the state at the end."""
    found = []
    for row in rows(dataset, "compression"):
        flat = row["snapshot_position"]
        run = row.drop_vars("snapshot_position")
        shape = row.sizes["snapshot"], row.sizes["monomer"], 3
        run["snapshot_position"] = (("snapshot", "monomer", "axis"), flat.values.reshape(shape), flat.attrs)
        run = _as_returned(run, dataset)
        found.append(run.assign_attrs(mass=float(sphere_mass(run["radius"].values, run.attrs["density"]).sum())))
    return found


def _as_returned(run, file):
    """A run with the labels of its dimensions and the constants of its material, which its file has once."""
    run = run.assign_coords({name: labels for name, labels in LABELS.items() if name in run.dims})
    return run.assign_attrs(constants_of(material_of(file)) | {"source": file.attrs["source"]})


def read_runs(path):
    """Runs of a file, see `runs`."""
    return runs(io.read(path, "compression"))


def read_pulls(path):
    """Pulls of a file, list of xarray.Dataset, as `ratd.stretch` returns them but for the state at the end."""
    file = io.read(path, "stretched")
    return [_as_returned(run, file) for run in rows(file, "stretched")]
