"""Boxes: edges in time, and what is refused."""

import math

import numpy as np
import pytest

from ratd.base.errors import InputError
from ratd.geometry.box import open_space, periodic


def test_edges_follow_their_rates():
    box = periodic([1e-6, 2e-6, 3e-6], [-1e3, 0.0, 2e3])
    assert box.edges(np.array([0.0])) == (1e-6, 2e-6, 3e-6)
    assert box.edges(np.array([1e-4])) == pytest.approx((1e-6 * math.exp(-0.1), 2e-6, 3e-6 * math.exp(0.2)), rel=1e-14)
    assert box.rates() == (-1e3, 0.0, 2e3)
    assert periodic(1e-6, -5.0).rates() == (-5.0, -5.0, -5.0)
    assert open_space().edges(np.array([1.0])) == (0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((0.0,), "The length of a periodic box is 0.0; it must be a finite number above 0"),
        (([1e-6, -1e-6, 1e-6],), "The length of a periodic box"),
        (([1e-6, 1e-6],), "or three of them"),
        ((1e-6, math.nan), "The rate of a periodic box is nan; it must be a finite number, or three of them"),
    ],
)
def test_bad_boxes_are_refused(arguments, words):
    with pytest.raises(InputError, match=words):
        periodic(*arguments)
    with pytest.raises(InputError, match="scheme is 'printed'; allowed are homogeneous, as_printed"):
        periodic(1e-6, scheme="printed")
