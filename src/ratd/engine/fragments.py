"""Fragments: the connected components of the contact graph, the largest followed, those that have left dropped."""

import math

import numpy as np

from ratd.base.jit import jit
from ratd.engine.contacts import remove_contact
from ratd.engine.layout import (
    CONTACTS, DRIVEN, FRAGMENTS_LOST, LARGEST_CONTACTS, LARGEST_MONOMERS, MASS, MONOMERS, OMEGA, RADIUS, ROW, TIME,
    VX, VY, VZ, X, Y, Z,
)  # fmt: skip
from ratd.geometry.neighbours import connected_components

_ROW = np.uint64(ROW)


@jit
def find_fragments(state):
    """Label the fragments, mark the largest as driven, and move the origin to its centre of mass.

    The origin takes the centre's velocity as well, which is an inertial motion, so that the terms of the turning
    frame keep their form. Of two fragments of the same mass the one with the first monomer counts as the larger.

    Returns
    -------
    int
        Number of fragments.
    """
    n = state.counter[MONOMERS]
    n_contacts = state.counter[CONTACTS]
    monomer = state.monomer
    pairs = np.empty((n_contacts, 2), dtype=np.int64)
    for k in range(n_contacts):
        pairs[k, 0] = np.int64(state.pair_i[k])
        pairs[k, 1] = np.int64(state.pair_j[k])
    label = connected_components(n, pairs)
    fragments = 0
    for k in range(n):
        fragments = max(fragments, label[k] + 1)
    mass = np.zeros(fragments)
    for k in range(n):
        mass[label[k]] += monomer[np.uint64(k) * _ROW + MASS]
    largest = 0
    for f in range(fragments):
        if mass[f] > mass[largest] * (1.0 + 1e-12):
            largest = f

    sums = np.zeros(6)
    members = 0
    for k in range(n):
        r = np.uint64(k) * _ROW
        # The largest gets label 0, the ones before it move up by one.
        if label[k] == largest:
            state.fragment[k] = 0
            monomer[r + DRIVEN] = 1.0
            members += 1
            m = monomer[r + MASS]
            sums[0] += m * monomer[r + X]
            sums[1] += m * monomer[r + Y]
            sums[2] += m * monomer[r + Z]
            sums[3] += m * monomer[r + VX]
            sums[4] += m * monomer[r + VY]
            sums[5] += m * monomer[r + VZ]
        else:
            state.fragment[k] = label[k] + 1 if label[k] < largest else label[k]
            monomer[r + DRIVEN] = 0.0
    sums /= mass[largest]
    for k in range(n):
        r = np.uint64(k) * _ROW
        monomer[r + X] -= sums[0]
        monomer[r + Y] -= sums[1]
        monomer[r + Z] -= sums[2]
        monomer[r + VX] -= sums[3]
        monomer[r + VY] -= sums[4]
        monomer[r + VZ] -= sums[5]
    state.counter[LARGEST_MONOMERS] = members
    inside = 0
    for k in range(n_contacts):
        inside += state.fragment[pairs[k, 0]] == 0
    state.counter[LARGEST_CONTACTS] = inside
    return fragments


@jit
def note_lost(state, mass, members):
    """Note a fragment of a mass [kg] and a number of monomers as lost, here and now."""
    entry = state.counter[FRAGMENTS_LOST]
    state.lost[entry, 0] = mass
    state.lost[entry, 1] = members
    state.lost[entry, 2] = state.scalar[OMEGA]
    state.lost[entry, 3] = state.scalar[TIME]
    state.counter[FRAGMENTS_LOST] = entry + 1


@jit
def drop(state, gone, place):
    """Take the fragments of which `gone` is true out of the arrays; the others keep their order.

    Parameters
    ----------
    state : State
    gone : (fragments,) array of bool or int
        Which fragments go.
    place : (n,) array of int
        Working space, n being the number of monomers.
    """
    n = state.counter[MONOMERS]
    monomer = state.monomer
    for k in range(state.counter[CONTACTS] - 1, -1, -1):
        if gone[state.fragment[state.pair_i[k]]]:
            remove_contact(state, k)
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
        kept += 1
    for k in range(state.counter[CONTACTS]):
        state.pair_i[k] = np.uint64(place[state.pair_i[k]])
        state.pair_j[k] = np.uint64(place[state.pair_j[k]])
    state.counter[MONOMERS] = kept


@jit
def drop_departed(state, fragments):
    """Drop the fragments that have left for good, noting their mass and number of monomers.

    A fragment has left when all of it lies outside the sphere around the centre of mass that holds the largest
    fragment, and its own centre of mass recedes. Centres of mass of free bodies go straight in the inertial frame, so
    that such a fragment meets the largest no more, unless it is long and reaches back with an end as it turns.

    Parameters
    ----------
    state : State
    fragments : int
        Number of fragments, as `find_fragments` has labelled them.

    Returns
    -------
    int
        Number of fragments dropped. The arrays hold the remaining monomers in their old order.
    """
    n = state.counter[MONOMERS]
    monomer = state.monomer
    outer = 0.0
    nearest = np.full(fragments, np.inf)
    mass = np.zeros(fragments)
    members = np.zeros(fragments, dtype=np.int64)
    centre = np.zeros((fragments, 6))
    for k in range(n):
        r = np.uint64(k) * _ROW
        f = state.fragment[k]
        distance = math.sqrt(monomer[r + X] ** 2 + monomer[r + Y] ** 2 + monomer[r + Z] ** 2)
        if f == 0:
            outer = max(outer, distance + monomer[r + RADIUS])
        nearest[f] = min(nearest[f], distance - monomer[r + RADIUS])
        m = monomer[r + MASS]
        mass[f] += m
        members[f] += 1
        for axis in range(3):
            offset = np.uint64(axis)
            centre[f, axis] += m * monomer[r + X + offset]
            centre[f, 3 + axis] += m * monomer[r + VX + offset]
    gone = np.zeros(fragments, dtype=np.bool_)
    dropped = 0
    for f in range(1, fragments):
        receding = centre[f, 0] * centre[f, 3] + centre[f, 1] * centre[f, 4] + centre[f, 2] * centre[f, 5] > 0.0
        if nearest[f] > outer and receding:
            gone[f] = True
            dropped += 1
            note_lost(state, mass[f], members[f])
    if dropped == 0:
        return 0

    drop(state, gone, np.empty(n, dtype=np.int64))
    return dropped
