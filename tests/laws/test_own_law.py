"""A law of one's own, in one file: a linear spring without adhesion, with which two spheres bounce."""

import math
from typing import NamedTuple

import numpy as np
import pytest
from numba.core.errors import TypingError

from ratd.base.jit import jit
from ratd.base.materials import MATERIALS
from ratd.base.parts import part
from ratd.engine.leapfrog import leapfrog
from ratd.engine.state import new_state
from ratd.experiments.evolve import evolve
from ratd.geometry.box import open_space, periodic
from ratd.laws import jkr
from ratd.laws.contact_fields import (
    A_I,
    A_J,
    COMMON,
    DX,
    DY,
    DZ,
    FX,
    FY,
    FZ,
    NCX,
    NCY,
    NCZ,
    NORMAL,
    STEP,
    TIX,
    TIY,
    TIZ,
    TJX,
    TJY,
    TJZ,
    law_fields,
)  # fmt: skip
from ratd.observables.stress import total_stress

OVERLAP, STIFFNESS = law_fields(2)


@part
class Spring(NamedTuple):
    """Spheres repel with k delta while they overlap."""

    k: float

    def n_fields(self):
        return COMMON + 2

    def vectors(self):
        return ()

    def idle(self, contact, at):
        # `forces` computes idle contacts with the others: this one must not end, and must not push
        contact[at + OVERLAP] = 1.0
        contact[at + STIFFNESS] = 0.0

    def begin(self, contact, at, pair, mass_i, mass_j, normal, distance, spin_i, spin_j, back, at_rest):
        contact[at + OVERLAP] = contact[at + A_I] + contact[at + A_J] - distance
        contact[at + STIFFNESS] = self.k
        contact[at + STEP] = math.sqrt(mass_i * mass_j / (mass_i + mass_j) / self.k)
        return 0.0

    def forces(self, contact, scratch, start, count, dt_drift, dt):
        ended = 0
        for lane in range(count):
            q = np.uint64(lane)
            at = start + q
            d = math.sqrt(scratch[DX + q] ** 2 + scratch[DY + q] ** 2 + scratch[DZ + q] ** 2)
            contact[at + NCX] = scratch[DX + q] / d
            contact[at + NCY] = scratch[DY + q] / d
            contact[at + NCZ] = scratch[DZ + q] / d
            delta = contact[at + A_I] + contact[at + A_J] - d
            contact[at + OVERLAP] = delta
            contact[at + NORMAL] = contact[at + STIFFNESS] * max(delta, 0.0)
            scratch[FX + q] = contact[at + NORMAL] * contact[at + NCX]
            scratch[FY + q] = contact[at + NORMAL] * contact[at + NCY]
            scratch[FZ + q] = contact[at + NORMAL] * contact[at + NCZ]
            scratch[TIX + q] = scratch[TIY + q] = scratch[TIZ + q] = 0.0
            scratch[TJX + q] = scratch[TJY + q] = scratch[TJZ + q] = 0.0
            ended += delta < 0.0
        return ended

    def ended(self, contact, at):
        return contact[at + OVERLAP] < 0.0

    def energies(self, contact, at):
        return 0.5 * contact[at + STIFFNESS] * max(contact[at + OVERLAP], 0.0) ** 2, 0.0, 0.0, 0.0

    def damping_coefficient(self, contact, at):
        return 0.0


def test_two_spheres_bounce():
    radius, k, speed = np.array([1e-7, 0.7e-7]), 2.0, 0.3
    mass = 4 / 3 * math.pi * 1000.0 * radius**3
    reduced = mass.prod() / mass.sum()
    wanted = math.pi * math.sqrt(reduced / k)
    run = evolve(
        [[0, 0, 0], [radius.sum() * (1 + 1e-5), 0, 0]], radius, [[speed, 0, 0], [0, 0, 0]], material="ice",
        law=Spring(k), duration=3 * wanted, timestep_factor=0.01, records=3000, balance=1e-3,
    )  # fmt: skip
    touching = run.n_contacts.values == 1
    assert not touching[0] and not touching[-1]
    assert touching.sum() * 3 * wanted / 3000 == pytest.approx(wanted, rel=0.01)
    v = run.velocity.values[:, 0]
    assert v[1] - v[0] == pytest.approx(speed, rel=1e-3)
    assert mass @ v == pytest.approx(mass[0] * speed, rel=1e-12)
    # at the turning point all of the energy of the approach is in the spring
    assert run.stored.values[:, 0].max() == pytest.approx(0.5 * reduced * speed**2, rel=1e-3)


def test_the_pressure_in_a_box_is_that_of_the_one_spring():
    """Contacts that pad a block to eight do nothing."""
    k, edge, overlap = 2.0, 1e-6, 1e-9
    run = evolve(
        [[0, 0, 0], [2e-7 - overlap, 0, 0]], [1e-7] * 2, material="ice", law=Spring(k), box=periodic(edge),
        duration=1e-15, timestep=1e-16, records=1,
    )  # fmt: skip
    assert run.pressure_tensor.values[-1, 0] == pytest.approx(k * overlap * (2e-7 - overlap) / edge**3, rel=1e-6)
    assert run.stored.values[0, 0] == pytest.approx(0.5 * k * overlap**2)


def n_fields_and_edge(law, box):
    return law.n_fields() + box.edges(np.zeros(1))[0]


def test_compiled_code_of_foreign_parts_is_not_kept_on_disk():
    """The cache would not notice that they change; that of the package's own is kept."""
    for law, hits in ((jkr(), 1), (Spring(1.0), 0)):
        jit(n_fields_and_edge)(law, open_space())
        again = jit(n_fields_and_edge)
        assert again(law, open_space()) == law.n_fields()
        assert sum(again.stats.cache_hits.values()) == hits


def test_a_part_must_name_its_arguments_like_the_others():
    with pytest.raises(TypeError, match="Other.ended.*must have the arguments"):

        @part
        class Other(NamedTuple):
            k: float

            def ended(self, contact, start):
                return False


def test_what_a_law_lacks_is_told():
    """Spring has no radius of the contact area."""
    law = Spring(1.0)
    touching = np.array([[0.0, 0, 0], [1.9e-7, 0, 0]])
    state = new_state(touching, np.full(2, 1e-7), MATERIALS["ice"], np.array([[0, 1]]), law, open_space(), leapfrog())
    with pytest.raises(TypingError, match="Spring has no method contact_radius"):
        total_stress(state, law)
