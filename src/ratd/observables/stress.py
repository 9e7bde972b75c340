"""Stresses and forces of contacts."""

import math

import numpy as np

from ratd.base.jit import jit
from ratd.engine.contacts import contact_start
from ratd.engine.layout import (
    CONTACTS, FORCE_ROW, FORCE_X, FORCE_Y, FORCE_Z, MONOMERS, RADIUS, ROW, TORQUE_X, TORQUE_Y, TORQUE_Z,
)  # fmt: skip
from ratd.laws.contact_fields import NORMAL

_ROW = np.uint64(ROW)
_FORCE_ROW = np.uint64(FORCE_ROW)


@jit
def contact_stress(state, law, k):
    """|F_N|/(pi r^2) [Pa] of contact k, r being the radius of the contact area."""
    at = contact_start(law, k)
    return abs(state.contact[at + NORMAL]) / (math.pi * law.contact_radius(state.contact, at) ** 2)


@jit
def total_stress(state, law):
    """sigma_Sigma [Pa]: sum of |F_N|/(pi r^2) over the contacts of the largest fragment (Eq. 32 of Reissl et al.)."""
    stress = 0.0
    for k in range(state.counter[CONTACTS]):
        if state.fragment[state.pair_i[k]] == 0:
            stress += contact_stress(state, law, k)
    return stress


@jit
def extreme_normal_force(state, law):
    """For each monomer that is left the normal force [N] of greatest magnitude, > 0 pushing, < 0 pulling; 0 if none."""
    extreme = np.zeros(state.counter[MONOMERS])
    for k in range(state.counter[CONTACTS]):
        normal = state.contact[contact_start(law, k) + NORMAL]
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
