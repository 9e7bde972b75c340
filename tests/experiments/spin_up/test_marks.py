"""Marks of disruption on made-up runs whose answers are known."""

import numpy as np
import pytest
import xarray as xr

from ratd.base.errors import InputError
from ratd.experiments.spin_up.marks import MARKS, VARIABLES, _half_width, before_marks, disruption, running_median
from synthetic_runs import make_run

BREAK = 1e8


def in_record(mark, name, expected):
    """Whether the event at `expected` lies in the interval before the record of the mark."""
    value, interval = float(mark[name]), float(mark[f"{name}_uncertainty"])
    return value - interval * (1 + 1e-9) <= expected <= value * (1 + 1e-9)


def test_running_median_is_the_median_of_the_window_that_fits():
    values = np.random.default_rng(0).normal(size=23)
    for window in (1, 3, 5, 9):
        half = [min(k, 22 - k, window // 2) for k in range(23)]
        expected = [np.median(values[k - h : k + h + 1]) for k, h in enumerate(half)]
        np.testing.assert_array_equal(running_median(values, window), expected)


@pytest.mark.parametrize("n", [0, 1, 2, 3])
def test_running_median_of_short_series(n):
    values = np.arange(n, dtype=float)
    np.testing.assert_array_equal(running_median(values), values)


@pytest.mark.parametrize("window", [0, -1, 4])
def test_running_median_needs_an_odd_window(window):
    with pytest.raises(InputError, match="odd"):
        running_median([1.0, 2.0], window)


@pytest.mark.parametrize(
    ("rule", "said"), [({"majority": 0}, "above 0"), ({"majority": 1.1}, "at most 1"), ({"window": 2}, "odd")]
)
def test_rules_that_are_not_allowed_are_named(rule, said):
    with pytest.raises(InputError, match=said):
        disruption(make_run(BREAK), **rule)


def test_marks_of_a_gradual_loss():
    mark = disruption(make_run(BREAK, decay=2.0))
    assert float(mark["omega_disr"]) == pytest.approx(BREAK, rel=0.005)
    assert abs(float(mark["omega_disr"]) - BREAK) <= float(mark["omega_disr_uncertainty"])
    assert in_record(mark, "omega_first_loss", BREAK)
    assert in_record(mark, "omega_mass_75", BREAK * (4 / 3) ** (1 / 2))
    assert in_record(mark, "omega_contacts_75", BREAK * (4 / 3) ** (1 / 2.4))
    assert mark.attrs["missing_marks"] == ""
    assert float(mark["omega_stress_max"]) == float(mark["omega_disr"])


def test_peak_in_the_last_record_before_an_abrupt_collapse():
    run = make_run(BREAK, steps=[(BREAK, 0.3), (2 * BREAK, 0.01)], gain=0)
    mark = disruption(run)
    last_whole = run["omega"].values[np.flatnonzero(run["mass"].values > 0.9 * run.attrs["initial_mass"])[-1]]
    assert float(mark["omega_disr"]) == last_whole
    assert float(mark["mass_fraction_disr"]) == 1


def test_the_stress_of_the_peak_is_that_of_its_record():
    run = make_run(BREAK, steps=[(BREAK, 0.3), (2 * BREAK, 0.01)], gain=0)
    whole = run["omega"].values < BREAK
    assert float(disruption(run)["stress_peak"]) == run["total_stress"].values[whole].max()


def test_the_peak_is_uncertain_by_the_farther_end_of_its_window():
    # the second record of a window of five: it begins before the first one, at rest
    assert _half_width(np.array([4.0, 5.0, 6.0, 7.0]), 1, 5) == 5.0
    assert _half_width(np.array([1.0, 2.0, 3.0, 5.0, 9.0]), 2, 5) == 6.0
    assert _half_width(np.array([1.0, 5.0, 6.0, 6.5, 7.0]), 2, 5) == 5.0


def test_other_marks_are_uncertain_by_the_interval_before_their_record():
    run = make_run(BREAK)
    mark, omega = disruption(run), run["omega"].values
    assert float(mark["omega_end_uncertainty"]) == omega[-1] - omega[-2]


@pytest.mark.parametrize("period", [2.5, 7, 20])
@pytest.mark.parametrize("phase", range(4))
def test_vibration_moves_the_mark_by_less_than_its_amplitude(period, phase):
    mark = disruption(make_run(BREAK, noise=0.1, period=period, seed=phase))
    assert float(mark["omega_disr"]) == pytest.approx(BREAK, rel=0.1)


@pytest.mark.parametrize("where", [3, 100, 180])
def test_lone_spikes_of_the_stress_do_not_count(where):
    run = make_run(BREAK)
    expected = float(disruption(run)["omega_disr"])
    run["total_stress"].values[where : where + 2] *= 50
    mark = disruption(run)
    assert float(mark["omega_disr"]) == pytest.approx(expected, abs=float(mark["omega_disr_uncertainty"]))


def test_late_peak_of_a_small_cluster_does_not_count():
    run = make_run(BREAK)
    late = (run["omega"].values > 5 * BREAK) & (run["omega"].values < 6 * BREAK)
    run["total_stress"].values[late] = 3 * run["total_stress"].values.max()
    mark = disruption(run)
    assert float(mark["omega_disr"]) == pytest.approx(BREAK, rel=0.005)
    assert 5 * BREAK < float(mark["omega_stress_max"]) < 6 * BREAK


def test_other_rules_read_the_same_run_otherwise():
    """40 % lost at half of omega, and the rest bears more stress: which counts depends on the majority."""
    run = make_run(BREAK, steps=[(0.5 * BREAK, 0.6), (BREAK, 0.2), (2 * BREAK, 0.01)])
    omega = run["omega"].values
    run["total_stress"].values[:] = np.where(omega < BREAK, (omega / BREAK) ** 2, 0.05)
    early, late = (float(disruption(run, majority=part)["omega_disr"]) for part in (0.75, 0.5))
    assert early == pytest.approx(0.5 * BREAK, rel=0.01) and late == pytest.approx(BREAK, rel=0.01)
    run["total_stress"].values[3] = 50 * run["total_stress"].values.max()
    spike = disruption(run, window=1)
    assert float(spike["omega_disr"]) == omega[3] and spike.attrs["disruption_median_window"] == 1
    assert float(disruption(run, window=9)["omega_disr"]) == pytest.approx(BREAK, rel=0.02)


def test_peak_after_a_quarter_of_the_mass_is_lost_counts():
    """As physics has it for grains of few monomers: 40 % lost, and the rest bears more stress before it breaks."""
    run = make_run(BREAK, steps=[(0.5 * BREAK, 0.6), (BREAK, 0.2), (2 * BREAK, 0.01)])
    omega = run["omega"].values
    run["total_stress"].values[:] = np.where(omega < BREAK, (omega / BREAK) ** 2, 0.05)
    mark = disruption(run)
    assert float(mark["omega_disr"]) == pytest.approx(BREAK, rel=0.01)
    assert float(mark["omega_mass_75"]) == pytest.approx(0.5 * BREAK, rel=0.01)
    assert float(mark["mass_fraction_disr"]) == pytest.approx(0.6)


def test_run_that_ends_early_says_what_it_lacks():
    mark = disruption(make_run(BREAK, end=0.8 * BREAK))
    for name in MARKS:
        assert np.isnan(mark[name]) and np.isnan(mark[f"{name}_uncertainty"])
        assert "max_steps reached" in mark[name].attrs["reason"]
        assert f"{name}: max_steps reached" in mark.attrs["missing_marks"]
    for name in ("stress_peak", "axis_a_disr", "mass_fraction_disr", "n_contacts_disr", "n_fragments_lost_disr"):
        assert np.isnan(mark[name])
    assert float(mark["omega_end"]) == pytest.approx(0.8 * BREAK, rel=0.01)


def test_decline_of_the_stress_alone_is_no_disruption():
    """A peak is not known to be one while the largest fragment is still most of the grain."""
    run = make_run(BREAK, decay=0.5, end=2 * BREAK)
    assert run["mass"].values[-1] > 0.7 * run.attrs["initial_mass"]
    mark = disruption(run)
    assert np.isnan(mark["omega_disr"])
    assert "held 70.7 % of the mass: the stress might have risen further" in mark["omega_disr"].attrs["reason"]
    assert np.isfinite(mark["omega_first_loss"])


def test_run_cut_after_half_of_the_mass_is_lost_has_the_mark_but_no_global_peak():
    mark = disruption(make_run(BREAK, end=3 * BREAK))
    assert float(mark["omega_disr"]) == pytest.approx(BREAK, rel=0.005)
    assert np.isnan(mark["omega_stress_max"])
    assert mark.attrs["missing_marks"].startswith("omega_stress_max: max_steps reached with")


def test_one_monomer_with_most_of_the_mass():
    """The largest fragment never falls below half of the mass, yet the run has ended."""
    run = make_run(BREAK, steps=[(BREAK, 0.8)], gain=0, contacts=3, n_monomers=3, end=1.5 * BREAK)
    run["n_contacts"].values[run["omega"].values >= BREAK] = 1
    run.attrs["end_reason"] = "one contact left"
    run["total_stress"].values[run["omega"].values >= BREAK] = 0
    mark = disruption(run)
    assert float(mark["omega_disr"]) == pytest.approx(BREAK, rel=0.005)
    assert np.isnan(mark["omega_mass_75"])
    assert mark["omega_mass_75"].attrs["reason"] == "one contact left before 25 % of the mass was lost"


def test_pair_that_parts_into_equal_halves():
    run = make_run(BREAK, steps=[(BREAK, 0.5)], gain=0, contacts=1, n_monomers=2, end=1.01 * BREAK)
    parted = run["omega"].values >= BREAK
    run["n_contacts"].values[:] = np.where(parted, 0, 1)
    run["total_stress"].values[parted] = 0
    mark = disruption(run)
    assert float(mark["omega_disr"]) == pytest.approx(BREAK, rel=0.005)
    assert float(mark["omega_disr"]) <= float(mark["omega_mass_75"])


def test_pair_that_still_holds_is_not_disrupted():
    run = make_run(BREAK, contacts=1, n_monomers=2, gain=0, end=0.9 * BREAK)
    assert np.isnan(disruption(run)["omega_disr"])


def test_exactly_a_quarter_counts():
    run = make_run(BREAK, steps=[(BREAK, 0.75), (1.5 * BREAK, 0.25)], gain=0)
    run["mass"].values[:] *= 1 + 1e-13
    mark = disruption(run)
    assert in_record(mark, "omega_mass_75", BREAK)


def test_exactly_three_quarters_of_the_contacts_count():
    run = make_run(BREAK, steps=[(BREAK, 0.9), (2 * BREAK, 0.1)], gain=0, contacts=4, n_monomers=3)
    omega = run["omega"].values
    run["n_contacts"].values[:] = np.where(omega < BREAK, 4, np.where(omega < 2 * BREAK, 3, 1))
    assert float(disruption(run)["omega_contacts_75"]) == omega[omega >= BREAK][0]


def test_exactly_half_of_the_mass_is_still_the_grain():
    run = make_run(BREAK, steps=[(BREAK, 0.5), (2 * BREAK, 0.1)], gain=0)
    omega = run["omega"].values
    run["total_stress"].values[:] = np.where(omega < 2 * BREAK, (omega / BREAK) ** 2, 0.05)
    assert float(disruption(run)["omega_disr"]) == pytest.approx(2 * BREAK, rel=0.01)


def test_rounding_is_no_loss():
    run = make_run(BREAK)
    run["mass"].values[:50] *= 1 - 1e-13
    assert in_record(disruption(run), "omega_first_loss", BREAK)


def test_contacts_count_from_their_start_and_not_from_their_peak():
    run = make_run(BREAK, gain=0.4)
    start = run.attrs["initial_n_contacts"]
    mark = disruption(run)
    k = int(np.flatnonzero(run["omega"].values == float(mark["omega_contacts_75"]))[0])
    assert run["n_contacts"].values[k] <= 0.75 * start < run["n_contacts"].values[k - 1]
    assert float(mark["n_contacts_max"]) == pytest.approx(1.4 * start, rel=0.01)
    assert float(mark["omega_contacts_max"]) == pytest.approx(0.7 * BREAK, rel=0.02)


def test_of_equal_numbers_of_contacts_the_first_is_their_maximum():
    run = make_run(BREAK, gain=0)
    assert float(disruption(run)["omega_contacts_max"]) == run["omega"].values[0]


def test_shape_and_fragments_are_those_of_the_record_of_the_mark():
    run = make_run(BREAK, steps=[(0.6 * BREAK, 0.9), (BREAK, 0.3), (2 * BREAK, 0.01)])
    mark = disruption(run)
    k = int(np.flatnonzero(run["omega"].values == float(mark["omega_disr"]))[0])
    for axis in ("axis_a", "axis_b", "axis_c", "porosity"):
        assert float(mark[f"{axis}_disr"]) == run[axis].values[k]
        assert float(mark[f"{axis}_start"]) == run.attrs[f"initial_{axis}"]
    assert float(mark["n_fragments_lost_disr"]) == run["n_fragments_lost"].values[k] == 5
    assert float(mark["n_contacts_disr"]) == run["n_contacts"].values[k]
    assert float(mark["mass_fraction_disr"]) == pytest.approx(0.9)


def test_what_a_grain_was_before_a_mark_is_that_of_the_record_before():
    run = xr.Dataset(
        {
            "omega": ("record", [1.0, 2.0, 3.0, 4.0]),
            "angular_momentum": ("record", [10.0, 20.0, 30.0, 40.0]),
            "axis_a": ("record", [1.0, 2.0, 1.0, 1.0]),
            "axis_c": ("record", [3.0, 5.0, 9.0, 9.0]),
            "steps_so_far": ("record", [5, 6, 7, 8]),
        }
    )
    found = before_marks(run, xr.Dataset({"omega_first_loss": 3.0, "omega_mass_75": np.nan}))
    names = ("angular_momentum", "axis_ratio", "steps")
    assert [found[f"{name}_first_loss"] for name in names] == [20.0, 2.5, 6.0]
    assert np.isnan([found[f"{name}_mass_75"] for name in names]).all()


def test_undefined_axes_are_allowed():
    run = make_run(BREAK)
    run["axis_a"].values[:] = np.nan
    mark = disruption(run)
    assert np.isnan(mark["axis_a_disr"]) and np.isfinite(mark["omega_disr"])


def test_first_record_already_in_pieces():
    run = make_run(BREAK, steps=[(0, 0.2)], gain=0).isel(record=slice(0, 5))
    run["n_contacts"].values[-1] = 1
    mark = disruption(run)
    assert np.isnan(mark["omega_disr"]) and "record more often" in mark["omega_disr"].attrs["reason"]
    assert in_record(mark, "omega_first_loss", 0)


def test_dataset_is_self_describing_and_survives_netcdf(tmp_path):
    run = make_run(BREAK, end=0.8 * BREAK)
    mark = disruption(run)
    assert list(mark.data_vars) == list(VARIABLES)
    for name, (units, meaning) in VARIABLES.items():
        assert mark[name].attrs["units"] == units and mark[name].attrs["long_name"] == meaning
        assert mark[name].dtype == np.float64 and mark[name].dims == ()
    for name, value in run.attrs.items():
        assert mark.attrs[name] == value
    mark.to_netcdf(tmp_path / "marks.nc")
    with xr.open_dataset(tmp_path / "marks.nc") as again:
        xr.testing.assert_identical(again.load(), mark)


def test_run_is_left_alone():
    run = make_run(BREAK)
    before = run.copy(deep=True)
    disruption(run)
    xr.testing.assert_identical(run, before)


@pytest.mark.parametrize("name", ["omega", "mass", "n_contacts", "total_stress", "porosity", "n_fragments_lost"])
def test_missing_variable(name):
    with pytest.raises(InputError, match=f"'{name}'"):
        disruption(make_run(BREAK).drop_vars(name))


def test_missing_attribute():
    run = make_run(BREAK)
    del run.attrs["initial_mass"]
    with pytest.raises(InputError, match="initial_mass"):
        disruption(run)


def test_no_records():
    with pytest.raises(InputError, match="no records"):
        disruption(make_run(BREAK).isel(record=slice(0, 0)))


def test_stress_that_is_not_a_number():
    run = make_run(BREAK)
    run["total_stress"].values[17] = np.nan
    with pytest.raises(InputError, match="'total_stress' of the run is not finite in record 17"):
        disruption(run)


def test_initial_mass_of_zero():
    with pytest.raises(InputError, match="initial_mass.*above zero"):
        disruption(make_run(BREAK, initial_mass=0.0))
