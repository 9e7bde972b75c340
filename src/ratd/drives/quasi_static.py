"""A grain spun up so slowly that only its equilibria matter: the limit of hours, in few steps.

Real grains are spun up over some 1e16 of the steps that an integration can make. Whatever sways or vibrates has died
out long before omega changes. So here the spin-up goes on only while the grain is quiet, and a drag in the turning
frame brings it to rest. With `prescribed` it is omega that rises, with `torque` the angular momentum, from which omega
follows: a grain that stretches then turns more slowly.
"""

import math
from typing import NamedTuple

import numpy as np

from ratd.base.checks import is_number
from ratd.base.errors import InputError
from ratd.base.jit import jit
from ratd.base.parts import part
from ratd.base.vectors import add4, load4, multiply4, numbers4, scale4, square4, store4, swap4, vector4
from ratd.drives.largest import (
    ANGULAR_MOMENTUM, DRAGGED, EXCESS, GREATEST, OMEGA, OWN_INERTIA, TORQUE_WORK, UNREST, UNWIND, centre,
    drop_departed, follow_largest, sample_stress, turn_to_take_out, work_of_torque,
)  # fmt: skip
from ratd.drives.rotating import SOFT_START
from ratd.engine.layout import (
    DRIVEN, FASTEST, FORCE_ROW, FORCE_X, INERTIA, INV_INERTIA, INV_MASS, MASS, MONOMERS, ROW, STRETCH, TORQUE_X, VX,
    VY, WX, WZ, X, Y,
)  # fmt: skip

TURN = 0.04
"""Angle [rad] by which the frame turns in a step at most: the Coriolis force is explicit, and grows what moves by
2 TURN^2 a step, where the drag takes c TURN."""

GREATEST_STRETCH = 1e-10
"""Greatest `stretch` [m]: an atom; contacts give way at less."""
LEAST_DRAG = 2.0 * TURN
"""c up to which motion would grow in steps of the greatest turn."""

DRIVES = ("prescribed", "torque")

_ROW = np.uint64(ROW)
_FORCE_ROW = np.uint64(FORCE_ROW)


@part
class QuasiStatic(NamedTuple):
    """The drive; made by `quasi_static`.

    Attributes
    ----------
    omega_1 : float
        Angular velocity [rad/s] below which omega^2 rises evenly, and below which unrest counts against it.
    pace : float
        (d omega/dt)/omega^2 above omega_1 while the grain is at rest.
    unrest : float
        q_0: at this unrest the rise stops.
    stretch : float
        The rise stops as well where a contact is stretched or pressed by so much in a step [m].
    drag : float
        c: velocities in the turning frame decay at the rate c omega.
    torque : bool
        Whether the angular momentum rises, not omega.
    """

    omega_1: float
    pace: float
    unrest: float
    stretch: float
    drag: float
    torque: bool

    def turning(self):
        return False

    def follow(self, state, changed):
        follow_largest(state, changed)
        if changed:
            state.drive[ANGULAR_MOMENTUM] = math.nan

    def leave(self, state, law):
        return drop_departed(state, law)

    def sample(self, state, law):
        sample_stress(state, law)
        # The drag holds nothing at rest but in this frame: off the axis the centre of mass would run away within some
        # 1/omega. It is put back before that grows beyond rounding.
        centre(state)

    def load(self, state, kick):
        add_frame_forces(state, state.drive[OMEGA])

    def longest_step(self, state):
        # The frame turns by TURN at most, and omega rises by pace TURN of itself, or of omega_1 where that is greater.
        omega = state.drive[OMEGA]
        return TURN * self.pace * max(omega, self.omega_1) / rise(self, omega)

    def move(self, state, box, kick, dt):
        drive = state.drive
        omega, unwind = drive[OMEGA], drive[UNWIND]
        keep = math.exp(-self.drag * omega * kick)
        momentum, inertia, energy, before, fastest = kick_and_drift(state, kick, dt, unwind, keep)
        inertia += drive[OWN_INERTIA]
        # In the inertial frame: of the motion in the turning one, and of its angular momentum, which the torque gives
        # back.
        drive[DRAGGED] += (1.0 - keep * keep) * before + (1.0 - keep) / keep * omega * (momentum - unwind * inertia)
        reference = max(omega, self.omega_1)
        unrest = math.sqrt(2.0 * energy / inertia) / reference
        quiet = max(0.0, 1.0 - (unrest / self.unrest) ** 2)
        still = max(0.0, 1.0 - (state.scalar[STRETCH] / self.stretch) ** 2)
        rate = rise(self, omega) * quiet * still
        excess = momentum / inertia
        drive[UNWIND] = turn_to_take_out(excess, drive[EXCESS], unwind)
        drive[EXCESS] = excess
        drive[UNREST] = unrest
        if self.torque:
            if drive[ANGULAR_MOMENTUM] != drive[ANGULAR_MOMENTUM]:
                # a new fragment: it keeps what it has, and the frame follows
                drive[ANGULAR_MOMENTUM] = inertia * omega + momentum
            drive[ANGULAR_MOMENTUM] += inertia * rate * dt
            drive[OMEGA] = drive[ANGULAR_MOMENTUM] / inertia
            leave_behind(state, drive[OMEGA] - omega)
        else:
            drive[OMEGA] = omega + rate * dt
            drive[ANGULAR_MOMENTUM] = inertia * drive[OMEGA]
        drive[TORQUE_WORK] += work_of_torque(inertia, omega, momentum, unwind, drive[OMEGA] - omega)
        drive[GREATEST] = max(drive[GREATEST], drive[OMEGA])
        state.scalar[FASTEST] = fastest if abs(momentum) < np.inf else math.nan


def quasi_static(name, *, omega_1, stretch=2e-14, pace=0.02, unrest=0.02, drag=1.0):
    """Drive from the words that a user gives.

    Parameters
    ----------
    name : {"prescribed", "torque"}
        Whether omega or the angular momentum rises.
    omega_1 : float
        Angular velocity [rad/s] from which on the rise has a constant epsilon.
    stretch : float
        The rise slows down as a contact is stretched or pressed in a step, and stops at so much [m]. It is the number
        of the accuracy; the limit is stretch -> 0. A contact that gives way begins slowly, the more so in a step that
        weighs its motion with its stiffness, and omega would rise on meanwhile.
    pace : float
        The epsilon above, (d omega/dt)/omega^2, while the grain is at rest.
    unrest : float
        q_0: unrest at which the rise stops.
    drag : float
        c: rate at which motion in the turning frame decays, over omega.

    Returns
    -------
    QuasiStatic

    Raises
    ------
    InputError
    """
    if name not in DRIVES:
        raise InputError(f"drive is {name!r}; allowed are {', '.join(DRIVES)}.")
    for word, value in (("pace", pace), ("unrest", unrest), ("stretch", stretch), ("drag", drag), ("omega_1", omega_1)):
        if not (is_number(value) and value > 0):
            raise InputError(f"{word} is {value!r}; it must be a number above 0.")
    for word, value, most in (("pace", pace, 1.0), ("unrest", unrest, 1.0), ("stretch", stretch, GREATEST_STRETCH)):
        if value > most:
            raise InputError(f"{word} is {value!r}; it must be above 0 and at most {most:g}.")
    if drag <= LEAST_DRAG:
        raise InputError(
            f"drag is {drag!r}; it must be above {LEAST_DRAG}, by which the Coriolis force makes motion grow."
        )
    return QuasiStatic(float(omega_1), float(pace), float(unrest), float(stretch), float(drag), name == "torque")


@jit
def rise(drive, omega):
    """d omega/dt [rad/s2] of a grain at rest.

    pace omega^2 above omega_1. Below, omega^2 and with it the centrifugal stress rise evenly; d omega/dt is
    constant up to `SOFT_START` omega_1, so that it is finite at the start.
    """
    if omega > drive.omega_1:
        return drive.pace * omega**2
    return drive.pace * drive.omega_1**3 / max(omega, SOFT_START * drive.omega_1)


@jit
def add_frame_forces(state, omega):
    """Add the forces of a frame that turns about z: centrifugal and Coriolis, and -I omega x w on the spins."""
    monomer, force = state.monomer, state.force
    centrifugal = vector4(omega * omega, omega * omega, 0.0, 0.0)
    coriolis = vector4(2.0 * omega, -2.0 * omega, 0.0, 0.0)
    turning = vector4(omega, -omega, 0.0, 0.0)
    for k in range(state.counter[MONOMERS]):
        r = np.uint64(k) * _ROW
        q = np.uint64(k) * _FORCE_ROW
        pull = add4(multiply4(centrifugal, load4(monomer, r + X)), multiply4(coriolis, swap4(load4(monomer, r + VX))))
        store4(force, q + FORCE_X, add4(load4(force, q + FORCE_X), scale4(monomer[r + MASS], pull)))
        turn = scale4(monomer[r + INERTIA], multiply4(turning, swap4(load4(monomer, r + WX))))
        store4(force, q + TORQUE_X, add4(load4(force, q + TORQUE_X), turn))


@jit
def kick_and_drift(state, kick, dt, unwind, keep):
    """Move all monomers by one step, and clear the forces.

    Parameters
    ----------
    state : State
        With all forces, those of the frame too.
    kick, dt : float
        Duration of the kick and of the move that follows [s].
    unwind : float
        Rigid rotation [rad/s] that keeps the angular momentum of the largest fragment in the frame at 0.
    keep : float
        Part of its velocities and spins that the drag leaves to the largest fragment.

    Returns
    -------
    angular_momentum, inertia, energy, before : float
        Of the largest fragment in the frame, after the kick: about z [kg m2 s-1], of its centres [kg m2], kinetic [J];
        kinetic before the drag and the torque [J].
    fastest : float
        Greatest speed of any monomer [m/s].

    Notes
    -----
    The outer torque, and the change of the frame's omega, are rigid rotations of the largest fragment; both
    are part of `unwind`. On the others, which no torque drives, the Euler force is left out where omega is prescribed:
    they leave within a small part of the time in which it changes. For a torque see `leave_behind`.
    """
    monomer, force = state.monomer, state.force
    nothing = vector4(0.0, 0.0, 0.0, 0.0)
    unwinding = vector4(-unwind, unwind, 0.0, 0.0)
    spin_unwinding = vector4(0.0, 0.0, unwind, 0.0)
    orbital, spinning, spread = nothing, nothing, nothing
    energy, before = 0.0, 0.0
    fastest = 0.0
    for k in range(state.counter[MONOMERS]):
        r = np.uint64(k) * _ROW
        q = np.uint64(k) * _FORCE_ROW
        driven = monomer[r + DRIVEN]
        left = 1.0 - driven * (1.0 - keep)
        # lanes x, y, z; the fourth of the positions is the radius, of the spins DRIVEN, and both stay
        braked = vector4(left, left, left, 1.0)
        x = load4(monomer, r + X)
        across = swap4(x)
        v = add4(load4(monomer, r + VX), scale4(kick * monomer[r + INV_MASS], load4(force, q + FORCE_X)))
        square = square4(v)
        v = add4(multiply4(braked, v), scale4(driven, multiply4(unwinding, across)))
        w = add4(load4(monomer, r + WX), scale4(kick * monomer[r + INV_INERTIA], load4(force, q + TORQUE_X)))
        m, own = driven * monomer[r + MASS], driven * monomer[r + INERTIA]
        before += 0.5 * (m * square + own * square4(w))
        w = add4(multiply4(braked, w), scale4(driven, spin_unwinding))
        store4(monomer, r + X, add4(x, scale4(dt, v)))
        store4(monomer, r + VX, v)
        store4(monomer, r + WX, w)
        store4(force, q + FORCE_X, nothing)
        store4(force, q + TORQUE_X, nothing)
        weighed = scale4(m, across)
        orbital = add4(orbital, multiply4(weighed, v))
        spread = add4(spread, multiply4(weighed, across))
        spinning = add4(spinning, scale4(own, w))
        square = square4(v)
        energy += 0.5 * (m * square + own * square4(w))
        fastest = max(fastest, square)
    backward, forward, _, _ = numbers4(orbital)
    across_x, across_y, _, _ = numbers4(spread)
    return forward - backward + numbers4(spinning)[2], across_x + across_y, energy, before, math.sqrt(fastest)


@jit
def leave_behind(state, risen):
    """Keep all but the largest fragment as they move in space while the frame turns faster by so much [rad/s].

    Under a torque the omega of the frame is that of the largest fragment, and jumps when the grain comes apart.
    """
    for k in range(state.counter[MONOMERS]):
        r = np.uint64(k) * _ROW
        if state.monomer[r + DRIVEN] == 0.0:
            state.monomer[r + VX] += risen * state.monomer[r + Y]
            state.monomer[r + VY] -= risen * state.monomer[r + X]
            state.monomer[r + WZ] -= risen
