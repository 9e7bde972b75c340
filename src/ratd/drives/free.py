"""Nothing from outside: monomers move by their contacts alone, in open space or in a box."""

import math
from typing import NamedTuple

import numpy as np

from ratd.base.jit import jit
from ratd.base.parts import part
from ratd.engine.layout import (
    FASTEST,
    FORCE_ROW,
    FORCE_X,
    FORCE_Y,
    FORCE_Z,
    INV_INERTIA,
    INV_MASS,
    MONOMERS,
    ROW,
    TORQUE_X,
    TORQUE_Y,
    TORQUE_Z,
    VX,
    VY,
    VZ,
    WX,
    WY,
    WZ,
    X,
    Y,
    Z,
)  # fmt: skip

_ROW = np.uint64(ROW)
_FORCE_ROW = np.uint64(FORCE_ROW)


@part
class Free(NamedTuple):
    """No outer force; made by `free`.

    Attributes
    ----------
    drag : float
        Rate [1/s] at which velocities and spins decay, 0 for none: it brings an aggregate to rest.
    """

    drag: float

    def turning(self):
        return False

    def follow(self, state, changed):
        pass

    def leave(self, state, law):
        return 0

    def sample(self, state, law):
        pass

    def move(self, state, box, kick, dt):
        _move(state, self.drag, kick, dt)


@jit
def _move(state, drag, kick, dt):
    """Kick and drift all monomers, and clear the forces; `FASTEST` is the greatest speed, NaN after a failure."""
    monomer, force = state.monomer, state.force
    keep = math.exp(-drag * kick)
    fastest = 0.0
    total = 0.0
    for k in range(state.counter[MONOMERS]):
        r = np.uint64(k) * _ROW
        q = np.uint64(k) * _FORCE_ROW
        pull = kick * monomer[r + INV_MASS]
        turn = kick * monomer[r + INV_INERTIA]
        vx = keep * (monomer[r + VX] + pull * force[q + FORCE_X])
        vy = keep * (monomer[r + VY] + pull * force[q + FORCE_Y])
        vz = keep * (monomer[r + VZ] + pull * force[q + FORCE_Z])
        wx = keep * (monomer[r + WX] + turn * force[q + TORQUE_X])
        wy = keep * (monomer[r + WY] + turn * force[q + TORQUE_Y])
        wz = keep * (monomer[r + WZ] + turn * force[q + TORQUE_Z])
        x = monomer[r + X] + dt * vx
        y = monomer[r + Y] + dt * vy
        z = monomer[r + Z] + dt * vz
        monomer[r + X] = x
        monomer[r + Y] = y
        monomer[r + Z] = z
        monomer[r + VX] = vx
        monomer[r + VY] = vy
        monomer[r + VZ] = vz
        monomer[r + WX] = wx
        monomer[r + WY] = wy
        monomer[r + WZ] = wz
        for number in range(FORCE_ROW):  # the whole row, which is one store
            force[q + np.uint64(number)] = 0.0
        square = vx * vx + vy * vy + vz * vz
        fastest = max(fastest, square)
        total += square
    state.scalar[FASTEST] = math.sqrt(fastest) if total < np.inf else math.nan


def free():
    """No outer force."""
    return Free(0.0)


def rest(drag):
    """No outer force, and a drag that brings the aggregate to rest: velocities and spins decay at this rate [1/s]."""
    return Free(float(drag))
