"""The fragments of a state, and the shape of the largest."""

import numpy as np

from ratd.base.jit import jit
from ratd.engine.fragments import pieces
from ratd.engine.layout import LARGEST_MONOMERS, MASS, MONOMERS, RADIUS, ROW, X, Y, Z
from ratd.geometry.shape import shape_of

_ROW = np.uint64(ROW)


def heaviest_pieces(state, number=2):
    """Masses [kg] of the heaviest pieces, (number,), the heaviest first; 0 where there are fewer."""
    mass = np.sort(pieces(state)[0])[::-1][:number]
    return np.concatenate([mass, np.zeros(number - len(mass))])


def ranked_pieces(state):
    """The piece of each monomer, (n,) int, 0 being the heaviest, as the monomers stand in the state."""
    mass, _, label = pieces(state)
    rank = np.empty(len(mass), dtype=np.int64)
    rank[np.argsort(-mass, kind="stable")] = np.arange(len(mass))
    return rank[label]


@jit
def largest_fragment(state):
    """Positions (m, 3) [m], masses (m,) [kg] and radii (m,) [m] of the largest fragment."""
    members = state.counter[LARGEST_MONOMERS]
    position = np.empty((members, 3))
    mass = np.empty(members)
    radius = np.empty(members)
    at = 0
    for k in range(state.counter[MONOMERS]):
        if state.fragment[k] == 0:
            r = np.uint64(k) * _ROW
            position[at, 0] = state.monomer[r + X]
            position[at, 1] = state.monomer[r + Y]
            position[at, 2] = state.monomer[r + Z]
            mass[at] = state.monomer[r + MASS]
            radius[at] = state.monomer[r + RADIUS]
            at += 1
    return position, mass, radius


@jit
def fragment_shape(state, density):
    """Mass [kg], semi-axes a, b, c [m] and porosity of the largest fragment."""
    position, mass, radius = largest_fragment(state)
    a, b, c, porosity = shape_of(position, mass, radius, density)
    return mass.sum(), a, b, c, porosity
