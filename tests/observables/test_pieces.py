"""Pieces of a state, energies and momenta, against plain sums."""

import numpy as np
import pytest

import naive_geometry as naive
from ratd.base.materials import MATERIALS
from ratd.engine.contacts import remove_contact
from ratd.engine.fragments import label_fragments
from ratd.engine.layout import CONTACTS, INERTIA, LARGEST_CONTACTS, LARGEST_MONOMERS, MASS
from ratd.engine.leapfrog import leapfrog
from ratd.engine.state import monomer_rows, new_state
from ratd.geometry.box import open_space
from ratd.laws import jkr
from ratd.observables.energy import kinetic, momenta, stored
from ratd.observables.pieces import heaviest_pieces, pieces
from systems import tree

MATERIAL, LAW = MATERIALS["q-S"], jkr()


def three_pieces():
    """A tree of twelve from which two contacts are taken, in motion."""
    rng = np.random.default_rng(8)
    radius = rng.uniform(20e-9, 60e-9, 12)
    position = tree(radius, MATERIAL, 3)
    touching = np.linalg.norm(position[:, None] - position, axis=2) < radius + radius[:, None]
    motion = rng.normal(size=(2, 12, 3))
    state = new_state(
        position, radius, MATERIAL, np.argwhere(np.triu(touching, 1)), LAW, open_space(), leapfrog(),
        velocity=motion[0], spin=motion[1] * 1e7,
    )  # fmt: skip
    for k in (3, 7):
        remove_contact(state, LAW, k)
    return state


def test_pieces_are_those_of_spreading_labels():
    state = three_pieces()
    mass, members, label = pieces(state)
    k = state.counter[CONTACTS]
    pairs = np.array([state.pair_i[:k], state.pair_j[:k]]).T.astype(int)
    wanted = naive.connected_components(12, pairs)
    np.testing.assert_array_equal(label, wanted)
    rows = monomer_rows(state)
    assert len(mass) == 3
    for piece in range(3):
        assert mass[piece] == pytest.approx(rows[wanted == piece, MASS].sum(), rel=1e-12)
        assert members[piece] == (wanted == piece).sum()
    np.testing.assert_array_equal(heaviest_pieces(state), np.sort(mass)[:0:-1])
    np.testing.assert_array_equal(heaviest_pieces(state, 5), [*np.sort(mass)[::-1], 0.0, 0.0])
    assert label_fragments(state) == 3
    largest = int(mass.argmax())
    np.testing.assert_array_equal(state.fragment == 0, wanted == largest)
    assert state.counter[LARGEST_MONOMERS] == members[largest]
    assert state.counter[LARGEST_CONTACTS] == (wanted[pairs[:, 0]] == largest).sum()


def test_energies_and_momenta_are_plain_sums():
    state = three_pieces()
    label_fragments(state)
    rows = monomer_rows(state)
    m, own = rows[:, MASS], rows[:, INERTIA]
    x, v, w = rows[:, 0:3], rows[:, 4:7], rows[:, 8:11]
    omega = np.array([0, 0, 3e6])
    lab, spin = v + np.cross(omega, x), w + omega
    for inside, largest in ((np.ones(12, bool), False), (state.fragment == 0, True)):
        wanted = 0.5 * m[inside] @ (lab[inside] ** 2).sum(1), 0.5 * own[inside] @ (spin[inside] ** 2).sum(1)
        assert kinetic(state, 3e6, largest) == pytest.approx(wanted, rel=1e-12)
    wanted = np.array([m @ v, m @ np.cross(x, v) + own @ w])
    np.testing.assert_allclose(momenta(state), wanted, rtol=1e-9, atol=1e-14 * np.abs(wanted).max())
    # U = -1.2 F_C delta_0 of each contact at rest (4 (6/5 - 2 + 1/2) = -1.2)
    k = state.counter[CONTACTS]
    r = rows[:, 3]
    a_i, a_j = r[state.pair_i[:k].astype(int)], r[state.pair_j[:k].astype(int)]
    reduced = a_i * a_j / (a_i + a_j)
    f_c = 3 * np.pi * MATERIAL.surface_energy * reduced
    r0 = (9 * np.pi * MATERIAL.surface_energy * reduced**2 / MATERIAL.reduced_modulus) ** (1 / 3)
    held = stored(state, LAW, False)
    assert held[0] == pytest.approx(-1.2 * (f_c * r0**2 / (3 * reduced)).sum(), rel=1e-9)
    assert np.abs(held[1:]).max() < 1e-12 * abs(held[0])
