"""The normal force of DMT in the law with springs: its formulae, a pair that vibrates, contacts that begin and end."""

import math

import numpy as np
import pytest

from ratd.base.errors import InputError
from ratd.base.materials import MATERIALS
from ratd.engine.contacts import contact_start
from ratd.engine.layout import CONTACTS
from ratd.experiments.evolve import evolve
from ratd.geometry.box import open_space
from ratd.laws import derjaguin_muller_toporov as dmt
from ratd.laws import jkr
from ratd.laws.contact_constants import (
    equilibrium_compression,
    equilibrium_contact_radius,
    pull_off_force,
    reduced_radius,
)
from ratd.laws.contact_fields import NORMAL
from systems import field, forces, pair_state, unit

MATERIAL = MATERIALS["q-S"]
RADII = [(30e-9, 30e-9), (10e-9, 100e-9)]
DMT = jkr(normal_force="DMT")


def constants(a_i, a_j):
    """R, r0, delta_0, F_C of JKR; K, adhesion of DMT."""
    r = reduced_radius(a_i, a_j)
    gamma, e_star = MATERIAL.surface_energy, MATERIAL.reduced_modulus
    return (
        r,
        equilibrium_contact_radius(r, gamma, e_star),
        equilibrium_compression(r, gamma, e_star),
        pull_off_force(r, gamma),
        dmt.hertz_stiffness(r, e_star),
        dmt.adhesion_force(r, gamma),
    )


@pytest.mark.parametrize("radii", RADII)
@pytest.mark.parametrize("x", [0.0, 0.3, 3 ** (-1 / 3), 1.0, 1.7])
def test_formulae_are_those_of_dmt_in_other_units(radii, x):
    r, r0, delta_0, f_c, hertz, adhesion = constants(*radii)
    delta = (r0 * x) ** 2 / r
    s = dmt.dmt_state(delta / delta_0)
    assert s == pytest.approx(math.sqrt(x), rel=1e-12)
    assert dmt.dmt_force(s, f_c) == pytest.approx(hertz * delta**1.5 - adhesion, rel=1e-12, abs=1e-12 * f_c)
    held = 0.4 * hertz * delta**2.5 - adhesion * delta
    assert dmt.dmt_potential(s, f_c, delta_0) == pytest.approx(held, rel=1e-12)


@pytest.mark.parametrize("radii", RADII)
def test_equilibrium_pull_off_and_stiffness(radii):
    _, _, delta_0, f_c, hertz, adhesion = constants(*radii)
    overlap = dmt.equilibrium_overlap(hertz, adhesion)
    s = dmt.dmt_state(overlap / delta_0)
    assert s**2 == pytest.approx(3 ** (-1 / 3), rel=1e-12)
    assert dmt.dmt_force(s, f_c) == pytest.approx(0.0, abs=1e-12 * f_c)
    assert -dmt.dmt_potential(s, f_c, delta_0) == pytest.approx(dmt.breaking_energy(adhesion, overlap), rel=1e-12)
    assert -dmt.dmt_force(0.0, f_c) == pytest.approx(4 / 3 * f_c, rel=1e-12) == pytest.approx(adhesion, rel=1e-12)


@pytest.mark.parametrize("compression", [0.05, 0.5, 1.4, 3.0, 6.0])
def test_stiffness_of_the_matrix_is_not_below_that_of_the_force(compression):
    """It is 2 x F_C/delta_0."""
    a = 30e-9
    _, _, delta_0, f_c, hertz, _ = constants(a, a)
    state = pair_state(DMT, open_space(), (a, a), MATERIAL, 2 * a - compression * delta_0, unit(-1.0, -0.4, -0.3))
    forces(state, DMT, open_space())
    own = 1.5 * hertz * math.sqrt(compression * delta_0)
    assert own == pytest.approx(2.0 * math.sqrt(compression / 3.0) * f_c / delta_0, rel=1e-12)
    assert DMT.stiffness(state.contact, contact_start(DMT, 0))[0] >= own * (1 - 1e-9)


@pytest.mark.parametrize("radii", RADII)
def test_a_free_pair_vibrates_with_its_period_and_keeps_its_energy(radii):
    _, _, delta_0, f_c, hertz, adhesion = constants(*radii)
    m_i, m_j = (4 / 3 * math.pi * MATERIAL.density * a**3 for a in radii)
    m_red = m_i * m_j / (m_i + m_j)
    overlap = dmt.equilibrium_overlap(hertz, adhesion)
    period = dmt.vibration_period(m_red, hertz, overlap)
    # a speed at which the pair neither parts nor stays in the range of small vibrations
    energy = 0.3 * dmt.breaking_energy(adhesion, overlap)
    speed = math.sqrt(2 * energy / m_red)
    position = [[0.0, 0.0, 0.0], [sum(radii) - overlap, 0.0, 0.0]]
    run = evolve(
        position, radii, [[speed * m_j / (m_i + m_j), 0, 0], [-speed * m_i / (m_i + m_j), 0, 0]], material="q-S",
        law=jkr(normal_force="DMT", damping="none"), duration=10 * period, timestep=period / 400, balance=None,
        records=400,
    )  # fmt: skip
    kinetic = run.kinetic_translation.values
    assert kinetic.max() > 0.99 * energy and kinetic.min() < 0.01 * energy
    assert np.abs(run.residual.values).max() < 1e-3 * energy
    assert float(run.n_contacts.min()) == 1 and (run.dissipated[-1] == 0.0).all()
    slow = evolve(
        position, radii, [[1e-3 * speed, 0, 0], [0, 0, 0]], material="q-S",
        law=jkr(normal_force="DMT", damping="none"), duration=period, timestep=period / 400, balance=None, records=1,
    )  # fmt: skip
    # after one period the first sphere is as fast as at the start
    assert float(slow.velocity[0, 0]) == pytest.approx(1e-3 * speed, rel=5e-3)


def test_nothing_is_radiated_and_a_contact_ends_where_the_surfaces_part():
    """Two spheres meet, and part again without damping: with JKR they would lose 0.77 F_C delta_0."""
    a, speed = 30e-9, 2.0
    run = evolve(
        [[0, 0, 0], [2 * a + 1e-12, 0, 0]], [a, a], [[speed, 0, 0], [0, 0, 0]], material="q-S",
        law=jkr(normal_force="DMT", damping="none"), duration=1e-9, timestep=2e-14, balance=None, records=200,
    )  # fmt: skip
    assert run.n_contacts.values.max() == 1 and run.n_contacts.values[-1] == 0
    _, _, delta_0, f_c, _, _ = constants(a, a)
    assert float(np.abs(run.dissipated[-1]).sum()) < 1e-2 * f_c * delta_0
    assert float(run.velocity[1, 0]) == pytest.approx(speed, rel=1e-3)


def test_the_pull_is_greatest_at_first_touch():
    a = 30e-9
    _, _, _, f_c, _, _ = constants(a, a)
    state = pair_state(DMT, open_space(), (a, a), MATERIAL, 2 * a * (1 - 1e-12), unit(-1.0, -0.4, -0.3))
    assert state.counter[CONTACTS] == 1
    assert field(state, NORMAL)[0] == pytest.approx(-4 / 3 * f_c, rel=1e-6)


def test_another_normal_force_gets_a_sentence():
    with pytest.raises(InputError, match="normal_force is 'Hertz'; allowed are JKR, DMT"):
        jkr(normal_force="Hertz")
