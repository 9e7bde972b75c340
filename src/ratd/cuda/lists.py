"""Lists that a block of threads makes: contacts of each monomer, pairs that may come into contact, rates of damping."""

import math

import numpy as np

from ratd.cuda.arena import RESULTS
from ratd.cuda.block import block_max, block_sum, chunk_of, prefix_sum, sum_before
from ratd.cuda.device import cuda, device_function
from ratd.engine.advance import gap
from ratd.engine.contacts import contact_start, contact_timestep
from ratd.engine.layout import (
    CONTACTS, DAMPING, DAMPING_RATE, DT, INV_MASS, LANES, MONOMERS, ROW, X, Y, Z,
)  # fmt: skip

_ROW = np.uint64(ROW)
NEAR_REFERENCE, FAR_REFERENCE = 0, 3
"""Columns of `reference`."""


@device_function
def link_to(c, side):
    """Entry of `link` for contact c and its monomer i (side 0) or j (side 1)."""
    return np.uint64(2 * ((c // LANES) * (RESULTS * LANES) + c % LANES) + side)


@device_function
def contact_of(link):
    """Number of the contact of an entry of `link`."""
    place = np.int64(link) // 2
    return place // (RESULTS * LANES) * LANES + place % (RESULTS * LANES)


@device_function
def link_contacts(body, counts):
    """List the contacts of each monomer, by their numbers."""
    state = body.state
    thread = cuda.threadIdx.x
    n = state.counter[MONOMERS]
    cuda.syncthreads()
    for k in range(thread, n + 1, cuda.blockDim.x):
        body.begin[k] = 0
    cuda.syncthreads()
    for c in range(thread, state.counter[CONTACTS], cuda.blockDim.x):
        cuda.atomic.add(body.begin, np.int64(state.pair_i[c]), np.int64(1))
        cuda.atomic.add(body.begin, np.int64(state.pair_j[c]), np.int64(1))
    prefix_sum(body.begin, n + 1, counts)
    # Filled in any order, by cursors that move from begin[k] to begin[k + 1], then sorted.
    for k in range(thread, n, cuda.blockDim.x):
        body.order[k] = body.begin[k]
    cuda.syncthreads()
    for c in range(thread, state.counter[CONTACTS], cuda.blockDim.x):
        body.link[cuda.atomic.add(body.order, np.int64(state.pair_i[c]), np.int64(1))] = link_to(c, 0)
        body.link[cuda.atomic.add(body.order, np.int64(state.pair_j[c]), np.int64(1))] = link_to(c, 1)
    cuda.syncthreads()
    for k in range(thread, n, cuda.blockDim.x):
        first = body.begin[k]
        for p in range(first + 1, body.begin[k + 1]):
            value = body.link[p]
            q = p
            while q > first and body.link[q - 1] > value:
                body.link[q] = body.link[q - 1]
                q -= 1
            body.link[q] = value
    cuda.syncthreads()


@device_function
def update_rates(body, timestep_factor, implicit_damping, buffer):
    """The same as `ratd.engine.contacts.update_contact_rates`; needs `link_contacts`."""
    state = body.state
    thread = cuda.threadIdx.x
    contacts = state.counter[CONTACTS]
    for k in range(thread, state.counter[MONOMERS], cuda.blockDim.x):
        total = 0.0
        for p in range(body.begin[k], body.begin[k + 1]):
            total += state.contact[contact_start(contact_of(body.link[p])) + DAMPING]
        body.piece[k] = total
    step = np.inf
    for c in range(thread, contacts, cuda.blockDim.x):
        step = min(step, contact_timestep(state, c))
    step = -block_max(-step, buffer)  # its barriers stand between the totals and their use
    for c in range(thread, contacts, cuda.blockDim.x):
        i = state.pair_i[c]
        j = state.pair_j[c]
        rate = 0.0
        if implicit_damping:
            rate = (
                body.piece[i] * state.monomer[i * _ROW + INV_MASS] + body.piece[j] * state.monomer[j * _ROW + INV_MASS]
            )
        state.contact[contact_start(c) + DAMPING_RATE] = rate
    if contacts > 0 and thread == 0:
        state.scalar[DT] = timestep_factor * step
    cuda.syncthreads()


@device_function
def keep_reference(body, column):
    """Note where the monomers are."""
    monomer = body.state.monomer
    for k in range(cuda.threadIdx.x, body.state.counter[MONOMERS], cuda.blockDim.x):
        r = np.uint64(k) * _ROW
        body.reference[k, column] = monomer[r + X]
        body.reference[k, column + 1] = monomer[r + Y]
        body.reference[k, column + 2] = monomer[r + Z]


@device_function
def farthest_move(body, column, turning, buffer):
    """Greatest distance [m] of any monomer from where it was when `keep_reference` noted it.

    With `turning` less a turn of all about z, as on the processor (`ratd.engine.advance`).
    """
    monomer = body.state.monomer
    cos = 1.0
    sin = 0.0
    if turning:
        along = 0.0
        across = 0.0
        for k in range(cuda.threadIdx.x, body.state.counter[MONOMERS], cuda.blockDim.x):
            r = np.uint64(k) * _ROW
            along += monomer[r + X] * body.reference[k, column] + monomer[r + Y] * body.reference[k, column + 1]
            across += monomer[r + Y] * body.reference[k, column] - monomer[r + X] * body.reference[k, column + 1]
        along = block_sum(along, buffer)
        across = block_sum(across, buffer)
        length = math.sqrt(along * along + across * across)
        if length > 0.0:
            cos = along / length
            sin = across / length
    square = 0.0
    for k in range(cuda.threadIdx.x, body.state.counter[MONOMERS], cuda.blockDim.x):
        r = np.uint64(k) * _ROW
        dx = monomer[r + X] - (cos * body.reference[k, column] - sin * body.reference[k, column + 1])
        dy = monomer[r + Y] - (cos * body.reference[k, column + 1] + sin * body.reference[k, column])
        dz = monomer[r + Z] - body.reference[k, column + 2]
        square = max(square, dx * dx + dy * dy + dz * dz)
    return math.sqrt(block_max(square, buffer))


@device_function
def find_far(body, reach, counts):
    """List all pairs i < j whose surfaces are closer than `reach` [m], by i, then j.

    Returns
    -------
    int
        Number of pairs; where it is greater than the room in `far`, nothing was listed.
    """
    state = body.state
    thread = cuda.threadIdx.x
    n = state.counter[MONOMERS]
    cuda.syncthreads()
    for i in range(thread, n, cuda.blockDim.x):
        found = 0
        for j in range(i + 1, n):
            found += gap(state, i, j) < reach
        body.order[i] = found
    pairs = prefix_sum(body.order, n, counts)
    if pairs <= body.far.shape[0]:
        for i in range(thread, n, cuda.blockDim.x):
            p = body.order[i]
            for j in range(i + 1, n):
                if gap(state, i, j) < reach:
                    body.far[p, 0] = i
                    body.far[p, 1] = j
                    p += 1
        keep_reference(body, FAR_REFERENCE)
    cuda.syncthreads()
    return pairs


@device_function
def may_touch(body, p, reach):
    """Whether the pair p of the far list is not in contact and closer than `reach` [m]; needs `link_contacts`."""
    state = body.state
    i = body.far[p, 0]
    j = body.far[p, 1]
    if gap(state, i, j) > reach:
        return False
    for q in range(body.begin[i], body.begin[i + 1]):
        c = contact_of(body.link[q])
        if np.int64(state.pair_i[c]) == j or np.int64(state.pair_j[c]) == j:
            return False
    return True


@device_function
def find_near(body, pairs, reach, counts):
    """List the pairs of the far list that are not in contact and closer than `reach` [m], in its order.

    Returns
    -------
    int
        Number of pairs.
    """
    first, last = chunk_of(pairs)
    found = 0
    for p in range(first, last):
        found += may_touch(body, p, reach)
    place, total = sum_before(found, counts)
    for p in range(first, last):
        if may_touch(body, p, reach):
            body.near[place, 0] = body.far[p, 0]
            body.near[place, 1] = body.far[p, 1]
            place += 1
    keep_reference(body, NEAR_REFERENCE)
    cuda.syncthreads()
    return total
