import numpy as np
import pytest

import naive_geometry as naive
from ratd.base.jit import jit
from ratd.geometry.neighbours import close_images, close_pairs, connected_components


def spheres(n, extent, seed, shape="box"):
    rng = np.random.default_rng(seed)
    position = rng.uniform(-extent, extent, (n, 3))
    radius = np.clip(rng.lognormal(np.log(20e-9), 0.844, n), 10e-9, 100e-9)
    if shape == "line":
        position[:, :2] = 0.0
    if shape == "plane":
        position[:, 1] = 3e-7
    if shape == "clusters":
        # Close pairs very far apart: a dense grid over the whole would be out of the question.
        position[n // 2 :] = position[: n - n // 2] + 1e-8
    return position, radius


@pytest.mark.parametrize("reach", [-5e-9, 0.0, 2e-9, 5e-8, 3e-7])
@pytest.mark.parametrize(
    ("n", "extent", "shape"),
    [
        (2, 5e-8, "box"),
        (3, 1e-7, "line"),
        (200, 2e-7, "box"),
        (250, 1e-6, "box"),
        (150, 3e-6, "line"),
        (150, 1e-6, "plane"),
        (120, 1.0, "clusters"),
        (120, 1e12, "clusters"),
    ],
)
def test_close_pairs_are_those_of_a_double_loop(n, extent, shape, reach):
    position, radius = spheres(n, extent, seed=n, shape=shape)
    pairs = close_pairs(position, radius, reach)
    assert pairs.dtype == np.int64
    np.testing.assert_array_equal(pairs, naive.close_pairs(position, radius, reach))


def test_close_pairs_in_very_many_neighbours():
    position, radius = spheres(80, 1e-9, seed=1)
    assert len(close_pairs(position, radius, 0.0)) == 80 * 79 // 2


def test_spheres_on_the_borders_of_cells():
    # A cubic lattice whose constant is the width of a cell: every sphere has its partners in other cells.
    lattice = np.stack(np.meshgrid(*[np.arange(5)] * 3, indexing="ij"), axis=-1).reshape(-1, 3) * 2.0
    radius = np.ones(125)
    assert len(close_pairs(lattice, radius, -1e-9)) == 0
    assert len(close_pairs(lattice, radius, 1e-9)) == 3 * 5 * 5 * 4
    assert len(close_pairs(lattice - 100.0, radius, 0.9)) == 3 * 5 * 5 * 4 + 6 * 5 * 4 * 4


@pytest.mark.parametrize("n", [0, 1])
def test_too_few_spheres_for_a_pair(n):
    assert close_pairs(np.zeros((n, 3)), np.ones(n), 1.0).shape == (0, 2)


def test_a_reach_below_all_diameters_finds_nothing():
    assert close_pairs(np.zeros((3, 3)), np.full(3, 1e-8), -1e-7).shape == (0, 2)


def test_the_order_of_the_spheres_does_not_matter():
    position, radius = spheres(300, 4e-7, seed=5)
    shuffled = np.random.default_rng(1).permutation(300)
    back = shuffled[close_pairs(position[shuffled], radius[shuffled], 1e-8)]
    expected = close_pairs(position, radius, 1e-8)
    back = np.sort(back, axis=1)
    np.testing.assert_array_equal(back[np.lexsort((back[:, 1], back[:, 0]))], expected)


def test_both_can_be_called_from_compiled_code():
    @jit
    def pieces(position, radius):
        return connected_components(radius.shape[0], close_pairs(position, radius, 0.0)).max() + 1

    position, radius = spheres(100, 4e-7, seed=2)
    pairs = naive.close_pairs(position, radius, 0.0)
    assert pieces(position, radius) == naive.connected_components(100, pairs).max() + 1


@pytest.mark.parametrize(("n", "k"), [(1, 0), (6, 0), (40, 15), (60, 40), (60, 200)])
def test_components_are_those_of_spreading_labels(n, k):
    rng = np.random.default_rng(n + k)
    pairs = np.array([rng.choice(n, 2, replace=False) for _ in range(k)], dtype=np.int64).reshape(-1, 2)
    label = connected_components(n, pairs)
    assert label.dtype == np.int64
    np.testing.assert_array_equal(label, naive.connected_components(n, pairs))


def test_components_are_counted_in_the_order_of_their_first_monomers():
    pairs = np.array([[5, 1], [4, 0], [3, 5]])
    np.testing.assert_array_equal(connected_components(6, pairs), [0, 1, 2, 1, 0, 1])


def test_a_long_chain_given_backwards_is_one_piece():
    pairs = np.stack([np.arange(9999, 0, -1), np.arange(9998, -1, -1)], axis=1)
    assert connected_components(10000, pairs).max() == 0


@pytest.mark.parametrize("reach", [0.3, 0.0, -0.3])
@pytest.mark.parametrize(("n", "ratio"), [(300, 1), (400, 10), (500, 50)])
def test_radii_of_very_different_size(n, ratio, reach):
    rng = np.random.default_rng(n)
    radius = np.exp(rng.uniform(0, np.log(ratio), n))
    position = rng.uniform(0, radius.mean() * 2.2 * n ** (1 / 3), (n, 3))
    wanted = naive.close_pairs(position, radius, reach)
    assert len(wanted) > 50
    np.testing.assert_array_equal(close_pairs(position, radius, reach), wanted)


@pytest.mark.parametrize("edge", [11.0, 3.1, 1.7])
@pytest.mark.parametrize("ratio", [1, 50])
def test_images_are_those_of_a_loop_over_all_copies(ratio, edge):
    """Edges from many diameters to less than one, where a sphere meets its own copies and a pair meets many times."""
    rng = np.random.default_rng(7)
    n = 30
    radius = np.exp(rng.uniform(0, np.log(ratio), n)) if ratio > 1 else np.ones(n)
    radius /= radius.max()
    edges = np.array([1.0, 1.1, 0.9]) * edge
    position = rng.uniform(0, 1, (n, 3)) * edges + rng.integers(-3, 4, (n, 3)) * edges
    found = close_images(position, radius, 0.2, tuple(edges))
    rows = list(map(tuple, found.tolist()))
    assert len(set(rows)) == len(rows)
    assert [row[:2] for row in rows] == sorted(row[:2] for row in rows)
    assert set(rows) == naive.close_images(position, radius, 0.2, edges)
    if edge < 2.0:
        assert any(i == j for i, j, *_ in rows) and len({row[:2] for row in rows}) < len(rows)
