"""Pairs that may come into contact: a far list from a search through all monomers, and a near one from it.

The near list is looked at in every step. A list of some reach is good until some monomer may have moved by half of it,
relative to a box that changes. A contact that breaks joins the near list, one that forms leaves it.
"""

import math

import numpy as np

from ratd.base.jit import jit
from ratd.engine.contacts import difference, gap, get_image
from ratd.engine.layout import CONTACTS, MONOMERS, RADIUS, ROW, VX, VY, VZ, X, Y, Z

FAR, NEAR = 0.2, 0.02
"""Reach of the two lists, in mean monomer radii."""
_ROW = np.uint64(ROW)


@jit
def mean_radius(state):
    """Mean, least and greatest radius of the monomers [m], (3,)."""
    mean, least, greatest = 0.0, np.inf, 0.0
    n = state.counter[MONOMERS]
    for k in range(n):
        a = state.monomer[np.uint64(k) * _ROW + RADIUS]
        mean += a / n
        least = min(least, a)
        greatest = max(greatest, a)
    return mean, least, greatest


@jit
def positions(state):
    """Positions (n, 3) and radii (n,) of the monomers [m]."""
    n = state.counter[MONOMERS]
    position = np.empty((n, 3))
    radius = np.empty(n)
    for k in range(n):
        r = np.uint64(k) * _ROW
        position[k, 0] = state.monomer[r + X]
        position[k, 1] = state.monomer[r + Y]
        position[k, 2] = state.monomer[r + Z]
        radius[k] = state.monomer[r + RADIUS]
    return position, radius


@jit
def farthest_move(state, reference, scale, turning):
    """Greatest distance of any monomer from where it was [m].

    Parameters
    ----------
    state : State
    reference : (n, 3) float64 array
        Where they were.
    scale : tuple of float
        How much the box has grown along x, y, z since then.
    turning : bool
        Whether the monomers as a whole are first turned back about z: distances within a grain that only turns do not
        change, however far its monomers go.
    """
    cos, sin = 1.0, 0.0
    if turning:
        along, across = 0.0, 0.0
        for k in range(reference.shape[0]):
            r = np.uint64(k) * _ROW
            x, y = state.monomer[r + X], state.monomer[r + Y]
            along += x * reference[k, 0] + y * reference[k, 1]
            across += y * reference[k, 0] - x * reference[k, 1]
        length = math.sqrt(along * along + across * across)
        if length > 0.0:
            cos, sin = along / length, across / length
    square = 0.0
    for k in range(reference.shape[0]):
        r = np.uint64(k) * _ROW
        dx = state.monomer[r + X] - scale[0] * (cos * reference[k, 0] - sin * reference[k, 1])
        dy = state.monomer[r + Y] - scale[1] * (cos * reference[k, 1] + sin * reference[k, 0])
        dz = state.monomer[r + Z] - scale[2] * reference[k, 2]
        square = max(square, dx * dx + dy * dy + dz * dz)
    return math.sqrt(square)


@jit
def growth(box, scalar, edges):
    """How much each edge of the box has grown since it was `edges`, (3,); 1 in open space."""
    now = box.edges(scalar)
    if edges[0] == 0.0:
        return 1.0, 1.0, 1.0
    return now[0] / edges[0], now[1] / edges[1], now[2] / edges[2]


@jit
def reach_left(reach, scale, greatest):
    """What is left of a list's reach when the box has shrunk [m], for spheres of up to the greatest radius."""
    shrunk = min(1.0, min(scale[0], min(scale[1], scale[2])))
    return shrunk * reach - (1.0 - shrunk) * 2.0 * greatest


@jit
def near_pairs(state, box, far, reach):
    """Pairs of the far list that are not in contact and closer than `reach`: the list, with room, and their number."""
    edges = box.edges(state.scalar)
    n = state.counter[MONOMERS]
    n_contacts = state.counter[CONTACTS]
    begin = np.zeros(n + 2, dtype=np.int64)
    for k in range(n_contacts):
        begin[min(state.pair_i[k], state.pair_j[k]) + np.uint64(2)] += 1
    for k in range(n):
        begin[k + 2] += begin[k + 1]
    member = np.empty(n_contacts, dtype=np.int64)
    for k in range(n_contacts):
        low = min(state.pair_i[k], state.pair_j[k])
        member[begin[low + np.uint64(1)]] = k
        begin[low + np.uint64(1)] += 1
    near = np.empty((far.shape[0] + 64, 5), dtype=np.int64)
    count = 0
    for p in range(far.shape[0]):
        i = far[p, 0]
        j = far[p, 1]
        image = (far[p, 2], far[p, 3], far[p, 4])
        if gap(state, edges, i, j, image) > reach:
            continue
        touching = False
        for q in range(begin[i], begin[i + 1]):
            k = member[q]
            other = get_image(state, k)
            if state.pair_i[k] == np.uint64(i):
                touching |= state.pair_j[k] == np.uint64(j) and other == image
            else:
                back = (-image[0], -image[1], -image[2])
                touching |= state.pair_i[k] == np.uint64(j) and other == back
        if not touching:
            near[count] = far[p]
            count += 1
    return near, count


@jit
def with_pair(near, count, i, j, image):
    """The near list with one pair more, and their number."""
    if count == near.shape[0]:
        near = np.concatenate((near, np.empty((count + 64, 5), dtype=np.int64)))
    near[count, 0] = i
    near[count, 1] = j
    for axis in range(3):
        near[count, 2 + axis] = image[axis]
    return near, count + 1


@jit
def count_touching(state, box, near, count):
    """How many of the pairs of the near list touch."""
    edges = box.edges(state.scalar)
    found = 0
    for p in range(count):
        found += gap(state, edges, near[p, 0], near[p, 1], (near[p, 2], near[p, 3], near[p, 4])) <= 0.0
    return found


@jit
def time_to_overlap(state, box, far, overlap):
    """Shortest times [s] in which a pair of the far list, now apart, comes to touch and to overlap by `overlap` [m]."""
    edges = box.edges(state.scalar)
    hx, hy, hz = box.rates()
    monomer = state.monomer
    touch, deep = np.inf, np.inf
    for p in range(far.shape[0]):
        i, j = far[p, 0], far[p, 1]
        dx, dy, dz, distance = difference(state, edges, i, j, (far[p, 2], far[p, 3], far[p, 4]))
        ri, rj = np.uint64(i) * _ROW, np.uint64(j) * _ROW
        apart = distance - monomer[ri + RADIUS] - monomer[rj + RADIUS]
        vx = monomer[ri + VX] - monomer[rj + VX] + hx * dx
        vy = monomer[ri + VY] - monomer[rj + VY] + hy * dy
        vz = monomer[ri + VZ] - monomer[rj + VZ] + hz * dz
        closing = -(vx * dx + vy * dy + vz * dz)
        if apart > 0.0 and closing > 0.0:
            touch = min(touch, apart * distance / closing)
            deep = min(deep, (apart + overlap) * distance / closing)
    return touch, deep


@jit
def take_touching(state, box, near, count, found):
    """Take the pairs that touch, so many, out of the near list: these, sorted, and the number of those left.

    Sorted, so that the order in which contacts form, and with it every sum, does not depend on that of the list.
    """
    edges = box.edges(state.scalar)
    touching = np.empty((found, 5), dtype=np.int64)
    found = 0
    kept = 0
    for p in range(count):
        if gap(state, edges, near[p, 0], near[p, 1], (near[p, 2], near[p, 3], near[p, 4])) <= 0.0:
            q = found
            while q > 0 and _before(near, p, touching, q - 1):
                touching[q] = touching[q - 1]
                q -= 1
            touching[q] = near[p]
            found += 1
        else:
            near[kept] = near[p]
            kept += 1
    return touching, kept


@jit
def _before(first, p, second, q):
    for column in range(5):
        if first[p, column] != second[q, column]:
            return first[p, column] < second[q, column]
    return False
