"""Nothing from outside: monomers move by their contacts alone, in open space or in a box."""

import math
from typing import NamedTuple

import numpy as np

from ratd.base.jit import jit
from ratd.base.parts import part
from ratd.base.vectors import add4, greater4, load4, multiply4, root_of_sum, scale4, store4, vector4
from ratd.engine.layout import (
    FASTEST, FORCE_ROW, FORCE_X, INV_INERTIA, INV_MASS, MONOMERS, ROW, TORQUE_X, VX, WX, X,
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

    def load(self, state, kick):
        pass

    def longest_step(self, state):
        return math.inf

    def move(self, state, box, kick, dt):
        _move(state, self.drag, kick, dt)


@jit
def _move(state, drag, kick, dt):
    """Kick and drift all monomers, and clear the forces; `FASTEST` is NaN after a failure."""
    monomer, force = state.monomer, state.force
    keep = math.exp(-drag * kick)
    nothing = vector4(0.0, 0.0, 0.0, 0.0)
    most, total = nothing, nothing
    # lanes x, y, z; the fourth of the positions is the radius, of the spins DRIVEN, and both stay
    braked = vector4(keep, keep, keep, 1.0)
    for k in range(state.counter[MONOMERS]):
        r = np.uint64(k) * _ROW
        q = np.uint64(k) * _FORCE_ROW
        pull = kick * monomer[r + INV_MASS]
        turn = kick * monomer[r + INV_INERTIA]
        v = multiply4(braked, add4(load4(monomer, r + VX), scale4(pull, load4(force, q + FORCE_X))))
        w = multiply4(braked, add4(load4(monomer, r + WX), scale4(turn, load4(force, q + TORQUE_X))))
        store4(monomer, r + X, add4(load4(monomer, r + X), scale4(dt, v)))
        store4(monomer, r + VX, v)
        store4(monomer, r + WX, w)
        store4(force, q + FORCE_X, nothing)
        store4(force, q + TORQUE_X, nothing)
        squares = multiply4(v, v)
        most = greater4(squares, most)
        total = add4(total, squares)
    state.scalar[FASTEST] = root_of_sum(most) if root_of_sum(total) < np.inf else math.nan


def free():
    """No outer force."""
    return Free(0.0)


def rest(drag):
    """No outer force, and a drag that brings the aggregate to rest: velocities and spins decay at this rate [1/s]."""
    return Free(float(drag))
