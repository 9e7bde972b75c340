"""An aggregate brought to rest: contacts of the growth carry the forces that their compression gives."""

from functools import partial

import numpy as np

from ratd.aggregates.grain import pressed, seated
from ratd.base.errors import GrainError
from ratd.base.jit import jit
from ratd.drives.free import free
from ratd.engine.contacts import update_contact_rates
from ratd.engine.forces import contact_forces, working_space
from ratd.engine.fragments import label_fragments
from ratd.engine.layout import CONTACTS, DT_DRIFT, LARGEST_MONOMERS, STEPS, VX, WX, X
from ratd.engine.leapfrog import leapfrog
from ratd.engine.state import come_to_rest, contact_blocks, monomer_rows, new_state
from ratd.engine.step import run, until
from ratd.geometry.box import open_space
from ratd.geometry.shape import principal_axes
from ratd.laws.contact_constants import pull_off_force, reduced_radius
from ratd.laws.contact_fields import A_I, A_J, E_DAMP, E_ROLL, E_SLIDE, E_TWIST, LANES, NCX
from ratd.laws.jkr_with_springs import jkr
from ratd.laws.material_pair import SURFACE_ENERGY
from ratd.observables.energy import kinetic
from ratd.observables.pieces import largest_fragment
from ratd.observables.stress import greatest_residual

__all__ = ["relax"]

RESIDUAL = 1e-3
"""A grain is relaxed when no net force exceeds this part of the least pull-off force in it."""
ROUND = 50
"""Steps of a round of the relaxation, after which the kinetic energy is looked at."""
PATIENCE = 1000
"""Rounds after which they take a step more each: a contact that rings in time with the rounds is caught at its turning
points only, where there is no velocity to take from it."""
PRESSED = 0.25
"""Part of its compression in equilibrium by which each contact is pressed, at least, where an aggregate falls apart as
it comes to rest: under DMT nothing pulls beyond touch, so that spheres which only touch bounce off each other."""
FAR = 10.0
"""See `near_the_origin`."""
LIMIT = 1_000_000
"""Steps after which a grain that is not yet relaxed is given up."""


def relax(grain, *, law=None, timestep_factor=0.125):
    """State of a grain that has come to rest.

    Parameters
    ----------
    grain : ratd.Grain
    law : part, optional
        Contact law, `ratd.laws.jkr` with its defaults when not given.
    timestep_factor : float
        f of Eq. 31.

    Returns
    -------
    State
        Origin at the centre of mass, z along a_1, the axis of the greatest moment of inertia; no velocities, no
        dissipated energy, time 0. Net forces are below `RESIDUAL` times the least pull-off force.

    Raises
    ------
    GrainError
        If it comes apart meanwhile, also when its contacts are pressed by `PRESSED` first.
    RuntimeError
        If the grain does not come to rest.

    Notes
    -----
    Spheres that only touch are pressed together first, see `ratd.aggregates.grain.seated`. Then the aggregate is
    integrated with damping; whenever the kinetic energy has fallen in a round (`round_length`), all velocities are set
    to zero, so that the slow swaying of long arms, which contacts hardly damp, does not go on for ever.
    """
    law = jkr() if law is None else law
    box, integrator = open_space(), leapfrog(timestep_factor=timestep_factor)
    for start in (seated, partial(pressed, by=PRESSED)):
        own = near_the_origin(start(grain))
        state = new_state(own.position, own.radius, own.material, own.contacts, law, box, integrator)
        state = find_rest(state, law, free(), box, integrator)
        label_fragments(state)
        whole = state.counter[LARGEST_MONOMERS]
        if whole == grain.n_monomers:
            settle(state, law, integrator)
            return state
    raise GrainError(
        f"As it comes to rest under the law of contact the aggregate comes apart: {whole} of its {grain.n_monomers} "
        "spheres are left in the largest piece; give positions in which its contacts are at rest."
    )


def near_the_origin(grain):
    """A grain whose centre is within `FAR` times its size of the origin: farther out contacts lose digits."""
    centre = grain.position.mean(axis=0)
    if np.abs(centre).max() <= FAR * np.ptp(grain.position, axis=0).max():
        return grain
    return grain.replace(position=grain.position - centre)


def find_rest(state, law, drive, box, integrator):
    """State without motion in which no net force exceeds `RESIDUAL` times the least pull-off force.

    Raises
    ------
    RuntimeError
        If the aggregate does not come to rest.
    """
    goal = residual_goal(state)
    energy = 0.0
    begun = state.counter[STEPS]
    steps = 0
    while steps < LIMIT:
        residual = residual_force(state, law, box)
        if residual <= goal:
            return state
        steps += round_length(steps)
        state, _ = run(state, law, drive, box, integrator, until(steps=begun + steps))
        before, energy = energy, sum(kinetic(state, 0.0, False))
        if energy <= before:
            come_to_rest(state)
            energy = 0.0
    raise RuntimeError(
        f"the grain does not come to rest: the net force is not to exceed {goal:.2e} N on any monomer; it is "
        f"{residual:.2e} N"
    )


def round_length(steps):
    """Steps of the round of the relaxation that begins after so many steps."""
    length = ROUND
    while steps >= PATIENCE * length:
        steps -= PATIENCE * length
        length += 1
    return length


@jit
def residual_force(state, law, box):
    """Greatest net force on any monomer [N] in a frame at rest; torques count as force times radius."""
    scratch = working_space()
    drift = state.scalar[DT_DRIFT]
    state.scalar[DT_DRIFT] = 0.0
    contact_forces(state, law, box, scratch, 0.0)
    state.scalar[DT_DRIFT] = drift
    greatest = greatest_residual(state)
    state.force[:] = 0.0
    return greatest


def residual_goal(state):
    """Net force [N] on any monomer below which a grain counts as relaxed."""
    blocks = contact_blocks(state)
    radii = [blocks[:, int(field) // LANES, :].reshape(-1)[: state.counter[CONTACTS]] for field in (A_I, A_J)]
    return RESIDUAL * pull_off_force(reduced_radius(*radii).min(), state.material[:, SURFACE_ENERGY].min())


def settle(state, law, integrator):
    """Make a relaxed state the start of a run: at rest, centred, z along a_1, nothing dissipated, time 0."""
    come_to_rest(state)
    label_fragments(state)
    position, mass, radius = largest_fragment(state)
    _, axes = principal_axes(position, mass, radius)
    place(state, law, mass @ position / mass.sum(), axes[[1, 2, 0]])
    start_anew(state, law, integrator)


def start_anew(state, law, integrator):
    """Make a state without motion the start of a run: nothing dissipated, time 0."""
    come_to_rest(state)
    state.scalar[:] = 0.0
    state.drive[:] = 0.0
    state.counter[STEPS] = 0
    for field in (E_SLIDE, E_ROLL, E_TWIST, E_DAMP):
        contact_blocks(state)[:, int(field) // LANES, :] = 0.0
    update_contact_rates(state, law, integrator)


def place(state, law, origin, axes):
    """Move the origin to `origin` and turn everything so that the rows of `axes` become x, y and z.

    Parameters
    ----------
    state : State
    law : part
    origin : (3,) array
        New origin in old coordinates [m].
    axes : (3, 3) array
        New axes in old coordinates, unit vectors, right-handed.
    """
    rows = monomer_rows(state)
    rows[:, X : X + 3] -= origin
    for first in (X, VX, WX):
        rows[:, first : first + 3] = rows[:, first : first + 3] @ axes.T
    fields = contact_blocks(state)
    for first in (NCX, *law.vectors()):
        lane = int(first) // LANES
        fields[:, lane : lane + 3, :] = np.einsum("ab,kbl->kal", axes, fields[:, lane : lane + 3, :])
