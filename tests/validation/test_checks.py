"""The fast part of the checks of `snakemake validation`, and that what they say follows from their tables."""

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from scipy.stats import kstest

import ratd
from ratd.aggregates.growth import grow
from ratd.base.materials import MATERIALS
from ratd.base.statistics import median_of
from ratd.experiments.spin_up.how import EPSILON, TIMESTEP_FACTOR
from ratd.experiments.spin_up.marks import disruption
from ratd.experiments.spin_up.solid import solid_omega, turned_by_spins
from ratd.experiments.spin_up.static_limit import static_limit
from ratd.laws.contact_constants import equilibrium_compression
from ratd.pipeline import io, kinds
from ratd.validation import (
    damping,
    energy,
    energy_step,
    forces,
    frames,
    growth,
    literal,
    mark_rules,
    pull_off,
    quasi_static,
    relaxation,
    theory,
    vibrating_pair,
)
from ratd.validation.free_grain import random_motion
from ratd.validation.plan import EXTENTS, Checks
from ratd.validation.tables import GRAIN_COLUMNS, as_dataset, grain_values, read_tables
from tiny_pipeline import ROOT

CONFIG = ROOT / "config" / "validation.yaml"
SMALL = {"material": "q-S", "type": "BAM2", "a_eff": 60e-9, "seed": 0}


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


def test_pull_off(tmp_path):
    rows = pull_off.compute(
        {"material": "q-S", "pairs": 2, "ratios": [1, 5], "seed": 0, "undamped_steps": [0.05, 0.02]}
        | {start: {"epsilon": 0.05, "timestep_factor": 0.05} for start in ("damped", "undamped")}
    )
    assert len(rows) == 2 * (2 + 4) + 2
    io.write(tmp_path / "a.nc", as_dataset(rows, pull_off.KIND), pull_off.KIND)
    back = read_tables([tmp_path / "a.nc", tmp_path / "a.nc"], pull_off.KIND)
    pd.testing.assert_frame_equal(back, pd.DataFrame(rows + rows)[list(pull_off.COLUMNS)], check_dtype=False)


def test_a_table_with_other_columns_is_refused(tmp_path):
    with pytest.raises(ratd.InputError, match="columns"):
        io.write(tmp_path / "a.nc", as_dataset([{"omega": 1.0}], pull_off.KIND), pull_off.KIND)
    with pytest.raises(ratd.InputError, match="at least one case"):
        io.write(tmp_path / "a.nc", as_dataset([], pull_off.KIND), pull_off.KIND)


def test_columns_and_values_of_a_grain_agree():
    grain = ratd.grow("BA", 60e-9, "q-S", 3)
    values = grain_values(grain)
    assert values.keys() == GRAIN_COLUMNS.keys()
    assert values["seed"] == 3 and values["type"] == "BA" and values["material"] == "q-S"
    assert values["n_monomers"] == len(grain.radius) and values["a_eff"] == pytest.approx(60e-9, rel=1e-9)


def test_random_motion_leaves_the_centre_of_mass_at_rest():
    grain = ratd.grow("BA", 60e-9, "q-S", 3)
    velocity, spin = random_motion(grain, 0.1, 1e6, 1e7)
    assert np.abs(grain.mass @ velocity).max() < 1e-12 * 0.1 * grain.mass.sum()
    assert spin[:, 2].mean() == pytest.approx(1e7, rel=0.1) and np.abs(spin[:, :2].mean(axis=0)).max() < 1e6
    still, _ = random_motion(grain, 0.0, 0.0, 1e7)
    centred = grain.position - grain.mass @ grain.position / grain.mass.sum()
    np.testing.assert_allclose(still, np.cross([0.0, 0.0, 1e7], centred), atol=1e-9)


def test_theory(tmp_path):
    rows = theory.compute(SMALL | {"seeds": 2, "epsilon": 0.2, "timestep_factor": 0.05})
    assert all(0.3 < row["omega_first_loss"] / row["cut_bound"] < 3.0 for row in rows)
    io.write(tmp_path / "a.nc", as_dataset(rows, theory.KIND), theory.KIND)


@pytest.mark.parametrize(("nm", "seed", "above"), [(100, 4, 0.01), (200, 2, 0.05)])
def test_arms_that_swing_outward_come_near_their_static_limit_if_the_spin_up_is_slow(nm, seed, above):
    """By default they come after omega, against the drag of the scheme; the loss itself is hardly moved."""
    grain, found = grow("BA", nm * 1e-9, "q-S", seed), {}
    for name, how in {"usual": {}, "slow": {"pace": 0.0025, "unrest": 0.0025}}.items():
        run, last = theory.followed(grain, **how)
        loss = disruption(run)["omega_first_loss"].item()
        found[name] = loss, loss / static_limit(last, axis=theory.AXIS)
    assert found["usual"][1] > 1.09
    assert 0.99 < found["slow"][1] < 1.0 + above
    assert found["slow"][0] == pytest.approx(found["usual"][0], rel=0.015)


def test_the_mark_is_read_by_every_rule(tmp_path):
    settings = SMALL | {"seeds": 2, "windows": [1, 9], "majorities": [0.75]}
    rows = mark_rules.compute(settings)
    assert [(row["seed"], row["window"], row["majority"]) for row in rows] == [
        (seed, *rule) for seed in (0, 1) for rule in ((5, 0.5), (1, 0.5), (9, 0.5), (5, 0.75))
    ]
    # fewer records belong to the grain where it must hold more of the mass
    assert all(
        stricter["omega_disr"] <= usual["omega_disr"] for usual, stricter in zip(rows[::4], rows[3::4], strict=True)
    )
    io.write(tmp_path / "a.nc", as_dataset(rows, mark_rules.KIND), mark_rules.KIND)


def test_relaxation(tmp_path, monkeypatch):
    """Of these two grains the second has a monomer that touches another by chance."""
    settings = {"material": "q-S", "type": "BAM2", "a_eff": 200e-9, "seeds": 6, "timestep_factor": TIMESTEP_FACTOR}
    rows = relaxation.compute(settings | {"damped": True})[-2:]
    assert [row["n_contacts"] - 3 * row["n_monomers"] for row in rows] == [-6, -5]
    for row in rows:
        assert (row["rested"], row["n_contacts_lost"], row["n_parts"]) == (1, 0, 1)
    assert rows[0]["moved"] < 1e-12 and 1e-5 < rows[1]["moved"] < 1e-2

    monkeypatch.setattr("ratd.experiments.relax.LIMIT", 50)
    said = []
    rows = relaxation.compute(settings | {"damped": False}, progress=said.append)
    (restless,) = said
    assert "seed 5: the grain does not come to rest" in restless
    io.write(tmp_path / "a.nc", as_dataset(rows, relaxation.KIND), relaxation.KIND)


def spread(grain, by=0.0):
    """A grain whose contacts are open: it comes apart as it comes to rest."""
    return SimpleNamespace(**vars(grain) | {"position": 1.05 * grain.position})


@pytest.fixture
def no_grain_holds(monkeypatch):
    for start in ("seated", "pressed"):
        monkeypatch.setattr(f"ratd.experiments.relax.{start}", spread)


@pytest.mark.usefixtures("no_grain_holds")
def test_a_grain_that_comes_apart_has_a_row_without_values():
    said = []
    settings = SMALL | {"seeds": 2, "timestep_factor": TIMESTEP_FACTOR, "damped": True}
    rows = relaxation.compute(settings, progress=said.append)
    assert [(row["seed"], row["rested"], np.isnan(row["moved"])) for row in rows] == [(0, 0, True), (1, 0, True)]
    assert len(said) == 2 and "the aggregate comes apart" in said[0]
    rows = quasi_static.compute(SMALL | {"vary": {"moved": [1]}})
    rows += damping.compute(SMALL | {"viscous_time_ps": [5]})
    rows += damping.compute(SMALL | {"viscous_time_ps": [5], "epsilon": 0.2, "timestep_factor": {"implicit": [0.1]}})
    assert len(rows) == 4
    for row in rows:
        assert row["outcome"].endswith("the aggregate comes apart") and np.isnan(row["omega_disr"])


def test_an_error_of_the_program_is_no_row(monkeypatch):
    def fails(*words, **named):
        raise NotImplementedError("no such thing")

    monkeypatch.setattr(relaxation, "relax", fails)
    with pytest.raises(NotImplementedError):
        relaxation.compute(SMALL | {"seeds": 1, "timestep_factor": TIMESTEP_FACTOR, "damped": True})


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


def uniform_values(rows):
    """Of the arrivals: name -> values, which should be uniform between 0 and 1."""
    table = pd.DataFrame(rows)
    values = {"squared impact parameter": table["impact"]}
    for name in ("direction", "place"):
        x, y, z = (table[f"{name}_{axis}"] for axis in "xyz")
        values |= {f"{name}, z": 0.5 + 0.5 * z, f"{name}, azimuth": 0.5 + np.arctan2(y, x) / (2.0 * np.pi)}
    return values


def test_arrivals_are_uniform():
    """Means of 1/2 and squares of 1/3; a test of the whole distribution with a chance of 1e-6 to fail for bad luck."""
    rows = growth.compute({"material": "q-S", "arrivals": 3000})
    for name, own in uniform_values(rows).items():
        assert len(own) == 3000 and kstest(own, "uniform").pvalue > 1e-6, name
    uneven = pd.DataFrame(rows).assign(impact=lambda table: np.sqrt(table["impact"]))
    assert kstest(uniform_values(uneven)["squared impact parameter"], "uniform").pvalue < 1e-6


@pytest.mark.parametrize(("how", "gap"), [({}, 1e-3), ({"epsilon": 0.05, "timestep_factor": 0.05}, 1e-3)])
def test_energy_put_in_is_stored_or_dissipated(how, gap):
    (row,) = energy.compute({key: SMALL[key] for key in ("material", "a_eff")} | {"type": "BA", "seeds": 1} | how)
    spent = row["work"] - row["kinetic"] - row["potential"]
    dissipated = sum(row[f"dissipated_{mode}"] for mode in energy.MODES)
    assert dissipated > 0.01 * row["work"] and abs(spent - dissipated) < gap * row["work"]
    assert np.isnan(row["epsilon"]) == (not how) and row["worst_to_quarter"] <= row["worst"] < 0.1


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


def test_the_viscous_time_does_more_the_faster_the_spin_up():
    """Contacts that open slowly do not know the damping."""
    rates = {"epsilon": [0.02, 0.2], "viscous_time_ps": [5, 9], "timestep_factor": {"explicit": [0.02]}}
    rows = damping.compute(SMALL | {"material": "a-C"} | rates)
    assert {row["study"] for row in rows} == {damping.RATE} and len(rows) == 4
    marks = pd.DataFrame(rows).set_index(["epsilon", "viscous_time"])["omega_mass_75"]
    slow, fast = (marks[epsilon, 9e-12] / marks[epsilon, 5e-12] - 1.0 for epsilon in (0.02, 0.2))
    assert 0.0 < slow < 0.5 * fast


def test_implicit_damping_tends_to_the_explicit_one_as_the_step_falls(damped_rows):
    """What weakens it falls nearly as fast as the step; the marks go with it."""
    table = pd.DataFrame(damped_rows)
    marks = table[table["viscous_time"] == 5e-12].set_index(["damping", "timestep_factor"])
    marks = marks[["omega_disr", "omega_mass_75"]]
    shift = (marks / marks.loc[("explicit", 0.003)] - 1.0).abs()
    short, long = shift.loc[("implicit", 0.003)], shift.loc[("implicit", 0.03)]
    assert (short < 0.25 * long).all() and (short < 0.02).all() and (long > 0.03).all()


def test_an_elastic_grain_keeps_its_energy_to_second_order_of_the_step():
    rows = energy_step.compute(
        SMALL
        | {"a_eff": 70e-9, "seed": 4, "speed": 0.03, "timestep_factor": [0.0125, 0.025, 0.05, 0.125]}
        | {"steps": 20_000, "steps_at": 0.05, "samples": 40}
    )
    table = pd.DataFrame(rows)
    assert (table["dissipated"] == 0.0).all() and (table["contacts_made"] == 0).all()
    errors = table.groupby("timestep_factor")["error"].apply(lambda error: error.abs().max())
    small = errors[errors.index <= 0.05]
    assert np.polyfit(np.log(small.index), np.log(small), 1)[0] == pytest.approx(2.0, abs=0.2)


def test_frames_agree():
    """A free, turning, vibrating grain in the inertial frame and in one that turns ever faster."""
    rows = frames.compute(
        SMALL | {"type": "BAM1", "a_eff": 90e-9, "seed": 3, "speed": 0.05, "omega": 0.3}
        | {"timestep_factor": [0.025, 0.05, 0.1], "samples": 5}
    )  # fmt: skip
    table = pd.DataFrame(rows)
    assert table["moved"].max() > 0.5 and table["turned"].max() == pytest.approx(1.5, rel=0.01)
    assert table["distance"].max() < 1e-6
    greatest = table.groupby("timestep_factor")["distance"].max()
    assert np.polyfit(np.log(greatest.index), np.log(greatest), 1)[0] > 1.8


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
    assert last["linear"] < 1e-10 and last["angular"] < 1e-10
    assert all(last[f"dissipated_{mode}"] > 0.0 for mode in forces.DISSIPATION)


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
    table = pd.DataFrame(rows)
    true, share = table.loc[0, ["omega_first_loss", "spin_share"]]
    of_literal = table[table["drive"] == "literal"]
    explicit, exact = (of_literal[of_literal["coriolis"] == how] for how in ("explicit", "exact"))
    solid = [solid_omega(true, share, *how)[0] for how in explicit[["angular_acceleration", "timestep"]].values]
    np.testing.assert_allclose(explicit["omega_first_loss"], solid, rtol=0.05)
    parts = (explicit["angular_acceleration"] / explicit["timestep"]) ** (1 / 3) * share / true
    np.testing.assert_allclose(parts, [0.5, 0.5, 0.8, 0.8], rtol=0.01)
    assert len(exact) == 2 and explicit["turned"].isna().all()
    assert (exact["turned"] / true).tolist() == pytest.approx([1.0, 1.0], abs=0.3)


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


def test_plan_names_every_piece_once():
    plan = Checks(CONFIG)
    for extent in EXTENTS:
        assert set(plan.pieces[extent]) == {
            "pull_off", "damping", "literal", "theory", "growth", "energy", "energy_step", "frames",
            "collision_step", "forces", "lammps", "mark_rules", "relaxation", "compression", "dense", "box_at_rest",
            "spring_back", "quasi_static", "remnant",
        }  # fmt: skip
        for check, pieces in plan.pieces[extent].items():
            assert pieces and kinds.kind_of(f"validation_{check}")
    for name, piece in plan.pieces["full"]["energy"].items():
        how = {"epsilon": EPSILON[piece["type"]], "timestep_factor": TIMESTEP_FACTOR}
        assert {key: piece[key] for key in how if key in piece} == ({} if name.startswith("waiting") else how)
    printed = plan.pieces["full"]["literal"]
    assert len({(piece["type"], piece["a_eff"], piece["seed"]) for piece in printed.values()}) == len(printed) >= 8


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("full: {colour: {}}", "colour"),
        ("full: {theory: {material: q-S, seeds: 1, types: [BA], sizes_nm: 100}}", "of the wrong kind"),
        ("full: [theory]", "of the wrong kind"),
    ],
)
def test_plan_names_what_is_wrong(tmp_path, text, said):
    path = tmp_path / "validation.yaml"
    production = "{epsilon: {BA: 0.02}, timestep_factor: 0.1}"
    path.write_text(f"results: x\n{text}\nquick: {{}}\nproduction: {production}\n")
    with pytest.raises(ratd.InputError, match=said) as error:
        Checks(path)
    assert "validation.yaml" in str(error.value) and "\n" not in str(error.value)
