import numpy as np

from ratd.base.jit import jit
from ratd.base.vectors import (
    add4,
    greater4,
    load4,
    multiply4,
    next4,
    numbers4,
    root_of_sum,
    scale4,
    square4,
    store4,
    swap4,
    vector4,
)


@jit
def all_of_them(a, b, out):
    """Each operation on the vectors at a[1] and b[2], stored one after the other; the square of the first."""
    x, y = load4(a, np.uint64(1)), load4(b, np.uint64(2))
    first, second, third, fourth = numbers4(x)
    store4(out, np.uint64(0), add4(x, y))
    store4(out, np.uint64(4), multiply4(x, y))
    store4(out, np.uint64(8), scale4(3.0, x))
    store4(out, np.uint64(12), swap4(x))
    store4(out, np.uint64(16), next4(x))
    store4(out, np.uint64(20), vector4(fourth, third, second, first))
    store4(out, np.uint64(24), greater4(x, y))
    return square4(x), root_of_sum(multiply4(x, x))


def test_vectors_of_four_numbers():
    rng = np.random.default_rng(3)
    a, b, out = rng.normal(size=6), rng.normal(size=7), np.full(29, np.nan)
    square, root = all_of_them(a, b, out)
    x, y = a[1:5], b[2:6]
    wanted = [x + y, x * y, 3.0 * x, [x[1], x[0], 0.0, 0.0], x[[1, 2, 0, 3]], x[::-1], np.maximum(x, y)]
    np.testing.assert_array_equal(out[:28], np.concatenate(wanted))
    assert np.isnan(out[28]) and square == x[0] ** 2 + x[1] ** 2 + x[2] ** 2
    assert root == np.sqrt(square)
