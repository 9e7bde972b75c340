"""Energies by mode, and momenta, of all monomers or of the largest fragment."""

import numpy as np

from ratd.base.jit import jit
from ratd.engine.contacts import contact_start
from ratd.engine.forces import contact_forces, working_space
from ratd.engine.layout import (
    CONTACTS, DT_DRIFT, FORCE_ROW, FORCE_X, FORCE_Y, FORCE_Z, INERTIA, INV_INERTIA, INV_MASS, LOST_DAMP, MASS,
    MONOMERS, ROW, TORQUE_X, TORQUE_Y, TORQUE_Z, VX, VY, VZ, WX, WY, WZ, X, Y, Z,
)  # fmt: skip
from ratd.engine.state import copied
from ratd.laws.contact_fields import E_DAMP, E_ROLL, E_SLIDE, E_TWIST

STORED = ("normal", "sliding", "rolling", "twisting")
"""Ways in which contacts store energy."""
DISSIPATED = ("damping", "sliding", "rolling", "twisting", "made", "broken")
"""Ways in which energy is dissipated; by contacts that jump in when they are made, and that break with energy left."""
_ROW = np.uint64(ROW)
_FORCE_ROW = np.uint64(FORCE_ROW)


def in_step(state, law, box, *, kick=True):
    """A copy of a state with everything at the time of its positions.

    In a running state velocities stand half a step behind, and contacts have not followed the last move.

    Parameters
    ----------
    state : State
    law, box : parts
    kick : bool
        Whether to bring the velocities forward. Not after a semi-implicit step: its masses are others, and the motion
        of half a step is little.

    Returns
    -------
    State
        For measuring, not for going on. The half kick knows the contact forces only: in a turning frame use the state.
    """
    state = copied(state)
    half = 0.5 * state.scalar[DT_DRIFT]
    state.force[:] = 0.0
    contact_forces(state, law, box, working_space(), half)
    if kick:
        _kick(state, half, box.rates())
    return state


@jit
def _kick(state, dt, rates):
    for k in range(state.counter[MONOMERS]):
        r = np.uint64(k) * _ROW
        q = np.uint64(k) * _FORCE_ROW
        pull = dt * state.monomer[r + INV_MASS]
        turn = dt * state.monomer[r + INV_INERTIA]
        state.monomer[r + VX] += pull * state.force[q + FORCE_X] - dt * rates[0] * state.monomer[r + VX]
        state.monomer[r + VY] += pull * state.force[q + FORCE_Y] - dt * rates[1] * state.monomer[r + VY]
        state.monomer[r + VZ] += pull * state.force[q + FORCE_Z] - dt * rates[2] * state.monomer[r + VZ]
        state.monomer[r + WX] += turn * state.force[q + TORQUE_X]
        state.monomer[r + WY] += turn * state.force[q + TORQUE_Y]
        state.monomer[r + WZ] += turn * state.force[q + TORQUE_Z]


@jit
def dissipated(state, law):
    """Energies [J] dissipated so far, (6,), in the order of `DISSIPATED`.

    Contacts of all monomers that have not left count, and those that are gone.
    """
    energy = np.empty(6)
    for mode in range(6):
        energy[mode] = state.scalar[LOST_DAMP + mode]
    for k in range(state.counter[CONTACTS]):
        at = contact_start(law, k)
        energy[0] += state.contact[at + E_DAMP]
        energy[1] += state.contact[at + E_SLIDE]
        energy[2] += state.contact[at + E_ROLL]
        energy[3] += state.contact[at + E_TWIST]
    return energy


@jit
def stored(state, law, largest):
    """Potential energies [J] of all contacts, or those of the largest fragment, (4,), in the order of `STORED`."""
    energy = np.zeros(4)
    for k in range(state.counter[CONTACTS]):
        if largest and state.fragment[state.pair_i[k]] != 0:
            continue
        for mode, value in enumerate(law.energies(state.contact, contact_start(law, k))):
            energy[mode] += value
    return energy


@jit
def kinetic(state, omega, largest):
    """Kinetic energies [J] of translation and of spin.

    Parameters
    ----------
    state : State
    omega : float
        Angular velocity [rad/s] about z of the frame of the run; velocities count in the inertial frame.
    largest : bool
        Whether only the largest fragment counts.

    Returns
    -------
    translation, spin : float
    """
    translation = 0.0
    spinning = 0.0
    for k in range(state.counter[MONOMERS]):
        if largest and state.fragment[k] != 0:
            continue
        r = np.uint64(k) * _ROW
        vx = state.monomer[r + VX] - omega * state.monomer[r + Y]
        vy = state.monomer[r + VY] + omega * state.monomer[r + X]
        vz = state.monomer[r + VZ]
        wx = state.monomer[r + WX]
        wy = state.monomer[r + WY]
        wz = state.monomer[r + WZ] + omega
        translation += 0.5 * state.monomer[r + MASS] * (vx * vx + vy * vy + vz * vz)
        spinning += 0.5 * state.monomer[r + INERTIA] * (wx * wx + wy * wy + wz * wz)
    return translation, spinning


@jit
def momenta(state):
    """Momentum [kg m/s] and angular momentum about the origin [kg m2/s] of all monomers, (2, 3)."""
    total = np.zeros((2, 3))
    for k in range(state.counter[MONOMERS]):
        r = np.uint64(k) * _ROW
        m = state.monomer[r + MASS]
        own = state.monomer[r + INERTIA]
        x, y, z = state.monomer[r + X], state.monomer[r + Y], state.monomer[r + Z]
        px, py, pz = m * state.monomer[r + VX], m * state.monomer[r + VY], m * state.monomer[r + VZ]
        total[0, 0] += px
        total[0, 1] += py
        total[0, 2] += pz
        total[1, 0] += y * pz - z * py + own * state.monomer[r + WX]
        total[1, 1] += z * px - x * pz + own * state.monomer[r + WY]
        total[1, 2] += x * py - y * px + own * state.monomer[r + WZ]
    return total
