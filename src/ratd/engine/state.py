"""The arrays of one run: set up, turned, enlarged."""

from typing import NamedTuple

import numpy as np

from ratd.base.jit import jit
from ratd.base.materials import sphere_mass
from ratd.engine.contacts import append_contact, clear_contacts, update_contact_rates
from ratd.engine.layout import (
    COUNTERS, CONTACTS, DRIVEN, DT_DRIFT, DRIVE_SCALARS, FORCE_ROW, INERTIA, INV_INERTIA, INV_MASS, MASS, MONOMERS,
    RADIUS, ROW, SCALARS, VX, WX, X,
)  # fmt: skip
from ratd.laws.contact_fields import LANES, VECTOR
from ratd.laws.material_pair import material_row

LINE = 64
"""Bytes of a line of the cache."""


class State(NamedTuple):
    """Everything that a run is made of; saving these arrays and loading them again continues it bit by bit.

    Attributes
    ----------
    monomer : (16 (n + 2),) float64
        Rows of monomers (see `layout`); the last two belong to contacts that do nothing.
    force : (8 (n + 2),) float64
        Force and torque on each monomer.
    contact : (blocks * fields * LANES,) float64
        Blocks of contacts (see `ratd.laws.contact_fields`).
    image : (blocks * 3 * LANES,) float64
        Images of contacts in a periodic box; empty in open space.
    pair_i, pair_j : (blocks * LANES,) uint64
        Monomers of each contact.
    identity : (n,) int64
        Number, in the order in which they were given, of each monomer that is left.
    fragment : (n,) int64
        Fragment of each monomer that is left; 0 is the largest by mass.
    kind : (n,) int64
        Row of `material` of each monomer that is left.
    lost : (n, 4) float64
        Mass [kg], number of monomers, clock of the drive and time [s] of each fragment that has left.
    scalar, drive : float64
        See `layout.SCALARS`; what the drive keeps.
    counter : int64
        See `layout.COUNTERS`.
    material : (m, 5) float64
        See `ratd.laws.material_pair`.
    """

    monomer: np.ndarray
    force: np.ndarray
    contact: np.ndarray
    image: np.ndarray
    pair_i: np.ndarray
    pair_j: np.ndarray
    identity: np.ndarray
    fragment: np.ndarray
    kind: np.ndarray
    lost: np.ndarray
    scalar: np.ndarray
    drive: np.ndarray
    counter: np.ndarray
    material: np.ndarray


FIELD_TYPES = {
    **dict.fromkeys(State._fields, "f8"),
    **dict.fromkeys(("identity", "fragment", "kind", "counter"), "i8"),
    **dict.fromkeys(("pair_i", "pair_j"), "u8"),
}
"""Array of a state -> its type."""


def new_state(position, radius, materials, contacts, law, box, integrator, *, velocity=None, spin=None, kind=None):
    """State of spheres of which some pairs are in contact from the start.

    Parameters
    ----------
    position : (n, 3) float64 array
        Centres [m].
    radius : (n,) float64 array
        Radii [m].
    materials : ratd.Material or list of ratd.Material
    contacts : (k, 2) or (k, 5) int64 array
        Pairs in contact; in a periodic box with their images (see `ratd.geometry.neighbours.close_images`).
    law, box, integrator : parts
    velocity, spin : (n, 3) float64 array, optional
        Velocities [m/s] and spins [rad/s]; 0 when not given.
    kind : (n,) int array, optional
        Number of each monomer's material; 0 when not given.

    Returns
    -------
    State
        Monomers stand in an order in which near ones are near in memory, see `identity`.
    """
    materials = list(materials) if isinstance(materials, list | tuple) else [materials]
    n = len(radius)
    kind = np.zeros(n, dtype=np.int64) if kind is None else np.asarray(kind, dtype=np.int64)
    order = spatial_order(position)
    density = np.array([material.density for material in materials])[kind[order]]
    rows = np.zeros((n + 2, ROW))
    rows[:n, X : X + 3] = position[order]
    rows[:n, RADIUS] = radius[order]
    if velocity is not None:
        rows[:n, VX : VX + 3] = velocity[order]
    if spin is not None:
        rows[:n, WX : WX + 3] = spin[order]
    rows[:n, MASS] = sphere_mass(radius[order], density)
    rows[:n, INERTIA] = 0.4 * rows[:n, MASS] * radius[order] ** 2
    rows[:n, INV_MASS] = 1.0 / rows[:n, MASS]
    rows[:n, INV_INERTIA] = 1.0 / rows[:n, INERTIA]
    rows[:n, DRIVEN] = 1.0
    rows[n, X] = 1.0  # the two monomers of idle contacts stand apart, so that their direction is defined
    state = State(
        monomer=rows.ravel(),
        force=np.zeros((n + 2) * FORCE_ROW),
        contact=np.zeros(0),
        image=np.zeros(0),
        pair_i=np.zeros(0, dtype=np.uint64),
        pair_j=np.zeros(0, dtype=np.uint64),
        identity=order,
        fragment=np.zeros(n, dtype=np.int64),
        kind=kind[order],
        lost=np.zeros((n, 4)),
        scalar=np.zeros(len(SCALARS)),
        drive=np.zeros(DRIVE_SCALARS),
        counter=np.zeros(len(COUNTERS), dtype=np.int64),
        material=np.array([material_row(material) for material in materials]),
    )
    state.counter[MONOMERS] = n
    state = copied(with_room(state, law, box, len(contacts) + 2 * n))
    if len(contacts) == 0 and n > 1:
        _set_first_step(state, law, box, integrator)
    _append_all(state, law, box, _spread(_renumbered(np.asarray(contacts), order)))
    update_contact_rates(state, law, integrator)
    return state


def _set_first_step(state, law, box, integrator):
    """The time step of spheres none of which touch: what a contact of the two smallest would allow."""
    first, second = np.argsort(monomer_rows(state)[:, RADIUS], kind="stable")[:2]
    _append_all(state, law, box, np.array([[first, second, 0, 0, 0]]))
    update_contact_rates(state, law, integrator)
    clear_contacts(state, law, 0, 1)
    state.counter[CONTACTS] = 0


@jit
def _append_all(state, law, box, contacts):
    for p in range(contacts.shape[0]):
        image = (contacts[p, 2], contacts[p, 3], contacts[p, 4])
        append_contact(state, law, box, contacts[p, 0], contacts[p, 1], image, 0.0, True)


def spatial_order(position):
    """Order of points along a Z-curve, (n,) int64: neighbours in space are mostly neighbours in it (Morton 1966)."""
    if len(position) == 0:
        return np.arange(0)
    lowest = position.min(axis=0)
    extent = max((position - lowest).max(), np.finfo(float).tiny)
    cell = ((position - lowest) / extent * (2**16 - 1)).astype(np.uint64)
    key = np.zeros(len(position), dtype=np.uint64)
    for bit in range(16):
        for axis in range(3):
            key |= ((cell[:, axis] >> np.uint64(bit)) & np.uint64(1)) << np.uint64(3 * bit + axis)
    return np.argsort(key, kind="stable")


def _renumbered(contacts, order):
    """Contacts with images, (k, 5), by the new numbers of their monomers, sorted."""
    table = np.zeros((len(contacts), 5), dtype=np.int64)
    place = np.empty(len(order), dtype=np.int64)
    place[order] = np.arange(len(order))
    if len(contacts):
        table[:, : contacts.shape[1]] = contacts
        table[:, :2] = place[table[:, :2]]
        turned = table[:, 0] > table[:, 1]
        table[turned, :2] = table[turned, 1::-1]
        table[turned, 2:] *= -1
    return table[np.lexsort((table[:, 1], table[:, 0]))]


def with_room(state, law, box, contacts):
    """The same state with room for at least so many contacts."""
    blocks = -(-contacts // LANES)
    held = len(state.pair_i) // LANES
    if blocks <= held:
        return state
    more = blocks - held
    idle = np.uint64(len(state.identity))
    images = 3 * LANES if has_images(box) else 0
    grown = state._replace(
        contact=aligned(np.concatenate([state.contact, np.zeros(more * law.n_fields() * LANES)])),
        image=aligned(np.concatenate([state.image, np.zeros(more * images)])),
        pair_i=aligned(np.concatenate([state.pair_i, np.full(more * LANES, idle)])),
        pair_j=aligned(np.concatenate([state.pair_j, np.full(more * LANES, idle + np.uint64(1))])),
    )
    clear_contacts(grown, law, held * LANES, blocks * LANES)
    return grown


def has_images(box):
    """Whether contacts of a box have images: not in open space."""
    return box.edges(np.zeros(len(SCALARS)))[0] > 0.0


def monomer_rows(state):
    """The monomers that are left, (m, 16), a view."""
    return state.monomer.reshape(-1, ROW)[: state.counter[MONOMERS]]


def positions_as_given(state):
    """Centres [m], unwrapped, in the order in which the monomers were given, (n, 3); for a state that has lost none."""
    return monomer_rows(state)[np.argsort(state.identity), X : X + 3].copy()


def contact_blocks(state):
    """All fields of all contacts, idle ones too, (blocks, fields, LANES), a view; field f stands at f // LANES."""
    return state.contact.reshape(len(state.pair_i) // LANES, -1, LANES)


def contact_field(state, field):
    """One field of all contacts, (k,), a copy."""
    return contact_blocks(state)[:, int(field) // LANES, :].reshape(-1)[: state.counter[CONTACTS]]


def come_to_rest(state):
    """Set all velocities and spins to zero; the next step starts from rest."""
    rows = monomer_rows(state)
    rows[:, VX : VX + 3] = 0.0
    rows[:, WX : WX + 3] = 0.0
    state.scalar[DT_DRIFT] = 0.0


def copied(state):
    """The same state in arrays of its own."""
    return State(*map(aligned, state))


def aligned(array):
    """A copy of an array that begins where a line of the cache does.

    A vector of eight numbers then lies in one line. In arrays as numpy makes them it mostly lies in two, and a step
    takes a seventh longer.
    """
    room = np.zeros(array.nbytes + LINE, dtype=np.uint8)
    begin = -room.ctypes.data % LINE
    copy = room[begin : begin + array.nbytes].view(array.dtype).reshape(array.shape)
    copy[...] = array
    return copy


def _spread(contacts):
    """Contacts in an order in which neighbours in the list seldom share a monomer.

    Sums into the same row of memory wait for each other.
    """
    n = len(contacts) // LANES * LANES
    blocks = contacts[:n].reshape(-1, LANES // VECTOR, VECTOR, 5).swapaxes(1, 2).reshape(-1, 5)
    return np.concatenate([blocks, contacts[n:]])
