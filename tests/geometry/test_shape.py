import math

import numpy as np
import pytest

import naive_geometry as naive
from ratd.geometry.shape import (
    Shape,
    centre_of_mass,
    enclosing_radius,
    enclosing_sphere,
    fractal_dimension,
    greatest_extent,
    inertia_tensor,
    mean_coordination,
    porosity,
    principal_axes,
    semi_axes,
    shape_of,
    spin_share,
)

DENSITY = 2650.0


def monomers(n, seed, spread=2e-7):
    rng = np.random.default_rng(seed)
    radius = rng.uniform(10e-9, 100e-9, n)
    position = rng.normal(size=(n, 3)) * spread * np.array([1.0, 0.7, 1.6]) + 1e-6
    return position, 4 / 3 * math.pi * DENSITY * radius**3, radius


def rotation(seed):
    q, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return q * np.sign(np.linalg.det(q))


@pytest.mark.parametrize("n", [1, 2, 3, 50])
def test_inertia_tensor_is_the_naive_one(n):
    position, mass, radius = monomers(n, seed=n)
    np.testing.assert_allclose(centre_of_mass(position, mass), np.average(position, axis=0, weights=mass), rtol=1e-13)
    expected = naive.inertia_tensor(position, mass, radius)
    np.testing.assert_allclose(inertia_tensor(position, mass, radius), expected, atol=1e-12 * np.abs(expected).max())


@pytest.mark.parametrize("n", [2, 3, 50])
def test_principal_axes_diagonalise_the_tensor(n):
    position, mass, radius = monomers(n, seed=n)
    tensor = naive.inertia_tensor(position, mass, radius)
    moments, axes = principal_axes(position, mass, radius)
    assert moments[0] >= moments[1] >= moments[2] > 0.0
    np.testing.assert_allclose(moments, np.linalg.eigvalsh(tensor)[::-1], rtol=1e-12)
    np.testing.assert_allclose(axes @ tensor @ axes.T, np.diag(moments), atol=1e-13 * moments[0])
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-14)
    assert np.linalg.det(axes) == pytest.approx(1.0)


def test_the_sense_of_the_axes_is_fixed():
    position, mass, radius = monomers(30, seed=3)
    _, axes = principal_axes(position, mass, radius)
    _, turned = principal_axes(-position, mass, radius)
    np.testing.assert_allclose(turned, axes, atol=1e-12)
    for axis in axes[:2]:
        assert axis[np.argmax(np.abs(axis))] > 0.0


def test_moments_do_not_depend_on_place_or_orientation():
    position, mass, radius = monomers(40, seed=4)
    q = rotation(1)
    moments, axes = principal_axes(position, mass, radius)
    moved, turned = principal_axes(np.ascontiguousarray(position @ q.T + 3e-6), mass, radius)
    np.testing.assert_allclose(moved, moments, rtol=1e-10)
    np.testing.assert_allclose(np.abs(np.sum(turned * (axes @ q.T), axis=1)), 1.0, rtol=1e-9)


@pytest.mark.parametrize("a", [10e-9, 550e-9, 3.0])
def test_a_solid_sphere_has_no_porosity_and_equal_axes(a):
    mass = np.array([4 / 3 * math.pi * DENSITY * a**3])
    result = shape_of(np.zeros((1, 3)), mass, np.array([a]), DENSITY)
    assert result == pytest.approx((a, a, a, 0.0), rel=1e-12, abs=1e-12)


def test_semi_axes_of_a_solid_ellipsoid():
    a, b, c = 1e-7, 2e-7, 5e-7
    mass = 4 / 3 * math.pi * DENSITY * a * b * c
    moments = mass / 5 * np.array([b**2 + c**2, a**2 + c**2, a**2 + b**2])
    a_eff = (a * b * c) ** (1 / 3)
    axis = semi_axes(moments, DENSITY, a_eff)
    np.testing.assert_allclose(axis, [a, b, c], rtol=1e-12)
    assert porosity(*axis, a_eff) == pytest.approx(0.0, abs=1e-12)


def test_porosity_of_a_half_filled_ellipsoid():
    # The same mass as half the ellipsoid's, spread evenly over it: all lengths stay, half is empty.
    a, b, c = 1e-7, 2e-7, 3e-7
    a_eff = (0.5 * a * b * c) ** (1 / 3)
    mass = 4 / 3 * math.pi * DENSITY * a_eff**3
    axis = semi_axes(mass / 5 * np.array([b**2 + c**2, a**2 + c**2, a**2 + b**2]), DENSITY, a_eff)
    np.testing.assert_allclose(axis, [a, b, c], rtol=1e-12)
    assert porosity(*axis, a_eff) == pytest.approx(0.5)


def test_two_equal_monomers():
    # Along the line: alpha = 2 m 2/5 a^2; across: + 2 m a^2. With a_eff^3 = 2 a^3: a = b = a, c = sqrt(6) a.
    a = 30e-9
    position = np.array([[0.0, 0.0, a], [0.0, 0.0, -a]])
    mass = np.full(2, 4 / 3 * math.pi * DENSITY * a**3)
    result = shape_of(position, mass, np.full(2, a), DENSITY)
    assert result == pytest.approx((a, a, math.sqrt(6) * a, 1 - 2 / math.sqrt(6)), rel=1e-12)


def test_no_monomers_have_no_shape():
    assert all(math.isnan(x) for x in shape_of(np.empty((0, 3)), np.empty(0), np.empty(0), DENSITY))


def test_enclosing_sphere_of_one_of_two_and_of_one_inside_another():
    centre, size = enclosing_sphere([[1.0, 2.0, 3.0]], [0.5])
    np.testing.assert_allclose([*centre, size], [1.0, 2.0, 3.0, 0.5])
    centre, size = enclosing_sphere([[0.0, 0.0, 0.0], [0.0, 0.0, 10.0]], [1.0, 3.0])
    np.testing.assert_allclose([*centre, size], [0.0, 0.0, 6.0, 7.0], atol=1e-9)
    centre, size = enclosing_sphere([[0.0, 0.0, 0.0], [0.5, 0.0, 0.0]], [5.0, 1.0])
    np.testing.assert_allclose([*centre, size], [0.0, 0.0, 0.0, 5.0], atol=1e-9)


def test_greatest_extent_is_that_of_whole_spheres_along_one_axis():
    assert greatest_extent(np.array([[0.0, 0.0, 0.0], [0.0, 3.0, 2.0]]), np.array([1.0, 0.5])) == 4.5
    assert greatest_extent(np.zeros((1, 3)), np.array([2.0])) == 4.0


def test_enclosing_sphere_of_a_tetrahedron():
    corner = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]) * 1e-7
    assert enclosing_radius(corner, np.full(4, 2e-8)) == pytest.approx(math.sqrt(3) * 1e-7 + 2e-8, rel=1e-9)


@pytest.mark.parametrize("form", ["box", "equal", "plane", "line", "shell", "lattice"])
@pytest.mark.parametrize("n", [3, 5, 20, 400])
def test_enclosing_sphere_encloses_and_none_nearby_is_smaller(n, form):
    rng = np.random.default_rng(n)
    position = rng.normal(size=(n, 3)) * 2e-7
    radius = rng.uniform(1e-8, 1e-7, n)
    if form == "equal":
        radius[:] = 4e-8
    if form == "plane":
        position[:, 2] = 0.0
    if form == "line":
        position[:, 1:] = 0.0
    if form == "shell":
        position *= 3e-7 / np.linalg.norm(position, axis=1)[:, None]
        radius[:] = 4e-8
    if form == "lattice":
        position = np.rint(position / 1e-7) * 1e-7
        radius[:] = 4e-8

    def needed(centre):
        return np.max(np.linalg.norm(position - centre, axis=1) + radius)

    centre, size = enclosing_sphere(position, radius)
    assert needed(centre) <= size * (1.0 + 1e-12)
    # The size needed is a convex function of the centre: where no step lowers it, no other centre does.
    for step in 10.0 ** np.arange(-15, -7):
        for _ in range(20):
            assert needed(centre + step * rng.normal(size=3)) > size * (1.0 - 1e-9)


@pytest.mark.parametrize("dimension", [1.0, 2.0, 3.0])
def test_fractal_dimension_of_power_laws(dimension):
    # As many monomers within r as r^D, in random directions about a centre that they keep by pairs.
    rng = np.random.default_rng(7)
    n = 2000
    direction = rng.normal(size=(n // 2, 3))
    direction /= np.linalg.norm(direction, axis=1)[:, None]
    half = direction * rng.uniform(size=(n // 2, 1)) ** (1.0 / dimension) * 1e-6
    value, error = fractal_dimension(np.concatenate([half, -half]), np.ones(n))
    assert 0.0 < error < 0.2
    assert value == pytest.approx(dimension, abs=4 * error)


def test_fractal_dimension_of_an_exact_power_law():
    # The k-th of n monomers at r = k^(1/D): every shell but for its rounded borders has the same density law.
    n, dimension = 3000, 2.5
    distance = (np.arange(1, n // 2 + 1) - 0.5) ** (1 / dimension)
    position = np.zeros((n, 3))
    position[: n // 2, 0] = distance
    position[n // 2 :, 0] = -distance
    value, error = fractal_dimension(position * 1e-8, np.ones(n))
    # The innermost shell, a ball, has a slightly other mean than a thin one; that is the 0.02 left over.
    assert value == pytest.approx(dimension, abs=0.03)
    assert error < 0.02


def test_fractal_dimension_needs_nine_monomers():
    position, mass, _ = monomers(9, seed=1)
    value, error = fractal_dimension(position, mass)
    assert math.isfinite(value) and error >= 0.0
    assert all(math.isnan(x) for x in fractal_dimension(position[:8], mass[:8]))


def test_fractal_dimension_ignores_the_scale_of_length_and_mass():
    position, mass, _ = monomers(60, seed=1)
    assert fractal_dimension(position * 1e3, mass * 7) == pytest.approx(fractal_dimension(position, mass), rel=1e-9)


def test_mean_coordination():
    assert mean_coordination(4, 6) == 3.0


def test_shape_puts_all_together():
    position, mass, radius = monomers(60, seed=9)
    shape = Shape.measure(position, radius, DENSITY, n_contacts=90)
    moments, axes = principal_axes(position, mass, radius)
    np.testing.assert_allclose(shape.moments, moments, rtol=1e-14)
    np.testing.assert_array_equal(shape.axes, axes)
    expected = semi_axes(moments, DENSITY, np.sum(radius**3) ** (1 / 3))
    assert (shape.a, shape.b, shape.c) == pytest.approx(tuple(expected), rel=1e-12)
    assert shape.a <= shape.b <= shape.c
    assert shape.filling_factor == 1.0 - shape.porosity
    assert shape.mean_coordination == 3.0
    assert shape.enclosing_radius == enclosing_radius(position, radius)
    assert (shape.fractal_dimension, shape.fractal_dimension_error) == fractal_dimension(position, mass)


def test_share_of_the_spins_of_two_equal_spheres():
    # each 2/5 m a^2 of its own, and m a^2 for its way around the middle
    a, density = 30e-9, 2000.0
    mass = 4 / 3 * np.pi * density * a**3
    assert spin_share([a, a], density, 2 * (0.4 + 1.0) * mass * a**2) == pytest.approx(0.8 / 2.8)
