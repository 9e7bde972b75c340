"""A grain turned by an outer torque: the law omega(t), the turning frame, the largest fragment followed.

`prescribed` is the consistent model: an outer torque keeps the largest fragment turning at omega(t). `literal` is what
the paper prints: fictitious forces only, no torque, no frame terms for the spins.
"""

import math
from typing import NamedTuple

import numpy as np

from ratd.base.errors import InputError
from ratd.base.jit import jit
from ratd.base.parts import part
from ratd.base.vectors import add4, load4, multiply4, numbers4, scale4, square4, store4, swap4, vector4
from ratd.engine.fragments import drop, label_fragments, note_lost
from ratd.engine.layout import (
    CLOCK, DRIVEN, DT_DRIFT, FASTEST, FORCE_ROW, FORCE_X, INERTIA, INV_INERTIA, INV_MASS, MASS, MONOMERS, RADIUS, ROW,
    STEPS, TIME, TORQUE_X, VX, VY, VZ, WX, WY, WZ, X, Y, Z,
)  # fmt: skip
from ratd.observables.stress import total_stress

GREATEST = CLOCK
"""Of `state.drive`: the greatest angular velocity so far [rad/s]."""
(
    ACCELERATION, UNWIND, EXCESS, TORQUE_WORK, STRESS_SUM, STRESS_SAMPLES, FRAGMENTS, OWN_INERTIA, OMEGA,
    ANGULAR_MOMENTUM, UNREST, DRAGGED, CARRIED,
) = range(1, 14)  # fmt: skip
"""... d omega/dt [rad/s2]; what the torque turns the largest fragment back by, and how much it turned after the last
step [rad/s]; work of the torque [J]; sum and number of the samples of the total stress; number of fragments; of the
largest one the moments of inertia of its monomers about their own centres, added up [kg m2]; angular velocity of the
frame [rad/s]; angular momentum of the largest fragment [kg m2/s]; its unrest, and energy that the drag has taken from
it [J] (see `ratd.drives.quasi_static`); kinetic energy that went with fragments that were dropped, and with the motion
of the origin [J]."""

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
        momentum, inertia, fastest = kick_and_drift(
            state.monomer, state.force, state.counter[MONOMERS], kick, dt, omega, domega, unwind, self
        )
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
        if value is not None and not (np.isfinite(value) and value > 0):
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


@jit
def kick_and_drift(monomer, force, n, kick, dt, omega, domega, unwind, drive):
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

    Returns
    -------
    angular_momentum : float
        Of the largest fragment about z, in the frame, after the kick [kg m2 s-1].
    inertia : float
        Moment of inertia of its centres about z [kg m2].
    fastest : float
        Greatest speed of any monomer in the frame [m/s].

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
    orbital, spinning, spread = nothing, nothing, nothing
    fastest = 0.0
    for k in range(n):
        r = np.uint64(k) * _ROW
        q = np.uint64(k) * _FORCE_ROW
        driven = monomer[r + DRIVEN]
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
        w = add4(add4(multiply4(cos4_w, p), add4(t, spin_lag)), multiply4(sin4_w, swap4(p)))
        w = add4(w, scale4(driven, spin_driving))

        store4(monomer, r + X, add4(x, scale4(dt, v)))
        store4(monomer, r + VX, v)
        store4(monomer, r + WX, w)
        store4(force, q + FORCE_X, nothing)
        store4(force, q + TORQUE_X, nothing)
        weighed = scale4(driven * monomer[r + MASS], across)
        orbital = add4(orbital, multiply4(weighed, v))
        spread = add4(spread, multiply4(weighed, across))
        spinning = add4(spinning, scale4(driven * monomer[r + INERTIA], w))
        fastest = max(fastest, square4(v))
    backward, forward, _, _ = numbers4(orbital)
    across_x, across_y, _, _ = numbers4(spread)
    return forward - backward + numbers4(spinning)[2], across_x + across_y, math.sqrt(fastest)


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


@jit
def work_of_torque(inertia, omega, momentum, unwind, risen):
    """Work [J] of the outer torque in a step: two rigid rotations, by `unwind` and then by `risen`.

    Parameters
    ----------
    inertia : float
        Of the fragment about the axis [kg m2].
    omega : float
        Angular velocity of the frame before the step [rad/s].
    momentum : float
        Angular momentum in it after the first [kg m2/s].
    unwind, risen : float
        What the torque adds to the velocities in the frame, and what omega rises by [rad/s].
    """
    return (unwind + risen) * (inertia * omega + momentum) + 0.5 * inertia * (risen * risen - unwind * unwind)


@jit
def follow_largest(state, changed):
    """Find the largest fragment and what is known of it; `changed` where contacts have come or gone."""
    state.drive[FRAGMENTS] = label_fragments(state)
    state.drive[OWN_INERTIA] = own_inertia(state)
    if changed:
        # They were those of the old fragment; nothing can be foretold of the new one before its first step.
        state.drive[UNWIND] = 0.0
        state.drive[EXCESS] = math.nan
        centre(state)


@jit
def sample_stress(state, law):
    """Take a sample of the total stress for its mean over a recording interval."""
    state.drive[STRESS_SUM] += total_stress(state, law)
    state.drive[STRESS_SAMPLES] += 1.0


@jit
def own_inertia(state):
    """Sum of the moments of inertia of the largest fragment's monomers about their own centres [kg m2]."""
    inertia = 0.0
    for k in range(state.counter[MONOMERS]):
        if state.fragment[k] == 0:
            inertia += state.monomer[np.uint64(k) * _ROW + INERTIA]
    return inertia


@jit
def centre(state):
    """Mark the largest fragment as driven, and move the origin to its centre of mass.

    The origin takes the centre's velocity as well, which is an inertial motion, so that the terms of the turning
    frame keep their form. The energy of that motion is `CARRIED` off.
    """
    n = state.counter[MONOMERS]
    monomer = state.monomer
    state.drive[CARRIED] += energy_of_motion(state)
    mass = 0.0
    sums = np.zeros(6)
    for k in range(n):
        r = np.uint64(k) * _ROW
        if state.fragment[k] == 0:
            monomer[r + DRIVEN] = 1.0
            m = monomer[r + MASS]
            mass += m
            sums[0] += m * monomer[r + X]
            sums[1] += m * monomer[r + Y]
            sums[2] += m * monomer[r + Z]
            sums[3] += m * monomer[r + VX]
            sums[4] += m * monomer[r + VY]
            sums[5] += m * monomer[r + VZ]
        else:
            monomer[r + DRIVEN] = 0.0
    sums /= mass
    for k in range(n):
        r = np.uint64(k) * _ROW
        monomer[r + X] -= sums[0]
        monomer[r + Y] -= sums[1]
        monomer[r + Z] -= sums[2]
        monomer[r + VX] -= sums[3]
        monomer[r + VY] -= sums[4]
        monomer[r + VZ] -= sums[5]
    state.drive[CARRIED] -= energy_of_motion(state)


@jit
def energy_of_motion(state):
    """Of all monomers in the inertial frame, centres and spins [J].

    Velocities stand half a step behind the positions. That matters where a fragment flies off, and is made up for in
    those but the largest, which only the forces of the turning frame act on.
    """
    omega, half = state.drive[OMEGA], 0.5 * state.scalar[DT_DRIFT]
    energy = 0.0
    for k in range(state.counter[MONOMERS]):
        r = np.uint64(k) * _ROW
        x, y = state.monomer[r + X], state.monomer[r + Y]
        vx, vy, vz = state.monomer[r + VX], state.monomer[r + VY], state.monomer[r + VZ]
        wx, wy, wz = state.monomer[r + WX], state.monomer[r + WY], state.monomer[r + WZ]
        if state.fragment[k] != 0:
            turn = omega * half
            vx, vy = vx + turn * (omega * x + 2.0 * vy), vy + turn * (omega * y - 2.0 * vx)
            wx, wy = wx + turn * wy, wy - turn * wx
        vx, vy, wz = vx - omega * y, vy + omega * x, wz + omega
        energy += 0.5 * state.monomer[r + MASS] * (vx * vx + vy * vy + vz * vz)
        energy += 0.5 * state.monomer[r + INERTIA] * (wx * wx + wy * wy + wz * wz)
    return energy


@jit
def drop_departed(state, law):
    """Drop the fragments that have left for good, noting their mass and number of monomers.

    A fragment has left when all of it lies outside the sphere around the centre of mass that holds the largest
    fragment, and its own centre of mass recedes. Centres of mass of free bodies go straight in the inertial frame, so
    that such a fragment meets the largest no more, unless it is long and reaches back with an end as it turns.

    Parameters
    ----------
    state : State
        Its fragments as `follow_largest` has found them.
    law : part

    Returns
    -------
    int
        Number of fragments dropped. The arrays hold the remaining monomers in their old order.
    """
    fragments = np.int64(state.drive[FRAGMENTS])
    if fragments < 2:
        return 0
    n = state.counter[MONOMERS]
    monomer = state.monomer
    outer = 0.0
    nearest = np.full(fragments, np.inf)
    mass = np.zeros(fragments)
    members = np.zeros(fragments, dtype=np.int64)
    centre = np.zeros((fragments, 6))
    for k in range(n):
        r = np.uint64(k) * _ROW
        f = state.fragment[k]
        distance = math.sqrt(monomer[r + X] ** 2 + monomer[r + Y] ** 2 + monomer[r + Z] ** 2)
        if f == 0:
            outer = max(outer, distance + monomer[r + RADIUS])
        nearest[f] = min(nearest[f], distance - monomer[r + RADIUS])
        m = monomer[r + MASS]
        mass[f] += m
        members[f] += 1
        for axis in range(3):
            offset = np.uint64(axis)
            centre[f, axis] += m * monomer[r + X + offset]
            centre[f, 3 + axis] += m * monomer[r + VX + offset]
    gone = np.zeros(fragments, dtype=np.bool_)
    dropped = 0
    for f in range(1, fragments):
        receding = centre[f, 0] * centre[f, 3] + centre[f, 1] * centre[f, 4] + centre[f, 2] * centre[f, 5] > 0.0
        if nearest[f] > outer and receding:
            gone[f] = True
            dropped += 1
            note_lost(state, mass[f], members[f])
    if dropped == 0:
        return 0

    state.drive[CARRIED] += energy_of_motion(state)
    drop(state, law, gone)
    state.drive[CARRIED] -= energy_of_motion(state)
    return dropped
