"""The compression against LAMMPS: the same cluster in the same shrinking box, pressure and contacts side by side.

LAMMPS shrinks the box by `fix deform` and carries the spheres along (`remap x`), so that its velocities are those
relative to the box, as here. It lacks the drag -H u of the homogeneous equations, which `fix viscous` adds: without it
arms that swing freely have less energy, the more the box has shrunk. What differs stands in
`ratd.validation.peer_lammps`; what it does to dense clusters tells `ratd.validation.dense`. LAMMPS keeps
its lists of neighbours, see `ratd.validation.lammps_box`.
"""

import math

import numpy as np

from ratd.aggregates.clusters import grow_bcca
from ratd.experiments.compression.run import Cluster, compress
from ratd.experiments.compression.static import box_rate
from ratd.laws.jkr_with_springs import jkr
from ratd.validation.lammps_box import BoxInLammps
from ratd.validation.peer_lammps import version
from ratd.validation.tables import table_kind

COLUMNS = {
    "code": ("", "ratd or LAMMPS"),
    "version": ("", "version of LAMMPS"),
    "material": ("", "material"),
    "seed": ("1", "seed of the cluster"),
    "n_monomers": ("1", "monomers"),
    "strain_rate": ("1", "C_v"),
    "timestep": ("s", "time step"),
    "phi": ("1", "filling factor, middle of a bin"),
    "pressure": ("Pa", "pressure, mean over a bin of phi"),
    "line": ("Pa", "P_0 phi^3"),
    "n_contacts": ("1", "contacts at the end of the bin"),
    "kinetic": ("J", "kinetic energy of centres, relative to the box, and spins, at the end of the bin"),
}
KIND = table_kind("compression", "Compression beside LAMMPS", COLUMNS)
STEP = 1.1
"""Ratio of the filling factors of two rows."""


def compute(settings, progress=None):
    """Compress one cluster in both codes.

    Parameters
    ----------
    settings : dict
        material, n, seed, strain_rate, until_phi, timestep_factor, lammps_step (over t_0).
    progress : callable, optional
        Called with a sentence.

    Returns
    -------
    list of dict
        Rows of `COLUMNS`.
    """
    cluster = grow_bcca(settings["n"], settings["material"], settings["seed"])
    # as LAMMPS does it: every step short, and the damping that goes with the contact radius
    how = {"law": jkr(), "timestep_factor": settings["timestep_factor"], "long_steps": None, "snapshots": ()}
    run = compress(cluster, settings["strain_rate"], settings["until_phi"], **how)
    edges = bin_edges(run.attrs["phi_start"], settings["until_phi"])
    rows = [
        case(settings, "ratd", run.attrs, *numbers)
        for numbers in zip(*_binned(run, edges), [run.attrs["timestep"]] * (len(edges) - 1), strict=True)
    ]
    if progress is not None:
        progress("ratd: done")
    timestep = settings["lammps_step"] * Cluster(cluster).time_unit
    length = run["box_length"].values[0, 0] * (run["phi"].values[0] / run.attrs["phi_start"]) ** (1.0 / 3.0)
    for numbers in in_lammps(cluster, length, settings["strain_rate"], edges, timestep):
        rows.append(case(settings, "LAMMPS", run.attrs, *numbers, timestep))
        if progress is not None:
            progress(f"LAMMPS: phi = {numbers[0]:.3g}, P = {numbers[1]:.3g} Pa")
    return rows


def bin_edges(first, last):
    """Filling factors between the rows, evenly spaced in the logarithm."""
    return np.geomspace(first, last, math.ceil(math.log(last / first) / math.log(STEP)) + 1)


def _binned(run, edges):
    """Middles, mean pressures, last contacts and last kinetic energies of bins of a run."""
    last = run["phi"].values
    # ln phi grows evenly in time; a record may lie in two bins
    end = np.concatenate([[0.0], np.log(last / edges[0])])
    impulse = np.concatenate([[0.0], np.cumsum(run["pressure"].values * np.diff(end))])
    bounds = np.minimum(np.log(edges / edges[0]), end[-1])
    pressure = np.diff(np.interp(bounds, end, impulse)) / np.diff(bounds)
    at = np.clip(np.searchsorted(last, edges[1:] * (1.0 - 1e-9)), 0, len(last) - 1)
    kinetic = (run["kinetic_translation"] + run["kinetic_spin"]).values
    return np.sqrt(edges[1:] * edges[:-1]), pressure, run["n_contacts"].values[at], kinetic[at]


def case(settings, code, about, phi, pressure, n_contacts, kinetic, timestep):
    """A row of `COLUMNS`; `about` has the ``rolling_pressure``."""
    line = about["rolling_pressure"] * phi**3
    own = {"code": code, "version": version(), "material": settings["material"], "seed": settings["seed"]}
    own |= {"n_monomers": settings["n"], "strain_rate": settings["strain_rate"], "timestep": timestep}
    found = {"phi": phi, "pressure": pressure, "line": line, "n_contacts": n_contacts, "kinetic": kinetic}
    return own | found


def in_lammps(cluster, length, strain_rate, edges, timestep):
    """Compress a cluster of equal monomers in LAMMPS.

    Parameters
    ----------
    cluster : Grain
    length : float
        Edge of the box at the start [m].
    strain_rate : float
        C_v.
    edges : (m,) array
        Filling factors between the rows; the first is that of the start.
    timestep : float
        [s]

    Yields
    ------
    phi, pressure, n_contacts, kinetic : float, float, int, float
        Middle of a bin, mean pressure [Pa] in it, contacts and kinetic energy [J] at its end.
    """
    rate = box_rate(strain_rate, Cluster(cluster).time_unit)
    with BoxInLammps(cluster, length, rate, timestep, length * (edges[0] / edges[-1]) ** (1.0 / 3.0)) as box:
        done = 0
        for low, high in zip(edges[:-1], edges[1:], strict=True):
            steps = box.whole(math.log(edges[0] / high) / (3.0 * rate))
            pressure = box.advance(steps - done)
            done = steps
            yield math.sqrt(low * high), pressure, box.contacts(), sum(box.kinetic())
