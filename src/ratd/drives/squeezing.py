"""A periodic box that shrinks or grows: the equations of motion in peculiar velocities, and the work of the box."""

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
    MASS,
    MONOMERS,
    ROW,
    TORQUE_X,
    TORQUE_Y,
    TORQUE_Z,
    VIRIAL,
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

WORK = 1
"""Of `state.drive`: work of the box on what is in it so far, -int P_ab dV_ab [J]; where it is `as_printed` also that of
the force -m H^2 x."""
KINETIC = 2
"""... six numbers: sum of m u_a u_b over the monomers in the last step (xx, yy, zz, xy, xz, yz) [J]."""
SUM_STEPS = 8
"""... steps since the means were last taken."""
SUM_TENSOR = 9
"""... six numbers: sum over these steps of V P_ab [J]."""

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
    gx, gy, gz = math.exp(0.5 * hx * dt), math.exp(0.5 * hy * dt), math.exp(0.5 * hz * dt)
    printed = box.as_printed
    fastest = 0.0
    xx, yy, zz, xy, xz, yz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    bx, by, bz = 0.0, 0.0, 0.0
    work = 0.0
    for k in range(state.counter[MONOMERS]):
        r = np.uint64(k) * _ROW
        q = np.uint64(k) * _FORCE_ROW
        pull = kick * monomer[r + INV_MASS]
        turn = kick * monomer[r + INV_INERTIA]
        m = monomer[r + MASS]
        x, y, z = monomer[r + X], monomer[r + Y], monomer[r + Z]
        vx, vy, vz = monomer[r + VX], monomer[r + VY], monomer[r + VZ]
        bx += m * vx * vx
        by += m * vy * vy
        bz += m * vz * vz
        ox, oy, oz = vx * ux, vy * uy, vz * uz
        vx = ox + pull * force[q + FORCE_X]
        vy = oy + pull * force[q + FORCE_Y]
        vz = oz + pull * force[q + FORCE_Z]
        if printed:
            px = -kick * hx * hx * (x - lx * math.floor(x / lx + 0.5))
            py = -kick * hy * hy * (y - ly * math.floor(y / ly + 0.5))
            pz = -kick * hz * hz * (z - lz * math.floor(z / lz + 0.5))
            vx += px
            vy += py
            vz += pz
            work += 0.5 * m * (px * (ox + vx) + py * (oy + vy) + pz * (oz + vz))
        vx *= ux
        vy *= uy
        vz *= uz
        monomer[r + X] = (x * gx + vx * dt) * gx
        monomer[r + Y] = (y * gy + vy * dt) * gy
        monomer[r + Z] = (z * gz + vz * dt) * gz
        monomer[r + VX] = vx
        monomer[r + VY] = vy
        monomer[r + VZ] = vz
        monomer[r + WX] += turn * force[q + TORQUE_X]
        monomer[r + WY] += turn * force[q + TORQUE_Y]
        monomer[r + WZ] += turn * force[q + TORQUE_Z]
        for number in range(FORCE_ROW):  # the whole row, which is one store
            force[q + np.uint64(number)] = 0.0
        fastest = max(fastest, vx * vx + vy * vy + vz * vz)
        xx += m * vx * vx
        yy += m * vy * vy
        zz += m * vz * vz
        xy += m * vx * vy
        xz += m * vx * vz
        yz += m * vy * vz
    after = (xx, yy, zz)
    before = (bx, by, bz)
    factor = (ux * ux, uy * uy, uz * uz)
    rate = (hx, hy, hz)
    for axis in range(3):
        # Kinetic energy that the factors give, before the kick and after it, and the work on the contacts.
        work += 0.5 * (before[axis] * (factor[axis] - 1.0) + after[axis] * (1.0 - 1.0 / factor[axis]))
        work -= rate[axis] * kick * scalar[VIRIAL + axis]
    drive[WORK] += work
    for axis in range(3):
        drive[SUM_TENSOR + axis] += 0.5 * (before[axis] * factor[axis] + after[axis] / factor[axis])
    shear = (xy, xz, yz)
    for axis in range(3):
        drive[KINETIC + axis] = after[axis]
        drive[KINETIC + 3 + axis] = shear[axis]
        drive[SUM_TENSOR + 3 + axis] += shear[axis]
    for component in range(6):
        drive[SUM_TENSOR + component] += scalar[VIRIAL + component]
    drive[SUM_STEPS] += 1.0
    scalar[FASTEST] = math.sqrt(fastest) if xx + yy + zz < np.inf else math.nan


def squeezing():
    """Motion in a periodic box, whose rate of change stands with the box (`ratd.geometry.box.periodic`)."""
    return Squeezing(True)
