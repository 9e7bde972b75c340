"""The contact law of a collision: by name or as it is, its friction, and the step that it allows."""

import numpy as np

from ratd.base.materials import sphere_mass
from ratd.engine.leapfrog import leapfrog
from ratd.engine.state import contact_field, new_state
from ratd.experiments.leapfrog_for import impact_step
from ratd.geometry.box import open_space
from ratd.laws.contact_constants import reduced_radius, touching_distance
from ratd.laws.contact_fields import STEP
from ratd.laws.derjaguin_muller_toporov import adhesion_force, equilibrium_overlap, hertz_stiffness, vibration_period
from ratd.laws.dmt_with_friction import DMT, SPRING, VELOCITY
from ratd.laws.jkr_with_springs import JKR

__all__ = ["BALANCE", "FARTHEST", "SPRING_BALANCE", "balance_of", "contacts_of", "longest_step", "step_of"]

BALANCE, SPRING_BALANCE = 0.01, 0.03
"""Part of the kinetic energy at the start by which the balance of energy may be off. The springs of DMT follow the
radius of the contact and are not exactly conservative."""
PARTS = {"contact": 1 / 16, "period": 1 / 300, "friction": 1 / 15}
"""The step over the shortest time of a contact of the smallest sphere, over the period in which two of them vibrate,
and over the time in which friction follows the rate."""
FARTHEST = 0.02
"""Part of the smallest radius by which the clusters may come nearer in a step: faster ones would pass through each
other without a contact."""
LONGEST_PARTS = {"contact": 1 / 4, "period": 1 / 40, "friction": 1 / 2}
"""Steps beyond are refused: hard impacts and spheres of several contacts shorten the times of a contact at rest."""


def balance_of(law):
    """Part of the kinetic energy at the start by which the balance may be off under a law [1]."""
    return SPRING_BALANCE if isinstance(law, DMT) and law.friction == SPRING else BALANCE


def contacts_of(grain, law):
    """Pairs of spheres of an aggregate in contact under a law, (k, 2) int64 array.

    A contact of JKR holds a little beyond touch, as `Grain.contacts` says; any other ends where the overlap ends.
    """
    if isinstance(law, JKR):
        return grain.contacts
    i, j = grain.contacts.T
    distance = np.linalg.norm(grain.position[i] - grain.position[j], axis=1)
    return grain.contacts[distance <= grain.radius[i] + grain.radius[j]]


def _times(radius, material, law):
    """Times [s] that limit the step: see `PARTS`; those that a law does not have are left out."""
    least, greatest = float(np.min(radius)), float(np.max(radius))
    mass = sphere_mass(least, material.density)
    times = {"contact": np.inf}
    for other in (least, greatest):
        distance = touching_distance(least, other, material.surface_energy, material.reduced_modulus)
        position = np.array([[0.0, 0.0, 0.0], [distance, 0.0, 0.0]])
        pair = np.array([[0, 1]])
        state = new_state(position, np.array([least, other]), material, pair, law, open_space(), leapfrog())
        times["contact"] = min(times["contact"], float(contact_field(state, STEP)[0]))
        if isinstance(law, JKR):
            # its STEP leaves the damping out, which is explicit here
            coefficient = law.damping_coefficient(state.contact, 0)
            times["contact"] = min(times["contact"], mass / max(coefficient, 1e-300))
    if isinstance(law, DMT):
        r = reduced_radius(least, least)
        hertz = hertz_stiffness(r, material.reduced_modulus)
        overlap = equilibrium_overlap(hertz, adhesion_force(r, material.surface_energy))
        times["period"] = float(vibration_period(0.5 * mass, hertz, overlap))
        if law.friction == VELOCITY and law.friction_time > 0.0:
            times["friction"] = law.friction_time
    return times


def step_of(radius, material, law, velocity):
    """Time step [s] for spheres of some radii [m] that meet at a velocity [m/s], with explicit damping."""
    least = float(np.min(radius))
    steps = [PARTS[name] * time for name, time in _times(radius, material, law).items()]
    if isinstance(law, JKR):
        # DMT has its period and its damping, which is strong, in `PARTS`
        steps.append(impact_step(least, material, velocity))
    return min(*steps, FARTHEST * least / velocity)


def longest_step(radius, material, law):
    """Time step [s] beyond which a collision is refused."""
    return min(LONGEST_PARTS[name] * time for name, time in _times(radius, material, law).items())
