"""The leapfrog that makes spheres rebound as fast as they should, where a user chooses no step."""

import numpy as np

from ratd.base.materials import sphere_mass
from ratd.engine.layout import DT
from ratd.engine.leapfrog import leapfrog
from ratd.engine.state import new_state
from ratd.geometry.box import open_space
from ratd.laws.contact_constants import reduced_radius
from ratd.laws.derjaguin_muller_toporov import impact_duration
from ratd.laws.dmt_with_friction import DMT
from ratd.laws.jkr_with_springs import JKR

__all__ = ["STEPS_OF_IMPACT", "impact_step", "leapfrog_for"]

HOW = {"timestep_factor": 0.125, "damping": "implicit"}
HOW_OF_DMT = {"timestep_factor": 0.03, "damping": "explicit"}
"""Options of `leapfrog` where none are given. The damping of DMT is strong: implicit it would be too weak by far."""
STEPS_OF_IMPACT = 100
"""Steps that the impact of two spheres takes at the least. With a tenth of them contacts make energy out of nothing at
50 m/s; so many leave the speed of rebound within 5 % of the limit of short steps (docs/model/engine.md)."""


def impact_step(radius, material, speed):
    """The step [s] with which the impact of two equal spheres of a radius [m] takes `STEPS_OF_IMPACT` steps."""
    mass = 0.5 * sphere_mass(radius, material.density)
    duration = impact_duration(mass, reduced_radius(radius, radius), material.reduced_modulus, speed)
    return duration / STEPS_OF_IMPACT


def leapfrog_for(law, radius, materials, velocity, *, timestep=None, timestep_factor=None, damping=None):
    """The leapfrog for some spheres.

    Parameters
    ----------
    law : part
    radius : (n,) array
        Radii [m].
    materials : list of ratd.Material
    velocity : (n, 3) array or None
        At the start [m/s].
    timestep, timestep_factor, damping
        As for `ratd.engine.leapfrog.leapfrog`; None for what is to be chosen. The factor is such that an impact at the
        greatest speed that any two spheres may have against each other takes `STEPS_OF_IMPACT` steps. With a law of
        one's own, whose stiffness is not known, velocities do not count.

    Returns
    -------
    Leapfrog
    """
    how = dict(HOW_OF_DMT if isinstance(law, DMT) else HOW)
    if damping is not None:
        how["damping"] = damping
    if timestep_factor is not None:
        how["timestep_factor"] = timestep_factor
    elif timestep is None and velocity is not None and isinstance(law, DMT | JKR):
        speed = float(np.linalg.norm(np.ptp(velocity, axis=0)))
        if speed > 0.0:
            sizes = {radius.min(), radius.max()}
            parts = [_part_of_impact(a, material, law, speed) for a in sizes for material in materials]
            how["timestep_factor"] = min(how["timestep_factor"], *parts)
    return leapfrog(timestep=timestep, **how)


def _part_of_impact(radius, material, law, speed):
    """The factor of the time of a contact that gives `impact_step`."""
    apart = np.array([[0.0, 0.0, 0.0], [3.0 * radius, 0.0, 0.0]])
    pair = new_state(apart, np.full(2, radius), material, (), law, open_space(), leapfrog(timestep_factor=1.0))
    return impact_step(radius, material, speed) / float(pair.scalar[DT])
