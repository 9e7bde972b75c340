"""Tables of a set of compressions, of which figures are drawn: the stage `compression_set` of the pipeline."""

import math

import numpy as np
import xarray as xr

from ratd.aggregates.grain import Grain
from ratd.base.errors import InputError
from ratd.base.statistics import mean_of
from ratd.experiments.compression.files import MONOMER, REFERENCE, RUN, read_cluster, read_runs, runs
from ratd.experiments.compression.grow import grown
from ratd.experiments.compression.strain import LABELS
from ratd.laws.contact_constants import reduced_radius, rolling_energy
from ratd.observables.energy import DISSIPATED, STORED
from ratd.observables.structure import cumulative_number, radius_of_gyration
from ratd.pipeline import io
from ratd.pipeline.blocks import material_of
from ratd.pipeline.kinds import MATERIAL, Kind, Variable, kind_of, over, register
from ratd.pipeline.provenance import together

__all__ = [
    "BIN",
    "DISTANCES",
    "bins",
    "in_bins",
    "joined",
    "nearest_phi",
    "run_set",
    "set_of",
    "snapshots",
    "snapshots_at",
]

BIN = 1.04
"""Ratio of the ends of a bin of the filling factor."""
DISTANCES = np.round(2.0 * 1.12 ** np.arange(44), 3)
"""Distances r/r_0 at which N(<r) is tabulated, from 2 to 262."""
NEAR = 0.03
"""ln phi by which a snapshot may lie beside the filling factor that is asked for."""
OF_RUN = ("phi_start", "static_from", "radius_of_gyration", "rolling_pressure", "strain_rate", "timestep")
GYRATION_SEEDS = 60
"""Clusters that are grown for the mean radius of gyration, which takes far less time than a run."""

_BY_PHI = {
    "pressure": ("Pa", "pressure"),
    **{f"pressure_{name}": ("Pa", f"component {name} of the pressure") for name in LABELS["component"]},
    "n_contacts": ("1", "number of contacts"),
    **{f"stored_{mode}": ("J", f"potential energy of the contacts, {mode}") for mode in STORED},
    **{f"dissipated_{way}": ("J", f"energy dissipated so far, {way}") for way in DISSIPATED},
    "work": ("J", "work of the box so far"),
    "energy_residual": ("J", "what the balance of energy lacks"),
}
SEED, PHI, SNAPSHOT, DISTANCE = "seed_number", "phi_bin", "snapshot", "distance_number"
register(
    "compression_set",
    Kind(
        "Compression of clusters with equal settings and different seeds",
        {
            **MATERIAL,
            **over((SEED,), {"seed": ("1", "seed of the cluster"), "steps": ("1", "number of steps")}, dtype="i8"),
            **over(
                (SEED,), {name: about for name, about in RUN.items() if name not in ("monomer_radius", "time_unit")}
            ),
            **over((PHI,), {"phi": ("1", "filling factor, middle of the bin")}),
            **over((SEED, PHI), _BY_PHI, nan=True),
            **over((SNAPSHOT,), {"snapshot_phi": ("1", "filling factor of the snapshots, as asked for")}),
            **over((DISTANCE,), {"distance": ("1", "distance from the centre of a monomer, over r_0")}),
            **over(
                (SEED, SNAPSHOT, DISTANCE),
                {"number_within": ("1", "mean number of centres within this distance, itself and copies included")},
                nan=True,
            ),
            **over(
                (),
                {
                    "monomer_radius": RUN["monomer_radius"],
                    "time_unit": RUN["time_unit"],
                    "mean_radius": ("m", "mean radius of the monomers"),
                    "mean_square_radius": ("m2", "mean square of the radius"),
                    "mean_square_gyration": ("m2", "mean square of the radius of gyration of such clusters"),
                    "mean_square_gyration_error": ("m2", "its standard error"),
                    "mean_rolling_energy": ("J", "mean over the contacts of the cluster of E_roll"),
                },
            ),
            "n_monomers": Variable((), "i8", "1", "number of monomers"),
        },
        attributes=("material", "law", "integrator", "scheme"),
        references=REFERENCE,
    ),
)
register(
    "compression_snapshots",
    Kind(
        "Snapshots of a cluster in its compression",
        {
            **over((SNAPSHOT,), {"phi": ("1", "filling factor"), "box_length": ("m", "edge of the box")}),
            **over((SNAPSHOT, "monomer"), {axis: MONOMER[axis] for axis in "xyz"}),
            **over(("monomer",), {"radius": MONOMER["radius"]}),
        },
        references=REFERENCE,
    ),
)


def bins(phi):
    """Numbers of the bins of filling factors: ``floor(ln phi/ln BIN)``, negative."""
    return np.floor(np.log(phi) / math.log(BIN) + 1e-9).astype(int)


def shared_bins(table, other):
    """Places, in each of two tables of sets, of the bins that both have, two (k,) arrays."""
    _, *places = np.intersect1d(*(bins(each["phi"].values) for each in (table, other)), return_indices=True)
    return places


def in_bins(run, first, last):
    """Means of a run over bins of the filling factor.

    Parameters
    ----------
    run : xarray.Dataset
        As `ratd.compress` returns it.
    first, last : int
        Numbers of the bins.

    Returns
    -------
    dict of str to (bins,) array
        Pressures are means over the records in a bin, other quantities are those of the first record at or
        above its middle; NaN where the run does not fill the bin.
    """
    number = last - first + 1
    middle = bins(run["phi_mean"].values) - first
    weight = np.bincount(middle[(middle >= 0) & (middle < number)], minlength=number).astype(float)
    weight[weight == 0.0] = np.nan

    def mean(values):
        inside = (middle >= 0) & (middle < number)
        return np.bincount(middle[inside], values[inside], minlength=number) / weight

    found = {"pressure": mean(run["pressure"].values)}
    tensor = run["pressure_tensor"].values
    found |= {f"pressure_{name}": mean(tensor[:, k]) for k, name in enumerate(LABELS["component"])}
    centre = BIN ** (np.arange(first, last + 1) + 0.5)
    nearest = np.clip(np.searchsorted(run["phi"].values, centre), 0, run.sizes["record"] - 1)
    others = [name for name in run.variables if name.startswith(("stored_", "dissipated_"))]
    for name in ("n_contacts", *others, "work", "energy_residual"):
        found[name] = np.where(np.isfinite(weight), run[name].values[nearest], np.nan)
    return found


def set_of(found, clusters):
    """Table of runs that differ in their seeds alone.

    Parameters
    ----------
    found : list of xarray.Dataset
        Runs, as `ratd.compress` returns them.
    clusters : list of Grain
        What was compressed.

    Returns
    -------
    xarray.Dataset
        Of the kind ``compression_set``.
    """
    first = min(bins(run["phi_mean"].values[:1])[0] for run in found)
    last = max(bins(run["phi_mean"].values[-1:])[0] for run in found)
    binned = [in_bins(run, first, last) for run in found]
    table = xr.Dataset({"phi": (PHI, BIN ** (np.arange(first, last + 1) + 0.5))})
    for name in binned[0]:
        table[name] = ((SEED, PHI), np.array([each[name] for each in binned]))
    for name in ("seed", "steps", *OF_RUN):
        table[name] = (SEED, np.array([run.attrs[name] for run in found]))
    kept = found[0].attrs
    table["monomer_radius"], table["time_unit"] = kept["monomer_radius"], kept["time_unit"]
    table["n_monomers"] = kept["n_monomers"]
    radius = np.concatenate([cluster.radius for cluster in clusters])
    table["mean_radius"], table["mean_square_radius"] = radius.mean(), np.mean(radius**2)
    table["mean_rolling_energy"] = np.mean([mean_rolling_energy(cluster) for cluster in clusters])
    material = clusters[0].material
    for name in MATERIAL:
        table[name] = getattr(material, name)
    _add_structure(table, found)
    about = {name: kept[name] for name in ("law", "integrator", "scheme")}
    return table.assign_attrs(material=material.name, **about)


def mean_rolling_energy(cluster: Grain):
    """Mean over the contacts of a cluster of the energy E_roll [J] of rolling by a quarter of a circle."""
    i, j = cluster.contacts.T
    R = reduced_radius(cluster.radius[i], cluster.radius[j])
    own = cluster.material.surface_energy, cluster.material.critical_rolling_displacement
    return float(np.mean(rolling_energy(R, *own)))


def _add_structure(table, found):
    """N(<r) at the snapshots that most runs have, those that a run lacks NaN."""
    rounded = [np.round(run["snapshot_phi"].values, 4) for run in found]
    most = max(rounded, key=len)
    numbers = np.full((len(found), len(most), len(DISTANCES)), np.nan)
    for k, run in enumerate(found):
        for at, phi in enumerate(rounded[k]):
            place = nearest_phi(most, phi)
            length = run["snapshot_box_length"].values[at]
            position = np.ascontiguousarray(run["snapshot_position"].values[at])
            distance = DISTANCES[1.5 * length / run.attrs["monomer_radius"] > DISTANCES]
            within = cumulative_number(position, (length,) * 3, distance * run.attrs["monomer_radius"])
            numbers[k, place, : len(distance)] = within
    table["snapshot_phi"] = (SNAPSHOT, most)
    table["distance"] = (DISTANCE, DISTANCES)
    table["number_within"] = ((SEED, SNAPSHOT, DISTANCE), numbers)


def gyration(settings):
    """Mean square of the radius of gyration [m2] of `GYRATION_SEEDS` clusters grown as settings say, and its error."""
    clusters = (grown(settings, seed) for seed in range(GYRATION_SEEDS))
    return mean_of([radius_of_gyration(cluster.position, cluster.mass) ** 2 for cluster in clusters])


def run_set(files, settings, say):
    """Table of a set from the files of its runs and clusters; the settings are those of the growth."""
    found, clusters = [], []
    for path, cluster in zip(files["runs"], files["clusters"], strict=True):
        file = io.read(path, "compression")
        material = material_of(file)
        run = runs(file)[0]
        found.append(run)
        clusters.append(read_cluster(cluster))
        assert clusters[-1].material == material
    table = set_of(found, clusters)
    table["mean_square_gyration"], table["mean_square_gyration_error"] = gyration(settings)
    say(f"{len(found)} runs of {table['n_monomers'].item()} monomers")
    return {"compression_set": typed(table)}


def joined(one, other):
    """One table of two of the same set, the seeds of both in their order.

    Parameters
    ----------
    one, other : xarray.Dataset
        Of the kind ``compression_set``.

    Returns
    -------
    xarray.Dataset
        Of the same kind.

    Raises
    ------
    InputError
        If the two differ in what all runs of a set share, or have a seed in common.
    """
    shared = [name for name in kind_of("compression_set").attributes if one.attrs[name] != other.attrs[name]]
    for name in (*(n for n in one.variables if not one[n].dims and n != "mean_rolling_energy"), "strain_rate"):
        if not np.isclose(one[name].values.flat[0], other[name].values.flat[0], rtol=1e-9, atol=0.0):
            shared.append(name)
    if shared:
        raise InputError(f"the tables are of different sets: they differ in {', '.join(shared)}.")
    both = sorted({*one["seed"].values.tolist()} & {*other["seed"].values.tolist()})
    if both:
        raise InputError(f"both tables have the seed {both[0]}; each seed may be in one of them.")
    parts = [each.assign_coords({PHI: bins(each["phi"].values)}) for each in (one, other)]
    numbers = np.union1d(parts[0][PHI], parts[1][PHI])
    most = max(one["snapshot_phi"].values, other["snapshot_phi"].values, key=len)
    for k, part in enumerate(parts):
        nearest = [nearest_phi(most, phi) for phi in part["snapshot_phi"].values]
        parts[k] = part.assign_coords({SNAPSHOT: nearest}).reindex({PHI: numbers, SNAPSHOT: range(len(most))})
    of_seeds = [name for name in one.variables if SEED in one[name].dims]
    table = xr.concat([part[of_seeds] for part in parts], SEED).drop_vars([PHI, SNAPSHOT])
    table = table.isel({SEED: np.argsort(table["seed"].values)})
    for name in one.data_vars:
        if not one[name].dims:
            table[name] = one[name]
    n = [each.sizes[SEED] for each in (one, other)]
    table["mean_rolling_energy"] = np.average([each["mean_rolling_energy"] for each in (one, other)], weights=n)
    table["phi"] = (PHI, BIN ** (numbers + 0.5))
    table["snapshot_phi"], table["distance"] = (SNAPSHOT, most), one["distance"]
    shared = {name: one.attrs[name] for name in kind_of("compression_set").attributes}
    return typed(table).assign_attrs(shared | together([one.attrs, other.attrs]))


def typed(table):
    """The same in the types of its kind."""
    for name, variable in kind_of("compression_set").variables.items():
        table[name] = table[name].astype(variable.dtype)
    return table


def nearest_phi(found, phi):
    """Which of some filling factors, (k,), is the nearest to one, in the logarithm."""
    return int(np.argmin(np.abs(np.log(found / phi))))


def snapshots_at(found, wanted):
    """Filling factor -> which of the snapshots found, (k,), was taken there; without those that a run did not pass.

    A run that begins denser has none there, and one takes its snapshots at records, up to `NEAR` beside.
    """
    nearest = {phi: nearest_phi(found, phi) for phi in wanted} if len(found) else {}
    return {phi: at for phi, at in nearest.items() if abs(np.log(found[at] / phi)) < NEAR}


def snapshots(files, settings, say):
    """Positions of one run at some filling factors, wrapped into the box about its middle, of those that it passed."""
    run = read_runs(files["run"])[0]
    wanted = list(snapshots_at(run["snapshot_phi"].values, settings["phi"]).values())
    if not wanted:
        raise InputError(
            f"figure 3: the run has no snapshot at phi = {', '.join(f'{phi:g}' for phi in settings['phi'])}; it goes "
            f"from {run.attrs['phi_start']:.3g} to {run['phi'].values[-1]:.3g}: name other ones in figures.figure3.phi"
        )
    length = run["snapshot_box_length"].values[wanted]
    position = run["snapshot_position"].values[wanted]
    wrapped = position - length[:, None, None] * np.round(position / length[:, None, None])
    table = xr.Dataset({"phi": (SNAPSHOT, run["snapshot_phi"].values[wanted]), "box_length": (SNAPSHOT, length)})
    for k, axis in enumerate("xyz"):
        table[axis] = ((SNAPSHOT, "monomer"), wrapped[:, :, k])
    table["radius"] = ("monomer", run["radius"].values)
    say(f"snapshots at phi = {', '.join(f'{phi:.3g}' for phi in table['phi'].values)}")
    return {"compression_snapshots": table}
