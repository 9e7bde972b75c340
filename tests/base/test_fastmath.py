"""Fast roots and reciprocals against the exact ones."""

import numpy as np
import pytest

from ratd.base.fastmath import reciprocal, reciprocal_root, rough_reciprocal, rough_reciprocal_root

VALUES = np.concatenate([10.0 ** np.random.default_rng(0).uniform(-36, 36, 20000), np.linspace(0.5, 4.0, 20000)])


@pytest.mark.parametrize(("function", "error"), [(reciprocal_root, 5e-16), (rough_reciprocal_root, 2e-14)])
def test_reciprocal_roots(function, error):
    found = np.array([function(x) for x in VALUES])
    np.testing.assert_allclose(found * np.sqrt(VALUES), 1.0, rtol=0, atol=error)
    assert function(1.0) == 1.0


@pytest.mark.parametrize(("function", "error"), [(rough_reciprocal, 1.3e-7), (reciprocal, 2e-14)])
def test_reciprocals(function, error):
    for sign in (1.0, -1.0):
        found = np.array([function(sign * x) for x in VALUES])
        np.testing.assert_allclose(found * sign * VALUES, 1.0, rtol=0, atol=error)
