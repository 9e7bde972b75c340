"""A loaded cluster in a box that stays: no energy may come from nowhere, in ratd and in LAMMPS.

A cluster is squeezed a little in a periodic box, so that its contacts carry a load. Then the box stays, and all
velocities and spins are taken away. From here on nothing does work. What the springs hold may become motion, and no
more. In LAMMPS it depends on whether its lists of neighbours are kept, see `ratd.validation.lammps_box`.
"""

import math
from functools import partial

import numpy as np

from ratd.aggregates.clusters import grow_bcca
from ratd.experiments.compression.run import Cluster, compress
from ratd.experiments.compression.static import box_rate
from ratd.experiments.compression.steps import integrators
from ratd.experiments.compression.strain import Parts, state_of, strain, strain_dataset
from ratd.experiments.relax import start_anew
from ratd.geometry.box import periodic
from ratd.geometry.shape import greatest_extent
from ratd.laws.contact_constants import rolling_energy
from ratd.laws.jkr_with_springs import jkr
from ratd.validation.lammps_box import BoxInLammps
from ratd.validation.peer_lammps import version
from ratd.validation.tables import table_kind

COLUMNS = {
    "code": ("", "ratd; LAMMPS, whose lists of neighbours are kept; or LAMMPS anew, whose lists are made anew"),
    "version": ("", "version of LAMMPS"),
    "material": ("", "material"),
    "seed": ("1", "seed of the cluster"),
    "n_monomers": ("1", "monomers"),
    "phi": ("1", "filling factor of the box that stays"),
    "time": ("1", "time since the box stays, over t_0"),
    "kinetic": ("1", "kinetic energy of centres and spins over E_roll"),
    "springs": ("1", "energy that sliding, rolling and twisting hold, over E_roll; unknown in LAMMPS"),
    "gap": ("1", "kinetic + stored + dissipated since the box stays, over E_roll; unknown in LAMMPS"),
    "n_contacts": ("1", "contacts"),
}
KIND = table_kind("box_at_rest", "A loaded cluster in a box at rest", COLUMNS)


def compute(settings, progress=None):
    """Follow one cluster in both codes.

    Parameters
    ----------
    settings : dict
        material, n, seed, strain_rate, squeezed (ratio of the filling factors at the end and the start), duration
        (over t_0), records, timestep_factor, lammps_step (over t_0).
    progress : callable, optional
        Called with a sentence.

    Returns
    -------
    list of dict
        Rows of `COLUMNS`.
    """
    follow = {"ratd": _in_ratd, "LAMMPS": partial(_in_lammps, keep_lists=True)}
    follow["LAMMPS anew"] = partial(_in_lammps, keep_lists=False)
    rows = []
    for code, found in follow.items():
        own = {"code": code, "version": version(), "material": settings["material"], "seed": settings["seed"]}
        rows += [own | {"n_monomers": settings["n"]} | row for row in found(settings)]
        if progress is not None:
            progress(f"{code}: K = {rows[-1]['kinetic']:.3g} E_roll at the end")
    return rows


def _times(settings):
    """Times of the records over t_0."""
    return settings["duration"] * np.arange(1, settings["records"] + 1) / settings["records"]


def _unit(cluster):
    """E_roll of the material as it is [J]."""
    material = cluster.material
    return rolling_energy(0.5 * cluster.radius[0], material.surface_energy, material.critical_rolling_displacement)


def _box(cluster):
    """Edge of the box in which copies of a cluster touch [m], and the filling factor."""
    length = greatest_extent(cluster.position, cluster.radius)
    return length, Cluster(cluster).volume / length**3


def _in_ratd(settings):
    """Rows of ratd without what all of them share."""
    cluster = grow_bcca(settings["n"], settings["material"], settings["seed"])
    law, time_unit = jkr(), Cluster(cluster).time_unit
    how = {"law": law, "timestep_factor": settings["timestep_factor"], "long_steps": None, "snapshots": ()}
    run = compress(cluster, settings["strain_rate"], settings["squeezed"] * _box(cluster)[1], **how)
    integrator, _ = integrators(
        cluster.material, cluster.radius[0], time_unit, settings["timestep_factor"], None, settings["strain_rate"]
    )
    state = state_of(run)
    start_anew(state, law, integrator)
    parts = Parts(law, periodic(run["box_length"].values[-1]), integrator)
    state, table, _ = strain(state, parts, _times(settings) * time_unit)
    found = strain_dataset(state, table, parts)
    unit = _unit(cluster)
    springs = sum(found[f"stored_{mode}"] for mode in ("sliding", "rolling", "twisting"))
    return [
        {
            "phi": found["phi"].item(k),
            "time": found["time"].item(k) / time_unit,
            "kinetic": (found["kinetic_translation"].item(k) + found["kinetic_spin"].item(k)) / unit,
            "springs": springs.item(k) / unit,
            "gap": found["energy_residual"].item(k) / unit,
            "n_contacts": found["n_contacts"].item(k),
        }
        for k in range(found.sizes["record"])
    ]


def _in_lammps(settings, keep_lists):
    """The same of LAMMPS."""
    cluster = grow_bcca(settings["n"], settings["material"], settings["seed"])
    time_unit, unit = Cluster(cluster).time_unit, _unit(cluster)
    length, first = _box(cluster)
    rate = box_rate(settings["strain_rate"], time_unit)
    rows, done = [], 0
    shortest = length * settings["squeezed"] ** (-1.0 / 3.0) if keep_lists else None
    with BoxInLammps(cluster, length, rate, settings["lammps_step"] * time_unit, shortest) as box:
        squeezed = box.whole(-math.log(settings["squeezed"]) / (3.0 * rate))
        box.advance(squeezed)
        box.come_to_rest()
        for time in _times(settings):
            steps = box.whole(time * time_unit)
            box.advance(steps - done)
            done = steps
            row = {"phi": first * settings["squeezed"], "time": time, "kinetic": sum(box.kinetic()) / unit}
            rows.append(row | {"springs": np.nan, "gap": np.nan, "n_contacts": box.contacts()})
    return rows
