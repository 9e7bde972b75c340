"""Grains spun up by both codes: classes of radius, what is driven, and what is told of the thresholds."""

from functools import partial

import numpy as np
import pandas as pd
import pytest

import ratd
from peer import needs_lammps
from ratd.base.units import NM
from ratd.engine.layout import RADIUS, X
from ratd.engine.state import monomer_rows
from ratd.experiments.relax import relax
from ratd.experiments.spin_up.cut_bound import cut_bound
from ratd.pipeline import io
from ratd.pipeline.queue import Task, key, work
from ratd.validation import lammps_spin_up as large
from ratd.validation import peer_lammps
from ratd.validation.lammps import ELASTIC_ROLLING, PARTS, TURNING, InLammps, driven, threshold
from ratd.validation.plan import Checks
from tiny_pipeline import ROOT

CONFIG = ROOT / "config" / "validation.yaml"


def test_classes_of_radius_are_narrow_and_cover_all():
    radius = np.random.default_rng(1).uniform(10e-9, 100e-9, 300)
    number, representative = peer_lammps.sort_by_radius(radius, 32)
    assert number.max() + 1 == len(representative) <= 32
    wide = (radius.max() / radius.min()) ** (1 / 32)
    ratio = radius / representative[number]
    assert ratio.max() < wide and ratio.min() > 1 / wide
    assert (np.diff(representative) > 0).all()


def test_equal_radii_are_one_class_and_none_means_one_each():
    number, representative = peer_lammps.sort_by_radius(np.full(5, 2e-8), 32)
    assert set(number) == {0} and representative == pytest.approx([2e-8])
    radius = np.array([3e-8, 1e-8, 3e-8])
    number, representative = peer_lammps.sort_by_radius(radius, None)
    assert number.tolist() == [0, 1, 2] and representative.tolist() == radius.tolist()


@needs_lammps
def test_normal_forces_do_not_depend_on_the_classes():
    """They are those of the true radii, at rest the only ones."""
    grain = ratd.grow("BAM1", 90e-9, "q-S", 2)
    rows = monomer_rows(relax(grain))
    forces = []
    for classes in (None, 4):
        with peer_lammps.Spheres(rows[:, X : X + 3], rows[:, RADIUS], grain.material, 1e-13, classes=classes) as body:
            body.place(1.0001 * rows[:, X : X + 3])
            forces.append(body.force())
    assert np.abs(forces[0]).max() > 0.0
    np.testing.assert_allclose(forces[1], forces[0], atol=1e-9 * np.abs(forces[0]).max())


@needs_lammps
def test_both_codes_drive_a_grain_from_the_first_omega_on():
    grain = ratd.grow("BA", 60e-9, "q-S", 0)
    unit = 0.8 * cut_bound(grain)
    found = large.both(grain, unit, 0.05, first=0.9)
    for number in range(2):
        own = found["code"] == number
        assert found["omega"][own][0] == pytest.approx(0.9 * unit * large.STEP)
        np.testing.assert_allclose(np.diff(np.log(found["omega"][own])), np.log(large.STEP))
    ends = [found["mass_left"][found["code"] == number][-1] for number in range(2)]
    assert max(ends) < 0.75
    low, high = np.transpose(
        [threshold(found["omega"][found["code"] == k], found["mass_left"][found["code"] == k], 0.75) for k in (0, 1)]
    )
    np.testing.assert_allclose(high / low, large.STEP)
    assert 0.7 < high[1] / high[0] < 1.4


@needs_lammps
@pytest.mark.parametrize("holds", [4, 13])
def test_a_killed_run_goes_on_after_its_last_hold(tmp_path, holds):
    """Killed during the rise, and behind it: the same bits as without."""
    grain = ratd.grow("BAM1", 60e-9, "q-S", 0)
    state, unit = relax(grain), 0.9 * cut_bound(grain)
    make = partial(InLammps, state, grain.material, turning=True, classes=4)
    whole = driven(make, unit, 1.03, 0.02, 0.7, tmp_path / "whole")
    assert not any(tmp_path.iterdir()) and len(whole) > 4

    class Killed(InLammps):
        """Dies in the unwinding after some holds."""

        left = holds * PARTS

        def unwind(self):
            Killed.left -= 1
            if Killed.left < 0:
                raise KeyboardInterrupt
            super().unwind()

    with pytest.raises(KeyboardInterrupt):
        driven(partial(Killed, *make.args, **make.keywords), unit, 1.03, 0.02, 0.7, tmp_path / "run")
    assert sorted(path.name for path in tmp_path.iterdir()) == [f"run.{holds}.restart", "run.npz"]
    for other, step in ((partial(InLammps, *make.args, turning=True, classes=5), 1.03), (make, 1.02)):
        with pytest.raises(ratd.InputError, match=r"run\.npz is of .*4 classes.*step=1.03.* does not go on with"):
            driven(other, unit, step, 0.02, 0.7, tmp_path / "run")
    # the start that was found then counts, though a later state of the code may have another
    assert driven(make, 1.001 * unit, 1.03, 0.02, 0.7, tmp_path / "run") == whole
    assert not any(tmp_path.iterdir())


@needs_lammps
def test_ratd_does_not_drive_again_what_it_had_driven_before_a_kill(tmp_path, monkeypatch):
    grain = ratd.grow("BA", 60e-9, "q-S", 0)
    how = {"unit": 0.8 * cut_bound(grain), "timestep_factor": 0.05, "first": 0.9}
    whole = large.both(grain, **how)

    def killed(*arguments):
        raise KeyboardInterrupt

    real, drive = large.InLammps.turn, large.driven_from_below
    monkeypatch.setattr(large.InLammps, "turn", killed)
    with pytest.raises(KeyboardInterrupt):
        large.both(grain, **how, checkpoint=tmp_path / "run", source="abc")
    assert [path.name for path in tmp_path.iterdir()] == ["run_ratd_abc.npy"]
    monkeypatch.setattr(large.InLammps, "turn", real)
    driven_codes = []

    def noted(make, *arguments):
        with make() as example:
            driven_codes.append(type(example).__name__)
        return drive(make, *arguments)

    monkeypatch.setattr(large, "driven_from_below", noted)
    again = large.both(grain, **how, checkpoint=tmp_path / "run", source="abc")
    assert driven_codes == ["InLammps"] and not any(tmp_path.iterdir())
    for name, values in whole.items():
        np.testing.assert_array_equal(again[name], values)


def test_a_grain_that_breaks_at_the_first_omega_is_driven_from_a_lower_one():
    grain = ratd.grow("BA", 60e-9, "q-S", 0)
    state = relax(grain)
    # a cut of the grain cannot hold at 1.8 times this
    unit = 2.0 * cut_bound(grain)
    held = large.driven_from_below(lambda: large.InRatd(state, 0.125), unit, 0.9)
    assert held[0, 3] == 1.0 and held[0, 0] < 0.9 * unit
    low, high = threshold(held[:, 0], held[:, 3], 0.75)
    assert high == pytest.approx(low * large.STEP)


def rows_of_check(cut, omega, break_at, code):
    return [
        {
            "study": "rotation", "path": "driven", "code": code, "material": "q-S", "type": "BA", "a_eff": 6e-8,
            "seed": 0.0, "cut_bound": cut, "omega": value, "mass_left": 1.0 if value < break_at else 0.5,
        }
        for value in omega
    ]  # fmt: skip


@pytest.fixture(scope="module")
def queued(tmp_path_factory):
    """A grain of the queue without LAMMPS, from its file."""
    folder = tmp_path_factory.mktemp("large")
    plan = Checks(CONFIG)
    (first, *_) = large.tasks(plan, folder)
    task = Task(first.table, key(60 * NM, 0), lambda: large.spun("q-S", "BA", 60, 0, 0.05, False, "abc"))
    assert work([task], say=lambda text: None) == 0
    return folder, io.read(first.table.path, large.KIND)


def test_a_grain_that_is_not_driven_has_the_marks_of_production(queued):
    _, file = queued
    run = ratd.disruption(ratd.spin_up(ratd.grow("BA", 60 * NM, "q-S", 0)))
    for name in large._OMEGA.values():
        np.testing.assert_array_equal(file[name].values, [run[name].item()])
    assert file["row_size_hold"].values.tolist() == [0]


def test_thresholds_of_the_check_stand_beside_production(queued):
    folder, file = queued
    cut = file["cut_bound"].values[0]
    omega = cut * 0.4 * 1.04 ** np.arange(30)
    edge = omega[20]
    rows = rows_of_check(cut, omega, edge, "ratd") + rows_of_check(cut, omega, omega[18], TURNING)
    other = [row | {"study": ELASTIC_ROLLING, "mass_left": 0.1} for row in rows]
    table = large.thresholds(folder, pd.DataFrame(rows + other))
    assert table["types"].tolist() == ["own", "own"]
    np.testing.assert_allclose(table["ratd"], np.sqrt(omega[19] * omega[20]))
    np.testing.assert_allclose(table["LAMMPS"], np.sqrt(omega[17] * omega[18]))
    assert table["waits"].tolist() == [file[name].values[0] for name in large._OMEGA.values()]


def test_a_check_of_other_grains_is_refused(queued):
    folder, file = queued
    rows = rows_of_check(1.1 * file["cut_bound"].values[0], [1e7, 2e7], 1.5e7, "ratd")
    with pytest.raises(ratd.InputError, match="another grain q-S BA 60 nm seed 0: its cut bound differs"):
        large.thresholds(folder, pd.DataFrame(rows))


def test_findings_are_medians_by_type_and_size():
    rows = [
        {
            "material": "q-S", "type": kind, "a_eff": size * NM, "seed": seed, "n_monomers": size, "mark": mark,
            "types": types, "waits": 1e7, "ratd": 1.1e7, "LAMMPS": 1e7 * ratio,
        }
        for kind, size, ratio, types in (
            ("BA", 100, 0.9, "own"), ("BA", 200, 1.0, "own"),
            ("BA", 200, 1.2, "classes"), ("BAM1", 300, 0.8, "classes"),
        )
        for seed in range(3)
        for mark in large.MARKS
    ]  # fmt: skip
    found = large.findings(pd.DataFrame(rows))
    assert found["lammps_spin_up.grains"] == 9 and found["lammps_spin_up.most monomers"] == 300
    assert found["lammps_spin_up.200 nm first"] == pytest.approx((1.0, 0.0))
    assert found["lammps_spin_up.BA quarter"].value == pytest.approx(0.95)
    assert found["lammps_spin_up.300 nm first driven"].value == pytest.approx(0.8 / 1.1)
    assert found["lammps_spin_up.all first waits"].value == pytest.approx(1.1)
    assert found["lammps_spin_up.twice first"] == ", ".join(3 * ["BA 1.00 and 1.20"])
    assert found["lammps_spin_up.BA first grains"] == 6


def test_the_queue_has_the_grains_of_the_check_and_the_large_ones(tmp_path):
    plan = Checks(CONFIG)
    wanted = large.tasks(plan, tmp_path)
    of_check = sum(grains["seeds"] for grains in plan.config["full"]["lammps"]["grains"])
    assert len(wanted) == of_check + len(large.LARGE)
    assert len({(task.table.path, task.key) for task in wanted}) == len(wanted)
    assert sum(task.make.args[5] for task in wanted) == len(large.LARGE) + len(large.CONTROLS)
