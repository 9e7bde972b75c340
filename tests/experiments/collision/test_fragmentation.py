"""Pieces of a collision, and the velocity at which clusters begin to come apart."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from ratd.base.errors import InputError
from ratd.experiments.collision.fragmentation import bootstrap_means, crossings, fragmentation, fragmentation_velocity


def made_up(piece, radius, cluster):
    return xr.Dataset(
        {name: ("monomer", np.array(v)) for name, v in (("piece", piece), ("radius", radius), ("cluster", cluster))},
        attrs={"density": 2000.0},
    )


def test_pieces_and_the_two_numbers():
    """Pieces of 3, 1 and 2 equal spheres: Eqs. 9 and 10 by hand."""
    found = fragmentation(made_up([0, 0, 1, 2, 2, 0], [1e-6] * 6, [0, 0, 0, 1, 1, 1]))
    one = 4 / 3 * np.pi * 2000 * 1e-18
    np.testing.assert_allclose(found["piece_mass"], np.array([3, 2, 1]) * one)
    assert found["piece_members"].values.tolist() == [3, 2, 1]
    np.testing.assert_allclose(found["piece_of_a"], [2 / 3, 0, 1])
    assert float(found["N_s"]) == pytest.approx(1 - 5 / 6) and float(found["X"]) == pytest.approx(1 / 6)


def test_mass_counts_not_the_number_of_spheres():
    found = fragmentation(made_up([0, 1, 1, 1], [2e-6, 1e-6, 1e-6, 1e-6], [0, 1, 1, 1]))
    assert float(found["X"]) == pytest.approx((8 - 3) / 11) and float(found["N_s"]) == pytest.approx(0.0)
    np.testing.assert_allclose(found["piece_largest_radius"], [2e-6, 1e-6])


def test_two_pieces_of_odd_masses_are_all_there_is():
    """No rounding makes N_s negative or X exceed 1."""
    rng = np.random.default_rng(1)
    for _ in range(20):
        radius = rng.uniform(1e-7, 1e-6, 40)
        one = fragmentation(made_up(np.zeros(40, int), radius, np.zeros(40, int)))
        two = fragmentation(made_up(np.arange(40) % 2, radius, np.zeros(40, int)))
        assert (float(one["N_s"]), float(one["X"]), float(two["N_s"])) == (0.0, 1.0, 0.0)


def test_one_piece_has_no_second():
    found = fragmentation(made_up([0, 0], [1e-6, 1e-6], [0, 1]))
    assert float(found["X"]) == 1.0 and float(found["N_s"]) == 0.0


def test_what_is_no_run_is_refused():
    with pytest.raises(InputError, match="run is DataFrame without radius"):
        fragmentation(pd.DataFrame({"X": [1.0]}))


def table(velocities, mean, number=40, scatter=0.05, seed=1):
    rng = np.random.default_rng(seed)
    rows = [(v, mean(v) + scatter * rng.normal()) for v in velocities for _ in range(number)]
    return pd.DataFrame(rows, columns=["velocity", "X"])


def test_velocity_of_a_known_fall():
    """X = 1 - v/10 falls through 0.15 at 8.5; the error is that of the scatter, 0.05/sqrt(40)/slope to a factor."""
    found = fragmentation_velocity(table([2, 4, 6, 8, 10], lambda v: 1 - v / 10))
    assert found["velocity"] == pytest.approx(8.5, abs=3 * found["error"])
    expected = 10 * 0.05 / np.sqrt(40) * np.hypot(0.75, 0.25)
    assert 0.5 * expected < found["error"] < 2 * expected and found["found"] == 1.0
    assert found["low"] < found["velocity"] < found["high"]
    assert (found["below"], found["above"]) == (8, 10)


def test_the_last_fall_counts_and_none_gives_nan():
    steps = {1: 0.9, 2: 0.1, 3: 0.6, 4: 0.0}
    assert fragmentation_velocity(table(steps, steps.get, scatter=0.0))["velocity"] == pytest.approx(3.75)
    none = fragmentation_velocity(table([1, 2], lambda v: 0.9, scatter=0.0))
    assert np.isnan(none["velocity"]) and np.isnan(none["error"]) and np.isnan(none["below"]) and none["found"] == 0.0


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        (pd.DataFrame({"velocity": [1.0]}), "no column 'X'"),
        (pd.DataFrame({"velocity": [], "X": []}), "no collisions"),
        (pd.DataFrame({"velocity": [1.0], "X": ["all"]}), "'X' of the table does not hold numbers alone"),
        (None, "The table is a NoneType; it must be a pandas.DataFrame"),
    ],
)
def test_bad_tables_are_refused(rows, words):
    with pytest.raises(InputError, match=words):
        fragmentation_velocity(rows)


def test_columns_of_datasets_are_numbers():
    falls = table([1, 2], lambda v: 2.0 - v)
    odd = pd.DataFrame({"velocity": falls["velocity"], "X": [xr.DataArray(value) for value in falls["X"]]})
    assert fragmentation_velocity(odd).equals(fragmentation_velocity(falls))
    with pytest.raises(InputError, match="samples is 0; it must be a whole number of at least 1"):
        fragmentation_velocity(falls, samples=0)


def test_one_collision_a_velocity_has_no_error():
    found = fragmentation_velocity(pd.DataFrame({"velocity": [1.0, 2.0, 3.0], "X": [1.0, 0.5, 0.0]}))
    assert found["velocity"] == pytest.approx(2.7) and np.isnan(found[["error", "low", "high"]].to_numpy(float)).all()
    with pytest.raises(InputError, match="velocity of the row 1 is -3; it must be a number above 0"):
        fragmentation_velocity(pd.DataFrame({"velocity": [1.0, -3.0], "X": [1.0, 0.0]}))


def test_a_velocity_without_a_value_is_passed_over():
    table = pd.DataFrame({"velocity": [1.0, 2.0, 3.0] * 4, "X": [1.0, np.nan, 0.0] * 4})
    found = fragmentation_velocity(table)
    assert 1.0 < found["velocity"] < 3.0 and (found["below"], found["above"]) == (1.0, 3.0)


def test_the_bootstrap_has_the_standard_error_of_the_mean():
    """Of few rotations and of few samples too, whose rotations do not make the error smaller; at all velocities."""
    rng = np.random.default_rng(5)
    values = np.array([0.0, 1.0, 0.2])
    samples = pd.DataFrame({"sample": np.repeat([1, 2, 3], 40), "X": np.repeat(values, 40)})
    table = pd.concat([samples.assign(velocity=3.0), samples.assign(velocity=4.0, X=1.0 - samples["X"])])
    error = values.std(ddof=1) / np.sqrt(3)
    drawn = bootstrap_means(table, "X", [3.0, 4.0], 20_000, rng)
    assert drawn.std(axis=1) == pytest.approx([error, error], rel=0.03)
    assert drawn.mean(axis=1) == pytest.approx([values.mean(), 1.0 - values.mean()], abs=0.01)
    # a sample is drawn with all of its velocities
    np.testing.assert_allclose(drawn.sum(axis=0), 1.0)
    few = pd.DataFrame({"velocity": 3.0, "X": values})
    assert bootstrap_means(few, "X", [3.0], 20_000, rng).std() == pytest.approx(error, rel=0.03)


def test_a_velocity_that_one_sample_has_alone_counts_with_its_rotations():
    rng = np.random.default_rng(5)
    table = pd.DataFrame(
        {"velocity": [1, 1, 1, 1, 2, 2], "sample": [1, 1, 2, 2, 1, 1], "X": [0.9, 0.9, 0.9, 0.9, 0, 0.1]}
    )
    drawn = bootstrap_means(table, "X", [1, 2], 5000, rng)
    assert np.isfinite(drawn).all() and drawn[1].std() == pytest.approx(0.05, rel=0.05)
    assert fragmentation_velocity(table)["found"] == 1.0


def test_all_velocities_at_which_x_falls_through_the_limit():
    """It falls from 0.4 to 0 between 10 and 20 m/s, and from 0.2 to 0.1 between 30 and 40 m/s."""
    velocity, mean = np.array([10.0, 20.0, 30.0, 40.0]), np.array([0.4, 0.0, 0.2, 0.1])
    np.testing.assert_allclose(crossings(velocity, mean, 0.15), [16.25, 35.0])
    assert len(crossings(velocity, mean, 0.5)) == 0
