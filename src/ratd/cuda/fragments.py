"""Fragments of a grain, found and dropped by a block of threads; see `ratd.engine.fragments`."""

import math

import numpy as np

from ratd.cuda.block import block_max, block_sum, prefix_sum
from ratd.cuda.device import cuda, device_function
from ratd.engine.fragments import drop, note_lost
from ratd.engine.layout import (
    CONTACTS, DRIVEN, LARGEST_CONTACTS, LARGEST_MONOMERS, MASS, MONOMERS, RADIUS, ROW, VX, X, Y, Z,
)  # fmt: skip

_ROW = np.uint64(ROW)


@device_function
def label_pieces(body):
    """Label each monomer with the first monomer of its piece."""
    state = body.state
    label = body.label
    parent = body.order
    thread = cuda.threadIdx.x
    n = state.counter[MONOMERS]
    cuda.syncthreads()
    for k in range(thread, n, cuda.blockDim.x):
        label[k] = k
        parent[k] = k
    cuda.syncthreads()
    while True:
        # Labels and parents are the same here, and roots: monomers that are their own parent. Of two in contact the
        # greater root comes under the smaller; the minimum is the same in whatever order the threads come. Labels stay
        # as they are meanwhile, and parents while the labels follow them, so that nobody reads what another writes.
        changed = 0
        for c in range(thread, state.counter[CONTACTS], cuda.blockDim.x):
            a = label[state.pair_i[c]]
            b = label[state.pair_j[c]]
            if a != b:
                cuda.atomic.min(parent, max(a, b), min(a, b))
                changed = 1
        changed = cuda.syncthreads_or(changed)
        if not changed:
            break
        for k in range(thread, n, cuda.blockDim.x):
            root = parent[k]
            while parent[root] != root:
                root = parent[root]
            label[k] = root
        cuda.syncthreads()
        for k in range(thread, n, cuda.blockDim.x):
            parent[k] = label[k]
        cuda.syncthreads()


@device_function
def find_fragments(body, buffer, counts):
    """Label the fragments, mark the largest as driven, and move the origin to its centre of mass.

    The same as `ratd.engine.fragments.find_fragments`, but for the order in which the centre of mass is summed.

    Returns
    -------
    int
        Number of fragments.
    """
    state = body.state
    monomer = state.monomer
    thread = cuda.threadIdx.x
    n = state.counter[MONOMERS]
    label_pieces(body)
    for k in range(thread, n, cuda.blockDim.x):
        body.order[k] = body.label[k] == k
    fragments = prefix_sum(body.order, n, counts)
    largest = 0
    if fragments > 1:
        for k in range(thread, n, cuda.blockDim.x):
            if body.label[k] == k:
                mass = 0.0
                for m in range(k, n):
                    if body.label[m] == k:
                        mass += monomer[np.uint64(m) * _ROW + MASS]
                body.piece[body.order[k]] = mass
        cuda.syncthreads()
        for f in range(1, fragments):
            if body.piece[f] > body.piece[largest] * (1.0 + 1e-12):
                largest = f

    for k in range(thread, n, cuda.blockDim.x):
        number = body.order[body.label[k]]
        # The largest gets number 0, the ones before it move up by one.
        inside = number == largest
        state.fragment[k] = 0 if inside else (number + 1 if number < largest else number)
        monomer[np.uint64(k) * _ROW + DRIVEN] = 1.0 if inside else 0.0
    members = 0.0
    mass = 0.0
    for k in range(thread, n, cuda.blockDim.x):
        driven = monomer[np.uint64(k) * _ROW + DRIVEN]
        members += driven
        mass += driven * monomer[np.uint64(k) * _ROW + MASS]
    members = block_sum(members, buffer)
    mass = block_sum(mass, buffer)
    for first in (X, VX):
        for axis in range(3):
            offset = first + np.uint64(axis)
            total = 0.0
            for k in range(thread, n, cuda.blockDim.x):
                r = np.uint64(k) * _ROW
                total += monomer[r + DRIVEN] * monomer[r + MASS] * monomer[r + offset]
            centre = block_sum(total, buffer) / mass
            for k in range(thread, n, cuda.blockDim.x):
                monomer[np.uint64(k) * _ROW + offset] -= centre
    inside = 0.0
    for c in range(thread, state.counter[CONTACTS], cuda.blockDim.x):
        if state.fragment[state.pair_i[c]] == 0:
            inside += 1.0
    inside = block_sum(inside, buffer)
    if thread == 0:
        state.counter[LARGEST_MONOMERS] = np.int64(members)
        state.counter[LARGEST_CONTACTS] = np.int64(inside)
    cuda.syncthreads()
    return fragments


@device_function
def drop_departed(body, fragments, buffer):
    """Drop the fragments that have left for good; see `ratd.engine.fragments.drop_departed`.

    Returns
    -------
    bool
        Whether any was dropped.
    """
    state = body.state
    monomer = state.monomer
    thread = cuda.threadIdx.x
    n = state.counter[MONOMERS]
    gone = body.order
    place = body.label
    outer = 0.0
    for k in range(thread, n, cuda.blockDim.x):
        if state.fragment[k] == 0:
            r = np.uint64(k) * _ROW
            distance = math.sqrt(monomer[r + X] ** 2 + monomer[r + Y] ** 2 + monomer[r + Z] ** 2)
            outer = max(outer, distance + monomer[r + RADIUS])
    outer = block_max(outer, buffer)
    any_gone = 0
    for f in range(thread, fragments, cuda.blockDim.x):
        gone[f] = 0
        if f > 0 and has_left(state, f, outer):
            gone[f] = 1
            any_gone = 1
    if not cuda.syncthreads_or(any_gone):
        return False
    if thread == 0:
        for f in range(1, fragments):
            if gone[f]:
                mass = 0.0
                members = 0
                for k in range(n):
                    if state.fragment[k] == f:
                        mass += monomer[np.uint64(k) * _ROW + MASS]
                        members += 1
                note_lost(state, mass, members)
        drop(state, gone, place)
    cuda.syncthreads()
    return True


@device_function
def has_left(state, f, outer):
    """Whether fragment f lies outside the sphere of radius `outer` [m], and its centre of mass recedes."""
    monomer = state.monomer
    cx = 0.0
    cy = 0.0
    cz = 0.0
    vx = 0.0
    vy = 0.0
    vz = 0.0
    for k in range(state.counter[MONOMERS]):
        if state.fragment[k] == f:
            r = np.uint64(k) * _ROW
            distance = math.sqrt(monomer[r + X] ** 2 + monomer[r + Y] ** 2 + monomer[r + Z] ** 2)
            if distance - monomer[r + RADIUS] <= outer:
                return False
            m = monomer[r + MASS]
            cx += m * monomer[r + X]
            cy += m * monomer[r + Y]
            cz += m * monomer[r + Z]
            vx += m * monomer[r + VX]
            vy += m * monomer[r + VX + np.uint64(1)]
            vz += m * monomer[r + VX + np.uint64(2)]
    return cx * vx + cy * vy + cz * vz > 0.0
