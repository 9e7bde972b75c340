"""Forces and torques of all contacts at one step: the hot loop of ratd.

Three passes over one block of contacts after the other: gather what depends on the two monomers, let the law compute
all contacts of the block, sum forces and torques per monomer. What the next block needs is called from memory
meanwhile: tens of thousands of monomers do not fit into the caches, and the processor does not foresee which of the
fields of a block comes next.
"""

import numpy as np

from ratd.base.jit import jit
from ratd.base.rows import EIGHT, LINE, add_forces, call_line, gather_differences, gather_sides
from ratd.engine.layout import CONTACTS, DT_DRIFT, FORCE_ROW, MONOMERS, ROW, VIRIAL
from ratd.laws.contact_fields import DX, FX, LANES, RARE, SCRATCH_SIZE, VECTOR, WIX

_LANES = np.uint64(LANES)
_LINE = np.uint64(LINE)
_ROW = np.uint64(ROW)
_FORCE_ROW = np.uint64(FORCE_ROW)
MANY = 20_000
"""Contacts, and monomers, from which on it pays to call them from memory; fewer are in a cache still (measured)."""


@jit(forceinline=True)
def _call_contacts(contact, begin, count):
    for at in range(0, count, LINE):
        call_line(contact, begin + np.uint64(at))


@jit(forceinline=True)
def _call_monomers(state, first):
    for lane in range(VECTOR):
        pair = first + np.uint64(lane)
        for k in (state.pair_i[pair], state.pair_j[pair]):
            call_line(state.monomer, k * _ROW)
            call_line(state.monomer, k * _ROW + _LINE)
            call_line(state.force, k * _FORCE_ROW)


@jit(forceinline=True)
def _gather(state, scratch, first, count, ahead, share, many):
    for lane in range(0, count, VECTOR):
        q = np.uint64(lane)
        _call_contacts(state.contact, ahead + q * share, VECTOR * share)
        if many:
            _call_monomers(state, first + _LANES + q)
        gather_differences(state.monomer, state.pair_i, state.pair_j, first + q, scratch, DX + q, _LANES)
        gather_sides(state.monomer, state.pair_i, state.pair_j, first + q, scratch, WIX + q, _LANES)


@jit(forceinline=True)
def _scatter(state, scratch, first, count, ahead, share):
    for lane in range(0, count, VECTOR):
        q = np.uint64(lane)
        _call_contacts(state.contact, ahead + q * share, VECTOR * share)
        add_forces(state.force, state.pair_i, state.pair_j, first + q, scratch, FX + q, _LANES)


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
    n_contacts = state.counter[CONTACTS]
    dt_drift = state.scalar[DT_DRIFT]
    edges = box.edges(state.scalar)
    size = law.n_fields()
    # numbers of the next block that are called for each contact gathered, and as many for each one summed
    share = np.uint64((size - RARE) // 2 if n_contacts > MANY else 0)
    many = state.counter[MONOMERS] > MANY
    ended = 0
    for first in range(0, n_contacts, LANES):
        count = min(LANES, (n_contacts - first + VECTOR - 1) // VECTOR * VECTOR)
        start = np.uint64(first * size)
        at = np.uint64(first)
        ahead = start + np.uint64(LANES * (size + RARE))
        _gather(state, scratch, at, count, ahead, share, many and first + 2 * LANES <= state.pair_i.shape[0])
        box.place_images(state.image, scratch, at, count, edges)
        ended += law.forces(state.contact, scratch, start, count, dt_drift, dt)
        box.add_virial(scratch, count)
        _scatter(state, scratch, at, count, ahead + _LANES * share, share)
    box.sum_virial(scratch, state.scalar, VIRIAL)
    return ended
