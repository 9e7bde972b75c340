"""A grain turned by an outer torque: the law omega(t), the turning frame, the largest fragment followed.

`prescribed` is the consistent model: an outer torque keeps the largest fragment turning at omega(t). `literal` is what
the paper prints: fictitious forces only, no torque, no frame terms for the spins.
"""

import math
from typing import NamedTuple

import numpy as np

from ratd.base.checks import is_number
from ratd.base.errors import InputError
from ratd.base.jit import jit
from ratd.base.parts import part
from ratd.base.vectors import add4, greater4, load4, multiply4, numbers4, root_of_sum, scale4, store4, swap4, vector4
from ratd.drives.largest import (
    ACCELERATION, ANGULAR_MOMENTUM, EXCESS, FRAGMENTS, GREATEST, OMEGA, OWN_INERTIA, TORQUE_WORK, UNWIND, centre,
    drop_departed, follow_largest, sample_stress, turn_to_take_out, work_of_torque,
)  # fmt: skip
from ratd.engine.layout import (
    DRIVEN, FASTEST, FORCE_ROW, FORCE_X, INERTIA, INV_INERTIA, INV_MASS, MASS, MONOMERS, ROW, STEPS, TIME, TORQUE_X,
    VX, WX, X,
)  # fmt: skip

CENTRE_EVERY = 4096
"""Steps after which the origin is put back to the centre of mass.

The outer torque acts about the origin. Off the centre of mass by x it leaves a net force m alpha x, which makes x grow
by exp(1/sqrt(epsilon)) until omega_1, from a rounding error to a size that tears slow runs apart.
"""

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


@part
class Rotating(NamedTuple):
    """The drive; made by `rotating`.

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

    def turning(self):
        # without the outer torque the grain stays behind the frame
        return not self.torque

    def follow(self, state, changed):
        follow_largest(state, changed)
        omega, acceleration = angular_velocity(self, state.scalar[TIME])
        state.drive[OMEGA] = state.drive[GREATEST] = omega
        state.drive[ACCELERATION] = acceleration

    def leave(self, state, law):
        return drop_departed(state, law)

    def sample(self, state, law):
        sample_stress(state, law)
        if state.counter[STEPS] % CENTRE_EVERY == 0:
            centre(state)

    def load(self, state, kick):
        pass

    def longest_step(self, state):
        return math.inf

    def move(self, state, box, kick, dt):
        drive, scalar = state.drive, state.scalar
        omega, domega, unwind = drive[OMEGA], drive[ACCELERATION], drive[UNWIND]
        monomer, force, n = state.monomer, state.force, state.counter[MONOMERS]
        # chosen here, so that the loop over a grain in one piece does not ask each monomer
        if drive[FRAGMENTS] == 1.0:
            sums = kick_and_drift(monomer, force, n, kick, dt, omega, domega, unwind, self, True)
        else:
            sums = kick_and_drift(monomer, force, n, kick, dt, omega, domega, unwind, self, False)
        momentum, inertia, fastest = sums
        inertia += drive[OWN_INERTIA]
        if self.torque:
            drive[TORQUE_WORK] += work_of_torque(inertia, omega, momentum, unwind, domega * kick)
            excess = momentum / inertia
            drive[UNWIND] = turn_to_take_out(excess, drive[EXCESS], unwind)
            drive[EXCESS] = excess
            drive[ANGULAR_MOMENTUM] = inertia * omega + momentum
        drive[OMEGA], drive[ACCELERATION] = angular_velocity(self, scalar[TIME] + dt)
        drive[GREATEST] = drive[OMEGA]
        scalar[FASTEST] = fastest if abs(momentum) < np.inf else math.nan


def rotating(name, *, omega_1, epsilon=None, angular_acceleration=None, coriolis=None):
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
    Rotating

    Raises
    ------
    InputError
    """
    if name not in DRIVES:
        raise InputError(f"drive is {name!r}; allowed are {', '.join(DRIVES)}.")
    if (epsilon is None) == (angular_acceleration is None):
        raise InputError("Exactly one of epsilon and angular_acceleration must say how fast the grain spins up.")
    for word, value in (("epsilon", epsilon), ("angular_acceleration", angular_acceleration)):
        if value is not None and not (is_number(value) and value > 0):
            raise InputError(f"{word} is {value!r}; it must be a number above 0.")
    literal = name == "literal"
    if coriolis is None:
        coriolis = "explicit" if literal else "exact"
    if coriolis not in CORIOLIS:
        raise InputError(f"coriolis is {coriolis!r}; allowed are {', '.join(CORIOLIS)}.")
    return Rotating(
        law=CONSTANT_EPSILON if angular_acceleration is None else EXPONENTIAL,
        epsilon=float(epsilon or 0.0),
        omega_1=float(omega_1),
        acceleration=float(angular_acceleration or 0.0),
        torque=not literal,
        explicit_coriolis=coriolis == "explicit",
        spin_terms=not literal,
    )


@jit
def angular_velocity(drive, time):
    """omega [rad/s] and d omega/dt [rad/s2] at a time [s].

    Parameters
    ----------
    drive : Rotating
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


@jit(forceinline=True)
def kick_and_drift(monomer, force, n, kick, dt, omega, domega, unwind, drive, whole):
    """Move all monomers by one step in the frame that turns with omega about z, and clear the forces.

    Velocities stand half a step behind the positions (leapfrog).

    Parameters
    ----------
    monomer, force : arrays
        See `State`.
    n : int
        Number of monomers.
    kick, dt : float
        Duration of the kick and of the move that follows [s].
    omega, domega : float
        Angular velocity [rad/s] of the frame and its rate of change [rad/s2], at the time of the positions.
    unwind : float
        Rigid rotation [rad/s] that the outer torque gives the largest fragment in this step, so that it has no angular
        momentum about z in the frame after it: minus what it had after the last step and what this step puts in, over
        its moment of inertia.
    drive : Rotating
    whole : bool
        Whether the drive acts on all monomers, since they are one fragment; then none is asked.

    Returns
    -------
    angular_momentum : float
        Of the largest fragment about z, in the frame, after the kick [kg m2 s-1].
    inertia : float
        Moment of inertia of its centres about z [kg m2].
    fastest : float
        No monomer is faster in the frame [m/s]; see `root_of_sum`.

    Notes
    -----
    Eqs. 19-21, 29, 30 with the terms that they lack: the centrifugal force m omega^2 (x, y, 0), the
    Coriolis force -2 m omega x v, the Euler force -m (d omega/dt) x X, their counterparts for the spin
    (-I omega x w, -I d omega/dt), and for the largest fragment the body force m alpha x X with I alpha on the spin.
    alpha is d omega/dt, which cancels the Euler force, plus what keeps the angular momentum in the frame zero.

    The exact treatment turns the velocity by the angle -2 omega dt between two half kicks (Boris 1970), and the spin by
    -omega dt likewise. The body force has to be part of these kicks: if the torque followed a step later, or after the
    turn, vibrations along the radius would lose energy at a rate ~ omega^2 dt.
    """
    cos_w, sin_w, spin_euler = 1.0, 0.0, 0.0
    if drive.spin_terms:
        cos_w, sin_w, spin_euler = math.cos(omega * kick), math.sin(omega * kick), -domega * kick
    alpha = 0.0
    if drive.torque:
        alpha = domega + unwind / kick
    angle = 2.0 * omega * kick
    cos_v, sin_v = math.cos(angle), math.sin(angle)
    explicit = drive.explicit_coriolis
    h = 0.5 * kick
    # Lanes x, y, z; the fourth of the positions is the radius, of the spins DRIVEN, and both stay. (y, x) times
    # (-s, s) is a quarter turn.
    centrifugal = vector4(h * omega * omega, h * omega * omega, 0.0, 0.0)
    euler = vector4(h * domega, -h * domega, 0.0, 0.0)
    driving = vector4(-h * alpha, h * alpha, 0.0, 0.0)
    coriolis = vector4(angle, -angle, 0.0, 0.0)
    cos4_v, sin4_v = vector4(cos_v, cos_v, 1.0, 1.0), vector4(sin_v, -sin_v, 0.0, 0.0)
    cos4_w, sin4_w = vector4(cos_w, cos_w, 1.0, 1.0), vector4(sin_w, -sin_w, 0.0, 0.0)
    spin_driving = vector4(0.0, 0.0, alpha * kick, 0.0)
    spin_lag = vector4(0.0, 0.0, spin_euler, 0.0)
    nothing = vector4(0.0, 0.0, 0.0, 0.0)
    orbital, spinning, spread, most = nothing, nothing, nothing, nothing
    for k in range(n):
        r = np.uint64(k) * _ROW
        q = np.uint64(k) * _FORCE_ROW
        driven = 1.0 if whole else monomer[r + DRIVEN]
        x = load4(monomer, r + X)
        v = load4(monomer, r + VX)
        across = swap4(x)
        ha = scale4(h * monomer[r + INV_MASS], load4(force, q + FORCE_X))
        ha = add4(ha, multiply4(centrifugal, x))
        ha = add4(ha, multiply4(add4(euler, scale4(driven, driving)), across))
        p = add4(v, ha)
        if explicit:
            v = add4(add4(p, multiply4(coriolis, swap4(v))), ha)
        else:
            v = add4(add4(multiply4(cos4_v, p), ha), multiply4(sin4_v, swap4(p)))
        t = scale4(h * monomer[r + INV_INERTIA], load4(force, q + TORQUE_X))
        p = add4(load4(monomer, r + WX), t)
        t = add4(t, add4(spin_lag, scale4(driven, spin_driving)))
        w = add4(add4(multiply4(cos4_w, p), t), multiply4(sin4_w, swap4(p)))

        store4(monomer, r + X, add4(x, scale4(dt, v)))
        store4(monomer, r + VX, v)
        store4(monomer, r + WX, w)
        store4(force, q + FORCE_X, nothing)
        store4(force, q + TORQUE_X, nothing)
        weighed = scale4(driven * monomer[r + MASS], across)
        orbital = add4(orbital, multiply4(weighed, v))
        spread = add4(spread, multiply4(weighed, across))
        spinning = add4(spinning, scale4(driven * monomer[r + INERTIA], w))
        most = greater4(multiply4(v, v), most)
    backward, forward, _, _ = numbers4(orbital)
    across_x, across_y, _, _ = numbers4(spread)
    return forward - backward + numbers4(spinning)[2], across_x + across_y, root_of_sum(most)
