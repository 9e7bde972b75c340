"""The engine timed as a spin-up uses it: contacts, limits, damping, turning frame, search for contacts, breaking."""

import time
from typing import NamedTuple

import numpy as np
from ratd.engine.advance import FULL, STEPS_DONE, advance

from ratd.drives.rotating import Drive, make_drive
from ratd.engine.contacts import update_contact_rates
from ratd.engine.fragments import find_fragments
from ratd.engine.layout import CONTACTS, DT, DT_DRIFT, OMEGA, STEPS, TIME
from ratd.engine.state import State, new_state, with_room
from ratd.experiments.spin_up.cut_bound import cut_bound
from ratd.experiments.spin_up.run import TIMESTEP_FACTOR, relax

EPSILON = 1e-9
"""So small that omega stays as it is however long the measurement: ten monomers make a microsecond in a second."""


class Turning(NamedTuple):
    """An aggregate in its turning frame.

    Attributes
    ----------
    state : ratd.engine.state.State
    drive : ratd.drives.rotating.Drive
    omega : float
        Angular velocity at the start [rad/s].
    """

    state: State
    drive: Drive
    omega: float

    @property
    def contacts(self):
        """Number of contacts now."""
        return int(self.state.counter[CONTACTS])

    @property
    def timestep(self):
        """The step [s]."""
        return float(self.state.scalar[DT])

    @property
    def memory(self):
        """Size of all arrays of the state [byte]."""
        return sum(array.nbytes for array in self.state)


def turning(grain, part, *, relaxed=True):
    """Let the frame of a grain turn, with the drive `prescribed`, at a rate that changes nothing.

    Parameters
    ----------
    grain : ratd.Grain
    part : float
        Angular velocity in units of the cut bound omega_1, below 1. 0 is at rest: every term of
        the turning frame is computed, and none does anything.
    relaxed : bool
        Whether the grain is relaxed before, as in a spin-up. One as grown is at rest but for a few chance contacts.

    Returns
    -------
    Turning
    """
    if relaxed:
        state = relax(grain, timestep_factor=TIMESTEP_FACTOR)
    else:
        state = new_state(grain.position, grain.radius, grain.material, grain.contacts, timestep_factor=TIMESTEP_FACTOR)
    update_contact_rates(state, TIMESTEP_FACTOR, True)
    state.scalar[DT_DRIFT] = state.scalar[DT]
    find_fragments(state)
    omega_1 = cut_bound(grain)
    # the exponential law is linear for so small a rate: start in the middle of it
    acceleration = EPSILON * omega_1**2
    drive = make_drive("prescribed", omega_1=omega_1, angular_acceleration=acceleration)
    state.scalar[TIME] = part * omega_1 / acceleration
    state.scalar[OMEGA] = part * omega_1
    return Turning(state, drive, part * omega_1)


def timed(body, steps):
    """Go on by some steps.

    Parameters
    ----------
    body : Turning
    steps : int

    Returns
    -------
    body : Turning
        Its arrays are the old ones, changed, or larger ones.
    seconds : float
        Processor time [s].
    """
    state = body.state
    goal = int(state.counter[STEPS]) + steps
    code = FULL
    start = time.process_time()
    while code == FULL:
        code = advance(state, body.drive, np.inf, goal, -1, TIMESTEP_FACTOR, True)
        if code == FULL:
            state = with_room(state, 2 * len(state.pair_i))
    seconds = time.process_time() - start
    if code != STEPS_DONE:
        raise RuntimeError(f"the engine returned {code} after {state.counter[STEPS]} of {goal} steps")
    return body._replace(state=state), seconds
