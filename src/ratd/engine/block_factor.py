"""L D L^T of a symmetric positive definite matrix of 6 x 6 blocks on a graph, in the order of least degree.

One row of blocks a monomer, a block off the diagonal for each pair in contact. A tree fills in nothing: each column
then has one block below the diagonal, and a solution is one sweep up the tree and one down.
"""

import heapq
from typing import NamedTuple

import numpy as np

from ratd.base.jit import jit
from ratd.base.vectors import add8, load8, multiply8, spread8, store8, subtract8, sum8

SIDE = 6
PADDED = 8
"""Numbers of a column of a block, of which the last two are 0: a column is one vector."""
BLOCK = SIDE * PADDED

_PADDED = np.uint64(PADDED)
_BLOCK = np.uint64(BLOCK)
_COLUMNS = tuple(np.uint64(PADDED * c) for c in range(SIDE))


class BlockFactor(NamedTuple):
    """The factors; made by `order_blocks`, filled by `factorise`.

    Attributes
    ----------
    place : (n,) int64
        Place of each row in the order of elimination.
    first : (n + 1,) int64
        Where each column begins in `rows` and `lower`, by place.
    rows : (k,) int64
        Places of the blocks below the diagonal, rising in each column.
    diagonal : (48 n,) float64
        Blocks of the diagonal, column by column: the matrix before, the inverse of D after `factorise`.
    lower : (48 k,) float64
        Blocks below it, likewise: the matrix before, L after `factorise`.
    """

    place: np.ndarray
    first: np.ndarray
    rows: np.ndarray
    diagonal: np.ndarray
    lower: np.ndarray


@jit
def order_blocks(n, pair_i, pair_j, pairs):
    """Order of elimination and pattern of the factors.

    Parameters
    ----------
    n : int
        Number of rows of blocks.
    pair_i, pair_j : (pairs,) uint64
        Rows that share a block off the diagonal; a pair may occur twice.
    pairs : int

    Returns
    -------
    BlockFactor
        With zeros for numbers.

    Notes
    -----
    Least degree on a quotient graph (George & Liu 1989, SIAM Review 31, 1, Sect. 4): a row that is eliminated becomes
    an element, the clique of its neighbours, and takes in the elements that it touched. Rows and elements together
    never need more room than the graph had. Ties go to the lower number.
    """
    start, near = _adjacency(n, pair_i, pair_j, pairs)
    rows_near = np.empty(n, dtype=np.int64)  # the first so many of a row's entries are rows, the others elements
    entries = np.empty(n, dtype=np.int64)
    heap = [(np.int64(0), np.int64(0)) for _ in range(0)]
    degree = np.empty(n, dtype=np.int64)
    for v in range(n):
        rows_near[v] = entries[v] = degree[v] = start[v + 1] - start[v]
        heap.append((degree[v], np.int64(v)))
    heapq.heapify(heap)
    place = np.full(n, -1, dtype=np.int64)
    absorbed = np.zeros(n, dtype=np.bool_)
    mark = np.full(n, -1, dtype=np.int64)
    stamp = 0
    begin = np.zeros(n, dtype=np.int64)
    end = np.zeros(n, dtype=np.int64)
    pool = np.empty(4 * n + 64, dtype=np.int64)
    used = 0
    done = 0
    while done < n:
        d, v = heapq.heappop(heap)
        if place[v] >= 0 or d != degree[v]:
            continue
        # the clique that v leaves
        while used + n > pool.shape[0]:
            pool = np.concatenate((pool, np.empty(pool.shape[0], dtype=np.int64)))
        stamp += 1
        mark[v] = stamp
        begin[v] = used
        for p in range(start[v], start[v] + entries[v]):
            if p < start[v] + rows_near[v]:
                u = near[p]
                if mark[u] != stamp:
                    mark[u] = stamp
                    pool[used] = u
                    used += 1
            else:
                e = near[p]
                absorbed[e] = True
                for k in range(begin[e], end[e]):
                    u = pool[k]
                    if place[u] < 0 and mark[u] != stamp:
                        mark[u] = stamp
                        pool[used] = u
                        used += 1
        end[v] = used
        place[v] = done
        done += 1
        inside = stamp
        for k in range(begin[v], end[v]):
            u = pool[k]
            # rows outside the clique stay, elements not taken in stay, v is a new element
            s = start[u]
            kept = s
            for p in range(s, s + rows_near[u]):
                if mark[near[p]] != inside:
                    near[kept] = near[p]
                    kept += 1
            n_rows = kept - s
            for p in range(s + rows_near[u], s + entries[u]):
                if not absorbed[near[p]]:
                    near[kept] = near[p]
                    kept += 1
            near[kept] = v
            rows_near[u] = n_rows
            entries[u] = kept + 1 - s
        for k in range(begin[v], end[v]):
            u = pool[k]
            stamp += 1
            mark[u] = stamp
            d = 0
            for p in range(start[u], start[u] + entries[u]):
                if p < start[u] + rows_near[u]:
                    d += mark[near[p]] != stamp
                    mark[near[p]] = stamp
                else:
                    e = near[p]
                    for q in range(begin[e], end[e]):
                        w = pool[q]
                        if place[w] < 0 and mark[w] != stamp:
                            mark[w] = stamp
                            d += 1
            degree[u] = d
            heapq.heappush(heap, (np.int64(d), np.int64(u)))

    first = np.zeros(n + 1, dtype=np.int64)
    for v in range(n):
        first[place[v] + 1] = end[v] - begin[v]
    first = np.cumsum(first)
    rows = np.empty(first[n], dtype=np.int64)
    for v in range(n):
        at = first[place[v]]
        length = end[v] - begin[v]
        for k in range(length):
            rows[at + k] = place[pool[begin[v] + k]]
        rows[at : at + length].sort()
    return BlockFactor(place, first, rows, np.zeros(BLOCK * n), np.zeros(BLOCK * rows.shape[0]))


@jit
def _adjacency(n, pair_i, pair_j, pairs):
    """Neighbours of each row without repetition: (n + 1,) starts, and their numbers."""
    count = np.zeros(n + 1, dtype=np.int64)
    # a row that is paired with itself fills two places here; the marks below leave it out of its own neighbours
    for k in range(pairs):
        count[np.int64(pair_i[k]) + 1] += 1
        count[np.int64(pair_j[k]) + 1] += 1
    start = np.cumsum(count)
    filled = start[:n].copy()
    near = np.empty(start[n], dtype=np.int64)
    for k in range(pairs):
        i, j = np.int64(pair_i[k]), np.int64(pair_j[k])
        near[filled[i]] = j
        filled[i] += 1
        near[filled[j]] = i
        filled[j] += 1
    mark = np.full(n, -1, dtype=np.int64)
    kept = 0
    own = np.zeros(n + 1, dtype=np.int64)
    for v in range(n):
        mark[v] = v
        own[v] = kept
        for p in range(start[v], start[v + 1]):
            u = near[p]
            if mark[u] != v:
                mark[u] = v
                near[kept] = u
                kept += 1
    own[n] = kept
    return own, near[:kept].copy()


@jit
def find_block(factor, i, j):
    """Number of the block of a pair in `lower`, and whether its rows are those of i; -1 where there is none."""
    p, q = factor.place[i], factor.place[j]
    column, row = min(p, q), max(p, q)
    low, high = factor.first[column], factor.first[column + 1]
    while low < high:
        middle = (low + high) // 2
        if factor.rows[middle] < row:
            low = middle + 1
        else:
            high = middle
    if low < factor.first[column + 1] and factor.rows[low] == row:
        return low, p > q
    return -1, False


@jit
def factorise(factor, chosen):
    """Turn the matrix in `diagonal` and `lower` into the inverse of D and L.

    Parameters
    ----------
    factor : BlockFactor
    chosen : (n,) bool
        Places of the rows to treat, the others being factorised already: all, or those of parts that share no block
        with the others that is not 0.

    Returns
    -------
    bool
        Whether the matrix is positive definite.

    Notes
    -----
    Column by column, each subtracting A_bj D_j^-1 A_aj^T from the blocks (b, a) that it reaches (right-looking).
    """
    n = factor.place.shape[0]
    first, rows, diagonal, lower = factor.first, factor.rows, factor.diagonal, factor.lower
    longest = 0
    for j in range(n):
        longest = max(longest, first[j + 1] - first[j])
    kept = np.empty(BLOCK * max(longest, 1))
    inverse = np.zeros(BLOCK)
    work = np.zeros((SIDE, SIDE))
    for j in range(n):
        if not chosen[j]:
            continue
        if not _invert(diagonal, BLOCK * j, inverse, work):
            return False
        begin, end = first[j], first[j + 1]
        for a in range(begin, end):
            if not chosen[rows[a]]:
                continue
            for c in range(BLOCK):
                kept[BLOCK * (a - begin) + c] = lower[BLOCK * a + c]
            _times(lower, np.uint64(BLOCK * a), kept, np.uint64(BLOCK * (a - begin)), inverse)
        for a in range(begin, end):
            column = rows[a]
            if not chosen[column]:
                continue
            source = np.uint64(BLOCK * (a - begin))
            _take_product(diagonal, np.uint64(BLOCK * column), lower, np.uint64(BLOCK * a), kept, source)
            target = first[column]
            for b in range(a + 1, end):
                if not chosen[rows[b]]:
                    continue
                while rows[target] != rows[b]:
                    target += 1
                _take_product(lower, np.uint64(BLOCK * target), lower, np.uint64(BLOCK * b), kept, source)
    return True


@jit
def _invert(block, at, inverse, work):
    """Replace a positive definite block by its inverse, also left in `inverse`; False where it is not so (Cholesky)."""
    for c in range(SIDE):
        for r in range(c, SIDE):
            s = block[at + PADDED * c + r]
            for k in range(c):
                s -= work[r, k] * work[c, k]
            if r == c:
                if not s > 0.0:
                    return False
                work[c, c] = 1.0 / np.sqrt(s)
            else:
                work[r, c] = s * work[c, c]
    # the inverse of the triangle, above the diagonal
    for c in range(SIDE):
        for r in range(c + 1, SIDE):
            s = 0.0
            for k in range(c, r):
                s += work[r, k] * (work[c, c] if k == c else work[c, k])
            work[c, r] = -s * work[r, r]
    for c in range(SIDE):
        for r in range(c, SIDE):
            s = 0.0
            for k in range(r, SIDE):
                s += (work[r, r] if k == r else work[r, k]) * (work[c, c] if k == c else work[c, k])
            block[at + PADDED * c + r] = s
            block[at + PADDED * r + c] = s
            inverse[PADDED * c + r] = s
            inverse[PADDED * r + c] = s
    return True


@jit(forceinline=True)
def _times(result, at, block, source, inverse):
    """result = block times a symmetric block."""
    c0, c1, c2, c3, c4, c5 = _COLUMNS
    b0, b1, b2 = load8(block, source + c0), load8(block, source + c1), load8(block, source + c2)
    b3, b4, b5 = load8(block, source + c3), load8(block, source + c4), load8(block, source + c5)
    for c in range(SIDE):
        q = PADDED * c
        s = multiply8(b0, spread8(inverse[q]))
        s = add8(s, multiply8(b1, spread8(inverse[q + 1])))
        s = add8(s, multiply8(b2, spread8(inverse[q + 2])))
        s = add8(s, multiply8(b3, spread8(inverse[q + 3])))
        s = add8(s, multiply8(b4, spread8(inverse[q + 4])))
        s = add8(s, multiply8(b5, spread8(inverse[q + 5])))
        store8(result, at + np.uint64(q), s)


@jit(forceinline=True)
def _take_product(result, at, left, first, right, second):
    """result -= left right^T."""
    c0, c1, c2, c3, c4, c5 = _COLUMNS
    b0, b1, b2 = load8(left, first + c0), load8(left, first + c1), load8(left, first + c2)
    b3, b4, b5 = load8(left, first + c3), load8(left, first + c4), load8(left, first + c5)
    for c in range(SIDE):
        q = second + np.uint64(c)
        t = at + np.uint64(PADDED * c)
        s = load8(result, t)
        s = subtract8(s, multiply8(b0, spread8(right[q + c0])))
        s = subtract8(s, multiply8(b1, spread8(right[q + c1])))
        s = subtract8(s, multiply8(b2, spread8(right[q + c2])))
        s = subtract8(s, multiply8(b3, spread8(right[q + c3])))
        s = subtract8(s, multiply8(b4, spread8(right[q + c4])))
        s = subtract8(s, multiply8(b5, spread8(right[q + c5])))
        store8(result, t, s)


@jit
def solve(factor, x):
    """Solve for one right-hand side, in place.

    Parameters
    ----------
    factor : BlockFactor
        After `factorise`.
    x : (8 n,) float64 array
        Eight numbers a row of which the last two are 0, in the order of places.
    """
    n = factor.place.shape[0]
    first, rows, diagonal, lower = factor.first, factor.rows, factor.diagonal, factor.lower
    c0, c1, c2, c3, c4, c5 = _COLUMNS
    for j in range(n):
        at = np.uint64(j) * _PADDED
        x0, x1, x2 = spread8(x[at]), spread8(x[at + np.uint64(1)]), spread8(x[at + np.uint64(2)])
        x3, x4, x5 = (
            spread8(x[at + np.uint64(3)]),
            spread8(x[at + np.uint64(4)]),
            spread8(x[at + np.uint64(5)]),
        )
        for a in range(first[j], first[j + 1]):
            t = np.uint64(rows[a]) * _PADDED
            b = np.uint64(a) * _BLOCK
            s = subtract8(load8(x, t), multiply8(load8(lower, b + c0), x0))
            u = multiply8(load8(lower, b + c1), x1)
            s = subtract8(s, multiply8(load8(lower, b + c2), x2))
            u = add8(u, multiply8(load8(lower, b + c3), x3))
            s = subtract8(s, multiply8(load8(lower, b + c4), x4))
            u = add8(u, multiply8(load8(lower, b + c5), x5))
            store8(x, t, subtract8(s, u))
    for j in range(n - 1, -1, -1):
        at = np.uint64(j) * _PADDED
        b = np.uint64(j) * _BLOCK
        s = multiply8(load8(diagonal, b + c0), spread8(x[at]))
        u = multiply8(load8(diagonal, b + c1), spread8(x[at + np.uint64(1)]))
        s = add8(s, multiply8(load8(diagonal, b + c2), spread8(x[at + np.uint64(2)])))
        u = add8(u, multiply8(load8(diagonal, b + c3), spread8(x[at + np.uint64(3)])))
        s = add8(s, multiply8(load8(diagonal, b + c4), spread8(x[at + np.uint64(4)])))
        u = add8(u, multiply8(load8(diagonal, b + c5), spread8(x[at + np.uint64(5)])))
        store8(x, at, add8(s, u))
        if first[j + 1] > first[j]:
            zero = spread8(0.0)
            s0, s1, s2, s3, s4, s5 = zero, zero, zero, zero, zero, zero
            for a in range(first[j], first[j + 1]):
                y = load8(x, np.uint64(rows[a]) * _PADDED)
                b = np.uint64(a) * _BLOCK
                s0 = add8(s0, multiply8(load8(lower, b + c0), y))
                s1 = add8(s1, multiply8(load8(lower, b + c1), y))
                s2 = add8(s2, multiply8(load8(lower, b + c2), y))
                s3 = add8(s3, multiply8(load8(lower, b + c3), y))
                s4 = add8(s4, multiply8(load8(lower, b + c4), y))
                s5 = add8(s5, multiply8(load8(lower, b + c5), y))
            x[at] -= sum8(s0)
            x[at + np.uint64(1)] -= sum8(s1)
            x[at + np.uint64(2)] -= sum8(s2)
            x[at + np.uint64(3)] -= sum8(s3)
            x[at + np.uint64(4)] -= sum8(s4)
            x[at + np.uint64(5)] -= sum8(s5)
