"""What is recorded of a state."""

import math

import numpy as np

from ratd.base.jit import jit
from ratd.engine.contacts import contact_energies, contact_start
from ratd.engine.layout import (
    FORCE_ROW, FORCE_X, FORCE_Y, FORCE_Z, TORQUE_X, TORQUE_Y, TORQUE_Z,
    CONTACTS, DRIVEN, E_DAMP, E_ROLL, E_SLIDE, E_TWIST, INERTIA, INV_AREA, LARGEST_MONOMERS, LOST_CONTACT, LOST_DAMP,
    LOST_ROLL, LOST_SLIDE, LOST_TWIST, MASS, MONOMERS, NORMAL, OMEGA, RADIUS, ROW, S, VX, VY, VZ, WX, WY, WZ, X, Y, Z,
)  # fmt: skip
from ratd.geometry.shape import shape_of

_ROW = np.uint64(ROW)
_FORCE_ROW = np.uint64(FORCE_ROW)


@jit
def contact_stress(state, k):
    """|F_N|/(pi r^2) [Pa] of contact k."""
    at = contact_start(k)
    x = state.contact[at + S] ** 2
    return abs(state.contact[at + NORMAL]) * state.contact[at + INV_AREA] / (x * x)


@jit
def total_stress(state):
    """sigma_Sigma [Pa]: sum over the contacts of the largest fragment of |F_N|/(pi r^2), Eq. 32."""
    stress = 0.0
    for k in range(state.counter[CONTACTS]):
        if state.fragment[state.pair_i[k]] == 0:
            stress += contact_stress(state, k)
    return stress


@jit
def dissipated(state):
    """Energies [J] dissipated so far by sliding, rolling, twisting, damping, and contacts made and broken, (5,).

    Contacts of all monomers that have not left count, and those that are gone.
    """
    energy = np.empty(5)
    energy[0] = state.scalar[LOST_SLIDE]
    energy[1] = state.scalar[LOST_ROLL]
    energy[2] = state.scalar[LOST_TWIST]
    energy[3] = state.scalar[LOST_DAMP]
    energy[4] = state.scalar[LOST_CONTACT]
    for k in range(state.counter[CONTACTS]):
        at = contact_start(k)
        energy[0] += state.contact[at + E_SLIDE]
        energy[1] += state.contact[at + E_ROLL]
        energy[2] += state.contact[at + E_TWIST]
        energy[3] += state.contact[at + E_DAMP]
    return energy


@jit
def kinetic_energy(state, k):
    """Kinetic energy [J] of monomer k in the inertial frame, of its velocity and of its spin, (2,)."""
    omega = state.scalar[OMEGA]
    r = np.uint64(k) * _ROW
    vx = state.monomer[r + VX] - omega * state.monomer[r + Y]
    vy = state.monomer[r + VY] + omega * state.monomer[r + X]
    vz = state.monomer[r + VZ]
    wx = state.monomer[r + WX]
    wy = state.monomer[r + WY]
    wz = state.monomer[r + WZ] + omega
    return (
        0.5 * state.monomer[r + MASS] * (vx * vx + vy * vy + vz * vz),
        0.5 * state.monomer[r + INERTIA] * (wx * wx + wy * wy + wz * wz),
    )


@jit
def stored_energy(state):
    """Kinetic energy in the inertial frame and potential energy of the contacts, of the largest fragment [J].

    The velocities stand half a step behind the positions, which makes the kinetic energy wrong by the order of
    dt times the power of the forces.
    """
    kinetic = 0.0
    for k in range(state.counter[MONOMERS]):
        if state.fragment[k] == 0:
            moving, spinning = kinetic_energy(state, k)
            kinetic += moving
            kinetic += spinning
    potential = 0.0
    for k in range(state.counter[CONTACTS]):
        if state.fragment[state.pair_i[k]] == 0:
            normal, sliding, rolling, twisting = contact_energies(state, k)
            potential += normal + sliding + rolling + twisting
    return kinetic, potential


@jit
def largest_fragment(state):
    """Positions (m, 3) [m], masses (m,) [kg] and radii (m,) [m] of the largest fragment."""
    members = state.counter[LARGEST_MONOMERS]
    position = np.empty((members, 3))
    mass = np.empty(members)
    radius = np.empty(members)
    at = 0
    for k in range(state.counter[MONOMERS]):
        r = np.uint64(k) * _ROW
        if state.monomer[r + DRIVEN] > 0.0:
            position[at, 0] = state.monomer[r + X]
            position[at, 1] = state.monomer[r + Y]
            position[at, 2] = state.monomer[r + Z]
            mass[at] = state.monomer[r + MASS]
            radius[at] = state.monomer[r + RADIUS]
            at += 1
    return position, mass, radius


@jit
def fragment_shape(state, density):
    """Mass [kg], semi-axes a, b, c [m] and porosity of the largest fragment."""
    position, mass, radius = largest_fragment(state)
    a, b, c, porosity = shape_of(position, mass, radius, density)
    return mass.sum(), a, b, c, porosity


@jit
def extreme_normal_force(state):
    """For each monomer that is left the normal force [N] of greatest magnitude, > 0 pushing, < 0 pulling; 0 if none."""
    extreme = np.zeros(state.counter[MONOMERS])
    for k in range(state.counter[CONTACTS]):
        normal = state.contact[contact_start(k) + NORMAL]
        for member in (state.pair_i[k], state.pair_j[k]):
            if abs(normal) > abs(extreme[member]):
                extreme[member] = normal
    return extreme


@jit
def greatest_residual(state):
    """Greatest net force [N] on any monomer and greatest net torque over its radius [N], as left in `state.force`."""
    greatest = 0.0
    for k in range(state.counter[MONOMERS]):
        q = np.uint64(k) * _FORCE_ROW
        a = state.monomer[np.uint64(k) * _ROW + RADIUS]
        f = state.force[q + FORCE_X] ** 2 + state.force[q + FORCE_Y] ** 2 + state.force[q + FORCE_Z] ** 2
        t = state.force[q + TORQUE_X] ** 2 + state.force[q + TORQUE_Y] ** 2 + state.force[q + TORQUE_Z] ** 2
        greatest = max(greatest, max(f, t / (a * a)))
    return math.sqrt(greatest)
