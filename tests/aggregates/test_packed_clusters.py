"""Clusters of given spheres: contacts, overlaps, the sphere that holds them, and what does not fit."""

import numpy as np
import pytest

from ratd.aggregates.mrn import mrn
from ratd.aggregates.packed_clusters import build_cluster, filling_factor, number_of_equal_mass
from ratd.base.errors import InputError
from ratd.base.materials import MATERIALS

SILICA = MATERIALS["silica"]
RADII = np.concatenate([[0.9e-6, 0.5e-6], np.linspace(0.4e-6, 0.05e-6, 80)])


def overlaps(cluster):
    """Overlap of all pairs, (n, n) [m], the naive way."""
    apart = np.linalg.norm(cluster.position[:, None] - cluster.position[None], axis=2)
    return cluster.radius[:, None] + cluster.radius[None] - apart


def resting_overlap(radius):
    """delta_eq of all pairs [m], Eq. 1 written out."""
    r = radius[:, None] * radius[None] / (radius[:, None] + radius[None])
    stiff = SILICA.youngs_modulus / (1 - SILICA.poisson_number**2)
    return (6 * np.pi * SILICA.surface_energy * np.sqrt(r) / stiff) ** (2 / 3)


@pytest.mark.parametrize("second_contact", [0.0, 0.5, 1.0])
def test_every_contact_is_at_rest_and_there_are_as_many_as_asked_for(second_contact):
    cluster = build_cluster(RADII, 2.2e-6, second_contact=second_contact, seed=3)
    n = cluster.n_monomers
    assert n == len(RADII) and (np.diff(cluster.radius) <= 0.0).all()
    upper = np.triu_indices(n, 1)
    overlap, wanted = overlaps(cluster)[upper], resting_overlap(cluster.radius)[upper]
    touching = overlap > 0.0
    np.testing.assert_allclose(overlap[touching], wanted[touching], rtol=2e-5)
    contacts = touching.sum()
    if second_contact == 0.0:
        assert contacts == n - 1
    elif second_contact == 1.0:
        # all but the first two, where a place with two contacts was found
        assert 2 * n - 3 - 4 <= contacts <= 2 * n - 3
    else:
        assert n - 1 + 0.3 * n < contacts < n - 1 + 0.7 * n


def test_all_stay_inside_and_the_centre_of_mass_is_the_origin():
    cluster = build_cluster(RADII, 2.2e-6, seed=5)
    np.testing.assert_allclose(cluster.mass @ cluster.position / cluster.mass.sum(), 0.0, atol=1e-18)
    # the sphere that held them is about another point: no two surfaces are farther apart than it is wide
    apart = np.linalg.norm(cluster.position[:, None] - cluster.position[None], axis=2)
    assert (apart + cluster.radius[:, None] + cluster.radius[None]).max() <= 2 * 2.2e-6 * (1 + 1e-9)


def test_a_large_sphere_that_leaves_no_room_beside_it_is_moved_aside():
    cluster = build_cluster([1.0e-6, 0.8e-6, 0.1e-6], 2.0e-6, seed=1)
    assert cluster.n_monomers == 3


def test_seeds():
    same = [build_cluster(RADII, 2.2e-6, second_contact=0.5, seed=7).position for _ in range(2)]
    assert np.array_equal(*same)
    assert not np.array_equal(same[0], build_cluster(RADII, 2.2e-6, second_contact=0.5, seed=8).position)


def test_the_clusters_of_the_paper():
    """N, phi of collision.md Sect. 4: equal mass in 4 um; contacts 1.5 N with half of the spheres rolled."""
    cube = 0.2965 * 4.0**3
    numbers = [number_of_equal_mass(radius, cube) for radius in (0.298, 0.314, 0.353, 0.396, 0.453, 0.57)]
    assert numbers == [717, 613, 431, 306, 204, 102]
    cluster = build_cluster(np.full(613, 0.314e-6), 4e-6, second_contact=0.5, seed=1)
    assert filling_factor(cluster.radius, 4e-6) == pytest.approx(0.2965, rel=2e-3)
    assert (np.triu(overlaps(cluster), 1) > 0.0).sum() / 613 == pytest.approx(1.5, abs=0.06)
    whole = build_cluster(mrn(5000, 1), 4e-6, second_contact=0.5, seed=1)
    assert whole.n_monomers == 5000


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (
            {"radii": np.full(400, 0.2e-6), "radius": 1.5e-6},
            r"do not fit: they need a filling factor phi of 0.948",
        ),
        ({"radii": [1e-6, 1e-6], "radius": 1.9e-6}, "the two largest spheres.* it must be at least 2e-06 m"),
        ({"radii": [1e-6, -1e-6]}, r"radii\[1\] is -1e-06; .* above 0"),
        ({"radii": [1e-6]}, r"at least two finite numbers above 0, in m; they are of the shape \(1,\)"),
        ({"radii": "many"}, "radii is not an array of numbers"),
        ({"radii": [True, True]}, "radii is not an array of numbers"),
        ({"radii": ["1e-6", "1e-6"]}, "radii is not an array of numbers"),
        ({"radius": np.nan}, "radius is nan"),
        ({"second_contact": 1.5}, "second_contact is 1.5; it must be a number from 0 to 1"),
        ({"seed": -1}, "seed is -1"),
        ({"material": "cheese"}, "The material is 'cheese'"),
    ],
)
def test_bad_input_is_refused_in_one_sentence(arguments, words):
    with pytest.raises(InputError, match=words) as caught:
        build_cluster(**{"radii": RADII, "radius": 2.2e-6} | arguments)
    assert "\n" not in str(caught.value)
