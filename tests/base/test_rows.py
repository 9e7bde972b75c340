"""Rows turned into columns and back, against numpy."""

import numpy as np
import pytest
from numba.core.errors import TypingError

from ratd.base.jit import jit
from ratd.base.rows import EIGHT, add_forces, call_line, gather_differences, gather_sides

STRIDE = 11
NUMBERS = [0, 1, 2, 4, 5, 6]


@jit
def gathered(rows, first, second, begin, columns, at, stride):
    gather_differences(rows, first, second, begin, columns, at, stride)
    gather_sides(rows, first, second, begin, columns, at + np.uint64(6) * stride, stride)


@jit
def added(rows, first, second, begin, columns, at, stride):
    add_forces(rows, first, second, begin, columns, at, stride)


@jit
def called(numbers, first, last):
    for at in range(first, last):
        call_line(numbers, np.uint64(at))


def test_calling_lines_changes_nothing_also_beyond_the_end():
    numbers = np.random.default_rng(2).normal(size=50)
    before = numbers.copy()
    called(numbers, 0, 10_000_000)
    np.testing.assert_array_equal(numbers, before)


def test_rows_are_gathered_as_columns():
    rng = np.random.default_rng(0)
    rows = rng.normal(size=(30, 16))
    first, second = rng.integers(0, 30, size=(2, 20)).astype(np.uint64)
    columns = np.full(3 + 12 * STRIDE, np.nan)
    gathered(rows.ravel(), first, second, np.uint64(5), columns, np.uint64(3), np.uint64(STRIDE))
    i, j = first[5 : 5 + EIGHT], second[5 : 5 + EIGHT]
    wanted = np.concatenate([(rows[i] - rows[j])[:, NUMBERS], rows[i][:, 8:11], rows[j][:, 8:11]], axis=1)
    table = columns[3:].reshape(12, STRIDE)
    np.testing.assert_array_equal(table[:, :EIGHT], wanted.T)
    assert np.isnan(table[:, EIGHT:]).all()


def test_forces_are_added_to_rows_in_their_order_also_twice():
    rng = np.random.default_rng(1)
    rows = rng.normal(size=(9, 8))
    first = np.array([4, 4, 0, 7, 4, 2, 2, 8, 1, 1], dtype=np.uint64)
    second = np.array([0, 5, 4, 4, 3, 2, 6, 6, 0, 8], dtype=np.uint64)
    columns = rng.normal(size=10 * STRIDE)
    table = columns.reshape(10, STRIDE)[1:]
    wanted = rows.copy()
    for lane in range(EIGHT):
        force, torque_i, torque_j = (table[k : k + 3, lane] for k in (0, 3, 6))
        wanted[first[1 + lane], :3] += force
        wanted[first[1 + lane], 4:7] += torque_i
        wanted[second[1 + lane], :3] -= force
        wanted[second[1 + lane], 4:7] += torque_j
    flat = rows.ravel().copy()
    added(flat, first, second, np.uint64(1), columns, np.uint64(STRIDE), np.uint64(STRIDE))
    np.testing.assert_array_equal(flat.reshape(9, 8), wanted)


def test_what_is_not_flat_is_refused():
    with pytest.raises(TypingError, match="flat contiguous arrays"):
        added(
            np.zeros((2, 8)), np.zeros(8, dtype=np.uint64), np.zeros(8, dtype=np.uint64), np.uint64(0), np.zeros(80),
            np.uint64(0), np.uint64(8),
        )  # fmt: skip
