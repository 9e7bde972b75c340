"""A linearly implicit step: the contacts' stiffness is part of the mass matrix, so that it limits the step no longer.

In place of M the step uses M' = M + theta dt^2 sum J^T K J + dt sum J^T C J over the contacts, with J the relative
motion at a contact, K its stiffness and C its damping. Soft motion, which is what a slowly loaded aggregate does, has
J near 0 and keeps its mass; stiff vibrations become slow enough for the step. Equilibria do not depend on M'. Rigid
motion of a fragment has J = 0, so momentum is kept, and angular momentum as far as the matrix has followed.
"""

import math
from typing import NamedTuple

import numpy as np

from ratd.base.errors import InputError
from ratd.base.jit import jit
from ratd.base.parts import part
from ratd.base.vectors import add8, load8, multiply8, spread8, store8
from ratd.engine.block_factor import BLOCK, PADDED, BlockFactor, factorise, find_block, order_blocks, solve
from ratd.engine.contacts import contact_start, difference, get_image
from ratd.engine.forces import contact_forces
from ratd.engine.layout import (
    CONTACTS, DT, DT_DRIFT, FASTEST, FORCE_ROW, FORCE_X, LOST_DAMP, MASS, MONOMERS, RADIUS, ROW, STEPS,
    STRETCH, TIME, TORQUE_X, VX, WX,
)  # fmt: skip
from ratd.engine.leapfrog import SAMPLE_EVERY
from ratd.engine.lists import time_to_overlap
from ratd.laws.contact_fields import NCX, NCY, NCZ

RUNG = math.sqrt(0.5)
"""Steps are the longest one times a power of this, so that the matrix seldom changes."""
CLIMB_AFTER = 8
"""Steps on a rung before the next longer one is tried."""
TURNED = 0.005
"""Angle [rad] by which a contact may have turned since the matrix of its fragment was made."""
SPHERE = 0.4
"""Moment of inertia of a sphere over m a^2."""

_ROW = np.uint64(ROW)
_FORCE_ROW = np.uint64(FORCE_ROW)
_PADDED = np.uint64(PADDED)
_NORMAL, _TWIST, _OF_I, _OF_J = (np.uint64(PADDED * row) for row in (0, 1, 2, 4))
_FROM_I_TO_J = np.uint64(2 * PADDED)


class Work(NamedTuple):
    """What the step keeps between two changes of contacts.

    Attributes
    ----------
    factor : BlockFactor
    block : (contacts,) int64
        Number of the block of each contact, and whether its rows are those of i: twice the number plus 0 or 1. -1 where
        a monomer touches a copy of itself.
    x : (8 n,) float64
        The right-hand side, and the solution.
    strain : (8 n,) float64
        What M' - M makes of the motion of the box: sum J^T (theta dt^2 K + dt C) H d over the contacts [kg m/s].
    made : (2,) float64
        Step [s] for which the matrix was made, 0 when it has to be made anew; the greatest of `turned`.
    turned : (n,) float64
        Angle [rad] by which a contact of each fragment may have turned since its part of the matrix was made.
    turn_rate : (n,) float64
        Angular velocity [rad/s] of the contact of each fragment that turns fastest.
    chosen : (n,) bool
        Places of the fragments whose part is made anew.
    rows : (48,) float64
        Space for one contact, see `_write_rows`.
    count : (1,) int64
        Steps since the last change of the step's length.
    """

    factor: BlockFactor
    block: np.ndarray
    x: np.ndarray
    strain: np.ndarray
    made: np.ndarray
    turned: np.ndarray
    turn_rate: np.ndarray
    chosen: np.ndarray
    rows: np.ndarray
    count: np.ndarray


@part
class SemiImplicit(NamedTuple):
    """The integrator; made by `semi_implicit`.

    Attributes
    ----------
    longest : float
        The longest step [s].
    displacement : float
        No two monomers in contact move against each other by more than this in a step [m].
    travel : float
        No monomer moves by more than this in a step [m].
    theta : float
        Weight of the stiffness in the mass matrix.
    calming : float
        Part of the stiff motion that a step takes away.
    first : float
        f of the first step, times the shortest time of any contact.
    implicit_damping : bool
        Always false: the damping is part of the matrix.
    """

    longest: float
    displacement: float
    travel: float
    theta: float
    calming: float
    first: float
    implicit_damping: bool

    def with_smaller_steps(self, part):
        return self._replace(
            longest=part * self.longest, displacement=part * self.displacement, travel=part * self.travel
        )

    def set_step(self, state, shortest):
        # only at the start: later the step follows the motion
        if state.scalar[DT] == 0.0:
            state.scalar[DT] = rung_below(self.longest, self.first * shortest)

    def prepare(self, state, law):
        return _work(state)

    def renew(self, state, law, work):
        return _renewed(state, work)

    def step(self, state, law, drive, box, scratch, work):
        scalar, counter = state.scalar, state.counter
        dt = scalar[DT]
        kick = 0.5 * (scalar[DT_DRIFT] + dt)
        ended = contact_forces(state, law, box, scratch, kick)
        if counter[STEPS] % SAMPLE_EVERY == 0:
            drive.sample(state, law)
        drive.load(state, kick)
        # the first step after a long one still begins with what that one has put in
        held = max(dt, scalar[DT_DRIFT])
        if work.made[0] != held or work.made[1] > TURNED:
            make_matrix(state, law, box, self.theta, held, work)
        scalar[LOST_DAMP] += weigh(state, self.calming / kick, kick, work)
        drive.move(state, box, kick, dt)
        scalar[DT_DRIFT] = dt
        scalar[TIME] += dt
        counter[STEPS] += 1
        return ended

    def farthest(self):
        return self.travel

    def limit(self, state, law, drive, box, far, least, work):
        scalar = state.scalar
        greatest, stretching = contact_speeds(state, law, work.turn_rate)
        work.made[1] = add_turns(work, scalar[DT_DRIFT])
        scalar[STRETCH] = stretching * scalar[DT_DRIFT]
        speed = max(greatest / self.displacement, scalar[FASTEST] / self.travel)
        allowed = min(self.longest, drive.longest_step(state))
        # what lands must not do so with an overlap that no force has worked for
        allowed = min(allowed, time_to_overlap(state, box, far, self.displacement))
        if speed > 0.0:
            allowed = min(allowed, 1.0 / speed)
        work.count[0] += 1
        if allowed < scalar[DT]:
            scalar[DT] = rung_below(self.longest, allowed)
            work.count[0] = 0
        elif work.count[0] >= CLIMB_AFTER and scalar[DT] / RUNG <= allowed * 1.000001:
            scalar[DT] = rung_below(self.longest, scalar[DT] / RUNG * 1.000001)
            work.count[0] = 0


@jit
def rung_below(longest, step):
    """The longest of the allowed lengths of a step that is not above `step` [s]."""
    rungs = max(0.0, math.ceil(math.log(step / longest) / math.log(RUNG) - 1e-9))
    return longest * RUNG**rungs


@jit
def _work(state):
    n, contacts = state.counter[MONOMERS], state.counter[CONTACTS]
    factor = order_blocks(n, state.pair_i, state.pair_j, contacts)
    block = np.empty(contacts, dtype=np.int64)
    _find_blocks(state, factor, block)
    return Work(
        factor, block, np.zeros(PADDED * n), np.zeros(PADDED * n), np.zeros(2), np.zeros(n), np.zeros(n),
        np.zeros(n, dtype=np.bool_), np.zeros(6 * PADDED), np.zeros(1, dtype=np.int64),
    )  # fmt: skip


@jit
def _find_blocks(state, factor, block):
    """Find the block of each contact; False when one has none."""
    for k in range(block.shape[0]):
        i, j = np.int64(state.pair_i[k]), np.int64(state.pair_j[k])
        if i == j:
            block[k] = -1
            continue
        at, turned = find_block(factor, i, j)
        if at < 0:
            return False
        block[k] = 2 * at + turned
    return True


@jit
def _renewed(state, work):
    """The same after contacts have changed; the order of elimination stays where the pattern has room for them."""
    contacts = state.counter[CONTACTS]
    if work.factor.place.shape[0] == state.counter[MONOMERS]:
        block = np.empty(contacts, dtype=np.int64)
        if _find_blocks(state, work.factor, block):
            work.made[0] = 0.0
            return Work(
                work.factor, block, work.x, work.strain, work.made, work.turned, work.turn_rate, work.chosen, work.rows,
                work.count,
            )  # fmt: skip
    fresh = _work(state)
    fresh.count[:] = work.count
    return fresh


# Inlined, so that there is one compiled version of it: a process that compiles the time loop would else call another
# one than a process that loads it, which rounds differently.
@jit(forceinline=True)
def make_matrix(state, law, box, theta, dt, work):
    """Make M' and factorise it; where it is there for this step, the parts of those fragments that have turned.

    Parameters
    ----------
    state : State
    law, box : parts
    theta : float
    dt : float
        Step [s].
    work : Work

    Notes
    -----
    The unknowns of a monomer are v and a w, velocity and spin times radius, so that all blocks are masses. With n from
    j to i the contact points slide by P g, P = 1 - n n^T and g = v_i - v_j + arm_i x (a_i w_i) + arm_j x (a_j w_j); a
    rigid motion has g = 0 (`arms`). After rolling the arms are not along n, and a contact that twists slides as well.
    Taken along n they would tell the step too little stiffness: a grain that has rolled by more than about r_0 would
    never come to rest.

    In a box that changes with H the velocities are peculiar, and the points recede by H d as well. M' needs it not,
    but calming does: else it would slow down rigid bodies, which move against the box.

    Fragments share no contact, so each has a part of the matrix that is made and factorised by itself. Most parts
    that are made anew are those of small pieces that spin away.
    """
    factor, strain, chosen, turned, rows = work.factor, work.strain, work.chosen, work.turned, work.rows
    diagonal, lower = factor.diagonal, factor.lower
    whole = work.made[0] != dt
    for i in range(state.counter[MONOMERS]):
        p = factor.place[i]
        chosen[p] = whole or turned[state.fragment[i]] > TURNED
        if chosen[p]:
            strain[PADDED * p : PADDED * (p + 1)] = 0.0
            diagonal[BLOCK * p : BLOCK * (p + 1)] = 0.0
            lower[BLOCK * factor.first[p] : BLOCK * factor.first[p + 1]] = 0.0
            m = state.monomer[np.uint64(i) * _ROW + MASS]
            for c in range(3):
                diagonal[BLOCK * p + (PADDED + 1) * c] = m
                diagonal[BLOCK * p + (PADDED + 1) * (c + 3)] = SPHERE * m
    edges = box.edges(state.scalar)
    hx, hy, hz = box.rates()
    changing = hx != 0.0 or hy != 0.0 or hz != 0.0
    weight = theta * dt * dt
    for k in range(state.counter[CONTACTS]):
        i, j = np.int64(state.pair_i[k]), np.int64(state.pair_j[k])
        if not chosen[factor.place[i]]:
            continue
        at = contact_start(law, k)
        n = (state.contact[at + NCX], state.contact[at + NCY], state.contact[at + NCZ])
        a_i = state.monomer[np.uint64(i) * _ROW + RADIUS]
        a_j = state.monomer[np.uint64(j) * _ROW + RADIUS]
        dx, dy, dz, distance = difference(state, edges, i, j, get_image(state, k))
        p_i, p_j = law.pointers(state.contact, at)
        arm_i, arm_j = arms(n, a_i, p_i, a_j, p_j, distance)
        k_n, k_s, k_r, k_t = law.stiffness(state.contact, at)
        k_n = weight * k_n + dt * law.damping_now(state.contact, at)
        k_s, k_r, k_t = weight * k_s, weight * k_r, weight * k_t
        _write_rows(rows, n, arm_i, arm_j)
        own_i, own_j = np.uint64(BLOCK * factor.place[i]), np.uint64(BLOCK * factor.place[j])
        both = -1.0 / (a_i * a_j)
        _add_block(diagonal, own_i, rows, _OF_I, _OF_I, k_n, k_s, k_r / (a_i * a_i), k_t / (a_i * a_i))
        _add_block(diagonal, own_j, rows, _OF_J, _OF_J, k_n, k_s, k_r / (a_j * a_j), k_t / (a_j * a_j))
        if i == j:
            _add_block(diagonal, own_i, rows, _OF_I, _OF_J, -k_n, k_s, k_r * both, k_t * both)
            _add_block(diagonal, own_i, rows, _OF_J, _OF_I, -k_n, k_s, k_r * both, k_t * both)
        else:
            of_row, of_column = (_OF_I, _OF_J) if work.block[k] % 2 == 1 else (_OF_J, _OF_I)
            shared = np.uint64(BLOCK * (work.block[k] // 2))
            _add_block(lower, shared, rows, of_row, of_column, -k_n, k_s, k_r * both, k_t * both)
        if changing:
            recede = (hx * dx, hy * dy, hz * dz)
            _add_strain(strain, PADDED * factor.place[i], recede, n, k_n, k_s, 1.0, arm_i)
            _add_strain(strain, PADDED * factor.place[j], recede, n, k_n, k_s, -1.0, arm_j)
    if not factorise(factor, chosen):
        state.scalar[FASTEST] = math.nan
    for i in range(state.counter[MONOMERS]):
        if chosen[factor.place[i]]:
            turned[state.fragment[i]] = 0.0
    work.made[0], work.made[1] = dt, 0.0


@jit(forceinline=True)
def arms(n, a_i, p_i, a_j, p_j, distance):
    """Arms of a contact over the radii: its points recede by v_i - v_j + arm_i x (a_i w_i) + arm_j x (a_j w_j).

    Parameters
    ----------
    n : tuple of float
        Direction from j to i.
    a_i, a_j : float
        Radii [m].
    p_i, p_j : tuple of float
        Unit vectors from the contact to the centre of i, and from that of j to the contact, fixed in the monomers:
        after rolling they are not along n.
    distance : float
        Of the centres [m].

    Returns
    -------
    arm_i, arm_j : tuple of float
        p_i and p_j scaled, less what the contact has slid, so that a rigid motion makes nothing recede.
    """
    x = a_i * p_i[0] + a_j * p_j[0]
    y = a_i * p_i[1] + a_j * p_j[1]
    z = a_i * p_i[2] + a_j * p_j[2]
    along = x * n[0] + y * n[1] + z * n[2]
    scale = distance / along
    slid = 1.0 / (a_i + a_j)
    x, y, z = slid * (x - along * n[0]), slid * (y - along * n[1]), slid * (z - along * n[2])
    return (
        (scale * (p_i[0] - x), scale * (p_i[1] - y), scale * (p_i[2] - z)),
        (scale * (p_j[0] - x), scale * (p_j[1] - y), scale * (p_j[2] - z)),
    )


@jit(forceinline=True)
def _write_rows(rows, n, arm_i, arm_j):
    """Write what the motion of i and j does at their contact: rows of J, each for six unknowns, padded to eight.

    With the tangents e1, e2 of the direction n these are n for the velocity (from `_NORMAL` on), n for the spin (from
    `_TWIST`), and for each monomer (+-e1, e1 x arm) and (+-e2, e2 x arm), from `_OF_I` and `_OF_J`: P [arm x] is the
    sum over the tangents of e (e x arm)^T.
    """
    first, second = tangents(n)
    for c in range(3):
        rows[_NORMAL + np.uint64(c)] = rows[_TWIST + np.uint64(c + 3)] = n[c]
    q = _OF_I
    for e in (first, second):
        turn_i, turn_j = _cross(e, arm_i), _cross(e, arm_j)
        for c in range(3):
            axis, spin = np.uint64(c), np.uint64(c + 3)
            rows[q + axis], rows[q + spin] = e[c], turn_i[c]
            rows[q + _FROM_I_TO_J + axis], rows[q + _FROM_I_TO_J + spin] = -e[c], turn_j[c]
        q += _PADDED


@jit(forceinline=True)
def tangents(n):
    """Two unit vectors that are normal to a third and to each other (Duff et al. 2017, J. Comput. Graph. Tech. 6, 1)."""
    x, y, z = n
    sign = math.copysign(1.0, z)
    a = -1.0 / (sign + z)
    b = x * y * a
    return (1.0 + sign * x * x * a, sign * b, -sign * x), (b, sign + y * y * a, -y)


@jit(forceinline=True)
def _add_block(target, at, rows, left, right, k_n, k_s, k_r, k_t):
    """Add J_left^T K J_right of one contact to a block that is kept column by column.

    The rolling stiffness counts for all spins, that of twisting for what is left along n.
    """
    one, normal, twist = left, load8(rows, _NORMAL), load8(rows, _TWIST)
    two = one + _PADDED
    normal = multiply8(spread8(k_n), normal)
    twist = multiply8(spread8(k_t - k_r), twist)
    slide_1 = multiply8(spread8(k_s), load8(rows, one))
    slide_2 = multiply8(spread8(k_s), load8(rows, two))
    for column in range(3):
        c = np.uint64(column)
        t = at + _PADDED * c
        s = add8(load8(target, t), multiply8(normal, spread8(rows[_NORMAL + c])))
        s = add8(s, multiply8(slide_1, spread8(rows[right + c])))
        store8(target, t, add8(s, multiply8(slide_2, spread8(rows[right + _PADDED + c]))))
    for column in range(3, 6):
        c = np.uint64(column)
        t = at + _PADDED * c
        s = add8(load8(target, t), multiply8(twist, spread8(rows[_TWIST + c])))
        s = add8(s, multiply8(slide_1, spread8(rows[right + c])))
        store8(target, t, add8(s, multiply8(slide_2, spread8(rows[right + _PADDED + c]))))
        target[t + c] += k_r


@jit(forceinline=True)
def _add_strain(target, at, recede, n, k_n, k_s, sign, arm):
    """J^T K H d of one contact, rows of one of its monomers, from the velocity H d at which its points recede."""
    along = n[0] * recede[0] + n[1] * recede[1] + n[2] * recede[2]
    slide = (
        k_s * (recede[0] - along * n[0]),
        k_s * (recede[1] - along * n[1]),
        k_s * (recede[2] - along * n[2]),
    )
    moment = _cross(slide, arm)
    for c in range(3):
        target[at + c] += sign * (k_n * along * n[c] + slide[c])
        target[at + 3 + c] += moment[c]


@jit(forceinline=True)
def _cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@jit
def weigh(state, rate, kick, work):
    """Turn the forces F into M (M'^-1 (F + rate (M v - s)) - rate v), which moves monomers of true mass as M' says.

    The terms with the rate [1/s] take stiff motion away and leave soft motion, for which M'^-1 (M v - s) is v. s is the
    `strain` of the box.

    Returns
    -------
    float
        Work of the forces in the kick to come, of this duration [s], less that of what they are turned into [J]: it is
        missing in the motion, and counts as damped.
    """
    monomer, force, x, strain = state.monomer, state.force, work.x, work.strain
    place = work.factor.place
    n = state.counter[MONOMERS]
    for k in range(n):
        q = np.uint64(k) * _FORCE_ROW
        to = PADDED * place[k]
        r = np.uint64(k) * _ROW
        radius = monomer[r + RADIUS]
        inv = 1.0 / radius
        pull = rate * monomer[r + MASS]
        turn = rate * SPHERE * monomer[r + MASS] * radius
        for axis in range(3):
            a = np.uint64(axis)
            x[to + axis] = force[q + FORCE_X + a] + pull * monomer[r + VX + a] - rate * strain[to + axis]
            turned = turn * monomer[r + WX + a] - rate * strain[to + 3 + axis]
            x[to + 3 + axis] = force[q + TORQUE_X + a] * inv + turned
    solve(work.factor, x)
    taken = 0.0
    for k in range(n):
        r = np.uint64(k) * _ROW
        q = np.uint64(k) * _FORCE_ROW
        to = PADDED * place[k]
        m = monomer[r + MASS]
        radius = monomer[r + RADIUS]
        inv = 1.0 / radius
        spin = SPHERE * m * radius
        for axis in range(3):
            a = np.uint64(axis)
            v, w = monomer[r + VX + a], monomer[r + WX + a]
            rise = x[to + axis] - rate * v
            turn = (x[to + 3 + axis] - rate * radius * w) * inv
            taken += (force[q + FORCE_X + a] - m * rise) * (v + 0.5 * kick * rise)
            taken += (force[q + TORQUE_X + a] - spin * radius * turn) * (w + 0.5 * kick * turn)
            force[q + FORCE_X + a] = m * rise
            force[q + TORQUE_X + a] = spin * radius * turn
    return kick * taken


@jit
def contact_speeds(state, law, turning):
    """Greatest speed at which two monomers in contact move or roll against each other, and at which contacts turn.

    Parameters
    ----------
    state : State
    law : part
    turning : (n,) float64
        Filled: for each fragment the greatest angular velocity of a line between two centres [rad/s], an upper limit.

    Returns
    -------
    greatest : float
        Of the contact points, or of the spins times the reduced radius [m/s].
    stretching : float
        Of the contact points along the line between the centres [m/s].
    """
    monomer, contact = state.monomer, state.contact
    turning[:] = 0.0
    greatest, stretching = 0.0, 0.0
    for k in range(state.counter[CONTACTS]):
        at = contact_start(law, k)
        i = state.pair_i[k] * _ROW
        j = state.pair_j[k] * _ROW
        a_i, a_j = monomer[i + RADIUS], monomer[j + RADIUS]
        nx, ny, nz = contact[at + NCX], contact[at + NCY], contact[at + NCZ]
        one = np.uint64(1)
        two = np.uint64(2)
        wx = a_i * monomer[i + WX] + a_j * monomer[j + WX]
        wy = a_i * monomer[i + WX + one] + a_j * monomer[j + WX + one]
        wz = a_i * monomer[i + WX + two] + a_j * monomer[j + WX + two]
        vx = monomer[i + VX] - monomer[j + VX]
        vy = monomer[i + VX + one] - monomer[j + VX + one]
        vz = monomer[i + VX + two] - monomer[j + VX + two]
        fragment = state.fragment[state.pair_i[k]]
        turning[fragment] = max(turning[fragment], (vx * vx + vy * vy + vz * vz) / (a_i + a_j) ** 2)
        stretching = max(stretching, abs(vx * nx + vy * ny + vz * nz))
        gx = vx + ny * wz - nz * wy
        gy = vy + nz * wx - nx * wz
        gz = vz + nx * wy - ny * wx
        r = a_i * a_j / (a_i + a_j)
        tx = monomer[i + WX] - monomer[j + WX]
        ty = monomer[i + WX + one] - monomer[j + WX + one]
        tz = monomer[i + WX + two] - monomer[j + WX + two]
        greatest = max(greatest, gx * gx + gy * gy + gz * gz, r * r * (tx * tx + ty * ty + tz * tz))
    for fragment in range(turning.shape[0]):
        turning[fragment] = math.sqrt(turning[fragment])
    return math.sqrt(greatest), stretching


@jit
def add_turns(work, duration):
    """Count by how much the contacts of each fragment may have turned in so many seconds; the greatest sum [rad]."""
    greatest = 0.0
    for fragment in range(work.turned.shape[0]):
        work.turned[fragment] += work.turn_rate[fragment] * duration
        greatest = max(greatest, work.turned[fragment])
    return greatest


def semi_implicit(*, longest, displacement=1e-10, travel=1e-9, theta=0.5, calming=0.0, first=0.125):
    """The linearly implicit integrator.

    Parameters
    ----------
    longest : float
        The longest step [s].
    displacement, travel : float
        By how much two monomers in contact may move against each other, and one may move at all, in a step [m].
    theta : float
        Weight of the stiffness in the mass matrix; at least 1/4, below which long steps are unstable.
    calming : float
        Part of the stiff motion, between 0 and 1, that a step takes away. It is for aggregates whose equilibria alone
        matter, and lets them come to rest.
    first : float
        f of the first step.

    Returns
    -------
    SemiImplicit

    Raises
    ------
    InputError
    """
    numbers = {"longest": longest, "displacement": displacement, "travel": travel, "first": first}
    for name, value in numbers.items():
        if not (np.isfinite(value) and value > 0.0):
            raise InputError(f"{name} is {value!r}; it must be a number above 0.")
    if not 0.25 <= theta <= 10.0:
        raise InputError(f"theta is {theta!r}; it must be between 0.25 and 10.")
    if not 0.0 <= calming < 1.0:
        raise InputError(f"calming is {calming!r}; it must be between 0 and 1.")
    options = (longest, displacement, travel, theta, calming, first)
    return SemiImplicit(*map(float, options), False)
