"""How monomers are spread: N(<r), radius of gyration."""

import itertools

import numpy as np
import pytest

from ratd.observables.structure import cumulative_number, radius_of_gyration


@pytest.mark.parametrize("edges", [(0.0, 0.0, 0.0), (1.0, 1.3, 0.9)])
@pytest.mark.parametrize("reach", [0.4, 2.1])
def test_cumulative_number_is_that_of_a_loop(edges, reach):
    """Itself and all images count; positions anywhere."""
    rng = np.random.default_rng(1)
    position = rng.uniform(-2, 3, (12, 3)) if edges[0] else rng.random((12, 3))
    distance = np.linspace(0.05, reach, 9)
    span = range(-9, 10) if edges[0] else (0,)
    shifts = np.array(list(itertools.product(span, repeat=3))) * edges
    wanted = np.zeros(len(distance))
    for x in position:
        for y in position:
            r = np.linalg.norm(x - y + shifts, axis=1)
            wanted += (r[:, None] <= distance).sum(axis=0)
    found = cumulative_number(position, edges, distance)
    np.testing.assert_allclose(found, wanted / 12, rtol=1e-12)
    assert 1.0 < found[-1] and (edges[0] or found[-1] <= 12.0)


def test_radius_of_gyration():
    """Two points of masses 1 and 3, 4 apart: sqrt(1*9 + 3*1)/2; a shift changes nothing."""
    position = np.array([[0.0, 0, 0], [0, 4.0, 0]])
    mass = np.array([1.0, 3.0])
    assert radius_of_gyration(position, mass) == pytest.approx(np.sqrt(3.0), rel=1e-14)
    assert radius_of_gyration(position + 7.0, mass) == pytest.approx(np.sqrt(3.0), rel=1e-12)
    # a solid ball of many points: sqrt(3/5) R
    points = np.random.default_rng(0).normal(size=(20_000, 3))
    points *= np.random.default_rng(1).random((20_000, 1)) ** (1 / 3) / np.linalg.norm(points, axis=1)[:, None]
    assert radius_of_gyration(points, np.ones(20_000)) == pytest.approx(np.sqrt(0.6), rel=5e-3)
