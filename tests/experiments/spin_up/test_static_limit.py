"""The static limit: exact cases, and a slow and obvious programme."""

import math
from itertools import product
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.optimize import linprog

from ratd.aggregates.grain import Grain
from ratd.aggregates.growth import grow_with_radii
from ratd.base.errors import InputError
from ratd.base.materials import get_material
from ratd.experiments.spin_up.firm_bound import firm_bound
from ratd.experiments.spin_up.static_limit import contact_limits, static_limit
from ratd.geometry.shape import principal_axes
from ratd.laws.contact_constants import equilibrium_compression

OCTAGON = 1.0 / math.cos(math.pi / 8)


def small_grain(type, n, seed):
    return grow_with_radii(type, np.random.default_rng(seed).uniform(10e-9, 100e-9, n), "q-S", seed)


def chain(a, half_angle):
    """Three equal spheres; the outer ones stand in a plane, at half an angle from the line through the middle."""
    quartz = get_material("q-S")
    d = 2 * a - equilibrium_compression(a / 2, quartz.surface_energy, quartz.reduced_modulus)
    out = d * np.array([math.cos(half_angle), math.sin(half_angle), 0.0])
    return Grain(np.array([out * [-1, 1, 1], [0.0, 0.0, 0.0], out]), np.full(3, a), quartz)


def test_limits_of_a_contact_written_out_anew():
    quartz, a = get_material("q-S"), 30e-9
    pull, slide, roll, twist = (each[0] for each in contact_limits(chain(a, 0.0)))
    reduced = quartz.youngs_modulus / (2 * (1 - quartz.poisson_number**2))
    shear = quartz.youngs_modulus / (2 * (1 + quartz.poisson_number))
    r0 = (9 * math.pi * quartz.surface_energy * (a / 2) ** 2 / reduced) ** (1 / 3)
    assert pull == pytest.approx(1.5 * math.pi * quartz.surface_energy * a)
    assert slide == pytest.approx(shear * r0**2 / (4 * math.pi))
    # Dominik & Tielens: 4 F_C xi
    assert roll == pytest.approx(4 * pull * 0.2e-9)
    assert twist == pytest.approx(16 / 3 * (shear / 2) * r0**3 / (16 * math.pi), rel=0.01)


def test_a_straight_chain_holds_what_its_contacts_pull():
    grain = chain(30e-9, 0.0)
    expected = math.sqrt(contact_limits(grain)[0][0] / (grain.mass[0] * np.linalg.norm(grain.position[0])))
    assert static_limit(grain) == pytest.approx(expected, rel=1e-6)
    assert static_limit(grain) == pytest.approx(firm_bound(grain), rel=1e-6)


@pytest.mark.parametrize("half_angle", [0.2, 0.6])
def test_a_bent_chain_holds_what_its_contacts_roll(half_angle):
    """An outer sphere is in balance if the force across its contact times its radius is a torque that rolls it."""
    a = 30e-9
    grain = chain(a, half_angle)
    x = grain.position[2] - np.average(grain.position, axis=0, weights=grain.mass)
    along = grain.position[2] / np.linalg.norm(grain.position[2])
    aside = grain.mass[2] * np.linalg.norm(x - (x @ along) * along)
    exact = math.sqrt(contact_limits(grain)[2][0] / (a * aside))
    assert exact < 0.5 * firm_bound(grain)
    assert exact * (1 - 1e-6) < static_limit(grain) < exact * OCTAGON**0.5 * (1 + 1e-6)


def obvious(grain, axis):
    """omega^2 of the same programme, contact by contact, with vectors of force and torque in place of components."""
    pull, slide, roll, twist = contact_limits(grain)
    n, k, a, unit = grain.n_monomers, grain.n_contacts, grain.radius, pull.max()
    x = grain.position - np.average(grain.position, axis=0, weights=grain.mass)
    load = grain.mass[:, None] * (x - np.outer(x @ axis, axis))
    scale = np.abs(load).max()
    A, ub, b = np.zeros((6 * n, 6 * k + 1)), [], []
    for c, (i, j) in enumerate(grain.contacts):
        distance = np.linalg.norm(x[j] - x[i])
        normal = (x[j] - x[i]) / distance
        to_contact = distance * a[i] / (a[i] + a[j])
        for axis_of, unit_vector in enumerate(np.eye(3)):
            # force of unit length on i, at the contact, and the opposite one on j
            A[6 * i : 6 * i + 3, 6 * c + axis_of] += unit_vector
            A[6 * j : 6 * j + 3, 6 * c + axis_of] -= unit_vector
            A[6 * i + 3 : 6 * i + 6, 6 * c + axis_of] += np.cross(to_contact * normal, unit_vector) / a.mean()
            A[6 * j + 3 : 6 * j + 6, 6 * c + axis_of] += (
                np.cross((to_contact - distance) * normal, -unit_vector) / a.mean()
            )
            A[6 * i + 3 : 6 * i + 6, 6 * c + 3 + axis_of] += unit_vector
            A[6 * j + 3 : 6 * j + 6, 6 * c + 3 + axis_of] -= unit_vector
        aside = np.eye(3)[np.abs(normal).argmin()]
        first = np.cross(normal, aside) / np.linalg.norm(np.cross(normal, aside))
        second = np.cross(normal, first)
        limits = [(0, normal, pull[c] / unit)]
        for step, (place, limit) in product(range(8), ((0, slide[c] / unit), (3, roll[c] / (unit * a.mean())))):
            side = math.cos(step * math.pi / 4) * first + math.sin(step * math.pi / 4) * second
            limits.append((place, side, limit))
        limits += [(3, sign * normal, twist[c] / (unit * a.mean())) for sign in (1, -1)]
        for place, side, limit in limits:
            row = np.zeros(6 * k + 1)
            row[6 * c + place : 6 * c + place + 3] = side
            ub.append(row)
            b.append(limit)
    for i in range(n):
        A[6 * i : 6 * i + 3, -1] = load[i] / scale
    goal = np.append(np.zeros(6 * k), -1.0)
    free = [(None, None)] * (6 * k) + [(0, None)]
    found = linprog(goal, np.array(ub), b, A, np.zeros(6 * n), free, method="highs-ds")
    return found.x[-1] * unit / scale


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("type", ["BA", "BAM1", "BAM2"])
def test_it_is_that_of_the_obvious_programme(type, seed):
    grain = small_grain(type, 12, seed)
    axes = principal_axes(grain.position, grain.mass, grain.radius)[1]
    assert static_limit(grain) == pytest.approx(static_limit(grain, axis=2.0 * axes[0]), rel=1e-9)
    for axis in axes:
        limit = static_limit(grain, axis=axis)
        assert limit == pytest.approx(math.sqrt(obvious(grain, axis)), rel=1e-6)
        assert limit < OCTAGON**0.5 * firm_bound(grain, axis=axis)
    assert firm_bound(grain, axis=axes[0]) == pytest.approx(firm_bound(grain), rel=1e-12)


def test_off_a_principal_axis_the_grain_tips_over_whichever_monomer_is_the_first():
    grain = small_grain("BAM2", 14, 3)
    order = np.random.default_rng(0).permutation(grain.n_monomers)
    other = Grain(grain.position[order], grain.radius[order], grain.material)
    limits = [static_limit(each, axis=[0.3, 0.5, 0.8]) for each in (grain, other)]
    assert limits[0] == pytest.approx(limits[1], rel=1e-6)


def test_what_is_no_grain_or_has_no_contacts_is_one_sentence():
    with pytest.raises(InputError, match="grain is a str"):
        static_limit("BAM2")
    quartz = get_material("q-S")
    lonely = SimpleNamespace(
        position=np.zeros((1, 3)), radius=np.ones(1), mass=np.ones(1), contacts=np.empty((0, 2), int), material=quartz
    )
    with pytest.raises(InputError, match="has no contacts"):
        static_limit(lonely)


def test_trees_hold_less_than_grains_whose_monomers_have_three_contacts():
    share = {
        type: static_limit(small_grain(type, 20, 1)) / firm_bound(small_grain(type, 20, 1)) for type in ("BA", "BAM2")
    }
    assert share["BA"] < 0.3 < share["BAM2"]
