"""Roots and reciprocals for the hot loop, from single precision and Newton's rule.

In single precision a division or a root takes a quarter of its time; one step of Newton's rule, or of the next order,
which are multiplications, brings back what accuracy is needed. The errors that are given hold on a processor. On a GPU
a division in single precision may be off by 2 units in the last place, by its documentation, and what follows from it
by up to eight times what is given.
"""

import math

import numpy as np

from ratd.base.jit import jit

_ONE = np.float32(1.0)


@jit(forceinline=True)
def reciprocal_root(x):
    """1/sqrt(x) with a relative error below 3e-16, for x between 1e-37 and 1e37; exactly 1 for x = 1."""
    y = np.float64(_ONE / math.sqrt(np.float32(x)))
    e = 1.0 - (x * y) * y
    return y + (y * e) * (0.5 + 0.375 * e)


@jit(forceinline=True)
def rough_reciprocal_root(x):
    """1/sqrt(x) with a relative error below 2e-14, for x between 1e-37 and 1e37; exactly 1 for x = 1."""
    y = np.float64(_ONE / math.sqrt(np.float32(x)))
    return y + (0.5 * y) * (1.0 - (x * y) * y)


@jit(forceinline=True)
def rough_reciprocal(x):
    """1/x with a relative error below 1.3e-7, for |x| between 1e-37 and 1e37."""
    return np.float64(_ONE / np.float32(x))


@jit(forceinline=True)
def reciprocal(x):
    """1/x with a relative error below 2e-14, for |x| between 1e-37 and 1e37."""
    y = rough_reciprocal(x)
    return y * (2.0 - x * y)
