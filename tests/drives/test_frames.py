"""Runs in the turning frame: equal to the inertial frame without torque, pull-off, the torque, what leaves."""

import math

import numpy as np
import pytest

from ratd.base.materials import MATERIALS
from ratd.drives.free import free
from ratd.drives.largest import ACCELERATION, OMEGA, TORQUE_WORK
from ratd.drives.rotating import OMEGA_RAT, rotating
from ratd.engine.contacts import remove_contact
from ratd.engine.fragments import label_fragments
from ratd.engine.layout import (
    CONTACTS,
    DT,
    DT_DRIFT,
    FRAGMENTS_LOST,
    INERTIA,
    LARGEST_CONTACTS,
    MASS,
    MONOMERS,
    SEARCHES,
    TIME,
    VX,
    WX,
    X,
)  # fmt: skip
from ratd.engine.leapfrog import leapfrog
from ratd.engine.state import contact_field, copied, monomer_rows, new_state
from ratd.engine.step import FEW_CONTACTS, REACHED, run, until
from ratd.geometry.box import open_space
from ratd.laws import jkr
from ratd.laws.contact_fields import NORMAL
from ratd.laws.jkr_with_springs import RADIUS_0, S
from ratd.observables.stress import total_stress
from systems import rest_distance, tree

MATERIAL = MATERIALS["q-S"]
LAW, BOX, INTEGRATOR = jkr(), open_space(), leapfrog()


def grain(radius, seed=1, integrator=INTEGRATOR, material=MATERIAL):
    """State of a tree at rest, its centre of mass at the origin."""
    radius = np.array(radius)
    position = tree(radius, material, seed)
    mass = radius**3
    position -= mass @ position / mass.sum()
    touching = np.linalg.norm(position[:, None] - position, axis=2) < radius + radius[:, None]
    contacts = np.argwhere(np.triu(touching, 1))
    state = new_state(position, radius, material, contacts, LAW, BOX, integrator)
    label_fragments(state)
    return state


def go(state, drive, *, integrator=INTEGRATOR, **goal):
    return run(state, LAW, drive, BOX, integrator, until(**goal))


def about_z(angle):
    return np.array([[math.cos(angle), -math.sin(angle), 0], [math.sin(angle), math.cos(angle), 0], [0, 0, 1.0]])


def test_without_torque_the_turning_frame_is_the_inertial_one():
    """The grain stays at rest in space while the frame turns ever faster: the error is that of the step, dt^2.

    In the inertial frame nothing but a slight vibration of the contacts happens."""
    acceleration = 1e17
    drive = rotating("prescribed", omega_1=1.0, angular_acceleration=acceleration)._replace(torque=False)
    errors = []
    for factor in (0.02, 0.01):
        integrator = leapfrog(timestep_factor=factor)
        begin = grain(np.random.default_rng(1).uniform(20e-9, 40e-9, 8), integrator=integrator)
        rng = np.random.default_rng(2)
        rows = monomer_rows(begin)
        rows[:, VX : VX + 3] = 0.3 * rng.normal(size=(8, 3))
        rows[:, WX : WX + 3] = 1e7 * rng.normal(size=(8, 3))
        rows[:, VX : VX + 3] -= rows[:, MASS] @ rows[:, VX : VX + 3] / rows[:, MASS].sum()
        steps = int(round(10 / factor))
        there, _ = go(copied(begin), free(), integrator=integrator, steps=steps)
        turned, _ = go(copied(begin), drive, integrator=integrator, steps=steps)
        assert there.counter[CONTACTS] == turned.counter[CONTACTS] == 7
        t, tau = turned.scalar[TIME], OMEGA_RAT / acceleration
        assert t == pytest.approx(there.scalar[TIME], rel=1e-9)
        angle = OMEGA_RAT * (t + tau * math.expm1(-t / tau))
        assert angle > 0.01
        back = monomer_rows(turned)[:, X : X + 3] @ about_z(angle).T
        way = np.abs(monomer_rows(there)[:, X : X + 3] - rows[:, X : X + 3]).max()
        errors.append(np.abs(back - monomer_rows(there)[:, X : X + 3]).max() / way)
        spin = monomer_rows(turned)[:, WX : WX + 3] @ about_z(angle).T + [0, 0, turned.drive[OMEGA]]
        np.testing.assert_allclose(spin, monomer_rows(there)[:, WX : WX + 3], rtol=0, atol=5e-3 * 3e7)
    assert errors[0] < 1e-5 and errors[1] < 0.3 * errors[0], errors


@pytest.mark.parametrize("name", ["a-C", "q-S", "co-S"])
@pytest.mark.parametrize("factor", [0.125, 0.03])
def test_two_equal_monomers_part_where_the_pull_is_the_greatest(name, factor):
    """omega = sqrt(3 pi gamma/(2 m)) at slow spin-up, whatever the step."""
    material, a = MATERIALS[name], 20e-9
    mass = 4 / 3 * math.pi * material.density * a**3
    wanted = math.sqrt(3 * math.pi * material.surface_energy / (2 * mass))
    d = rest_distance(a, a, material)
    integrator = leapfrog(timestep_factor=factor)
    state = new_state(
        np.array([[-d / 2, 0, 0], [d / 2, 0, 0]]), np.array([a, a]), material, np.array([[0, 1]]), LAW, BOX, integrator
    )  # fmt: skip
    drive = rotating("prescribed", omega_1=wanted, epsilon=0.0005)
    state, code = go(state, drive, integrator=integrator, clock=2 * wanted, fewest_contacts=0)
    assert code == FEW_CONTACTS
    assert state.drive[OMEGA] == pytest.approx(wanted, rel=0.01)


def test_the_torque_keeps_the_grain_at_rest_in_the_frame():
    """And its work is the energy of the rotation, up to the small strain."""
    state = grain(np.random.default_rng(1).uniform(20e-9, 40e-9, 8))
    drive = rotating("prescribed", omega_1=1e8, epsilon=0.05)
    state, code = go(state, drive, clock=2e7, fewest_contacts=0)
    assert code == REACHED and state.counter[CONTACTS] == 7
    rows = monomer_rows(state)
    x, v = rows[:, X : X + 3], rows[:, VX : VX + 3]
    momentum = rows[:, MASS] @ (x[:, 0] * v[:, 1] - x[:, 1] * v[:, 0]) + rows[:, INERTIA] @ rows[:, WX + 2]
    inertia = rows[:, MASS] @ (x[:, 0] ** 2 + x[:, 1] ** 2) + rows[:, INERTIA].sum()
    omega = state.drive[OMEGA]
    assert abs(momentum / inertia) < 1e-7 * omega and state.drive[ACCELERATION] > 0.0
    assert state.drive[TORQUE_WORK] == pytest.approx(0.5 * inertia * omega**2, rel=2e-2)
    assert np.abs(rows[:, MASS] @ x).max() / rows[:, MASS].sum() < 1e-12


def test_a_long_stretch_stays_centred():
    """Unequal monomers, slowly: an offset of the centre of mass would grow from rounding to tear them apart early."""
    a = np.array([12e-9, 60e-9])
    state = grain(a)
    mass = monomer_rows(state)[:, MASS]
    d = np.linalg.norm(np.diff(monomer_rows(state)[:, :3], axis=0))
    # pull-off at F_C = 3 pi gamma R, the line of centres normal to z
    rows = monomer_rows(state)
    place = {0: -mass[1], 1: mass[0]}
    for k in range(2):
        rows[k, :3] = [place[k] / mass.sum() * d, 0, 0]
    touching = np.array([[0, 1]])
    state = new_state(rows[:, :3].copy(), rows[:, 3].copy(), MATERIAL, touching, LAW, BOX, INTEGRATOR)
    label_fragments(state)
    reduced = mass.prod() / mass.sum()
    bound = math.sqrt(3 * math.pi * MATERIAL.surface_energy * a.prod() / a.sum() / (reduced * a.sum()))
    state, _ = go(state, rotating("prescribed", omega_1=bound, epsilon=0.0005), clock=0.97 * bound, fewest_contacts=0)
    assert state.counter[CONTACTS] == 1
    rows = monomer_rows(state)
    assert np.abs(rows[:, MASS] @ rows[:, :3]).max() / rows[:, MASS].sum() < 1e-6 * a.min()


def test_a_fragment_that_leaves_is_dropped_and_noted():
    """An end that is cut off and flies outwards; what stays keeps its order and its centre of mass."""
    state = grain(np.random.default_rng(3).uniform(20e-9, 40e-9, 12), seed=4)
    n = 12
    ends = np.bincount(np.concatenate([state.pair_i[: n - 1], state.pair_j[: n - 1]]).astype(int), minlength=n)
    rows = monomer_rows(state)
    mass = rows[:, MASS].copy()
    end = int(np.argmax(np.where(ends[:n] == 1, np.linalg.norm(rows[:, :3], axis=1), 0.0)))
    remove_contact(state, LAW, next(k for k in range(n - 1) if end in (int(state.pair_i[k]), int(state.pair_j[k]))))
    rows[end, VX : VX + 3] = 50.0 * rows[end, :3] / np.linalg.norm(rows[end, :3])
    drive = rotating("prescribed", omega_1=1e8, epsilon=1e-4)
    state, _ = go(state, drive, steps=20_000)
    assert state.counter[FRAGMENTS_LOST] == 1 and state.counter[MONOMERS] == n - 1
    assert state.lost[0, 0] == pytest.approx(mass[end]) and state.lost[0, 1] == 1 and state.lost[0, 3] > 0.0
    assert state.counter[LARGEST_CONTACTS] == state.counter[CONTACTS] == n - 2
    rows = monomer_rows(state)
    np.testing.assert_array_equal(rows[:, MASS], np.delete(mass, end))
    np.testing.assert_allclose(rows[:, MASS] @ rows[:, :3] / rows[:, MASS].sum(), 0.0, atol=1e-12)


def test_a_grain_that_stays_behind_the_frame_needs_no_new_lists():
    """Without torque the frame turns by a radian, and the grain back by as much."""
    drive = rotating("prescribed", omega_1=1.0, angular_acceleration=2e15)._replace(torque=False)
    state = grain(np.random.default_rng(1).uniform(20e-9, 40e-9, 8))
    state, _ = go(state, drive, time=math.sqrt(2 / 2e15))
    assert state.counter[SEARCHES] == 0 and state.counter[CONTACTS] == 7


def test_a_grain_that_turns_misses_no_contact():
    """A monomer that meets the middle of a chain of three whose ends have moved by several reaches of the lists."""
    a, omega = 20e-9, 5e7
    d = rest_distance(a, a, MATERIAL)
    chain = np.array([[0.0, 0, 0], [-d, 0, 0], [d, 0, 0], [0, 2 * a + 30e-9, 0]])
    velocity = np.array([[0.0, 0, 0], [0, -omega * d, 0], [0, omega * d, 0], [0, -10.0, 0]])
    spin = np.zeros((4, 3))
    spin[:3, 2] = omega
    state = new_state(
        chain, np.full(4, a), MATERIAL, np.array([[0, 1], [0, 2]]), LAW, BOX, INTEGRATOR, velocity=velocity, spin=spin
    )  # fmt: skip
    # a frame that hardly turns
    drive = rotating("prescribed", omega_1=1.0, angular_acceleration=1e6)._replace(torque=False)
    assert drive.turning()
    state, _ = go(state, drive, time=3.5e-9)
    sides = np.array([state.pair_i, state.pair_j]).T[: state.counter[CONTACTS]].astype(int)
    pairs = {frozenset(pair) for pair in state.identity[sides].tolist()}
    assert len(pairs) == 3 and frozenset((0, 3)) in pairs


def test_stress_is_the_sum_of_eq_32():
    state = grain(np.random.default_rng(1).uniform(20e-9, 40e-9, 8))
    rows = monomer_rows(state)
    rows[:, VX : VX + 3] = 0.05 * np.random.default_rng(1).normal(size=(8, 3))
    state, _ = go(state, free(), steps=500)
    r = contact_field(state, RADIUS_0) * contact_field(state, S) ** 2
    wanted = (np.abs(contact_field(state, NORMAL)) / (np.pi * r**2)).sum()
    assert total_stress(state, LAW) == pytest.approx(wanted, rel=1e-12) and wanted > 0.0
    assert state.scalar[DT] == state.scalar[DT_DRIFT]
