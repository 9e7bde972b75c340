"""Table of grains, statistics per cell, and the fit of Eq. 33."""

from dataclasses import asdict, replace

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from ratd.aggregates.grain import Grain
from ratd.base.errors import InputError
from ratd.base.materials import Material, get_material
from ratd.experiments.spin_up.cells import cell_of, cell_statistics, joined, size_key, sort_cells
from ratd.experiments.spin_up.eq33 import (
    TABLE_3,
    eq33,
    fit_as_configured,
    fit_ensemble,
    radius_of_reading,
    table3,
    table3_dataset,
)
from ratd.experiments.spin_up.grain_table import COLUMNS, grain_table, table_dataset
from ratd.experiments.spin_up.marks import VARIABLES, disruption
from synthetic_runs import make_run, make_table

SIZES = (50e-9, 100e-9, 200e-9)


@pytest.fixture(scope="module")
def table():
    return make_table(sizes=SIZES, seeds=6)


@pytest.fixture(scope="module")
def fit(table):
    return fit_ensemble(table, n_bootstrap=200)


def grown(kind="BAM2", a_eff=200e-9, seed=0, **more):
    return {"material": "q-S", "type": kind, "a_eff": a_eff, "seed": seed, "n_contacts": 475, "porosity": 0.5} | more


# Eq. 33


@pytest.mark.parametrize(
    "kind, a_eff, n_contacts, filling_factor, expected",
    [("BAM2", 200e-9, 475, 0.53, 4.6e8), ("BAM2", 350e-9, 1950, 0.53, 3.2e8)],
)
def test_eq33_with_table_3_gives_the_papers_order(kind, a_eff, n_contacts, filling_factor, expected):
    """Figures worked out by hand for grains like those of Fig. 1, q-S with 20 nm."""
    material = get_material("q-S")
    args = (a_eff, material.surface_energy, material.density, 20e-9, n_contacts, filling_factor)
    assert eq33(*args, *TABLE_3["q-S", kind]) == pytest.approx(expected, rel=0.05)


def test_eq33_scales_as_each_of_its_terms():
    args = {"a_eff": 1e-7, "surface_energy": 0.02, "density": 2650.0, "mean_monomer_radius": 2e-8}
    args |= {"n_contacts": 100, "filling_factor": 0.4, "A": 2.0, "alpha": 0.14}
    base = eq33(**args)
    assert base == pytest.approx(2 / 1e-7 * (0.02 / (2650 * 2e-8)) ** 0.5 * 40**0.14, rel=1e-14)
    powers = {"a_eff": -1, "surface_energy": 0.5, "density": -0.5, "mean_monomer_radius": -0.5}
    powers |= {"n_contacts": 0.14, "filling_factor": 0.14, "A": 1}
    for name, power in powers.items():
        assert eq33(**(args | {name: 3 * args[name]})) == pytest.approx(base * 3**power, rel=1e-13)


def test_eq33_broadcasts():
    n_contacts = np.array([[10.0], [20.0]])
    assert eq33(np.array([1e-7, 2e-7, 3e-7]), 0.02, 2650.0, 2e-8, n_contacts, 0.5, 1.0, 0.1).shape == (2, 3)


# The table


def test_grain_table_joins_grains_and_marks():
    runs = [make_run(1e8, seed=seed, a_eff=200e-9, type="BAM2") for seed in (2, 0)]
    marks = [disruption(run) for run in runs]
    table = grain_table([grown(seed=seed) for seed in (0, 1, 2)], marks)
    assert list(table.columns) == list(COLUMNS)
    assert list(table["seed"]) == [0, 1, 2]
    assert table["omega_disr"].notna().tolist() == [True, False, True]
    for name in VARIABLES:
        assert table.loc[2, name] == float(marks[0][name])
    assert table.loc[0, "drive"] == "prescribed" and table.loc[1, "drive"] == ""
    assert table.loc[0, "steps"] == 1000 and table.loc[0, "cut_bound"] == runs[1].attrs["cut_bound"]
    np.testing.assert_array_equal(table["filling_factor"], 0.5)
    # Grown values stand, also where the relaxed grain has others.
    assert (table["n_contacts"] == 475).all()


def test_grain_table_of_marks_alone_uses_the_grain_at_rest():
    run = make_run(1e8)
    table = grain_table(marks=[disruption(run)])
    assert table.loc[0, "n_contacts"] == run.attrs["initial_n_contacts"]
    assert table.loc[0, "n_monomers"] == run.attrs["initial_n_monomers"]
    assert table.loc[0, "filling_factor"] == 1 - run.attrs["initial_porosity"]
    assert np.isnan(table.loc[0, "fractal_dimension"])
    assert [table.loc[0, f"axis_{axis}"] for axis in "abc"] == [run.attrs[f"initial_axis_{axis}"] for axis in "abc"]
    assert table.loc[0, "porosity"] == run.attrs["initial_porosity"]


def test_grain_table_reads_a_grain():
    radius = np.array([20e-9, 30e-9, 20e-9])
    z = np.array([0.0, 49.9e-9, 99.8e-9])
    grain = Grain(np.column_stack([0 * z, 0 * z, z]), radius, "q-S", type="BA", seed=4)
    row = grain_table([grain]).loc[0]
    assert (row["material"], row["type"], row["seed"]) == ("q-S", "BA", 4)
    assert (row["n_monomers"], row["n_contacts"]) == (3, 2)
    assert row["mean_monomer_radius"] == pytest.approx(70e-9 / 3)
    assert row["a_eff"] == pytest.approx(np.cbrt(np.sum(radius**3)))
    assert row["porosity"] == grain.shape.porosity and row["filling_factor"] == 1 - grain.shape.porosity
    assert row["axis_a"] == pytest.approx(row["axis_b"]) and row["axis_c"] > 2 * row["axis_b"]
    assert row["enclosing_radius"] == pytest.approx((99.8e-9 + 40e-9) / 2, rel=1e-6)
    own, orbit = (np.sum(radius**3 * part) for part in (0.4 * radius**2, (z - 49.9e-9) ** 2))
    assert row["spin_share"] == pytest.approx(own / (own + orbit), rel=1e-6)


def test_grain_table_takes_every_form_of_rows(table):
    expected = grain_table(table)
    mappings = table.to_dict("records")
    pd.testing.assert_frame_equal(grain_table(mappings), expected)
    pd.testing.assert_frame_equal(grain_table(table_dataset(expected)), expected)
    scalars = [xr.Dataset({"radius": ("monomer", [1e-8, 3e-8])}, attrs=grown())]
    row = grain_table(scalars).loc[0]
    assert (row["n_monomers"], row["mean_monomer_radius"]) == (2, 2e-8)


def test_order_of_the_input_does_not_matter(table):
    shuffled = table.sample(frac=1, random_state=1)
    pd.testing.assert_frame_equal(grain_table(shuffled), grain_table(table))


def test_sizes_are_told_apart_to_the_picometre():
    assert 350 * 1e-9 != 350e-9
    marks = [disruption(make_run(1e8, a_eff=350e-9))]
    table = grain_table([grown(a_eff=350 * 1e-9)], marks)
    assert table["omega_disr"].notna().all()
    assert size_key(pd.Series([199.9999999e-9, 2e-7, 200.0000001e-9])).tolist() == [200000] * 3


def test_a_grain_finds_itself_in_another_table():
    table = pd.DataFrame(
        {"material": "q-S", "type": "BA", "a_eff": [3e-7, 350 * 1e-9, 1e-7], "seed": 0, "omega": [3.0, 2.0, 1.0]}
    )
    other = table[:2].assign(a_eff=[3e-7, 350e-9], omega=[4.0, 5.0], more=1)
    found = joined(table, other[::-1], ["omega"])
    assert found[["omega", "omega_other"]].to_numpy().tolist() == [[3.0, 4.0], [2.0, 5.0]] and "more" not in found
    kept = joined(table, other.assign(seed=[0, 1]), ["omega"], how="left", suffix=" again")
    assert kept["omega"].tolist() == [3.0, 2.0, 1.0]
    np.testing.assert_array_equal(kept["omega again"], [4.0, np.nan, np.nan])
    with pytest.raises(pd.errors.MergeError):
        joined(table, pd.concat([other, other]), ["omega"])


def test_rows_stand_in_the_order_of_the_paper(table):
    table = sort_cells(table.iloc[::-1])
    assert list(dict.fromkeys(table["material"])) == ["a-C", "q-S", "co-S"]
    assert list(dict.fromkeys(table["type"])) == ["BA", "BAM1", "BAM2"]
    assert table.groupby(["material", "type"], sort=False)["a_eff"].is_monotonic_increasing.all()
    half = len(table) // 2
    parts = [table[:half], table[half:].reset_index(drop=True)]  # whose numbers of rows are the same
    pd.testing.assert_frame_equal(sort_cells(pd.concat(parts)), table)


@pytest.mark.parametrize(
    "grains, marks, message",
    [
        (None, None, "give grains, marks or both"),
        ([grown(), grown()], None, "q-S BAM2 200 nm seed 0 more than once"),
        ([{"material": "q-S", "type": "BA", "seed": 0}], None, "no 'a_eff'"),
        ([grown()], [grown(seed=1)], "q-S BAM2 200 nm seed 1 has marks but no grain"),
        ([3], None, "is a int, not a Grain"),
    ],
)
def test_rows_that_do_not_make_a_table(grains, marks, message):
    with pytest.raises(InputError, match=message):
        grain_table(grains, marks)


# Cells


def test_cell_statistics_against_plain_loops(table):
    table = table.copy()
    table.loc[table.index[::4], "omega_disr"] = np.nan
    cells = cell_statistics(table)
    assert len(cells) == 27 and (cells["n_grains"] == 6).all()
    for _, cell in cells.iterrows():
        rows = [
            row
            for row in table.to_dict("records")
            if (row["material"], row["type"], row["a_eff"]) == (cell["material"], cell["type"], cell["a_eff"])
        ]
        values = [row["omega_disr"] for row in rows if not np.isnan(row["omega_disr"])]
        assert cell["omega_disr_count"] == len(values)
        assert cell["omega_disr_mean"] == pytest.approx(sum(values) / len(values), rel=1e-12)
        assert (cell["omega_disr_minimum"], cell["omega_disr_maximum"]) == (min(values), max(values))


def test_every_material_type_and_size_is_a_cell(table):
    cell = pd.Series(cell_of(table), table.index)
    names = table[["material", "type", "a_eff"]].apply(tuple, axis=1)
    assert cell.nunique() == 27 and names.groupby(cell).nunique().eq(1).all()


def test_cells_may_pool_the_materials(table):
    cells = cell_statistics(table, by=("type", "a_eff"))
    assert len(cells) == 9 and (cells["n_grains"] == 18).all()
    mean = table[(table["type"] == "BA") & (table["a_eff"] == 1e-7)]["porosity"].mean()
    assert cells.set_index(["type", "a_eff"]).loc[("BA", 1e-7), "porosity_mean"] == pytest.approx(mean)


def test_cell_without_any_value(table):
    cells = cell_statistics(table.assign(omega_disr=np.nan))
    assert (cells["omega_disr_count"] == 0).all() and cells["omega_disr_mean"].isna().all()


def test_cells_need_their_columns(table):
    with pytest.raises(InputError, match="no column 'type'"):
        cell_statistics(table.drop(columns="type"))


# The fit


def test_fit_finds_the_exact_law():
    for reading, A in (("own", 1.7), (20e-9, None)):
        exact = make_table(sizes=SIZES, seeds=3, A=1.7, alpha=0.13, scatter=0.0)
        if A is None:
            exact["mean_monomer_radius"] = 30e-9
            for name in ("a-C", "q-S", "co-S"):
                m, here = get_material(name), exact["material"] == name
                rows = exact[here]
                args = (rows["a_eff"], m.surface_energy, m.density, 20e-9, rows["n_contacts"], rows["filling_factor"])
                exact.loc[here, "omega_disr"] = eq33(*args, 1.7, 0.13)
        best = fit_ensemble(exact, reading, n_bootstrap=20)
        np.testing.assert_allclose(best["A"], 1.7, rtol=1e-10)
        np.testing.assert_allclose(best["alpha"], 0.13, rtol=1e-10)
        np.testing.assert_allclose(best["A_low"], best["A_high"], rtol=1e-9)
        np.testing.assert_allclose(best["scatter"], 0, atol=1e-10)


def test_fit_is_the_least_squares_line(table, fit):
    rows = table[(table["material"] == "co-S") & (table["type"] == "BAM1")]
    m = get_material("co-S")
    x = np.log(rows["n_contacts"] * rows["filling_factor"])
    y = np.log(rows["omega_disr"] * rows["a_eff"] * np.sqrt(m.density * rows["mean_monomer_radius"] / m.surface_energy))
    alpha, log_a = np.polyfit(x, y, 1)
    best = fit.sel(mean_radius="own", material="co-S", type="BAM1")
    assert float(best["alpha"]) == pytest.approx(alpha, rel=1e-9)
    assert float(best["A"]) == pytest.approx(np.exp(log_a), rel=1e-9)
    assert float(best["scatter"]) == pytest.approx(np.std(y - log_a - alpha * x, ddof=2), rel=1e-9)


def test_the_reading_of_the_mean_radius_scales_A(table):
    best = fit_ensemble(table.assign(mean_monomer_radius=30e-9), n_bootstrap=5)
    assert list(best["mean_radius"].values) == ["20 nm", "own"]
    ratio = best["A"].sel(mean_radius="own") / best["A"].sel(mean_radius="20 nm")
    np.testing.assert_allclose(ratio, np.sqrt(30 / 20), rtol=1e-12)  # the 22 % of the paper's two readings
    np.testing.assert_allclose(best["alpha"][0], best["alpha"][1], rtol=1e-12)
    # The same grains are drawn for both readings.
    np.testing.assert_allclose(best["alpha_low"][0], best["alpha_low"][1], rtol=1e-9)
    assert [radius_of_reading(name) for name in best["mean_radius"].values] == [pytest.approx(20e-9), None]


def test_bootstrap_agrees_with_the_textbook_error():
    rows = make_table(materials=("q-S",), types=("BA",), seeds=30, scatter=0.1)
    best = fit_ensemble(rows, "own", n_bootstrap=2000).squeeze()
    x = np.log(rows["n_contacts"] * rows["filling_factor"])
    error = float(best["scatter"]) / np.sqrt(np.sum((x - x.mean()) ** 2))
    assert float(best["alpha_high"] - best["alpha_low"]) == pytest.approx(2 * 1.96 * error, rel=0.15)
    assert float(best["alpha_low"]) < 0.12 < float(best["alpha_high"])
    assert float(best["A_low"]) < 0.4 < float(best["A_high"])
    narrow = fit_ensemble(rows, "own", n_bootstrap=2000, confidence=0.5).squeeze()
    assert float(narrow["A_high"] - narrow["A_low"]) < 0.5 * float(best["A_high"] - best["A_low"])


def test_a_fit_does_not_hang_on_how_many_grains_each_size_has(table):
    """omega that is no law of Eq. 33 and the same for all grains of a size, seen with all and with fewer of them."""
    rows = table[(table["material"] == "q-S") & (table["type"] == "BA")].copy()
    for _, here in rows.groupby("a_eff").groups.items():
        for name in ("n_contacts", "filling_factor", "mean_monomer_radius", "omega_disr"):
            rows.loc[here, name] = rows.loc[here[0], name]
    rows["omega_disr"] *= np.where(rows["a_eff"] > rows["a_eff"].median(), 3.0, 1.0)
    fewer = rows[(rows["seed"] == 0) | (rows["a_eff"] == rows["a_eff"].min())]
    best, thin = (fit_ensemble(part, n_bootstrap=5) for part in (rows, fewer))
    for name in ("A", "alpha"):
        np.testing.assert_allclose(best[name], thin[name], rtol=1e-9)


def test_intervals_hold_the_truth_as_often_as_they_say_with_few_large_grains():
    full = make_table(materials=("q-S",), types=("BA",), seeds=10, scatter=0.0)
    large = full["a_eff"] > full["a_eff"].median()
    rows = full[~large | (full["seed"] == 0)]
    exact = fit_ensemble(rows, "own", n_bootstrap=2).squeeze()
    inside = 0
    for seed in range(100):
        noise = np.random.default_rng(seed).lognormal(0, 0.2, len(rows))
        made = rows.assign(omega_disr=rows["omega_disr"] * noise)
        found = fit_ensemble(made, "own", n_bootstrap=200, confidence=0.8, seed=seed).squeeze()
        inside += float(found["alpha_low"]) < float(exact["alpha"]) < float(found["alpha_high"])
    assert 65 <= inside <= 95


def test_intervals_are_about_the_fit_with_few_large_grains():
    full = make_table(materials=("q-S",), types=("BA",), seeds=20, scatter=0.0)
    rows = full[(full["a_eff"] < 1.2e-7) | (full["seed"] < 2)]
    # omega that is no law of Eq. 33: the weights move the line
    rows = rows.assign(omega_disr=rows["omega_disr"] * np.where(rows["a_eff"] > 2e-7, 3.0, 1.0))
    found = fit_ensemble(rows, "own", n_bootstrap=400, confidence=0.9).squeeze()
    for name in ("A", "alpha"):
        assert float(found[f"{name}_low"]) < float(found[name]) < float(found[f"{name}_high"])


def test_fit_repeats_to_the_last_bit_whatever_the_order(table, fit):
    xr.testing.assert_identical(fit_ensemble(table.sample(frac=1, random_state=2), n_bootstrap=200), fit)
    xr.testing.assert_identical(fit_ensemble(table_dataset(grain_table(table)), n_bootstrap=200), fit)
    assert not np.array_equal(fit_ensemble(table, n_bootstrap=200, seed=1)["A_low"], fit["A_low"])


def test_fit_as_configured_takes_every_setting(table):
    table = table[table["material"] == "q-S"]
    light = replace(get_material("q-S"), density=1000.0)
    how = {"mean_monomer_radius": [3e-8], "bootstrap": 20, "confidence": 0.5, "seed": 3}
    expected = fit_ensemble(table, [3e-8], n_bootstrap=20, confidence=0.5, seed=3, materials={"q-S": light})
    xr.testing.assert_identical(fit_as_configured(table, how | {"materials": {"q-S": asdict(light)}}), expected)


def test_further_materials_change_nothing(table, fit):
    alone = fit_ensemble(table[table["material"] == "q-S"], n_bootstrap=200)
    for name in ("A", "A_low", "alpha_high"):
        np.testing.assert_array_equal(alone[name].sel(material="q-S"), fit[name].sel(material="q-S"))


def test_grains_without_the_mark_are_left_out(table):
    gaps = table.copy()
    gaps.loc[(gaps["seed"] == 3) & (gaps["type"] == "BA"), "omega_disr"] = np.nan
    best = fit_ensemble(gaps, n_bootstrap=5)
    assert best["n_grains"].sel(type="BA").values.tolist() == [15, 15, 15]
    assert best["n_grains"].sel(type="BAM1").values.tolist() == [18, 18, 18]
    expected = fit_ensemble(table[table["seed"] != 3], n_bootstrap=5)
    np.testing.assert_allclose(best["A"].sel(type="BA"), expected["A"].sel(type="BA"), rtol=1e-12)
    # nor do those without a size or contacts count
    for name in ("a_eff", "n_contacts"):
        gaps = table.astype({name: float})
        gaps.loc[gaps["seed"] == 3, name] = np.nan
        np.testing.assert_allclose(fit_ensemble(gaps, n_bootstrap=5)["A"], expected["A"], rtol=1e-12)
    with pytest.raises(InputError, match="the columns a_eff, n_contacts, .*omega_disr, .* must hold numbers"):
        fit_ensemble(table.astype({"omega_disr": object}).assign(omega_disr="fast"), n_bootstrap=5)
    with pytest.raises(InputError, match="mean_monomer_radius is empty; give a radius in m, or 'own'"):
        fit_ensemble(table, [], n_bootstrap=5)


def test_other_marks_can_be_fitted(table):
    best = fit_ensemble(table, "own", mark="omega_mass_75", n_bootstrap=5)
    np.testing.assert_allclose(best["A"], 0.95 * fit_ensemble(table, "own", n_bootstrap=5)["A"], rtol=1e-12)
    assert best.attrs["mark"] == "omega_mass_75"


def test_sparse_ensembles_say_what_is_missing(table):
    one_size = fit_ensemble(table[table["a_eff"] == 1e-7], n_bootstrap=5)
    assert one_size["A"].isnull().all() and "q-S BAM2: 6 usable grains of 1 sizes" in one_size.attrs["missing_fits"]
    one_seed = fit_ensemble(table[table["seed"] == 0], n_bootstrap=200)
    assert (one_seed["A_low"] < one_seed["A"]).all() and (one_seed["A"] < one_seed["A_high"]).all()
    hole = table[~((table["material"] == "q-S") & (table["type"] == "BA"))]
    best = fit_ensemble(hole, n_bootstrap=5)
    assert best["A"].isnull().sum() == 2 and best.attrs["missing_fits"] == "q-S BA: 0 usable grains of 0 sizes"


def test_material_of_ones_own(table):
    rows = table[table["material"] == "q-S"].assign(material="snow")
    with pytest.raises(InputError, match="snow"):
        fit_ensemble(rows)
    q_s = get_material("q-S")
    ice = Material("snow", 4 * q_s.surface_energy, q_s.youngs_modulus, q_s.poisson_number, q_s.density)
    best = fit_ensemble(rows, n_bootstrap=5, materials={"snow": ice})
    expected = fit_ensemble(table[table["material"] == "q-S"], n_bootstrap=5)
    np.testing.assert_allclose(best["A"].values, expected["A"].values / 2, rtol=1e-12)


@pytest.mark.parametrize(
    "change, options, message",
    [
        (lambda t: t.drop(columns="omega_disr"), {}, "no column 'omega_disr'"),
        (lambda t: t.drop(columns=["filling_factor", "porosity"]), {}, "neither a column 'filling_factor'"),
        (lambda t: t.assign(mean_monomer_radius=np.nan), {}, "no row has a 'mean_monomer_radius', needed for \"own\""),
        (lambda t: t.drop(columns="mean_monomer_radius"), {}, 'needed for "own"'),
        (lambda t: t.iloc[:0], {}, "no rows"),
        (lambda t: t.assign(drive=["literal"] + ["prescribed"] * (len(t) - 1)), {}, "literal, prescribed; fit one"),
        (lambda t: t, {"mean_monomer_radius": "mean"}, "'mean', allowed are a radius in m and 'own'"),
        (lambda t: t, {"mean_monomer_radius": -1e-9}, "must be above zero"),
        (lambda t: t, {"n_bootstrap": 0}, "n_bootstrap must be 1 or more"),
        (lambda t: t, {"confidence": 95}, "between 0 and 1"),
    ],
)
def test_bad_input(table, change, options, message):
    with pytest.raises(InputError, match=message):
        fit_ensemble(change(table), **options)


# Table 3


def test_printed_table_is_complete():
    assert {material for material, _ in TABLE_3} == {"a-C", "q-S", "co-S"}
    assert len(TABLE_3) == 9
    # Sums over the printed rows, added up by hand from the paper.
    assert sum(A for A, _ in TABLE_3.values()) == pytest.approx(17.75)
    assert sum(alpha for _, alpha in TABLE_3.values()) == pytest.approx(1.12)


def test_table3_puts_fit_and_print_side_by_side(fit):
    rows = table3(fit).set_index(["mean_radius", "material", "type"])
    assert len(rows) == 18
    for (material, kind), (A, alpha) in TABLE_3.items():
        for reading in ("20 nm", "own"):
            row = rows.loc[(reading, material, kind)]
            assert (row["A_printed"], row["alpha_printed"]) == (A, alpha)
            assert row["A"] == float(fit["A"].sel(mean_radius=reading, material=material, type=kind))
            assert row["A_low"] < row["A"] < row["A_high"]
    assert (rows["drive"] == "prescribed").all()


def test_table3_has_no_print_for_what_the_paper_lacks(table):
    best = fit_ensemble(table.assign(type="RA"), n_bootstrap=5)
    assert table3(best)["A_printed"].isna().all()


def test_tables_as_datasets_survive_netcdf(tmp_path, table, fit):
    full = grain_table(table)
    for name, dataset in {
        "fit": table3_dataset(fit),
        "grains": table_dataset(full),
        "cells": table_dataset(cell_statistics(full), "cell"),
    }.items():
        dataset.to_netcdf(tmp_path / f"{name}.nc")
        with xr.open_dataset(tmp_path / f"{name}.nc") as again:
            xr.testing.assert_equal(again.load(), dataset)
        for variable in dataset.data_vars.values():
            assert variable.attrs["long_name"]
            assert "units" in variable.attrs or variable.dtype == object
    cells = table_dataset(cell_statistics(full), "cell")
    assert cells["omega_disr_mean"].attrs["units"] == "rad s-1"
    assert cells["omega_disr_count"].attrs["units"] == "1"
    assert cells["n_contacts_maximum"].attrs["long_name"] == "maximum of: number of contacts"
