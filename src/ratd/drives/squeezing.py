"""A periodic box that shrinks or grows: the equations of motion in peculiar velocities, and the work of the box."""

import math
from typing import NamedTuple

import numpy as np

from ratd.base.jit import jit
from ratd.base.parts import part
from ratd.base.vectors import add4, load4, multiply4, next4, numbers4, scale4, square4, store4, vector4
from ratd.engine.layout import (
    FASTEST, FORCE_ROW, FORCE_X, INV_INERTIA, INV_MASS, MASS, MONOMERS, ROW, TORQUE_X, VIRIAL, VX, WX, X, Y, Z,
)  # fmt: skip

WORK = 1
"""Of `state.drive`: work of the box on what is in it so far, -int P_ab dV_ab [J]; where it is `as_printed` also that of
the force -m H^2 x."""
SUM_TIME = 2
"""... time [s] since the means were last taken."""
SUM_TENSOR = 3
"""... six numbers: integral of P_ab over it (xx, yy, zz, xy, xz, yz) [Pa s]."""

_ROW = np.uint64(ROW)
_FORCE_ROW = np.uint64(FORCE_ROW)


@part
class Squeezing(NamedTuple):
    """Motion in a box that changes with H; made by `squeezing`.

    Attributes
    ----------
    inertial : bool
        Always true; numba passes no tuple without fields.
    """

    inertial: bool

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
        _move(state, box, kick, dt)


@jit
def _move(state, box, kick, dt):
    """Kick and drift all monomers, and clear the forces.

    Notes
    -----
    dx/dt = u + H x, du/dt = F/m - H u with the peculiar velocity u (compression of Kataoka et al. 2013, made
    homogeneous): u' = (u e^(-H dt/2) + F dt/m) e^(-H dt/2), x' = (x e^(H dt/2) + u' dt) e^(H dt/2). Where the box is
    `as_printed`, -H^2 x is added to the acceleration, x taken in [-L/2, L/2).

    The work of the box is that of the two factors on the velocities, exactly, and H d.F of the contacts.
    """
    monomer, force, scalar, drive = state.monomer, state.force, state.scalar, state.drive
    hx, hy, hz = box.rates()
    lx, ly, lz = box.edges(scalar)
    ux, uy, uz = math.exp(-0.5 * hx * kick), math.exp(-0.5 * hy * kick), math.exp(-0.5 * hz * kick)
    # lanes x, y, z; the fourth of the positions is the radius, and stays
    slow = vector4(ux, uy, uz, 1.0)
    grow = vector4(math.exp(0.5 * hx * dt), math.exp(0.5 * hy * dt), math.exp(0.5 * hz * dt), 1.0)
    printed = box.as_printed
    nothing = vector4(0.0, 0.0, 0.0, 0.0)
    before4, after4, shear4, body4 = nothing, nothing, nothing, nothing
    fastest = 0.0
    for k in range(state.counter[MONOMERS]):
        r = np.uint64(k) * _ROW
        q = np.uint64(k) * _FORCE_ROW
        m = monomer[r + MASS]
        x = load4(monomer, r + X)
        v = load4(monomer, r + VX)
        before4 = add4(before4, multiply4(scale4(m, v), v))
        slowed = multiply4(slow, v)
        v = add4(slowed, scale4(kick * monomer[r + INV_MASS], load4(force, q + FORCE_X)))
        if printed:
            x1, y1, z1 = monomer[r + X], monomer[r + Y], monomer[r + Z]
            pull_x = -kick * hx * hx * (x1 - lx * math.floor(x1 / lx + 0.5))
            pull_y = -kick * hy * hy * (y1 - ly * math.floor(y1 / ly + 0.5))
            pull_z = -kick * hz * hz * (z1 - lz * math.floor(z1 / lz + 0.5))
            pulled = vector4(pull_x, pull_y, pull_z, 0.0)
            v = add4(v, pulled)
            body4 = add4(body4, multiply4(scale4(0.5 * m, pulled), add4(slowed, v)))
        v = multiply4(slow, v)
        turn = kick * monomer[r + INV_INERTIA]
        w = add4(load4(monomer, r + WX), scale4(turn, load4(force, q + TORQUE_X)))
        store4(monomer, r + X, multiply4(grow, add4(multiply4(grow, x), scale4(dt, v))))
        store4(monomer, r + VX, v)
        store4(monomer, r + WX, w)
        store4(force, q + FORCE_X, nothing)
        store4(force, q + TORQUE_X, nothing)
        p = scale4(m, v)
        after4 = add4(after4, multiply4(p, v))
        shear4 = add4(shear4, multiply4(p, next4(v)))
        fastest = max(fastest, square4(v))
    bx, by, bz, _ = numbers4(before4)
    xx, yy, zz, _ = numbers4(after4)
    xy, yz, xz, _ = numbers4(shear4)
    after = (xx, yy, zz)
    before = (bx, by, bz)
    factor = (ux * ux, uy * uy, uz * uz)
    rate = (hx, hy, hz)
    work_x, work_y, work_z, _ = numbers4(body4)
    work = work_x + work_y + work_z
    for axis in range(3):
        # Kinetic energy that the factors give, before the kick and after it, and the work on the contacts.
        work += 0.5 * (before[axis] * (factor[axis] - 1.0) + after[axis] * (1.0 - 1.0 / factor[axis]))
        work -= rate[axis] * kick * scalar[VIRIAL + axis]
    drive[WORK] += work
    weight = kick / (lx * ly * lz)
    shear = (xy, xz, yz)
    for axis in range(3):
        moving = 0.5 * (before[axis] * factor[axis] + after[axis] / factor[axis])
        drive[SUM_TENSOR + axis] += weight * (moving + scalar[VIRIAL + axis])
        drive[SUM_TENSOR + 3 + axis] += weight * (shear[axis] + scalar[VIRIAL + 3 + axis])
    drive[SUM_TIME] += kick
    scalar[FASTEST] = math.sqrt(fastest) if xx + yy + zz < np.inf else math.nan


def squeezing():
    """Motion in a periodic box, whose rate of change stands with the box (`ratd.geometry.box.periodic`)."""
    return Squeezing(True)


def mean_pressure_tensor(state):
    """Mean of P_ab (`ratd.observables.pressure`) over the time since the last call [Pa], (6,); starts a new mean."""
    time = state.drive[SUM_TIME]
    mean = state.drive[SUM_TENSOR : SUM_TENSOR + 6] / (time if time > 0.0 else 1.0)
    state.drive[SUM_TIME : SUM_TENSOR + 6] = 0.0
    return mean
