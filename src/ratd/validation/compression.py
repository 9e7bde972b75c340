"""The compression against LAMMPS: the same cluster in the same shrinking box, pressure and contacts side by side.

LAMMPS shrinks the box by `fix deform` and carries the spheres along (`remap x`), so that its velocities are those
relative to the box, as here. The drag -H u of the homogeneous equations is missing there; it acts over a time of
1/(2 C_v) t_0, in which damping and friction have long taken what moves. What else differs stands in
`ratd.validation.peer_lammps.DIFFERENCES`: the limits of sliding, rolling and twisting grow with the load, and a contact
ends at the greatest pull.
"""

import math

import numpy as np

from ratd.aggregates.clusters import grow_bcca
from ratd.base.materials import get_material
from ratd.experiments.compression.run import Cluster, compress
from ratd.experiments.compression.static import box_rate
from ratd.laws.jkr_with_springs import jkr
from ratd.validation.peer_lammps import load, pair_coefficients, version
from ratd.validation.tables import table_kind

COLUMNS = {
    "code": ("", "ratd or LAMMPS"),
    "version": ("", "version of LAMMPS"),
    "material": ("", "material"),
    "seed": ("1", "seed of the cluster"),
    "n_monomers": ("1", "monomers"),
    "strain_rate": ("1", "C_v"),
    "timestep": ("s", "time step"),
    "phi": ("1", "filling factor"),
    "pressure": ("Pa", "pressure, mean over a bin of phi"),
    "line": ("Pa", "P_0 phi^3"),
    "n_contacts": ("1", "contacts at the end of the bin"),
}
KIND = table_kind("compression", "Compression beside LAMMPS", COLUMNS)
STEP = 1.1
"""Ratio of the filling factors of two rows."""
SKIN = 0.2
"""Skin of the neighbour list over the radius."""

WINDOW = 200
"""Steps of LAMMPS between two means of the pressure, which are then averaged."""

_COMMANDS = """
units si
atom_style sphere
atom_modify map array
boundary p p p
newton off
comm_modify vel yes cutoff {cutoff}
region world block {low} {high} {low} {high} {low} {high}
create_box 1 world
"""
_SETTINGS = """
pair_style granular
pair_coeff 1 1 {models}
neighbor {skin} bin
neigh_modify every 1 delay 0 check yes
timestep {timestep}
compute pressure all pressure NULL virial
compute vector all pair/local p10 p11 p12
fix move all nve/sphere
fix shrink all deform 1 x trate {rate} y trate {rate} z trate {rate} remap x
thermo 2000000000
"""


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
    edges = _edges(run.attrs["phi_start"], settings["until_phi"])
    rows = [
        _case(settings, "ratd", run.attrs, *numbers)
        for numbers in zip(*_binned(run, edges), [run.attrs["timestep"]] * (len(edges) - 1), strict=True)
    ]
    if progress is not None:
        progress("ratd: done")
    timestep = settings["lammps_step"] * Cluster(cluster).time_unit
    length = run["box_length"].values[0, 0] * (run["phi"].values[0] / run.attrs["phi_start"]) ** (1.0 / 3.0)
    for numbers in in_lammps(cluster, length, settings["strain_rate"], edges, timestep):
        rows.append(_case(settings, "LAMMPS", run.attrs, *numbers, timestep))
        if progress is not None:
            progress(f"LAMMPS: phi = {numbers[0]:.3g}, P = {numbers[1]:.3g} Pa")
    return rows


def _edges(first, last):
    """Filling factors between the rows, evenly spaced in the logarithm."""
    return np.geomspace(first, last, math.ceil(math.log(last / first) / math.log(STEP)) + 1)


def _binned(run, edges):
    """Middles, mean pressures and last contacts of bins of a run."""
    phi, last = run["phi_mean"].values, run["phi"].values
    place = np.clip(np.searchsorted(edges, phi) - 1, 0, len(edges) - 2)
    number = np.bincount(place, minlength=len(edges) - 1)
    pressure = np.bincount(place, run["pressure"].values, minlength=len(edges) - 1) / number
    at = np.clip(np.searchsorted(last, edges[1:] * (1.0 - 1e-9)), 0, len(last) - 1)
    return np.sqrt(edges[1:] * edges[:-1]), pressure, run["n_contacts"].values[at]


def _case(settings, code, about, phi, pressure, n_contacts, timestep):
    line = about["rolling_pressure"] * phi**3
    own = {"code": code, "version": version(), "material": settings["material"], "seed": settings["seed"]}
    own |= {"n_monomers": settings["n"], "strain_rate": settings["strain_rate"], "timestep": timestep}
    return own | {"phi": phi, "pressure": pressure, "line": line, "n_contacts": n_contacts}


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
    phi, pressure, n_contacts : float, float, int
        Middle of a bin, mean pressure [Pa] in it, contacts at its end.
    """
    material = get_material(cluster.material)
    radius = float(cluster.radius[0])
    n = cluster.n_monomers
    rate = box_rate(strain_rate, Cluster(cluster).time_unit)
    words = pair_coefficients(radius, radius, material)
    models = " ".join(f"{name} " + " ".join(f"{value:.17g}" for value in words[name]) for name in words)
    spheres = load()(cmdargs=["-log", "none", "-screen", "none"])
    say = spheres.commands_string
    middle = 0.5 * (cluster.position.max(axis=0) + cluster.position.min(axis=0))
    try:
        say(_COMMANDS.format(low=-0.5 * length, high=0.5 * length, cutoff=2.5 * radius))
        numbers = np.arange(1, n + 1)
        spheres.create_atoms(n, numbers.tolist(), [1] * n, np.ravel(cluster.position - middle).tolist())
        for name, value in (("radius", radius), ("rmass", cluster.mass[0])):
            spheres.numpy.extract_atom(name)[:n] = value
        say(_SETTINGS.format(models=models, skin=SKIN * radius, timestep=timestep, rate=rate))
        done = 0
        for low, high in zip(edges[:-1], edges[1:], strict=True):
            # the running mean of the fix is told at multiples of WINDOW only
            steps = round(math.log(edges[0] / high) / (3.0 * rate) / timestep / WINDOW) * WINDOW
            say(f"fix mean all ave/time 1 {WINDOW} {WINDOW} c_pressure ave running")
            say(f"run {steps - done} post no")
            pressure = spheres.extract_fix("mean", 0, 0)
            say("unfix mean")
            done = steps
            yield math.sqrt(low * high), pressure, _contacts(spheres)
    finally:
        spheres.close()


def _contacts(spheres):
    """Number of pairs in contact."""
    spheres.commands_string("run 0 post no")
    vector = np.atleast_2d(spheres.numpy.extract_compute("vector", 2, 2))
    return int(np.any(vector != 0.0, axis=1).sum()) if vector.shape[-1] == 3 else 0
