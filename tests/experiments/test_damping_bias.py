"""The implicit damping is too weak in collisions of unequal spheres, the less the shorter the step.

`python -m pytest -s tests/experiments/test_damping_bias.py` prints the numbers of docs/model/engine.md.
"""

import numpy as np

import ratd
from ratd.experiments.collision.approach import approach
from ratd.experiments.collision.laws import contacts_of
from ratd.experiments.collision.run import at_rest
from ratd.experiments.evolve import evolve

LAW = ratd.laws.dmt(viscous_time=1e-9)
VELOCITY, NUMBER, PAIRS = 30.0, 250, 8
RADIUS = 4e-6 * (NUMBER / 5000) ** (1 / 3)


def start(seed):
    """An MRN cluster that meets itself: radii, positions, velocities, contacts."""
    radii = ratd.mrn(NUMBER, seed, mass_within=None, length_within=None, largest=RADIUS / 4)
    cluster = at_rest(ratd.build_cluster(radii, RADIUS, second_contact=0.5, seed=seed), LAW)
    position, velocity, _ = approach(cluster, cluster, VELOCITY, 0.0, 20e-9, seed)
    pairs = contacts_of(cluster, LAW)
    return np.tile(cluster.radius, 2), position, velocity, np.concatenate([pairs, pairs + NUMBER])


def energy_left(case, damping, timestep):
    """Kinetic energy after 60 ns over that of the impact."""
    radius, position, velocity, contacts = case
    run = evolve(
        position, radius, velocity, material="silica", law=LAW, duration=6e-8, timestep=timestep, damping=damping,
        contacts=contacts, records=2, snapshot_every=0,
    )  # fmt: skip
    moving = run.kinetic_translation + run.kinetic_spin
    return float(moving[-1] / moving[0])


def test_bias_of_the_implicit_damping():
    cases = [start(seed) for seed in range(PAIRS)]
    explicit = np.array([energy_left(case, "explicit", 1e-12) for case in cases])
    mean, error = {}, {}
    for timestep in (1e-12, 2e-12, 4e-12):
        ratio = np.array([energy_left(case, "implicit", timestep) for case in cases]) / explicit
        mean[timestep], error[timestep] = ratio.mean(), ratio.std(ddof=1) / np.sqrt(PAIRS)
        print(f"implicit, {timestep:g} s: {mean[timestep]:.3f} +- {error[timestep]:.3f} of the explicit energy left")
    assert mean[4e-12] > 1.0 + 2.0 * error[4e-12]
    assert mean[1e-12] < mean[2e-12] < mean[4e-12] < 1.2
