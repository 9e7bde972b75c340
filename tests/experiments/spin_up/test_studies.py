"""What studies change of the ensemble: on tables whose answers are known."""

import numpy as np
import pandas as pd
import pytest

from ratd.aggregates.growth import grain_radii, grow
from ratd.aggregates.radii import RadiusDistribution
from ratd.base.errors import FileError
from ratd.base.measured import Measured
from ratd.experiments.spin_up.eq33 import eq33_omega
from ratd.experiments.spin_up.findings.studies import (
    MARKS,
    cell_ratio,
    of_studies,
    paired,
    studies,
    with_radii,
)
from ratd.experiments.spin_up.grain_table import spun_up_files, spun_up_table
from ratd.experiments.spin_up.printed import PAPER_MEAN_RADIUS, TABLE_3
from tiny_pipeline import ROOT

TYPES = {"BA": 1.0, "BAM1": 2.0, "BAM2": 4.0}
SIZES = (100e-9, 200e-9, 300e-9)
ALPHA = -0.2
"""Exponent of Eq. 33 for the made-up grains, with <a_mon> the second of the means."""
MEANS = {1: 30e-9, 2: 35e-9, 3: 41e-9}


def made_up(seeds, *, factor=1.0, scatter=0.1, radius=None, materials=("q-S",), start=0, rng=None):
    """Grains that follow Eq. 33, times a factor, with scatter in ln omega."""
    rng = np.random.default_rng(start) if rng is None else rng
    rows = []
    for material in materials:
        for kind, strength in TYPES.items():
            for size in SIZES:
                for seed in range(seeds):
                    means = MEANS if radius is None else dict.fromkeys(MEANS, radius)
                    number = (size / means[3]) ** 3 * np.exp(3 * scatter * rng.normal())
                    omega = strength / size * means[2] ** -0.5 * number**ALPHA * factor * np.exp(scatter * rng.normal())
                    marks = {name: k * omega for name, k in zip(MARKS, (0.5, 1.0, 1.2), strict=True)}
                    rows.append(
                        {"material": material, "type": kind, "a_eff": size * (1 + 1e-15 * seed), "seed": seed, **marks}
                        | {"n_monomers": number, "n_contacts": 2 * number, "filling_factor": 0.3}
                        | {f"radius_{k}": mean for k, mean in means.items()}
                    )
    return pd.DataFrame(rows)


@pytest.fixture(scope="module")
def tables():
    ensemble = made_up(40, materials=("q-S", "a-C"))
    # the same grains, 1.15 times faster, and an outlier that a median does not see
    dmt = ensemble[ensemble["seed"] < 6].copy().reset_index(drop=True)
    dmt[list(MARKS)] *= 1.15
    dmt.loc[0, list(MARKS)] *= 10.0
    equal = {f"equal_{nm}nm": made_up(40, radius=nm * 1e-9, start=nm) for nm in (30, 41)}
    literal = made_up(4, factor=5.0)
    printed = literal.copy()
    printed[list(MARKS)] *= 0.9
    return {
        "spun_up": ensemble, "dmt": dmt, **equal, "second_reading": made_up(40, factor=1.05, start=7),
        "printed": printed, "literal": literal,
    }  # fmt: skip


@pytest.fixture(scope="module")
def values(tables):
    return of_studies(tables)


def test_grains_are_compared_with_themselves(tables, values):
    pairs = paired(tables["dmt"].sample(frac=1.0, random_state=1), tables["spun_up"])
    assert len(pairs) == len(tables["dmt"]) == values["dmt.grains"]
    assert np.isclose(pairs["omega_mass_75_ratio"], 1.15).sum() == len(pairs) - 1
    for mark in MARKS:
        for name in ("dmt.all", "dmt.BA", "dmt.q-S BAM1", "dmt.a-C all"):
            assert values[f"{name} {mark}"] == pytest.approx(Measured(1.15, 0.0), abs=1e-9)
        assert values[f"printed.BAM2 {mark}"].value == pytest.approx(0.9)


def test_a_grain_that_the_ensemble_does_not_have_is_left_out(tables):
    fewer = tables["spun_up"][tables["spun_up"]["seed"] != 3]
    pairs = paired(tables["dmt"], fewer)
    assert len(pairs) == len(tables["dmt"]) * 5 // 6 and 3 not in set(pairs["seed"])


def test_printed_equations_are_compared_with_the_printed_law(tables, values):
    table = tables["printed"]
    law = eq33_omega(table, TABLE_3, PAPER_MEAN_RADIUS)
    part = table["type"] == "BAM1"
    wanted = np.median(table["omega_disr"][part] / law[part])
    assert values["printed.BAM1 omega_disr table 3"].value == pytest.approx(wanted)


def test_other_grains_are_compared_cell_by_cell():
    """Cells that one of the two lacks say nothing, and a cell with more grains has no greater say."""
    first, second = made_up(30, factor=1.3, start=1), made_up(60, start=2)
    many = made_up(300, factor=1.3, start=3)
    first = pd.concat([first, many[many["type"] == "BA"].assign(seed=many["seed"] + 100)])
    first.loc[first["type"] == "BA", "omega_mass_75"] *= 2.0
    second = second[~np.isclose(second["a_eff"], 300e-9)]
    found = cell_ratio(first, second, "omega_mass_75")
    assert found.value == pytest.approx(1.3 * 2.0 ** (1 / 3), abs=4 * found.error)
    # as without the cells that only one has
    alone = cell_ratio(first[~np.isclose(first["a_eff"], 300e-9)], second, "omega_mass_75")
    assert found == pytest.approx(alone, rel=1e-12)
    assert np.isnan(cell_ratio(first[first["type"] == "BA"], second[second["type"] == "BAM2"], "omega_mass_75").value)


def test_the_error_is_the_scatter_of_repeated_studies():
    rng = np.random.default_rng(4)
    beside = made_up(50, rng=rng)
    found = [cell_ratio(made_up(6, rng=rng), beside, "omega_disr") for _ in range(200)]
    values, errors = np.array(found).T
    # less the scatter of `beside`, which is the same each time: 6/56 of the square
    assert np.std(values, ddof=1) == pytest.approx(errors.mean() * np.sqrt(50 / 56), rel=0.12)


def test_marks_that_are_missing_are_left_out():
    first, second = made_up(10, factor=1.3, scatter=0.0), made_up(10, scatter=0.0)
    first.loc[first["seed"] < 5, "omega_disr"] = np.nan
    second.loc[second["type"] == "BA", "omega_disr"] = np.nan
    assert cell_ratio(first, second, "omega_disr").value == pytest.approx(1.3, rel=1e-12)


def test_grains_of_other_monomers_are_compared_with_the_ensemble(values):
    """Monomers of 30 nm, beside those of the ensemble, whose means are 30, 35 and 41 nm."""
    for k, mean in MEANS.items():
        assert values[f"equal_30nm.all radius {k}"].value == pytest.approx(30e-9 / mean, rel=1e-12)
    number = values["equal_30nm.all n_monomers"]
    assert number.value == pytest.approx((41 / 30) ** 3, abs=4 * number.error)
    assert values["equal_30nm.all n_contacts"] == pytest.approx(number, rel=1e-12)
    assert values["equal_30nm.all filling_factor"].value == pytest.approx(1.0)
    assert values["second_reading.all omega_disr"].value == pytest.approx(1.05, abs=0.03)


def test_equal_monomers_are_more_porous_where_all_types_are(tables):
    loose = {name: tables[name].assign(filling_factor=0.2) for name in ("equal_30nm", "equal_41nm")}
    loose = {name: table.assign(filling_factor=0.2 + 0.001 * (table["seed"] % 2)) for name, table in loose.items()}
    assert of_studies(tables | loose)["equal.holds compact"] == "yes"
    one = loose["equal_41nm"].assign(filling_factor=np.where(loose["equal_41nm"]["type"] == "BAM2", 0.4, 0.2))
    assert of_studies(tables | loose | {"equal_41nm": one})["equal.holds compact"] == "no"


def test_a_law_of_the_ensemble_holds_for_equal_monomers_with_the_right_mean_radius(values):
    for mark in MARKS:
        for kind in TYPES:
            alpha = values[f"law.{kind} {mark} alpha 2"]
            assert alpha.value == pytest.approx(ALPHA, abs=4 * alpha.error) and 0.0 < alpha.error < 0.03
            for name in ("equal_30nm", "equal_41nm"):
                right, wrong = (values[f"{name}.{kind} {mark} law {k}"] for k in (2, 1))
                assert right.value == pytest.approx(1.0, abs=4 * right.error) and 0.0 < right.error < 0.06
                assert wrong.value == pytest.approx(right.value * np.sqrt(35 / 30), rel=1e-3)
        assert values[f"equal.{mark} mean"] == "⟨a²⟩^(1/2)"
        assert values[f"equal.{mark} chi2 2"] < 20.0 < values[f"equal.{mark} chi2 1"]
    # and at each size by itself
    n = values["equal.sizes"]
    assert values["equal.sizes chi2 2"] < n + 4 * np.sqrt(2 * n) < values["equal.sizes chi2 1"]


def test_a_law_that_holds_in_the_mean_of_sizes_alone_is_far_off_at_each(tables):
    """omega of equal monomers that rises with size where that of the ensemble does not."""
    turned = {}
    for name in ("equal_30nm", "equal_41nm"):
        size = tables[name]["a_eff"] / np.exp(np.log(tables[name]["a_eff"]).mean())
        turned[name] = tables[name].assign(omega_mass_75=tables[name]["omega_mass_75"] * size)
    values = of_studies(tables | turned)
    n = values["equal.sizes"]
    flatter = values["equal_30nm.BA flatter omega_mass_75"]
    assert flatter.value == pytest.approx(1.0, abs=4 * flatter.error) and 0.0 < flatter.error < 0.1
    assert abs(values["equal_30nm.BA flatter omega_disr"].value) < 0.1
    assert values["equal.BA flatter least"].value < 0.1 < 0.9 < values["equal.BA flatter most"].value
    assert values["equal.omega_mass_75 chi2 2"] < 20.0 and values["equal.sizes chi2 2"] > 10 * n
    below, above = (
        values[f"equal_30nm.BA {size / 1e-9:.0f} nm omega_mass_75 law 2"].value for size in SIZES[:: len(SIZES) - 1]
    )
    assert above / below == pytest.approx(SIZES[-1] / SIZES[0], rel=0.15)


def test_how_omega_goes_with_the_radius_of_equal_monomers(values):
    """As a^-1/2 N^alpha, where N goes as a^-3."""
    for kind in ("all", *TYPES):
        exponent = values[f"equal.{kind} omega_disr exponent"]
        assert exponent.value == pytest.approx(-0.5 - 3 * ALPHA, abs=4 * exponent.error)
        assert 0.0 < exponent.error < 0.15


@pytest.mark.parametrize(("kind", "size"), [("BA", 100e-9), ("BAM2", 200e-9)])
def test_radii_of_a_grain_without_growing_it(kind, size):
    distribution = RadiusDistribution(8.77e-9, 1.2845)
    grown = grow(kind, size, "q-S", 3, distribution=distribution)
    np.testing.assert_array_equal(grain_radii(kind, size, "q-S", 3, distribution), grown.radius)


def test_rows_have_the_radii_of_their_own_monomers():
    """On rows that come with ratd."""
    files = spun_up_files(ROOT / "docs/reproduction/data/equal_41nm/prescribed")
    rows = spun_up_table(files)
    wanted = rows["seed"] < 2
    table = with_radii(rows, files, wanted)
    assert (np.isfinite(table["radius_1"]) == wanted).all() and wanted.sum() == 18
    table = table[wanted]
    np.testing.assert_allclose(table["radius_3"], table["a_eff"] / table["n_monomers"] ** (1 / 3), rtol=1e-9)
    assert (table["radius_1"].between(38e-9, 43e-9)).all() and (table["radius_1"] <= table["radius_2"]).all()


def test_a_study_without_rows_is_named(tmp_path):
    with pytest.raises(FileError, match="dmt/prescribed: holds no rows; `python -m .* --study dmt` makes them"):
        studies(tmp_path, [], None)
