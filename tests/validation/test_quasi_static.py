"""The checks of the quasi-static spin-up: shifts of marks, remnants that turn, and their page."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from pictures_alike import unlike
from ratd.base.errors import FileError
from ratd.validation import quasi_static_document, remnant
from ratd.validation.quasi_static import compute, shifts

ROOT = Path(__file__).parents[2]


def rows(vary, value, marks, kind="BA"):
    shared = {"vary": vary, "value": value, "material": "q-S", "type": kind, "a_eff": 1e-7}
    return [shared | {"seed": seed, "omega_mass_75": mark} for seed, mark in enumerate(marks)]


def test_shifts_are_those_of_each_grain_against_itself():
    # a grain in two groups stands twice in the table, with the same mark
    own = rows("production", 0.0, [1.0, 10.0, 100.0, np.nan]) + rows("production", 0.0, [1.0])
    table = pd.DataFrame(own + rows("drag", 0.3, [1.1, 12.0, 130.0, 5.0]))
    (found,) = shifts(table, marks=("omega_mass_75",)).to_dict("records")
    assert found["median"] == pytest.approx(1.2) and found["n"] == 3 and found["type"] == "BA"
    two = pd.DataFrame(own + rows("drag", 0.3, [1.1, 12.0]) + rows("drag", 0.1, [2.0]))
    assert shifts(two, marks=("omega_mass_75",), by=("material", "type"))["value"].tolist() == [0.1, 0.3]


def test_a_grain_is_spun_up_in_every_way():
    settings = {"material": "q-S", "type": "BA", "a_eff": 50e-9, "seed": 1, "vary": {"drag": [0.3], "moved": [1]}}
    production, drag, moved = compute(settings)
    assert (production["vary"], drag["vary"], drag["value"], moved["vary"]) == ("production", "drag", 0.3, "moved")
    for row in (drag, moved):
        assert row["omega_first_loss"] == pytest.approx(production["omega_first_loss"], rel=0.02)
        assert row["steps"] != production["steps"]
    assert production["steps_mass_75"] < production["steps"] and production["axis_ratio_first_loss"] > 1.0


def test_a_spin_up_that_never_waits_takes_more_steps_and_has_its_drag():
    settings = {"material": "q-S", "type": "BAM2", "a_eff": 75e-9, "seed": 1, "vary": {"unwaiting": [1.0]}}
    production, unwaiting = compute(settings)
    assert unwaiting["vary"] == "unwaiting" and unwaiting["steps"] > 5 * production["steps"]
    assert unwaiting["omega_first_loss"] == pytest.approx(production["omega_first_loss"], rel=0.03)


def looks(mass, tilt, turns=None, drag=1.0):
    turns = np.arange(len(mass), dtype=float) if turns is None else turns
    columns = {"mass_fraction": mass, "tilt": tilt, "turns": turns, "roundness": np.full(len(mass), 0.8)}
    table = pd.DataFrame(columns)
    return table.assign(material="q-S", type="BA", a_eff=1e-7, seed=0, drag=drag)


def test_events_have_a_peak_of_the_tilt_and_the_turns_until_it_is_over():
    table = looks([1.0, 0.6, 0.6, 0.6, 0.59, 0.3, 0.3], [0.0, 10.0, 30.0, 5.0, 1.0, 20.0, 19.0])
    first, second = remnant.events(table).to_dict("records")
    assert first["mass_fraction"] == 0.6 and first["tilt"] == 30.0 and first["turns"] == 1.0 and first["end"] == 1.0
    assert second["tilt"] == 20.0 and np.isnan(second["turns"])


def test_a_remnant_turns_its_own_axis_into_the_rotation_axis():
    settings = {
        "material": "q-S",
        "type": "BA",
        "a_eff": 100e-9,
        "seed": 1,
        "drag": [1.0],
        "every": 50,
        "mass_left": 0.3,
    }
    table = pd.DataFrame(remnant.compute(settings))
    assert table["mass_fraction"].iloc[0] == pytest.approx(1.0)
    lost = table[table["mass_fraction"] < 0.95]
    held = lost[lost["mass_fraction"] == lost["mass_fraction"].iloc[0]]
    # some turns after the loss, and not yet before the next one
    quiet = held[held["turns"] > held["turns"].iloc[0] + 4.0]
    assert len(quiet) > 3 and held["tilt"].max() > 0.02 and quiet["tilt"].min() < 0.004


def test_the_page_and_its_figures_are_those_of_the_data(tmp_path):
    quasi_static_document.redraw(ROOT, tmp_path)
    page = quasi_static_document.DOCUMENT
    assert (tmp_path / page).read_bytes() == (ROOT / page).read_bytes(), "redraw the page"
    assert sorted(path.name for path in (tmp_path / quasi_static_document.FIGURES).glob("*.png")) == [
        "numbers.png", "remnant.png",
    ]  # fmt: skip
    assert unlike(tmp_path / quasi_static_document.FIGURES, ROOT / quasi_static_document.FIGURES) == []


def test_drags_are_told_apart_without_colour_and_numbers_have_a_true_minus():
    table, looks = (
        pd.read_csv(ROOT / quasi_static_document.DATA / f"{check}.csv") for check in ("quasi_static", "remnant")
    )
    figure = quasi_static_document.turning(looks)
    for axes in figure.axes:
        assert [line.get_linestyle() for line in axes.get_lines()] == ["-", "--"]
        assert axes.get_lines()[0].get_color() == "black"
    assert [text.get_text() for text in figure.legends[0].texts] == ["drag $c$ = 1", "drag $c$ = 0.3"]
    (axes,) = quasi_static_document.strips(table).axes
    said = [text.get_text() for text in axes.get_xticklabels()]
    assert "\N{MINUS SIGN}50" in said and not any("-" in text for text in said)


def test_collect_names_the_table_that_is_missing(tmp_path):
    with pytest.raises(FileError, match="quasi_static.csv: is missing; `snakemake --cores 2"):
        quasi_static_document.collect(tmp_path, tmp_path / "data")


def test_what_the_answer_tells_of_fluffy_grains_is_what_the_table_has():
    """Means of BA grains, one by one, from the committed rows."""
    table, looks = (
        pd.read_csv(ROOT / quasi_static_document.DATA / f"{check}.csv") for check in ("quasi_static", "remnant")
    )
    found = quasi_static_document.findings(table, looks)
    table = table.assign(a_eff=(table["a_eff"] * 1e9).round())
    table = table[(table["type"] == "BA") & (table["a_eff"] == 300)]
    key = ["material", "a_eff", "seed"]
    own = table[table["vary"] == "production"].drop_duplicates(key).set_index(key)

    def logs(vary, value, mark):
        part = table[(table["vary"] == vary) & (table["value"] == value)].drop_duplicates(key).set_index(key)
        return np.log(part[mark] / own[mark]).dropna()

    pace = logs("pace", 0.005, "omega_disr")
    assert found["mean hard pace 0.005 omega_disr"].value == pytest.approx(np.exp(pace.mean()))
    assert found["torque hard"].value == pytest.approx(np.exp(logs("drive", 1.0, "omega_mass_75").median()), rel=1e-3)
    moved = logs("moved", 1.0, "omega_mass_75")
    assert 0.0 < found["moved hard"] < 1.0 and len(moved) > 5
