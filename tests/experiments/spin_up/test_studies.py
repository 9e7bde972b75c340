"""What studies change of the ensemble: on tables whose answers are known."""

import numpy as np
import pandas as pd
import pytest

from ratd.aggregates.growth import grain_radii, grow
from ratd.aggregates.radii import RadiusDistribution
from ratd.base.errors import FileError
from ratd.experiments.spin_up.eq33 import eq33_omega
from ratd.experiments.spin_up.printed import PAPER_MEAN_RADIUS, TABLE_3
from ratd.experiments.spin_up.studies import (
    DATA,
    MARKS,
    cell_ratio,
    findings,
    paired,
    read_study,
    same_omega,
    studies,
)
from ratd.pipeline.documents import Measured
from tiny_pipeline import ROOT

TYPES = {"BA": 1.0, "BAM1": 2.0, "BAM2": 4.0}
SIZES = (100e-9, 200e-9, 300e-9)
POWER = -0.7
"""Of the radius of the monomers, in the omega of the made-up grains."""
MEANS = {1: 30e-9, 2: 35e-9, 3: 41e-9}


def made_up(seeds, *, factor=1.0, scatter=0.1, radius=None, materials=("q-S",), start=0, rng=None):
    """Grains with omega ~ type, a_eff^-1 and the factor, with scatter in ln omega."""
    rng = np.random.default_rng(start) if rng is None else rng
    rows = []
    for material in materials:
        for kind, strength in TYPES.items():
            for size in SIZES:
                for seed in range(seeds):
                    omega = factor * 1e8 * strength * (1e-7 / size) * np.exp(scatter * rng.normal())
                    marks = {name: k * omega for name, k in zip(MARKS, (0.5, 1.0, 1.2), strict=True)}
                    means = MEANS if radius is None else dict.fromkeys(MEANS, radius)
                    number = (size / means[3]) ** 3
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
    equal = {
        f"equal_{nm}nm": made_up(40, radius=radius, factor=(radius / MEANS[2]) ** POWER, start=nm)
        for nm, radius in ((30, 30e-9), (41, 41e-9))
    }
    literal = made_up(4, factor=5.0)
    printed = literal.copy()
    printed[list(MARKS)] *= 0.9
    return {
        "spun_up": ensemble, "dmt": dmt, **equal, "second_reading": made_up(40, factor=1.05, start=7),
        "printed": printed, "literal": literal,
    }  # fmt: skip


@pytest.fixture(scope="module")
def values(tables):
    return findings(tables)


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
    # the scatter of `beside`, which is the same each time, is 6/56 of the square
    assert np.std(values, ddof=1) == pytest.approx(errors.mean() * np.sqrt(50 / 56), rel=0.12)


def test_marks_that_are_missing_are_left_out():
    first, second = made_up(10, factor=1.3, scatter=0.0), made_up(10, scatter=0.0)
    first.loc[first["seed"] < 5, "omega_disr"] = np.nan
    second.loc[second["type"] == "BA", "omega_disr"] = np.nan
    assert cell_ratio(first, second, "omega_disr").value == pytest.approx(1.3, rel=1e-12)


def test_scaling_by_a_mean_radius(values):
    """omega sqrt(a) of monomers of 30 nm over that of the ensemble, whose means are 30, 35 and 41 nm."""
    plain = values["equal_30nm.BA omega_mass_75"].value
    for k, mean in MEANS.items():
        scaled = values[f"equal_30nm.BA omega_mass_75 scaled {k}"].value
        assert scaled == pytest.approx(plain * np.sqrt(30e-9 / mean), rel=1e-12)
        assert values[f"equal_30nm.all radius {k}"].value == pytest.approx(30e-9 / mean, rel=1e-12)
    assert values["equal_30nm.all n_monomers"].value == pytest.approx((41 / 30) ** 3, rel=1e-9)
    assert values["equal_30nm.all filling_factor"].value == pytest.approx(1.0)
    assert values["second_reading.all omega_disr"].value == pytest.approx(1.05, abs=0.03)


def test_the_radius_of_equal_monomers_that_come_apart_alike(values):
    """The made-up law goes through the ensemble at its second mean."""
    for mark in MARKS:
        radius, exponent = values[f"equal.all {mark} radius"], values[f"equal.all {mark} exponent"]
        assert radius.value == pytest.approx(35.0, abs=3 * radius.error) and 0.0 < radius.error < 2.0
        assert exponent.value == pytest.approx(POWER, abs=3 * exponent.error) and 0.0 < exponent.error < 0.2
        assert values[f"equal.{mark} mean"] == "<a²>^(1/2)"


def test_same_omega_of_exact_ratios():
    ratios = [Measured((radius / 37e-9) ** -0.5, 0.01) for radius in (30e-9, 41e-9)]
    radius, exponent = same_omega((30e-9, 41e-9), ratios)
    assert radius.value == pytest.approx(37e-9, rel=1e-12) and exponent.value == pytest.approx(-0.5, rel=1e-12)
    # by trial: the first ratio a little greater
    first, second = ratios[0].value, ratios[1]._replace(error=0.0)
    moved, _ = same_omega((30e-9, 41e-9), [Measured(1.001 * first, 0.0), second])
    uncertain, _ = same_omega((30e-9, 41e-9), [Measured(first, 0.001 * first), second])
    assert abs(moved.value - radius.value) == pytest.approx(uncertain.error, rel=0.01)


@pytest.mark.parametrize(("kind", "size"), [("BA", 100e-9), ("BAM2", 200e-9)])
def test_radii_of_a_grain_without_growing_it(kind, size):
    distribution = RadiusDistribution(8.77e-9, 1.2845)
    grown = grow(kind, size, "q-S", 3, distribution=distribution)
    np.testing.assert_array_equal(grain_radii(kind, size, "q-S", 3, distribution), grown.radius)


def test_rows_have_the_radii_of_their_own_monomers():
    """Those of the ensemble, which come with ratd."""
    table = read_study(ROOT / DATA / "equal_41nm" / "prescribed")
    row = table.iloc[0]
    assert row["radius_3"] == pytest.approx(row["a_eff"] / row["n_monomers"] ** (1 / 3), rel=1e-9)
    assert (table["radius_1"].between(38e-9, 43e-9)).all() and (table["radius_1"] <= table["radius_2"]).all()


def test_a_study_without_rows_is_named(tmp_path):
    with pytest.raises(FileError, match="spun_up/prescribed: holds no rows; `python -m .* --study spun_up` makes them"):
        studies(tmp_path)
