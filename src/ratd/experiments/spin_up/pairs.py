"""Two monomers that are spun up until they part (Fig. 10): by the engine, and the answers that it is compared with."""

import math

import numpy as np
import pandas as pd

from ratd.base.materials import Material, sphere_mass
from ratd.drives.largest import OMEGA
from ratd.drives.rotating import rotating
from ratd.engine.leapfrog import leapfrog
from ratd.engine.state import new_state
from ratd.engine.step import FEW_CONTACTS, run, until
from ratd.experiments.spin_up.printed import PAPER
from ratd.geometry.box import open_space
from ratd.laws.contact_constants import equilibrium_compression, pull_off_force, reduced_radius
from ratd.laws.jkr_with_springs import jkr
from ratd.pipeline.kinds import Kind, as_dataset, entries, register

__all__ = ["PAIR_COLUMNS", "eq35_omega", "force_controlled_omega", "holding_omega", "pairs", "parting_omega", "table"]

PAIR_COLUMNS = {
    "material": ("", "material of both monomers"),
    "start": ("", "damped from equilibrium, or undamped from first touch"),
    "monomer_radius": ("m", "radius of both monomers"),
    "parting_omega": ("rad s-1", "angular velocity at which the pair parts, NaN if it never does"),
    "force_controlled_omega": ("rad s-1", "solution for a force that grows slowly, sqrt(3 pi gamma/(2 m))"),
    "eq35_omega": ("rad s-1", "Eq. 35 of the paper, sqrt(5 pi gamma/(6 m))"),
    "epsilon": ("1", "(d omega/dt)/omega^2"),
    "timestep_factor": ("1", "f in the time step f min(t_dis, t_vel)"),
}
"""Units and meaning of the columns of `pairs`."""
STARTS = ("damped", "undamped")
HIGHEST = 3.0
"""A pair that holds up to so many times the omega that is expected never parts."""


def holding_omega(pull_off, reduced_mass, distance):
    """omega [rad/s] at which the centrifugal force m_red omega^2 d at the distance d [m] is `pull_off` [N]."""
    return math.sqrt(pull_off / (reduced_mass * distance))


def force_controlled_omega(a_1, a_2, material):
    """omega [rad/s] at which the centrifugal force on a pair of radii [m] is the pull-off force.

    m_red omega^2 (a_1 + a_2) = 3 pi gamma R (docs/model/drives.md); for equal monomers sqrt(3 pi gamma/(2 m)).
    """
    m_1, m_2 = (sphere_mass(a, material.density) for a in (a_1, a_2))
    force = pull_off_force(reduced_radius(a_1, a_2), material.surface_energy)
    return holding_omega(force, m_1 * m_2 / (m_1 + m_2), a_1 + a_2)


def eq35_omega(a_1, a_2, material):
    """omega [rad/s] of Eq. 35, which takes the force at the end of the branch, 5/9 of the pull-off force."""
    return math.sqrt(5.0 / 9.0) * force_controlled_omega(a_1, a_2, material)


def parting_omega(a_1, a_2, material, *, epsilon, timestep_factor, damped=True):
    """omega [rad/s] at which a simulated pair parts.

    Parameters
    ----------
    a_1, a_2 : float
        Radii [m].
    material : ratd.Material
    epsilon : float
        (d omega/dt)/omega^2 from half of `force_controlled_omega` on; below, omega grows as in `ratd.drives.rotating`.
    timestep_factor : float
        f of Eq. 31.
    damped : bool
        From equilibrium and with damping; or from first touch, delta = 0, without, so that the pair vibrates.

    Returns
    -------
    float
    """
    expected = force_controlled_omega(a_1, a_2, material)
    overlap = 0.0
    if damped:
        overlap = equilibrium_compression(reduced_radius(a_1, a_2), material.surface_energy, material.reduced_modulus)
    distance = a_1 + a_2 - overlap
    share = a_2**3 / (a_1**3 + a_2**3)
    position = np.array([[-share * distance, 0.0, 0.0], [(1.0 - share) * distance, 0.0, 0.0]])
    law = jkr(damping="viscoelastic" if damped else "none")
    box, integrator = open_space(), leapfrog(timestep_factor=timestep_factor)
    state = new_state(position, np.array([a_1, a_2]), material, np.array([[0, 1]]), law, box, integrator)
    drive = rotating("prescribed", omega_1=0.5 * expected, epsilon=epsilon)
    state, code = run(state, law, drive, box, integrator, until(clock=HIGHEST * expected, fewest_contacts=0))
    return float(state.drive[OMEGA]) if code == FEW_CONTACTS else math.nan


def pairs(material, number, seed, smallest, largest, *, damped, undamped, progress=None):
    """Pairs of equal monomers with random radii, each spun up until it parts (Fig. 10).

    Parameters
    ----------
    material : ratd.Material
    number : int
        How many pairs; the radii are the same for every material.
    seed : int
        Of the radii, drawn evenly from [smallest, largest].
    smallest, largest : float
        Radii [m].
    damped, undamped : dict
        epsilon and timestep_factor of the two starts, see `parting_omega`.
    progress : callable, optional
        Called with a sentence.

    Returns
    -------
    list of dict
        Columns of `PAIR_COLUMNS`, `number` rows for each start.
    """
    radii = np.sort(np.random.Generator(np.random.PCG64(seed)).uniform(smallest, largest, number))
    rows = []
    for start, how in zip(STARTS, (damped, undamped), strict=True):
        for k, a in enumerate(radii):
            rows.append(
                {
                    "material": material.name,
                    "start": start,
                    "monomer_radius": a,
                    "parting_omega": parting_omega(a, a, material, damped=start == "damped", **how),
                    "force_controlled_omega": force_controlled_omega(a, a, material),
                    "eq35_omega": eq35_omega(a, a, material),
                    **how,
                }
            )
            if progress is not None and (k + 1) % 20 == 0:
                progress(f"{start}: {k + 1} of {number} pairs")
    return rows


def table(files, settings, say):
    """The table of the pairs of one material, which the settings (arguments of `pairs`) alone decide."""
    settings = dict(settings)
    rows = pairs(Material(**settings.pop("material")), **settings, progress=say)
    return {"pairs": as_dataset(pd.DataFrame(rows))}


register("pairs", Kind("Pairs of equal monomers that part", entries(PAIR_COLUMNS), references=PAPER))
