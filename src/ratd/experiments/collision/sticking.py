"""Two spheres that meet head-on: do they stick, and how fast do they part? The answer that the engine is tested with.

Motion of the overlap delta from first touch, by the normal force of the law of DMT with its damping alone.
"""

import math
from bisect import bisect_left
from functools import cache

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from ratd.base.materials import sphere_mass
from ratd.laws.contact_constants import reduced_radius
from ratd.laws.derjaguin_muller_toporov import (
    adhesion_force,
    breaking_energy,
    equilibrium_overlap,
    hertz_stiffness,
    vibration_period,
)

__all__ = ["breaking_energy_of", "parting_velocity", "sticking_velocity"]

PERIODS = 20.0
"""Periods of the pair after which one that has not parted is held to stick."""


def _pair(a_i, a_j, material):
    """Reduced mass [kg], K [N m^-3/2] and adhesion [N] of two spheres of radii [m]."""
    r = reduced_radius(a_i, a_j)
    m_i, m_j = (sphere_mass(a, material.density) for a in (a_i, a_j))
    adhesion = adhesion_force(r, material.surface_energy)
    return m_i * m_j / (m_i + m_j), hertz_stiffness(r, material.reduced_modulus), adhesion


def breaking_energy_of(a_i, a_j, material):
    """E_break [J] of two spheres of radii [m] at rest, Eq. 2 of Umstaetter & Urbassek (2020)."""
    _, hertz, adhesion = _pair(a_i, a_j, material)
    return breaking_energy(adhesion, equilibrium_overlap(hertz, adhesion))


def parting_velocity(velocity, a_i, a_j, material, damping_time):
    """Velocity [m/s] at which two spheres part that meet head-on with `velocity`; 0 where they stick.

    Parameters
    ----------
    velocity : float
        Of approach at first touch [m/s].
    a_i, a_j : float
        Radii [m].
    material : ratd.Material
    damping_time : float
        A [s].

    Returns
    -------
    float
        Over `velocity` it is the coefficient of restitution.

    Notes
    -----
    m_red d2(delta)/dt2 = -(K (delta^1.5 + A sqrt(delta) d(delta)/dt) - 4 pi gamma R), in units of delta_eq and of the
    time (m_red delta_eq/adhesion)^(1/2), by DOP853 with a relative tolerance of 1e-11.
    """
    mass, hertz, adhesion = _pair(a_i, a_j, material)
    overlap = equilibrium_overlap(hertz, adhesion)
    unit = math.sqrt(mass * overlap / adhesion)
    damping = damping_time / unit

    def force(_, y):
        root = math.sqrt(max(y[0], 0.0))
        return [y[1], 1.0 - root * y[0] - damping * root * y[1]]

    def parted(_, y):
        return y[0]

    parted.terminal, parted.direction = True, -1
    end = PERIODS * vibration_period(mass, hertz, overlap) / unit
    start = [0.0, velocity * unit / overlap]
    # away from the start, where the overlap is 0 too
    first = 1e-6 / max(start[1], 1.0)
    middle = [start[1] * first + 0.5 * first**2, start[1] + first]
    found = solve_ivp(force, (first, end), middle, "DOP853", events=parted, rtol=1e-11, atol=1e-13)
    return float(-found.y_events[0][0][1] * overlap / unit) if len(found.t_events[0]) else 0.0


@cache
def sticking_velocity(a_i, a_j, material, damping_time):
    """Greatest velocity [m/s] at which two spheres that meet head-on stick; inf where always, 0 without damping.

    Notes
    -----
    Close to it they part ever more slowly, which the limit of time would take for sticking; so it is where they part
    with a millionth of the velocity that the energy of the contact would give them.
    """
    if damping_time == 0.0:
        return 0.0
    mass, hertz, adhesion = _pair(a_i, a_j, material)
    overlap = equilibrium_overlap(hertz, adhesion)
    scale = math.sqrt(2.0 * breaking_energy(adhesion, overlap) / mass)
    grid = scale * np.geomspace(0.02, 200.0, 24)

    def parts(v):
        return parting_velocity(v, a_i, a_j, material, damping_time) > 0.0

    if not parts(grid[-1]):
        return math.inf
    # how many of the grid stick: the faster two meet, the sooner they part
    stuck = bisect_left(grid, True, key=parts)
    if stuck == 0:
        return 0.0
    low, high = grid[stuck - 1], grid[stuck]
    return brentq(lambda v: parting_velocity(v, a_i, a_j, material, damping_time) - 1e-6 * scale, low, high, rtol=1e-6)
