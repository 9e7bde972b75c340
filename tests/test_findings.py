"""Rows of the reproduction on made-up runs, tables and grains with known answers."""

import re
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from ratd.reproduction import course, disrupted, peak, shapes, structure, summary
from ratd.reproduction.argument import by_frame_and_type, by_size, rolling_limit
from ratd.reproduction.bounds import table3_omega
from ratd.reproduction.paper import PRINTED
from ratd.reproduction.text import Answer, Row

from ratd.experiments.spin_up.size_law import slopes
from ratd.validation.lammps import COMPARISONS, ELASTIC_ROLLING, TURNING
from synthetic_runs import make_run, make_table, marked


def holds(rows, key, drive="prescribed"):
    return next(row for row in rows if row.key == key).answers[drive].holds


@pytest.fixture
def table():
    return make_table(sizes=(100e-9, 200e-9), seeds=12)


def with_stress(*stress):
    """Run of as many records that keeps its mass until the last one, in which little is left."""
    run = make_run(1e8, steps=[(2e8, 0.1)], end=2e8).isel(record=slice(0, len(stress)))
    mass = np.full(len(stress), 4.76e-16)
    mass[-1] *= 0.1
    return run.assign(
        omega=("record", 1e6 * np.arange(1.0, len(stress) + 1)), total_stress=("record", np.array(stress, float)),
        mass=("record", mass),
    ).assign_attrs(end_reason="one contact left")  # fmt: skip


def test_rise_and_fall_of_the_stress_are_those_of_its_running_median():
    steady = with_stress(*range(1, 101), *[100] * 3, *[40] * 9)
    assert peak.greatest_fall(*marked(steady)) == 0
    # the median over 5 records holds the plateau of 3 for one record longer than it lasts
    assert peak.omega_of_half(*marked(steady)) == pytest.approx(104 / 103, rel=0.02)
    falls = with_stress(*range(1, 61), *[30] * 10, *range(61, 101), *[100] * 3, *[40] * 9)
    assert peak.greatest_fall(*marked(falls)) == pytest.approx(0.28)  # from the third last record before the fall, 58
    slow = with_stress(*range(1, 101), *range(100, 40, -1), *[1] * 6)
    assert peak.omega_of_half(*marked(slow)) == pytest.approx(1.5, rel=0.01)
    ends_early = make_run(1e8, end=0.9e8)
    assert np.isnan(peak.greatest_fall(*marked(ends_early))) and np.isnan(peak.omega_of_half(*marked(ends_early)))


def test_rows_of_the_peak(table):
    fragments = pd.DataFrame(
        {"type": "BA", "material": "q-S", "a_eff": 1e-7, "grain": np.repeat(np.arange(8), 4), "half": True}
    )
    restless = with_stress(*range(1, 61), *[30] * 10, *range(61, 101), *[40] * 9)
    steady, slow = with_stress(*range(1, 101), *[40] * 9), with_stress(*range(1, 101), *range(100, 40, -1), *[1] * 6)
    for small, quarter, runs in ((True, True, [steady] * 3), (False, False, [slow] * 3)):
        pieces = fragments.assign(mass_fraction=np.tile([0.05, 0.02, 0.04, 0.03 if small else 0.4], 8))
        found = peak.rows(
            SimpleNamespace(
                course={"prescribed": [marked(run) for run in runs]},
                tables={"prescribed": table.assign(mass_fraction_disr=0.75 if quarter else 0.9)},
                fragments={"prescribed": pieces},
            )
        )
        assert holds(found, "abrupt") is small and holds(found, "peak_mass") is quarter
        assert holds(found, "stress_drop") is small and holds(found, "stress_rise") is True
    nothing = SimpleNamespace(course={"prescribed": [marked(restless)] * 3}, tables={}, fragments={})
    assert holds(peak.rows(nothing), "stress_rise") is False


def test_largest_piece_of_a_grain_is_one_of_its_first_half(table):
    late = pd.DataFrame(
        {"type": "BA", "grain": [0, 0, 1], "half": [True, False, True], "mass_fraction": [0.1, 0.4, 0.2]}
    )
    assert peak._largest_pieces(late)["mass_fraction"].tolist() == [0.1, 0.2]


def test_gain_of_contacts_is_compared_with_the_other_type_that_gains_most(table):
    gain = table["type"].map({"BA": 1.2, "BAM1": 1.0, "BAM2": 1.1})
    scatter = 1 + 1e-3 * np.random.default_rng(0).normal(size=len(table))
    less = course._gain_most(table.assign(n_contacts_max=table["n_contacts"] * gain * scatter), None)
    assert less.text.startswith("-0.0996") and less.holds is False
    gain[table["type"] == "BAM2"] = 1.3
    assert course._gain_most(table.assign(n_contacts_max=table["n_contacts"] * gain * scatter), None).holds is True


def test_gains_of_mass_are_counted_among_its_changes():
    run = make_run(1e8, end=2e8)
    mass = np.full(run.sizes["record"], 1.0)
    mass[10:], mass[20:], mass[30:] = 0.5, 0.6, 0.1
    run = run.assign(mass=("record", mass * run.attrs["initial_mass"]))
    late, early = ({"omega_disr": run["omega"].values[k]} for k in (50, 25))
    found = course._reconnects([(run, late)] * 2, None)
    assert found.text == "0.333 (2 of 6)" and found.holds is None
    assert course._reconnects([(run, early)], None).text == "0.5 (1 of 2)" and course._reconnects([], None) is None
    mass[20:30] = 0.5
    calm = run.assign(mass=("record", mass * run.attrs["initial_mass"]))
    assert course._reconnects([(calm, late)] * 40, None).holds is True


def test_grains_that_become_oblate_are_counted_by_pairs(table):
    oblate, prolate = np.array([1.0, 1.4, 1.5]), np.array([1.0, 1.1, 1.5])
    for start, end, became in ((prolate, oblate, True), (oblate, prolate, False), (oblate, oblate, False)):
        columns = {f"axis_{axis}_{when}": shape[k] for when, shape in (("start", start), ("disr", end))
                   for k, axis in enumerate("abc")}  # fmt: skip
        own = table.assign(**columns)
        own.loc[0, "axis_a_disr"] = np.nan
        found = shapes.more_oblate(own, None)
        assert found.holds is became  # no change is none
        assert found.text.startswith(f"{became - (start is oblate and end is prolate)} (")


def test_scatter_of_the_porosity_is_that_within_the_cells(table):
    rng = np.random.default_rng(1)
    size = 0.3 * np.log(table["a_eff"] / 1e-7)  # differences of the cells are no scatter
    start = 0.5 + size + 0.01 * rng.normal(size=len(table))
    for end, more in ((0.03, True), (0.003, False)):
        own = table.assign(porosity_start=start, porosity_disr=0.5 + end * rng.normal(size=len(table)))
        assert shapes._variation(own, None).holds is more


def test_types_are_compared_in_geometric_means(table):
    factor = table["type"].map({"BA": 0.5, "BAM1": 1.0, "BAM2": 2.0})
    scatter = np.exp(0.01 * np.random.default_rng(2).normal(size=len(table)))
    own = table.assign(omega_disr=1e8 * factor * scatter)
    found = disrupted._easier(own, None)
    assert found.holds is True and "(below 1 in 6 of 6 cells)" in found.text
    assert float(found.text.split()[1]) == pytest.approx(0.5, rel=0.02)
    assert disrupted._easier(own.assign(omega_disr=1e8 / factor * scatter), None).holds is False


def test_longest_viscous_time_is_set_beside_the_shortest_of_the_same_grain():
    level = np.repeat(np.exp(np.random.default_rng(3).normal(size=8)), 2)
    times = np.tile([1e-12, 9e-12], 8)
    table = pd.DataFrame({"type": "BA", "material": "a-C", "a_eff": 1e-7, "seed": np.repeat(range(8), 2)})
    table = table.assign(viscous_time=times, omega_disr=level * (1 + 1e11 * times), omega_mass_75=level)
    found = disrupted._viscous_rise(table, None)
    assert found.holds is True and found.text.startswith("BA 1.73") and "of 100 nm" in found.text
    assert disrupted._viscous_rise(table.assign(omega_disr=level / times), None).holds is False


def equal_monomers(kind, migration, level, rng):
    """Rows of aggregates of equal monomers, whose porosity rises with their number."""
    return [
        {"study": "aggregates", "type": kind, "migration": migration, "n_monomers": n,
         "porosity": level + 0.05 * np.log(n) + rng.normal(0, 0.01)}
        for n in (32, 128, 512, 2048) for _ in range(30)
    ]  # fmt: skip


def test_porosity_is_compared_with_that_of_equal_monomers_of_the_same_number():
    rng = np.random.default_rng(4)
    growth = pd.DataFrame(
        row
        for kind in ("BAM1", "BAM2")
        for migration, level in (("random", 0.3), ("nearest", 0.9))
        for row in equal_monomers(kind, migration, level, rng)
    )
    numbers = {1e-7: 12, 2e-7: 120, 3.5e-7: 640, 5e-7: 1900, 5.5e-7: 2500}  # the first and the last are not covered
    for less in (0.1, -0.1):
        grown = pd.DataFrame(
            {"type": kind, "n_monomers": n, "porosity": 0.3 + 0.05 * np.log(n) - less + rng.normal(0, 0.01), "a_eff": a}
            for kind in ("BAM1", "BAM2")
            for a, n in numbers.items()
            for _ in range(20)
        )
        answer = structure._compact(growth, "random", grown).answers[""]
        assert answer.holds is (less > 0) and answer.text.count("(200 nm)") == answer.text.count("(500 nm)") == 2
        assert "(100 nm)" not in answer.text and "(550 nm)" not in answer.text
        assert [float(word) for word in re.findall(r"(-?0\.\d+) ±", answer.text)] == pytest.approx(
            [-less] * 4, abs=0.01
        )
    assert structure._compact(None, "random", grown).answers == {}
    assert structure._compact(growth, "random", grown[grown["a_eff"] < 2e-7]).answers == {}


def test_error_of_the_porosity_less_that_of_equal_monomers_has_both_parts():
    """Halfway between two points of the curve, each of which counts half."""
    curve = pd.DataFrame({"mean": [0.4, 0.6, 0.7], "sem": [0.03, 0.04, 9.0]}, index=[16, 64, 256])
    grains = pd.DataFrame({"n_monomers": 32, "porosity": [0.41, 0.43]})
    assert structure._less(grains, curve) == pytest.approx((-0.08, np.hypot(0.01, np.hypot(0.015, 0.02))))


def test_depth_of_small_monomers_is_compared_with_that_of_grains_that_do_not_migrate():
    rng = np.random.default_rng(5)

    def rows(kind, mean):
        return [
            {"type": kind, "a_eff": a, "depth_correlation": value}
            for a in (2e-7, 5e-7) for value in rng.normal(mean, 0.05, 50)
        ]  # fmt: skip

    for more in (0.1, -0.1):
        table = pd.DataFrame(rows("BA", 0.2) + rows("BAM1", 0.2 + more) + rows("BAM2", 0.2 + more))
        answer = structure._deeper(table).answers[""]
        assert answer.holds is (more > 0) and answer.text.count("(200 nm)") == answer.text.count("(500 nm)") == 2
    assert structure._deeper(None).answers == {}
    assert structure._deeper(table[table["type"] != "BA"]).answers == {}


def test_fractal_dimension_is_compared_with_the_shape_by_rank():
    table = make_table(sizes=(100e-9, 200e-9, 300e-9), seeds=40).assign(axis_a=1.0)
    rng = np.random.default_rng(7)
    free = table.assign(axis_c=rng.uniform(1, 2, len(table)), fractal_dimension=rng.uniform(2, 3, len(table)))
    assert structure._fractal_shape(free).answers[""].holds is True
    bound = free.assign(fractal_dimension=free["axis_c"] + table["a_eff"] * 1e9)
    assert structure._fractal_shape(bound).answers[""].holds is False
    # a correlation that is not the same at all sizes, each of which is known well
    link = np.where(np.isclose(table["a_eff"], 300e-9), 0.4, 0.0)
    mixed = pd.concat(
        [free.assign(fractal_dimension=rng.uniform(size=len(free)) + link * free["axis_c"]) for _ in range(30)]
    )
    assert structure._fractal_shape(mixed).answers[""].holds is True


def test_growth_of_the_axis_ratios_is_told_by_type(table):
    """b/a half as great again and c/b by a fifth in BAM1, nothing in BAM2; BA is left out."""
    start = {"axis_a_start": 1.0, "axis_b_start": 1.1, "axis_c_start": 1.4}
    first = np.where(table["type"] == "BAM1", 1.5, 1.0)
    second = np.where(table["type"] == "BAM1", 1.2, 1.0)
    end = {"axis_a_disr": 1.0, "axis_b_disr": 1.1 * first, "axis_c_disr": 1.4 * first * second}
    own = table.assign(**start, **end)
    told = shapes._deformation({"prescribed": own, "literal": own.assign(axis_c_disr=np.nan)})
    assert "by factors of prescribed BAM1 1.5 and 1.2, BAM2 1 and 1." in told


def test_share_of_oblate_grains_is_set_beside_that_of_200_nm():
    oblate, prolate = {"b": 2.0, "c": 2.1}, {"b": 1.1, "c": 2.0}
    table = pd.DataFrame(
        {"material": "q-S", "type": "BA", "a_eff": size, "axis_a_start": 1.0}
        | {f"axis_{name}_start": value for name, value in (oblate if k < share else prolate).items()}
        for size, share in ((200e-9, 30), (350e-9, 10)) for k in range(50)
    )  # fmt: skip
    found = re.fullmatch(r"Less that of 200 nm it is (-\S+) ± (\S+)\.", shapes._more_prolate(table, 350))
    error = np.hypot(np.sqrt(0.6 * 0.4 / 49), np.sqrt(0.2 * 0.8 / 49))
    assert [float(value) for value in found.groups()] == pytest.approx([-0.4, error], rel=0.02)
    assert shapes._more_prolate(table, 500) == ""


def test_powers_of_size_are_told_without_cells_of_few_grains():
    """Cells of 450 and 500 nm with one grain each fall steeply, the others as 1/a_eff."""
    table = make_table(sizes=(300e-9, 400e-9, 450e-9, 500e-9), seeds=6)
    few = table["a_eff"] > 420e-9
    table = table[~few | (table["seed"] == 0)]
    table = table.assign(omega_disr=np.where(table["a_eff"] > 420e-9, 0.1, 1.0) / table["a_eff"])
    data = SimpleNamespace(tables={"prescribed": table})
    powers = slopes(summary.without_thin_cells(table))
    assert powers["above"].tolist() == pytest.approx([-1.0] * 3) and (powers["sizes_above"] == 2).all()
    told = summary._with_thin_cells(data)
    assert told.startswith(" 18 of the large cells of the drive `prescribed` have fewer than 3 grains")
    steep = slopes(table).set_index("type")["above"]
    assert (steep < -3).all() and re.search(rf"the power is BA {steep['BA']:.2f} ± ", told)
    full = table[table["a_eff"] < 420e-9]
    assert summary._with_thin_cells(SimpleNamespace(tables={"literal": full})) == ""
    assert summary.without_thin_cells(full).equals(full)


def test_lammps_is_told_by_frame_and_type():
    """BA at 0.8, BAM2 at 1.1 in the inertial frame; both alike, and no BAM2 of one way, in the others."""
    rows = [
        {"start": start, "code": code, "type": kind, "a_eff": 1e-7, "seed": seed, "mark": "first loss"}
        | {"ratd": (1e8, 1e8), "LAMMPS": (ratio * 1e8,) * 2}
        for (start, code), ratios in zip(COMPARISONS, ({"BA": 0.8, "BAM2": 1.1}, {"BA": 1.0}, {"BA": 1.0}), strict=True)
        for kind, ratio in ratios.items() for seed in range(3)
    ]  # fmt: skip
    first, *others = by_frame_and_type(rows).split("; ")
    assert first.startswith("BA 0.8, BAM2 1.1 (") and all(other.startswith("BA 1 (") for other in others)
    assert len(others) == 2
    # sizes that differ by rounding are one
    sized = [row | {"a_eff": (1 + row["seed"] * 1e-15) * (2e-7 if row["type"] == "BAM2" else 1e-7)} for row in rows]
    assert by_size(sized) == "100 nm 1, 200 nm 1.1"


def test_limit_of_rolling_is_told_where_it_was_left_out():
    """LAMMPS at half of the omega of ratd with the limit, at the same and at twice it without."""
    runs = [("rotation", 3, 2, 0), (ELASTIC_ROLLING, 4, 4, 0), ("rotation", 3, 2, 1), (ELASTIC_ROLLING, 3, 4, 1)]
    table = pd.DataFrame(
        [
            {"study": study, "path": "driven", "code": code, "type": "BA", "a_eff": 1e-7, "seed": seed}
            | {"cut_bound": 1.0, "omega": 2.0**k, "mass_left": 1.0 if k < whole else 0.9}
            for study, ours, theirs, seed in runs
            for code, whole in (("ratd", ours), (TURNING, theirs))
            for k in range(6)
        ]
    )
    assert "is 0.5–0.5 in 2 driven grains, and 1–2 where rolling has no limit in either code" in rolling_limit(table)
    assert rolling_limit(table[table["study"] == "rotation"]) == ""


def test_exact_term_is_set_beside_the_printed_fit():
    """Runs of the exact term that lost mass count, not those of the explicit one, and none of the consistent drive."""
    grown = make_table(materials=["q-S"], sizes=(100e-9, 200e-9), seeds=2)
    printed = table3_omega(grown)
    runs = grown.assign(
        drive="literal", coriolis="exact", omega_first_loss=np.where(grown["seed"] == 0, 3, 5) * printed
    )
    lost = grown["type"] != "BA"
    study = pd.concat(
        [
            runs.assign(omega_first_loss=runs["omega_first_loss"].where(lost)),
            runs.assign(coriolis="explicit", omega_first_loss=0.0),
            runs.assign(drive="prescribed", omega_first_loss=0.0),
        ]
    )
    plan = SimpleNamespace(materials=None)
    found = summary.exact_over_printed(SimpleNamespace(grown=grown, plan=plan), study)
    assert found.to_dict() == {(kind, nm): pytest.approx(4.0) for kind in ("BAM1", "BAM2") for nm in (100, 200)}


def test_main_findings_are_grouped_by_the_drives_that_show_them():
    verdicts = {"easier": (True, True), "order": (False, True), "flattening": (False, False), "quarter": (None, False)}
    rows = [
        Row(key, {drive: Answer(holds=holds) for drive, holds in zip(("prescribed", "literal"), both, strict=True)})
        for key, both in verdicts.items()
    ]
    (line,) = summary._main_findings(rows, ["prescribed", "literal"])
    for words in (
        f"seen with `prescribed` and `literal`: {summary.MAIN['easier']};",
        f"seen with `literal`: {summary.MAIN['order']};",
        f"seen in none: {summary.MAIN['flattening']};",
        f"not decided, or not seen: {summary.MAIN['quarter']}.",
    ):
        assert words in line
    assert set(summary.MAIN) <= set(PRINTED)
    assert summary._main_findings([], ["prescribed"]) == []
