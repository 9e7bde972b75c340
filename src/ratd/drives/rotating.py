"""What moves the aggregate: the law omega(t) and the equations of motion of a monomer in the turning frame.

`prescribed` is the consistent model: an outer torque keeps the largest fragment turning at omega(t). `literal` is what
the paper prints: fictitious forces only, no torque, no frame terms for the spins (docs/model.md).
"""

import math
from typing import NamedTuple

import numpy as np

from ratd.base.errors import InputError
from ratd.base.jit import jit
from ratd.engine.layout import (
    DRIVEN,
    FORCE_ROW,
    FORCE_X,
    FORCE_Y,
    FORCE_Z,
    INERTIA,
    INV_INERTIA,
    INV_MASS,
    MASS,
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

OMEGA_RAT = 3e10
"""Terminal angular velocity [rad/s] of Eq. 24 (Sect. 7 of the paper)."""

DRIVES = ("prescribed", "literal")
SPIN_UP_LAWS = ("constant-epsilon", "exponential")
CONSTANT_EPSILON, EXPONENTIAL = range(len(SPIN_UP_LAWS))
CORIOLIS = ("exact", "explicit")

SOFT_START = 0.3
"""Part of omega_1 up to which the constant-epsilon law is linear, so that it starts with a finite d omega/dt."""

_ROW = np.uint64(ROW)
_FORCE_ROW = np.uint64(FORCE_ROW)


class Drive(NamedTuple):
    """Parameters of a drive, as compiled code takes them.

    Attributes
    ----------
    law : int
        `CONSTANT_EPSILON` or `EXPONENTIAL` (Eq. 24).
    epsilon : float
        (d omega/dt)/omega^2 of the constant-epsilon law.
    omega_1 : float
        Below it the constant-epsilon law raises omega^2 evenly [rad/s].
    acceleration : float
        Initial d omega/dt of Eq. 24, i.e. omega_RAT/tau_drag [rad/s2].
    torque : bool
        Whether the outer torque acts on the largest fragment.
    explicit_coriolis : bool
        Whether the Coriolis force is taken at the old velocity; else the velocity is turned exactly.
    spin_terms : bool
        Whether the spins feel the turning of the frame.
    """

    law: int
    epsilon: float
    omega_1: float
    acceleration: float
    torque: bool
    explicit_coriolis: bool
    spin_terms: bool


def make_drive(name, *, omega_1, epsilon=None, angular_acceleration=None, coriolis=None):
    """Drive from the words that a user gives.

    Parameters
    ----------
    name : {"prescribed", "literal"}
    omega_1 : float
        Angular velocity [rad/s] from which on the constant-epsilon law has constant epsilon.
    epsilon : float, optional
        For the constant-epsilon law.
    angular_acceleration : float, optional
        Initial d omega/dt [rad/s2] of Eq. 24. Exactly one of the two is given.
    coriolis : {"exact", "explicit"}, optional
        For `literal` only; "explicit" when not given, as printed.

    Returns
    -------
    Drive

    Raises
    ------
    InputError
    """
    if name not in DRIVES:
        raise InputError(f"drive is {name!r}; allowed are {', '.join(DRIVES)}.")
    if (epsilon is None) == (angular_acceleration is None):
        raise InputError("Exactly one of epsilon and angular_acceleration must say how fast the grain spins up.")
    for word, value in (("epsilon", epsilon), ("angular_acceleration", angular_acceleration)):
        if value is not None and not (np.isfinite(value) and value > 0):
            raise InputError(f"{word} is {value!r}; it must be a number above 0.")
    literal = name == "literal"
    if coriolis is None:
        coriolis = "explicit" if literal else "exact"
    if coriolis not in CORIOLIS:
        raise InputError(f"coriolis is {coriolis!r}; allowed are {', '.join(CORIOLIS)}.")
    return Drive(
        law=CONSTANT_EPSILON if angular_acceleration is None else EXPONENTIAL,
        epsilon=float(epsilon or 0.0),
        omega_1=float(omega_1),
        acceleration=float(angular_acceleration or 0.0),
        torque=not literal,
        explicit_coriolis=coriolis == "explicit",
        spin_terms=not literal,
    )


AT_REST = Drive(EXPONENTIAL, 0.0, 1.0, 0.0, False, False, False)
"""A frame that does not turn: for the relaxation before the spin-up, and for free aggregates."""


@jit
def angular_velocity(drive, time):
    """omega [rad/s] and d omega/dt [rad/s2] at a time [s].

    Parameters
    ----------
    drive : Drive
    time : float
        Since the start from rest [s].

    Returns
    -------
    omega, domega : float

    Notes
    -----
    Exponential: Eqs. 24 and 26 with tau_drag = omega_RAT/acceleration.

    Constant epsilon: d omega/dt = epsilon omega^2 above omega_1. Below, omega^2 and with it the
    centrifugal stress rise evenly, d omega/dt = epsilon omega_1^3/omega, after a linear start up to `SOFT_START`
    omega_1. That takes half as long as a linear rise to omega_1 with the same rate there.
    """
    if drive.law == EXPONENTIAL:
        rate = drive.acceleration / OMEGA_RAT
        return -OMEGA_RAT * math.expm1(-time * rate), drive.acceleration * math.exp(-time * rate)
    unit = 1.0 / (drive.epsilon * drive.omega_1)
    linear = SOFT_START**2 * unit
    even = linear + 0.5 * (1.0 - SOFT_START**2) * unit
    if time <= linear:
        slope = drive.omega_1 / (SOFT_START * unit)
        return slope * time, slope
    if time <= even:
        omega = drive.omega_1 * math.sqrt(SOFT_START**2 + 2.0 * (time - linear) / unit)
        return omega, drive.omega_1**2 / (unit * omega)
    omega = 1.0 / max(1.0 / drive.omega_1 - drive.epsilon * (time - even), 1.0 / (2.0 * OMEGA_RAT))
    return omega, drive.epsilon * omega**2


class TurningStep(NamedTuple):
    """What one step in the turning frame is for all monomers alike; made by `turning_step`.

    Attributes
    ----------
    square : float
        omega^2.
    domega : float
        d omega/dt [rad/s2] that the velocities feel.
    alpha : float
        Angular acceleration [rad/s2] that the outer torque gives the largest fragment, 0 without it.
    two_omega_dt, cos_v, sin_v : float
        Angle by which the Coriolis force turns a velocity, its cosine and sine.
    cos_w, sin_w : float
        The same of the turning of a spin.
    spin_euler : float
        What the Euler term takes from a spin [rad/s].
    explicit_coriolis : bool
        See `Drive`.
    """

    square: float
    domega: float
    alpha: float
    two_omega_dt: float
    cos_v: float
    sin_v: float
    cos_w: float
    sin_w: float
    spin_euler: float
    explicit_coriolis: bool


@jit(forceinline=True)
def turning_step(dt, omega, domega, unwind, drive):
    """`TurningStep` from the arguments of `kick_and_drift`."""
    cos_w = 1.0
    sin_w = 0.0
    spin_euler = 0.0
    if drive.spin_terms:
        cos_w = math.cos(omega * dt)
        sin_w = math.sin(omega * dt)
        spin_euler = -domega * dt
    alpha = 0.0
    if drive.torque:
        alpha = domega + unwind / dt
    return TurningStep(
        omega * omega, domega, alpha,
        2.0 * omega * dt, math.cos(2.0 * omega * dt), math.sin(2.0 * omega * dt),
        cos_w, sin_w, spin_euler, drive.explicit_coriolis,
    )  # fmt: skip


@jit(forceinline=True)
def kick_and_drift_one(monomer, force, r, q, dt, turn):
    """Move the monomer of row `r` by one step, and clear its force, row `q`; see `kick_and_drift`.

    Returns
    -------
    angular_momentum, inertia : float
        What it adds to those of the largest fragment.
    square : float
        Square of its speed in the frame [m2/s2].
    """
    h = 0.5 * dt
    x = monomer[r + X]
    y = monomer[r + Y]
    driven = monomer[r + DRIVEN]
    inv_mass = monomer[r + INV_MASS]
    euler = turn.alpha * driven - turn.domega
    ax = force[q + FORCE_X] * inv_mass + turn.square * x - euler * y
    ay = force[q + FORCE_Y] * inv_mass + turn.square * y + euler * x
    vx = monomer[r + VX]
    vy = monomer[r + VY]
    vz = monomer[r + VZ] + dt * force[q + FORCE_Z] * inv_mass
    if turn.explicit_coriolis:
        vx, vy = vx + dt * ax + turn.two_omega_dt * vy, vy + dt * ay - turn.two_omega_dt * vx
    else:
        px = vx + h * ax
        py = vy + h * ay
        vx = turn.cos_v * px + turn.sin_v * py + h * ax
        vy = turn.cos_v * py - turn.sin_v * px + h * ay

    inv_inertia = dt * monomer[r + INV_INERTIA]
    hx = 0.5 * inv_inertia * force[q + TORQUE_X]
    hy = 0.5 * inv_inertia * force[q + TORQUE_Y]
    ux = monomer[r + WX] + hx
    uy = monomer[r + WY] + hy
    wx = turn.cos_w * ux + turn.sin_w * uy + hx
    wy = turn.cos_w * uy - turn.sin_w * ux + hy
    wz = monomer[r + WZ] + inv_inertia * force[q + TORQUE_Z] + turn.spin_euler + turn.alpha * dt * driven

    mass = driven * monomer[r + MASS]
    own = driven * monomer[r + INERTIA]
    monomer[r + VX] = vx
    monomer[r + VY] = vy
    monomer[r + VZ] = vz
    monomer[r + WX] = wx
    monomer[r + WY] = wy
    monomer[r + WZ] = wz
    monomer[r + X] = x + dt * vx
    monomer[r + Y] = y + dt * vy
    monomer[r + Z] += dt * vz
    for number in range(FORCE_ROW):  # the whole row, which is one store
        force[q + np.uint64(number)] = 0.0
    momentum = mass * (x * vy - y * vx) + own * wz
    return momentum, mass * (x * x + y * y) + own, vx * vx + vy * vy + vz * vz


@jit
def kick_and_drift(monomer, force, n, dt, omega, domega, unwind, drive):
    """Move all monomers by one step in the frame that turns with omega about z, and clear the forces.

    Velocities stand half a step behind the positions (leapfrog).

    Parameters
    ----------
    monomer, force : arrays
        See `State`.
    n : int
        Number of monomers.
    dt : float
        Step [s].
    omega, domega : float
        Angular velocity [rad/s] of the frame and its rate of change [rad/s2], at the time of the positions.
    unwind : float
        Rigid rotation [rad/s] that the outer torque gives the largest fragment in this step, so that it has no angular
        momentum about z in the frame after it: minus what it had after the last step and what this step puts in, over
        its moment of inertia.
    drive : Drive

    Returns
    -------
    angular_momentum : float
        Of the largest fragment about z, in the frame, after the kick [kg m2 s-1].
    inertia : float
        Moment of inertia of the largest fragment about z [kg m2].
    fastest : float
        Greatest speed of any monomer in the frame [m/s].

    Notes
    -----
    Eqs. 19-21, 29, 30 with the terms that they lack (docs/model.md): the centrifugal force m omega^2 (x, y, 0), the
    Coriolis force -2 m omega x v, the Euler force -m (d omega/dt) x X, their counterparts for the spin
    (-I omega x w, -I d omega/dt), and for the largest fragment the body force m alpha x X with I alpha on the spin.
    alpha is d omega/dt, which cancels the Euler force, plus what keeps the angular momentum in the frame zero.

    The exact treatment turns the velocity by the angle -2 omega dt between two half kicks (Boris 1970), and the spin by
    -omega dt likewise. The body force has to be part of these kicks: if the torque followed a step later, or after the
    turn, vibrations along the radius would lose energy at a rate ~ omega^2 dt.
    """
    turn = turning_step(dt, omega, domega, unwind, drive)
    angular_momentum = 0.0
    inertia = 0.0
    fastest = 0.0
    for k in range(n):
        momentum_k, inertia_k, speed = kick_and_drift_one(
            monomer, force, np.uint64(k) * _ROW, np.uint64(k) * _FORCE_ROW, dt, turn
        )
        angular_momentum += momentum_k
        inertia += inertia_k
        fastest = max(fastest, speed)
    return angular_momentum, inertia, math.sqrt(fastest)


@jit
def turn_to_take_out(excess, last_excess, last_unwind):
    """Rigid rotation [rad/s] that the outer torque has to give the largest fragment in the step to come.

    Parameters
    ----------
    excess, last_excess : float
        Angular momentum of the fragment in the frame over its moment of inertia [rad/s], after the last step and the
        one before; the latter is NaN when the fragment was another one.
    last_unwind : float
        What the torque gave in the last step.

    Returns
    -------
    float
        Minus what has stayed, and minus what the step will put in: as much as the last one did.
    """
    put_in = 0.0
    if last_excess == last_excess:
        put_in = excess - last_excess - last_unwind
    return -excess - put_in
