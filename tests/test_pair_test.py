"""The paper's test with pairs, under the printed equations: the engine against the solid pair."""

import numpy as np
import pandas as pd
import pytest
from ratd.reproduction.pair_test import (
    RATES,
    explicit_over,
    least_factor,
    smallest_and_largest,
    with_share_and_step,
)

import ratd
from ratd import spin_up
from ratd.base.materials import MATERIALS
from ratd.experiments.spin_up.calibration import PRINTED_STEP
from ratd.experiments.spin_up.pairs import eq35_omega, force_controlled_omega
from ratd.laws.contact_constants import equilibrium_compression, reduced_radius


def pairs_of(*radii, material="q-S"):
    thresholds = [force_controlled_omega(a, a, MATERIALS[material]) for a in radii]
    pairs = pd.DataFrame({"material": material, "monomer_radius": radii, "parting_omega": thresholds})
    pairs["eq35_omega"] = [eq35_omega(a, a, MATERIALS[material]) for a in radii]
    return with_share_and_step(pairs, MATERIALS)


@pytest.mark.parametrize(("radius", "rate"), [(20e-9, 1e15), (60e-9, 1e14), (100e-9, 1e15)])
def test_a_pair_of_the_engine_parts_where_the_solid_one_does(radius, rate):
    material = MATERIALS["q-S"]
    constants = reduced_radius(radius, radius), material.surface_energy, material.reduced_modulus
    distance = 2 * radius - equilibrium_compression(*constants)
    grain = ratd.Grain(np.array([[0.0, 0, 0], [distance, 0, 0]]), np.full(2, radius), material)
    law = dict(angular_acceleration=rate, timestep_factor=PRINTED_STEP)
    run = spin_up(grain, drive="literal", coriolis="explicit", **law)
    pair = pairs_of(radius)
    assert run.attrs["timestep"] == pytest.approx(pair["timestep"][0], rel=1e-12)
    assert float(run["omega"][-1]) / pair["eq35_omega"][0] == pytest.approx(explicit_over(pair, rate)[0], rel=0.02)


def test_share_of_the_spins_of_two_spheres_that_touch():
    """0.4 m a^2 each, beside m a^2 each; the overlap brings the centres nearer by less than a hundredth."""
    share = with_share_and_step(pairs_of(10e-9, 100e-9), MATERIALS)["share"]
    assert (share > 0.8 / 2.8).all() and (share < 0.8 / 2.8 * 1.01).all() and share[0] > share[1]


def test_large_pairs_part_later_than_small_ones_at_every_rate():
    """Far above q omega is q times a number: omega/threshold ~ a^3/2 dt^-1/3, with dt ~ a^7/6, is a^10/9."""
    factor = least_factor(pairs_of(10e-9, 100e-9))
    slow = explicit_over(pairs_of(10e-9, 100e-9), RATES[0])
    assert slow[1] / slow[0] == pytest.approx(10 ** (10 / 9), rel=0.02)
    assert 4 < factor <= slow[1] / slow[0] * (1 + 1e-9)
    assert least_factor(pairs_of(30e-9, 31e-9)) < 1.1


def test_ends_are_those_of_each_material_among_the_pairs_that_start_at_rest():
    pairs = pd.DataFrame(
        {
            "material": ["q-S", "q-S", "q-S", "a-C", "a-C", "q-S"],
            "start": ["damped"] * 5 + ["undamped"],
            "monomer_radius": [2e-8, 1e-8, 9e-8, 3e-8, 4e-8, 1e-9],
            "parting_omega": [1e8, 1e9, np.nan, 1e8, 1e8, 1e10],
        }
    )
    found = smallest_and_largest(pairs)
    assert sorted(zip(found["material"], found["monomer_radius"], strict=True)) == [
        ("a-C", 3e-8), ("a-C", 4e-8), ("q-S", 1e-8), ("q-S", 2e-8)
    ]  # fmt: skip
    assert smallest_and_largest(None) is None and smallest_and_largest(pairs[-1:]) is None
