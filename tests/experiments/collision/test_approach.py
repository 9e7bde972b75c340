"""How two clusters are turned, placed and set in motion."""

import numpy as np
import pytest
from scipy.stats import kstest

from ratd.aggregates.packed_clusters import build_cluster
from ratd.experiments.collision.approach import approach, first_touch, random_turn
from ratd.experiments.collision.fragmentation import fragmentation
from ratd.experiments.collision.run import collide

A = build_cluster(np.linspace(0.4e-6, 0.1e-6, 12), 1.5e-6, seed=1)
B = build_cluster(np.full(8, 0.3e-6), 1.5e-6, seed=2)


def gaps(position, radius, n):
    """Gaps between the first n spheres and the others, (n, m)."""
    apart = np.linalg.norm(position[:n, None] - position[None, n:], axis=2)
    return apart - radius[:n, None] - radius[None, n:]


def test_turns_are_rotations_in_all_directions():
    rng = np.random.default_rng(0)
    turns = np.array([random_turn(rng) for _ in range(2000)])
    np.testing.assert_allclose(turns @ turns.transpose(0, 2, 1), np.broadcast_to(np.eye(3), turns.shape), atol=1e-12)
    np.testing.assert_allclose(np.linalg.det(turns), 1.0)
    # each coordinate of a turned vector is uniform between -1 and 1
    for row in range(3):
        for column in range(3):
            assert kstest(turns[:, row, column], "uniform", args=(-1, 2)).pvalue > 1e-3


@pytest.mark.parametrize("impact", [0.0, 0.3, 0.6])
def test_the_first_surfaces_are_a_gap_apart(impact):
    position, velocity, meet = approach(A, B, 3.0, impact, 20e-9, 5)
    radius, mass = np.concatenate([A.radius, B.radius]), np.concatenate([A.mass, B.mass])
    n = A.n_monomers
    assert gaps(position, radius, n).min() == pytest.approx(20e-9, rel=1e-6)
    # a hair nearer they would be closer than the gap, a hair farther not
    shifted = position + np.array([1e-12, 0, 0]) * (np.arange(len(position)) >= n)[:, None]
    assert gaps(shifted, radius, n).min() > 20e-9
    assert velocity[0, 0] - velocity[-1, 0] == pytest.approx(3.0) and (velocity[:, 1:] == 0.0).all()
    np.testing.assert_allclose(mass @ velocity, 0.0, atol=1e-12 * mass.sum())
    np.testing.assert_allclose(mass @ position, 0.0, atol=1e-15 * mass.sum())
    centres = [own @ place / own.sum() for own, place in ((A.mass, position[:n]), (B.mass, position[n:]))]
    reach = sum(
        np.max(np.linalg.norm(place - centre, axis=1) + cluster.radius)
        for cluster, place, centre in ((A, position[:n], centres[0]), (B, position[n:], centres[1]))
    )
    assert centres[1][1] - centres[0][1] == pytest.approx(impact * reach, abs=1e-12)
    assert centres[1][0] > centres[0][0] and meet


def test_seeds_turn_both():
    first, again, other = (approach(A, A, 1.0, 0.0, 1e-9, seed)[0] for seed in (1, 1, 2))
    assert np.array_equal(first, again) and not np.allclose(first, other, rtol=0, atol=1e-8)
    # each on its own
    n = A.n_monomers
    shapes = [np.linalg.norm(np.ptp(part, axis=0)) for part in (first[:n], first[n:])]
    assert abs(shapes[0] - shapes[1]) > 1e-9


def test_clusters_that_pass_each_other():
    small = build_cluster([0.1e-6, 0.1e-6], 0.3e-6, seed=1)
    assert first_touch(np.zeros((1, 3)), np.ones(1), np.array([[0.0, 3.0, 0.0]]), np.ones(1), 0.5) == -np.inf
    n = small.n_monomers
    results = [approach(small, small, 1.0, 0.999, 1e-10, seed) for seed in range(20)]
    passing = [position for position, _, meet in results if not meet]
    assert passing
    for position in passing:
        ahead = position[n:, 0] - small.radius
        assert ahead.min() - (position[:n, 0] + small.radius).max() == pytest.approx(1e-10, rel=1e-3)
        # along their way they never touch
        beside = np.linalg.norm(position[:n, None, 1:] - position[None, n:, 1:], axis=2)
        assert (beside > small.radius[:, None] + small.radius[None, :]).all()


def test_a_collision_without_contact_is_a_result():
    small = build_cluster([0.1e-6, 0.1e-6], 0.3e-6, seed=1)
    seed = next(seed for seed in range(20) if not approach(small, small, 1.0, 0.999, 1e-10, seed)[2])
    with pytest.warns(UserWarning, match="impact_parameter is 0.999: .* the two pass each other"):
        run = collide(small, small, 20.0, 0.999, seed, gap=1e-10, duration=5e-8, records=4)
    whole = fragmentation(run)
    assert run["n_pieces"].values.tolist() == [2] * 5 and float(whole["N_s"]) == pytest.approx(0.0, abs=1e-12)
    assert float(whole["X"]) == pytest.approx(0.0, abs=1e-12)
