"""A collision of two small clusters without friction beside LAMMPS' `granular dmt`: energy, fragments, places."""

from functools import partial

import numpy as np
import pytest

import ratd
from peer import need_lammps
from ratd.base.materials import MATERIALS
from ratd.experiments.collision.approach import approach
from ratd.experiments.collision.run import collide
from ratd.geometry.neighbours import close_pairs, connected_components
from ratd.validation.peer_lammps import Spheres, dmt_coefficients

SILICA = MATERIALS["silica"]
TIME, STEP = 1.5e-7, 2e-12


@pytest.fixture(scope="module")
def cluster():
    need_lammps()
    radii = np.concatenate([[0.5e-6], np.linspace(0.35e-6, 0.2e-6, 15)])
    return ratd.build_cluster(radii, 1.4e-6, second_contact=0.5, seed=4)


@pytest.mark.parametrize("speed", [3.0, 12.0])
def test_two_clusters_without_friction(cluster, speed):
    law = ratd.laws.dmt(viscous_time=0.5e-9, friction="none")
    run = collide(
        cluster, cluster, speed, 0.2, seed=5, law=law, duration=TIME, timestep=STEP, records=1, relaxed=True,
        snapshot_every=0,
    )  # fmt: skip
    position, velocity, _ = approach(cluster, cluster, speed, 0.2, 20e-9, 5)
    radius, mass = np.tile(cluster.radius, 2), np.tile(cluster.mass, 2)
    pair = partial(dmt_coefficients, damping_time=0.5e-9)
    with Spheres(position, radius, SILICA, STEP, pair) as spheres:
        spheres.push(velocity)
        spheres.advance(run.attrs["steps"])
        place, moving = spheres.position(), spheres.velocity()
    energy = 0.5 * float(mass @ (moving**2).sum(axis=1))
    left = float(run.kinetic_translation[-1])
    # enough has happened to tell two codes apart
    assert left < 0.9 * run.attrs["impact_energy"]

    assert energy == pytest.approx(left, rel=1e-5)
    np.testing.assert_allclose(place, run.position, rtol=0, atol=2e-3 * radius.min())
    pieces = connected_components(len(radius), close_pairs(place, radius, 0.0))
    # the same spheres hang together
    together = [labels[:, None] == labels[None] for labels in (pieces, run.piece.values)]
    assert np.array_equal(*together)
