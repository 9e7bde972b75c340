"""The step that `ratd.evolve` takes where none is chosen: spheres rebound as fast as with far shorter ones."""

import math

import numpy as np
import pytest

import ratd
from ratd.base.materials import MATERIALS
from ratd.experiments.leapfrog_for import HOW, STEPS_OF_IMPACT, leapfrog_for
from ratd.laws.derjaguin_muller_toporov import impact_duration
from ratd.laws.dmt_with_friction import dmt
from ratd.laws.jkr_with_springs import jkr

QUARTZ = MATERIALS["q-S"]


def rebound(law, material, radius, speed, **how):
    """Speed at which two equal spheres part, over that at which they met head-on; 0 where they stick."""
    position = [[0.0, 0.0, 0.0], [2.0 * radius + 1e-12, 0.0, 0.0]]
    velocity = [[speed, 0.0, 0.0], [0.0, 0.0, 0.0]]
    duration = min(max(20.0 * radius / speed, 0.03 * radius), 0.2 * radius)
    about = {"material": material, "law": law, "duration": duration, "records": 1}
    run = ratd.evolve(position, [radius] * 2, velocity, **about, **how)
    if run.n_contacts.values[-1]:
        return 0.0
    return float(run.velocity[1, 0] - run.velocity[0, 0]) / speed


@pytest.mark.parametrize("speed", [5.0, 50.0, 200.0])
@pytest.mark.parametrize("radius", [1e-7, 1e-6])
@pytest.mark.parametrize(
    ("law", "material"),
    [(jkr(), "q-S"), (jkr(), "a-C"), (jkr(damping="constant"), "ice"), (dmt(), "silica")],
    ids=["quartz", "carbon", "ice", "silica"],
)
def test_spheres_rebound_as_with_short_steps(law, material, radius, speed):
    found = rebound(law, material, radius, speed)
    short = rebound(law, material, radius, speed, damping="explicit", timestep_factor=0.002)
    assert found == pytest.approx(short, rel=0.05, abs=1e-12)


def test_the_long_steps_of_before_part_spheres_that_stick():
    """Why impacts count: at 1/8 of the time of a contact two spheres of carbon lose their energy too late."""
    assert rebound(jkr(), "a-C", 1e-7, 50.0) == 0.0
    assert rebound(jkr(), "a-C", 1e-7, 50.0, timestep_factor=HOW["timestep_factor"], balance=None) > 0.1


def test_it_is_the_speed_against_each_other_that_counts():
    radius = np.full(3, 1e-7)
    velocity = np.array([[30.0, 0.0, 0.0], [-10.0, 30.0, 0.0], [0.0, 0.0, 0.0]])
    own = [leapfrog_for(jkr(), radius, [QUARTZ], v) for v in (velocity, velocity + 500.0, 32.0 * velocity)]
    assert own[0].timestep_factor == pytest.approx(own[1].timestep_factor, rel=1e-9)
    # the time of an impact goes with the speed to the power of -1/5
    assert own[2].timestep_factor == pytest.approx(own[0].timestep_factor / 2.0, rel=1e-9)
    still = [leapfrog_for(jkr(), radius, [QUARTZ], v) for v in (None, np.zeros((3, 3)), np.full((3, 3), 500.0))]
    assert {one.timestep_factor for one in still} == {0.125}


def test_a_step_is_a_part_of_the_impact():
    radius, velocity = np.array([1e-7, 1e-7]), np.array([[40.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    position = np.array([[0.0, 0.0, 0.0], [1.9995e-7, 0.0, 0.0]])
    run = ratd.evolve(position, radius, velocity, material="q-S", duration=1e-14, records=1)
    mass = 0.5 * QUARTZ.density * 4.0 / 3.0 * math.pi * 1e-21
    duration = impact_duration(mass, 5e-8, QUARTZ.reduced_modulus, 40.0)
    assert run.attrs["timestep"] == pytest.approx(duration / STEPS_OF_IMPACT, rel=1e-9)


def test_of_several_sizes_and_materials_the_least_part_holds():
    velocity = np.array([[100.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    materials = [QUARTZ, MATERIALS["a-C"]]
    alone = [
        leapfrog_for(jkr(), np.full(2, radius), [material], velocity).timestep_factor
        for radius in (1e-7, 1e-6)
        for material in materials
    ]
    together = leapfrog_for(jkr(), np.array([1e-7, 1e-6]), materials, velocity).timestep_factor
    assert together == min(alone) and len(set(alone)) == 4


def test_what_is_given_holds():
    radius, velocity = np.full(2, 1e-7), np.array([[100.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    given = leapfrog_for(dmt(), radius, [QUARTZ], velocity, timestep_factor=0.2, damping="implicit")
    assert given.timestep_factor == 0.2 and given.implicit_damping
    fixed = leapfrog_for(jkr(), radius, [QUARTZ], velocity, timestep=1e-12)
    assert fixed.timestep == 1e-12 and fixed.timestep_factor == 0.125
    assert not leapfrog_for(dmt(), radius, [QUARTZ], None).implicit_damping
    assert leapfrog_for(jkr(), radius, [QUARTZ], None).implicit_damping
