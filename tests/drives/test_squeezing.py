"""A periodic box that changes: the checks (a) to (e) of compression.md Sect. 3, and the rolling of a pair."""

import numpy as np
import pytest

from ratd.base.materials import Material
from ratd.engine.state import monomer_rows
from ratd.experiments.evolve import evolve
from ratd.geometry.box import open_space, periodic
from ratd.laws import dmt, jkr
from ratd.laws.contact_fields import E_ROLL, E_SLIDE, E_TWIST
from reference.contact import DMT, ICE, JKR, Pair
from systems import field, forces, lattice, pair_state, rest_distance, tree

T0 = 1.9365e-10  # of ice, 0.1 um
A = 1e-7
MATERIAL = Material("ice", *ICE)
CONSTANT = jkr(damping="constant")


def squeeze(position, radius, box, law=CONSTANT, **options):
    """`evolve` of ice spheres, without the check of the balance."""
    radius = np.broadcast_to(radius, len(position))
    return evolve(position, radius, material=MATERIAL, law=law, box=box, balance=None, **options)


@pytest.mark.parametrize(
    ("law", "theirs"),
    [(CONSTANT, JKR("constant")), (jkr(), JKR()), (dmt(viscous_time=0.5e-9, friction="spring"), DMT(0.5e-9))],
    ids=["constant", "viscoelastic", "dmt"],
)
@pytest.mark.parametrize("side", [1, 2, 3])
def test_lattice_stays_affine(law, theirs, side):
    """(a) P = F_N/d^2, the damping at the rate of the box included; 1 is a sphere that touches three of its images, 2
    are pairs with two contacts each."""
    pair = Pair(ICE, A, A)
    rest = 2 * A - (pair.delta_0 if law.__class__.__name__ == "JKR" else pair.delta_eq)
    rate, dt, steps = -2e-4 / T0, 0.05 * T0, 400
    x = lattice(side, rest)
    box = periodic(side * rest, rate)
    run = squeeze(x, A, box, law, duration=dt * (steps - 0.5), timestep=dt, damping="explicit", records=steps)
    assert run.attrs["steps"] == steps and (run.n_contacts == 3 * side**3).all()
    grown = np.exp(rate * dt * steps)
    np.testing.assert_allclose(run.position, x * grown, rtol=0, atol=1e-12 * rest)
    np.testing.assert_allclose(run.velocity, 0.0, atol=1e-9 * abs(rate) * side * rest)
    # the mean since the last record is that of one step, at the positions before its move
    d = rest * np.exp(rate * dt * (steps - 1))
    force = theirs.normal(pair, 2 * A - d) - theirs.c(pair, 2 * A - d) * rate * d
    assert force > 0.0
    np.testing.assert_allclose(run.pressure_tensor[-1, :3], force / d**2, rtol=1e-11)
    np.testing.assert_allclose(run.pressure_tensor[-1, 3:], 0.0, atol=1e-12 * force / d**2)


def gas(scheme, rate, factor=1.0):
    rng = np.random.default_rng(3)
    x, u = rng.uniform(-4e-6, 4e-6, (5, 3)) * factor, rng.normal(size=(5, 3)) * 0.1
    return x, u, periodic(1e-5, rate, scheme=scheme)


def test_points_without_contacts_keep_their_energy_times_the_square_of_the_box():
    """(b) And the work of the box is what they gain; the momentum times the edge stays."""
    x, u, box = gas("homogeneous", -1e-4 / T0)
    run = squeeze(x, 1e-9, box, velocity=u, duration=200 * T0, timestep=0.1 * T0, records=20)
    assert run.n_contacts.values.max() == 0 and run.box_length.values[-1, 0] < 0.99e-5
    energy = run.kinetic_translation.values * run.box_length.values[:, 0] ** 2
    np.testing.assert_allclose(energy, energy[0], rtol=1e-8)
    # up to half a step, by which the work stands behind
    gained = run.kinetic_translation.values - run.kinetic_translation.values[0]
    np.testing.assert_allclose(run.box_work, gained, rtol=0, atol=1.1e-4 * 0.1 * run.kinetic_translation.values[-1])
    carried = run.momentum.values * run.box_length.values
    np.testing.assert_allclose(carried, np.broadcast_to(carried[0], carried.shape), rtol=1e-8)


@pytest.mark.parametrize("scheme", ["as_printed", "homogeneous"])
def test_a_free_sphere_flies_straight_in_the_laboratory_as_printed(scheme):
    """Until it meets a face; the homogeneous box carries it along."""
    rate = -5e-3 / T0
    x, u, box = gas(scheme, rate, 1e-3)
    dt, steps = 0.01 * T0, 2000
    run = squeeze(x, 1e-10, box, velocity=u, duration=dt * (steps - 0.5), timestep=dt, records=1)
    straight = x + (u + rate * x) * dt * steps
    error = np.abs(run.position.values - straight).max() / np.abs(straight - x).max()
    assert (error < 1e-4) == (scheme == "as_printed") and error < 0.5
    if scheme == "homogeneous":
        # du/dt = -H u: the peculiar way in units of the edge
        way = u * (1 - np.exp(-2 * rate * dt * steps)) / (2 * rate)
        carried = (x + way) * np.exp(rate * dt * steps)
        np.testing.assert_allclose(run.position, carried, rtol=0, atol=1e-4 * np.abs(straight - x).max())
    gained = float(run.kinetic_translation[-1] - run.kinetic_translation[0])
    assert float(run.box_work[-1]) == pytest.approx(gained, rel=1e-3)


def test_crossing_a_face_as_printed_changes_the_speed():
    """Straight flight in the laboratory, and a jump of the velocity by 2 |v_b| where it comes in at the other side."""
    rate, length, dt, steps = -1e-4 / T0, 1e-6, 0.1 * T0, 3000
    x, u = np.array([[0.45e-6, 0, 0]]), np.array([[30.0, 0, 0]])
    box = periodic(length, rate, scheme="as_printed")
    run = squeeze(x, 1e-9, box, velocity=u, duration=dt * (steps - 0.5), timestep=dt, records=1)
    lab = u[0, 0] + rate * x[0, 0]
    # way to the face that comes in: x + lab t = L/2 exp(H t)
    times = np.linspace(0, dt * steps, 2_000_001)
    crossing = times[np.argmax(x[0, 0] + lab * times > 0.5 * length * np.exp(rate * times))]
    assert 0 < crossing < dt * steps
    face = 0.5 * length * np.exp(rate * crossing)
    after = lab - rate * 2 * face  # v -> v - dL/dt
    inside = -face + after * (dt * steps - crossing)
    found = run.position.values[0, 0] - run.box_length.values[-1, 0]
    assert found == pytest.approx(inside, abs=2e-3 * 30.0 * dt * steps)


def test_a_shift_changes_nothing():
    """(c) Spheres that collide in a shrinking box, through its faces."""
    rng = np.random.default_rng(5)
    x, u, w = lattice(2, 2.02e-7), rng.normal(size=(8, 3)), rng.normal(size=(8, 3)) * 1e7
    box = periodic(4.04e-7, -1e-3 / T0)
    options = dict(velocity=u, spin=w, duration=10 * T0, timestep=0.04 * T0, records=5)
    first = squeeze(x, A, box, **options)
    shift = np.array([0.3, -1.4, 7.2]) * 4.04e-7
    second = squeeze(x + shift, A, box, **options)
    assert first.n_contacts.values[-1] > 8
    np.testing.assert_array_equal(first.n_contacts, second.n_contacts)
    for name in ("kinetic_translation", "pressure_tensor", "velocity", "spin", "dissipated"):
        wanted = first[name].values
        np.testing.assert_allclose(second[name], wanted, rtol=0, atol=1e-9 * np.abs(wanted).max())
    moved = shift * first.box_length.values[-1] / 4.04e-7
    np.testing.assert_allclose(second.position, first.position + moved, rtol=0, atol=1e-9 * A)


def test_rolling_by_a_right_angle():
    """(d) i rolls round j, which stands still: its spin is twice the turn of the line of centres."""
    d, steps = rest_distance(A, A, "ice"), 4000
    state = pair_state(CONSTANT, open_space(), (A, A), MATERIAL, d, np.array([-1.0, 0, 0]))
    first, second = monomer_rows(state)
    turn = np.pi / 2 / steps
    first[10] = 2 * turn
    for k in range(1, steps + 1):
        first[:3] = second[:3] + d * np.array([-np.cos(k * turn), -np.sin(k * turn), 0.0])
        forces(state, CONSTANT, open_space(), dt_drift=1.0)
    full = 4.737e-16
    assert field(state, E_ROLL)[0] / full == pytest.approx(1 - 2 * 0.8e-9 / (np.pi * A), abs=2e-4)  # 0.995
    assert field(state, E_SLIDE)[0] < 1e-6 * full and field(state, E_TWIST)[0] == 0.0


def test_work_of_the_box_is_what_is_stored_and_dissipated():
    """(e) A cluster squeezed until it touches its own images."""
    n = 100
    x = tree(np.full(n, A), "ice", 4)
    length = np.ptp(x, axis=0).max() + 2 * A
    rate = -2e-5 / T0
    duration = np.log(length / (n * 4 / 3 * np.pi * A**3 / 0.3) ** (1 / 3)) / -rate
    run = squeeze(x, A, periodic(length, rate), duration=duration, timestep=0.1 * T0, records=50)
    work, residual = run.box_work.values, run.residual.values
    filling = n * 4 / 3 * np.pi * A**3 / run.box_length.values[:, 0] ** 3
    assert filling[-1] == pytest.approx(0.3, rel=1e-3)
    assert run.n_contacts.values[-1] > 1.3 * n
    assert np.abs(residual[-1]) < 2e-3 * work[-1]
    # through the faces: some images are not 0, more contacts than open space would have
    gaps = np.linalg.norm(run.position.values[:, None] - run.position.values, axis=2) - 2 * A
    assert (gaps[np.triu_indices(n, 1)] < 0).sum() < run.n_contacts.values[-1] - 10
    # -int P dV from the recorded pressure
    pressure = run.pressure_tensor.values[1:, :3].mean(axis=1)
    volume = run.box_length.values[:, 0] ** 3
    assert -(pressure * np.diff(volume)).sum() == pytest.approx(work[-1], rel=1e-3)
    # the momentum times the edge stays 0
    mass = 4 / 3 * np.pi * A**3 * 1000.0 * n
    scale = np.sqrt(2 * run.kinetic_translation.values.max() * mass)
    assert np.abs(run.momentum.values).max() < 1e-10 * scale
