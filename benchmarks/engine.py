"""The engine timed as a run uses it: contacts, limits, damping, drive, search for contacts, breaking."""

import time
from typing import NamedTuple

from ratd.drives.free import Free, free
from ratd.drives.largest import OMEGA
from ratd.drives.rotating import Rotating, rotating
from ratd.drives.squeezing import Squeezing, squeezing
from ratd.engine.layout import CONTACTS, DT, STEPS, TIME
from ratd.engine.leapfrog import leapfrog
from ratd.engine.state import State, new_state
from ratd.engine.step import STEPS_DONE, run, until
from ratd.experiments.relax import relax
from ratd.experiments.spin_up.cut_bound import cut_bound
from ratd.experiments.spin_up.how import TIMESTEP_FACTOR
from ratd.geometry.box import Open, Periodic, open_space, periodic
from ratd.laws import dmt, jkr

EPSILON = 1e-9
"""So small that omega stays as it is however long the measurement: ten monomers make a microsecond in a second."""
SHRINKING = -1.0
"""Rate [1/s] of the box, at which nothing happens in the microseconds of a measurement."""
INTEGRATOR = leapfrog(timestep_factor=TIMESTEP_FACTOR)


class Body(NamedTuple):
    """An aggregate, and what moves it.

    Attributes
    ----------
    state : ratd.engine.state.State
    law, drive, box : parts of the engine
    omega : float
        Angular velocity at the start [rad/s].
    """

    state: State
    law: NamedTuple
    drive: Rotating | Squeezing | Free
    box: Open | Periodic
    omega: float = 0.0

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
    Body
    """
    law, box = jkr(), open_space()
    if relaxed:
        state = relax(grain, law=law, timestep_factor=TIMESTEP_FACTOR)
    else:
        state = _as_grown(grain, law, box)
    omega_1 = cut_bound(grain)
    # the exponential law is linear for so small a rate: start in the middle of it
    acceleration = EPSILON * omega_1**2
    drive = rotating("prescribed", omega_1=omega_1, angular_acceleration=acceleration)
    state.scalar[TIME] = part * omega_1 / acceleration
    state.drive[OMEGA] = part * omega_1
    return Body(state, law, drive, box, part * omega_1)


def boxed(grain):
    """A grain at rest in a periodic box that shrinks at a rate that changes nothing, as a `Body`."""
    law, box = jkr(), periodic(4.0 * grain.enclosing_radius, SHRINKING)
    return Body(_as_grown(grain, law, box), law, squeezing(), box)


def other_law(grain):
    """A grain at rest with the law of Derjaguin, Muller & Toporov and friction of limited force, as a `Body`."""
    law, box = dmt(viscous_time=0.5e-9), open_space()
    return Body(relax(grain, law=law, timestep_factor=TIMESTEP_FACTOR), law, free(), box)


def _as_grown(grain, law, box):
    return new_state(grain.position, grain.radius, grain.material, grain.contacts, law, box, INTEGRATOR)


def timed(body, steps):
    """Go on by some steps.

    Parameters
    ----------
    body : Body
    steps : int

    Returns
    -------
    body : Body
        Its arrays are the old ones, changed, or larger ones.
    seconds : float
        Processor time [s].
    """
    goal = until(steps=body.state.counter[STEPS] + steps)
    start = time.process_time()
    state, code = run(body.state, body.law, body.drive, body.box, INTEGRATOR, goal)
    seconds = time.process_time() - start
    if code != STEPS_DONE:
        raise RuntimeError(f"the engine returned {code} after {state.counter[STEPS]} of {goal.steps} steps")
    return body._replace(state=state), seconds
