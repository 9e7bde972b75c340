"""Which spheres are near each other, and which hang together.

Both functions are compiled and may be called from compiled code. Neither knows anything about forces.
"""

import numpy as np

from ratd.base.jit import jit

__all__ = ["close_pairs", "connected_components"]

_BITS = 20
"""Bits of a cell number along each axis: three of them, each with a margin, fit into one 64-bit key."""


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
    The spheres are sorted into cubic cells no smaller than the greatest distance at which a pair counts, so that the
    partners of a sphere lie in its own cell and the 26 around it. Only cells that hold a sphere exist. They are
    visited in the order of their keys, and of every row of cells along z that may hold partners the beginning moves
    only forwards, so that apart from the sort everything is linear in n.
    """
    n = radius.shape[0]
    widest = 0.0
    for i in range(n):
        widest = max(widest, radius[i])
    size = 2.0 * widest + reach
    if n < 2 or size <= 0.0:
        return np.empty((0, 2), dtype=np.int64)

    lowest = position[0].copy()
    extent = 0.0
    for axis in range(3):
        highest = position[0, axis]
        for i in range(n):
            lowest[axis] = min(lowest[axis], position[i, axis])
            highest = max(highest, position[i, axis])
        extent = max(extent, highest - lowest[axis])
    # Wider cells than needed are still right; the margin keeps the last cell number below 2^_BITS after rounding.
    size = max(size * (1.0 + 1e-12), extent / (2.0**_BITS - 2.0))

    # Numbers start at 1, so that the cells before and after along z have keys of their own.
    stride_y = np.int64(1) << (_BITS + 1)
    stride_x = stride_y << (_BITS + 1)
    key = np.empty(n, dtype=np.int64)
    for i in range(n):
        cx = np.int64((position[i, 0] - lowest[0]) / size) + 1
        cy = np.int64((position[i, 1] - lowest[1]) / size) + 1
        cz = np.int64((position[i, 2] - lowest[2]) / size) + 1
        key[i] = cx * stride_x + cy * stride_y + cz
    order = np.argsort(key, kind="mergesort")

    x = np.empty(n)
    y = np.empty(n)
    z = np.empty(n)
    a = np.empty(n)
    cell = np.empty(n, dtype=np.int64)
    for s in range(n):
        i = order[s]
        x[s] = position[i, 0]
        y[s] = position[i, 1]
        z[s] = position[i, 2]
        a[s] = radius[i]
        cell[s] = key[i]

    # Rows of three cells along z, given by their middle; with the own row they see every pair of cells once.
    row = np.array([stride_y, stride_x - stride_y, stride_x, stride_x + stride_y])
    begin = np.zeros(4, dtype=np.int64)
    first = np.empty(4 * n, dtype=np.int64)
    second = np.empty(4 * n, dtype=np.int64)
    count = 0
    for s in range(n):
        for part in range(5):
            if part == 0:
                start = s + 1
                last = cell[s] + 1
            else:
                lowest_key = cell[s] + row[part - 1] - 1
                start = begin[part - 1]
                while start < n and cell[start] < lowest_key:
                    start += 1
                begin[part - 1] = start
                last = lowest_key + 2
            for t in range(start, n):
                if cell[t] > last:
                    break
                dx = x[t] - x[s]
                dy = y[t] - y[s]
                dz = z[t] - z[s]
                limit = a[s] + a[t] + reach
                if dx * dx + dy * dy + dz * dz < limit * limit and limit > 0.0:
                    if count == first.shape[0]:
                        first = np.concatenate((first, np.empty(count, dtype=np.int64)))
                        second = np.concatenate((second, np.empty(count, dtype=np.int64)))
                    first[count] = min(order[s], order[t])
                    second[count] = max(order[s], order[t])
                    count += 1
    return _sorted_pairs(n, first, second, count)


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
