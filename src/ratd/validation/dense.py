"""Dense clusters compressed in LAMMPS, and why it presses less there.

A cluster that ratd has compressed is taken as it lies in its box, all springs forgotten, and compressed further by both
codes. Then the same without twisting in either, where both have the same law but for limits that follow the load in
LAMMPS. And in ratd with the limits of LAMMPS, `ratd.laws.jkr_as_in_lammps`, where only the program differs.
"""

import math

import numpy as np

from ratd.aggregates.clusters import grow_bcca
from ratd.aggregates.grain import Grain
from ratd.engine.state import new_state
from ratd.experiments.compression.run import Cluster, compress
from ratd.experiments.compression.static import box_rate
from ratd.experiments.compression.steps import integrators
from ratd.experiments.compression.strain import Parts, strain, strain_dataset
from ratd.experiments.evolve import touching_at_start
from ratd.geometry.box import periodic
from ratd.laws.jkr_as_in_lammps import jkr_as_in_lammps
from ratd.laws.jkr_with_springs import jkr
from ratd.validation.compression import COLUMNS as OF_COMPRESSION
from ratd.validation.compression import bin_edges, case
from ratd.validation.lammps_box import BoxInLammps
from ratd.validation.tables import table_kind

COLUMNS = OF_COMPRESSION | {
    "code": ("", "ratd or LAMMPS; without twisting; or ratd with the limits of LAMMPS"),
    "twisting": ("1", "energy lost by twisting so far over the work of the box; unknown in LAMMPS"),
}
KIND = table_kind("dense", "Dense clusters compressed beside LAMMPS", COLUMNS)
LAWS = {
    "ratd": jkr(),
    "ratd without twisting": jkr(twisting_stiffness=1e-9),
    "ratd with the limits of LAMMPS": jkr_as_in_lammps(),
}
MARGIN = 8.0
"""That of the lists of neighbours in LAMMPS, see `ratd.validation.lammps_box`; dense clusters move less."""


def compute(settings, progress=None):
    """Compress one dense cluster in both codes.

    Parameters
    ----------
    settings : dict
        material, n, seed, strain_rate, from_phi, until_phi, timestep_factor, lammps_step (over t_0).
    progress : callable, optional
        Called with a sentence.

    Returns
    -------
    list of dict
        Rows of `COLUMNS`.
    """
    grain, length, first = _pressed(settings)
    about = Cluster(grain)
    line = {"rolling_pressure": about.rolling_pressure}
    edges = bin_edges(first, settings["until_phi"])
    times = np.log(first / edges[1:]) / (3.0 * box_rate(settings["strain_rate"], about.time_unit))
    rows = []
    for code in (*LAWS, "LAMMPS", "LAMMPS without twisting"):
        follow = _in_ratd if code in LAWS else _in_lammps
        found = follow(code, grain, length, times, settings)
        for phi, (*numbers, twisting) in zip(np.sqrt(edges[1:] * edges[:-1]), found, strict=True):
            rows.append(case(settings, code, line, phi, *numbers) | {"twisting": twisting})
        if progress is not None:
            progress(f"{code}: P = {rows[-1]['pressure']:.3g} Pa at phi = {rows[-1]['phi']:.3g}")
    return rows


def _pressed(settings):
    """The compressed cluster, the edge of its box [m], and its filling factor."""
    cluster = grow_bcca(settings["n"], settings["material"], settings["seed"])
    how = {"law": jkr(), "timestep_factor": settings["timestep_factor"], "long_steps": None, "snapshots": ()}
    run = compress(cluster, settings["strain_rate"], settings["from_phi"], **how)
    grain = Grain(run["position"].values, cluster.radius, cluster.material, seed=settings["seed"])
    return grain, run["box_length"].values[-1, 0].item(), run["phi"].values[-1].item()


def _in_ratd(code, grain, length, times, settings):
    """Pressure, contacts, kinetic energy, time step and what twisting took of the work, of each bin."""
    time_unit = Cluster(grain).time_unit
    integrator, _ = integrators(
        grain.material, grain.radius[0], time_unit, settings["timestep_factor"], None, settings["strain_rate"]
    )
    parts = Parts(LAWS[code], periodic(length, box_rate(settings["strain_rate"], time_unit)), integrator)
    pairs = touching_at_start(grain.position, grain.radius, parts.box)
    state = new_state(grain.position, grain.radius, grain.material, pairs, *parts)
    state, table, _ = strain(state, parts, times)
    run = strain_dataset(state, table, parts)
    kinetic = run["kinetic_translation"] + run["kinetic_spin"]
    twisting = run["dissipated_twisting"] / run["work"]
    for k in range(run.sizes["record"]):
        numbers = (each.item(k) for each in (run["pressure"], run["n_contacts"], kinetic))
        yield *numbers, run.attrs["timestep"], twisting.item(k)


def _in_lammps(code, grain, length, times, settings):
    """The same of LAMMPS."""
    time_unit = Cluster(grain).time_unit
    rate, timestep = box_rate(settings["strain_rate"], time_unit), settings["lammps_step"] * time_unit
    how = {"margin": MARGIN, "twisting": code == "LAMMPS"}
    done = 0
    with BoxInLammps(grain, length, rate, timestep, length * math.exp(rate * times[-1]), **how) as box:
        for time in times:
            steps = box.whole(time)
            pressure = box.advance(steps - done)
            done = steps
            yield pressure, box.contacts(), sum(box.kinetic()), timestep, math.nan
