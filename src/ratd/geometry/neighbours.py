"""Which spheres are near each other, and which hang together.

All functions are compiled and may be called from compiled code. None knows anything about forces.
"""

import math

import numpy as np

from ratd.base.jit import jit

__all__ = ["close_images", "close_pairs", "connected_components"]

CLASS_WIDTH = 2.5
"""Greatest radius over the least in one class of the search."""

_BITS = 20
"""Bits of a cell number along each axis: three of them, each with a margin, fit into one 64-bit key."""
_STRIDE_Y = 1 << (_BITS + 1)
_STRIDE_X = _STRIDE_Y << (_BITS + 1)
_ROWS = (_STRIDE_Y, _STRIDE_X - _STRIDE_Y, _STRIDE_X, _STRIDE_X + _STRIDE_Y)
"""Rows of three cells along z, given by their middle; with the own row they see every pair of cells once."""


@jit
def close_pairs(position, radius, reach):
    """All pairs of spheres whose surfaces are closer than a given distance.

    Parameters
    ----------
    position : (n, 3) float64 array
        Centres [m], finite, spread over any volume.
    radius : (n,) float64 array
        Radii [m], greater than 0.
    reach : float
        Pairs with |X_i - X_j| < a_i + a_j + reach count [m]; 0 finds the overlapping ones, less than 0 those that
        overlap by more than that.

    Returns
    -------
    (k, 2) int64 array
        i < j, sorted by i, then by j.

    Notes
    -----
    Spheres are sorted into classes of radii, each a factor of `CLASS_WIDTH` wide, so that a few large ones do not make
    the cells of all others large. Those of a class are sorted into cubic cells no smaller than the greatest distance
    at which a pair of them counts; so the partners of a sphere, of its class or a smaller one, lie in the same cell
    and the 26 around it. Only cells that hold a sphere exist. They are visited in the order of their keys, and of every
    row of cells along z that may hold partners the beginning moves only forwards, so that apart from the sorts
    everything is linear in n.
    """
    n = radius.shape[0]
    first = np.empty(4 * n, dtype=np.int64)
    second = np.empty(4 * n, dtype=np.int64)
    count = 0
    if n < 2:
        return np.empty((0, 2), dtype=np.int64)
    least = radius.min()
    size_class = np.empty(n, dtype=np.int64)
    classes = 0
    for i in range(n):
        size_class[i] = np.int64(math.log(radius[i] / least) / math.log(CLASS_WIDTH))
        classes = max(classes, size_class[i] + 1)
    for b in range(classes):
        large = np.flatnonzero(size_class == b)
        if large.shape[0] == 0:
            continue
        small = np.flatnonzero(size_class < b)
        size = 2.0 * radius[large].max() + reach
        if size <= 0.0:
            continue
        lowest, size = _grid(position, size)
        large, large_key = _in_cells(position, large, lowest, size)
        first, second, count = _pairs_within(position, radius, reach, large, large_key, first, second, count)
        if small.shape[0] > 0:
            small, small_key = _in_cells(position, small, lowest, size)
            first, second, count = _pairs_between(
                position, radius, reach, small, small_key, large, large_key, first, second, count
            )
    return _sorted_pairs(n, first, second, count)


@jit
def _grid(position, size):
    """Lowest corner (3,) of a grid around all spheres, and the edge of its cells, not below `size`."""
    lowest = position[0].copy()
    extent = 0.0
    for axis in range(3):
        highest = position[0, axis]
        for i in range(position.shape[0]):
            lowest[axis] = min(lowest[axis], position[i, axis])
            highest = max(highest, position[i, axis])
        extent = max(extent, highest - lowest[axis])
    # Wider cells than needed are still right; the margin keeps the last cell number below 2^_BITS after rounding.
    return lowest, max(size * (1.0 + 1e-12), extent / (2.0**_BITS - 2.0))


@jit
def _in_cells(position, members, lowest, size):
    """Spheres in the order of the keys of their cells, and these keys. Numbers start at 1, so that the cells before and
    after along z have keys of their own."""
    key = np.empty(members.shape[0], dtype=np.int64)
    for s in range(members.shape[0]):
        i = members[s]
        cx = np.int64((position[i, 0] - lowest[0]) / size) + 1
        cy = np.int64((position[i, 1] - lowest[1]) / size) + 1
        cz = np.int64((position[i, 2] - lowest[2]) / size) + 1
        key[s] = cx * _STRIDE_X + cy * _STRIDE_Y + cz
    order = np.argsort(key, kind="mergesort")
    return members[order], key[order]


@jit(forceinline=True)
def _counts(position, radius, reach, i, j):
    """Whether a pair counts."""
    dx = position[i, 0] - position[j, 0]
    dy = position[i, 1] - position[j, 1]
    dz = position[i, 2] - position[j, 2]
    limit = radius[i] + radius[j] + reach
    return dx * dx + dy * dy + dz * dz < limit * limit and limit > 0.0


@jit
def _pairs_within(position, radius, reach, members, cell, first, second, count):
    """Add the pairs among spheres of one class: of a sphere with the rest of its own cell and those after it."""
    n = members.shape[0]
    # Copies in the order of the cells, since they are read again and again.
    near = position[members]
    a = radius[members]
    begin = np.zeros(4, dtype=np.int64)
    for s in range(n):
        for part in range(5):
            if part == 0:
                start = s + 1
                last = cell[s] + 1
            else:
                lowest_key = cell[s] + _ROWS[part - 1] - 1
                start = begin[part - 1]
                while start < n and cell[start] < lowest_key:
                    start += 1
                begin[part - 1] = start
                last = lowest_key + 2
            for t in range(start, n):
                if cell[t] > last:
                    break
                if _counts(near, a, reach, s, t):
                    if count == first.shape[0]:
                        first = np.concatenate((first, np.empty(count, dtype=np.int64)))
                        second = np.concatenate((second, np.empty(count, dtype=np.int64)))
                    first[count] = min(members[s], members[t])
                    second[count] = max(members[s], members[t])
                    count += 1
    return first, second, count


@jit
def _pairs_between(position, radius, reach, small, small_cell, large, large_cell, first, second, count):
    """Add the pairs of a smaller with a larger sphere, in cells of the larger ones."""
    begin = np.zeros(9, dtype=np.int64)
    for s in range(small.shape[0]):
        for part in range(9):
            lowest_key = small_cell[s] + (part // 3 - 1) * _STRIDE_X + (part % 3 - 1) * _STRIDE_Y - 1
            start = begin[part]
            while start < large.shape[0] and large_cell[start] < lowest_key:
                start += 1
            begin[part] = start
            for t in range(start, large.shape[0]):
                if large_cell[t] > lowest_key + 2:
                    break
                if _counts(position, radius, reach, small[s], large[t]):
                    if count == first.shape[0]:
                        first = np.concatenate((first, np.empty(count, dtype=np.int64)))
                        second = np.concatenate((second, np.empty(count, dtype=np.int64)))
                    first[count] = min(small[s], large[t])
                    second[count] = max(small[s], large[t])
                    count += 1
    return first, second, count


@jit
def close_images(position, radius, reach, edges):
    """All pairs of spheres, and of a sphere with a copy, that are closer than a given distance in a periodic box.

    Parameters
    ----------
    position : (n, 3) float64 array
        Centres [m], anywhere.
    radius : (n,) float64 array
        Radii [m].
    reach : float
        As for `close_pairs`.
    edges : tuple of float
        Edges of the box along x, y, z [m].

    Returns
    -------
    (k, 5) int64 array
        i, j and the image, three integers n: X_i - X_j + n L is the difference. i < j, or i = j with a positive first
        number of n that is not 0; sorted by i, then by j.

    Notes
    -----
    Spheres near a face get copies beyond the other faces, and the search goes on in open space; so any number of copies
    may be within reach.
    """
    n = radius.shape[0]
    widest = 2.0 * radius.max() + reach
    cell = np.empty((n, 3), dtype=np.int64)
    inside = np.empty((n, 3))
    most = np.empty(3, dtype=np.int64)
    for axis in range(3):
        most[axis] = np.int64(math.ceil(widest / edges[axis]))
        for i in range(n):
            cell[i, axis] = np.int64(math.floor(position[i, axis] / edges[axis]))
            inside[i, axis] = position[i, axis] - cell[i, axis] * edges[axis]
    room = 4 * n + 64
    owner = np.empty(room, dtype=np.int64)
    shift = np.empty((room, 3), dtype=np.int64)
    place = np.empty((room, 3))
    copies = 0
    for gx in range(-most[0], most[0] + 1):
        for gy in range(-most[1], most[1] + 1):
            for gz in range(-most[2], most[2] + 1):
                g = (gx, gy, gz)
                home = gx == 0 and gy == 0 and gz == 0
                for i in range(n):
                    near = True
                    for axis in range(3):
                        x = inside[i, axis] + g[axis] * edges[axis]
                        near &= -widest <= x <= edges[axis] + widest
                    if not (near or home):
                        continue
                    if copies == room:
                        owner = np.concatenate((owner, np.empty(room, dtype=np.int64)))
                        shift = np.concatenate((shift, np.empty((room, 3), dtype=np.int64)))
                        place = np.concatenate((place, np.empty((room, 3))))
                        room *= 2
                    owner[copies] = i
                    for axis in range(3):
                        shift[copies, axis] = g[axis]
                        place[copies, axis] = inside[i, axis] + g[axis] * edges[axis]
                    copies += 1
    found = close_pairs(place[:copies], radius[owner[:copies]], reach)
    kept = np.empty((found.shape[0], 5), dtype=np.int64)
    count = 0
    for p in range(found.shape[0]):
        i, j = found[p, 0], found[p, 1]
        # One of the two lies in the box; of each pair of copies only one is kept.
        for turn in range(2):
            if turn == 1:
                i, j = j, i
            if shift[i, 0] != 0 or shift[i, 1] != 0 or shift[i, 2] != 0:
                continue
            if owner[i] > owner[j]:
                continue
            image = (
                cell[owner[j], 0] - cell[owner[i], 0] - shift[j, 0],
                cell[owner[j], 1] - cell[owner[i], 1] - shift[j, 1],
                cell[owner[j], 2] - cell[owner[i], 2] - shift[j, 2],
            )
            if owner[i] == owner[j]:
                sign = image[0] if image[0] != 0 else (image[1] if image[1] != 0 else image[2])
                if sign <= 0:
                    continue
            elif turn == 1 and shift[j, 0] == 0 and shift[j, 1] == 0 and shift[j, 2] == 0:
                continue
            kept[count, 0] = owner[i]
            kept[count, 1] = owner[j]
            for axis in range(3):
                kept[count, 2 + axis] = image[axis]
            count += 1
    kept = kept[:count]
    order = np.argsort(kept[:, 0] * n + kept[:, 1], kind="mergesort")
    return kept[order]


@jit
def _sorted_pairs(n, first, second, count):
    """The first `count` pairs as one (count, 2) array sorted by both columns, by counting and short insertions."""
    begin = np.zeros(n + 1, dtype=np.int64)
    for p in range(count):
        begin[first[p] + 1] += 1
    for i in range(n):
        begin[i + 1] += begin[i]
    filled = begin[:n].copy()
    pairs = np.empty((count, 2), dtype=np.int64)
    for p in range(count):
        i = first[p]
        j = second[p]
        q = filled[i]
        filled[i] += 1
        while q > begin[i] and pairs[q - 1, 1] > j:
            pairs[q, 1] = pairs[q - 1, 1]
            q -= 1
        pairs[q, 1] = j
    for i in range(n):
        for q in range(begin[i], begin[i + 1]):
            pairs[q, 0] = i
    return pairs


@jit
def connected_components(n, pairs):
    """Which monomers hang together.

    Parameters
    ----------
    n : int
        Number of monomers.
    pairs : (k, 2) int64 array
        Pairs in contact, in any order.

    Returns
    -------
    (n,) int64 array
        Label of each monomer's piece: 0, 1, ... in the order of the first monomer of each piece.
    """
    root = np.arange(n)
    for p in range(pairs.shape[0]):
        i = pairs[p, 0]
        j = pairs[p, 1]
        while root[i] != i:
            root[i] = root[root[i]]
            i = root[i]
        while root[j] != j:
            root[j] = root[root[j]]
            j = root[j]
        # The root is the first monomer of its piece, so that a root comes before all that point to it.
        if i < j:
            root[j] = i
        else:
            root[i] = j
    label = np.empty(n, dtype=np.int64)
    pieces = 0
    for i in range(n):
        if root[i] == i:
            label[i] = pieces
            pieces += 1
        else:
            label[i] = label[root[i]]
    return label
