"""A grain that is left to itself, in a frame at rest: set in motion, made elastic, its momenta and energies."""

import numpy as np

from ratd.drives.rotating import AT_REST
from ratd.engine.advance import STEPS_DONE, advance
from ratd.engine.fragments import find_fragments
from ratd.engine.layout import DAMPING, INERTIA, INV_XI2, INV_ZETA2, LANES, MASS, STEPS, VX, WX, X
from ratd.engine.measure import stored_energy
from ratd.engine.state import contact_blocks, monomer_rows, new_state

POSITION, VELOCITY, SPIN = (slice(int(first), int(first) + 3) for first in (X, VX, WX))
"""Columns of `ratd.engine.state.monomer_rows`."""


def state_of(grain, timestep_factor=0.02, implicit=True):
    """State of a grain at rest, its fragments known.

    Parameters
    ----------
    grain : ratd.Grain
    timestep_factor : float
        f of Eq. 31.
    implicit : bool
        Whether the damping is treated implicitly.

    Returns
    -------
    State
    """
    state = new_state(
        grain.position, grain.radius, grain.material, grain.contacts,
        timestep_factor=timestep_factor, implicit_damping=implicit,
    )  # fmt: skip
    find_fragments(state)
    return state


def shaken(grain, speed, spin, seed=0, **options):
    """State of a grain whose monomers have random velocities and spins.

    Parameters
    ----------
    grain : ratd.Grain
    speed, spin : float
        Standard deviation of each component of the velocities [m/s] and spins [rad/s].
    seed : int
        Of the random numbers.
    **options
        For `state_of`.

    Returns
    -------
    State
        With its centre of mass at rest.
    """
    state = state_of(grain, **options)
    rng = np.random.default_rng(seed)
    rows = monomer_rows(state)
    rows[:, VELOCITY] = speed * rng.normal(size=(len(rows), 3))
    rows[:, SPIN] = spin * rng.normal(size=(len(rows), 3))
    find_fragments(state)
    return state


def turn(rows, omega):
    """Add a rigid rotation with omega (3,) [rad/s] about the origin to rows of monomers."""
    rows[:, VELOCITY] += np.cross(omega, rows[:, POSITION])
    rows[:, SPIN] += omega


def go_on(state, grain, goal, timestep_factor, drive=AT_REST):
    """Integrate until so many steps have been made in all.

    Parameters
    ----------
    state : State
    grain : ratd.Grain
        Of the state, for the message.
    goal : int
        Total number of steps.
    timestep_factor : float
        f of Eq. 31; damping, if any, is implicit.
    drive : ratd.drives.rotating.Drive
        Of the frame; by default one that does not turn.

    Raises
    ------
    RuntimeError
        If the integration ends before.
    """
    code = advance(state, drive, np.inf, goal, -1, timestep_factor, True)
    if code != STEPS_DONE or state.counter[STEPS] != goal:
        raise RuntimeError(f"the free grain {grain.type} {grain.seed} did not go on at f = {timestep_factor:g}")


def copied(state):
    """A state of its own with the same content."""
    return state._replace(**{name: array.copy() for name, array in state._asdict().items()})


def with_field(state, field, value):
    """Set one field of all contacts."""
    contact_blocks(state)[:, int(field) // LANES, :] = value


def make_elastic(state):
    """Switch off damping and the limits of sliding and rolling; twisting must stay below its limit by itself."""
    for field in (DAMPING, INV_ZETA2, INV_XI2):
        with_field(state, field, 0.0)


def kinetic_energy(rows):
    """Kinetic energy [J] of rows of monomers."""
    return 0.5 * (rows[:, MASS] @ (rows[:, VELOCITY] ** 2).sum(1) + rows[:, INERTIA] @ (rows[:, SPIN] ** 2).sum(1))


def momenta(state):
    """Linear and angular momentum about the origin, each with the sum of the magnitudes of its parts.

    Returns
    -------
    linear : (3,) array
        [kg m s-1]
    linear_size : float
    angular : (3,) array
        [kg m2 s-1]
    angular_size : float
    """
    rows = monomer_rows(state)
    linear = rows[:, MASS, None] * rows[:, VELOCITY]
    angular = np.cross(rows[:, POSITION], linear) + rows[:, INERTIA, None] * rows[:, SPIN]
    return linear.sum(0), np.linalg.norm(linear, axis=1).sum(), angular.sum(0), np.linalg.norm(angular, axis=1).sum()


def energy_after_step(state, step):
    """Make one step, and give the energy at the positions before it.

    Parameters
    ----------
    state : State
    step : callable
        Takes the state one step further, such as one call of `ratd.engine.advance.advance`.

    Returns
    -------
    kinetic, potential : float
        [J], of the largest fragment; the kinetic energy is that of the mean of the velocities half a step before and
        half a step after.
    """
    middle = monomer_rows(state).copy()
    step(state)
    rows = monomer_rows(state)
    for columns in (VELOCITY, SPIN):
        middle[:, columns] = 0.5 * (middle[:, columns] + rows[:, columns])
    return kinetic_energy(middle), stored_energy(state)[1]
