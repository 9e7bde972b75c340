"""The time loop: steps, contacts made and broken, fragments, monomers dropped."""

import math

import numpy as np

from ratd.base.jit import jit
from ratd.drives.rotating import angular_velocity, kick_and_drift, turn_to_take_out
from ratd.engine.contacts import append_contact, contact_start, remove_contact, update_contact_rates
from ratd.engine.forces import SCRATCH_SIZE, contact_forces
from ratd.engine.fragments import drop_departed, find_fragments
from ratd.engine.layout import (
    COMPRESSION, CONTACTS, DT, DT_DRIFT, EXCESS, LARGEST_CONTACTS, MONOMERS, OMEGA, RADIUS, ROW,
    SEARCHES, STEPS, STRESS_SAMPLES, STRESS_SUM, TIME, TORQUE_WORK, UNWIND, X, Y, Z,
)  # fmt: skip
from ratd.engine.measure import greatest_residual, total_stress
from ratd.laws.jkr import COMPRESSION_END
from ratd.geometry.neighbours import close_pairs

REACHED, FEW_CONTACTS, STEPS_DONE, FULL, NOT_FINITE = range(5)
"""Why `advance` returned: omega reached, few contacts left, number of steps reached, no room for a new contact, a
velocity that is no finite number."""

STRESS_EVERY = 64
"""Steps between two samples of the total stress."""
CENTRE_EVERY = 4096
"""Steps after which the origin is put back to the centre of mass.

The outer torque acts about the origin. Off the centre of mass by x it leaves a net force m alpha x, which makes x grow
by exp(1/sqrt(epsilon)) until omega_1, from a rounding error to a size that tears slow runs apart.
"""
FAR, NEAR = 0.2, 0.02
"""Reach of the two lists of pairs that may come into contact, in mean monomer radii.

The far list is made by a search through all monomers, the near list, which is looked at in every step, from the far
one. A list is good until some monomer may have moved by half of its reach.
"""
_ROW = np.uint64(ROW)


@jit
def _positions(state):
    n = state.counter[MONOMERS]
    position = np.empty((n, 3))
    radius = np.empty(n)
    for k in range(n):
        r = np.uint64(k) * _ROW
        position[k, 0] = state.monomer[r + X]
        position[k, 1] = state.monomer[r + Y]
        position[k, 2] = state.monomer[r + Z]
        radius[k] = state.monomer[r + RADIUS]
    return position, radius


@jit
def _farthest_move(state, reference, turning):
    """Greatest distance of any monomer from where it was [m].

    With `turning` the monomers as a whole are first turned back about z: distances within a grain that only turns
    do not change, however far its monomers go.
    """
    cos, sin = 1.0, 0.0
    if turning:
        along, across = 0.0, 0.0
        for k in range(reference.shape[0]):
            r = np.uint64(k) * _ROW
            x, y = state.monomer[r + X], state.monomer[r + Y]
            along += x * reference[k, 0] + y * reference[k, 1]
            across += y * reference[k, 0] - x * reference[k, 1]
        length = math.sqrt(along * along + across * across)
        if length > 0.0:
            cos, sin = along / length, across / length
    square = 0.0
    for k in range(reference.shape[0]):
        r = np.uint64(k) * _ROW
        dx = state.monomer[r + X] - (cos * reference[k, 0] - sin * reference[k, 1])
        dy = state.monomer[r + Y] - (cos * reference[k, 1] + sin * reference[k, 0])
        dz = state.monomer[r + Z] - reference[k, 2]
        square = max(square, dx * dx + dy * dy + dz * dz)
    return math.sqrt(square)


@jit
def _near_pairs(state, far, reach):
    """Pairs (i, j) of the far list that are not in contact and closer than `reach`, in the order of that list."""
    n = state.counter[MONOMERS]
    n_contacts = state.counter[CONTACTS]
    begin = np.zeros(n + 2, dtype=np.int64)
    for k in range(n_contacts):
        begin[min(state.pair_i[k], state.pair_j[k]) + np.uint64(2)] += 1
    for k in range(n):
        begin[k + 2] += begin[k + 1]
    partner = np.empty(n_contacts, dtype=np.int64)
    for k in range(n_contacts):
        low = min(state.pair_i[k], state.pair_j[k])
        partner[begin[low + np.uint64(1)]] = np.int64(max(state.pair_i[k], state.pair_j[k]))
        begin[low + np.uint64(1)] += 1
    near = np.empty((far.shape[0], 2), dtype=np.int64)
    count = 0
    for p in range(far.shape[0]):
        i = far[p, 0]
        j = far[p, 1]
        if gap(state, i, j) > reach:
            continue
        touching = False
        for q in range(begin[i], begin[i + 1]):
            touching |= partner[q] == j
        if not touching:
            near[count, 0] = i
            near[count, 1] = j
            count += 1
    return near[:count].copy()


@jit(forceinline=True)
def gap(state, i, j):
    """Distance between two surfaces [m], negative when they overlap."""
    ri = np.uint64(i) * _ROW
    rj = np.uint64(j) * _ROW
    dx = state.monomer[ri + X] - state.monomer[rj + X]
    dy = state.monomer[ri + Y] - state.monomer[rj + Y]
    dz = state.monomer[ri + Z] - state.monomer[rj + Z]
    return math.sqrt(dx * dx + dy * dy + dz * dz) - state.monomer[ri + RADIUS] - state.monomer[rj + RADIUS]


@jit
def advance(state, drive, omega_goal, steps_goal, fewest_contacts, timestep_factor, implicit_damping):
    """Integrate until the frame turns with `omega_goal`, or something else ends it.

    Parameters
    ----------
    state : State
        Changed in place. The same sequence of calls gives the same bits.
    drive : ratd.drives.rotating.Drive
    omega_goal : float
        Angular velocity [rad/s] at which to return.
    steps_goal : int
        Total number of steps at which to return.
    fewest_contacts : int
        Return when the largest fragment has no more contacts than this; -1 for never.
    timestep_factor : float
        f of dt = f min(t_dis, t_vel) (Eq. 31 and below it).
    implicit_damping : bool

    Returns
    -------
    int
        `REACHED`, `FEW_CONTACTS`, `STEPS_DONE`, `NOT_FINITE`, or `FULL`: make room for contacts and call again.
    """
    scalar = state.scalar
    counter = state.counter
    scratch = np.zeros(SCRATCH_SIZE)
    smallest = np.inf
    mean = 0.0
    for k in range(counter[MONOMERS]):
        a = state.monomer[np.uint64(k) * _ROW + RADIUS]
        smallest = min(smallest, a)
        mean += a / counter[MONOMERS]
    far_reach = FAR * mean
    near_reach = NEAR * mean

    position, radius = _positions(state)
    far_reference = position
    near_reference = position
    far = close_pairs(position, radius, far_reach)
    near = _near_pairs(state, far, near_reach)
    travel = 0.0
    # without the outer torque the grain stays behind the frame
    turning = not drive.torque
    fragments = find_fragments(state)
    changed = False
    omega, domega = angular_velocity(drive, scalar[TIME])
    while True:
        if changed:
            # Some contact was made or broken.
            changed = False
            # They were those of the old fragment; nothing can be foretold of the new one before its first step.
            scalar[UNWIND] = 0.0
            scalar[EXCESS] = math.nan
            update_contact_rates(state, timestep_factor, implicit_damping)
            fragments = find_fragments(state)
            near_reference, radius = _positions(state)
            far_reference = near_reference
            far = close_pairs(near_reference, radius, far_reach)
            near = _near_pairs(state, far, near_reach)
            travel = 0.0
            counter[SEARCHES] += 1
        if counter[LARGEST_CONTACTS] <= fewest_contacts:
            return FEW_CONTACTS
        if scalar[OMEGA] >= omega_goal:
            return REACHED
        if counter[STEPS] >= steps_goal:
            return STEPS_DONE
        if counter[CONTACTS] + near.shape[0] > state.pair_i.shape[0]:
            return FULL

        if counter[STEPS] % CENTRE_EVERY == 0:
            find_fragments(state)
        dt = scalar[DT]
        ended = contact_forces(
            state.monomer, state.force, state.contact, state.pair_i, state.pair_j, scratch,
            counter[CONTACTS], scalar[DT_DRIFT], dt,
        )  # fmt: skip
        if counter[STEPS] % STRESS_EVERY == 0:
            scalar[STRESS_SUM] += total_stress(state)
            scalar[STRESS_SAMPLES] += 1.0
        momentum, inertia, fastest = kick_and_drift(
            state.monomer, state.force, counter[MONOMERS], dt, omega, domega, scalar[UNWIND], drive
        )
        if drive.torque:
            # Power of the body force m alpha x X: alpha times the angular momentum in the inertial frame.
            scalar[TORQUE_WORK] += (domega * dt + scalar[UNWIND]) * (inertia * omega + momentum)
            excess = momentum / inertia
            scalar[UNWIND] = turn_to_take_out(excess, scalar[EXCESS], scalar[UNWIND])
            scalar[EXCESS] = excess
        scalar[DT_DRIFT] = dt
        scalar[TIME] += dt
        omega, domega = angular_velocity(drive, scalar[TIME])
        scalar[OMEGA] = omega
        counter[STEPS] += 1
        if not (fastest < np.inf and abs(momentum) < np.inf):
            return NOT_FINITE

        if ended > 0:
            for k in range(counter[CONTACTS] - 1, -1, -1):
                if state.contact[contact_start(k) + COMPRESSION] < COMPRESSION_END:
                    remove_contact(state, k)
            changed = True
        for p in range(near.shape[0]):
            if gap(state, near[p, 0], near[p, 1]) <= 0.0:
                append_contact(state, near[p, 0], near[p, 1], dt, False)
                changed = True
        travel += fastest * dt
        if travel > 0.5 * near_reach and not changed:
            travel = _farthest_move(state, near_reference, turning)
            if travel > 0.25 * near_reach:
                if fragments > 1 and drop_departed(state, fragments) > 0:
                    changed = True
                else:
                    near_reference, radius = _positions(state)
                    if _farthest_move(state, far_reference, turning) > 0.5 * (far_reach - near_reach):
                        far_reference = near_reference
                        far = close_pairs(near_reference, radius, far_reach)
                        counter[SEARCHES] += 1
                    near = _near_pairs(state, far, near_reach)
                    travel = 0.0
        if fastest * dt > timestep_factor * smallest:
            scalar[DT] = timestep_factor * smallest / fastest


@jit
def residual_force(state):
    """Greatest net force on any monomer [N] in a frame at rest; torques count as force times radius."""
    scratch = np.zeros(SCRATCH_SIZE)
    contact_forces(
        state.monomer,
        state.force,
        state.contact,
        state.pair_i,
        state.pair_j,
        scratch,
        state.counter[CONTACTS],
        0.0,
        0.0,
    )
    greatest = greatest_residual(state)
    state.force[:] = 0.0
    return greatest
