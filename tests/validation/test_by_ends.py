"""Pulling by the ends: chains, whose strength is known, and a grain by two integrators."""

import numpy as np
import pytest

import ratd
from ratd.engine.layout import MASS, X
from ratd.engine.leapfrog import leapfrog
from ratd.engine.state import monomer_rows
from ratd.experiments.relax import relax
from ratd.laws.contact_constants import equilibrium_compression, pull_off_force, reduced_radius
from ratd.validation.by_ends import lever, pull_by_ends

RADIUS = 40e-9


def chain(*radii):
    """A straight chain along x in equilibrium."""
    material = ratd.MATERIALS["q-S"]
    x = [0.0]
    for one, other in zip(radii, radii[1:], strict=False):
        r = reduced_radius(one, other)
        x.append(x[-1] + one + other - equilibrium_compression(r, material.surface_energy, material.reduced_modulus))
    return ratd.Grain(np.column_stack([x, np.zeros(len(x)), np.zeros(len(x))]), radii, material)


def along(state):
    """The coordinate along which a relaxed chain lies."""
    return int(np.argmax(np.ptp(monomer_rows(state)[:, X : X + 3], axis=0)))


@pytest.mark.parametrize("radii", [(RADIUS,) * 4, (RADIUS, RADIUS, 0.5 * RADIUS, RADIUS)])
def test_a_chain_holds_the_pull_off_force_of_its_weakest_contact(radii):
    grain = chain(*radii)
    state = relax(grain)
    pull = pull_by_ends(state, along(state), 2e3)
    weakest = min(
        pull_off_force(reduced_radius(*grain.radius[list(pair)]), grain.material.surface_energy)
        for pair in grain.contacts
    )
    assert pull.force == pytest.approx(weakest, rel=0.02)
    assert pull.unequal < 0.01


def test_the_state_that_is_given_stays():
    state = relax(chain(RADIUS, RADIUS, RADIUS))
    before = state.monomer.copy()
    pull_by_ends(state, along(state), 1e4)
    np.testing.assert_array_equal(state.monomer, before)


def test_lever_of_a_pair():
    grain = chain(RADIUS, RADIUS)
    state = relax(grain)
    mass = monomer_rows(state)[0, MASS]
    distance = np.ptp(monomer_rows(state)[:, X + along(state)])
    assert lever(state, along(state)) == pytest.approx(mass * distance / 2)


def test_ends_with_a_monomer_in_common_are_refused():
    state = relax(chain(RADIUS, RADIUS, RADIUS))
    with pytest.raises(ratd.InputError, match="the two ends of this grain would have monomers in common"):
        pull_by_ends(state, along(state), 1e4, held=0.6)


@pytest.mark.parametrize("kind", ["BA", "BAM2"])
def test_a_grain_holds_as_much_by_the_explicit_step(kind):
    state = relax(ratd.grow(kind, 150e-9, "q-S", 3))
    fast, slow = (pull_by_ends(state, 1, rate).force for rate in (6e3, 2e3))
    explicit = pull_by_ends(state, 1, 6e3, integrator=leapfrog(timestep_factor=0.125)).force
    assert slow == pytest.approx(fast, rel=0.06) and explicit == pytest.approx(fast, rel=0.06)
