"""The pressure tensor of a state, against plain sums."""

import numpy as np
import pytest

from ratd.base.materials import Material
from ratd.drives.squeezing import mean_pressure_tensor, squeezing
from ratd.engine.layout import MASS, STEPS, VIRIAL, VX, X
from ratd.engine.leapfrog import leapfrog
from ratd.engine.state import monomer_rows, new_state
from ratd.engine.step import run, until
from ratd.geometry.box import periodic
from ratd.laws import jkr
from ratd.observables.pressure import COMPONENTS, pressure, pressure_tensor, volume
from reference.contact import ICE, JKR, Pair

A = 1e-7
MATERIAL, LAW = Material("ice", *ICE), jkr(damping="none", friction="none")


def test_of_two_pairs_in_motion():
    """Without friction and damping the force is the normal one; kinetic part and virial by hand, all six of them."""
    pair = Pair(ICE, A, A)
    gap = 2 * A - 1.7 * pair.delta_0
    slanted = gap * np.array([0.6, 0.0, 0.8])
    position = np.array([[0, 0, 0], [gap, 0, 0], [5e-7, 5e-7, 0], slanted + [5e-7, 5e-7, 0]])
    velocity = np.random.default_rng(1).normal(size=(4, 3)) * 1e-2
    box, contacts = periodic(2e-6), np.array([[0, 1], [2, 3]])
    step = leapfrog(timestep=1e-13, damping="explicit")
    state = new_state(position, np.full(4, A), MATERIAL, contacts, LAW, box, step, velocity=velocity)
    before = monomer_rows(state)[np.argsort(state.identity), X : X + 3].copy()
    drive = squeezing()
    run(state, LAW, drive, box, step, until(steps=1))
    assert state.counter[STEPS] == 1
    rows = monomer_rows(state)
    wanted = np.einsum("k,ka,kb->ab", rows[:, MASS], rows[:, VX : VX + 3], rows[:, VX : VX + 3])
    for i, j in contacts:
        d = before[i] - before[j]
        length = np.linalg.norm(d)
        wanted += np.outer(d, d / length * JKR().normal(pair, 2 * A - length))
    wanted /= 8e-18
    found = pressure_tensor(state, box)
    assert volume(state, box) == pytest.approx(8e-18)
    np.testing.assert_allclose(found, [wanted["xyz".index(a), "xyz".index(b)] for a, b in COMPONENTS], rtol=1e-9)
    assert pressure(found) == pytest.approx(np.trace(wanted) / 3.0)
    # of a single step the mean is the same, but for the kinetic part, which it takes about the kick
    np.testing.assert_allclose(mean_pressure_tensor(state), found, rtol=1e-2)


def test_sliding_adds_nothing_to_the_pressure():
    """It is normal to the line between the centres, so that it shows in the shear components alone."""
    pair, law = Pair(ICE, A, A), jkr(damping="none")
    gap = 2 * A - 1.2 * pair.delta_0
    box, step = periodic(2e-6), leapfrog(timestep=1e-13, damping="explicit")
    velocity = np.array([[0.0, 0.05, 0.0], [0.0, -0.05, 0.0]])
    contacts = np.array([[0, 1]])
    position = np.array([[0.0, 0.0, 0.0], [gap, 0.0, 0.0]])
    state = new_state(position, np.full(2, A), MATERIAL, contacts, law, box, step, velocity=velocity)
    drive = squeezing()
    state, _ = run(state, law, drive, box, step, until(steps=300))
    before = monomer_rows(state)[np.argsort(state.identity), X : X + 3].copy()
    state, _ = run(state, law, drive, box, step, until(steps=301))
    d = before[0] - before[1]
    length = np.linalg.norm(d)
    normal = JKR().normal(pair, 2 * A - length)
    virial = state.scalar[VIRIAL : VIRIAL + 6]
    assert virial[:3].sum() == pytest.approx(length * normal, rel=1e-9)
    assert abs(virial[3]) > 100 * abs(normal * d[0] * d[1] / length)
