"""The arrays of one run: set up, turned, enlarged."""

from typing import NamedTuple

import numpy as np

from ratd.engine.contacts import append_contact, clear_contacts, update_contact_rates
from ratd.engine.layout import (
    BLOCK, CONTACTS, COUNTERS, DRIVEN, DT, DT_DRIFT, FORCE_ROW, INERTIA, INV_INERTIA, INV_MASS, LANES, MASS,
    MONOMERS, NCX, NIX, NJX, RADIUS, ROW, SCALARS, VECTOR, VX, WX, X,
)  # fmt: skip


class State(NamedTuple):
    """Everything that a run is made of; saving these arrays and loading them again continues it bit by bit.

    Attributes
    ----------
    monomer : (16 (n + 2),) float64
        Rows of monomers (see `layout`); the last two belong to contacts that do nothing.
    force : (8 (n + 2),) float64
        Force and torque on each monomer.
    contact : (blocks * BLOCK,) float64
        Blocks of contacts (see `layout`).
    pair_i, pair_j : (blocks * LANES,) uint64
        Monomers of each contact.
    identity : (n,) int64
        Number in the original grain of each monomer that is left.
    fragment : (n,) int64
        Fragment of each monomer that is left; 0 is the largest by mass.
    lost : (n, 4) float64
        Mass [kg], number of monomers, omega [rad/s] and time [s] of each fragment that has left.
    scalar : float64
        See `layout.SCALARS`.
    counter : int64
        See `layout.COUNTERS`.
    material : (6,) float64
        gamma, E*, G, nu, xi_c, T_vis.
    """

    monomer: np.ndarray
    force: np.ndarray
    contact: np.ndarray
    pair_i: np.ndarray
    pair_j: np.ndarray
    identity: np.ndarray
    fragment: np.ndarray
    lost: np.ndarray
    scalar: np.ndarray
    counter: np.ndarray
    material: np.ndarray


def new_state(position, radius, material, contacts, *, timestep_factor, implicit_damping=True):
    """State of an aggregate at rest.

    Parameters
    ----------
    position : (n, 3) float64 array
        Centres [m].
    radius : (n,) float64 array
        Radii [m].
    material : ratd.Material
    contacts : (k, 2) int64 array
        Pairs in contact.
    timestep_factor : float
        f: the step is f t_dis (Eq. 31).
    implicit_damping : bool
        Whether the damping is treated implicitly.

    Returns
    -------
    State
    """
    n = len(radius)
    rows = np.zeros((n + 2, ROW))
    rows[:n, X : X + 3] = position
    rows[:n, RADIUS] = radius
    rows[:n, MASS] = 4.0 / 3.0 * np.pi * material.density * radius**3
    rows[:n, INERTIA] = 0.4 * rows[:n, MASS] * radius**2
    rows[:n, INV_MASS] = 1.0 / rows[:n, MASS]
    rows[:n, INV_INERTIA] = 1.0 / rows[:n, INERTIA]
    rows[:n, DRIVEN] = 1.0
    rows[n, X] = 1.0  # the two monomers of idle contacts stand apart, so that their direction is defined
    state = State(
        monomer=rows.ravel(),
        force=np.zeros((n + 2) * FORCE_ROW),
        contact=np.zeros(0),
        pair_i=np.zeros(0, dtype=np.uint64),
        pair_j=np.zeros(0, dtype=np.uint64),
        identity=np.arange(n),
        fragment=np.zeros(n, dtype=np.int64),
        lost=np.zeros((n, 4)),
        scalar=np.zeros(len(SCALARS)),
        counter=np.zeros(len(COUNTERS), dtype=np.int64),
        material=np.array(
            [
                material.surface_energy,
                material.reduced_modulus,
                material.shear_modulus,
                material.poisson_number,
                material.critical_rolling_displacement,
                material.viscous_time,
            ]
        ),
    )
    state.counter[MONOMERS] = n
    state = with_room(state, len(contacts) + 2 * n)
    for i, j in _spread(contacts):
        append_contact(state, i, j, 0.0, True)
    update_contact_rates(state, timestep_factor, implicit_damping)
    state.scalar[DT_DRIFT] = state.scalar[DT]
    return state


def with_room(state, contacts):
    """The same state with room for at least so many contacts."""
    blocks = -(-contacts // LANES)
    held = len(state.pair_i) // LANES
    if blocks <= held:
        return state
    idle = np.uint64(len(state.identity))
    grown = state._replace(
        contact=np.concatenate([state.contact, np.zeros((blocks - held) * BLOCK)]),
        pair_i=np.concatenate([state.pair_i, np.full((blocks - held) * LANES, idle)]),
        pair_j=np.concatenate([state.pair_j, np.full((blocks - held) * LANES, idle + np.uint64(1))]),
    )
    clear_contacts(grown, held * LANES, blocks * LANES)
    return grown


def monomer_rows(state):
    """The monomers that are left, (m, 16), a view."""
    return state.monomer.reshape(-1, ROW)[: state.counter[MONOMERS]]


def contact_blocks(state):
    """All fields of all contacts, idle ones too, (blocks, fields, LANES), a view; field f stands at f // LANES."""
    return state.contact.reshape(-1, BLOCK // LANES, LANES)


def contact_field(state, field):
    """One field of all contacts, (k,), a copy."""
    return contact_blocks(state)[:, int(field) // LANES, :].reshape(-1)[: state.counter[CONTACTS]]


def come_to_rest(state):
    """Set all velocities and spins to zero."""
    rows = monomer_rows(state)
    rows[:, VX : VX + 3] = 0.0
    rows[:, WX : WX + 3] = 0.0


def place(state, origin, axes):
    """Move the origin to `origin` and turn everything so that the rows of `axes` become x, y and z.

    Parameters
    ----------
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
    for first in (NIX, NJX, NCX):
        lane = int(first) // LANES
        fields[:, lane : lane + 3, :] = np.einsum("ab,kbl->kal", axes, fields[:, lane : lane + 3, :])


def _spread(contacts):
    """Contacts in an order in which neighbours in the list seldom share a monomer.

    Sums into the same row of memory wait for each other.
    """
    n = len(contacts) // LANES * LANES
    blocks = contacts[:n].reshape(-1, LANES // VECTOR, VECTOR, 2).swapaxes(1, 2).reshape(-1, 2)
    return np.concatenate([blocks, contacts[n:]])
