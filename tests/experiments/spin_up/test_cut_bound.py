import math

import numpy as np
import pytest

import naive_geometry as naive
from ratd.aggregates.grain import Grain
from ratd.aggregates.growth import grow, grow_with_radii
from ratd.aggregates.strength import midplane_tension, tensile_strength_tatsuuma2019
from ratd.base.errors import InputError
from ratd.base.materials import get_material
from ratd.experiments.spin_up.cut_bound import (
    contact_strengths,
    cut_bound,
    least_bridge_cut,
    least_plane_cut,
    plane_normals,
)
from ratd.geometry.shape import principal_axes
from ratd.laws.contact_constants import equilibrium_compression, pull_off_force


def small_grain(type, n, seed):
    return grow_with_radii(type, np.random.default_rng(seed).uniform(10e-9, 100e-9, n), "q-S", seed)


def loads(grain):
    """Pull on each monomer at omega = 1 about a_1, (n, 2), written out anew."""
    axis = principal_axes(grain.position, grain.mass, grain.radius)[1][0]
    x = grain.position - np.average(grain.position, axis=0, weights=grain.mass)
    across = x - np.outer(x @ axis, axis)
    u = np.cross(axis, [0.3, -0.5, 0.8])
    u /= np.linalg.norm(u)
    return grain.mass[:, None] * np.stack([across @ u, across @ np.cross(axis, u)], axis=1)


def strengths(grain):
    return contact_strengths(grain.radius, grain.contacts, grain.material.surface_energy)


@pytest.mark.parametrize("material", ["a-C", "q-S", "co-S"])
@pytest.mark.parametrize("a", [10e-9, 37e-9, 100e-9])
def test_two_equal_monomers(material, a):
    grain = grow_with_radii("BA", [a, a], material, 1)
    gamma = grain.material.surface_energy
    exact = math.sqrt(3 * math.pi * gamma / (2 * grain.mass[0]))
    # The centres are 2 a - delta_0 apart, not 2 a.
    delta_0 = equilibrium_compression(a / 2, gamma, grain.material.reduced_modulus)
    assert cut_bound(grain) == pytest.approx(exact / math.sqrt(1 - delta_0 / (2 * a)), rel=1e-12)
    assert cut_bound(grain) == pytest.approx(exact, rel=0.003)


def test_a_row_of_four_breaks_in_the_middle():
    quartz = get_material("q-S")
    a = 30e-9
    d = 2 * a - equilibrium_compression(a / 2, quartz.surface_energy, quartz.reduced_modulus)
    grain = Grain(np.outer(np.arange(4), [0.0, d, 0.0]), np.full(4, a), quartz)
    # Two monomers at d/2 and 3 d/2 pull at one contact.
    middle = math.sqrt(pull_off_force(a / 2, quartz.surface_energy) / (2 * d * grain.mass[0]))
    assert cut_bound(grain) == pytest.approx(middle, rel=1e-12)
    # About the row itself nothing pulls.
    assert cut_bound(grain, axis=[0, 1, 0]) > 1e6 * middle
    assert cut_bound(grain, axis=[5.0, 0, 0]) == pytest.approx(middle, rel=1e-12)


def test_strengths_are_pull_off_forces_of_each_pair():
    grain = small_grain("BAM2", 12, 3)
    for (i, j), force in zip(grain.contacts, strengths(grain), strict=True):
        R = 1 / (1 / grain.radius[i] + 1 / grain.radius[j])
        assert force == pytest.approx(3 * math.pi * 0.02 * R, rel=1e-13)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("n", [2, 3, 7, 10])
def test_the_bound_of_a_tree_is_the_least_of_all_its_cuts(n, seed):
    grain = small_grain("BA", n, seed)
    assert grain.n_contacts == n - 1
    arguments = loads(grain), grain.contacts, strengths(grain)
    everything = naive.least_cut(*arguments)
    assert naive.least_bridge_cut(*arguments) == pytest.approx(everything, rel=1e-12)
    assert least_bridge_cut(*arguments) == pytest.approx(everything, rel=1e-12)
    assert cut_bound(grain) == pytest.approx(math.sqrt(everything), rel=1e-12)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize(("type", "n"), [("BAM1", 5), ("BAM1", 10), ("BAM2", 6), ("BAM2", 10)])
def test_with_more_contacts_the_bound_lies_above_the_least_of_all_cuts_but_not_far(type, n, seed):
    grain = small_grain(type, n, seed)
    least = math.sqrt(naive.least_cut(loads(grain), grain.contacts, strengths(grain)))
    assert least * (1 - 1e-12) <= cut_bound(grain) <= 1.3 * least


@pytest.mark.parametrize("seed", range(6))
def test_bridges_are_found_among_rings(seed):
    # Any graph will do: places and contacts need not go together here.
    rng = np.random.default_rng(seed)
    n = 25
    tree = [(int(rng.integers(j)), j) for j in range(1, n)]
    extra = [tuple(sorted(rng.choice(n, 2, replace=False).tolist())) for _ in range(seed + 1)]
    contacts = np.array(sorted({*tree, *extra}))
    load = rng.normal(size=(n, 2))
    load -= load.mean(axis=0)
    strength = rng.uniform(1, 2, len(contacts))
    expected = naive.least_bridge_cut(load, contacts, strength)
    assert math.isfinite(expected)
    assert least_bridge_cut(load, contacts, strength) == pytest.approx(expected, rel=1e-10)


def test_a_ring_has_no_bridge():
    contacts = np.array([[0, 1], [0, 3], [1, 2], [2, 3]])
    assert least_bridge_cut(np.ones((4, 2)), contacts, np.ones(4)) == math.inf


def test_plane_cuts_are_those_of_sorting_along_each_normal():
    grain = small_grain("BAM1", 20, 1)
    load, strength, normals = loads(grain), strengths(grain), plane_normals(17)
    expected = math.inf
    for normal in normals:
        order = np.argsort(grain.position @ normal)
        for below in range(1, 20):
            part = np.zeros(20, dtype=bool)
            part[order[:below]] = True
            expected = min(expected, naive.cut(load, grain.contacts, strength, part))
    assert least_plane_cut(grain.position, load, grain.contacts, strength, normals) == pytest.approx(expected, rel=1e-9)


def test_plane_normals_are_spread_over_the_half_sphere():
    normals = plane_normals(2000)
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0)
    assert np.all(normals[:, 2] > 0.0)
    np.testing.assert_allclose(normals.T @ normals / 2000, np.eye(3) / 3, atol=1e-3)


def test_the_bound_does_not_depend_on_orientation_and_grows_with_the_square_root_of_the_surface_energy():
    grain = grow("BA", 200e-9, "q-S", 5)
    q, _ = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))
    turned = Grain(grain.position @ q + 1e-6, grain.radius, "q-S")
    assert cut_bound(turned) == pytest.approx(cut_bound(grain), rel=1e-9)
    load = loads(grain)
    four_times = contact_strengths(grain.radius, grain.contacts, 4 * 0.02)
    assert least_bridge_cut(load, grain.contacts, four_times) == pytest.approx(
        4 * least_bridge_cut(load, grain.contacts, strengths(grain)), rel=1e-12
    )


@pytest.mark.parametrize(("a_eff", "one_grain"), [(200e-9, 1.7e7), (350e-9, 0.5e7)])
def test_ba_grains_of_quartz_are_as_weak_as_in_trials(a_eff, one_grain):
    # Trial values of one grain each; grains differ among themselves by about a third.
    bounds = [cut_bound(grow("BA", a_eff, "q-S", seed)) for seed in range(12)]
    assert np.mean(bounds) == pytest.approx(one_grain, rel=0.35)
    assert min(bounds) < one_grain < max(bounds)


@pytest.mark.parametrize("axis", [[0, 0, 0], [1, 0], [math.nan, 0, 1], [math.inf, 0, 0]])
def test_an_axis_without_direction_is_refused(axis):
    with pytest.raises(InputError, match="axis"):
        cut_bound(small_grain("BA", 3, 1), axis=axis)


@pytest.mark.parametrize("directions", [0, -3, 2.5, True])
def test_a_wrong_number_of_directions_is_refused(directions):
    with pytest.raises(InputError, match="directions"):
        cut_bound(small_grain("BA", 3, 1), directions=directions)


def test_tensile_strength_of_tatsuuma_2019():
    # 9.51 kPa for 100 mJ/m2, monomers of 0.1 um and a filling factor of 0.1
    assert tensile_strength_tatsuuma2019(0.1, 0.1e-6, 0.1) == pytest.approx(9.51e3, rel=1e-3)
    assert tensile_strength_tatsuuma2019(0.1, 0.1e-6, 1.0) == pytest.approx(6e5)
    assert tensile_strength_tatsuuma2019(0.02, 0.2e-6, 1.0) == pytest.approx(6e4)


def test_midplane_tension_is_the_pull_of_half_a_sphere():
    omega, density, phi, size = 3e7, 2650.0, 0.4, 4e-7
    x = (np.arange(100000) + 0.5) / 100000 * size
    pull = np.sum(density * phi * omega**2 * x * math.pi * (size**2 - x**2)) * size / 100000
    assert midplane_tension(omega, density, phi, size) == pytest.approx(pull / (math.pi * size**2), rel=1e-8)
