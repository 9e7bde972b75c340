"""The law of DMT for a pair of equal silica spheres: table of collision.md Sect. 1, the speed of sticking."""

import numpy as np
import pytest

from ratd.base.materials import MATERIALS
from ratd.experiments.evolve import evolve
from ratd.laws import dmt
from ratd.laws.derjaguin_muller_toporov import (
    adhesion_force,
    breaking_energy,
    equilibrium_overlap,
    hertz_stiffness,
    vibration_period,
)
from reference.contact import SILICA, Pair
from systems import lattice

MATERIAL = MATERIALS["silica"]
TABLE = {  # radius [um]: delta_eq [nm], E_break [J], period [ns]
    0.05: (0.1215, 5.73e-19, 0.46),
    0.314: (0.2242, 6.64e-18, 3.94),
    0.396: (0.2423, 9.04e-18, 5.16),
    0.453: (0.2534, 1.08e-17, 6.04),
    0.57: (0.2735, 1.47e-17, 7.90),
}


@pytest.mark.parametrize("radius", TABLE)
def test_table(radius):
    r = radius * 0.5e-6
    hertz = hertz_stiffness(r, MATERIAL.reduced_modulus)
    adhesion = adhesion_force(r, MATERIAL.surface_energy)
    overlap = equilibrium_overlap(hertz, adhesion)
    mass = 2 / 3 * np.pi * MATERIAL.density * (radius * 1e-6) ** 3
    found = overlap * 1e9, breaking_energy(adhesion, overlap), vibration_period(mass, hertz, overlap) * 1e9
    assert found == pytest.approx(TABLE[radius], rel=5e-3)
    assert hertz * overlap**1.5 == pytest.approx(adhesion, rel=1e-12)
    # what it holds at rest is what parts it
    assert 0.4 * hertz * overlap**2.5 - adhesion * overlap == pytest.approx(-found[1], rel=1e-12)


def stick(radius, speed, periods=8.0):
    """Whether two spheres that meet head-on at this relative speed [m/s] stay together."""
    pair = Pair(SILICA, radius, radius)
    run = evolve(
        [[0, 0, 0], [2 * radius + 1e-12, 0, 0]], [radius] * 2, [[speed, 0, 0], [0, 0, 0]], material="silica",
        law=dmt(viscous_time=0.5e-9, friction="none"), damping="explicit", timestep=pair.period / 4000, balance=None,
        duration=periods * pair.period, records=1,
    )  # fmt: skip
    return run.n_contacts.values[-1] == 1


@pytest.mark.parametrize(("radius", "wanted"), [(0.314e-6, 1.3274), (0.57e-6, 0.35630)])
def test_speed_of_sticking(radius, wanted):
    """Against an independent integration with A = 0.5 ns."""
    low, high = 0.9 * wanted, 1.1 * wanted
    assert stick(radius, low) and not stick(radius, high)
    for _ in range(8):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if stick(radius, middle) else (low, middle)
    assert low == pytest.approx(wanted, rel=3e-3)


def test_the_smallest_never_part():
    """Overdamped: damping ratio 2.3 at 50 nm."""
    assert stick(0.05e-6, 30.0)


def test_friction_that_follows_the_rate_is_stable_at_the_step_that_is_chosen():
    """A cubic lattice, whose inner spheres have six contacts, with random spins: they only lose."""
    radius = 0.3e-6
    hertz = hertz_stiffness(radius / 2, MATERIAL.reduced_modulus)
    overlap = equilibrium_overlap(hertz, adhesion_force(radius / 2, MATERIAL.surface_energy))
    position = lattice(4, 2 * radius - overlap)
    spin = np.random.default_rng(2).normal(size=position.shape)
    run = evolve(
        position, [radius] * len(position), spin=spin, material="silica", law=dmt(), duration=1e-7, balance=None
    )
    energy = run.kinetic_spin.values + run.kinetic_translation.values
    assert energy[-1] < 0.9 * energy[0] and energy.max() < 1.01 * energy[0]
