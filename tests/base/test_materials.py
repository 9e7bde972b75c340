import math

import numpy as np
import pandas as pd
import pytest

from ratd.base.errors import InputError
from ratd.base.materials import CO_S_FRACTIONS, MATERIALS, Material, element_ratios, get_material, mix, sphere_mass
from ratd.laws.contact_constants import (
    equilibrium_compression,
    equilibrium_contact_radius,
    pull_off_force,
    reduced_radius,
    rolling_energy,
)


@pytest.mark.parametrize(
    ("name", "surface_energy", "youngs_modulus", "poisson_number", "density"),
    [
        ("a-C", 0.050, 168e9, 0.16, 2368.0),
        ("q-S", 0.020, 54e9, 0.17, 2650.0),
        ("forsterite", 0.070, 204e9, 0.24, 3213.0),
        ("fayalite", 0.070, 140e9, 0.32, 4393.0),
        ("enstatite", 0.070, 180e9, 0.21, 3209.0),
        ("ferrosilite", 0.070, 142e9, 0.31, 4014.0),
    ],
)
def test_table_2(name, surface_energy, youngs_modulus, poisson_number, density):
    material = MATERIALS[name]
    assert material.name == name
    assert material.surface_energy == pytest.approx(surface_energy, rel=1e-15)
    assert material.youngs_modulus == youngs_modulus
    assert material.poisson_number == poisson_number
    assert material.density == density
    assert material.critical_rolling_displacement == 0.2e-9
    assert material.viscous_time == 5e-12


def test_co_s_is_the_mean_of_its_minerals_and_near_the_rounded_table():
    material = MATERIALS["co-S"]
    assert material.youngs_modulus == pytest.approx(168.24e9, rel=1e-12)
    assert material.poisson_number == pytest.approx(0.2712, rel=1e-12)
    assert material.density == pytest.approx(3714.6, rel=1e-12)
    assert material.surface_energy == pytest.approx(0.07, rel=1e-12)
    # Table 2 prints 169 GPa, 0.27, 3707 kg/m3.
    assert material.youngs_modulus == pytest.approx(169e9, rel=0.01)
    assert material.density == pytest.approx(3707.0, rel=0.01)


def test_element_ratios_are_those_of_table_1():
    ratios = element_ratios(CO_S_FRACTIONS)
    expected = {"Mg/O": 0.23, "Si/O": 0.28, "Fe/O": 0.22, "Mg/Fe": 1.05, "(Mg+Fe)/Si": 1.60}
    assert ratios == pytest.approx(expected, abs=0.005)


def test_element_ratios_of_one_mineral():
    ratios = element_ratios({"forsterite": 1.0})
    assert ratios["Mg/O"] == 0.5
    assert ratios["Mg/Fe"] == math.inf
    assert element_ratios({"ferrosilite": 1.0})["Mg/Fe"] == 0.0


def test_mass_of_a_sphere():
    """That of water in a ball of 1 mm, and of two at once."""
    assert sphere_mass(1e-3, 1000.0) == pytest.approx(4.18879e-6, rel=1e-5)
    assert np.allclose(sphere_mass(np.array([1.0, 2.0]), 3.0 / (4.0 * np.pi)), [1.0, 8.0], rtol=1e-14)


def test_moduli():
    material = Material("x", 0.02, 50e9, 0.25, 2000.0)
    assert material.reduced_modulus == pytest.approx(50e9 / (2 * 0.9375))
    assert material.shear_modulus == pytest.approx(20e9)


def test_contact_constants_of_two_quartz_monomers():
    # 40 nm each: R = 20 nm, E* = 54e9/(2 (1 - 0.17^2)) = 2.78035e10 Pa; by hand with four digits.
    quartz = MATERIALS["q-S"]
    R = reduced_radius(40e-9, 40e-9)
    assert pytest.approx(20e-9) == R
    r0 = equilibrium_contact_radius(R, quartz.surface_energy, quartz.reduced_modulus)
    assert r0 == pytest.approx(2.0112e-9, rel=1e-4)
    assert pull_off_force(R, quartz.surface_energy) == pytest.approx(3.7699e-9, rel=1e-4)
    assert equilibrium_compression(R, quartz.surface_energy, quartz.reduced_modulus) == pytest.approx(
        6.7417e-11, rel=1e-4
    )


@pytest.mark.parametrize("name", ["a-C", "q-S", "co-S"])
@pytest.mark.parametrize(("a_i", "a_j"), [(10e-9, 10e-9), (10e-9, 100e-9), (41e-9, 70e-9)])
def test_contact_constants_agree_with_each_other(name, a_i, a_j):
    # The stiffness at rest is 1.2 F_C/delta_0 and 1.2 E* r0, which ties all three constants together.
    material = MATERIALS[name]
    R = reduced_radius(a_i, a_j)
    r0 = equilibrium_contact_radius(R, material.surface_energy, material.reduced_modulus)
    delta_0 = equilibrium_compression(R, material.surface_energy, material.reduced_modulus)
    force = pull_off_force(R, material.surface_energy)
    assert force / delta_0 == pytest.approx(material.reduced_modulus * r0, rel=1e-13)
    assert delta_0 < 0.01 * min(a_i, a_j)


@pytest.mark.parametrize(
    ("name", "a", "t_0", "rolling"),
    [("ice", 0.1e-6, 1.9365e-10, 4.737e-16), ("silicate", 0.6e-6, 1.7073e-9, 1.4212e-15)],
)
def test_materials_of_compression(name, a, t_0, rolling):
    """shared/compression.md, Sect. 1: t_0 of Kataoka et al. 2013, Eq. 2, E_roll, and T_vis for k_n = 0.01."""
    material = MATERIALS[name]
    gamma, modulus = material.surface_energy, material.reduced_modulus
    time = 0.95 * a ** (7 / 6) * material.density**0.5 / (gamma ** (1 / 6) * modulus ** (1 / 3))
    assert time == pytest.approx(t_0, rel=1e-4)
    energy = rolling_energy(reduced_radius(a, a), gamma, material.critical_rolling_displacement)
    assert energy == pytest.approx(rolling, rel=2e-4)
    mass = 4 / 3 * math.pi * material.density * a**3
    contact_radius = equilibrium_contact_radius(reduced_radius(a, a), gamma, modulus)
    damping = 2 * modulus / material.poisson_number**2 * contact_radius * material.viscous_time
    assert damping == pytest.approx(0.01 * mass / time, rel=5e-3)


@pytest.mark.parametrize(
    ("a", "delta_eq", "e_break"),
    [
        (0.05e-6, 0.1215e-9, 5.73e-19),
        (0.314e-6, 0.2242e-9, 6.64e-18),
        (0.396e-6, 0.2423e-9, 9.04e-18),
        (0.453e-6, 0.2534e-9, 1.08e-17),
        (0.57e-6, 0.2735e-9, 1.47e-17),
    ],
)
def test_silica_of_collisions(a, delta_eq, e_break):
    """shared/collision.md, Sect. 1: compression at rest and energy to break a contact of Umstaetter & Urbassek 2020."""
    material = MATERIALS["silica"]
    R = reduced_radius(a, a)
    pull = 4 * math.pi * material.surface_energy * R
    delta = (pull / (4 / 3 * material.reduced_modulus * math.sqrt(R))) ** (2 / 3)
    assert delta == pytest.approx(delta_eq, rel=5e-4)
    assert 0.6 * pull * delta == pytest.approx(e_break, rel=5e-3)
    # T_vis = (2/3) nu^2 A
    assert 1.5 * material.viscous_time / material.poisson_number**2 == pytest.approx(0.5e-9, rel=1e-3)


def test_reduced_radius_of_a_wall():
    assert reduced_radius(10e-9, 1.0) == pytest.approx(10e-9, rel=1e-7)


def test_get_material_takes_names_materials_and_other_tables():
    own = Material("snow", 0.1, 7e9, 0.25, 1000.0)
    assert get_material("q-S") is MATERIALS["q-S"]
    assert get_material(own) is own
    assert get_material("snow", {"snow": own}) is own
    with pytest.raises(InputError, match="'snow'; allowed are a-C, q-S"):
        get_material("snow")
    with pytest.raises(InputError, match="allowed are"):
        get_material(3)


def test_mix_takes_every_property_of_another_table():
    table = {"x": Material("x", 0.02, 10e9, 0.2, 1000.0, 1e-10, 4e-12), "y": Material("y", 0.04, 30e9, 0.4, 3000.0)}
    mixed = mix("z", {"x": 0.25, "y": 0.75}, table)
    assert mixed.name == "z"
    assert mixed.youngs_modulus == pytest.approx(25e9)
    assert mixed.critical_rolling_displacement == pytest.approx(1.75e-10)
    assert mixed.viscous_time == pytest.approx(4.75e-12)
    assert mix("z", pd.Series({"x": 0.25, "y": 0.75}), table) == mixed


@pytest.mark.parametrize(
    ("fractions", "message"),
    [
        ({"forsterite": 0.5, "fayalite": 0.4}, "add up to 0.9"),
        ({"forsterite": 1.5, "fayalite": -0.5}, "at least 0"),
        ({"forsterite": math.nan}, "at least 0"),
        ({}, "at least 0"),
        ({"cheese": 1.0}, "cheese"),
        ({"forsterite": "1"}, "at least 0"),
        (None, "must be a dict"),
    ],
)
def test_wrong_mixtures_are_refused(fractions, message):
    with pytest.raises(InputError, match=message):
        mix("z", fractions)
    with pytest.raises(InputError, match=message):
        element_ratios(fractions)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"surface_energy": 0.0}, "surface_energy = 0.0; it must be a number above 0"),
        ({"youngs_modulus": math.nan}, "youngs_modulus"),
        ({"poisson_number": 0.6}, "above 0 and at most 0.5"),
        ({"poisson_number": 0.0}, "above 0 and at most 0.5"),
        ({"density": "heavy"}, "density"),
        ({"density": True}, "density"),
        ({"critical_rolling_displacement": -1e-10}, "critical_rolling_displacement"),
        ({"viscous_time": -1e-12}, "at least 0"),
        ({"viscous_time": math.inf}, "at least 0"),
        ({"name": ""}, "name"),
        ({"youngs_modulus": 50}, "it is in Pa, and no solid has one below 10000"),
        ({"viscous_time": 5.0}, "it is in s, and no solid has one below 0 or above 1e-07"),
        ({"density": 2.0}, "it is in kg/m3"),
        ({"surface_energy": 20.0}, "it is in J/m2"),
    ],
)
def test_wrong_materials_are_refused(changes, message):
    good = dict(name="x", surface_energy=0.02, youngs_modulus=50e9, poisson_number=0.25, density=2000.0)
    Material(**good)
    with pytest.raises(InputError, match=message):
        Material(**{**good, **changes})
