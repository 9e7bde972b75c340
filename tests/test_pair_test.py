"""The paper's test with pairs, under the printed equations: the engine against the solid pair."""

import numpy as np
import pandas as pd
import pytest

import ratd
from ratd import spin_up
from ratd.calibration import PRINTED_STEP
from ratd.materials import MATERIALS, equilibrium_compression, reduced_radius
from ratd.pair import force_controlled_omega
from ratd.reproduction.pair_test import (
    RATES,
    explicit_over,
    smallest_and_largest,
    suiting_both,
    with_share_and_step,
)


def pairs_of(*radii, material="q-S"):
    thresholds = [force_controlled_omega(a, a, MATERIALS[material]) for a in radii]
    pairs = pd.DataFrame({"material": material, "monomer_radius": radii, "parting_omega": thresholds})
    return with_share_and_step(pairs, MATERIALS)


@pytest.mark.parametrize(("radius", "rate"), [(20e-9, 1e15), (60e-9, 1e14)])
def test_a_pair_of_the_engine_parts_where_the_solid_one_does(radius, rate):
    material = MATERIALS["q-S"]
    constants = reduced_radius(radius, radius), material.surface_energy, material.reduced_modulus
    distance = 2 * radius - equilibrium_compression(*constants)
    grain = ratd.Grain(np.array([[0.0, 0, 0], [distance, 0, 0]]), np.full(2, radius), material)
    law = dict(angular_acceleration=rate, timestep_factor=PRINTED_STEP)
    run = spin_up(grain, drive="literal", coriolis="explicit", **law)
    pair = pairs_of(radius)
    assert run.attrs["timestep"] == pytest.approx(pair["timestep"][0], rel=1e-12)
    assert float(run["omega"][-1]) / pair["parting_omega"][0] == pytest.approx(explicit_over(pair, rate)[0], rel=0.02)


def test_share_of_the_spins_of_two_spheres_that_touch():
    """0.4 m a^2 each, beside m a^2 each; the overlap brings the centres nearer by less than a hundredth."""
    share = with_share_and_step(pairs_of(10e-9, 100e-9), MATERIALS)["share"]
    assert (share > 0.8 / 2.8).all() and (share < 0.8 / 2.8 * 1.01).all() and share[0] > share[1]


def test_one_pair_has_a_rate_that_suits_it_and_two_unlike_ones_have_not():
    rate, over = suiting_both(pairs_of(30e-9))
    assert RATES[0] < rate < RATES[-1] and abs(np.log(over[0])) < np.log(10**0.25)
    small, large = (suiting_both(pairs_of(radius))[0] for radius in (10e-9, 100e-9))
    assert small > 100 * large
    _, over = suiting_both(pairs_of(10e-9, 100e-9))
    assert np.abs(np.log(over)).max() > np.log(2)


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
