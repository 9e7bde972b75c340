import math

import numpy as np
import pytest

import naive_geometry as naive
from ratd import disruption, spin_up
from ratd.aggregates.grain import Grain
from ratd.aggregates.growth import grow, grow_with_radii
from ratd.base.materials import get_material
from ratd.experiments.spin_up.cut_bound import cut_bound, plane_normals
from ratd.experiments.spin_up.firm_bound import QUARTER, bridge_pulls, firm_bound, slide_forces
from ratd.geometry.shape import principal_axes
from ratd.laws.contact_constants import equilibrium_compression


def small_grain(type, n, seed):
    return grow_with_radii(type, np.random.default_rng(seed).uniform(10e-9, 100e-9, n), "q-S", seed)


def forces(grain):
    """F_C and F_S of each contact, written out anew."""
    own = grain.material
    R = 1 / np.sum(1 / grain.radius[grain.contacts], axis=1)
    pull_off = 3 * math.pi * own.surface_energy * R
    shear = own.youngs_modulus / (2 * (1 + own.poisson_number))
    reduced = own.youngs_modulus / (2 * (1 - own.poisson_number**2))
    r0 = (9 * math.pi * own.surface_energy * R**2 / reduced) ** (1 / 3)
    return pull_off, shear * r0**2 / (4 * math.pi)


def naive_cut(grain, part):
    """omega^2 at which a cut gives way; in three dimensions, contact by contact."""
    axis = principal_axes(grain.position, grain.mass, grain.radius)[1][0]
    x = grain.position - np.average(grain.position, axis=0, weights=grain.mass)
    pull = np.sum(grain.mass[part, None] * (x - np.outer(x @ axis, axis))[part], axis=0)
    size = np.linalg.norm(pull)
    pulls, slides = forces(grain)
    across = np.flatnonzero(part[grain.contacts[:, 0]] != part[grain.contacts[:, 1]])
    held = 0.0
    for c in across:
        inner, outer = sorted(grain.contacts[c], key=lambda i: part[i])
        out = x[outer] - x[inner]
        theta = math.acos(np.clip(out @ pull / (np.linalg.norm(out) * size), -1, 1))
        if len(across) == 1 and theta > 0:
            along = pulls[c] / math.cos(theta) if theta < math.pi / 2 else math.inf
            return min(along, slides[c] / math.sin(theta)) / size
        held += pulls[c] * math.cos(theta) + slides[c] * math.sin(theta) if theta < math.pi / 2 else math.inf
    return held / size


def parts_of_bridges(grain):
    """Both families of cuts: contacts that alone hold two parts together."""
    n = grain.n_monomers
    for c in range(grain.n_contacts):
        labels = naive.connected_components(n, np.delete(grain.contacts, c, axis=0))
        if len(set(labels)) == 2:
            yield np.array(labels) == labels[grain.contacts[c, 0]]


def parts_of_planes(grain, directions):
    for normal in plane_normals(directions):
        order = np.argsort(grain.position @ normal)
        for below in range(1, grain.n_monomers):
            part = np.zeros(grain.n_monomers, dtype=bool)
            part[order[:below]] = True
            yield part


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(("type", "n"), [("BA", 2), ("BA", 14), ("BAM1", 14), ("BAM2", 14)])
def test_the_firm_bound_is_the_least_of_bridges_and_planes(type, n, seed):
    grain = small_grain(type, n, seed)
    parts = [*parts_of_bridges(grain), *parts_of_planes(grain, 23)]
    expected = math.sqrt(min(naive_cut(grain, part) for part in parts))
    assert firm_bound(grain, directions=23) == pytest.approx(expected, rel=1e-9)
    # cuts that leave a quarter of the mass on either side
    large = [part for part in parts if 0.25 <= grain.mass[part].sum() / grain.mass.sum() <= 0.75]
    expected = math.sqrt(min((naive_cut(grain, part) for part in large), default=math.inf))
    assert firm_bound(grain, least_part=QUARTER, directions=23) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("material", ["a-C", "q-S", "co-S"])
@pytest.mark.parametrize("type", ["BA", "BAM1", "BAM2"])
def test_it_lies_above_the_cut_bound(type, material):
    # F_S is above F_C for every pair of monomers of the ensemble.
    grain = grow(type, 150e-9, material, 1)
    pulls, slides = forces(grain)
    assert np.all(slides > pulls)
    assert cut_bound(grain) <= firm_bound(grain) * (1 + 1e-12)


def test_a_contact_slides_at_the_force_of_its_stiffness_at_the_limit():
    grain = small_grain("BAM2", 12, 3)
    R = 1 / np.sum(1 / grain.radius[grain.contacts], axis=1)
    np.testing.assert_allclose(slide_forces(R, grain.material), forces(grain)[1], rtol=1e-12)


@pytest.mark.parametrize("seed", range(6))
def test_bridges_are_found_among_rings_with_what_they_carry(seed):
    rng = np.random.default_rng(seed)
    n = 25
    tree = [(int(rng.integers(j)), j) for j in range(1, n)]
    extra = [tuple(sorted(rng.choice(n, 2, replace=False).tolist())) for _ in range(seed)]
    contacts = np.array(sorted({*tree, *extra}))
    load = rng.normal(size=(n, 2))
    found = {int(c): (int(contacts[c, end]), pull) for c, end, pull in zip(*bridge_pulls(load, contacts), strict=True)}
    for c in range(len(contacts)):
        labels = np.array(naive.connected_components(n, np.delete(contacts, c, axis=0)))
        assert (c in found) == (len(set(labels)) == 2)
        if c in found:
            beyond, pull = found[c]
            np.testing.assert_allclose(pull, load[labels == labels[beyond]].sum(axis=0), atol=1e-12)


def two_triangles(a, angle):
    """Two rigid triangles of equal monomers with one contact between them, which the load pulls at a slant."""
    quartz = get_material("q-S")
    d = 2 * a - equilibrium_compression(a / 2, quartz.surface_energy, quartz.reduced_modulus)
    first = np.array([d / 2, 0.0, 0.0])
    triangle = [first]
    for side in (angle + math.pi / 6, angle - math.pi / 6):
        triangle.append(first + d * np.array([math.cos(side), math.sin(side), 0.0]))
    return Grain(np.array([*triangle, *(-x for x in triangle)]), np.full(6, a), quartz)


@pytest.mark.parametrize("angle", [0.0, 85.0])
def test_a_slanted_load_is_held_beyond_the_cut_bound_and_up_to_the_firm_one(angle):
    grain = two_triangles(20e-9, math.radians(angle))
    _, y, _ = grain.position[:3].mean(axis=0)
    slant = math.atan2(y, grain.position[:3, 0].mean())
    over = firm_bound(grain) / cut_bound(grain)
    assert over == pytest.approx(math.cos(slant) ** -0.5, rel=1e-9)
    run = spin_up(grain, epsilon=0.005, timestep_factor=0.1, records=300)
    assert disruption(run)["omega_first_loss"].item() / firm_bound(grain) == pytest.approx(1.0, abs=0.02)
    assert run["n_contacts"].values.max() == 7
