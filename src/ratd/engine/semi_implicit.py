"""A linearly implicit step: the contacts' stiffness is part of the mass matrix, so that it limits the step no longer.

In place of M the step uses M' = M + theta dt^2 sum J^T K J + dt sum J^T C J over the contacts, with J the relative
motion at a contact, K its stiffness and C its damping. Soft motion, which is what a slowly loaded aggregate does, has
J near 0 and keeps its mass; stiff vibrations become slow enough for the step. Equilibria do not depend on M'. Rigid
motion of a fragment has J = 0, so momentum is kept, and angular momentum as far as the matrix has followed.
"""

import math
from typing import NamedTuple

import numpy as np

from ratd.base.checks import is_number
from ratd.base.errors import InputError
from ratd.base.jit import jit
from ratd.base.parts import part
from ratd.engine.block_factor import PADDED, BlockFactor, find_block, order_blocks
from ratd.engine.contacts import contact_start
from ratd.engine.forces import contact_forces
from ratd.engine.layout import (
    CONTACTS, DT, DT_DRIFT, FASTEST, LOST_DAMP, LOST_MADE, MONOMERS, RADIUS, ROW, STEADY, STEPS, STRETCH, TIME, VX, WX,
)  # fmt: skip
from ratd.engine.leapfrog import SAMPLE_EVERY
from ratd.engine.lists import time_to_overlap
from ratd.engine.mass_matrix import TURNED, make_matrix, weigh
from ratd.laws.contact_fields import NCX, NCY, NCZ

RUNG = math.sqrt(0.5)
"""Steps are the longest one times a power of this, so that the matrix seldom changes."""
CLIMB_AFTER = 8
"""Steps on a rung before the next longer one is tried."""

_ROW = np.uint64(ROW)


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
        Space for one contact, see `ratd.engine.mass_matrix`.
    landed : (1,) float64
        `LOST_MADE` when contacts last changed [J]: it has grown since where two monomers have met.
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
    landed: np.ndarray


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
    calming, calmed : float
        Part of the stiff motion that a step takes away, up to this length of the step [s]; of longer ones less.
    first : float
        f of the first step, times the shortest time of any contact.
    landing : float
        The longest step [s] where two monomers meet.
    implicit_damping : bool
        Always false: the damping is part of the matrix.
    """

    longest: float
    displacement: float
    travel: float
    theta: float
    calming: float
    calmed: float
    first: float
    landing: float
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
        # the speeds say nothing yet of the fall into a new contact, which one long step would pass over
        if state.scalar[LOST_MADE] > work.landed[0] and self.landing < state.scalar[DT]:
            state.scalar[DT] = rung_below(self.longest, self.landing)
            state.counter[STEADY] = 0
        work.landed[0] = state.scalar[LOST_MADE]
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
        rate = self.calming / kick * min(1.0, self.calmed / kick)
        scalar[LOST_DAMP] += weigh(state, rate, scalar[DT_DRIFT], dt, box.rates(), work)
        drive.move(state, box, kick, dt)
        scalar[DT_DRIFT] = dt
        scalar[TIME] += dt
        counter[STEPS] += 1
        return ended

    def farthest(self):
        return self.travel

    def limit(self, state, law, drive, box, far, least, work):
        scalar, counter = state.scalar, state.counter
        greatest, stretching = contact_speeds(state, law, work.turn_rate)
        work.made[1] = add_turns(work, scalar[DT_DRIFT])
        scalar[STRETCH] = stretching * scalar[DT_DRIFT]
        speed = max(greatest / self.displacement, scalar[FASTEST] / self.travel)
        allowed = min(self.longest, drive.longest_step(state))
        # What lands must not do so with an overlap that no force has worked for, and in short steps.
        touch, overlap = time_to_overlap(state, box, far, self.displacement)
        allowed = min(allowed, overlap, max(self.landing, 0.5 * touch))
        if speed > 0.0:
            allowed = min(allowed, 1.0 / speed)
        counter[STEADY] += 1
        if allowed < scalar[DT]:
            scalar[DT] = rung_below(self.longest, allowed)
            counter[STEADY] = 0
        elif counter[STEADY] >= CLIMB_AFTER and scalar[DT] / RUNG <= allowed * 1.000001:
            scalar[DT] = rung_below(self.longest, scalar[DT] / RUNG * 1.000001)
            counter[STEADY] = 0


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
        np.zeros(n, dtype=np.bool_), np.zeros(6 * PADDED), np.full(1, state.scalar[LOST_MADE]),
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
                work.landed,
            )  # fmt: skip
    fresh = _work(state)
    fresh.landed[0] = work.landed[0]
    return fresh


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


def semi_implicit(
    *, longest, displacement=1e-10, travel=1e-9, theta=0.5, calming=0.0, calmed=math.inf, first=0.125, landing=math.inf
):
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
    calmed : float
        Length of a step [s] above which it takes less, as the inverse of the length. It also takes some of soft motion,
        as a viscosity of calming theta dt times the stiffness would: so this stops growing with the step.
    first : float
        f of the first step.
    landing : float
        The longest step where two monomers meet [s]. Where it is a part of the time of a vibration, the fall into a new
        contact keeps the balance of energy. In long steps some per cent of what falling sets free is lost untold.

    Returns
    -------
    SemiImplicit

    Raises
    ------
    InputError
    """
    numbers = {"longest": longest, "displacement": displacement, "travel": travel, "first": first}
    for name, value in numbers.items():
        if not (is_number(value) and value > 0.0):
            raise InputError(f"{name} is {value!r}; it must be a number above 0.")
    if not (is_number(theta) and 0.25 <= theta <= 10.0):
        raise InputError(f"theta is {theta!r}; it must be between 0.25 and 10.")
    if not (is_number(calming) and 0.0 <= calming < 1.0):
        raise InputError(f"calming is {calming!r}; it must be between 0 and 1.")
    for name, value in {"calmed": calmed, "landing": landing}.items():
        if not value > 0.0:
            raise InputError(f"{name} is {value!r}; it must be a number above 0.")
    options = (longest, displacement, travel, theta, calming, calmed, first, landing)
    return SemiImplicit(*map(float, options), False)
