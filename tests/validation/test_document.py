"""docs/validation.md: what it tells follows from the tables, these are today's, and it is short."""

import json

import numpy as np
import pandas as pd
import pytest

from pictures_alike import unlike
from ratd.base.errors import FileError, InputError
from ratd.base.measured import Measured
from ratd.experiments.spin_up.figures.figure10 import LOOK
from ratd.pictures.style import ONE_COLUMN
from ratd.pipeline import io
from ratd.pipeline.documents import fill
from ratd.validation import (
    damping,
    document,
    energy_step,
    figures,
    findings,
    growth,
    lammps_findings,
    pull_off,
    relaxation,
)
from ratd.validation.tables import CASE, as_dataset
from templates import slots
from tiny_pipeline import ROOT

GROWN = [
    {"material": "q-S", "type": "BAM1", "monomers": 128, "seeds": 2},
    {"material": "q-S", "type": "BAM2", "a_eff": 300e-9, "seeds": 2, "migration": "random"},
    {"material": "q-S", "type": "BAM1", "a_eff": 200e-9, "seeds": 2, "migration": "nearest"},
    {"material": "q-S", "arrivals": 20},
]


@pytest.fixture(scope="module")
def tables():
    return document.read_data(ROOT)


@pytest.fixture(scope="module")
def template():
    return (ROOT / document.TEMPLATE).read_text(encoding="utf-8")


def test_the_page_its_figures_and_tables_are_those_of_the_data(tmp_path):
    document.redraw(ROOT, tmp_path)
    written = [path.relative_to(tmp_path) for path in tmp_path.rglob("*") if path.is_file()]
    for path in written:
        assert (ROOT / path).is_file(), f"redraw the page: {path}"
        if path.suffix != ".png":
            assert (tmp_path / path).read_bytes() == (ROOT / path).read_bytes(), f"redraw the page: {path}"
    assert unlike(tmp_path / document.FIGURES, ROOT / document.FIGURES) == [], "redraw the page"
    figures = {path for path in written if path.suffix == ".png"}
    there = {path.relative_to(ROOT) for path in (ROOT / document.FIGURES).glob("*.png")}
    text = (ROOT / document.DOCUMENT).read_text(encoding="utf-8")
    assert figures == there and all(f"(validation/{path.name})" in text for path in figures)


def test_the_page_is_short_and_its_first_lines_tell_what_is_open():
    text = (ROOT / document.DOCUMENT).read_text(encoding="utf-8")
    lines = text.splitlines()
    assert len(lines) <= 200 and text.count("![") <= 6
    answer = " ".join(lines[:11])
    assert all(word in answer for word in ("something outside this code", "largest known error", "open"))
    assert text.count("| open |") == 5 and text.count("| missed |") == 6 and "Five are open" in answer


def test_figures_are_as_wide_as_columns_and_pairs_look_as_in_the_reproduction(tables):
    for check, draw in (("damping", figures.viscous_time), ("literal", figures.late_coriolis)):
        assert draw(tables[check]).get_figwidth() == ONE_COLUMN
    axes = figures.apart(tables["pull_off"]).axes[0]
    found = {line.get_label(): line for line in axes.get_lines()}
    for start in ("damped", "undamped"):
        line = found[f"not waiting, {start}"]
        assert (line.get_marker(), line.get_color()) == (LOOK[start]["marker"], LOOK[start]["color"])
    assert found["waiting (the default)"].get_color() == "black"


def test_another_verdict_is_an_error(tables, template):
    pairs = tables["pull_off"]
    late = pairs["omega"].where(pairs["start"] != "waiting", 1.02 * pairs["omega_force"])
    changed = document.values(tables | {"pull_off": pairs.assign(omega=late)})
    assert changed["pull_off.waiting verdict"] == "missed"
    with pytest.raises(InputError, match="waiting verdict is 'missed'"):
        fill(template, changed)


def test_the_slots_of_lammps_come_from_its_function_alone(tables, template):
    """So that its data can be exchanged."""
    own = lammps_findings.of_lammps(tables["lammps"])
    assert {name for name in slots(template) if name.startswith("lammps.")} <= set(own)
    assert all(name.startswith("lammps.") for name in own)


def rotated(code, held, path="driven", study="rotation"):
    """Rows of one grain: omega -> mass that is left."""
    shared = {"study": study, "path": path, "code": code, "material": "q-S", "type": "BA", "a_eff": 1e-7, "seed": 0}
    return [
        shared | {"omega": omega, "mass_left": mass, "cut_bound": 2.0, "n_monomers": 9} for omega, mass in held.items()
    ]


def test_thresholds_lie_between_the_omega_that_were_tried():
    rows = rotated("ratd", {1.0: 1.0, 4.0: 0.9, 9.0: 0.5})
    rows += rotated(lammps_findings.TURNING, {1.0: 1.0, 4.0: 1.0, 9.0: 0.8})
    first, quarter = lammps_findings.thresholds(pd.DataFrame(rows)).to_dict("records")
    assert first["ratd"] == pytest.approx(2.0) and first["lammps"] == pytest.approx(6.0)
    assert first["ratio"] == pytest.approx(3.0) and first["way"] == "driven"
    assert quarter["ratd"] == pytest.approx(6.0) and np.isnan(quarter["ratio"])


def test_a_grain_that_is_off_leaves_the_check_open(tables):
    table = tables["lammps"]
    shifted = (table["study"] == lammps_findings.ELASTIC_ROLLING) & (table["code"] == "ratd") & (table["type"] == "BA")
    omega = table["omega"].where(~shifted, 1.3 * table["omega"])
    found = lammps_findings.of_lammps(table.assign(omega=omega))
    own = lammps_findings.of_lammps(table)
    assert own["lammps.elastic first verdict"] == "met" and found["lammps.elastic first verdict"] == "missed"
    assert found["lammps.elastic first least"] == pytest.approx(own["lammps.elastic first least"] / 1.3, rel=0.1)


def piece(folder, name, energies):
    grain = {"material": "q-S", "type": "BA", "a_eff": 1e-7, "seed": 0, "n_monomers": 3}
    rows = [
        grain | {"timestep_factor": 0.1, "time": 1.0, "error": error, "dissipated": 0.0, "contacts_made": 0}
        for error in energies
    ]
    made = dict.fromkeys(document.MADE, name)
    path = folder / f"{name}.nc"
    io.write(path, as_dataset(rows, energy_step.KIND).assign_attrs(made), energy_step.KIND)
    return path


def test_pieces_are_added_and_replaced(tmp_path):
    target = tmp_path / "all.nc"
    for folder in ("old", "new"):
        (tmp_path / folder).mkdir()
    old = [piece(tmp_path / "old", "a", [1.0, 2.0]), piece(tmp_path / "old", "b", [3.0])]
    io.write(target, document.merged(target, old, energy_step.KIND), energy_step.KIND)
    new = [piece(tmp_path / "new", "a", [5.0]), piece(tmp_path / "new", "c", [6.0, 7.0])]
    table = document.merged(target, new, energy_step.KIND)
    assert table["error"].values.tolist() == [5.0, 3.0, 6.0, 7.0] and table.sizes[CASE] == 4
    pieces = json.loads(table.attrs["pieces"])
    assert [(name, cases) for name, cases, _ in pieces] == [("a", 1), ("b", 1), ("c", 2)]
    assert pieces[0][2]["code_hash"] == "a"


def test_collect_says_what_is_missing(tmp_path):
    with pytest.raises(FileError, match="holds no piece of a check"):
        document.collect(tmp_path, tmp_path)


def again(rows, table, keys, columns, within=1e-9):
    """Assert that rows are in a table, with the same numbers."""
    both = pd.DataFrame(rows).merge(table, on=keys, suffixes=("", "_there"))
    assert len(both) == len(rows)
    for name in columns:
        np.testing.assert_allclose(both[name], both[f"{name}_there"], rtol=within, atol=within, err_msg=name)


@pytest.mark.parametrize("settings", GROWN)
def test_aggregates_of_the_data_grow_like_that_today(tables, settings):
    table = tables["growth"]
    rows = growth.compute(settings)
    table = table[table["study"] == rows[0]["study"]]
    columns = ["n_contacts", "porosity", "fractal_dimension"]
    if "a_eff" in settings:
        table = table[np.isclose(table["a_eff"], settings["a_eff"], rtol=1e-6)]
        columns.append("depth_correlation")
    if "arrivals" in settings:
        columns = ["impact", "direction_x", "place_z"]
    again(rows, table, ["type", "migration", "n_monomers", "seed"], columns)


def test_grains_of_the_data_come_to_rest_like_that_today(tables):
    table = tables["relaxation"]
    table = table[(table["viscous_time"] > 0.0) & np.isclose(table["a_eff"], 200e-9, rtol=1e-6)]
    settings = {"material": "q-S", "type": "BAM2", "a_eff": 200e-9, "seeds": 6, "timestep_factor": 0.125}
    rows = relaxation.compute(settings | {"damped": True})
    again(rows, table, ["material", "type", "seed"], ["rested", "n_contacts", "n_contacts_made"])
    # at rest to a thousandth of a pull-off force
    again(rows, table, ["material", "type", "seed"], ["moved", "inertia"], 1e-5)


def test_marks_of_the_data_are_found_today(tables):
    settings = {"material": "a-C", "type": "BAM2", "a_eff": 100e-9, "seed": 0, "epsilon": [1.0]}
    rows = damping.compute(settings | {"viscous_time_ps": [5, 9], "timestep_factor": {"explicit": [0.01]}})
    keys = ["study", "type", "seed", "epsilon", "viscous_time", "timestep_factor", "damping"]
    again(rows, tables["damping"], keys, ["omega_disr", "omega_mass_75"])


def test_pairs_that_wait_are_a_piece_of_their_own(tables):
    rows = pull_off.compute({"material": "q-S", "pairs": 1, "ratios": [2], "seed": 0})
    assert [row["start"] for row in rows] == ["waiting"] * 3
    assert all(abs(row["omega"] / row["omega_force"] - 1.0) < 0.01 for row in rows)
    table = findings.off_the_answer(pd.DataFrame(rows).assign(study="pairs"))
    assert table["off"].tolist() == pytest.approx([row["omega"] / row["omega_force"] - 1.0 for row in rows])


def test_exponents_are_those_of_the_power_law():
    grain = {"material": "q-S", "type": "BA", "a_eff": 1e-7}
    rows = [
        grain | {"seed": seed, "timestep_factor": f, "error": sign * (1 + seed) * f**2}
        for seed in (0, 1) for f in (0.01, 0.02, 0.1) for sign in (-1.0, 0.3)
    ]  # fmt: skip
    rows.append(grain | {"seed": 0, "timestep_factor": 0.4, "error": 5.0})
    rows.append(grain | {"seed": 1, "timestep_factor": 0.4, "error": 5.0})
    np.testing.assert_allclose(findings.exponents(pd.DataFrame(rows), "error", 0.1), 2.0, rtol=1e-9)


def test_a_grain_beyond_its_bound_is_noticed(tables):
    table = tables["theory"]
    assert findings.of_theory(table)["theory.verdict"] == "met"
    higher = table.assign(omega_first_loss=table["omega_first_loss"] * np.where(table["type"] == "BA", 1.02, 1.0))
    assert findings.of_theory(higher)["theory.verdict"] == "missed"
    assert findings.of_theory(table)["theory.static verdict"] == "met"
    lower = table.assign(static_limit_at_loss=table["static_limit_at_loss"] / 1.02)
    assert findings.of_theory(lower)["theory.static verdict"] == "missed"


def test_a_verdict_is_open_where_errors_do_not_decide():
    for value, error, verdict in (
        (0.995, 0.010, "met"),
        (0.995, 0.014, "open"),
        (0.94, 0.06, "open"),
        (0.9, 0.03, "missed"),
    ):
        assert findings.decided([Measured(1.0, 0.001), Measured(value, error)], 0.03) == verdict
