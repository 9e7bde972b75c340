"""Contact laws: table of docs/model/laws.md, forces as derivatives of potentials, limits leave other modes alone."""

import math

import numpy as np
import pytest

from ratd.base.materials import MATERIALS
from ratd.laws import johnson_kendall_roberts as jkr
from ratd.laws import tangential
from ratd.laws.contact_constants import (
    equilibrium_compression,
    equilibrium_contact_radius,
    pull_off_force,
    reduced_radius,
)
from ratd.laws.derjaguin_muller_toporov import impact_duration
from ratd.laws.material_pair import material_pair, material_row

MATERIAL = MATERIALS["q-S"]
RADII = [(30e-9, 30e-9), (10e-9, 100e-9), (100e-9, 10e-9)]


def constants(a_i, a_j):
    r = reduced_radius(a_i, a_j)
    gamma, e_star = MATERIAL.surface_energy, MATERIAL.reduced_modulus
    return (
        r,
        equilibrium_contact_radius(r, gamma, e_star),
        equilibrium_compression(r, gamma, e_star),
        pull_off_force(r, gamma),
    )


@pytest.mark.parametrize(
    ("s", "x", "compression", "force"),
    [
        (jkr.S_TOUCH, 0.763, 0.0, -8 / 9),
        (1.0, 1.0, 1.0, 0.0),
        (jkr.S_PULL_OFF, 0.630, -0.397, -1.0),
        (jkr.S_END, 0.303, -0.8255, -5 / 9),
    ],
)
def test_states_of_the_normal_contact(s, x, compression, force):
    assert s**2 == pytest.approx(x, abs=5e-4)
    assert jkr.compression_of(s) == pytest.approx(compression, abs=5e-4)
    assert jkr.normal_force(s, 1.0) == pytest.approx(force, abs=1e-12)


def test_pull_off_is_the_greatest_pull():
    s = np.linspace(jkr.S_END, 2.0, 100001)
    force = np.array([jkr.normal_force(value, 1.0) for value in s])
    assert s[force.argmin()] == pytest.approx(jkr.S_PULL_OFF, abs=1e-4)


@pytest.mark.parametrize("s", [0.57, 0.63, 0.8736, 1.0, 1.1, 1.4])
def test_normal_force_is_the_derivative_of_its_potential(s):
    _, _, delta_0, f_c = constants(10e-9, 100e-9)
    h = 1e-5

    def slope(h):
        rise = jkr.normal_potential(s + h, f_c, delta_0) - jkr.normal_potential(s - h, f_c, delta_0)
        return rise / (delta_0 * (jkr.compression_of(s + h) - jkr.compression_of(s - h)))

    # approaching by d(delta) stores F d(delta); Richardson's extrapolation takes out the error of order h^2
    assert (4 * slope(h) - slope(2 * h)) / 3 == pytest.approx(jkr.normal_force(s, f_c), rel=1e-6, abs=1e-6 * f_c)


def test_potential_vanishes_without_contact_and_is_lowest_at_equilibrium():
    assert jkr.normal_potential(0.0, 1.0, 1.0) == 0.0
    values = [jkr.normal_potential(s, 1.0, 1.0) for s in (0.99, 1.0, 1.01)]
    assert values[1] == min(values) == pytest.approx(-1.2)


@pytest.mark.parametrize("radii", RADII)
def test_stiffness_at_equilibrium(radii):
    _, r0, delta_0, f_c = constants(*radii)
    h = 1e-4
    change = jkr.normal_force(1 + h, f_c) - jkr.normal_force(1 - h, f_c)
    numerical = change / (delta_0 * (jkr.compression_of(1 + h) - jkr.compression_of(1 - h)))
    assert jkr.equilibrium_stiffness(f_c, delta_0) == pytest.approx(1.2 * MATERIAL.reduced_modulus * r0, rel=1e-12)
    assert numerical == pytest.approx(jkr.equilibrium_stiffness(f_c, delta_0), rel=1e-6)


@pytest.mark.parametrize("s", np.linspace(0.63, 1.5, 12))
@pytest.mark.parametrize("change", [-1e-3, -1e-4, 1e-4, 1e-3])
def test_two_newton_steps_follow_the_change_of_a_time_step(s, change):
    compression = jkr.compression_of(s) + change
    found = jkr.contact_state(compression, s)
    assert jkr.compression_of(found) == pytest.approx(compression, abs=1e-6 * abs(change))


@pytest.mark.parametrize("s", np.linspace(jkr.S_END, 1.0, 10))
@pytest.mark.parametrize("change", [0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 3.0])
@pytest.mark.parametrize(("up_to", "within"), [(1.0, 0.15), (2.0, 0.8)])
def test_a_contact_that_springs_back_in_one_step_pushes_as_it_should(s, change, up_to, within):
    """Newton's rule from the end of the branch would lead to forces of 20 000 F_C and more."""
    compression = min(jkr.compression_of(s) + change, up_to)
    (root,) = (x.real for x in np.roots([3.0, 0.0, 0.0, -2.0, -compression]) if x.imag == 0.0 and x.real >= jkr.S_END)
    found = jkr.contact_state(compression, s)
    assert abs(jkr.normal_force(found, 1.0) - jkr.normal_force(root, 1.0)) < within


@pytest.mark.parametrize("s", [0.552, 0.56, 0.6, 0.63])
def test_the_state_is_near_up_to_the_end_of_the_branch(s):
    for change in (-1e-3, 1e-3):
        compression = max(jkr.compression_of(s) + change, jkr.COMPRESSION_END)
        assert jkr.compression_of(jkr.contact_state(compression, s)) == pytest.approx(compression, abs=1e-3)


def test_the_state_follows_a_slow_pull_to_the_end_of_the_branch():
    s = 1.0
    for compression in np.linspace(1.0, jkr.COMPRESSION_END, 20001):
        s = jkr.contact_state(compression, s)
        assert jkr.compression_of(s) == pytest.approx(compression, abs=1e-4)
    assert s == pytest.approx(jkr.S_END, abs=5e-3)


def test_step_of_eq_31():
    a = 10e-9
    material = MATERIALS["a-C"]
    r = a / 2
    r0 = equilibrium_contact_radius(r, material.surface_energy, material.reduced_modulus)
    mass = 4 / 3 * math.pi * a**3 * material.density
    # 0.02 t_dis is 0.23 ps for a-C monomers of 10 nm
    assert 0.02 * jkr.dissipation_time(mass, r, r0, material.surface_energy) == pytest.approx(0.23e-12, rel=0.02)


@pytest.mark.parametrize(
    ("name", "ratios"), [("a-C", (20, 3.9, 1.4)), ("q-S", (10, 1.9, 0.7)), ("co-S", (6, 1.2, 0.4))]
)
def test_damping_ratios(name, ratios):
    material = MATERIALS[name]
    for a, ratio in zip((10e-9, 41e-9, 100e-9), ratios, strict=True):
        r = a / 2
        r0 = equilibrium_contact_radius(r, material.surface_energy, material.reduced_modulus)
        c = jkr.viscoelastic_damping(r0, material.reduced_modulus, material.viscous_time / material.poisson_number**2)
        m_red = 2 / 3 * math.pi * a**3 * material.density
        # the table of docs/model/laws.md is rounded to its last digit
        assert c / (2 * math.sqrt(1.2 * material.reduced_modulus * r0 * m_red)) == pytest.approx(ratio, rel=0.12)


def test_limits_and_stiffnesses():
    nu, shear = 0.2, 3e10
    pair = material_pair(*[np.array([0.1, 2 * (1 + nu) * shear, nu, 1e-9, 1e-12])] * 2)
    assert tangential.sliding_stiffness(1e-9, pair.sliding_modulus) == pytest.approx(8e-9 * shear / 3.6)
    assert tangential.sliding_limit(1e-9, nu) == pytest.approx(1.8e-9 / (16 * math.pi))
    assert tangential.twisting_stiffness(1e-9, pair.twisting_modulus) == pytest.approx(16 / 3 * shear / 2 * 1e-27)
    assert tangential.rolling_stiffness(1e-9, 2e-8) == pytest.approx(8e-17)
    assert pytest.approx(0.0198943678865) == tangential.TWISTING_LIMIT


def test_turning_a_pointer_changes_its_length_in_the_fourth_order():
    spin = np.array([3e8, -2e8, 5e8])
    for dt in (1e-10, 3e-11):
        n = np.array(tangential.rotate_pointer(0.36, 0.48, 0.8, *(0.5 * dt * spin)))
        assert 0.0 < np.linalg.norm(n) - 1.0 <= (np.linalg.norm(spin) * dt) ** 4 / 8


def test_pointers_turn_by_the_right_angle_and_keep_their_length():
    n = np.array([0.36, 0.48, 0.8])
    spin = np.array([3e8, -2e8, 5e8])
    dt = 1e-12
    steps = 1000
    for _ in range(steps):
        n = np.array(tangential.nearly_unit(*tangential.rotate_pointer(*n, *(0.5 * dt * spin))))
    assert np.linalg.norm(n) == pytest.approx(1.0, abs=1e-13)
    axis = spin / np.linalg.norm(spin)
    angle = np.linalg.norm(spin) * dt * steps
    start = np.array([0.36, 0.48, 0.8])
    exact = (
        start * math.cos(angle)
        + np.cross(axis, start) * math.sin(angle)
        + axis * (axis @ start) * (1 - math.cos(angle))
    )
    np.testing.assert_allclose(n, exact, atol=1e-7)


@pytest.mark.parametrize(("a_i", "a_j"), RADII)
def test_slipping_and_rolling_leave_each_other_alone(a_i, a_j):
    rng = np.random.default_rng(3)
    n_c = np.array([0.0, 0.0, 1.0])
    n_i = -n_c + 1e-2 * rng.normal(size=3)
    n_j = n_c + 1e-2 * rng.normal(size=3)
    n_i /= np.linalg.norm(n_i)
    n_j /= np.linalg.norm(n_j)

    def slide(p_i, p_j):
        return np.array(tangential.sliding_displacement(a_i, *p_i, a_j, *p_j, *n_c)[1:])

    zeta = slide(n_i, n_j)
    after = np.array(tangential.slide_back(0.7, 1 / (a_i + a_j), *n_i, *n_j, *zeta)).reshape(2, 3)
    np.testing.assert_allclose(slide(*after), 0.3 * zeta, rtol=1e-10, atol=1e-20)
    np.testing.assert_allclose(after.sum(0), n_i + n_j, atol=1e-15)

    after = np.array(tangential.roll_back(0.7, 1 / (a_i + a_j), a_i, *n_i, a_j, *n_j)).reshape(2, 3)
    np.testing.assert_allclose(after.sum(0), 0.3 * (n_i + n_j), rtol=1e-10, atol=1e-16)
    np.testing.assert_allclose(slide(*after), zeta, rtol=1e-10, atol=1e-22)


def test_excess_is_what_lies_beyond_the_limit():
    assert tangential.excess_fraction(4.0) == pytest.approx(0.5, abs=1e-15)
    assert [tangential.excess_fraction(square) for square in (0.0, 1e-300, 0.25, 1.0)] == [0.0] * 4
    assert tangential.excess_fraction(1.0 + 1e-9) == pytest.approx(5e-10, abs=3e-16)


def test_constants_of_two_materials_are_those_of_one_when_they_are_the_same():
    nu = MATERIAL.poisson_number
    pair = material_pair(*[np.array(material_row(MATERIAL))] * 2)
    assert pair.surface_energy == pytest.approx(MATERIAL.surface_energy, rel=1e-14)
    assert pair.reduced_modulus == pytest.approx(MATERIAL.reduced_modulus, rel=1e-14)
    assert pair.sliding_modulus == pytest.approx(MATERIAL.shear_modulus / (2 * (2 - nu)), rel=1e-14)
    assert pair.twisting_modulus == pytest.approx(MATERIAL.shear_modulus / 2, rel=1e-14)
    assert pair.poisson_number == pytest.approx(nu, rel=1e-14)
    assert pair.rolling_limit == pytest.approx(MATERIAL.critical_rolling_displacement, rel=1e-14)
    assert pair.viscosity == pytest.approx(MATERIAL.viscous_time / nu**2, rel=1e-14)


def test_constants_of_two_materials():
    """1/E* is the sum of what each gives; a rigid partner leaves the other's; the order does not matter."""
    ice, silica = (np.array(material_row(MATERIALS[name])) for name in ("ice", "silica"))
    both = material_pair(ice, silica)
    assert both == pytest.approx(material_pair(silica, ice), rel=1e-14)
    assert 1 / both.reduced_modulus == pytest.approx((1 - 0.25**2) / 7e9 + (1 - 0.17**2) / 54e9, rel=1e-12)
    assert both.surface_energy == pytest.approx(math.sqrt(0.1 * 0.025), rel=1e-12)
    assert both.rolling_limit == pytest.approx(0.45e-9, rel=1e-12)
    rigid = silica.copy()
    rigid[1] *= 1e12
    assert material_pair(ice, rigid).reduced_modulus == pytest.approx(2 * MATERIALS["ice"].reduced_modulus, rel=1e-9)


def test_an_impact_takes_the_time_that_its_integration_takes():
    """m x'' = -(4/3) E* sqrt(R) x^1.5 from x = 0 at speed v until x = 0 again, by short steps."""
    mass, radius, modulus, speed = 3e-18, 5e-8, 3e10, 20.0
    stiffness = 4.0 / 3.0 * modulus * math.sqrt(radius)
    overlap, velocity, time, step = 0.0, speed, 0.0, 1e-14
    while overlap >= 0.0:
        velocity -= 0.5 * step * stiffness / mass * overlap**1.5
        overlap += step * velocity
        velocity -= 0.5 * step * stiffness / mass * max(overlap, 0.0) ** 1.5
        time += step
    assert impact_duration(mass, radius, modulus, speed) == pytest.approx(time, rel=2e-3)
