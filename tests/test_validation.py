"""The fast part of the checks of `snakemake validation`, and that what they say follows from their tables."""

from importlib import import_module
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from ratd.validation.show import convergence as show_convergence
from ratd.validation.show import damping as show_damping
from ratd.validation.show import energy as show_energy
from ratd.validation.show import energy_step as show_energy_step
from ratd.validation.show import forces as show_forces
from ratd.validation.show import frames as show_frames
from ratd.validation.show import growth as show_growth
from ratd.validation.show import literal as show_literal
from ratd.validation.show import pull_off as show_pull_off
from ratd.validation.show import relaxation as show_relaxation
from ratd.validation.show import theory as show_theory
from ratd.validation.show.report import SHOWN, report, section
from scipy.stats import kstest

import ratd
from ratd.aggregates.growth import grow
from ratd.base.markdown import markdown_table, measured, measured_range
from ratd.base.materials import MATERIALS
from ratd.base.statistics import mean_of, median_of
from ratd.drives.rotating import angular_velocity, make_drive
from ratd.experiments.spin_up.run import EPSILON, TIMESTEP_FACTOR
from ratd.experiments.spin_up.solid import solid_omega, turned_by_spins
from ratd.laws.contact_constants import equilibrium_compression
from ratd.pipeline import schema
from ratd.pipeline.provenance import provenance
from ratd.validation import (
    convergence,
    damping,
    energy,
    energy_step,
    forces,
    frames,
    free_grain,
    growth,
    literal,
    pull_off,
    relaxation,
    theory,
    vibrating_pair,
)
from ratd.validation import data as kept
from ratd.validation.plan import EXTENTS, Plan
from ratd.validation.tables import GRAIN_COLUMNS, grain_values, read_tables, write_table

ROOT = Path(__file__).parents[1]
CONFIG = ROOT / "config" / "validation.yaml"
SMALL = {"material": "q-S", "type": "BAM2", "a_eff": 60e-9, "seed": 0}


def works(show, rows):
    """Draw and tell a table; the section in words."""
    table = pd.DataFrame(rows)
    assert show.draw(table).axes
    text = show.tell(table)
    assert text.startswith("## ") and "| --- |" in text
    return text


@pytest.mark.parametrize(("a_1", "a_2"), [(10e-9, 10e-9), (80e-9, 80e-9), (10e-9, 100e-9), (30e-9, 100e-9)])
@pytest.mark.parametrize("material", ["a-C", "q-S", "co-S"])
def test_a_pair_parts_where_the_force_is_that_of_pull_off(a_1, a_2, material):
    material = MATERIALS[material]
    omega = pull_off.parting_omega(a_1, a_2, material, epsilon=0.0005, timestep_factor=0.05)
    assert omega == pytest.approx(pull_off.force_controlled_omega(a_1, a_2, material), rel=0.01)


@pytest.mark.parametrize(("a_1", "a_2"), [(10e-9, 10e-9), (40e-9, 40e-9), (30e-9, 100e-9)])
def test_an_undamped_pair_from_first_touch_parts_where_its_vibration_reaches_the_barrier(a_1, a_2):
    """Engine, integration of the distance alone, and conservation of the action, at a step where they agree."""
    material, epsilon = MATERIALS["q-S"], 0.05
    adiabatic = vibrating_pair.adiabatic_omega(a_1, a_2, material)
    vibrating = vibrating_pair.vibrating_omega(a_1, a_2, material, epsilon)
    omega = pull_off.parting_omega(a_1, a_2, material, epsilon=epsilon, timestep_factor=0.05, damped=False)
    assert vibrating == pytest.approx(adiabatic, rel=0.015)
    assert omega == pytest.approx(vibrating, rel=0.005)
    assert adiabatic < pull_off.eq35_omega(a_1, a_2, material)


def test_action_of_small_vibrations_is_that_of_the_harmonic_oscillator():
    """J = 2 pi E/frequency with the stiffness 1.2 F_C/delta_0 (Eqs. 9 and 12)."""
    pair = vibrating_pair.Pair.of(20e-9, 50e-9, MATERIALS["q-S"])
    s = 1.0 - 1e-4
    energy = pair.potential(s, 0.0) - pair.potential(1.0, 0.0)
    assert pair.action(s, 0.0) == pytest.approx(2 * np.pi * energy / pair.frequency, rel=1e-3)


def test_solutions_for_equal_monomers_are_those_of_the_paper():
    material, a = MATERIALS["co-S"], 50e-9
    mass = 4 / 3 * np.pi * a**3 * material.density
    gamma = material.surface_energy
    assert pull_off.force_controlled_omega(a, a, material) == pytest.approx(np.sqrt(3 * np.pi * gamma / (2 * mass)))
    assert pull_off.eq35_omega(a, a, material) == pytest.approx(np.sqrt(5 * np.pi * gamma / (6 * mass)))


def test_pull_off_is_drawn_and_told(tmp_path):
    rows = pull_off.compute(
        {"material": "q-S", "pairs": 2, "ratios": [1, 5], "seed": 0, "undamped_steps": [0.05, 0.02]}
        | {start: {"epsilon": 0.05, "timestep_factor": 0.05} for start in ("damped", "undamped")}
    )
    assert len(rows) == 2 * (2 + 4) + 2
    text = works(show_pull_off, rows)
    assert "undamped" in text and "f = 0.02" in text
    write_table(tmp_path / "a.nc", rows, pull_off.KIND, {})
    back = read_tables([tmp_path / "a.nc", tmp_path / "a.nc"], pull_off.KIND)
    pd.testing.assert_frame_equal(back, pd.DataFrame(rows + rows)[list(pull_off.COLUMNS)], check_dtype=False)


def test_a_table_with_other_columns_is_refused(tmp_path):
    with pytest.raises(ratd.InputError, match="columns"):
        write_table(tmp_path / "a.nc", [{"omega": 1.0}], pull_off.KIND, {})
    with pytest.raises(ratd.InputError, match="at least one case"):
        write_table(tmp_path / "a.nc", [], pull_off.KIND, {})


def test_columns_and_values_of_a_grain_agree():
    grain = ratd.grow("BA", 60e-9, "q-S", 3)
    values = grain_values(grain)
    assert values.keys() == GRAIN_COLUMNS.keys()
    assert values["seed"] == 3 and values["type"] == "BA" and values["material"] == "q-S"
    assert values["n_monomers"] == len(grain.radius) and values["a_eff"] == pytest.approx(60e-9, rel=1e-9)


def test_a_free_grain_that_does_not_go_on_is_named():
    grain = ratd.grow("BA", 60e-9, "q-S", 3)
    state = free_grain.state_of(grain)
    free_grain.go_on(state, grain, 5, 0.02)
    with pytest.raises(RuntimeError, match="BA 3 did not go on at f = 0.02"):
        free_grain.go_on(state, grain, 4, 0.02)


@pytest.fixture(scope="module")
def convergence_rows():
    return convergence.compute(
        SMALL
        | {
            "production_timestep_factor": 0.05,
            "epsilon": [0.5, 0.1],
            "step_epsilon": 0.2,
            "timestep_factor": {"implicit": [0.02, 0.1], "explicit": [0.02, 0.6]},
            "xi_c_nm": [0.2, 6.4],
            "viscous_time_ps": [1, 5, 9],
        }
    )


def test_convergence_of_one_grain(convergence_rows):
    table = pd.DataFrame(convergence_rows)
    text = works(show_convergence, convergence_rows)
    assert "Greatest epsilon up to which no run broke down" in text
    step = show_convergence.ratios(table, "timestep_factor")
    implicit = step[step["damping"] == "implicit"]
    np.testing.assert_allclose(implicit["omega_first_loss"], 1.0, atol=0.05)
    assert step[(step["damping"] == "explicit") & (step["x"] == 0.6)]["broken"].all()
    assert not show_convergence.ratios(table, "xi_c", 0.2e-9)["broken"].any()
    laws = table[table["study"] == "law"].set_index("law")
    assert laws.loc["exponential", "omega_first_loss"] == pytest.approx(
        laws.loc["constant-epsilon", "omega_first_loss"], rel=0.1
    )
    times = show_convergence.ratios(table, "T_vis", 5e-12).set_index("x")["omega_first_loss"]
    assert times.loc[1e-12] < 1.0 < times.loc[9e-12]


def epsilon_row(study, seed, epsilon, omega, a_eff=1e-7, kind="BA"):
    """A run of the convergence check with all marks at omega."""
    row = {name: "" if not units else np.nan for name, (units, _) in convergence.COLUMNS.items()}
    row |= dict(study=study, material="q-S", type=kind, damping="implicit", outcome="one contact left")
    row |= dict(a_eff=a_eff, seed=seed, epsilon=epsilon, timestep_factor=0.05)
    return row | {name: omega for name in convergence.MARKS}


def test_ratios_are_to_the_finest_run_of_the_same_grain():
    rows = []
    for seed, scale in ((0, 1e7), (1, 3e7)):
        for epsilon, shift in ((0.01, 1.0), (0.1, 1.02), (1.0, 1.5)):
            rows.append(epsilon_row("epsilon", seed, epsilon, scale * shift))
    table = show_convergence.ratios(pd.DataFrame(rows), "epsilon")
    statistics = show_convergence.summary(table, "omega_disr")
    np.testing.assert_allclose([entry["median"] for entry in statistics], [1.0, 1.02, 1.5])
    assert show_convergence.coarsest(statistics) == 0.1
    assert show_convergence.coarsest(statistics, goal=0.6) == 1.0
    assert np.isnan(show_convergence.coarsest(statistics[2:]))


@pytest.mark.parametrize("study", convergence.EPSILON_ALONE)
def test_a_grain_for_slow_spin_ups_is_spun_up_with_its_own_epsilon_alone(study):
    settings = SMALL | {"production_timestep_factor": 0.1, study: [0.2, 0.1]}
    rows = convergence.compute(settings)
    assert [(row["study"], row["epsilon"]) for row in rows] == [(study, 0.2), (study, 0.1)]
    assert all(row["omega_first_loss"] > 0.0 for row in rows)


def test_slow_spin_ups_have_tables_of_their_own(convergence_rows):
    """Each cell is compared with its own slowest run, and judged at the epsilon of its type."""
    fine = [
        epsilon_row("epsilon_fine", seed, epsilon * EPSILON[kind], omega, 3e-7, kind)
        for kind in ("BA", "BAM1")
        for seed in range(3)
        for epsilon, omega in ((0.5, 1.0), (1, 1.0625 if kind == "BA" else 1.015625), (2, 1.125))  # exact in binary
    ]
    without = show_convergence.tell(pd.DataFrame(convergence_rows))
    text = works(show_convergence, convergence_rows + fine)
    assert "epsilon of production is another" not in without and "6 grains that show it" in text
    words = text.split("\n\n")
    # but for what is said of the epsilon of production nothing else has changed
    judged = ("No run has the epsilon of production.", "If all shifts go with", "| type | omega_disr |")
    assert all(word.startswith(judged) for word in set(without.split("\n\n")) - set(words))
    for mark in show_convergence.IN_CELLS:
        head = words.index(f"{mark} by type and size:", words.index(next(w for w in words if "6 grains" in w)))
        assert "| BA | 300 | 3 | – | – | 1 | 1.06 | 1.12 |" in words[head + 1]
        assert "| BAM1 | 300 | 3 | 1 | 1.02 | 1.12 | – | – |" in words[head + 1]
    assert "| BA | 0.02 | 3 | 1.06, off | 1.06, off | 1.06, off |" in text
    assert "| BAM1 | 0.005 | 3 | 1.02, within | 1.02, within | 1.02, within |" in text


def test_large_grains_tell_how_fast_the_spin_up_is_where_they_lose_mass(convergence_rows):
    """omega below 0.7 of the bound by 2: d omega/dt there is that of the law, 8 times epsilon omega^2."""
    drive = make_drive("prescribed", omega_1=0.7e8, epsilon=EPSILON["BAM1"])
    times = np.linspace(0.0, 1.0, 4001) / (drive.epsilon * drive.omega_1)
    omega, domega = np.array([angular_velocity(drive, time) for time in times]).T
    for part in (0.35, 0.5, 0.7, 0.9):
        k = np.searchsorted(omega, part * 1e8)
        own = domega[k] / (drive.epsilon * omega[k] ** 2)
        assert show_convergence.haste(part) == pytest.approx(own, rel=5e-3)
    large = [
        epsilon_row("epsilon_large", seed, epsilon, omega, 4.5e-7, "BAM1") | {"cut_bound": 2 / 0.7}
        for seed in range(3)
        for epsilon, omega in ((0.0025, 0.9375), (0.005, 1.0))
    ]
    text = works(show_convergence, convergence_rows + large)
    without = show_convergence.tell(pd.DataFrame(convergence_rows)).split("\n\n")
    assert set(without) <= set(text.split("\n\n"))
    assert "3 large grains at the epsilon of production" in text
    assert "| BAM1 | 450 | q-S | 3 | 0.0025 | 0.35 | 8 | 1.07 | 1.07 | 1.07 | " in text


def test_shift_from_the_limit_is_that_of_the_law_it_is_made_with():
    power, slope = show_convergence.LAG_POWER, 0.8
    rows = [
        epsilon_row("epsilon_fine", seed, epsilon, (1 + seed) * 1e7 * (1 + slope * epsilon**power), kind="BAM1")
        for seed in range(4)
        for epsilon in (0.001, 0.002, 0.004)
    ]
    rows += [epsilon_row("epsilon_fine", 4, epsilon, np.nan, kind="BAM1") for epsilon in (0.001, 0.002)]  # not known
    found = show_convergence.shift_from_limit(show_convergence.ratios(pd.DataFrame(rows), "epsilon_fine"), "omega_disr")
    assert found["median"] == pytest.approx(slope * EPSILON["BAM1"] ** power, rel=0.02) and found["n"] == 4


@pytest.mark.parametrize(
    ("median", "error", "word"),
    [(1.01, 0.01, "within"), (0.99, 0.03, "open"), (1.04, 0.02, "open"), (0.9, 0.02, "off"), (1.0, np.nan, "within")],
)
def test_a_median_is_judged_together_with_its_error(median, error, word):
    assert show_convergence.within({"median": median, "error": error}, 0.03) == word


def test_theory(tmp_path):
    rows = theory.compute(SMALL | {"seeds": 2, "epsilon": 0.2, "timestep_factor": 0.05})
    assert all(0.3 < row["omega_first_loss"] / row["cut_bound"] < 3.0 for row in rows)
    assert "2 grains" in works(show_theory, rows)
    write_table(tmp_path / "a.nc", rows, theory.KIND, {})


def test_relaxation(tmp_path, monkeypatch):
    """Of these two grains the second has a monomer that touches another by chance."""
    settings = {"material": "q-S", "type": "BAM2", "a_eff": 200e-9, "seeds": 6, "timestep_factor": TIMESTEP_FACTOR}
    rows = relaxation.compute(settings | {"damped": True})[-2:]
    assert [row["n_contacts"] - 3 * row["n_monomers"] for row in rows] == [-6, -5]
    for row in rows:
        assert (row["rested"], row["n_contacts_lost"], row["n_parts"]) == (1, 0, 1)
    assert rows[0]["moved"] < 1e-12 and 1e-5 < rows[1]["moved"] < 1e-2
    text = works(show_relaxation, rows)
    assert "All of them come to rest." in text and "| BAM2 | own | 2 | 0 | 1 | 0 | 0 | 0 | 0.00022 (0.00022) |" in text

    monkeypatch.setattr("ratd.experiments.spin_up.run.RELAXATION_LIMIT", 50)
    said = []
    rows = relaxation.compute(settings | {"damped": False}, progress=said.append)
    (restless,) = said
    assert "seed 5: the grain does not come to rest" in restless
    write_table(tmp_path / "a.nc", rows, relaxation.KIND, {})
    text = works(show_relaxation, relaxation.compute(settings | {"damped": True}) + rows)
    assert "2 grains never came to rest: q-S BAM2 200 nm, seed 5; q-S BAM2 200 nm, seed 5 (not damped)." in text
    assert "| BAM2 | none | 6 | 1 | 0 | 0 |" in text


def test_what_relaxation_changes():
    """Of a pair that just touches, and of three monomers of which two come to touch as the others pull them in."""
    a, material = 20e-9, MATERIALS["q-S"]
    delta_0 = equilibrium_compression(a / 2, material.surface_energy, material.reduced_modulus)
    pair = ratd.Grain([[0.0, 0.0, 0.0], [2 * a, 0.0, 0.0]], [a, a], material)
    found = relaxation.rest(pair, TIMESTEP_FACTOR)
    assert found["moved"] == pytest.approx(0.5 * delta_0 / a, rel=0.01)
    own = 2 * 0.4 * a**2
    assert found["inertia"] == pytest.approx((2 * (a - delta_0 / 2) ** 2 + own) / (2 * a**2 + own), rel=1e-4)

    apart = 2 * a + 0.3 * delta_0
    top = np.sqrt((2 * a) ** 2 - (apart / 2) ** 2)
    three = ratd.Grain([[0.0, 0.0, 0.0], [apart, 0.0, 0.0], [apart / 2, top, 0.0]], [a] * 3, material)
    found = relaxation.rest(three, TIMESTEP_FACTOR)
    assert [found[name] for name in ("n_contacts", "n_contacts_made", "n_contacts_lost", "n_parts")] == [2, 1, 0, 1]


def test_growth():
    rows = growth.compute({"material": "q-S", "type": "BAM2", "monomers": 32, "seeds": 8})
    assert [row["migration"] for row in rows] == ["random"] * 8 + ["nearest"] * 8
    assert np.mean([row["porosity"] for row in rows[8:]]) == pytest.approx(0.46, abs=0.04)
    assert all(row["n_contacts"] >= 3 * 32 - 6 for row in rows)
    assert all(row["square_x"] + row["square_y"] + row["square_z"] == pytest.approx(1.0) for row in rows)
    text = works(show_growth, rows)
    value, error = mean_of([row["porosity"] for row in rows[8:]])  # those that the independent generator has
    assert f"| BAM2 | 32 | 8 | {measured(value, error)} | 0.46 ± 0.01 |" in text
    assert "| BAM2 | 16 |" not in works(show_growth, rows + [row | {"n_monomers": 16} for row in rows])


def test_the_depth_of_monomers_is_told_by_their_ranks():
    radius = np.sort(np.random.default_rng(5).uniform(10e-9, 60e-9, 60))
    side = np.where(np.arange(60) % 2, 1, -1)  # to both sides of the centre of mass by turns
    place = np.outer(np.arange(60.0) * side, [1.0, 0.0, 0.0])
    outside = SimpleNamespace(position=place, radius=radius)
    assert growth.depth_correlation(outside) > 0.99
    moved = SimpleNamespace(position=place + [5.0, -3.0, 2.0], radius=radius)
    assert growth.depth_correlation(moved) == pytest.approx(growth.depth_correlation(outside))
    assert growth.depth_correlation(SimpleNamespace(position=place, radius=radius[::-1])) < -0.9
    rows = growth.compute({"material": "q-S", "type": "BA", "a_eff": 150e-9, "seeds": 2, "migration": "random"})
    assert [(row["migration"], row["seed"]) for row in rows] == [("none", 0), ("none", 1)]
    own = grow("BA", 150e-9, "q-S", 1)
    assert rows[1]["porosity"] == own.shape.porosity and rows[1]["depth_correlation"] == growth.depth_correlation(own)
    assert [rows[1][f"axis_{name}"] for name in "abc"] == [own.shape.a, own.shape.b, own.shape.c]
    assert (rows[1]["material"], rows[1]["type"], rows[1]["a_eff"]) == ("q-S", "BA", pytest.approx(150e-9, rel=1e-9))


def test_both_ways_to_migrate_stand_beside_the_printed_radius():
    grains = {"material": "q-S", "type": "BAM1", "a_eff": 200e-9, "seeds": 6}
    rows = [row for how in ("random", "nearest") for row in growth.compute(grains | {"migration": how})]
    assert [row["migration"] for row in rows] == ["random"] * 6 + ["nearest"] * 6
    aggregates = growth.compute({"material": "q-S", "type": "BA", "monomers": 32, "seeds": 2})
    porosity = [grow("BAM1", 200e-9, "q-S", 0, migration=how).shape.porosity for how in ("random", "nearest")]
    assert [rows[0]["porosity"], rows[6]["porosity"]] == porosity and porosity[0] != porosity[1]
    table = pd.DataFrame(rows).assign(enclosing_radius=np.tile([400e-9, 500e-9], 6), porosity=np.repeat([0.6, 0.75], 6))
    text = works(show_growth, table.to_dict("records") + aggregates)
    assert text.count("| 457.4 | 450 (400–500) | 3 | 0.7 |") == 2
    assert "BAM1 nearest, 1 and 0 of 1; BAM1 random, 1 and 1 of 1." in text
    other = table.assign(enclosing_radius=500e-9, a_eff=210e-9).to_dict("records")
    assert "BAM1" not in works(show_growth, other + aggregates)


def test_arrivals_are_uniform():
    """Means of 1/2 and squares of 1/3; a test of the whole distribution with a chance of 1e-6 to fail for bad luck."""
    rows = growth.compute({"material": "q-S", "arrivals": 3000})
    values = show_growth.uniform_values(pd.DataFrame(rows))
    assert len(values) == len(show_growth.UNIFORM)
    for name, own in values.items():
        assert len(own) == 3000 and kstest(own, "uniform").pvalue > 1e-6, name
    aggregates = growth.compute({"material": "q-S", "type": "BA", "monomers": 32, "seeds": 2})
    assert "squared impact parameter" in works(show_growth, rows + aggregates)


def test_uneven_arrivals_are_noticed():
    table = pd.DataFrame(growth.compute({"material": "q-S", "arrivals": 3000}))
    uneven = show_growth.uniform_values(table.assign(impact=np.sqrt(table["impact"])))
    assert kstest(uneven["squared impact parameter"], "uniform").pvalue < 1e-6


def test_energy_put_in_is_stored_or_dissipated():
    rows = energy.compute(SMALL | {"type": "BA", "epsilon": 0.05, "timestep_factor": 0.05})
    table = pd.DataFrame(rows)
    gap = show_energy.gap(table)
    assert abs(gap.iloc[-1]) < 0.01 * table["work"].iloc[-1]
    works(show_energy, rows)


@pytest.fixture(scope="module")
def damped_rows():
    """A grain with 5 and 9 ps, its damping less and less resolved."""
    ways = {"implicit": [0.003, 0.03], "explicit": [0.003]}
    settings = {"material": "a-C", "epsilon": 0.2, "viscous_time_ps": [5, 9], "timestep_factor": ways}
    return damping.compute(SMALL | settings)


def test_damping_is_run_with_every_time_treatment_and_step(damped_rows):
    table = pd.DataFrame(damped_rows)
    found = set(table[["damping", "timestep_factor"]].itertuples(index=False, name=None))
    assert found == {("implicit", 0.003), ("implicit", 0.03), ("explicit", 0.003)} and len(table) == 6
    assert set(table["viscous_time"]) == {5e-12, 9e-12} and (table["outcome"] == "one contact left").all()
    text = works(show_damping, damped_rows)
    assert "1 grain of 60 nm, a-C" in text and "explicit at f = 0.003" in text


def test_the_viscous_time_does_more_the_faster_the_spin_up(damped_rows):
    """Contacts that open slowly do not know the damping."""
    rates = {"epsilon": [0.02, 0.2], "viscous_time_ps": [5, 9], "timestep_factor": {"explicit": [0.02]}}
    rows = damping.compute(SMALL | {"material": "a-C"} | rates)
    assert {row["study"] for row in rows} == {damping.RATE} and len(rows) == 4
    found = show_damping.rise_by_rate(pd.DataFrame(rows))
    slow, fast = (found[epsilon]["omega_mass_75"]["median"] - 1.0 for epsilon in (0.02, 0.2))
    assert 0.0 < slow < 0.5 * fast
    text = works(show_damping, damped_rows + rows)
    assert "By the rate, with the damping resolved (explicit, f = 0.02), from 5 to 9 ps." in text
    assert "By the rate" not in show_damping.tell(pd.DataFrame(damped_rows))


def test_implicit_damping_tends_to_the_explicit_one_as_the_step_falls(damped_rows):
    """What weakens it falls nearly as fast as the step; the marks go with it."""
    marks = show_damping.over_finest(pd.DataFrame(damped_rows)).set_index(["damping", "timestep_factor"])
    shift = (marks[["omega_disr", "omega_mass_75"]] - 1.0).abs()
    assert (shift.loc[("explicit", 0.003)] == 0.0).all()
    short, long = shift.loc[("implicit", 0.003)], shift.loc[("implicit", 0.03)]
    assert (short < 0.25 * long).all() and (short < 0.02).all() and (long > 0.03).all()


def test_the_rise_with_the_viscous_time_is_taken_grain_by_grain_and_way_by_way(damped_rows):
    """Three grains whose marks are set by hand; of one, a run breaks down."""
    rows = [
        row | {"seed": seed, "omega_disr": level * (1.0 + seed / 100 if row["viscous_time"] > 6e-12 else 1.0)}
        for seed, level in ((1, 1e8), (2, 7e8), (3, 3e8), (6, 2e8))
        for row in damped_rows
    ]
    for row in rows:
        if (row["seed"], row["damping"]) == (6, "explicit") and row["viscous_time"] > 6e-12:
            row |= {"outcome": "failed: it flew", "omega_disr": np.nan}
    table = pd.DataFrame(rows)
    rise = show_damping.over_shorter(table, 5e-12)
    assert len(rise) == 12 and rise["omega_disr"].isna().sum() == 1
    good = rise.dropna(subset="omega_disr")
    assert good["omega_disr"].to_numpy() == pytest.approx(1.0 + good["seed"].to_numpy() / 100)
    resolved = show_damping.resolved_rise(table)["omega_disr"]
    assert (resolved["n"], resolved["median"]) == (3, pytest.approx(1.02))
    text = works(show_damping, rows)
    assert "| BAM2 | explicit | 0.003 | 4 | 1 | 1.02" in text and "so resolved: BAM2 omega_disr 1.02" in text


def test_an_elastic_grain_keeps_its_energy_to_second_order_of_the_step():
    rows = energy_step.compute(
        SMALL
        | {"a_eff": 70e-9, "seed": 4, "speed": 0.03, "timestep_factor": [0.0125, 0.025, 0.05, 0.125]}
        | {"steps": 20_000, "steps_at": 0.05, "samples": 40}
    )
    table = pd.DataFrame(rows)
    assert (table["dissipated"] == 0.0).all() and (table["contacts_made"] == 0).all()
    assert show_energy_step.exponents(table).iloc[0] == pytest.approx(2.0, abs=0.2)
    assert show_energy_step.greatest_errors(table).xs(0.05, level="timestep_factor").max() < 1e-3
    text = works(show_energy_step, rows)
    assert "No run dissipated" in text and "The error stays below" in text and "At the production step" in text
    text = show_energy_step.tell(table[table["timestep_factor"] < show_energy_step.PRODUCTION])
    assert "The error stays below" in text and "At the production step" not in text


def test_frames_agree():
    """A free, turning, vibrating grain in the inertial frame and in one that turns ever faster."""
    rows = frames.compute(
        SMALL | {"type": "BAM1", "a_eff": 90e-9, "seed": 3, "speed": 0.05, "omega": 0.3}
        | {"timestep_factor": [0.025, 0.05, 0.1], "samples": 5}
    )  # fmt: skip
    table = pd.DataFrame(rows)
    assert table["moved"].max() > 0.5 and table["turned"].max() == pytest.approx(1.5, rel=0.01)
    assert table["distance"].max() < 1e-6
    assert show_frames.exponents(table).iloc[0] > 1.8
    works(show_frames, rows)


def test_a_frame_that_turns_otherwise_than_it_says_is_noticed(monkeypatch):
    monkeypatch.setattr(frames, "turned_angle", lambda drive, start, end: drive.acceleration * (end - start) * start)
    rows = frames.compute(
        SMALL | {"type": "BAM1", "a_eff": 90e-9, "seed": 3, "speed": 0.05, "omega": 0.3}
        | {"timestep_factor": [0.1], "samples": 2}
    )  # fmt: skip
    assert rows[-1]["distance"] > 0.1


def test_forces_are_derivatives_of_the_potentials_and_momenta_are_kept():
    rows = forces.compute(
        {"material": "q-S", "contacts": 10, "seed": 2, "types": ["BAM1"], "a_eff": 110e-9, "speed": 1.0}
        | {"timestep_factor": 0.02, "steps": 100_000, "samples": 4}
    )
    table = pd.DataFrame(rows)
    modes = table[table["study"] == "derivative"].groupby("mode")[["force", "torque", "reaction"]]
    assert (modes.max()[["force", "torque"]].max() < 1e-6).all() and modes.max()["reaction"].max() < 1e-12
    count = modes.count()
    assert (count.loc[["normal", "sliding"], "force"] == 10).all() and count.loc["rolling", "force"] == 0
    assert (count.loc[["sliding", "rolling", "twisting"], "torque"] == 10).all() and count.loc["normal", "torque"] == 0
    last = rows[-1]
    assert last["step"] == 100_000 and last["linear"] < 1e-10 and last["angular"] < 1e-10
    assert all(last[f"dissipated_{mode}"] > 0.0 for mode in forces.DISSIPATION)
    works(show_forces, rows)


def test_a_force_that_is_no_derivative_is_noticed(monkeypatch):
    right = forces.engine_forces
    monkeypatch.setattr(forces, "engine_forces", lambda *a: tuple(value * (1 + 1e-5) for value in right(*a)))
    rng = np.random.default_rng(1)
    rows = forces.deviations(forces.random_contact(MATERIALS["q-S"], rng, 3.0), MATERIALS["q-S"])
    assert min(row["torque"] for row in rows[1:]) > 5e-6 and rows[0]["force"] > 5e-6


def test_the_spins_share_of_a_pair():
    """Two equal spheres that touch: 2 x 2/5 m a^2 over that and 2 m a^2."""
    a = 20e-9
    pair = ratd.Grain([[-a, 0, 0], [a, 0, 0]], [a, a], "q-S")
    assert pair.shape.spin_share == pytest.approx(0.8 / 2.8, rel=1e-9)


def test_a_solid_grain_under_the_printed_equations():
    """Fourth root, third root, and the spins alone, in units in which d omega/dt = dt = 1."""
    third = [solid_omega(threshold, 1e-9, 1.0, 1.0)[0] for threshold in (1e4, 1e5)]
    assert third[1] == pytest.approx(third[0], rel=1e-3)
    assert solid_omega(1e-5, 1e-9, 1.0, 1.0)[0] == pytest.approx(4e-5**0.25, rel=1e-2)
    omega, backwards = solid_omega(1e-3, 0.2, 1.0, 1.0)
    assert omega == pytest.approx(1e-3 / 0.2, rel=1e-3) and not backwards
    once, backwards = solid_omega(1e8, 0.1, 1e14, 1e-12)
    assert backwards and solid_omega(1e8, 0.1, 3e14, 3e-12)[0] == pytest.approx(once, rel=1e-6)
    assert np.isnan(solid_omega(np.nan, 0.1, 1.0, 1.0)[0])


def test_literal_drive():
    rows = literal.compute(
        {"material": "q-S", "type": "BA", "a_eff": 50e-9, "seed": 0}
        | {"part_of_limit": [0.5, 0.8], "timestep_factor": [0.1, 0.2]}
    )
    assert [row["drive"] for row in rows] == ["prescribed"] + ["literal"] * 6
    runs = show_literal.with_reference(pd.DataFrame(rows))
    explicit = show_literal.torn_backwards(runs, "omega_first_loss")
    assert len(explicit) == 4 and (explicit["coriolis"] == "explicit").all()
    np.testing.assert_allclose(explicit["omega_first_loss"], explicit["solid_omega_first_loss"], rtol=0.05)
    parts = explicit["scale"] * explicit["spin_share"] / explicit["true_omega_first_loss"]
    np.testing.assert_allclose(parts, [0.5, 0.5, 0.8, 0.8], rtol=0.01)
    exact = runs[runs["coriolis"] == "exact"]
    assert len(exact) == 2 and runs.loc[runs["coriolis"] == "explicit", "turned"].isna().all()
    assert exact["turns"].tolist() == pytest.approx([1.0, 1.0], abs=0.3)
    assert (exact["unstretched"] == exact["turns"] * exact["stretched"]).all()
    over = exact["omega_first_loss"] / exact["true_omega_first_loss"]
    assert show_literal.exact_over_consistent(pd.DataFrame(rows)) == (
        (pytest.approx(over.median()),) * 2, pytest.approx((over.min(), over.max()))
    )  # fmt: skip
    works(show_literal, rows)


def test_stretching_explains_only_what_it_changes():
    rows = [
        {"type": kind, "grain": seed, "turns": 1.0 + 0.02 * seed, "unstretched": stretched + 0.02 * seed}
        for kind, stretched in (("BA", 2.0), ("BAM2", 1.01))
        for seed in range(4)
    ]
    found = show_literal._by_type(pd.DataFrame(rows))
    other = "the two numbers agree within two standard errors."
    assert show_literal._why(found) == f"Stretching is why BA grains need more omega; in BAM2 {other}"
    assert show_literal._why({"BAM2": found["BAM2"]}) == f"In BAM2 {other}"


def test_spins_turn_a_grain_slower_as_it_stretches():
    """A grain that only turns has the kinetic energy L Omega/2, with the angular momentum L = I_spin omega."""
    grain = grow("BA", 100e-9, "q-S", 0)
    share = grain.shape.spin_share
    run = ratd.spin_up(grain, drive="literal", coriolis="exact", angular_acceleration=1e15, timestep_factor=0.2)
    first_loss = float(ratd.disruption(run)["omega_first_loss"])
    run = run.isel(record=(run["omega"].values > 0.1 * first_loss) & (run["omega"].values < first_loss))
    rest = {axis: run.attrs[f"initial_axis_{axis}"] for axis in "bc"}
    spin_momentum = share * run.attrs["initial_mass"] / 5.0 * (rest["b"] ** 2 + rest["c"] ** 2) * run["omega"].values
    b, c = (np.append(rest[axis], run[f"axis_{axis}"].values) for axis in "bc")
    turned = turned_by_spins(np.append(0.0, run["omega"].values), share, b, c)[1:]
    ratio = 2.0 * run["kinetic_energy"].values / spin_momentum / turned
    assert np.median(ratio) == pytest.approx(1.0, abs=0.02) and ratio[turned.argmax()] == pytest.approx(1.0, abs=0.02)
    assert turned.max() < share * run["omega"].values[turned.argmax()] / 1.4  # it has stretched


def test_only_what_comes_before_the_first_loss_counts():
    omega = np.array([1e7, 1e8, 2e8, 9e8])
    run = xr.Dataset(
        {name: ("record", values) for name, values in {
            "omega": omega, "axis_b": [1e-7, 1e-7, 3e-7, 1e-7], "axis_c": [2e-7, 2e-7, 4e-7, 2e-7],
        }.items()}
    )  # fmt: skip
    assert literal._fastest(run, 0.1, 8e8) == pytest.approx({"turned": 1e7, "stretched": 1.0})
    assert literal._fastest(run, 0.1, np.nan) == pytest.approx({"turned": 9e7, "stretched": 1.0})
    run["omega"][0] = 0.0
    assert np.isnan(list(literal._fastest(run, 0.1, 5e7).values())).all()


def test_exponents_are_found_in_what_follows_the_law():
    a, dt = (grid.ravel() for grid in np.meshgrid([1e15, 1e16, 1e17], [1e-13, 2e-13, 4e-13]))
    rows = pd.DataFrame({"grain": "x", "angular_acceleration": a, "timestep": dt, "omega": 0.4 * (a / dt) ** (1 / 3)})
    (found,) = show_literal.exponents(rows, "omega")
    np.testing.assert_allclose(found, [1 / 3, -1 / 3], rtol=1e-9)


def test_median_and_its_error():
    rng = np.random.Generator(np.random.PCG64(1))
    values = rng.normal(1.0, 0.1, 400)
    found = median_of(values)
    assert found["median"] == np.median(values) and found["n"] == 400
    assert found["error"] == pytest.approx(1.2533 * 0.1 / 20, rel=0.3)
    assert found["low"] == pytest.approx(0.9, abs=0.03) and found["high"] == pytest.approx(1.1, abs=0.03)
    assert np.isnan(median_of([np.nan])["median"]) and np.isnan(median_of([1.0])["error"])
    together = median_of(np.repeat(values[:20], 20), np.repeat(np.arange(20), 20))
    assert together["error"] > 3 * found["error"]


@pytest.fixture
def theory_pieces(tmp_path):
    """Settings of two pieces, rows of both, and their files, of different source."""
    shared = SMALL | {"seeds": 1, "epsilon": 0.5, "timestep_factor": 0.1}
    pieces = {kind: shared | {"type": kind} for kind in ("BA", "BAM2")}
    paths, rows = [tmp_path / "results" / f"{name}.nc" for name in pieces], []
    for path, settings, source in zip(paths, pieces.values(), ("b", "a"), strict=True):
        rows += theory.compute(settings)
        write_table(path, rows[-1:], theory.KIND, provenance(source, settings))
    return pieces, rows, paths


def test_a_piece_is_kept_as_long_as_it_is_asked_for(tmp_path, theory_pieces):
    pieces, rows, paths = theory_pieces
    folder = tmp_path / "data"
    assert kept.lacking(kept.read_pieces(folder, "theory"), pieces) == ["BA", "BAM2"]
    kept.collect(folder, "theory", paths, pieces)
    assert kept.is_whole(kept.read_pieces(folder, "theory"), pieces)
    table = kept.check_table(folder, "theory")
    pd.testing.assert_frame_equal(table, pd.DataFrame(rows)[list(theory.COLUMNS)], check_dtype=False)
    more, other = pieces | {"BAM1": pieces["BA"]}, pieces | {"BA": pieces["BA"] | {"seed": 1}}
    assert kept.lacking(kept.read_pieces(folder, "theory"), more) == ["BAM1"] and kept.lacking(
        kept.read_pieces(folder, "theory"), other
    ) == ["BA"]
    fewer = {"BA": pieces["BA"]}
    assert kept.lacking(kept.read_pieces(folder, "theory"), fewer) == []
    assert not any(kept.is_whole(kept.read_pieces(folder, "theory"), asked) for asked in (more, other, fewer))
    kept.collect(folder, "theory", [], other)
    assert kept.check_table(folder, "theory")["type"].tolist() == ["BAM2"]
    kept.collect(folder, "theory", paths, pieces)
    kept.collect(folder, "theory", [], fewer)
    assert kept.is_whole(kept.read_pieces(folder, "theory"), fewer) and kept.check_table(folder, "theory")[
        "type"
    ].tolist() == ["BA"]


def test_pieces_collected_one_after_the_other_are_those_collected_at_once(tmp_path, theory_pieces):
    pieces, _, paths = theory_pieces
    kept.collect(tmp_path / "whole", "theory", paths, pieces)
    for path in reversed(paths):
        kept.collect(tmp_path / "parts", "theory", [path], pieces)
    whole, parts = (Path(kept.table_path(tmp_path / name, "theory")) for name in ("whole", "parts"))
    assert parts.read_bytes() == whole.read_bytes()
    whole.write_bytes(whole.read_bytes()[:-100])
    assert kept.lacking(kept.read_pieces(tmp_path / "whole", "theory"), pieces) == list(pieces)


def test_pieces_of_other_settings_are_refused(tmp_path, theory_pieces):
    pieces, _, paths = theory_pieces
    with pytest.raises(ratd.FileError, match="BAM2.nc: was made with other settings"):
        kept.collect(tmp_path / "data", "theory", paths, pieces | {"BAM2": pieces["BA"]})
    assert not (tmp_path / "data").exists()


def test_the_folder_says_what_it_holds_and_holds_nothing_else(tmp_path, theory_pieces):
    pieces, _, paths = theory_pieces
    folder = tmp_path / "data"
    kept.collect(folder, "theory", paths, pieces)
    (folder / "old.nc").write_text("not asked for")
    kept.finish(folder, {"theory": pieces}, "make it")
    text = (folder / "README.md").read_text()
    assert "make it" in text and "| `theory.nc` | 2 of 2 | 2 | a; b |" in text and str(tmp_path) not in text
    assert {path.name for path in folder.iterdir()} == {"README.md", "theory.nc"}


def test_the_document_needs_whole_tables(tmp_path, theory_pieces):
    pieces, rows, paths = theory_pieces
    folder, checks = tmp_path / "data", {"theory": pieces}
    kept.collect(folder, "theory", paths[:1], pieces)
    kept.finish(folder, checks, "make it")
    assert "| `theory.nc` | 1 of 2 | 1 | b |" in (folder / "README.md").read_text()
    with pytest.raises(ratd.InputError, match="lacks the table of theory as"):
        report(folder, kept.whole_tables(folder, checks), "pictures", "make it")
    kept.collect(folder, "theory", paths[1:], pieces)
    text = report(folder, kept.whole_tables(folder, checks), "pictures", "make it")
    assert "make it" in text
    assert text.endswith(section("theory", show_theory.tell(pd.DataFrame(rows)), "pictures/theory.png"))


def test_the_committed_document_says_what_its_tables_give(monkeypatch):
    monkeypatch.chdir(ROOT)
    tables = kept.whole_tables(kept.FOLDER, Plan(CONFIG).pieces["full"])
    text = report(kept.FOLDER, tables, "validation", "snakemake --cores 2 validation_report")
    assert text == (ROOT / "docs" / "validation.md").read_text()


def test_every_check_is_shown():
    assert set(SHOWN) == set(Plan(CONFIG).pieces["full"])


def test_numbers_in_words():
    assert measured(1.01349, 0.0241) == "1.013 ± 0.024"
    assert measured(123.4, 20.0) == "123 ± 20"
    assert measured_range(median_of([1.0, 2.0, 3.0])).endswith(" (1.32–2.68)") and measured_range(median_of([])) == "–"
    assert measured(0.5, np.nan) == "0.5" and measured(np.nan, 1.0) == "–"
    assert measured(0.35, 5e-17) == "0.35"  # the rounding of equal values
    assert markdown_table(["a", "b"], [[1, 2]]).splitlines() == ["| a | b |", "| --- | --- |", "| 1 | 2 |"]


def test_plan_names_every_piece_once():
    plan = Plan(CONFIG)
    for extent in EXTENTS:
        assert set(plan.pieces[extent]) == {
            "convergence", "pull_off", "damping", "literal", "theory", "growth", "energy", "energy_step", "frames",
            "forces", "lammps", "relaxation",
        }  # fmt: skip
        for check, pieces in plan.pieces[extent].items():
            assert pieces and import_module(f"ratd.validation.{check}").KIND in schema.KINDS
    full = plan.pieces["full"]["convergence"]
    assert full["q-S_BAM2_150nm_3"]["a_eff"] == pytest.approx(150e-9) and full["q-S_BAM2_150nm_3"]["seed"] == 3
    assert {piece["type"] for piece in full.values()} == {"BA", "BAM1", "BAM2"}
    fine = full["fine_BAM1_300nm_2"]
    assert fine["a_eff"] == pytest.approx(300e-9) and fine["epsilon_fine"] and "step_epsilon" not in fine
    assert full["large_BAM1_450nm_2"] | {"epsilon_large": None} == {
        "production_timestep_factor": TIMESTEP_FACTOR, "material": "co-S", "epsilon_large": None, "type": "BAM1",
        "a_eff": pytest.approx(450e-9), "seed": 2,
    }  # fmt: skip
    for check in ("theory", "energy"):
        for piece in plan.pieces["full"][check].values():
            assert (piece["epsilon"], piece["timestep_factor"]) == (EPSILON[piece["type"]], TIMESTEP_FACTOR)
    printed = plan.pieces["full"]["literal"]
    assert len({(piece["type"], piece["a_eff"], piece["seed"]) for piece in printed.values()}) == len(printed) >= 8


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("docs: quick\nfull: {colour: {}}", "colour"),
        ("docs: quick\nfull: {theory: {material: q-S, seeds: 1, types: [BA], sizes_nm: 100}}", "of the wrong kind"),
        ("docs: quick\nfull: [theory]", "of the wrong kind"),
        ("docs: fast\nfull: {}", "docs is 'fast'; allowed: full, quick"),
    ],
)
def test_plan_names_what_is_wrong(tmp_path, text, said):
    path = tmp_path / "validation.yaml"
    production = "{epsilon: {BA: 0.02}, timestep_factor: 0.1}"
    path.write_text(f"results: x\n{text}\nquick: {{}}\nproduction: {production}\n")
    with pytest.raises(ratd.InputError, match=said) as error:
        Plan(path)
    assert "validation.yaml" in str(error.value) and "\n" not in str(error.value)
