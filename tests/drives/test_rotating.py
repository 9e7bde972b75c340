"""Spin-up laws, and the equations of motion of a single free monomer in the turning frame."""

import math

import numpy as np
import pytest

from ratd.base.errors import InputError
from ratd.drives.rotating import OMEGA_RAT, SOFT_START, angular_velocity, kick_and_drift, rotating
from ratd.engine import layout


def test_constant_epsilon_law():
    drive = rotating("prescribed", omega_1=1e8, epsilon=0.02)
    assert angular_velocity(drive, 0.0)[0] == 0.0
    times = np.linspace(0, 1.4 / (0.02 * 1e8), 4001)
    omega, slope = np.array([angular_velocity(drive, t) for t in times]).T
    wanted = np.where(omega > 1e8, 0.02 * omega**2, 0.02 * 1e24 / np.maximum(omega, SOFT_START * 1e8))
    np.testing.assert_allclose(slope, wanted, rtol=1e-9)
    numerical = np.gradient(omega, times)
    np.testing.assert_allclose(numerical[1:-1], slope[1:-1], rtol=5e-3)
    np.testing.assert_allclose(np.diff(slope), 0.0, atol=2e-2 * slope.max())
    reached = times[np.searchsorted(omega, 1e8)] * 0.02 * 1e8
    assert reached == pytest.approx((1 + SOFT_START**2) / 2, abs=1e-3)


def test_exponential_law_is_eq_24():
    drive = rotating("prescribed", omega_1=1.0, angular_acceleration=1e15)
    tau = OMEGA_RAT / 1e15
    for t in (0.0, 1e-9, 1e-5, 1e-4):
        omega, slope = angular_velocity(drive, t)
        assert omega == pytest.approx(OMEGA_RAT * (1 - math.exp(-t / tau)), rel=1e-9)
        assert slope == pytest.approx(OMEGA_RAT / tau * math.exp(-t / tau), rel=1e-12)


def free_monomer(position, velocity, spin):
    monomer = np.zeros(layout.ROW)
    monomer[0:3], monomer[4:7], monomer[8:11] = position, velocity, spin
    monomer[int(layout.INV_MASS)] = monomer[int(layout.INV_INERTIA)] = 1.0
    return monomer


def test_free_monomer_goes_straight_in_the_inertial_frame():
    """Centrifugal, Coriolis and Euler terms, and those of the spin, in a frame that turns ever faster."""
    drive = rotating("prescribed", omega_1=1.0, angular_acceleration=3e16)._replace(torque=False)
    x_0, v_0, w_0 = np.array([1e-7, 0, 2e-8]), np.array([3.0, 7.0, -1.0]), np.array([2e7, -3e7, 4e7])
    errors = []
    for steps in (500, 1000):
        dt = 2e-9 / steps
        # velocities stand half a step before the positions
        back = angular_velocity(drive, 0.0)[1] * dt / 2
        v = v_0 - np.cross([0, 0, back], x_0)
        v += np.array([back * -x_0[1], back * x_0[0], 0.0])
        monomer, force = free_monomer(x_0, v, w_0), np.zeros(layout.FORCE_ROW)
        for step in range(steps):
            omega, domega = angular_velocity(drive, step * dt)
            kick_and_drift(monomer, force, 1, dt, dt, omega, domega, 0.0, drive, True)
        t = steps * dt
        tau = OMEGA_RAT / 3e16
        angle = OMEGA_RAT * (t + tau * math.expm1(-t / tau))
        turn = np.array([[math.cos(angle), -math.sin(angle), 0], [math.sin(angle), math.cos(angle), 0], [0, 0, 1]])
        errors.append(np.abs(turn @ monomer[0:3] - (x_0 + v_0 * t)).max() / np.linalg.norm(v_0 * t))
        spin = turn @ monomer[8:11] + [0, 0, angular_velocity(drive, t)[0]]
        np.testing.assert_allclose(spin, w_0, atol=2e-3 * 6e7)
    assert angle > 0.05
    assert errors[0] < 1e-3 and errors[1] < 0.6 * errors[0], errors


def test_literal_frame_lacks_torque_and_spin_terms():
    literal = rotating("literal", omega_1=1e8, angular_acceleration=1e15)
    assert not literal.torque and not literal.spin_terms and literal.explicit_coriolis
    assert not rotating("literal", omega_1=1e8, angular_acceleration=1e15, coriolis="exact").explicit_coriolis
    monomer, force = free_monomer([1e-7, 0, 0], [0, 0, 0], [1e7, 0, 0]), np.zeros(layout.FORCE_ROW)
    kick_and_drift(monomer, force, 1, 1e-12, 1e-12, 1e9, 1e15, 0.0, literal, True)
    np.testing.assert_array_equal(monomer[8:11], [1e7, 0, 0])
    np.testing.assert_allclose(monomer[4:7], [1e18 * 1e-7 * 1e-12, -1e15 * 1e-7 * 1e-12, 0.0], rtol=1e-12)


def test_explicit_coriolis_feeds_energy_and_the_exact_one_does_not():
    """A free monomer at rest in the inertial frame: the explicit term drives it outwards (docs/model/drives.md)."""
    speeds = {}
    for coriolis in ("explicit", "exact"):
        drive = rotating("literal", omega_1=1e8, epsilon=0.02, coriolis=coriolis)
        omega, dt = 2e9, 1e-12
        back = 0.5 * omega * dt  # the velocity stands half a step before the position
        start = omega * 1e-7 * np.array([np.sin(back), -np.cos(back), 0.0])
        monomer, force = free_monomer([1e-7, 0, 0], start, [0, 0, 0]), np.zeros(layout.FORCE_ROW)
        for _ in range(100_000):
            kick_and_drift(monomer, force, 1, dt, dt, omega, 0.0, 0.0, drive, True)
        speeds[coriolis] = np.hypot(monomer[0], monomer[1]) / 1e-7
    # the exact one is of second order: an acceleration of 0.4 (omega dt)^2 of the centrifugal one is left
    assert speeds["exact"] == pytest.approx(1.0, abs=0.05)
    assert speeds["explicit"] > 1.2


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"name": "torque"}, "drive is 'torque'"),
        ({"name": "prescribed", "epsilon": None}, "Exactly one"),
        ({"name": "prescribed", "angular_acceleration": 1e14}, "Exactly one"),
        ({"name": "prescribed", "epsilon": 0.0}, "epsilon is 0.0"),
        ({"name": "literal", "epsilon": None, "angular_acceleration": float("nan")}, "angular_acceleration is nan"),
        ({"name": "literal", "coriolis": "implicit"}, "coriolis is 'implicit'"),
    ],
)
def test_bad_drives_are_refused_in_one_sentence(arguments, words):
    with pytest.raises(InputError, match=words):
        rotating(**{"omega_1": 1e8, "epsilon": 0.02} | arguments)


@pytest.mark.parametrize("name", ["prescribed", "literal"])
def test_a_grain_in_one_piece_moves_as_one_whose_monomers_are_asked(name):
    drive = rotating(name, omega_1=1e8, epsilon=0.02)
    rng = np.random.default_rng(4)
    n = 7
    rows, forces = rng.normal(size=(n, layout.ROW)), rng.normal(size=(n, layout.FORCE_ROW))
    rows[:, int(layout.STILL)] = forces[:, 3] = forces[:, 7] = 0.0
    rows[:, int(layout.DRIVEN)] = 1.0
    found = []
    for whole in (True, False):
        monomer, force = rows.ravel().copy(), forces.ravel().copy()
        sums = kick_and_drift(monomer, force, n, 0.02, 0.03, 1.5, 0.3, 0.2, drive, whole)
        assert not force.any()
        found.append(np.concatenate([monomer, sums]))
    np.testing.assert_array_equal(*found)
    speed = np.linalg.norm(found[0][:-3].reshape(n, -1)[:, 4:7], axis=1).max()
    assert speed <= found[0][-1] <= np.sqrt(3.0) * speed


def test_what_the_drive_does_not_act_on_is_left_out_of_its_sums():
    """The second of two monomers has left: the torque turns the first alone, and only that one is summed."""
    drive = rotating("prescribed", omega_1=1e8, epsilon=0.02)
    rows = np.random.default_rng(5).normal(size=(2, layout.ROW))
    rows[:, int(layout.STILL)] = 0.0
    rows[:, int(layout.DRIVEN)] = [1.0, 0.0]
    alone, both = rows[0].copy(), rows.ravel().copy()
    moved = [
        kick_and_drift(monomer, np.zeros(layout.FORCE_ROW * n), n, 0.02, 0.03, 1.5, 0.3, 0.2, drive, n == 1)
        for n, monomer in ((1, alone), (2, both))
    ]
    np.testing.assert_array_equal(both[: layout.ROW], alone)
    assert moved[0][:2] == moved[1][:2] and moved[1][2] >= moved[0][2]
