"""Beyond the paper: made-up grains and fragments with known answers."""

import numpy as np
import pandas as pd
import pytest

from ratd.base.errors import InputError
from ratd.base.materials import get_material
from ratd.experiments.spin_up.cross_validation import cross_validation
from ratd.experiments.spin_up.eq33 import (
    PAPER_MEAN_RADIUS,
    eq33,
    eq33_omega,
    fit_ensemble,
    fitted_numbers,
    radius_of_reading,
)
from ratd.experiments.spin_up.fragmentation import MONOMER_CLASSES, exponents, mass_shares, power_law
from ratd.experiments.spin_up.oblateness import is_oblate, oblate_change, oblate_share
from ratd.experiments.spin_up.size_law import SPLIT, curved_law, curved_law_value, size_law, size_law_unit, slopes
from synthetic_runs import make_fragments, make_table

SIZES = tuple(50e-9 * k for k in range(1, 9))


@pytest.fixture(scope="module")
def table():
    return make_table(sizes=SIZES, seeds=6, scatter=0.1)


def scatter_of(found, kind, predictor):
    return found[(found["type"] == kind) & (found["predictor"] == predictor)].iloc[0]


def test_the_law_that_made_the_grains_predicts_them_to_their_scatter(table):
    # the mean radius of the made-up grains scatters by 8 %, which Eq. 33 with 20 nm cannot know
    expected = np.hypot(0.1, 0.5 * 0.08)
    found = scatter_of(cross_validation(table), "all", "Eq. 33")
    assert found["scatter"] == pytest.approx(expected, rel=0.1)
    assert abs(found["scatter"] - expected) < 4 * found["error"] and found["error"] < 0.01


def test_a_bound_that_differs_by_type_predicts_with_one_constant_a_type():
    table = make_table(sizes=SIZES, seeds=6)
    factor = table["type"].map({"BA": 1.0, "BAM1": 2.0, "BAM2": 4.0})
    table["cut_bound"] = table["omega_disr"] / factor
    found = cross_validation(table)
    assert scatter_of(found, "all", "cut bound by type")["scatter"] == pytest.approx(0.0, abs=1e-12)
    # one constant for ln 1, ln 2, ln 4: the geometric mean, off by ln 2 for the outer two types
    assert scatter_of(found, "BAM2", "cut bound")["scatter"] == pytest.approx(np.log(2), rel=1e-9)
    assert scatter_of(found, "all", "cut bound")["scatter"] == pytest.approx(np.log(2) * np.sqrt(2 / 3), rel=1e-9)


def test_what_was_left_out_has_no_part_in_its_prediction():
    """One of eight sizes lies a factor of 10 off: seen from the others it is off by all of that."""
    table = make_table(materials=["q-S"], types=["BAM2"], sizes=SIZES, seeds=6)
    table["cut_bound"] = table["omega_disr"]
    table.loc[np.isclose(table["a_eff"], SIZES[-1]), "omega_disr"] *= 10
    found = scatter_of(cross_validation(table), "BAM2", "cut bound")
    assert found["scatter"] == pytest.approx(np.log(10) * np.sqrt(1 / 8 + 7 / 8 / 7**2), rel=1e-9)


def test_what_is_predicted_by_one_constant_counts_all_sizes_alike():
    """omega over the bound: 1 for twenty grains of one size, e and e^2 for two each of the others."""
    table = make_table(materials=["q-S"], types=["BAM2"], sizes=(1e-7, 2e-7, 4e-7), seeds=20)
    table = table[(table["a_eff"] < 1.5e-7) | (table["seed"] < 2)].reset_index(drop=True)
    level = table["a_eff"].map({1e-7: 0.0, 2e-7: 1.0, 4e-7: 2.0})
    table["cut_bound"] = table["omega_disr"] / np.exp(level)
    found = scatter_of(cross_validation(table), "BAM2", "cut bound")
    # seen from the mean of the other two: -1.5, 0, 1.5
    assert found["scatter"] == pytest.approx(1.5 * np.sqrt(2 / 3), rel=1e-9)


def test_predictions_do_not_hang_on_how_many_grains_each_size_has():
    """omega that is no power of N phi and the same for all grains of a size, seen with all and with fewer of them."""
    table = make_table(materials=["q-S"], types=["BAM2"], sizes=(1e-7, 2e-7, 3e-7, 4e-7), seeds=6)
    for _, here in table.groupby("a_eff").groups.items():
        for name in ("n_contacts", "n_monomers", "filling_factor", "mean_monomer_radius", "omega_disr", "cut_bound"):
            table.loc[here, name] = table.loc[here[0], name]
    fewer = table[(table["seed"] == 0) | (table["a_eff"] < 1.5e-7)].reset_index(drop=True)
    np.testing.assert_allclose(cross_validation(fewer)["scatter"], cross_validation(table)["scatter"], rtol=1e-9)


def test_a_grain_that_one_predictor_cannot_predict_counts_for_none(table):
    lone = table[(table["material"] == "q-S") & (table["type"] == "BA")].iloc[:1].assign(material="a-C", a_eff=1e-6)
    here = pd.concat([table[table["material"] == "q-S"], lone], ignore_index=True)
    assert scatter_of(cross_validation(here), "all", "cut bound")["n_grains"] == len(here) - 1


def test_a_power_of_size_predicts_what_goes_with_size_and_material_alone(table):
    """Each type has a constant and a power of its own; materials differ as sqrt(gamma/rho)."""
    constant, power = ({"BA": 0.5, "BAM1": 1.5, "BAM2": 3.0}, {"BA": 2.0, "BAM1": 1.5, "BAM2": 1.2})
    table = table.assign(omega_disr=0.0)
    for k, row in table.iterrows():
        material, x = get_material(row["material"]), row["a_eff"] / 300e-9
        unit = np.sqrt(material.surface_energy / (material.density * 300e-9**3))
        table.loc[k, "omega_disr"] = constant[row["type"]] * unit * x ** -power[row["type"]]
    assert scatter_of(cross_validation(table), "all", "power of size")["scatter"] < 1e-9
    law = size_law(table).set_index("type")
    for kind, own in law.iterrows():
        assert own["C"] == pytest.approx(constant[kind], rel=1e-9) and own["p"] == pytest.approx(power[kind], rel=1e-9)
        assert own["scatter"] < 1e-9 and own["C_error"] < 1e-9 and own["p_error"] < 1e-9
    assert not len(size_law(table[np.isclose(table["a_eff"], SIZES[0])]))


def test_errors_of_the_law_of_size_are_the_scatter_between_ensembles():
    rng, table = np.random.default_rng(5), make_table(materials=["q-S"], types=["BAM2"], sizes=SIZES, seeds=6)
    line = 1e8 * (table["a_eff"] / 300e-9) ** -1.5
    found = pd.concat(size_law(table.assign(omega_disr=line * rng.lognormal(0, 0.2, len(table)))) for _ in range(60))
    for name in ("C", "p"):
        assert found[f"{name}_error"].mean() == pytest.approx(found[name].std(), rel=0.3)
    assert found["scatter"].mean() == pytest.approx(0.2, rel=0.05) and found["p"].mean() == pytest.approx(1.5, abs=0.02)


def test_errors_of_the_law_of_size_hold_with_few_large_grains():
    rng, table = np.random.default_rng(5), make_table(materials=["q-S"], types=["BAM2"], sizes=SIZES, seeds=12)
    table = table[(table["a_eff"] < 160e-9) | (table["seed"] < 2)]
    line = 1e8 * (table["a_eff"] / 300e-9) ** -1.5
    found = pd.concat(size_law(table.assign(omega_disr=line * rng.lognormal(0, 0.2, len(table)))) for _ in range(60))
    for name in ("C", "p"):
        assert found[f"{name}_error"].mean() == pytest.approx(found[name].std(), rel=0.25)


def test_the_scatter_about_the_law_of_size_counts_all_sizes_alike():
    """None of eight small grains, 0.3 of two large ones: half of 0.09 in the mean of both sizes."""
    table = make_table(materials=["q-S"], types=["BAM2"], sizes=(1e-7, 3e-7), seeds=8)
    table = table[(table["a_eff"] < 2e-7) | (table["seed"] < 2)].reset_index(drop=True)
    off = np.where(table["a_eff"] > 2e-7, np.where(table["seed"] == 0, 0.3, -0.3), 0.0)
    law = size_law(table.assign(omega_disr=table["a_eff"] ** -1.5 * np.exp(off)))
    assert law["scatter"].item() == pytest.approx(0.3 / np.sqrt(2))


def curved_table(bends, seeds=4):
    """Grains with C = 0.5, 1.5, 3, p = 2, 1.5, 1.2 and such bends q of the types."""
    table = make_table(sizes=SIZES, seeds=seeds)
    x = np.log(table["a_eff"] / 300e-9)
    constant, power, bend = (
        table["type"].map(dict(zip(("BA", "BAM1", "BAM2"), values, strict=True)))
        for values in ((0.5, 1.5, 3.0), (2.0, 1.5, 1.2), bends)
    )
    return table.assign(omega_mass_75=constant * size_law_unit(table) * np.exp(-power * x - bend * x**2))


def test_a_curved_law_is_found_and_its_value_is_the_formula():
    table = curved_table((-0.2, 0.0, 0.1))
    law = curved_law(table).set_index("type")
    for kind, C, p, q in (("BA", 0.5, 2.0, -0.2), ("BAM1", 1.5, 1.5, 0.0), ("BAM2", 3.0, 1.2, 0.1)):
        own = law.loc[kind]
        assert own[["C", "p", "q"]].tolist() == pytest.approx([C, p, q], abs=1e-9)
        assert max(own[["C_error", "p_error", "q_error", "scatter"]]) < 1e-9 and own["n_grains"] == 3 * 4 * len(SIZES)
        here = table[table["type"] == kind]
        value = size_law_unit(here) * curved_law_value(here["a_eff"], C, p, q)
        np.testing.assert_allclose(value, here["omega_mass_75"])
        ratio = here["a_eff"].to_numpy() / SPLIT
        np.testing.assert_allclose(value, C * size_law_unit(here) * ratio ** (-p - q * np.log(ratio)))
    two = curved_law(table[table["a_eff"] < 110e-9])
    assert not len(two) and len(size_law(table[table["a_eff"] < 110e-9], "omega_mass_75")) == 3


def test_errors_of_the_curved_law_are_the_scatter_between_ensembles():
    rng, table = np.random.default_rng(5), curved_table((0.1, 0.1, 0.1), seeds=3)
    table = table[table["type"] == "BAM1"]
    made = pd.concat(
        curved_law(table.assign(omega_mass_75=table["omega_mass_75"] * rng.lognormal(0, 0.2, len(table))))
        for _ in range(60)
    )
    for name, value in (("C", 1.5), ("p", 1.5), ("q", 0.1)):
        assert made[f"{name}_error"].mean() == pytest.approx(made[name].std(), rel=0.3)
        assert made[name].mean() == pytest.approx(value, abs=4 * made[name].std() / np.sqrt(60))
    assert made["scatter"].mean() == pytest.approx(0.2, rel=0.05)


def test_the_curve_does_not_hang_on_how_many_grains_each_size_has():
    """omega that is no parabola of size, seen with all grains and with fewer of the large ones."""
    table = curved_table((0.0, 0.0, 0.0), seeds=5)
    table["omega_mass_75"] *= np.exp(0.3 * np.log(table["a_eff"] / 300e-9) ** 3)
    fewer = table[(table["seed"] == 0) | (table["a_eff"] < 220e-9)]
    names = ["C", "p", "q"]
    np.testing.assert_allclose(curved_law(fewer)[names], curved_law(table)[names], rtol=1e-9)


def test_eq_33_of_many_grains_is_that_of_each(table):
    fit = fit_ensemble(table, n_bootstrap=1)
    for reading in fit["mean_radius"].values:
        numbers = fitted_numbers(fit, reading)
        radius = radius_of_reading(reading)
        found = eq33_omega(table, numbers | {("q-S", "BA"): (1.0, 0.0)}, radius)
        for _, row in table.sample(20, random_state=0).iterrows():
            cell, material = (row["material"], row["type"]), get_material(row["material"])
            given = row["mean_monomer_radius"] if reading == "own" else PAPER_MEAN_RADIUS
            best = fit.sel(mean_radius=reading, material=cell[0], type=cell[1])
            pair = (1.0, 0.0) if cell == ("q-S", "BA") else (float(best["A"]), float(best["alpha"]))
            scale = row["a_eff"], material.surface_energy, material.density, given
            expected = eq33(*scale, row["n_contacts"], row["filling_factor"], *pair)
            assert found[row.name] == pytest.approx(expected, rel=1e-12)
    assert eq33_omega(table, {}, PAPER_MEAN_RADIUS).isna().all()


def power_table(below, above, noise=0.05, split=300e-9):
    rng = np.random.default_rng(3)
    rows = []
    for level, material in enumerate(("a-C", "q-S")):
        for a in 50e-9 * np.arange(1, 12):
            for seed in range(8):
                slope = below if a <= split else above
                omega = 1e8 * (1 + level) * (a / split) ** slope * rng.lognormal(0, noise)
                rows.append({"material": material, "type": "BA", "a_eff": a, "seed": seed, "omega_disr": omega})
    return pd.DataFrame(rows)


@pytest.mark.parametrize(("below", "above"), [(-1.0, 0.0), (-1.2, -1.2)])
def test_slopes_on_both_sides_are_found(below, above):
    row = slopes(power_table(below, above)).iloc[0]
    assert abs(row["below"] - below) < 4 * row["below_error"] < 0.1
    assert abs(row["above"] - above) < 4 * row["above_error"] < 0.2
    assert row["change"] == pytest.approx(row["above"] - row["below"], abs=1e-12)
    assert (row["sizes_below"], row["sizes_above"], row["n_grains"]) == (6, 6, 176)


def test_errors_of_slopes_are_the_scatter_between_ensembles():
    """Also with a single grain of each size above the split, which counts as much as the eight of one below."""
    table = power_table(-1.0, 0.0, noise=0.0)
    table = table[(table["a_eff"] <= 300e-9) | (table["seed"] == 0)]
    made = []
    for seed in range(200):
        noise = np.random.default_rng(seed).lognormal(0, 0.1, len(table))
        made.append(slopes(table.assign(omega_disr=table["omega_disr"] * noise)).iloc[0])
    made = pd.DataFrame(made)
    for name in ("below", "above", "change"):
        scatter = made[name].std()
        assert 0.85 < np.sqrt((made[f"{name}_error"] ** 2).mean()) / scatter < 1.4
        assert abs(made[name].mean() - {"below": -1.0, "above": 0.0, "change": 1.0}[name]) < 4 * scatter / np.sqrt(200)


def test_grains_at_the_split_count_twice_in_the_error_of_the_change():
    """If they alone scatter: one that lies high raises the slope below and lowers that above."""
    table = power_table(-1.0, -1.0, noise=0.0)
    split = np.isclose(table["a_eff"], 300e-9)
    table.loc[split, "omega_disr"] *= np.exp(np.where(table.loc[split, "seed"] % 2, -0.1, 0.1))
    row = slopes(table).iloc[0]
    assert row["change_error"] == pytest.approx(row["below_error"] + row["above_error"], rel=1e-6)


def test_a_slope_does_not_hang_on_how_many_grains_each_size_has():
    """omega that is not a power of size, seen with all grains and with fewer of the large ones."""
    table = power_table(-1.0, -1.0, noise=0.0)
    table["omega_disr"] *= np.exp(0.5 * np.log(table["a_eff"] / 300e-9) ** 2)
    fewer = table[(table["seed"] == 0) | (table["a_eff"] < 120e-9) | (table["a_eff"] > 480e-9)]
    for side in ("below", "above"):
        assert slopes(fewer).iloc[0][side] == pytest.approx(slopes(table).iloc[0][side], rel=1e-9)


def test_one_side_without_sizes_has_no_slope():
    row = slopes(power_table(-1.0, 0.0), split=550e-9).iloc[0]
    assert np.isfinite(row["below"]) and np.isnan(row["above"]) and np.isnan(row["change_error"])


def test_a_side_without_an_error_leaves_the_change_without_one():
    below = make_table(materials=["q-S"], types=["BA"], sizes=SIZES[1:6], seeds=5)
    above = make_table(materials=["q-S"], types=["BA"], sizes=SIZES[6:7], seeds=1)  # a line through both grains
    found = slopes(pd.concat([below[(below["a_eff"] < 290e-9) | (below["seed"] == 0)], above])).iloc[0]
    assert np.isfinite([found["below_error"], found["change"]]).all()
    assert np.isnan(found["above_error"]) and np.isnan(found["change_error"])


def test_a_grain_is_oblate_where_b_over_a_is_above_c_over_b():
    # b is below the middle of a and c and yet above their geometric mean, or below both
    assert is_oblate(1.0, 1.5, 2.2) and not is_oblate(1.0, 1.5, 2.4)
    assert is_oblate(1.0, 1.45, 2.0) and not is_oblate(1.0, 1.45, 2.15)


def test_the_share_of_oblate_grains_is_of_known_shapes_and_counts_all_sizes_alike():
    """Three oblate grains of one size, one of another that is not, and two whose shape is not known."""
    oblate, prolate, unknown = (1.0, 2.0, 2.1), (1.0, 1.1, 2.0), (np.nan, np.nan, np.nan)
    axes = [oblate, oblate, oblate, prolate, unknown, (0.0, 1.0, 1.0)]
    table = pd.DataFrame(axes, columns=[f"axis_{axis}_start" for axis in "abc"])
    table = table.assign(material="q-S", type="BA", a_eff=[1e-7] * 3 + [2e-7] + [1e-7] * 2)
    share, _, n_oblate, n = oblate_share(table, "start")
    assert (share, n_oblate, n) == (0.5, 3, 4)


def test_oblate_grains_are_counted_at_both_times():
    axes = {"axis_a_start": [1, 1, 1], "axis_b_start": [2.0, 1.1, 1.5], "axis_c_start": [2.1, 2.0, np.nan]}
    axes |= {"axis_a_disr": [1, 1, 1], "axis_b_disr": [2.0, 3.0, 2.0], "axis_c_disr": [2.1, 3.1, 2.2]}
    table = pd.DataFrame({"material": "q-S", "type": "BA", "a_eff": 1e-7, **axes})
    assert [oblate_share(table, when)[2:] for when in ("start", "disr")] == [(1, 2), (3, 3)]


def test_what_the_share_of_oblate_grains_gains_is_counted_grain_by_grain():
    prolate, oblate, unknown = (1.0, 1.1, 2.0), (1.0, 2.0, 2.1), (1.0, 2.0, np.nan)
    ways = [(prolate, oblate), (prolate, prolate), (oblate, oblate), (oblate, oblate), (unknown, oblate)]
    names = [f"axis_{axis}_{when}" for when in ("start", "disr") for axis in "abc"]
    table = pd.DataFrame([start + end for start, end in ways], columns=names)
    table = table.assign(material="q-S", type="BA", a_eff=1e-7)
    change, error = oblate_change(table)
    assert change == pytest.approx(0.25) and error == pytest.approx(np.std([1, 0, 0, 0], ddof=1) / 2)
    assert oblate_change(table[1:4]) == (0.0, 0.0)
    # all of one size gain, none of the other: sizes count alike, and by how much they differ is no error
    apart = table.iloc[[0, 0, 0, 1, 1]].assign(a_eff=[1e-7] * 3 + [2e-7] * 2)
    assert oblate_change(apart) == (0.5, 0.0)


def test_shares_of_fragments():
    fragments = pd.DataFrame(
        {
            "grain": [0, 0, 0, 1, 1],
            "fragment_n_monomers": [1, 3, 20, 1, 4],
            "mass_fraction": [0.1, 0.1, 0.3, 0.25, 0.25],
            "weight": 1.0,
        }
    )
    found = mass_shares(fragments)
    assert list(found) == list(MONOMER_CLASSES)
    assert [share.value for share in found.values()] == pytest.approx([0.35, 0.1, 0.25, 0.3])
    one = mass_shares(fragments[:3])
    assert one["more than 10"].value == pytest.approx(0.6) and all(np.isnan(share.error) for share in one.values())
    found = mass_shares(fragments.assign(weight=[0.5, 0.5, 0.5, 1.5, 1.5]))
    assert [share.value for share in found.values()] == pytest.approx([0.425, 0.05, 0.375, 0.15])
    found = mass_shares(fragments, {"up to 3": 3, "more": np.inf})
    assert [share.value for share in found.values()] == pytest.approx([0.45, 0.55])


def test_classes_of_monomers_begin_where_their_names_say():
    fragments = pd.DataFrame({"fragment_n_monomers": [1, 2, 3, 4, 10, 11], "grain": 0})
    found = mass_shares(fragments.assign(mass_fraction=0.1, weight=1.0))
    assert [share.value for share in found.values()] == pytest.approx([1 / 6, 2 / 6, 2 / 6, 1 / 6])


def test_error_of_a_share_of_lone_fragments_is_binomial():
    """Of 200 grains that lose one fragment each 60 lose a monomer."""
    fragments = pd.DataFrame({"fragment_n_monomers": np.repeat([1, 3], [60, 140])})
    found = mass_shares(fragments.assign(grain=np.arange(200), mass_fraction=0.1, weight=1.0))
    assert found["1 monomer"].error == pytest.approx(np.sqrt(0.3 * 0.7 / 199))


def test_error_of_a_share_is_that_of_a_bootstrap_over_grains():
    fragments = make_fragments(grains=30)
    fragments = fragments[(fragments["type"] == "BAM2") & (fragments["a_eff"] < 100e-9)]
    fragments = fragments.assign(weight=1.0 + fragments["grain"] % 3)
    rng, own = np.random.default_rng(1), [part for _, part in fragments.groupby("grain")]
    drawn = []
    for _ in range(300):
        chosen = [own[k].assign(grain=number) for number, k in enumerate(rng.integers(len(own), size=len(own)))]
        drawn.append([share.value for share in mass_shares(pd.concat(chosen)).values()])
    errors = [share.error for share in mass_shares(fragments).values()]
    np.testing.assert_allclose(errors, np.std(drawn, axis=0, ddof=1), rtol=0.2)


@pytest.mark.parametrize("exponent", [1.5, 2.5])
def test_power_law_is_found_and_justified_where_it_made_the_sample(exponent):
    n = np.arange(1, 501)
    law = n**-exponent / np.sum(n**-exponent)
    found = power_law(np.random.default_rng(5).choice(n, size=2000, p=law), 500)
    assert abs(found["exponent"] - exponent) < 4 * found["error"] < 0.2
    assert found["probability"] > 0.05


def test_power_law_is_not_justified_for_another_distribution():
    sizes = np.random.default_rng(6).poisson(20, size=500) + 1
    assert power_law(sizes, 500)["probability"] == 0.0
    assert np.isnan(power_law([1, 2, 3], 10)["exponent"])


def test_the_exponent_is_that_of_greatest_likelihood():
    """Against the condition itself, <ln n> of the law = <ln n> of the sample, solved by bisection."""
    rng = np.random.default_rng(7)
    for _ in range(40):
        largest = int(rng.integers(20, 1500))
        sizes = np.exp(rng.uniform(0, np.log(largest), rng.integers(10, 60))).astype(int)
        n = np.arange(1, largest + 1)

        def mean(exponent, n=n):
            law = n**-exponent
            return law @ np.log(n) / law.sum()

        low, high, wanted = -5.0, 15.0, np.log(sizes).mean()
        for _ in range(80):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if mean(middle) > wanted else (low, middle)
        assert power_law(sizes, largest, replicates=1)["exponent"] == pytest.approx(low, abs=1e-9)


def test_each_fragment_has_the_upper_end_of_its_own_grain():
    """One law cut off at two sizes is found and justified; taken as of one end it is steeper, and is not."""
    rng = np.random.default_rng(8)
    ends = np.repeat([8, 400], 1000)
    sizes = np.concatenate([rng.choice(np.arange(1, k + 1), 1000, p=law_to(k, 0.9)) for k in (8, 400)])
    found, common = power_law(sizes, ends), power_law(sizes, 400)
    assert abs(found["exponent"] - 0.9) < 4 * found["error"] < 0.2 and found["probability"] > 0.05
    assert common["exponent"] > 1.1 and common["probability"] == 0.0
    with pytest.raises(InputError, match="a fragment has 9 monomers, but 8 is the largest possible"):
        power_law([1, 9, 2], 8)


def law_to(largest, exponent):
    n = np.arange(1, largest + 1)
    return n**-exponent / np.sum(n**-exponent)


def test_exponents_by_type_and_class_lie_in_their_intervals():
    found = exponents(make_fragments(grains=60), replicates=100)
    assert len(found) == 9 and (found["n_grains"] == 60).all()
    assert (found["low"] < found["exponent"]).all() and (found["exponent"] < found["high"]).all()
    inside = (found["low"] < 1.2) & (found["high"] > 1.2)
    assert inside.sum() >= 7  # 95 % of 9 intervals
    large = found[found["size_class"] == "400 to 550 nm"]
    assert (large["high"] - large["low"] < 0.2).all() and large["exponent"].to_numpy() == pytest.approx(1.2, abs=0.1)
    steeper = exponents(make_fragments(grains=60).assign(n_monomers=10**4), replicates=2)
    assert (steeper["exponent"] > found["exponent"]).all()  # fewer large ones than there could be


def test_large_pieces_are_counted_by_the_grain():
    table = make_fragments(grains=2)
    table["mass_fraction"] = np.where(table.groupby("grain").cumcount() < 2, 0.2, 0.01)
    table.loc[table["grain"] == 0, "mass_fraction"] = 0.1  # is not above a tenth
    found = exponents(table, replicates=2).set_index(["type", "size_class"])["large_pieces"]
    assert found["BA", "50 to 150 nm"] == 1.0 and found["BAM2", "400 to 550 nm"] == 2.0
    one = exponents(table[table["grain"] == 3], replicates=2).iloc[0]
    assert np.isnan(one["low"]) and np.isnan(one["large_pieces_error"]) and one["large_pieces"] == 2


def test_numbers_that_occur_alike_have_the_exponent_0():
    """Each from 1 to one less than the grain has, once."""
    table = pd.DataFrame({"fragment_n_monomers": np.tile(np.arange(1, 12), 2), "grain": np.repeat([0, 1], 11)})
    table = table.assign(type="BA", a_eff=1e-7, n_monomers=12, mass_fraction=0.01, half=True)
    assert exponents(table, replicates=5)["exponent"].item() == pytest.approx(0.0, abs=1e-9)


def test_intervals_of_exponents_are_of_grains_and_not_of_fragments():
    """A grain that loses the same piece three times tells no more than one that loses it once."""
    rng = np.random.default_rng(2)
    once = pd.DataFrame({"type": "BA", "a_eff": 1e-7, "grain": np.arange(30), "n_monomers": 50})
    once = once.assign(fragment_n_monomers=rng.integers(1, 20, 30), mass_fraction=0.01, half=True)
    thrice = once.loc[once.index.repeat(3)]
    one, other = (exponents(table, replicates=50).iloc[0][["low", "high"]].tolist() for table in (once, thrice))
    assert other == pytest.approx(one, rel=1e-6)
