"""Aggregates come to rest whole, also those of other programs, whose spheres only touch."""

from types import SimpleNamespace

import numpy as np
import pytest

import ratd
from ratd.aggregates.grain import Grain, gaps, pressed, seated
from ratd.base.errors import InputError
from ratd.engine.layout import CONTACTS, LARGEST_MONOMERS
from ratd.engine.state import positions_as_given
from ratd.experiments import relax as relaxation
from ratd.experiments.relax import relax


def touching(seed, n=60, width=0.0, material="ice"):
    """Spheres at exactly the sum of their radii, each on a random one of those before it."""
    source = np.random.default_rng(seed)
    radius = 1e-7 * np.exp(width * source.normal(size=n))
    position = [np.zeros(3)]
    while len(position) < n:
        k, on = len(position), source.integers(len(position))
        direction = source.normal(size=3)
        place = position[on] + (radius[on] + radius[k]) * direction / np.linalg.norm(direction)
        if all(np.linalg.norm(place - position[m]) >= radius[m] + radius[k] - 1e-16 for m in range(k)):
            position.append(place)
    return Grain(np.array(position), radius, material)


def gaps_of(position, grain):
    return gaps(position, grain.radius, grain.contacts, grain.material.surface_energy, grain.material.reduced_modulus)


@pytest.mark.parametrize(("seed", "width", "material"), [(10, 0.0, "ice"), (12, 0.0, "ice"), (1, 0.4, "q-S")])
@pytest.mark.parametrize("law", [ratd.laws.jkr(), ratd.laws.dmt()])
def test_spheres_that_only_touch_come_to_rest_in_one_piece(seed, width, material, law):
    """Without being pressed together first, the first two come apart under JKR as adhesion pulls all at once."""
    grain = touching(seed, width=width, material=material)
    state = relax(grain, law=law)
    assert state.counter[LARGEST_MONOMERS] == 60 and state.counter[CONTACTS] >= grain.n_contacts == 59


def test_equal_spheres_that_touch_are_pressed_to_their_rest():
    grain = touching(3)
    np.testing.assert_allclose(gaps_of(seated(grain).position, grain), -1.0, atol=1e-6)
    np.testing.assert_allclose(gaps_of(pressed(grain, 0.25).position, grain), -0.25, atol=1e-6)
    unequal = touching(3, width=0.4)
    assert gaps_of(pressed(unequal, 0.25).position, unequal).max() == pytest.approx(-0.25, abs=1e-3)
    assert np.median(gaps_of(seated(unequal).position, unequal)) == pytest.approx(-1.0, abs=1e-3)


@pytest.mark.parametrize("kind", ["BA", "BAM2"])
def test_what_was_grown_is_left_as_it_is(kind):
    grain = ratd.grow(kind, 150e-9, "q-S", 0)
    assert seated(grain) is grain


def test_a_spin_up_and_a_compression_begin_with_all_spheres():
    grain = touching(10)
    run = ratd.spin_up(grain, epsilon=0.9, max_steps=2000)
    assert run.attrs["initial_n_monomers"] == 60 and run.attrs["initial_n_contacts"] == 59
    run = ratd.compress(grain, strain_rate=1e-5, until_phi=0.05)
    assert run["n_contacts"].values[0] == 59


def test_an_aggregate_that_comes_apart_is_refused(monkeypatch):
    wider = SimpleNamespace(**vars(touching(0)))
    wider.position = 1.05 * wider.position
    monkeypatch.setattr(relaxation, "seated", lambda grain: wider)
    monkeypatch.setattr(relaxation, "pressed", lambda grain, by: wider)
    with pytest.raises(InputError, match="the aggregate comes apart: 1 of its 60 spheres are left"):
        relax(touching(0))


def test_spheres_that_come_to_touch_as_others_are_pressed_are_in_contact():
    radius, delta_0 = 20e-9, 2e-11
    apart = 2 * radius + 0.3 * delta_0
    top = np.sqrt((2 * radius) ** 2 - (apart / 2) ** 2)
    three = Grain([[0.0, 0.0, 0.0], [apart, 0.0, 0.0], [apart / 2, top, 0.0]], [radius] * 3, "q-S")
    assert three.n_contacts in (2, 3) and seated(three).n_contacts == relax(three).counter[CONTACTS] == 3


def test_touching_spheres_of_very_unequal_radii_come_to_rest():
    """By one factor a sphere of 1 um would be pressed into one of 20 nm by ten times its rest."""
    grain = Grain([[0, 0, 0], [1.02e-6, 0, 0], [1.06e-6, 0, 0]], [1e-6, 2e-8, 2e-8], "ice")
    assert gaps_of(seated(grain).position, grain) == pytest.approx([-1.0, -1.0])
    assert relax(grain).counter[LARGEST_MONOMERS] == 3
    wide = touching(1, width=1.3)
    assert wide.radius.max() > 30.0 * wide.radius.min()
    # a tree: all of its contacts are at rest, whatever their spheres
    np.testing.assert_allclose(gaps_of(seated(wide).position, wide), -1.0, rtol=1e-6)
    for law in (ratd.laws.jkr(), ratd.laws.dmt()):
        assert relax(wide, law=law).counter[LARGEST_MONOMERS] == 60


def test_a_grain_far_from_the_origin_comes_to_rest_as_one_near_it():
    """A metre away a contact has five digits left, too few to find rest."""
    grain = ratd.grow("BA", a_eff=60e-9, material="q-S", seed=2)
    near, far = relax(grain), relax(grain.replace(position=grain.position + 1.0))
    shift = positions_as_given(far) - positions_as_given(near)
    assert np.abs(shift - shift.mean(axis=0)).max() < 1e-12
