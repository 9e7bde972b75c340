"""The calibration of the literal drive: the marks of its runs, the fit, the figure."""

import numpy as np
import pandas as pd
import pytest

from ratd.aggregates.growth import grow
from ratd.base.errors import InputError
from ratd.experiments.spin_up.calibration import CALIBRATION_COLUMNS, calibrate, calibration_table
from ratd.experiments.spin_up.figures.calibration import calibration
from ratd.experiments.spin_up.run import spin_up
from ratd.pictures.style import save
from ratd.pipeline import io

RUNS = {4e16: 0.02, 1e17: 0.05, 3e17: 0.05}
"""d omega/dt -> f. Over the step it is the same for the first two."""


def made_up(exponent, prefactors=(1.0,), accelerations=(1e14, 1e15, 1e16)):
    """Runs whose marks follow a power law, with a prefactor for each grain."""
    rows = [
        dict.fromkeys(CALIBRATION_COLUMNS, 1.0)
        | {"material": "q-S", "type": "BAM2", "end_reason": "", "seed": seed, "printed_acceleration": a}
        | {"omega_first_loss": prefactor * a**exponent, "omega_mass_99": 2.0 * prefactor * a**exponent}
        for seed, prefactor in enumerate(prefactors)
        for a in accelerations
    ]
    return pd.DataFrame(rows)


@pytest.fixture(scope="module")
def runs():
    grain = grow("BAM2", 75e-9, "q-S", 0)
    return [spin_up(grain, drive="literal", angular_acceleration=a, timestep_factor=f) for a, f in RUNS.items()]


@pytest.fixture(scope="module")
def table(runs):
    return calibration_table(runs)


def test_marks_of_real_runs_lie_in_order(runs, table):
    assert list(table["angular_acceleration"]) == list(RUNS)
    assert table["printed_acceleration"].tolist() == pytest.approx([4e16, 4e16, 1.2e17])
    assert (table["omega_first_loss"] <= table["omega_mass_99"]).all()
    assert (table["omega_mass_99"] <= table["omega_mass_75"]).all()
    mass, omega = runs[0]["mass"].values / runs[0].attrs["initial_mass"], runs[0]["omega"].values
    k = list(omega).index(table["omega_mass_99"][0])
    assert mass[k] <= 0.99 < mass[k - 1]


def test_runs_with_another_step_stand_for_the_printed_one(table):
    """The same d omega/dt over the step: the onset of this grain differs by 5 % where d omega/dt differs by 2.5."""
    first, second = table[:2].to_dict("records")
    assert sorted(row["timestep_factor"] for row in (first, second)) == [0.02, 0.05]
    assert second["omega_mass_99"] / first["omega_mass_99"] == pytest.approx(1.0, abs=0.05)


def test_of_equally_slow_runs_that_with_the_shortest_step_is_taken_for_the_law():
    table = made_up(1 / 3, accelerations=(1e15, 1e15 * (1 - 1e-12), 4e15)).assign(timestep_factor=[0.02, 0.125, 0.125])
    table["omega_mass_99"] *= [1.0, 2.0, 1.0]
    assert float(calibrate(table, 1e5)["calibrated_by_law"]) == pytest.approx((1e5 / 2.0) ** 3)


def test_a_power_law_is_found_and_inverted():
    fit = calibrate(made_up(0.25, (1.0, 1.1, 1.1**-1)), omega_onset=2.0 * 1e13**0.25)
    assert float(fit["exponent"]) == pytest.approx(0.25)
    assert float(fit["calibrated"]) == pytest.approx(1e13)
    # ln of the grains' own answers: 0 and +- 4 ln 1.1; the exponent is exact
    error = np.log(float(fit["calibrated_high"]) / float(fit["calibrated"]))
    assert error == pytest.approx(4 * np.log(1.1) / np.sqrt(3), rel=1e-6)
    assert float(fit["calibrated_low"]) < 1e13


def test_no_answer_far_outside_the_runs():
    fit = calibrate(made_up(1 / 3), omega_onset=2e3)  # the law alone would say 1e9
    assert np.isnan(float(fit["calibrated"])) and np.isnan(float(fit["calibrated_by_law"]))
    assert float(fit["exponent"]) == pytest.approx(1 / 3)


def test_grains_that_differ_in_their_law_widen_the_answer():
    """By as much as the answers scatter between ensembles of grains."""
    rng = np.random.default_rng(1)
    found = []
    for _ in range(300):
        table = pd.concat(made_up(0.3 + 0.02 * rng.normal(), (1.0,)).assign(seed=seed) for seed in range(6))
        fit = {name: value.item() for name, value in calibrate(table, 2.0 * 1e13**0.3).items()}
        answer, error = np.log(fit["calibrated"]), np.log(fit["calibrated_high"] / fit["calibrated"])
        found.append((fit["exponent"], answer, fit["exponent_error"], error))
    found = np.array(found)
    errors = np.sqrt(np.mean(found[:, 2:] ** 2, axis=0))
    assert errors == pytest.approx(found[:, :2].std(axis=0), rel=0.15)


def test_further_runs_of_the_same_grain_tell_nothing_of_the_error():
    once = pd.concat(made_up(0.3 + 0.02 * seed, (1.0,)).assign(seed=seed) for seed in range(4))
    single, double = (calibrate(table, 6e4) for table in (once, pd.concat([once, once])))
    for name in single:
        assert float(double[name]) == pytest.approx(float(single[name]), rel=1e-9)


def test_one_grain_gives_no_error():
    fit = calibrate(made_up(1 / 3, (1.0,)), omega_onset=6e4)
    assert float(fit["calibrated"]) == pytest.approx(2.7e13)
    assert float(fit["calibrated_by_law"]) == pytest.approx(2.7e13)
    assert np.isnan([float(fit[name]) for name in ("exponent_error", "calibrated_low", "calibrated_high")]).all()


@pytest.mark.parametrize("accelerations", [(1e15,), ()])
def test_too_few_runs_give_no_answer(accelerations):
    fit = calibrate(made_up(0.3, accelerations=accelerations).reindex(columns=list(CALIBRATION_COLUMNS)), 3e8)
    assert np.isnan(float(fit["calibrated"])) and float(fit["omega_onset"]) == 3e8


def test_an_onset_that_is_none_is_refused(table):
    with pytest.raises(InputError, match="omega_onset is -1"):
        calibrate(table, -1)


def test_it_can_be_written_and_read_and_drawn(table, tmp_path):
    fit = calibrate(table, 2e9)
    dataset = table.rename_axis("entry").to_xarray().drop_vars("entry").merge(fit)
    io.write(tmp_path / "a.nc", dataset, "calibration")
    back = io.read(tmp_path / "a.nc", "calibration")
    assert float(back["calibrated"]) == float(fit["calibrated"])
    figure = calibration(table, fit)
    (axes,) = figure.axes
    markers = {factor: marker for factor, marker in zip((0.02, 0.05), "so", strict=True)}
    for factor, marker in markers.items():
        (run,) = (line for line in axes.get_lines() if line.get_marker() == marker)
        here = table[table["timestep_factor"] == factor]
        assert list(run.get_ydata()) == list(here["omega_mass_99"])
        bars = [bar for c in axes.containers if c[0] is run for bar in c[2][0].get_segments()]
        ends = here[["omega_first_loss", "omega_mass_75"]].to_numpy()
        np.testing.assert_allclose([bar[:, 1] for bar in bars], ends)
    assert "3 runs of 1 grain at 2 rates" in figure.get_suptitle()
    diamond = next(line for line in axes.get_lines() if line.get_marker() == "D")
    assert diamond.get_xdata()[0] == float(fit["calibrated"]) and diamond.get_ydata()[0] == 2e9
    with pytest.raises(InputError, match="at least one run"):
        calibration(table[:0], fit)


def test_the_last_bits_of_the_fit_do_not_show(tmp_path):
    """Processors differ in them; the fit, a straight line, joins its ends."""
    table = made_up(0.29, (1.0, 1.1))
    fit = calibrate(table, 2e5)
    pictures = set()
    for bits in range(-8, 9):
        moved = fit.assign(exponent=fit["exponent"] * (1 + bits * np.finfo(float).eps))
        figure = calibration(table, moved)
        save(figure, tmp_path / "a.png")
        pictures.add((tmp_path / "a.png").read_bytes())
    assert len(pictures) == 1
    line = next(line for line in figure.axes[0].get_lines() if line.get_label().startswith("fit"))
    (low, high), (first, last) = line.get_data()
    assert low == 1e14 and high == float(fit["calibrated"]) > 1e16 and last == pytest.approx(2e5)
    assert np.log(last / first) / np.log(high / low) == pytest.approx(0.29)
