"""Forces and torques of all contacts at one step: the hot loop of ratd.

Three passes over one block of contacts after the other: gather what depends on the two monomers, let the law compute
all contacts of the block, sum forces and torques per monomer.
"""

import numpy as np

from ratd.base.jit import jit
from ratd.base.rows import EIGHT, add_forces, gather_differences, gather_sides
from ratd.engine.layout import CONTACTS, DT_DRIFT, VIRIAL
from ratd.laws.contact_fields import DX, FX, LANES, SCRATCH_SIZE, VECTOR, WIX

_LANES = np.uint64(LANES)


@jit(forceinline=True)
def _gather(monomer, pair_i, pair_j, scratch, first, count):
    for lane in range(0, count, VECTOR):
        q = np.uint64(lane)
        gather_differences(monomer, pair_i, pair_j, first + q, scratch, DX + q, _LANES)
        gather_sides(monomer, pair_i, pair_j, first + q, scratch, WIX + q, _LANES)


@jit(forceinline=True)
def _scatter(force, pair_i, pair_j, scratch, first, count):
    for lane in range(0, count, VECTOR):
        q = np.uint64(lane)
        add_forces(force, pair_i, pair_j, first + q, scratch, FX + q, _LANES)


@jit
def working_space():
    """Working space of `contact_forces`, (SCRATCH_SIZE,), zeros, from the beginning of a line of the cache on."""
    room = np.zeros(SCRATCH_SIZE + EIGHT)
    begin = EIGHT - (np.int64(room.ctypes.data) // 8) % EIGHT
    return room[begin : begin + SCRATCH_SIZE]


@jit
def contact_forces(state, law, box, scratch, dt):
    """Add the forces and torques of all contacts to `state.force`.

    Parameters
    ----------
    state : State
        Contacts are advanced by the last move, `DT_DRIFT`.
    law, box : parts
    scratch : (SCRATCH_SIZE,) float64 array
        See `working_space`.
    dt : float
        Duration of the kick to come [s].

    Returns
    -------
    int
        Number of contacts that have ended, to be removed after the kick.
    """
    monomer, force, contact = state.monomer, state.force, state.contact
    pair_i, pair_j = state.pair_i, state.pair_j
    n_contacts = state.counter[CONTACTS]
    dt_drift = state.scalar[DT_DRIFT]
    edges = box.edges(state.scalar)
    size = law.n_fields()
    ended = 0
    for first in range(0, n_contacts, LANES):
        count = min(LANES, (n_contacts - first + VECTOR - 1) // VECTOR * VECTOR)
        start = np.uint64(first * size)
        at = np.uint64(first)
        _gather(monomer, pair_i, pair_j, scratch, at, count)
        box.place_images(state.image, scratch, at, count, edges)
        ended += law.forces(contact, scratch, start, count, dt_drift, dt)
        box.add_virial(scratch, count)
        _scatter(force, pair_i, pair_j, scratch, at, count)
    box.sum_virial(scratch, state.scalar, VIRIAL)
    return ended
