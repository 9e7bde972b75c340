"""Clusters that grow by cluster-cluster aggregation."""

import numpy as np
import pytest

import ratd
from ratd.aggregates.cluster_growth import first_touch
from ratd.geometry.neighbours import close_pairs
from ratd.laws.contact_constants import touching_distance
from ratd.observables.structure import radius_of_gyration

ICE = ratd.MATERIALS["ice"]
CONSTANTS = ICE.surface_energy, ICE.reduced_modulus


def first_touch_of_all_pairs(moving, moving_radius, still, still_radius, direction):
    """The same as `first_touch`, pair by pair."""
    way = np.inf
    for i, x in enumerate(moving):
        for k, y in enumerate(still):
            apart = y - x
            along = apart @ direction
            beside = apart @ apart - along**2
            touch = touching_distance(moving_radius[i], still_radius[k], *CONSTANTS)
            if beside < touch**2:
                way = min(way, along - np.sqrt(touch**2 - beside))
    return way


def test_first_touch_is_that_of_all_pairs():
    rng = np.random.default_rng(0)
    hits = 0
    for _ in range(50):
        moving, still = rng.uniform(-6e-7, 6e-7, (12, 3)), rng.uniform(-6e-7, 6e-7, (9, 3))
        radii = rng.uniform(2e-8, 1.5e-7, 12), rng.uniform(2e-8, 1.5e-7, 9)
        direction = rng.normal(size=3)
        direction /= np.linalg.norm(direction)
        moving += 4e-7 * rng.normal(size=3)
        way = first_touch(moving, radii[0], still, radii[1], direction, *CONSTANTS)
        slow = first_touch_of_all_pairs(moving, radii[0], still, radii[1], direction)
        assert way == pytest.approx(slow, rel=1e-9) or way == slow == np.inf
        hits += way < np.inf
    assert 20 < hits < 50


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_a_cluster_is_a_tree_free_of_force_but_for_pairs_that_come_near_by_chance(seed):
    cluster = ratd.grow_bcca(512, seed=seed)
    i, j = cluster.contacts.T
    distance = np.linalg.norm(cluster.position[i] - cluster.position[j], axis=1)
    touch = touching_distance(1e-7, 1e-7, *CONSTANTS)
    made = np.abs(distance / touch - 1.0) < 1e-9
    assert made.sum() == 511
    assert (distance[~made] > touch).all() and (~made).sum() < 10
    assert len(close_pairs(cluster.position, np.full(512, 0.5 * touch * (1.0 - 1e-9)), 0.0)) == 0
    assert np.allclose(cluster.position.mean(axis=0), 0.0, atol=1e-15)


def test_the_radius_of_gyration_is_that_of_an_independent_code():
    clusters = [ratd.grow_bcca(1024, seed=seed) for seed in range(60)]
    size = np.array([radius_of_gyration(cluster.position, cluster.mass) for cluster in clusters]) / 1e-7
    assert 35.0 < size.mean() < 39.0 and 3.0 < size.std() < 11.0


def test_the_fractal_dimension_is_near_1_9():
    size = [
        np.mean([radius_of_gyration(c.position, c.mass) for c in (ratd.grow_bcca(n, seed=s) for s in range(30))])
        for n in (64, 4096)
    ]
    assert np.log(4096 / 64) / np.log(size[1] / size[0]) == pytest.approx(1.9, abs=0.15)


def test_a_seed_gives_one_shape_of_any_material_and_copies_another():
    ice, silicate = ratd.grow_bcca(64, seed=3), ratd.grow_bcca(64, "silicate", seed=3)
    assert (ice.position == ratd.grow_bcca(64, seed=3).position).all()
    assert silicate.position / 6e-7 == pytest.approx(ice.position / 1e-7, abs=0.2)
    copies = ratd.grow_bcca(64, seed=3, copies=True)
    assert not np.allclose(copies.position, ice.position)


def test_with_copies_both_halves_have_the_same_distances():
    position = ratd.grow_bcca(32, seed=1, copies=True).position
    halves = [np.linalg.norm(half[:, None] - half[None], axis=2) for half in (position[:16], position[16:])]
    assert halves[0] == pytest.approx(halves[1], abs=1e-16)


def test_unequal_radii_are_those_given():
    radii = np.linspace(5e-8, 3e-7, 128)
    cluster = ratd.grow_bcca(128, "q-S", seed=0, radii=radii)
    assert (np.sort(cluster.radius) == radii).all() and not (cluster.radius == radii).all()
    assert cluster.n_contacts >= 127


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"n": 1000}, r"n is 1000; it must be a power of 2 from 2 on \(512 or 1024\)"),
        ({"n": 1}, "n is 1; it must be a power of 2 from 2 on,"),
        ({"n": 64.0}, "n is 64.0; it must be a power of 2"),
        ({"n": 2**40}, "n is 1099511627776; it must be at most 16777216: "),
        (
            {"n": 64, "material": "q-S"},
            "radius is None; it must be a number above 0, in m, and may be left out for ice",
        ),
        ({"n": 64, "radius": -1.0}, "radius is -1.0; it must be a number above 0"),
        ({"n": 64, "radii": [1e-7] * 63}, r"radii must be 64 finite numbers above 0.* they are of the shape \(63,\)"),
        ({"n": 2, "radii": [1e-7, -1e-7]}, r"radii\[1\] is -1e-07; radii must be finite numbers above 0"),
        ({"n": 64, "copies": "False"}, "copies is 'False'; it must be True or False"),
        ({"n": 64, "radii": [1e-7] * 64, "radius": 1e-7}, "radius and radii are both given"),
        ({"n": 64, "radii": [1e-7] * 64, "copies": True}, "copies and radii are both given"),
        ({"n": 64, "seed": -1}, "seed is -1; it must be a whole number of at least 0"),
    ],
)
def test_bad_input_is_one_sentence(arguments, said):
    with pytest.raises(ratd.InputError, match=said):
        ratd.grow_bcca(**arguments)
