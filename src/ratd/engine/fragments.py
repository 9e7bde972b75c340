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
def label_fragments(state):
    """Label the fragments in `state.fragment`: 0 is the largest by mass, the others follow in the order of their first
    monomers. Of two of the same mass the one with the first monomer counts as the larger.

    Returns
    -------
    int
        Number of fragments.
    """
    n = state.counter[MONOMERS]
    pairs = contact_pairs(state)
    label = connected_components(n, pairs)
    fragments = 0
    for k in range(n):
        fragments = max(fragments, label[k] + 1)
    mass = np.zeros(fragments)
    for k in range(n):
        mass[label[k]] += state.monomer[np.uint64(k) * _ROW + MASS]
    largest = 0
    for f in range(fragments):
        if mass[f] > mass[largest] * (1.0 + 1e-12):
            largest = f
    members = 0
    for k in range(n):
        # The largest gets label 0, the ones before it move up by one.
        if label[k] == largest:
            state.fragment[k] = 0
            members += 1
        else:
            state.fragment[k] = label[k] + 1 if label[k] < largest else label[k]
    inside = 0
    for k in range(pairs.shape[0]):
        inside += state.fragment[pairs[k, 0]] == 0
    state.counter[LARGEST_MONOMERS] = members
    state.counter[LARGEST_CONTACTS] = inside
    return fragments


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
