"""The check against LAMMPS: the mapping of constants, both codes on pairs and a small grain, and what is told of it."""

import sys
from dataclasses import replace

import numpy as np
import pytest

import ratd
from peer import needs_lammps
from ratd.base.materials import MATERIALS
from ratd.engine.layout import VX, WX, X
from ratd.engine.leapfrog import leapfrog
from ratd.engine.state import monomer_rows, new_state
from ratd.experiments.relax import relax
from ratd.experiments.spin_up.cut_bound import cut_bound
from ratd.geometry.box import open_space
from ratd.laws.contact_constants import (
    equilibrium_compression,
    equilibrium_contact_radius,
    pull_off_force,
    reduced_radius,
)
from ratd.laws.jkr_with_springs import jkr
from ratd.laws.johnson_kendall_roberts import COMPRESSION_END, S_PULL_OFF, compression_of
from ratd.pipeline import io
from ratd.validation import lammps, peer_lammps
from ratd.validation.plan import EXTENTS, Checks
from ratd.validation.tables import as_dataset, read_tables
from tiny_pipeline import ROOT

CONFIG = ROOT / "config" / "validation.yaml"


PAIRS = [(20e-9, 20e-9), (10e-9, 100e-9)]


@pytest.mark.parametrize(("a_1", "a_2"), PAIRS)
def test_coefficients_give_the_forces_of_the_model(a_1, a_2):
    material = MATERIALS["co-S"]
    gamma, nu, shear = material.surface_energy, material.poisson_number, material.shear_modulus
    r = a_1 * a_2 / (a_1 + a_2)
    r0 = equilibrium_contact_radius(r, gamma, material.reduced_modulus)
    m_1, m_2 = (4 / 3 * np.pi * a**3 * material.density for a in (a_1, a_2))
    critical = 2 * 3 * np.pi * gamma * r  # |F_N + 2 F_C| at equilibrium
    words = peer_lammps.pair_coefficients(a_1, a_2, material)
    youngs, damping, *rest = words["jkr"]
    assert (youngs, *rest) == (material.youngs_modulus, nu, gamma)
    c = 2 * material.reduced_modulus / nu**2 * r0 * material.viscous_time
    assert damping * m_1 * m_2 / (m_1 + m_2) * r0 == pytest.approx(c)
    slide, none, limit = words["tangential linear_history"]
    assert (slide, none) == (pytest.approx(4 * r0 * shear / (2 - nu)), 0.0)
    assert limit * critical == pytest.approx(shear * r0**2 / (4 * np.pi))
    roll, none, limit = words["rolling sds"]
    assert (roll, none) == (pytest.approx(12 * np.pi * gamma), 0.0)
    assert limit * critical == pytest.approx(12 * np.pi * gamma * material.critical_rolling_displacement)
    twist, none, limit = words["twisting sds"]
    assert (twist, none) == (pytest.approx(8 / 3 * shear * r0**3), 0.0)
    assert limit * critical == pytest.approx(shear * r0**3 / (6 * np.pi))


def test_step_keeps_the_explicit_damping_stable():
    material = MATERIALS["q-S"]
    radius = np.array([10e-9, 50e-9, 30e-9])
    step = peer_lammps.stable_step(radius, material, [[0, 1], [1, 2]], most=1.0)
    m = 4 / 3 * np.pi * radius**3 * material.density
    r0 = equilibrium_contact_radius(reduced_radius(10e-9, 50e-9), material.surface_energy, material.reduced_modulus)
    c = 2 * material.reduced_modulus / material.poisson_number**2 * r0 * material.viscous_time
    assert step < 2.0 / (c / m[0] + c / m[1])
    assert peer_lammps.stable_step(radius, material, [[0, 1], [1, 2]], most=1e-15) == 1e-15
    undamped = replace(material, viscous_time=0.0)
    assert peer_lammps.stable_step(radius, undamped, [[0, 1], [1, 2]], most=1e-12) == 1e-12


def test_missing_lammps_is_one_sentence(monkeypatch):
    monkeypatch.setitem(sys.modules, "lammps", None)
    with pytest.raises(ratd.InputError, match="pip install -r environment-lammps.txt"):
        peer_lammps.load()
    plan = Checks(CONFIG)
    with pytest.raises(ratd.InputError, match="pip install"):
        plan.files("quick", "lammps")
    assert len(plan.files("quick", "growth")) == len(plan.pieces["quick"]["growth"])


@needs_lammps
@pytest.mark.parametrize(("a_1", "a_2"), PAIRS)
@pytest.mark.parametrize("material", ["a-C", "q-S", "co-S"])
def test_normal_force_of_both_codes(a_1, a_2, material):
    material = MATERIALS[material]
    compressions, path = lammps.curve_points(31)
    force = lammps.force_curve(a_1, a_2, material, compressions) / (3 * np.pi * material.surface_energy)
    force /= reduced_radius(a_1, a_2)
    held = np.isfinite(force)
    np.testing.assert_allclose(force[held.all(axis=1)][:, 0], force[held.all(axis=1)][:, 1], atol=1e-9)
    np.testing.assert_allclose(np.nanmin(force, axis=0), -1.0, atol=1e-9)
    # a contact starts at first touch, and ends at the greatest pull in LAMMPS, at the end of the branch in ratd
    withdrawal = np.array(path) == "withdrawal"
    np.testing.assert_array_equal(held[~withdrawal, 0], compressions[~withdrawal] >= 0.0)
    np.testing.assert_array_equal(held[withdrawal, 0], compressions[withdrawal] >= COMPRESSION_END)
    np.testing.assert_array_equal(held[withdrawal, 1], compressions[withdrawal] > compression_of(S_PULL_OFF))
    assert held[~withdrawal, 1].sum() == pytest.approx(held[~withdrawal, 0].sum(), abs=1)


RADII = np.array([30e-9, 50e-9])
# velocities of both spheres (over their share of the mass) and spins times radius, in units of the speed
MODES = {
    "normal": ([[1, 0, 0], [-1, 0, 0]], np.zeros((2, 3))),
    "sliding": ([[0, 1, 0], [0, -1, 0]], np.zeros((2, 3))),
    "rolling": (np.zeros((2, 3)), [[0, 0, 1], [0, 0, -1]]),
    "twisting": (np.zeros((2, 3)), [[1, 0, 0], [-1, 0, 0]]),
}


def move_a_pair(mode, speed, duration, material=MATERIALS["q-S"]):
    """Velocities, and spins times radius, of a pair that starts from equilibrium: at first, from ratd, from LAMMPS.

    All over the speed [m/s] of the start.
    """
    r = reduced_radius(*RADII)
    delta_0 = equilibrium_compression(r, material.surface_energy, material.reduced_modulus)
    position = np.array([[0.0, 0.0, 0.0], [RADII.sum() - delta_0, 0.0, 0.0]])
    velocity, turning = (speed * np.array(value, dtype=float) for value in MODES[mode])
    velocity *= (RADII.min() / RADII[:, None]) ** 3
    spin = turning / RADII[:, None]

    def joined(velocity, spin):
        return np.concatenate([velocity, spin * RADII[:, None]]) / speed

    parts = jkr(), open_space(), leapfrog(timestep_factor=0.001)
    state = new_state(position, RADII, material, np.array([[0, 1]]), *parts)
    grain = lammps.InRatd(state, 0.001)
    rows = monomer_rows(grain._state)
    rows[:, VX : VX + 3], rows[:, WX : WX + 3] = velocity, spin
    grain.advance(duration)
    mine = joined(rows[:, VX : VX + 3], rows[:, WX : WX + 3])
    steps = round(duration / grain.timestep)
    with peer_lammps.Spheres(position, RADII, material, duration / steps) as spheres:
        spheres._atoms("v")[:2], spheres._atoms("omega")[:2] = velocity, spin
        spheres.advance(steps)
        theirs = joined(spheres._atoms("v")[:2], spheres._atoms("omega")[:2])
    return joined(velocity, spin), mine, theirs


@needs_lammps
@pytest.mark.parametrize(
    ("mode", "speed", "duration"),
    [
        ("normal", 0.1, 2e-11),
        ("sliding", 0.1, 4e-11),
        ("sliding", 4.0, 4e-11),
        ("rolling", 0.1, 1e-9),
        ("rolling", 1.0, 1e-9),
        ("twisting", 0.1, 3e-10),
        ("twisting", 20.0, 3e-10),
    ],
)
def test_a_pair_moves_alike_in_both_codes(mode, speed, duration):
    """Springs and damping at low speed, and the limits of the springs at the higher one."""
    start, mine, theirs = move_a_pair(mode, speed, duration)
    change = np.abs(mine - start).max()
    assert change > 0.02
    np.testing.assert_allclose(mine, theirs, atol=0.02 * change)


@needs_lammps
def test_a_pair_rolls_back_in_both_codes_where_rolling_has_no_limit():
    """At a speed at which it would go far beyond the critical displacement."""
    elastic = replace(MATERIALS["q-S"], critical_rolling_displacement=lammps.NO_ROLLING_LIMIT)
    start, mine, theirs = move_a_pair("rolling", 1.0, 1e-9, elastic)
    np.testing.assert_allclose(mine, theirs, atol=0.02 * np.abs(mine - start).max())
    _, limited, _ = move_a_pair("rolling", 1.0, 1e-9)
    assert np.abs(limited - mine).max() > 0.1 * np.abs(mine - start).max()


@needs_lammps
def test_springs_of_lammps_do_not_turn_with_a_pair_about_its_own_line():
    """One of the differences of `peer_lammps`, which decides how whole grains compare in the inertial frame."""
    material, a = MATERIALS["q-S"], 40e-9
    delta_0 = equilibrium_compression(a / 2, material.surface_energy, material.reduced_modulus)
    step, steps = 1e-15, 10
    position = [[0.0, 0.0, 0.0], [0.0, 0.0, 2 * a - delta_0]]
    with peer_lammps.Spheres(position, [a, a], material, step) as spheres:
        spheres._atoms("v")[:2] = [[0.0, 100.0, 0.0], [0.0, -100.0, 0.0]]
        spheres.advance(1)
        spheres._atoms("v")[:2] = 0.0
        spheres.place(position)
        before = spheres.force()
        # so fast that the pair makes a quarter of a turn before the force moves the spheres
        spheres._atoms("omega")[:2] = [0.0, 0.0, 0.5 * np.pi / (step * steps)]
        spheres.advance(steps)
        after = spheres.force()
    assert abs(before[0, 1]) > 1e3 * abs(before[0, 0])
    np.testing.assert_allclose(after, before, atol=0.01 * np.abs(before).max())


@pytest.fixture(scope="module")
def small_grain():
    grain = ratd.grow("BA", 70e-9, "q-S", 1)
    return grain, relax(grain)


def masses_left(grain, state, omega):
    left = {}
    for code, make in (
        ("ratd", lambda: lammps.InRatd(state, 0.05)),
        ("LAMMPS", lambda: lammps.InLammps(state, grain.material)),
        (lammps.TURNING, lambda: lammps.InLammps(state, grain.material, turning=True)),
    ):
        with make() as body:
            body.turn(omega)
            left[code] = lammps.hold(body, omega, 0.5)[1]
    return left


@needs_lammps
@pytest.mark.parametrize(("part", "whole"), [(0.5, True), (1.5, False)])
def test_a_grain_holds_or_comes_apart_in_both_codes(small_grain, part, whole):
    grain, state = small_grain
    before = state.monomer.copy()
    left = masses_left(grain, state, part * cut_bound(grain))
    assert all((mass == pytest.approx(1.0)) == whole for mass in left.values()), left
    np.testing.assert_array_equal(state.monomer, before)


@needs_lammps
def test_unwinding_takes_the_angular_momentum_out(small_grain):
    grain, state = small_grain
    rows = monomer_rows(state)[np.argsort(state.identity)]
    with peer_lammps.Spheres(rows[:, X : X + 3], grain.radius, grain.material, 1e-13) as spheres:
        n = grain.n_monomers
        members = np.arange(n) < n - 1
        spheres.turn(2e7)
        spheres._atoms("v")[:n] += [0.3, -0.2, 0.1]
        before = spheres._atoms("v")[:n].copy()
        spheres.unwind(members)
        # it was a rigid rotation, so that nothing of it is left, and nobody else feels it
        np.testing.assert_allclose(spheres._atoms("omega")[: n - 1], 0.0, atol=1.0)
        velocity = spheres._atoms("v")[: n - 1]
        np.testing.assert_allclose(velocity, velocity[[0]] * np.ones((n - 1, 1)), atol=1e-9)
        np.testing.assert_array_equal(spheres._atoms("v")[n - 1], before[-1])
        mass = grain.mass[: n - 1]
        np.testing.assert_allclose(mass @ velocity, mass @ before[:-1], rtol=1e-9)


def test_unwinding_in_ratd_gives_the_angular_momentum_of_omega(small_grain):
    grain, state = small_grain
    body = lammps.InRatd(state, 0.05)
    body.turn(2e7)
    rows = monomer_rows(body._state)
    expected = rows[:, VX : VX + 3].copy()
    rows[:, VX] += 0.3 + 1e7 * rows[:, X + 1]
    rows[:, VX + 1] -= 1e7 * rows[:, X]
    rows[:, WX + 2] -= 1e7
    body.unwind()
    rows = monomer_rows(body._state)
    np.testing.assert_allclose(rows[:, VX : VX + 3], expected, atol=1e-9)
    np.testing.assert_allclose(rows[:, WX + 2], 2e7)


@needs_lammps
def test_contacts_of_lammps_are_those_of_the_relaxed_grain(small_grain):
    grain, state = small_grain
    rows = monomer_rows(state)[np.argsort(state.identity)]
    with peer_lammps.Spheres(rows[:, X : X + 3], grain.radius, grain.material, 1e-13) as spheres:
        found = {tuple(sorted(pair)) for pair in spheres.contacts().tolist()}
        pull = pull_off_force(reduced_radius(grain.radius.min(), grain.radius.min()), grain.material.surface_energy)
        assert np.abs(spheres.force()).max() < 2e-3 * pull
    assert found == {tuple(sorted(pair)) for pair in grain.contacts.tolist()}


def test_threshold_lies_between_the_runs():
    omega = [3.0, 1.0, 2.0, 4.0, 2.5]
    assert lammps.threshold(omega, [0.7, 1.0, 0.9, 0.5, 0.8], 0.75) == (2.5, 3.0)
    # a run that held above one that did not is not looked at
    assert lammps.threshold(omega, [1.0, 1.0, 0.7, 0.5, 1.0], 0.75) == (1.0, 2.0)
    assert np.isnan(lammps.threshold(omega, np.ones(5), 0.75)).all()
    assert np.isnan(lammps.threshold(omega, np.zeros(5), 0.75)).all()


class Brittle:
    """A body that loses 10 % of its mass from omega = 2 on, and half of it from omega = 3 on."""

    timestep = 1.0

    def __enter__(self):
        self.omega = 0.0
        return self

    def __exit__(self, *_):
        pass

    def turn(self, omega):
        self.omega += omega

    def advance(self, duration):
        pass

    def unwind(self):
        pass

    def mass_left(self):
        return 1.0 if self.omega < 2.0 else 0.9 if self.omega < 3.0 else 0.5


@pytest.mark.parametrize("how", [lammps.sudden, lammps.driven])
def test_both_starts_bracket_the_thresholds(how):
    runs = np.array(how(Brittle, 2.1, 1.02, 0.5))
    for mark, expected in (("first loss", 2.0), ("25 % of the mass", 3.0)):
        low, high = lammps.threshold(runs[:, 0], runs[:, 3], lammps.MARKS[mark])
        assert low < expected <= high and high / low == pytest.approx(1.02)


@needs_lammps
def test_lammps_takes_every_study(tmp_path):
    settings = {"material": "q-S", "type": "BA", "a_eff": 60e-9, "seed": 0, "timestep_factor": 0.05}
    settings |= {"study": "rotation", "step": 1.2, "rotations": {"sudden": 0.5, "driven": 0.1}}
    rows = lammps.compute(settings)
    rolling = lammps.compute(settings | {"study": lammps.ELASTIC_ROLLING, "rotations": {"driven": 0.1}})
    assert {(row["study"], row["path"], row["code"]) for row in rolling} == {
        (lammps.ELASTIC_ROLLING, "driven", code) for code in ("ratd", lammps.TURNING)
    }
    rows += rolling + lammps.compute({"study": "force", "material": "a-C", "pairs": [[2e-8, 5e-8]], "points": 11})
    io.write(tmp_path / "a.nc", as_dataset(rows, lammps.KIND), lammps.KIND)
    table = read_tables([tmp_path / "a.nc"], lammps.KIND)
    assert (table["study"] == "force").sum() >= 11
    turned = table[table["study"] == "rotation"]
    assert set(zip(turned["path"], turned["code"], strict=True)) == {
        (path, code) for path, code in [("sudden", "ratd"), ("driven", "ratd"), *lammps.COMPARISONS]
    }


def test_plan_of_lammps():
    plan = Checks(CONFIG)
    for extent in EXTENTS:
        pieces = plan.pieces[extent]["lammps"]
        grains = plan.config[extent]["lammps"]["grains"]
        for study in ("rotation", lammps.ELASTIC_ROLLING):
            assert sum(piece["study"] == study for piece in pieces.values()) == sum(g["seeds"] for g in grains)
        assert {piece["material"] for piece in pieces.values() if piece["study"] == "force"} == set(
            plan.config[extent]["lammps"]["materials"]
        )
