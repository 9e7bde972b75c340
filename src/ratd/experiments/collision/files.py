"""Kinds of files of the collision, and the rows that go into them.

A row of `built_clusters` is one cluster, one of `collisions` one collision. Of the pieces that a collision leaves,
single spheres are only counted. Positions of snapshots are rounded to a nanometre, which is what a picture needs.
"""

import numpy as np
import xarray as xr

from ratd.aggregates.packed_clusters import filling_factor
from ratd.aggregates.grain import Grain
from ratd.aggregates.mrn import sample_length
from ratd.base.materials import sphere_mass
from ratd.base.units import NM
from ratd.experiments.collision.fragmentation import fragmentation
from ratd.geometry.neighbours import close_pairs
from ratd.pipeline import io
from ratd.pipeline.blocks import material_of
from ratd.pipeline.blocks import rows as rows_of
from ratd.pipeline.kinds import MATERIAL, ROW, Kind, Variable, over, register, row_sizes

__all__ = ["SERIES", "cluster_row", "clusters_of", "collision_row", "read_runs", "with_snapshots"]

_REFERENCES = "Umstaetter & Urbassek (2020), A&A 633, A24"

register(
    "built_clusters",
    Kind(
        "Clusters of spheres",
        {
            **MATERIAL,
            **row_sizes(("monomer",)),
            **over(
                (ROW,),
                {
                    "seed": ("1", "number of the sample"),
                    "n_monomers": ("1", "number of spheres"),
                    "n_contacts": ("1", "number of pairs of spheres that overlap"),
                },
                "i8",
            ),
            **over(
                (ROW,),
                {
                    "cluster_radius": ("m", "radius R of the cluster"),
                    "filling_factor": ("1", "phi, sum of r^3 over R^3"),
                    "mass": ("kg", "mass of the cluster"),
                    "largest_radius": ("m", "radius of the largest sphere"),
                    "largest_share": ("1", "its part of the mass"),
                    "length_46": ("m", "L_4.6 of the radii of this sample"),
                    "length_5": ("m", "L_5 of the radii of this sample"),
                },
            ),
            **over(
                ("monomer",),
                {
                    "x": ("m", "position of the centre along x"),
                    "y": ("m", "position of the centre along y"),
                    "z": ("m", "position of the centre along z"),
                    "radius": ("m", "radius of the sphere"),
                },
            ),
        },
        attributes=("material", "cluster"),
        ragged=("monomer",),
        references=_REFERENCES,
    ),
)

SERIES = {
    "time": ("s", "time"),
    "kinetic_translation": ("J", "kinetic energy of the centres"),
    "kinetic_spin": ("J", "kinetic energy of the spins"),
    "stored": ("J", "potential energy of the contacts"),
    "dissipated_damping": ("J", "energy dissipated so far by the normal damping"),
    "dissipated_sliding": ("J", "energy dissipated so far by sliding"),
    "dissipated_rolling": ("J", "energy dissipated so far by rolling"),
    "dissipated_twisting": ("J", "energy dissipated so far by twisting"),
    "dissipated_contacts": ("J", "energy dissipated so far by contacts made and broken"),
    "residual": ("J", "what the balance of energy lacks"),
    "mass_1": ("kg", "mass of the heaviest piece"),
    "mass_2": ("kg", "mass of the second heaviest piece"),
}
"""What a collision has against time: units and meaning."""

ROW_VALUES = {
    "velocity": ("m s-1", "velocity of one cluster against the other"),
    "impact_parameter": ("1", "impact parameter in the sum of the radii of both clusters"),
    "timestep": ("s", "time step"),
    "duration": ("s", "duration"),
    "damping_time": ("s", "A of the normal damping of DMT, 0 for another law"),
    "mass": ("kg", "mass 2 M of both clusters"),
    "impact_energy": ("J", "E_0, kinetic energy at the start"),
    "N_s": ("1", "N_s at the end, Eq. 9"),
    "X": ("1", "X at the end, Eq. 10"),
    "X_rest": ("1", "X of the mass without the largest sphere of each cluster"),
    "N_s_rest": ("1", "N_s of the mass without the largest sphere of each cluster"),
    "mean_sphere_radius": ("m", "mean radius of the spheres"),
    "largest_radius": ("m", "radius of the largest sphere"),
    "largest_share": ("1", "its part of the mass of its cluster"),
    "single_mass": ("kg", "mass of all single spheres at the end"),
    "balance": ("1", "greatest residual of the balance of energy over E_0"),
}
UNKNOWN_OF_FILES = {
    "second_contact": ("1", "part of the spheres that rolled to a second contact when the cluster was built")
}
"""NaN where the cluster was not built here."""
ROW_NUMBERS = {
    "seed": ("1", "seed of the rotations"),
    "sample": ("1", "number of the sample of radii and of the cluster"),
    "n_monomers": ("1", "number of spheres of both clusters"),
    "steps": ("1", "number of time steps"),
    "n_pieces": ("1", "number of pieces at the end, single spheres included"),
    "n_single": ("1", "number of single spheres at the end"),
    "joined": ("1", "1 where the largest spheres of both clusters are in one piece at the end, else 0"),
}
ROW_WORDS = {
    "law": "name of the law in the config",
    "cluster": "name of the cluster in the config",
    "friction": "friction of DMT, or the law",
    "source": "hash of the source that the collision was computed with",
}

register(
    "collisions",
    Kind(
        "Collisions of two clusters",
        {
            **MATERIAL,
            **row_sizes(("record", "piece", "snapshot", "snapshot_monomer", "monomer")),
            **over((ROW,), ROW_NUMBERS, "i8"),
            **over((ROW,), ROW_VALUES),
            **over((ROW,), UNKNOWN_OF_FILES, nan=True),
            **{name: Variable((ROW,), "str", "", meaning) for name, meaning in ROW_WORDS.items()},
            **over(("record",), SERIES),
            **over(
                ("record",),
                {"n_contacts": ("1", "number of contacts"), "n_pieces_then": ("1", "number of pieces")},
                "i8",
            ),
            **over(("piece",), {"piece_mass": ("kg", "mass of a piece of two spheres or more, the heaviest first")}),
            **over(
                ("piece",),
                {"piece_members": ("1", "number of its spheres")},
                "i8",
            ),
            **over(("piece",), {"piece_largest_radius": ("m", "radius of its largest sphere")}),
            **over(("snapshot",), {"snapshot_time": ("s", "time of the snapshot")}),
            **over(
                ("snapshot_monomer",),
                {f"snapshot_{axis}": ("m", f"position along {axis}, to a nanometre") for axis in "xyz"},
            ),
            **over(
                ("snapshot_monomer",),
                {
                    "snapshot_piece": ("1", "number of the piece, 0 the heaviest"),
                },
                "i4",
            ),
            **over(("monomer",), {"radius": ("m", "radius of a sphere of a collision with snapshots")}),
        },
        attributes=("material",),
        ragged=("record", "piece", "snapshot", "snapshot_monomer", "monomer"),
        references=_REFERENCES,
    ),
)


def cluster_row(cluster, cluster_radius, name):
    """Row of one cluster in a file of clusters.

    Parameters
    ----------
    cluster : ratd.Grain
        With the number of the sample as its seed.
    cluster_radius : float
        R [m].
    name : str
        Of the cluster in the config.

    Returns
    -------
    xarray.Dataset
    """
    mass = cluster.mass.sum()
    values = {
        "seed": cluster.seed,
        "n_monomers": cluster.n_monomers,
        "n_contacts": len(close_pairs(cluster.position, cluster.radius, 0.0)),
        "cluster_radius": cluster_radius,
        "filling_factor": filling_factor(cluster.radius, cluster_radius),
        "mass": mass,
        "largest_radius": cluster.radius.max(),
        "largest_share": cluster.mass.max() / mass,
        "length_46": sample_length(cluster.radius, 4.6),
        "length_5": sample_length(cluster.radius, 5.0),
    }
    row = xr.Dataset(values, attrs={"material": cluster.material.name, "cluster": name})
    for axis, coordinate in zip("xyz", cluster.position.T, strict=True):
        row[axis] = ("monomer", coordinate)
    row["radius"] = ("monomer", cluster.radius)
    return row


def clusters_of(dataset):
    """Clusters of a file, dict of sample to `ratd.Grain`."""
    material = material_of(dataset)
    return {
        row["seed"].item(): Grain(
            np.stack([row[axis].values for axis in "xyz"], axis=1),
            row["radius"].values,
            material,
            type="cluster",
            seed=row["seed"].item(),
        )
        for row in rows_of(dataset, "built_clusters")
    }


def collision_row(run, **names):
    """Row of one collision in a file of collisions.

    Parameters
    ----------
    run : xarray.Dataset
        From `ratd.collide`.
    **names
        What the run does not know: sample, law, cluster, friction, damping_time, second_contact, source.

    Returns
    -------
    xarray.Dataset
    """
    found = fragmentation(run)
    several = found["piece_members"].values > 1
    dissipated = {way: run["dissipated"].sel(way=way).values for way in run["way"].values}
    row = xr.Dataset(_values(run, found, several) | names, attrs={"material": run.attrs["material"]})
    series = {
        "stored": run["stored"].sum("storage").values,
        **{f"dissipated_{way}": dissipated[way] for way in ("damping", "sliding", "rolling", "twisting")},
        "dissipated_contacts": dissipated["made"] + dissipated["broken"],
        "mass_1": run["piece_mass"].values[:, 0],
        "mass_2": run["piece_mass"].values[:, 1],
        "n_pieces_then": run["n_pieces"].values,
    }
    for name in (*SERIES, "n_contacts", "n_pieces_then"):
        row[name] = ("record", series[name] if name in series else run[name].values)
    for name in ("piece_mass", "piece_members", "piece_largest_radius"):
        row[name] = ("piece", found[name].values[several])
    if "snapshot_time" in run:
        row["snapshot_time"] = ("snapshot", run["snapshot_time"].values)
        places = np.rint(run["snapshot_position"].values / NM) * NM
        for k, axis in enumerate("xyz"):
            row[f"snapshot_{axis}"] = ("snapshot_monomer", places[:, :, k].ravel())
        row["snapshot_piece"] = ("snapshot_monomer", run["snapshot_piece"].values.ravel())
        row["radius"] = ("monomer", run["radius"].values)
    return row


def read_runs(path):
    """Collisions of a file, list of xarray.Dataset as `collision_row` makes them, see `with_snapshots`."""
    return [with_snapshots(row) for row in rows_of(io.read(path, "collisions"), "collisions")]


def with_snapshots(row):
    """A row whose snapshots lie along ``snapshot`` and ``monomer``, as those of `ratd.collide`, in place of one length.

    Parameters
    ----------
    row : xarray.Dataset
        From `collision_row`, or with its snapshots as they shall be already.

    Returns
    -------
    xarray.Dataset
    """
    n = row.sizes.get("monomer", 0)
    if "snapshot_position" in row or not n:
        return row
    places = np.stack([row[f"snapshot_{axis}"].values for axis in "xyz"], axis=1).reshape(-1, n, 3)
    piece = row["snapshot_piece"]
    about = {"units": "m", "long_name": "position at the snapshot, to a nanometre"}
    row = row.drop_vars([*(f"snapshot_{axis}" for axis in "xyz"), "snapshot_piece"])
    row["snapshot_position"] = (("snapshot", "monomer", "axis"), places, about)
    row["snapshot_piece"] = (("snapshot", "monomer"), piece.values.reshape(-1, n), piece.attrs)
    return row


def _values(run, found, several):
    """The numbers of a row that follow from its run."""
    radius = run["radius"].values
    mass = sphere_mass(radius, run.attrs["density"])
    owner = run["cluster"].values
    largest = [int(np.flatnonzero(owner == own)[np.argmax(radius[owner == own])]) for own in (0, 1)]
    of_both = int(radius.argmax())
    label = run["piece"].values
    rest = mass.copy()
    rest[largest] = 0.0
    first, second = (*np.sort(np.bincount(label, rest))[::-1], 0.0)[:2]
    single = found["piece_members"].values == 1
    return {
        "seed": run.attrs["seed"],
        "n_monomers": len(radius),
        "steps": run.attrs["steps"],
        "n_pieces": len(several),
        "n_single": int(single.sum()),
        "joined": int(label[largest[0]] == label[largest[1]]),
        "velocity": run.attrs["velocity"],
        "impact_parameter": run.attrs["impact_parameter"],
        "timestep": run.attrs["timestep"],
        "duration": float(run["time"].values[-1]),
        "mass": mass.sum(),
        "impact_energy": run.attrs["impact_energy"],
        "N_s": found["N_s"].item(),
        "X": found["X"].item(),
        "X_rest": (first - second) / rest.sum(),
        "N_s_rest": 1.0 - (first + second) / rest.sum(),
        "mean_sphere_radius": radius.mean(),
        "largest_radius": radius[of_both],
        "largest_share": mass[of_both] / mass[owner == owner[of_both]].sum(),
        "single_mass": float(found["piece_mass"].values[single].sum()),
        "balance": run.attrs["balance"],
    }
