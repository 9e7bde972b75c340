"""The time loop: steps, contacts made and broken, lists of near pairs."""

from typing import NamedTuple

import numpy as np

from ratd.base.errors import InputError
from ratd.base.jit import jit
from ratd.engine.contacts import append_contact, contact_start, get_image, remove_contact, update_contact_rates
from ratd.engine.forces import working_space
from ratd.engine.layout import (
    CLOCK, CONTACTS, DT, DT_DRIFT, FASTEST, LARGEST_CONTACTS, SEARCHES, STEPS, TIME,
)  # fmt: skip
from ratd.engine.lists import (
    FAR,
    NEAR,
    count_touching,
    farthest_move,
    growth,
    mean_radius,
    near_pairs,
    positions,
    reach_left,
    take_touching,
    with_pair,
)
from ratd.engine.state import with_room
from ratd.geometry.box import pairs_within

REACHED, FEW_CONTACTS, STEPS_DONE, FULL, NOT_FINITE = range(5)
"""Why `advance` returned: time or clock reached, few contacts left, number of steps reached, no room for a new contact,
a velocity that is no finite number."""


NEVER = np.iinfo(np.int64).max
CALL = 100_000
"""Steps of a call of `advance` at most where somebody waits: Ctrl-C, progress and checkpoints come between calls."""


class Until(NamedTuple):
    """When `advance` is to return, whichever comes first.

    Attributes
    ----------
    steps : int
        Total number of steps.
    time : float
        Time [s].
    clock : float
        What the drive counts (omega [rad/s] where it turns the aggregate).
    fewest_contacts : int
        The largest fragment has no more contacts than this, where the drive follows it; -1 for never.
    """

    steps: int
    time: float
    clock: float
    fewest_contacts: int


def until(*, steps=NEVER, time=np.inf, clock=np.inf, fewest_contacts=-1):
    """`Until` with what is not given left open."""
    return Until(int(steps), float(time), float(clock), int(fewest_contacts))


@jit
def advance(state, law, drive, box, integrator, until):
    """Integrate until something ends it.

    Parameters
    ----------
    state : State
        Changed in place. The same sequence of calls gives the same bits.
    law, drive, box, integrator : parts
        See `ratd.laws`, `ratd.drives`, `ratd.geometry.box`, `ratd.engine.leapfrog`.
    until : Until

    Returns
    -------
    int
        `REACHED`, `FEW_CONTACTS`, `STEPS_DONE`, `NOT_FINITE`, or `FULL`: make room for contacts and call again.
    """
    scalar = state.scalar
    counter = state.counter
    scratch = working_space()
    mean, least, greatest = mean_radius(state)
    # in a long step two monomers may come from beyond what a short one reaches
    far_reach = FAR * mean + 2.0 * integrator.farthest()
    near_reach = NEAR * mean + 2.0 * integrator.farthest()
    turning = drive.turning()

    far_reference, radius = positions(state)
    near_reference = far_reference
    far_edges = box.edges(scalar)
    near_edges = far_edges
    far = pairs_within(far_reference, radius, far_reach, far_edges)
    near, n_near = near_pairs(state, box, far, near_reach)
    travel = 0.0
    drive.follow(state, False)
    work = integrator.prepare(state, law)
    while True:
        if counter[LARGEST_CONTACTS] <= until.fewest_contacts:
            return FEW_CONTACTS
        if scalar[TIME] >= until.time or state.drive[CLOCK] >= until.clock:
            return REACHED
        if counter[STEPS] >= until.steps:
            return STEPS_DONE
        if counter[CONTACTS] + n_near > state.pair_i.shape[0]:
            return FULL

        ended = integrator.step(state, law, drive, box, scratch, work)
        dt = scalar[DT_DRIFT]
        if not scalar[FASTEST] < np.inf:
            return NOT_FINITE

        changed = False
        if ended > 0:
            for k in range(counter[CONTACTS] - 1, -1, -1):
                if law.ended(state.contact, contact_start(law, k)):
                    i, j = np.int64(state.pair_i[k]), np.int64(state.pair_j[k])
                    near, n_near = with_pair(near, n_near, i, j, get_image(state, k))
                    remove_contact(state, law, k)
            changed = True
        found = count_touching(state, box, near, n_near)
        if found > 0:
            touching, n_near = take_touching(state, box, near, n_near, found)
            for p in range(found):
                image = (touching[p, 2], touching[p, 3], touching[p, 4])
                append_contact(state, law, box, touching[p, 0], touching[p, 1], image, dt, False)
            changed = True
        if changed:
            _take_note(state, law, drive, integrator)
            work = integrator.renew(state, law, work)

        # The list has to hold for the next step as well, before which nobody looks.
        ahead = scalar[FASTEST] * dt
        travel += ahead
        scale = growth(box, scalar, near_edges)
        left = reach_left(near_reach, scale, greatest)
        if 2.0 * (travel + ahead) > left:
            travel = farthest_move(state, near_reference, scale, turning)
            if 4.0 * travel > left or 2.0 * (travel + ahead) > left:
                gone = drive.leave(state, law)
                scale = growth(box, scalar, far_edges)
                near_reference, radius = positions(state)
                near_edges = box.edges(scalar)
                worn = gone > 0
                if not worn:
                    moved = farthest_move(state, far_reference, scale, turning)
                    worn = 2.0 * moved > reach_left(far_reach, scale, greatest) - near_reach
                if worn:
                    far_reference = near_reference
                    far_edges = near_edges
                    far = pairs_within(far_reference, radius, far_reach, far_edges)
                    counter[SEARCHES] += 1
                near, n_near = near_pairs(state, box, far, near_reach)
                travel = 0.0
                if gone > 0:
                    _take_note(state, law, drive, integrator)
                    work = integrator.renew(state, law, work)
        integrator.limit(state, law, drive, box, far, least, work)


@jit
def _take_note(state, law, drive, integrator):
    """What follows from contacts that were made, broken or dropped."""
    update_contact_rates(state, law, integrator)
    drive.follow(state, True)


def run(state, law, drive, box, integrator, until):
    """`advance`, with more room for contacts when they need it.

    Returns
    -------
    state : State
    code : int
        Why it ended, see `advance`.

    Raises
    ------
    InputError
        If neither a contact nor an option says how long a step is.
    RuntimeError
        If a velocity is no finite number; its attribute ``state`` holds the state at that step, whose contacts may have
        more room than those of the state that was given.
    """
    if not state.scalar[DT] > 0.0:
        raise InputError("timestep is not given; a single sphere needs one, since it has no contact to take it from.")
    while True:
        code = advance(state, law, drive, box, integrator, until)
        if code == NOT_FINITE:
            error = RuntimeError(
                f"the integration failed at step {state.counter[STEPS]}, time {state.scalar[TIME]:.4g} s: a velocity "
                "is no finite number; try a smaller time step"
            )
            error.state = state
            raise error
        if code != FULL:
            return state, code
        state = with_room(state, law, box, 2 * len(state.pair_i))
