"""Tables of collisions: a row each, fragmentation velocities, and Table 1 of the clusters."""

import numpy as np
import pandas as pd

from ratd.base.materials import sphere_mass
from ratd.experiments.collision.files import SERIES
from ratd.experiments.collision.fragmentation import (
    agglomeration,
    fragmentation_number,
    fragmentation_velocity,
    mean_over_samples,
)
from ratd.experiments.collision.likeness import is_equal, likeness_table
from ratd.experiments.collision.sticking import breaking_energy_of, sticking_velocity
from ratd.pipeline import io
from ratd.pipeline.blocks import material_of, rows
from ratd.pipeline.kinds import Kind, as_dataset, entries, register

__all__ = [
    "EARLY",
    "HALF",
    "LARGE",
    "LATE",
    "analyse",
    "cluster_table",
    "collision_table",
    "findings",
    "materials_of_laws",
    "mean_energy",
    "read_collisions",
    "series_of",
    "threshold_error",
    "threshold_table",
]

HALF = 0.5e-6
"""Time [s] at which the energy left is looked at (Fig. 8)."""
EARLY = 0.6e-6
"""Time [s] at which X and N_s are looked at too: long after the passage of the clusters, and too early all the same."""
GRID = 0.2
"""What a fragmentation velocity is uncertain by, over the distance of the two velocities that it lies between: X is no
straight line there."""
LARGE = 0.01
"""Mass of a large piece over that of both clusters."""
LATE = 2.0e-6
"""Time [s] at which X is looked at once more: what comes after it says whether pieces still part."""
REFERENCES = "Umstaetter & Urbassek (2020), A&A 633, A24"

COLUMNS = {
    "law": ("", "name of the law in the config"),
    "cluster": ("", "name of the cluster in the config"),
    "friction": ("", "friction of DMT, or the law"),
    "source": ("", "hash of the source that the collision was computed with"),
    "sample": ("1", "number of the sample"),
    "velocity": ("m s-1", "velocity of one cluster against the other"),
    "impact_parameter": ("1", "impact parameter in the sum of the radii of both clusters"),
    "seed": ("1", "seed of the rotations"),
    "damping_time": ("s", "A of the normal damping of DMT, 0 for another law"),
    "surface_energy": ("J m-2", "surface energy gamma"),
    "second_contact": ("1", "part of the spheres that rolled to a second contact"),
    "n_monomers": ("1", "number of spheres of both clusters"),
    "mean_sphere_radius": ("m", "mean radius of the spheres"),
    "largest_radius": ("m", "radius of the largest sphere"),
    "largest_share": ("1", "its part of the mass of its cluster"),
    "mass": ("kg", "mass of both clusters"),
    "timestep": ("s", "time step"),
    "duration": ("s", "duration"),
    "X": ("1", "X at the end"),
    "N_s": ("1", "N_s at the end"),
    "X_early": ("1", "X at 0.6 us"),
    "N_s_early": ("1", "N_s at 0.6 us"),
    "X_late": ("1", "X at 2 us"),
    "X_rest": ("1", "X of the mass without the largest sphere of each cluster"),
    "N_s_rest": ("1", "N_s of the mass without the largest sphere of each cluster"),
    "n_pieces": ("1", "number of pieces, single spheres included"),
    "n_single": ("1", "number of single spheres"),
    "single_share": ("1", "their part of the mass"),
    "large_share": ("1", "part of the mass in pieces of at least a hundredth of it"),
    "joined": ("1", "1 where the largest spheres of both clusters are in one piece"),
    "energy_half": ("1", "kinetic energy left at 0.5 us, over E_0"),
    "energy_end": ("1", "kinetic energy left at the end, over E_0"),
    "potential_share": ("1", "greatest |potential| over kinetic energy until 0.5 us"),
    "by_damping": ("1", "energy dissipated by the normal damping, over E_0"),
    "by_sliding": ("1", "energy dissipated by sliding, over E_0"),
    "by_rolling": ("1", "energy dissipated by rolling, over E_0"),
    "by_twisting": ("1", "energy dissipated by twisting, over E_0"),
    "balance": ("1", "greatest residual of the balance of energy over E_0"),
}
register("collision_table", Kind("Collisions, a row each", entries(COLUMNS), references=REFERENCES))

THRESHOLDS = {
    "law": ("", "name of the law in the config"),
    "cluster": ("", "name of the cluster in the config"),
    "impact_parameter": ("1", "impact parameter in the sum of the radii of both clusters"),
    "damping_time": ("s", "A of the normal damping of DMT, 0 for another law"),
    "surface_energy": ("J m-2", "surface energy gamma"),
    "friction": ("", "friction of DMT, or the law"),
    "radius": ("m", "radius of the spheres, NaN where they differ"),
    "velocity": ("m s-1", "velocity at which the mean X falls through 0.15"),
    "error": ("m s-1", "its standard error, by bootstrap and by the distance of the velocities that were tried"),
    "low": ("m s-1", "16 % of the bootstrap"),
    "high": ("m s-1", "84 % of the bootstrap"),
    "found": ("1", "part of the bootstrap that has a threshold"),
    "below": ("m s-1", "velocity next below it that was tried"),
    "above": ("m s-1", "velocity next above it that was tried"),
    "slowest": ("m s-1", "least velocity that was tried"),
    "fastest": ("m s-1", "greatest velocity that was tried"),
    "collisions": ("1", "number of collisions"),
    "sticking_velocity": ("m s-1", "greatest velocity at which two spheres stick, NaN where they always do"),
    "energy_per_contact": ("1", "E_0 at the threshold over N E_break, N the spheres of one cluster"),
}
register("collision_thresholds", Kind("Fragmentation velocities", entries(THRESHOLDS), references=REFERENCES))

CLUSTERS = {
    "law": ("", "law under which they came to rest"),
    "cluster": ("", "name of the cluster in the config"),
    "samples": ("1", "number of samples"),
    "n_monomers": ("1", "number of spheres, mean"),
    "n_contacts": ("1", "number of contacts over that of the spheres, mean"),
    "filling_factor": ("1", "phi, mean"),
    "cluster_radius": ("m", "radius R"),
    "mass": ("kg", "mass of a cluster, mean"),
    "largest_radius": ("m", "radius of the largest sphere, mean"),
    "largest_share": ("1", "its part of the mass, mean"),
    "length_46": ("m", "L_4.6 of the samples, mean"),
    "length_5": ("m", "L_5 of the samples, mean"),
}
register("collision_clusters", Kind("Clusters (Table 1)", entries(CLUSTERS), references=REFERENCES))


def read_collisions(paths):
    """Rows of files of collisions with the material of their file, list of (xarray.Dataset, ratd.Material)."""
    found = []
    for path in paths:
        file = io.read(path, "collisions")
        material = material_of(file)
        found += [(row, material) for row in rows(file, "collisions")]
    return found


def materials_of_laws(collisions):
    """Material of collisions (of `read_collisions`) under each law: name of the law -> ratd.Material."""
    return {row["law"].item(): material for row, material in collisions}


def collision_table(collisions):
    """Collisions (of `read_collisions`), a row each, `COLUMNS`, pandas.DataFrame."""
    table = []
    for row, material in collisions:
        energy = row["impact_energy"].item()
        time, moving = row["time"].values, row["kinetic_translation"].values + row["kinetic_spin"].values
        early = time <= HALF
        pieces = row["piece_mass"].values / row["mass"].item()
        values = {name: row[name].item() for name in COLUMNS if name in row.variables}
        values |= {
            "surface_energy": material.surface_energy,
            "single_share": row["single_mass"].item() / row["mass"].item(),
            "large_share": pieces[pieces >= LARGE].sum(),
            "energy_half": np.interp(HALF, time, moving) / energy if time[-1] >= HALF else np.nan,
            "energy_end": moving[-1] / energy,
            **{name: np.interp(then, time, part) if time[-1] >= then else np.nan for name, then, part in _then(row)},
            "potential_share": np.max(np.abs(row["stored"].values[early]) / moving[early]),
            **{f"by_{way}": row[f"dissipated_{way}"].values[-1] / energy for way in _WAYS},
        }
        table.append(values)
    return pd.DataFrame(table, columns=list(COLUMNS))


def _then(row):
    """X and N_s of one collision against time, with the column that they are for, and its time [s]."""
    masses = row["mass_1"].values, row["mass_2"].values, row["mass"].item()
    yield "X_early", EARLY, agglomeration(*masses)
    yield "N_s_early", EARLY, fragmentation_number(*masses)
    yield "X_late", LATE, agglomeration(*masses)


_WAYS = ("damping", "sliding", "rolling", "twisting")


def series_of(paths, choose):
    """`SERIES` of the collisions of some files, list of (dict of the row, pandas.DataFrame).

    Parameters
    ----------
    paths : list of path-like
    choose : callable
        Of a row, whether it is wanted.
    """
    return [
        (
            {name: row[name].item() for name in row.variables if row[name].ndim == 0},
            pd.DataFrame({name: row[name].values for name in (*SERIES, "n_contacts", "n_pieces_then")}),
        )
        for row, _ in read_collisions(paths)
        if choose(row)
    ]


def mean_energy(series):
    """Time [s], mean kinetic energy over E_0 and its standard error of some collisions of the same records."""
    energies = [(s["kinetic_translation"] + s["kinetic_spin"]).to_numpy() / row["impact_energy"] for row, s in series]
    samples = [row.get("sample", 0) for row, _ in series]
    return series[0][1]["time"].to_numpy(), *mean_over_samples(np.array(energies), samples)


def threshold_error(threshold):
    """Standard error of a `fragmentation_velocity` [m/s], with what the distance of the velocities leaves open."""
    return np.hypot(threshold["error"], GRID * (threshold["above"] - threshold["below"]))


def threshold_table(table, materials, samples=2000):
    """Fragmentation velocities of all laws, clusters and impact parameters of a table.

    Parameters
    ----------
    table : pandas.DataFrame
        From `collision_table`.
    materials : dict of str to ratd.Material
        Name of a law -> material under it.
    samples : int
        Of the bootstrap.

    Returns
    -------
    pandas.DataFrame
        `THRESHOLDS`.
    """
    found = []
    for names, part in table.groupby(["law", "cluster", "impact_parameter"], sort=False):
        threshold = fragmentation_velocity(part, samples=samples)
        one = part.iloc[0]
        equal = is_equal(one)
        radius = one["largest_radius"] if equal else np.nan
        row = dict(zip(("law", "cluster", "impact_parameter"), names, strict=True)) | {
            name: one[name] for name in ("damping_time", "surface_energy", "friction")
        }
        row |= {"radius": radius, **threshold, "slowest": part["velocity"].min(), "fastest": part["velocity"].max()}
        row["error"] = threshold_error(threshold)
        row |= {"collisions": len(part), "sticking_velocity": np.nan, "energy_per_contact": np.nan}
        if equal:
            material = materials[one["law"]]
            mass = sphere_mass(radius, material.density)
            if one["damping_time"] > 0.0:
                stick = sticking_velocity(radius, radius, material, one["damping_time"])
                row["sticking_velocity"] = stick if np.isfinite(stick) else np.nan
            # E_0/N = m v^2/4, m the mass of a sphere
            energy = 0.25 * mass * threshold["velocity"] ** 2
            row["energy_per_contact"] = energy / breaking_energy_of(radius, radius, material)
        found.append(row)
    return pd.DataFrame(found, columns=list(THRESHOLDS))


def cluster_table(paths):
    """Table 1: what the clusters of some files are, `CLUSTERS`, pandas.DataFrame.

    The file says the law in the name of its folder.
    """
    found = []
    for path in paths:
        file = io.read(path, "built_clusters")
        mean = {name: float(np.mean(file[name].values)) for name in CLUSTERS if name in file.variables}
        mean["n_contacts"] = float(np.mean(file["n_contacts"].values / file["n_monomers"].values))
        names = {"law": str(path).split("/")[-2], "cluster": file.attrs["cluster"], "samples": file.sizes["row"]}
        found.append(names | mean)
    return pd.DataFrame(found, columns=list(CLUSTERS))


def findings(files, settings, say):
    """Tables of a job of the pipeline that follow from collisions alone: collisions, thresholds, likeness."""
    collisions = read_collisions(files["runs"])
    table = collision_table(collisions)
    thresholds = threshold_table(table, materials_of_laws(collisions), settings["bootstrap"])
    say(f"{len(table)} collisions, {int(thresholds['velocity'].notna().sum())} fragmentation velocities")
    tables = {"collision_table": table, "collision_thresholds": thresholds}
    tables["collision_likeness"] = likeness_table(table, min(settings["bootstrap"], 500))
    return _both(tables)


def analyse(files, settings, say):
    """All tables of a job of the pipeline, each as netCDF and CSV."""
    return findings(files, settings, say) | _both({"collision_clusters": cluster_table(files["clusters"])})


def _both(tables):
    """Tables as datasets and, under another name, as they are."""
    return {name: as_dataset(one) for name, one in tables.items()} | {f"{n}_csv": one for n, one in tables.items()}
