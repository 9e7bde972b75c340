"""Grains that ratd drives from several starts, beside LAMMPS: what is driven, and what is told of it."""

import numpy as np
import pandas as pd
import pytest

import ratd
from ratd.base.errors import InputError
from ratd.base.units import NM
from ratd.engine.layout import X
from ratd.engine.state import monomer_rows
from ratd.experiments.spin_up.cut_bound import cut_bound
from ratd.pipeline import io
from ratd.pipeline.queue import Task, key, work
from ratd.validation import lammps_single as single
from ratd.validation.lammps import MARKS
from ratd.validation.lammps_spin_up import LARGE
from ratd.validation.plan import Checks
from tiny_pipeline import ROOT

CONFIG = ROOT / "config" / "validation.yaml"
DRIVE = {"timestep_factor": 0.1, "step": 1.1, "rotations": 0.03, "large": False}


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    """A small grain, from its file."""
    folder = tmp_path_factory.mktemp("single")
    (first, *_) = single.tasks(Checks(CONFIG), folder)
    task = Task(first.table, key(60 * NM, 0), lambda: single.one("q-S", "BA", 60, 0, **DRIVE, source="abc"))
    assert work([task], say=lambda text: None) == 0
    return folder, io.read(first.table.path, single.KIND)


def test_each_law_drives_the_grain_from_each_start_until_a_quarter_is_lost(file):
    _, found = file
    unit = cut_bound(ratd.grow("BA", 60 * NM, "q-S", 0))
    for number in range(len(single.LAWS)):
        for start in range(single.STARTS):
            own = (found["law"].values == number) & (found["start"].values == start)
            omega, mass = found["omega"].values[own], found["mass_left"].values[own]
            np.testing.assert_allclose(omega, 0.4 * unit * 1.1 ** np.arange(1, len(omega) + 1))
            assert mass[-1] < 0.75 <= mass[:-1].min()


def test_starts_are_moved_and_the_laws_differ():
    """Seen by what is driven, since runs may end alike from all starts."""
    seen = []

    def drive(make):
        with make() as grain:
            seen.append((grain._law, monomer_rows(grain._state)[:, X : X + 3].copy()))
        return np.zeros((1, 4))

    single.from_starts(ratd.grow("BA", 60 * NM, "q-S", 0), 0.1, drive)
    laws, position = zip(*seen, strict=True)
    assert len(seen) == len(single.LAWS) * single.STARTS
    assert list(dict.fromkeys(laws)) == list(single.LAWS.values())
    for start in range(1, single.STARTS):
        moved = np.abs(position[start] - position[0]).max()
        assert 0.2 * single.SHIFT < moved < 5.0 * single.SHIFT
        # the same for both laws
        np.testing.assert_array_equal(position[start], position[single.STARTS + start])


def in_lammps(omega):
    """What LAMMPS found for the grain of `file`, as `ratd.validation.lammps_spin_up.one_each` has it."""
    grain = {"material": "q-S", "type": "BA", "a_eff": 60 * NM, "seed": 0}
    return pd.DataFrame([grain | {"mark": mark, "LAMMPS": omega} for mark in MARKS])


def test_lammps_stands_over_the_thresholds_of_all_starts(file):
    folder, found = file
    table = single.beside(folder, in_lammps(1e8))
    assert list(table["limits"]) == [*single.LAWS] * len(MARKS)
    own = table[table["mark"] == "25 % of the mass"].set_index("limits").loc["ratd"]
    ends = [
        found["omega"].values[(found["law"].values == 0) & (found["start"].values == start)][-1]
        for start in range(single.STARTS)
    ]
    # the last omega, at which it came apart, and the one before
    middle = np.array(ends) / np.sqrt(1.1)
    ratio = 1e8 / middle
    assert [own["least"], own["median"], own["most"]] == pytest.approx([ratio.min(), np.median(ratio), ratio.max()])
    assert own["nearest"] == pytest.approx(min(ratio, key=lambda each: abs(each - 1.0)))


def test_grains_that_lammps_has_not_driven_and_empty_folders_are_one_sentence(file, tmp_path):
    folder, _ = file
    with pytest.raises(ratd.InputError, match="LAMMPS has not driven q-S BA"):
        single.beside(folder, in_lammps(1e8).assign(seed=1))
    with pytest.raises(ratd.InputError, match="holds no grains"):
        single.beside(tmp_path, in_lammps(1e8))


def test_lammps_is_reached_from_one_start_or_from_most():
    nan = (np.nan,) * 4
    # in the last one the starts lie on both sides of it, and none is near
    some = ((0.8, 0.9, 1.2, 0.9), (1.1, 1.2, 1.3, 1.1), nan, (0.98, 0.99, 1.0, 1.0), (0.7, 0.75, 1.2, 1.2))
    rows = [
        {"material": "q-S", "type": "BA", "a_eff": 1e-7, "seed": seed, "mark": mark, "limits": law}
        | dict(zip(("least", "median", "most", "nearest"), spread, strict=True))
        for seed, spread in enumerate(some)
        for mark in MARKS
        for law in single.LAWS
    ]
    table = pd.DataFrame(rows)
    found = single.findings(table)
    for slot in ("own first", "limits quarter"):
        own = {name: found[f"lammps_single.{slot} {name}"] for name in ("known", "reached", "near", "least", "most")}
        assert own == {"known": 4, "reached": 3, "near": 2, "least": 0.75, "most": 1.2}
        assert found[f"lammps_single.{slot} spread"] == pytest.approx(1.2 / 0.7)
        # one has LAMMPS above all of its starts; a start that is as LAMMPS is not below or above
        assert [found[f"lammps_single.{slot} {name}"] for name in ("below", "above")] == [0, 1]
        mean = np.exp(np.mean(np.log([0.9, 1.2, 0.99, 0.75])))
        assert found[f"lammps_single.{slot} mean"].value == pytest.approx(mean)
    assert found["lammps_single.verdict"] == "missed"
    # what is told of the limits of ratd alone does not decide
    other = table[~table["seed"].isin([1, 4]) | (table["limits"] == "ratd")]
    assert single.findings(other)["lammps_single.verdict"] == "met"


def test_the_queue_has_all_grains_but_those_that_take_hours(tmp_path):
    plan = Checks(CONFIG)
    wanted = single.tasks(plan, tmp_path)
    of_check = sum(grains["seeds"] for grains in plan.config["full"]["lammps"]["grains"])
    assert len(wanted) == of_check + len([grain for grain in LARGE if grain[2] <= single.LARGEST])
    assert sum(task.make.keywords["large"] for task in wanted) == len(wanted) - of_check


@pytest.mark.parametrize("name", ["STEP", "ROTATIONS", "FIRST", "STARTS", "SHIFT"])
def test_rows_made_in_other_steps_are_refused(file, name, monkeypatch):
    folder, _ = file
    single.tasks(Checks(CONFIG), folder)
    monkeypatch.setattr(single, name, getattr(single, name) * 2)
    with pytest.raises(InputError, match="other settings"):
        single.tasks(Checks(CONFIG), folder)
