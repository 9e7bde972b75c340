"""The block factors against dense linear algebra."""

import numpy as np
import pytest

from ratd.engine.block_factor import BLOCK, PADDED, SIDE, factorise, find_block, order_blocks, solve


def all_of(factor):
    return np.ones(len(factor.place), dtype=bool)


def solved(factor, right):
    """The solution for one right-hand side, (n, 6), in the order of the rows."""
    x = np.zeros((len(right), PADDED))
    x[factor.place, :SIDE] = right
    x = x.ravel()
    solve(factor, x)
    return x.reshape(-1, PADDED)[factor.place, :SIDE]


def filled(n, pairs, rng):
    """Factors that hold a random positive definite matrix on a graph, and the same matrix dense."""
    pairs = np.array(pairs, dtype=np.uint64).reshape(-1, 2)
    factor = order_blocks(n, pairs[:, 0], pairs[:, 1], len(pairs))
    diagonal = factor.diagonal.reshape(n, SIDE, PADDED)
    lower = factor.lower.reshape(-1, SIDE, PADDED)
    dense = np.zeros((SIDE * n, SIDE * n))
    for i, j in pairs.astype(int):
        part = rng.normal(size=(SIDE, 2 * SIDE))
        square = part.T @ part
        diagonal[factor.place[i], :, :SIDE] += square[:SIDE, :SIDE]
        diagonal[factor.place[j], :, :SIDE] += square[SIDE:, SIDE:]
        at, rows_of_i = find_block(factor, i, j)
        block = square[:SIDE, SIDE:]
        lower[at, :, :SIDE] += block.T if rows_of_i else block  # kept column by column
        both = np.r_[SIDE * i : SIDE * (i + 1), SIDE * j : SIDE * (j + 1)]
        dense[np.ix_(both, both)] += square
    for i in range(n):
        diagonal[factor.place[i], range(SIDE), range(SIDE)] += 0.1
    return factor, dense + 0.1 * np.eye(SIDE * n)


@pytest.mark.parametrize("density", [0.0, 0.03, 0.3])
def test_solution_is_that_of_the_dense_matrix(density):
    rng = np.random.default_rng(4)
    n = 40
    pairs = [(int(rng.integers(k)), k) for k in range(1, n - 3)]  # three rows stand alone
    pairs += [(i, j) for i in range(n - 3) for j in range(i) if rng.random() < density]
    pairs += pairs[:3]  # a pair may touch twice
    factor, dense = filled(n, pairs, rng)
    assert factorise(factor, all_of(factor))
    right = rng.normal(size=(n, SIDE))
    np.testing.assert_allclose(
        solved(factor, right).ravel(), np.linalg.solve(dense, right.ravel()), rtol=1e-9, atol=1e-9
    )


def test_a_tree_fills_in_nothing():
    rng = np.random.default_rng(1)
    pairs = np.array([(int(rng.integers(k)), k) for k in range(1, 500)], dtype=np.uint64)
    factor = order_blocks(500, pairs[:, 0], pairs[:, 1], len(pairs))
    assert len(factor.rows) == 499 and len(factor.lower) == 499 * BLOCK
    assert sorted(factor.place) == list(range(500))
    for column in range(500):
        rows = factor.rows[factor.first[column] : factor.first[column + 1]]
        assert (rows > column).all() and (np.diff(rows) > 0).all()


def test_a_matrix_that_is_not_positive_definite_is_told():
    factor, _ = filled(3, [(0, 1), (1, 2)], np.random.default_rng(0))
    factor.diagonal[0] = -1.0
    assert not factorise(factor, all_of(factor))


def test_a_part_may_be_factorised_again_alone():
    """Two chains in one pattern, joined by a block that is 0, as when a contact has broken."""
    rng = np.random.default_rng(7)
    n = 12
    pairs = [(k, k + 1) for k in range(n - 1) if k != 5]
    with_joint = np.array([*pairs, (5, 6), (2, 8)], dtype=np.uint64)
    factor = order_blocks(n, with_joint[:, 0], with_joint[:, 1], len(with_joint))
    first, dense = filled(n, pairs, rng)
    for i in range(n):
        at, to = BLOCK * first.place[i], BLOCK * factor.place[i]
        factor.diagonal[to : to + BLOCK] = first.diagonal[at : at + BLOCK]
    for i, j in pairs:
        block = dense[SIDE * i : SIDE * (i + 1), SIDE * j : SIDE * (j + 1)]
        at, rows_of_i = find_block(factor, i, j)
        factor.lower.reshape(-1, SIDE, PADDED)[at, :, :SIDE] = block.T if rows_of_i else block
    right = rng.normal(size=(n, SIDE))
    wanted = np.linalg.solve(dense, right.ravel()).reshape(n, SIDE)
    for rows in (range(6, n), range(6)):
        chosen = np.zeros(n, dtype=bool)
        chosen[factor.place[list(rows)]] = True
        assert factorise(factor, chosen)
    np.testing.assert_allclose(solved(factor, right), wanted, rtol=1e-9, atol=1e-9)


def test_a_row_that_is_paired_with_itself_is_nobodys_neighbour():
    pairs = np.array([(1, 1), (0, 1), (2, 2)], dtype=np.uint64)
    factor = order_blocks(3, pairs[:, 0], pairs[:, 1], 3)
    assert sorted(factor.place) == [0, 1, 2] and len(factor.rows) == 1
