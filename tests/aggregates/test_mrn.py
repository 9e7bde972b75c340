"""MRN samples and the lengths of their moments."""

import numpy as np
import pytest
from scipy.stats import kstest

from ratd.aggregates import mrn as module
from ratd.aggregates.mrn import (
    LARGEST,
    SMALLEST,
    free_samples,
    moment_of_length,
    mrn,
    mrn_length,
    part_above,
    sample_length,
    sample_moment,
)
from ratd.base.errors import InputError


def test_lengths_of_the_moments():
    """Umstaetter & Urbassek (2020), Eqs. 5, 6, and Eq. 8 for q = 5."""
    found = [mrn_length(q) * 1e6 for q in (1, 2, 3, 4, 5, 6, 4.5, 4.6)]
    assert found == pytest.approx([0.0831, 0.1036, 0.1560, 0.2462, 0.3536, 0.4631, 0.2989, 0.3098], abs=6e-5)
    assert mrn_length(5) == pytest.approx(np.sqrt(SMALLEST * LARGEST), rel=1e-12)
    for q in (1.5, 2.5, 4.64, 7.0):
        assert moment_of_length(mrn_length(q)) == pytest.approx(q, abs=2e-3)
    # the radius that is printed for q = 4.6 is that of 4.64
    assert moment_of_length(0.314e-6) == pytest.approx(4.64, abs=0.01)
    assert np.isnan(moment_of_length(10e-6))


def test_length_of_a_sample():
    radii = np.array([1e-7, 2e-7, 4e-7])
    assert sample_length(radii, 3.0) == pytest.approx(np.mean(radii**3) ** (1 / 3), rel=1e-12)


def test_a_free_sample_follows_the_law():
    radii = mrn(20_000, 3, mass_within=None, length_within=None)
    assert kstest(radii, lambda r: 1.0 - part_above(r)).pvalue > 0.01
    assert (np.diff(radii) <= 0.0).all() and radii[-1] >= SMALLEST and radii[0] <= LARGEST


def test_free_samples_differ():
    one, other = free_samples(50, 2)
    assert not np.array_equal(one, other)


def test_a_sample_is_near_to_the_law():
    for seed in range(3):
        radii = mrn(5000, seed)
        assert abs(np.mean(radii**3) / mrn_length(3) ** 3 - 1.0) <= 0.02
        assert abs(sample_length(radii, 5) / mrn_length(5) - 1.0) <= 0.05
    assert np.array_equal(mrn(5000, 1), mrn(5000, 1)) and not np.array_equal(mrn(5000, 1), mrn(5000, 2))


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"n": 1}, "n is 1; it must be a whole number of at least 2"),
        ({"n": 2.5}, "n is 2.5"),
        ({"seed": -1}, "seed is -1"),
        ({"smallest": 3e-6}, "smallest and largest are 3e-06 and 2.5e-06"),
        ({"largest": "2.5 um"}, "smallest and largest are 5e-08 and '2.5 um'; they must be numbers above 0, in m"),
        ({"smallest": 50, "largest": 2500}, "lengths are in m, .* multiply those in nm by 1e-09"),
        ({"mass_within": 0.0}, "mass_within is 0.0; it must be a number above 0, or None"),
        ({"length_within": "5 %"}, "length_within is '5 %'"),
        # a single one of so few would need all the mass
        ({"n": 20, "length_within": 1e-9}, "None of 500 samples of 20 radii .* is near enough to the law"),
    ],
)
def test_bad_input_is_refused_in_one_sentence(arguments, words, monkeypatch):
    monkeypatch.setattr(module, "MOST_DRAWS", 500)
    with pytest.raises(InputError, match=words) as caught:
        mrn(**{"n": 100, "seed": 1} | arguments)
    assert "\n" not in str(caught.value)


def test_the_moment_of_a_sample_is_the_inverse_of_its_lengths():
    """q of a length of its own is the q that it was made with; a length that none has gives NaN."""
    radii = mrn(5000, 1)
    for q in (0.7, 3.0, 4.6, 12.5):
        assert sample_moment(sample_length(radii, q), radii) == pytest.approx(q, rel=1e-3)
    assert np.isnan(sample_moment(2.0 * radii.max(), radii))
