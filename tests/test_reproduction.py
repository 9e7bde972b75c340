"""The reproduction document: printed values, bounds, rows, and the whole text from a folder of made-up data."""

import re
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import xarray as xr
import yaml
from ratd.reproduction import disrupted, figures
from ratd.reproduction.argument import printed_porosity
from ratd.reproduction.bounds import ratios, same_grains, table3_omega
from ratd.reproduction.data import COMMON_FIGURES, DRIVEN_FIGURES, FIRM_BOUNDS, GROWN, Data
from ratd.reproduction.paper import GRAINS, PRINTED
from ratd.reproduction.rate import _beside_table3, solid_parts, solid_prediction, with_literal_step
from ratd.reproduction.report import report
from ratd.reproduction.text import Answer, Row, between, number, over, row_table, with_error

from ratd.aggregates.growth import grow
from ratd.base.materials import MATERIALS
from ratd.experiments.spin_up.eq33 import TABLE_3, eq33, fit_ensemble, table3_dataset
from ratd.experiments.spin_up.figures import save
from ratd.experiments.spin_up.formula_table import FORMULAE
from ratd.experiments.spin_up.grain_table import grain_table, table_dataset
from ratd.experiments.spin_up.solid import solid_omega
from ratd.experiments.spin_up.tensile import midplane_bound
from ratd.geometry.shape import porosity, semi_axes
from ratd.pipeline import io
from ratd.pipeline.config import load
from ratd.validation import growth
from ratd.validation.data import kind_of, table_path
from ratd.validation.literal import COLUMNS as LITERAL_COLUMNS
from ratd.validation.tables import write_table
from synthetic_runs import NO_CHECKS, make_run, make_table, marked

ROOT = Path(__file__).parents[1]
SIZES = (200e-9, 300e-9, 350e-9, 500e-9)
FACTOR = {"prescribed": 0.1, "literal": 1.0}
"""omega of the made-up grains over Eq. 33 with A = 2.2, alpha = 0.14."""


def ensemble(drive, types=("BA", "BAM1", "BAM2")):
    """Table of made-up grains with all columns of the pipeline's."""
    table = make_table(types=types, sizes=SIZES, seeds=3, A=2.2 * FACTOR[drive], alpha=0.14, drive=drive)
    table["omega_first_loss"], table["omega_end"] = 0.5 * table["omega_disr"], 20 * table["omega_disr"]
    table["end_reason"] = "one contact left"
    table["n_contacts_max"] = table["n_contacts"]
    table["porosity_start"], table["porosity_disr"] = table["porosity"], table["porosity"] + 0.01
    return grain_table(grains=table, marks=table)


@pytest.fixture(scope="module", params=["both", "prescribed alone"])
def folder(request, tmp_path_factory):
    """A folder of data with one drive or two, without studies of the validation."""
    path = tmp_path_factory.mktemp("data")
    drives = ["prescribed", "literal"] if request.param == "both" else ["prescribed"]
    config = load(ROOT / "config" / "config.yaml", schemas=ROOT / "config" / "schema").config | {"drives": drives}
    config["materials_file"] = str(ROOT / "config" / "materials.yaml")
    (path / "config.yaml").write_text(yaml.safe_dump(config))
    for drive in drives:
        table = ensemble(drive)
        io.write(path / f"ensemble/{drive}/grains.nc", table_dataset(table, "grain"), "table")
        fit = table3_dataset(fit_ensemble(table, n_bootstrap=50))
        io.write(path / f"ensemble/{drive}/table3.nc", fit, "fit")
    return path


@pytest.fixture(scope="module")
def text(folder):
    return report(Data(str(folder), checks=NO_CHECKS), "reproduction")


@pytest.fixture(autouse=True)
def in_root(monkeypatch):
    monkeypatch.chdir(ROOT)


def test_literal_omega_is_predicted_from_the_consistent_one():
    table = pd.DataFrame(
        {"omega_disr": [1e8, 1e8, np.nan], "spin_share": [0.05, np.nan, 0.05], "literal_step": [2e-13, 2e-13, 2e-13]}
    )
    found = solid_prediction(table, 1e15)
    assert found[0] == solid_omega(1e8, 0.05, 1e15, 2e-13)[0] and np.isnan(found[1:]).all()
    # a threshold far below the scale of rate and step: the fourth root
    scale = (1e15 / 2e-13) ** (1 / 3)
    tiny = solid_prediction(table.assign(omega_disr=1e-4 * scale, spin_share=1e-9), 1e15)[0]
    assert tiny == pytest.approx((4 * 1e-4) ** 0.25 * scale, rel=0.1)


def test_grains_of_the_literal_drive_are_set_beside_solid_ones(folder):
    """Each type at a factor of its own from where solid grains would part."""
    data, factor = Data(str(folder), checks=NO_CHECKS), {"BA": 1.5, "BAM1": 1.25, "BAM2": 0.75}
    for name, table in data.tables.items():
        data.tables[name] = table.assign(spin_share=0.05, timestep=1e-12)
    if "literal" not in data.tables:
        assert "both drives have here" not in "\n\n".join(solid_parts(data))
        return
    law = data.plan.spin_up_of("literal")
    consistent = with_literal_step(data, law["timestep_factor"])
    solid = consistent.assign(solid=solid_prediction(consistent, law["angular_acceleration"]))
    literal = same_grains(data.tables["literal"], solid, ("", "_consistent"))
    data.tables["literal"] = literal.assign(omega_disr=literal["type"].map(factor) * literal["solid"])
    text = "\n\n".join(solid_parts(data))
    assert f"In the {len(literal)} grains that both drives have here" in text
    for kind, value in factor.items():
        assert re.search(rf"{kind} [\d–]+ nm {value:g}\b", text)


def test_drive_is_set_beside_table_3_for_every_type(folder):
    data = Data(str(folder), checks=NO_CHECKS)
    table = ratios(data.tables["prescribed"], data.plan.materials)
    printed = table3_omega(table, data.plan.materials)
    table = table.assign(omega_disr=printed / 2, found_over_printed=0.5)
    rows, sentence = _beside_table3(table, data.plan.materials)
    for kind in ("BA", "BAM1", "BAM2"):
        (line,) = [line for line in rows.splitlines() if line.startswith(f"| a-C | {kind} |")]
        sizes, level, slope, of_print = line.strip("| ").split(" | ")[2:]
        assert sizes == "200–500 nm" and level.startswith("0.5 (") and float(slope.split(" ")[0]) < 0
        assert slope.split(" ")[0].startswith(of_print[:4])
    cases = table.groupby(["material", "type"]).ngroups
    assert sentence == f"It falls less steeply with size than Table 3 in 0 of {cases} cases."
    flatter = table.assign(omega_disr=table["omega_disr"] * np.where(table["type"] == "BA", table["a_eff"] ** 0.1, 1.0))
    assert f" in {cases // 3} of {cases} " in _beside_table3(flatter, data.plan.materials)[1]


def test_every_printed_value_is_used_once_in_the_document(text):
    table = text.split("## The printed numbers")[1].split("## Figures and tables")[0]
    cells = [line.split(" | ")[:4] for line in table.splitlines() if line.startswith("| ") and "---" not in line]
    found = [tuple(cell.strip("| ") for cell in row) for row in cells if row[0] != "| where"]
    assert sorted(found) == sorted((p.place, p.what, p.text, p.rule or "–") for p in PRINTED.values())


def test_the_same_data_give_the_same_bytes(folder, text):
    assert report(Data(str(folder), checks=NO_CHECKS), "reproduction") == text and not re.search(r"\bnan\b", text)


def test_the_committed_document_says_what_its_data_give():
    captions = {
        number: (ROOT / f"workflow/report/figure{number}.rst").read_text()
        for number in (*COMMON_FIGURES, *DRIVEN_FIGURES)
    }
    assert report(Data(), "reproduction", captions) == (ROOT / "docs" / "reproduction.md").read_text()


def test_figures_give_the_same_bytes(folder, tmp_path):
    for k in range(2):
        data = Data(str(folder), checks=NO_CHECKS)
        for draw in (figures.overview, figures.bound):
            save(draw(data.grown, data.tables), tmp_path / f"{draw.__name__}_{k}.png")
    for name in ("overview", "bound"):
        assert (tmp_path / f"{name}_0.png").read_bytes() == (tmp_path / f"{name}_1.png").read_bytes()


def test_ratios_are_those_of_the_functions_for_one_grain():
    grain = grow("BAM2", 120e-9, "q-S", seed=3)
    table = grain_table([grain])
    table["cut_bound"], table["omega_disr"] = 2.0e7, 3.0e7
    row = ratios(table).iloc[0]
    material = grain.material
    printed = eq33(
        120e-9,
        material.surface_energy,
        material.density,
        20e-9,
        grain.n_contacts,
        grain.shape.filling_factor,
        *TABLE_3["q-S", "BAM2"],
    )
    assert row["printed_over_bound"] == pytest.approx(printed / 2.0e7, rel=1e-12)
    assert row["strength_over_bound"] == pytest.approx(midplane_bound(grain) / 2.0e7, rel=1e-9)
    assert row["found_over_bound"] == 1.5
    assert row["found_over_printed"] == pytest.approx(3.0e7 / printed, rel=1e-12)


def test_materials_that_the_paper_does_not_have_get_no_printed_value():
    table = make_table(materials=["q-S"], sizes=[1e-7], seeds=1).assign(material="ice")
    assert ratios(table, {"ice": MATERIALS["q-S"]})["printed_over_bound"].isna().all()


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.1234, "0.123"), (4.5e8, "4.50e8"), (1234.5, "1234"), (-2e-5, "-2.00e-5"), (np.nan, "–"), (999.6, "1000")],
)
def test_numbers_as_text(value, text):
    assert number(value) == text


def test_values_with_errors_and_ranges_as_text():
    assert with_error(1.5, 0.02) == "1.500 ± 0.020"
    assert with_error(3.25e8, 1.2e7) == "(3.25 ± 0.12)e8"
    assert with_error(-7e-5, 3.17e-3) == "-0.0001 ± 0.0032" and with_error(2e-9, 5e-8) == "(0.2 ± 5.0)e-8"
    assert with_error(0.0, 2.0) == "0.0 ± 2.0" and with_error(1.5, np.inf) == "1.5"
    assert with_error(0.95, 1e-17) == "0.95" and with_error(2e9, np.nan) == "2.00e9" and with_error(np.nan, 1) == "–"
    assert between(0.4, 5e8) == "0.4–5.00e8" and between(-0.4, -0.1) == "-0.4 to -0.1"
    assert over(3.0, 6.0) == "0.5" and over((1.0, 4.0), (2.0, 2.0)) == "0.5 / 2" and over(1.0, 0.0) == "–"


def test_rows_stand_in_the_order_of_the_paper_with_what_is_missing_named():
    def cells(rows, drives):
        lines = row_table(rows, drives).splitlines()[2:]
        return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]

    rows = [Row("decade", {"prescribed": Answer("12", "1.2", True)}, "because"), Row("onset")]
    first, second = cells(rows, ["prescribed", "literal"])
    assert first[2:] == ["3e8", "within a quarter", "no data", "–", "–", "no data", "–", "–", ""]
    assert second[3:] == ["within a factor of 2", "12", "1.2", "yes", "no data", "–", "–", "because"]
    (only,) = cells([Row("mean_radius", {"": Answer("30 nm", "1.5", False)})], [])
    assert only[2:] == ["20 nm", "within a quarter", "30 nm", "1.5", "no", ""]


def test_porosity_of_a_solid_sphere_with_eq_3_as_printed():
    moments = np.full(3, 0.4 * 4 / 3 * np.pi * 2650.0 * 1e-7**5)
    # alpha_k is proportional to the moments: a smaller prefactor acts as smaller moments
    as_printed = porosity(*semi_axes(5 / (4 * np.pi) / (15 / (8 * np.pi)) * moments, 2650.0, 1e-7), 1e-7)
    assert printed_porosity(porosity(*semi_axes(moments, 2650.0, 1e-7), 1e-7)) == pytest.approx(as_printed, rel=1e-9)
    assert as_printed == pytest.approx(-0.84, abs=0.005)


def test_studies_are_told_from_their_columns(folder):
    """Tables of another origin, with the columns that the text needs."""
    data = Data(str(folder), checks=NO_CHECKS)
    grains = pd.DataFrame({"type": ["BAM2"] * 4, "omega_disr_ratio": [1.0, 1.1, 1.12, 1.14]})
    grains["omega_mass_75_ratio"] = [1.0, 1.11, 1.11, 1.12]
    grains["viscous_time"] = [5e-12, 9e-12, 9e-12, 9e-12]
    grains[["material", "omega_disr", "omega_mass_75"]] = "a-C", 1e8, 1e8
    grains["a_eff"], grains["seed"] = 1e-7, range(4)
    grains["critical_rolling_displacement"] = 2e-10
    data.__dict__["parameters"] = {"prescribed": grains}
    names = ["consistent", *["damping"] * 3]
    marks = {"omega_disr_ratio": [1.0, 0.5, 0.6, 0.7], "omega_mass_75_ratio": [1.0, 0.8, 0.8, 0.8]}
    of = {"material": "q-S", "type": "BA", "a_eff": 1e-7, "seed": [0, 0, 1, 2]}
    data.__dict__["formulae"] = pd.DataFrame({"formula": names, **of, **marks})
    values = {"omega_onset": 3e8, "calibrated": 3.4e13, "exponent": 0.32, "exponent_error": 0.01}
    values |= {"calibrated_low": 3e13, "calibrated_high": 4e13, "calibrated_by_law": 3.6e13}
    runs = {"seed": [0, 0, 0], "printed_acceleration": [1e15, 1e15, 3e13], "timestep_factor": [0.02, 0.1, 0.1]}
    runs |= {"omega_mass_99": [9.0e8, 9.9e8, 3e8]}
    data.__dict__["calibration"] = xr.Dataset(values | {name: ("entry", column) for name, column in runs.items()})
    text = report(data, "reproduction")
    row = next(line for line in text.splitlines() if "| omega at T_vis = 9 ps over that at 5 ps" in line)
    assert "1.120 ± " in row and "| yes |" in row
    # an error that allows both the printed effect and none leaves it open
    grains["omega_disr_ratio"] = [1.0, 0.9, 1.05, 1.2]
    open_row = next(
        line
        for line in report(data, "reproduction").splitlines()
        if "| omega at T_vis = 9 ps over that at 5 ps" in line
    )
    assert "1.05 ± " in open_row and "| yes |" not in open_row and "| no |" not in open_row
    assert "**Each printed formula alone**: no damping, as in Eq. 29, moves it to 0.600 ± 0.0" in text
    assert " (100 nm) times, and the omega of the loss of a quarter of the mass to 0.8 (100 nm) times" in text
    assert "(all types together; 3 grains of q-S of 100 nm; larger ones were not tried)" in text
    assert f"| {FORMULAE['damping']} | BA | 100 nm | 0.600 ± 0.0" in text and "| 0.8 | 3 |" in text
    assert "3.40e13 rad/s² (3.00e13–4.00e13" in text and "p = 0.320 ± 0.010 over 3 runs of 1 grain" in text
    assert "it is 3.60e13 rad/s² from the slowest run of each grain" in text
    assert "in pairs of runs of the same grain: 1.1000 (f = 0.1 over f = 0.02, 1 pair)." in text
    # 1.1^(1/0.32) = 1.347 times the d omega/dt is needed
    assert "runs with f = 0.1 ask for a d omega/dt that is 26 % too low" in text


def test_grains_of_fig_9_are_set_beside_themselves_with_the_step_of_the_ensemble(folder):
    data = Data(str(folder), checks=NO_CHECKS)
    own = ensemble("literal").query("material == 'a-C' and type == 'BAM2'").assign(parameter="none")
    own["omega_disr"] *= 0.8
    own["omega_mass_75"] /= np.linspace(0.99, 1.01, len(own))
    other = own.assign(parameter="T_vis", omega_disr=1.0, omega_mass_75=1.0)
    ratios_of_fig_9 = {"viscous_time": 5e-12, "critical_rolling_displacement": 2e-10, "omega_disr_ratio": np.nan}
    data.__dict__["parameters"] = {"literal": pd.concat([own, other]).assign(**ratios_of_fig_9)}
    text = report(data, "reproduction")
    if "literal" not in data.tables:
        assert "both the ensemble and Fig. 9" not in text
        return
    words = (
        f"the {len(own)} grains that both the ensemble and Fig. 9 have: with f = 0.125 a quarter of the mass is lost"
    )
    assert words in text and "the stress is greatest at 1.25 times (1.25–1.25" in text
    line = next(line for line in text.splitlines() if "both the ensemble and Fig. 9" in line)
    assert " is lost at 1.000" in line and line.endswith("the omega with f = 0.05.")
    data.plan.config["figures"]["figure9"]["literal"]["angular_acceleration"] *= 2
    assert "both the ensemble and Fig. 9" not in report(data, "reproduction")
    data.plan.config["literal"] |= {"epsilon": 0.02, "angular_acceleration": None}
    assert "both the ensemble and Fig. 9" not in report(data, "reproduction")


def test_fit_is_set_beside_the_means_of_each_size_and_beside_separate_exponents(folder):
    """The made-up grains obey Eq. 33; with those of 350 nm half as fast again it follows the means no longer."""
    data = Data(str(folder), checks=NO_CHECKS)

    def holds(key):
        answers = next(row for row in disrupted.rows(data) if row.key == key).answers
        return {drive: own.holds for drive, own in answers.items()}, next(iter(answers.values())).text

    assert set(holds("match")[0]) == set(data.drives) and False not in holds("match")[0].values()
    assert False not in holds("exponents")[0].values()
    for drive, table in data.tables.items():
        fast = np.isclose(table["a_eff"], 350e-9)
        data.tables[drive] = table.assign(omega_disr=table["omega_disr"] * np.where(fast, 1.5, 1.0))
    verdicts, told = holds("match")
    assert set(verdicts.values()) == {False} and told.count("(350 nm)") == 3
    for drive, table in data.tables.items():
        law = table["n_monomers"] ** 0.2 * table["filling_factor"] ** 2 / table["a_eff"]
        data.tables[drive] = table.assign(omega_disr=1e2 * law)
    assert set(holds("exponents")[0].values()) == {False}


def test_what_a_drive_was_fixed_on_decides_nothing(folder):
    data = Data(str(folder), checks=NO_CHECKS)
    values = {"omega_onset": 3e8, "calibrated": 2e13, "calibrated_by_law": 2e13, "exponent": 0.3}
    values["exponent_error"] = 0.01
    runs = {"seed": [0], "printed_acceleration": [2e13], "timestep_factor": [0.02], "omega_mass_99": [3e8]}
    runs = {name: ("entry", column) for name, column in runs.items()}
    run = make_run(3e8, omega_1=3e8, steps=[(3e8, 0.5)], end=4e8)
    data.__dict__["course"] = {drive: [marked(run)] for drive in data.drives}
    for low, fixed in ((1.9e13, True), (2.01e13, False)):
        ends = {"calibrated_low": low, "calibrated_high": 2.1e13}
        data.__dict__["calibration"] = xr.Dataset(values | ends | runs)
        lines = report(data, "reproduction").splitlines()
        row = next(line for line in lines if "| mass constant up to" in line)
        assert ("(fixed on this)" in row) == (fixed and "literal" in data.tables)
        assert not fixed or "literal" not in data.tables or row.split(" | ")[9] == "–"


def test_fig_1_is_as_printed():
    assert GRAINS["BAM2", 500] == (1814, 5546, 845.2) and len(GRAINS) == 9
    assert all(contacts >= monomers - 1 for monomers, contacts, _ in GRAINS.values())


def test_means_of_the_document_are_those_of_the_table(folder, text):
    data = Data(str(folder), checks=NO_CHECKS)
    for drive, table in data.tables.items():
        found = ratios(table)["found_over_printed"].median()
        line = next(line for line in text.splitlines() if line.startswith(f"- **Drive `{drive}`"))
        assert float(line.split("omega_disr is ")[1].split(" ")[0]) == pytest.approx(found, rel=2e-3)


def test_the_answer_and_its_picture_stand_first(folder, text):
    """The answer sets both drives beside each other, and is left out where one is missing."""
    data = Data(str(folder), checks=NO_CHECKS)
    first, second, *_ = text.split("## In short\n\n")[1].split("\n\n")
    assert first.startswith("**The answer**") == (len(data.tables) == 2)
    assert "![overview](reproduction/overview.png)" in (first, second) and "overview" in data.further_figures
    if len(data.tables) == 2:
        found = ratios(data.tables["literal"])["found_over_printed"].median()
        assert float(first.split("omega_disr lies at ")[1].split(" ")[0]) == pytest.approx(found, rel=6e-3)
        table = ratios(data.tables["prescribed"])
        for size in (200, 500):
            here = table[np.isclose(table["a_eff"], size * 1e-9)]
            medians = here.groupby("type")["found_over_printed"].median()
            low, high = map(float, re.search(rf"(\S+)–(\S+) times (?:it )?at {size} nm", first).groups())
            assert (low, high) == pytest.approx((medians.min(), medians.max()), rel=6e-3)
        load = re.search(r"is (\S+)–(\S+) times lower", first).groups()
        assert [float(value) for value in load] == pytest.approx([high**-2, low**-2], rel=2e-2)


def test_figures_are_followed_by_what_is_seen_of_them(folder, text):
    """One verdict a drive for each row of the figure that has a rule, in the order of the drives."""
    data = Data(str(folder), checks=NO_CHECKS)
    part = text.split("### Fig. 7\n")[1].split("### ")[0]
    assert "are not there" in part or f"({' / '.join(data.drives)})" in part
    seen = next(line for line in part.splitlines() if line.startswith("Seen here"))
    for printed in PRINTED.values():
        there = f"{printed.what} ({printed.text}): " in seen
        assert not there or ("Fig. 7" in printed.place and printed.rule)
    (verdicts,) = re.findall(r"omega_disr, all grains \[rad/s\] \(5e8–5e9\): ([^;.]*)", seen)
    assert len(verdicts.split(" / ")) == len(data.tables)
    row = next(line for line in text.splitlines() if "| omega_disr, all grains [rad/s] |" in line)
    cells = row.strip("| ").split(" | ")[4:]
    assert [cells[3 * k + 2].replace("–", "not decided") for k in range(len(data.tables))] == verdicts.split(" / ")


def test_sections_without_data_say_so(text):
    for words in ("check against LAMMPS are not", "literal drive are not", "hold no fragments", "Fig. 4 is not"):
        assert words in text
    assert len([line for line in text.splitlines() if line.startswith("#")]) > 20


def test_tables_of_the_validation_are_part_of_the_data(folder, tmp_path):
    row = {name: 1.0 if units else "x" for name, (units, _) in LITERAL_COLUMNS.items()}
    path = table_path(tmp_path, "literal")
    write_table(path, [row], kind_of("literal"), {})
    data = Data(str(folder), checks=str(tmp_path))
    assert set(data.files) - set(Data(str(folder), checks=NO_CHECKS).files) == {path}
    assert "literal" in data.further_figures and "lammps" not in data.further_figures
    assert data.study("literal").to_dict("records") == [row] and data.study("lammps") is None


def test_a_folder_without_config_has_nothing_to_draw(tmp_path):
    data = Data(str(tmp_path), checks=NO_CHECKS)
    assert data.files == data.drives == data.figures == data.further_figures == []


def alike_table(grown, copies, migration="random"):
    """Cases of the check of growth: grains with the values of some that were grown, `copies` of each."""
    columns = ["type", "seed", "a_eff", "n_monomers", "porosity", "fractal_dimension", "axis_a", "axis_b", "axis_c"]
    rows = growth.empty_row("grains") | {"material": "q-S", "depth_correlation": 0.1}
    own = grown[columns].assign(**{name: value for name, value in rows.items() if name not in columns})
    own["migration"] = own["type"].map({"BA": "none"}).fillna(migration)
    return pd.concat([own] * copies, ignore_index=True)


def test_grains_at_rest_are_those_of_the_check_of_growth_where_these_are_more(folder, tmp_path):
    """Alike are those that migrate as the ensemble's; sizes that it does not have are left out."""
    grown = Data(str(folder), checks=NO_CHECKS).grown
    more = alike_table(grown, 4).assign(porosity=0.5)
    other = more[more["type"] == "BAM1"].assign(migration="nearest")
    larger = more[np.isclose(more["a_eff"], max(SIZES))].assign(a_eff=9e-7)
    rows = pd.concat([more, other, larger]).to_dict("records")
    write_table(table_path(tmp_path, "growth"), rows, kind_of("growth"), {})
    data = Data(str(folder), checks=str(tmp_path))
    assert len(data.alike) == len(more) + len(larger) and len(data.at_rest) == len(more)
    text = report(data, "reproduction")
    least = 4 * len(grown) // (3 * len(SIZES))
    assert f"Said of {len(more)} grains, at least {least} of each type and size," in text and "all of q-S" in text
    assert "what is said of them at rest" not in text and text.count("| 0.5 to 0.5 (single grains ") == 4
    few = pd.concat([more, other])[lambda table: ~((table["type"] == "BA") & np.isclose(table["a_eff"], SIZES[0]))]
    write_table(table_path(tmp_path, "growth"), few.to_dict("records"), kind_of("growth"), {})
    data = Data(str(folder), checks=str(tmp_path))
    assert data.at_rest is data.grown and "and what is said of them at rest, is said of all" in report(
        data, "reproduction"
    )


@pytest.mark.parametrize(("key", "value"), [("sigma_ln", 0.8), ("migration", "nearest")])
def test_grains_that_are_grown_otherwise_are_not_alike(folder, tmp_path, key, value):
    rows = alike_table(Data(str(folder), checks=NO_CHECKS).grown, 4).to_dict("records")
    write_table(table_path(tmp_path, "growth"), rows, kind_of("growth"), {})
    data = Data(str(folder), checks=str(tmp_path))
    data.plan.config["growth"][key] = value
    assert data.at_rest is data.grown
    assert (data.alike is None) == (key == "sigma_ln")


def test_what_needs_no_spin_up_is_said_of_all_grown_grains(folder, tmp_path):
    """A grain that no drive spun up counts in what is said of grains at rest, and in nothing else."""
    data = Data(str(shutil.copytree(folder, tmp_path / "data")), checks=NO_CHECKS)
    before = report(data, "reproduction")
    assert "figure2" not in data.figures and len(data.grown) == max(map(len, data.tables.values()))
    more = data.grown.drop(columns="firm_bound").assign(drive="", omega_disr=np.nan)
    more = pd.concat([more, more.assign(seed=more["seed"] + 100)], ignore_index=True)
    io.write(tmp_path / "data" / GROWN, table_dataset(more, "grain"), "table")
    data = replace(data)
    assert "figure2" in data.figures and data.figure_files(2) == {"data": [data.path(GROWN)]}
    text = report(data, "reproduction")
    assert f"{len(more)} grains were grown" in text
    known = int(ratios(more)["printed_over_bound"].notna().sum())
    assert f"of {known} grains" in text and f"of {known} grains" not in before
    changed = set(text.splitlines()) ^ set(before.splitlines())
    assert not [line for line in changed if "omega_disr, drive `" in line]


def test_firm_bounds_are_joined_to_the_grown_grains_and_told(folder, text, tmp_path):
    data = Data(str(shutil.copytree(folder, tmp_path / "data")), checks=NO_CHECKS)
    assert data.grown["firm_bound"].isna().all() and "above the firm bound" not in text
    printed = table3_omega(data.grown)
    firm = data.grown[["material", "type", "a_eff", "seed"]].assign(firm_bound=printed * 2)
    firm["seed"] = firm["seed"].astype(float)
    weak = firm.index[:5]
    firm.loc[weak, "firm_bound"] /= 4
    shuffled = firm.sample(frac=1, random_state=1).reset_index(drop=True).rename_axis("entry")
    attributes = dict.fromkeys(("settings", "config_hash", "code_hash", "inputs", "versions"), "{}")
    io.write(
        tmp_path / "data" / FIRM_BOUNDS, shuffled.to_xarray().drop_vars("entry").assign_attrs(attributes), "firm_bounds"
    )
    data = replace(data)
    np.testing.assert_array_equal(data.grown["firm_bound"], firm["firm_bound"])
    known = printed.notna().sum()
    assert f"above the firm bound for 5 of {known} grains" in report(data, "reproduction")


def test_figures_are_drawn_from_what_is_there(folder):
    data = Data(str(folder), checks=NO_CHECKS)
    assert {f"figure7_{drive}" for drive in data.drives} < set(data.figures)
    assert not [name for name in data.figures if name.startswith(("figure4", "figure10"))]


def test_fragments_are_drawn_for_each_drive_and_stage():
    table = pd.DataFrame(
        {"type": "BA", "mass_fraction": [0.1, 0.4], "weight": 1.0, "disruption": [True, False], "half": True}
    )
    drawn = figures.fragments({"prescribed": table, "literal": table})
    assert len(drawn.axes) == 4
    mass, count = (line.get_ydata()[-1] for line in drawn.axes[0].lines)
    assert (mass, count) == (1.0, 1.0)
    assert drawn.axes[2].lines[0].get_ydata().tolist() == pytest.approx([0.2, 1.0])
