"""Numbers with their standard errors."""

import numpy as np
import pytest

from ratd.base.measured import Measured, geometric_mean, quotient


def test_the_error_of_a_geometric_mean_is_that_of_its_cells():
    cell = np.repeat([0, 1], 3)
    found = geometric_mean(np.exp([0.9, 1.0, 1.1, 3.9, 4.0, 4.1]), cell)
    assert found.value == pytest.approx(np.exp(2.5))
    assert found.error / found.value == pytest.approx(0.1 / np.sqrt(3) / np.sqrt(2))


def test_a_quotient_has_the_relative_errors_of_both():
    assert quotient(Measured(6.0, 0.3), (2.0, 0.0)) == pytest.approx((3.0, 0.15))
    assert quotient((-6.0, 0.18), (2.0, 0.08)) == pytest.approx((-3.0, 3.0 * 0.05))
    # of nothing the error is that of the number itself
    assert quotient((0.0, 0.3), (-2.0, 0.1)) == (0.0, pytest.approx(0.15))
