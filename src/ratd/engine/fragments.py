"""Fragments: the connected components of the contact graph, labelled; some of them taken out of the arrays."""

import numpy as np

from ratd.base.jit import jit
from ratd.engine.contacts import remove_contact
from ratd.engine.layout import (
    CLOCK, CONTACTS, FRAGMENTS_LOST, LARGEST_CONTACTS, LARGEST_MONOMERS, MASS, MONOMERS, ROW, TIME,
)  # fmt: skip
from ratd.geometry.neighbours import connected_components

_ROW = np.uint64(ROW)


@jit
def contact_pairs(state):
    """Monomers of all contacts, (k, 2) int64."""
    pairs = np.empty((state.counter[CONTACTS], 2), dtype=np.int64)
    for k in range(pairs.shape[0]):
        pairs[k, 0] = np.int64(state.pair_i[k])
        pairs[k, 1] = np.int64(state.pair_j[k])
    return pairs


@jit
def pieces(state):
    """Masses [kg] and numbers of monomers of all pieces, and the piece of each monomer.

    Returns
    -------
    mass : (f,) float64 array
    members : (f,) int64 array
    label : (n,) int64 array
        0, 1, ... in the order of the first monomer of each piece.
    """
    n = state.counter[MONOMERS]
    label = connected_components(n, contact_pairs(state))
    number = 0
    for k in range(n):
        number = max(number, label[k] + 1)
    mass = np.zeros(number)
    members = np.zeros(number, dtype=np.int64)
    for k in range(n):
        mass[label[k]] += state.monomer[np.uint64(k) * _ROW + MASS]
        members[label[k]] += 1
    return mass, members, label


@jit
def label_fragments(state):
    """Label the fragments in `state.fragment`: 0 is the largest by mass, the others follow in the order of their first
    monomers. Of two of the same mass the one with the first monomer counts as the larger.

    Returns
    -------
    int
        Number of fragments.
    """
    mass, members, label = pieces(state)
    largest = 0
    for f in range(mass.shape[0]):
        if mass[f] > mass[largest] * (1.0 + 1e-12):
            largest = f
    for k in range(label.shape[0]):
        # The largest gets label 0, the ones before it move up by one.
        if label[k] == largest:
            state.fragment[k] = 0
        else:
            state.fragment[k] = label[k] + 1 if label[k] < largest else label[k]
    inside = 0
    for k in range(state.counter[CONTACTS]):
        inside += state.fragment[state.pair_i[k]] == 0
    state.counter[LARGEST_MONOMERS] = members[largest]
    state.counter[LARGEST_CONTACTS] = inside
    return mass.shape[0]


@jit
def note_lost(state, mass, members):
    """Note a fragment of a mass [kg] and a number of monomers as lost, here and now."""
    entry = state.counter[FRAGMENTS_LOST]
    state.lost[entry, 0] = mass
    state.lost[entry, 1] = members
    state.lost[entry, 2] = state.drive[CLOCK]
    state.lost[entry, 3] = state.scalar[TIME]
    state.counter[FRAGMENTS_LOST] = entry + 1


@jit
def drop(state, law, gone):
    """Take the fragments of which `gone` is true out of the arrays; the others keep their order.

    Parameters
    ----------
    state : State
    law : part
    gone : (fragments,) array of bool
        Which fragments go.
    """
    n = state.counter[MONOMERS]
    monomer = state.monomer
    place = np.empty(n, dtype=np.int64)
    for k in range(state.counter[CONTACTS] - 1, -1, -1):
        if gone[state.fragment[state.pair_i[k]]]:
            remove_contact(state, law, k)
    kept = 0
    for k in range(n):
        place[k] = kept
        if gone[state.fragment[k]]:
            continue
        if kept < k:
            for field in range(ROW):
                offset = np.uint64(field)
                monomer[np.uint64(kept) * _ROW + offset] = monomer[np.uint64(k) * _ROW + offset]
            state.identity[kept] = state.identity[k]
            state.fragment[kept] = state.fragment[k]
            state.kind[kept] = state.kind[k]
        kept += 1
    for k in range(state.counter[CONTACTS]):
        state.pair_i[k] = np.uint64(place[state.pair_i[k]])
        state.pair_j[k] = np.uint64(place[state.pair_j[k]])
    state.counter[MONOMERS] = kept
