"""Statistics of cells that have different numbers of values."""

import numpy as np
import pytest

from ratd.base.statistics import (
    _of_sorted,
    equal_weights,
    jackknife_error,
    mean_of,
    median_of,
    slope_error,
    slope_of,
    weighted_line,
)


def quantiles(values, probabilities, weights=None):
    """Those behind `median_of`, of values in any order."""
    values = np.asarray(values, dtype=float)
    order = np.argsort(values, kind="stable")
    weights = np.ones(len(values)) if weights is None else np.asarray(weights, dtype=float)[order]
    return _of_sorted(values[order], weights, len(values), np.asarray(probabilities, dtype=float))


def test_cells_have_equal_weights():
    weights = equal_weights(["a", "b", "a", "a"])
    assert weights == pytest.approx([2 / 3, 2, 2 / 3, 2 / 3]) and weights.mean() == pytest.approx(1)
    assert (equal_weights([7, 3, 7, 3, 5, 5]) == 1.0).all()


def test_quantiles_with_equal_weights_are_those_of_numpy():
    values = np.random.default_rng(1).normal(size=37)
    at = [0.0, 0.16, 0.5, 0.84, 1.0]
    for n in (1, 2, 3, 10, 37):
        expected = np.quantile(values[:n], at)
        assert quantiles(values[:n], at) == pytest.approx(expected, abs=1e-14)
        assert quantiles(values[:n], at, np.full(n, 0.3)) == pytest.approx(expected, abs=1e-14)


def test_a_weight_stands_for_as_many_values():
    values, counts = np.array([3.0, 1.0, 2.0, 7.0]), np.array([2, 1, 4, 1])
    many = np.repeat(values, counts)
    for at in (0.0, 0.1, 0.3, 0.5, 0.9, 1.0):
        # eight values that are weighted alike, of which four stand for the other four
        weighted = quantiles(np.concatenate([values, values]), at, np.concatenate([counts, 0 * counts]))
        assert weighted == pytest.approx(np.quantile(many, at))
    assert quantiles([1.0, 2.0, 3.0], [0.1, 0.5], [1.0, 1e9, 1.0]) == pytest.approx(2.0)


def test_statistics_do_not_hang_on_how_many_values_a_cell_has():
    """Two cells about 1 and 3, of which the first has 20 times as many."""
    rng = np.random.default_rng(2)
    values = np.concatenate([rng.normal(1, 0.1, 2000), rng.normal(3, 0.1, 100)])
    cell = np.repeat([0, 1], [2000, 100])
    mean, error = mean_of(values, cell)
    assert abs(mean - 2) < 0.02 and error == pytest.approx(0.5 * np.hypot(0.1 / 2000**0.5, 0.1 / 10), rel=0.2)
    found = median_of(values, cell=cell)
    assert found["low"] < 1.1 and found["high"] > 2.9 and found["n"] == 2100
    assert median_of(values)["high"] < 1.2


def test_values_that_are_not_known_are_left_out_of_the_weights_too():
    values, cell = [1.0, np.nan, 1.0, 4.0, 4.0], [0, 0, 0, 1, 1]
    assert mean_of(values, cell)[0] == pytest.approx(2.5)
    assert mean_of([2.0], [0]) == (2.0, pytest.approx(np.nan, nan_ok=True))
    assert np.isnan(mean_of([np.nan])).all() and median_of([np.nan], cell=[0])["n"] == 0


def test_error_of_the_mean_is_that_of_the_textbook():
    values = np.random.default_rng(3).normal(size=50)
    mean, error = mean_of(values)
    assert mean == pytest.approx(values.mean()) and error == pytest.approx(values.std(ddof=1) / np.sqrt(50))


@pytest.mark.parametrize("counts", [[30, 5, 15], [8, 4, 1, 1]])
def test_error_of_the_mean_is_the_scatter_between_ensembles_of_the_same_cells(counts):
    """However much the cells differ, and where some have a single value."""
    cell = np.repeat(np.arange(len(counts)), counts)
    made = 100.0 * cell + np.random.default_rng(4).normal(size=(4000, len(cell)))
    found = np.array([mean_of(row, cell) for row in made])
    assert np.sqrt(np.mean(found[:, 1] ** 2)) == pytest.approx(found[:, 0].std(), rel=0.1)
    assert np.isnan(mean_of([1.0, 2.0, 3.0], [0, 1, 2])[1])


def test_error_by_leaving_out_is_that_of_the_mean_for_a_mean():
    values = np.random.default_rng(8).normal(size=9)
    left_out = [np.delete(values, k).mean() for k in range(9)]
    assert jackknife_error(left_out) == pytest.approx(mean_of(values)[1])
    assert np.isnan(jackknife_error([1.0])) and np.isnan(jackknife_error([1.0, np.nan, 2.0]))


def slope_by_matrix(x, y, group, weights):
    """The same slope from the normal equations with a column for each level."""
    design = np.column_stack([x, *(group == name for name in np.unique(group))]).astype(float)
    root = np.sqrt(weights)
    return np.linalg.lstsq(design * root[:, None], y * root, rcond=None)[0][0]


def test_influence_is_what_the_slope_loses_without_the_point():
    rng = np.random.default_rng(5)
    x, y, weights = rng.normal(size=12), rng.normal(size=12), rng.uniform(0.5, 2, 12)
    group = np.array([0, 0, 0, 0, 1, 1, 1, 1, 1, 2, 2, 2])
    slope, influence = slope_of(x, y, group, weights)
    assert slope == pytest.approx(slope_by_matrix(x, y, group, weights), rel=1e-12)
    for k in range(12):
        others = np.arange(12) != k
        without = slope_by_matrix(x[others], y[others], group[others], weights[others])
        assert influence[k] == pytest.approx(slope - without, rel=1e-9)


def test_the_only_point_of_a_group_tells_nothing_of_the_slope():
    x, y = np.array([0.0, 1.0, 2.0, 3.0, 5.0]), np.array([0.0, 1.1, 1.9, 3.0, 99.0])
    slope, influence = slope_of(x, y, [0, 0, 0, 0, 1])
    alone, expected = slope_of(x[:4], y[:4])
    assert slope == alone and influence[4] == 0 and (influence[:4] == expected).all()
    assert np.isnan(slope_error(slope_of([0.0, 1.0], [0.0, 1.0])[1]))
    slope, influence = slope_of([1.0, 1.0], [0.0, 1.0])
    assert np.isnan(slope) and np.isnan(slope_error(influence))


@pytest.mark.parametrize("counts", [[8] * 6, [8, 8, 8, 2, 1, 1], [1] * 6])
def test_error_of_a_slope_is_the_scatter_between_ensembles(counts):
    """Also where sizes have one grain each, and with weights that make up for it."""
    rng = np.random.default_rng(6)
    x = np.repeat(np.log(np.arange(1, 7)), counts)
    weights = equal_weights(x)
    found = []
    for _ in range(1500):
        slope, influence = slope_of(x, 0.3 * rng.normal(size=len(x)), weights=weights)
        found.append((slope, slope_error(influence)))
    scatter, error = np.std([s for s, _ in found]), np.sqrt(np.mean([e**2 for _, e in found]))
    assert 0.9 < error / scatter < 1.5  # HC3 errs to the safe side with few points


def test_the_error_of_a_slope_needs_three_points_that_tell_of_it():
    assert np.isnan(slope_error(np.array([0.1, 0.2, 0.0])))
    assert slope_error(np.array([0.1, 0.2, 0.2])) == pytest.approx(0.3)


def test_the_sixteenth_and_the_eighty_fourth_part_are_told():
    found = median_of(np.arange(101.0))
    assert (found["low"], found["median"], found["high"]) == pytest.approx((16.0, 50.0, 84.0))


def test_the_error_of_the_median_needs_three_groups():
    assert np.isnan(median_of([1.0, 2.0, 3.0, 4.0], group=[0, 0, 1, 1])["error"])
    assert np.isfinite(median_of([1.0, 2.0, 3.0, 4.0], group=[0, 0, 1, 2])["error"])


@pytest.mark.parametrize("weighted", [False, True])
def test_the_error_of_the_median_is_that_of_the_medians_of_drawn_samples(weighted):
    """The slow way: each sample written out, group by group."""
    rng = np.random.default_rng(7)
    values, group, cell = rng.lognormal(size=40), rng.integers(15, size=40), np.repeat([0, 1, 2], [30, 8, 2])
    weights = equal_weights(cell) if weighted else np.ones(40)
    found = median_of(values, group, seed=3, cell=cell if weighted else None)
    names = list(dict.fromkeys(group))
    draws = np.random.Generator(np.random.PCG64(3)).integers(len(names), size=(2000, len(names)))
    medians = []
    for draw in draws:
        chosen = np.concatenate([np.flatnonzero(group == names[k]) for k in draw])
        medians.append(quantiles(values[chosen], 0.5, weights[chosen]))
    assert found["error"] == pytest.approx(np.std(medians, ddof=1), rel=1e-9)


def test_weighted_lines_go_along_the_last_axis_and_equal_x_have_no_slope():
    x = np.array([[0.0, 1.0, 3.0], [2.0, 2.0, 2.0]])
    slope, level = weighted_line(x, 5.0 - 2.0 * x, np.array([1.0, 2.0, 0.5]))
    np.testing.assert_allclose([slope[0], level[0]], [-2.0, 5.0], rtol=1e-12)
    assert np.isnan(slope[1]) and np.isnan(level[1])
    # a weight of 2 is a point that stands twice
    y = np.array([1.0, 4.0, 2.0])
    once = weighted_line(x[0], y, np.array([1.0, 2.0, 1.0]))
    np.testing.assert_allclose(once, np.polyfit([0, 1, 1, 3], [1, 4, 4, 2], 1), rtol=1e-12)
