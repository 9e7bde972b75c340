"""Leapfrog: the explicit integrator. Velocities stand half a step behind the positions."""

from typing import NamedTuple

import numpy as np

from ratd.base.checks import is_number
from ratd.base.errors import InputError
from ratd.base.jit import jit
from ratd.base.parts import part
from ratd.engine.forces import contact_forces
from ratd.engine.layout import DT, DT_CONTACTS, DT_DRIFT, FASTEST, STEPS, TIME

SAMPLE_EVERY = 64
"""Steps between two samples that a drive may take for its means."""
GROW_EVERY, GROWTH = 64, 1.25
"""A step that the greatest speed has shortened grows by this factor after so many steps, up to what is allowed."""
DAMPINGS = ("implicit", "explicit")


@part
class Leapfrog(NamedTuple):
    """The explicit integrator; made by `leapfrog`.

    Attributes
    ----------
    timestep_factor : float
        f: the step is f times the shortest time of any contact, and no monomer moves by more than f times the least
        radius in it.
    timestep : float
        Step [s] that holds instead, where it is above 0.
    implicit_damping : bool
        Whether the normal damping is weakened such that it cannot limit the step
        (`ratd.engine.contacts.update_contact_rates`).
    """

    timestep_factor: float
    timestep: float
    implicit_damping: bool

    def with_smaller_steps(self, part):
        return self._replace(timestep_factor=part * self.timestep_factor, timestep=part * self.timestep)

    def set_step(self, state, shortest):
        if self.timestep > 0.0:
            state.scalar[DT] = self.timestep
        elif shortest < np.inf:
            state.scalar[DT] = state.scalar[DT_CONTACTS] = self.timestep_factor * shortest

    def prepare(self, state, law):
        return 0

    def renew(self, state, law, work):
        return work

    def step(self, state, law, drive, box, scratch, work):
        scalar = state.scalar
        dt = scalar[DT]
        # From the middle of the last move to that of the next; half a step from the start, where nothing has moved.
        kick = 0.5 * (scalar[DT_DRIFT] + dt)
        ended = contact_forces(state, law, box, scratch, kick)
        if state.counter[STEPS] % SAMPLE_EVERY == 0:
            drive.sample(state, law)
        drive.load(state, kick)
        drive.move(state, box, kick, dt)
        scalar[DT_DRIFT] = dt
        scalar[TIME] += dt
        state.counter[STEPS] += 1
        return ended

    def farthest(self):
        return 0.0

    def limit(self, state, law, drive, box, far, least, work):
        if self.timestep == 0.0:
            limit_step(state, self.timestep_factor * least)


@jit
def limit_step(state, farthest):
    """Let no monomer move farther than this [m] in the next step; a step that is shorter than need be grows.

    When it grows depends on the number of steps alone, so that a run in pieces has the bits of one at once.
    """
    scalar = state.scalar
    if state.counter[STEPS] % GROW_EVERY == 0 and scalar[DT] < scalar[DT_CONTACTS]:
        scalar[DT] = min(GROWTH * scalar[DT], scalar[DT_CONTACTS])
    if scalar[FASTEST] * scalar[DT] > farthest:
        scalar[DT] = farthest / scalar[FASTEST]


def leapfrog(*, timestep_factor=0.125, timestep=None, damping="implicit"):
    """The explicit integrator.

    Parameters
    ----------
    timestep_factor : float
        f of dt = f min(t_dis, t_vel) (Reissl et al. 2024, Eq. 31 and below it).
    timestep : float, optional
        A fixed step [s] instead.
    damping : {"implicit", "explicit"}
        Treatment of the normal damping. Explicit is exact for short steps and unstable for long ones; implicit is
        stable at any step, and damps monomers with many contacts too little at long ones.

    Returns
    -------
    Leapfrog

    Raises
    ------
    InputError
    """
    if not (is_number(timestep_factor) and 0.0 < timestep_factor <= 1.0):
        raise InputError(f"timestep_factor is {timestep_factor!r}; it must be above 0 and at most 1.")
    if timestep is not None and not (is_number(timestep) and timestep > 0.0):
        raise InputError(f"timestep is {timestep!r}; it must be a number above 0 in s, or None.")
    if damping not in DAMPINGS:
        raise InputError(f"damping is {damping!r}; allowed are {', '.join(DAMPINGS)}.")
    return Leapfrog(float(timestep_factor), float(timestep or 0.0), damping == "implicit")
