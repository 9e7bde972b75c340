"""One grain in a kernel: its parts of the arrays of all grains."""

from typing import NamedTuple

import numpy as np

from ratd.cuda.arena import BLOCK_AT, FAR_PER_SLOT, MONOMER_AT, NUMBER_AT, RESULTS
from ratd.cuda.device import device_function
from ratd.engine.layout import BLOCK, LANES, ROW
from ratd.engine.state import State


class Body(NamedTuple):
    """A grain: its state, and its parts of the working space (see `ratd.cuda.arena.Arena`)."""

    state: State
    result: np.ndarray
    reference: np.ndarray
    piece: np.ndarray
    begin: np.ndarray
    link: np.ndarray
    far: np.ndarray
    near: np.ndarray
    label: np.ndarray
    order: np.ndarray


@device_function
def body_of(arena, grain):
    """`Body` of a grain. Its `force` is empty: on the device forces are summed where they are used."""
    m0 = arena.at[grain, MONOMER_AT]
    m1 = arena.at[grain + 1, MONOMER_AT]
    n0 = arena.at[grain, NUMBER_AT]
    n1 = arena.at[grain + 1, NUMBER_AT]
    b0 = arena.at[grain, BLOCK_AT]
    b1 = arena.at[grain + 1, BLOCK_AT]
    state = State(
        arena.monomer[m0 * ROW : m1 * ROW],
        arena.monomer[0:0],
        arena.contact[b0 * BLOCK : b1 * BLOCK],
        arena.pair_i[b0 * LANES : b1 * LANES],
        arena.pair_j[b0 * LANES : b1 * LANES],
        arena.identity[n0:n1],
        arena.fragment[n0:n1],
        arena.lost[n0:n1],
        arena.scalar[grain],
        arena.counter[grain],
        arena.material[grain],
    )
    return Body(
        state,
        arena.result[b0 * LANES * RESULTS : b1 * LANES * RESULTS],
        arena.reference[m0:m1],
        arena.piece[m0:m1],
        arena.begin[m0:m1],
        arena.link[2 * b0 * LANES : 2 * b1 * LANES],
        arena.far[FAR_PER_SLOT * b0 * LANES : FAR_PER_SLOT * b1 * LANES],
        arena.near[FAR_PER_SLOT * b0 * LANES : FAR_PER_SLOT * b1 * LANES],
        arena.label[m0:m1],
        arena.order[m0:m1],
    )
