"""What the turning drives share: the largest fragment is followed, an outer torque turns it, what leaves is dropped."""

import math

import numpy as np

from ratd.base.jit import jit
from ratd.engine.fragments import drop, label_fragments, note_lost
from ratd.engine.layout import (
    CLOCK, DRIVEN, DT_DRIFT, INERTIA, MASS, MONOMERS, RADIUS, ROW, VX, VY, VZ, WX, WY, WZ, X, Y, Z,
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

_ROW = np.uint64(ROW)


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
