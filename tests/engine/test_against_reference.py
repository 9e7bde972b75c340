"""Runs of three unequal spheres against the independent slow engine, in the limit of small steps."""

import numpy as np
import pytest

from ratd.base.materials import Material as Own
from ratd.experiments.evolve import evolve
from ratd.geometry.box import periodic
from ratd.laws import dmt, jkr
from reference.contact import DMT, ICE, JKR, SILICA, JKRWithDMT, Material
from reference.system import Cube, run
from systems import unit

T0 = 1.9365e-10  # of ice, 0.1 um
SOFT = Material(*ICE[:5], 0.5e-12)
CASES = {  # laws, material, size, speed, step, steps
    "jkr": (jkr(), JKR(), SOFT, 1e-7, 10.0, 0.01 * T0, 1000),
    "jkr undamped": (jkr(damping="none"), JKR("none"), ICE, 1e-7, 10.0, 0.01 * T0, 1000),
    "jkr, DMT normal force": (jkr(normal_force="DMT"), JKRWithDMT(), SOFT, 1e-7, 10.0, 0.005 * T0, 2000),
    "dmt": (dmt(friction="none"), DMT(0.5e-9, "none"), SILICA, 5e-7, 1.0, 10e-12, 1000),
    "dmt velocity": (dmt(friction="velocity"), DMT(0.5e-9, "velocity"), SILICA, 5e-7, 1.0, 10e-12, 1000),
    "dmt spring": (dmt(friction="spring"), DMT(0.5e-9, "spring"), SILICA, 5e-7, 1.0, 10e-12, 1000),
}


def three(size, speed):
    """Two spheres of unequal size hit a third off centre, all spinning: radii, positions, velocities, spins."""
    radius = np.array([1, 0.7, 1.3]) * size
    x = np.zeros((3, 3))
    x[1] = (radius[0] + radius[1]) * 1.0005 * unit(0.92, 0.39, 0.2)
    x[2] = (radius[0] + radius[2]) * 1.0005 * unit(0.3, -1, 0.1)
    u = np.array([[0, 0, 0], [-1, 0.1, 0.2], [0.2, 0.9, -0.3]]) * speed
    return radius, x, u, np.random.default_rng(1).normal(size=(3, 3)) * speed / size * 0.5


@pytest.mark.parametrize("rate", [0.0, -2e-3 / T0], ids=["open", "box"])
@pytest.mark.parametrize("name", CASES)
def test_same_motion_and_same_energies(name, rate):
    law, theirs, material, size, speed, dt, steps = CASES[name]
    if rate:
        rate *= T0 / (dt * steps / 10)  # the box shrinks to 0.82
    radius, x, u, w = three(size, speed)
    length = 20 * size
    slow = run(
        x, radius, u, w, material, law=theirs, dt=dt, steps=steps, every=steps, box=Cube(length, rate) if rate else None
    )
    ours = evolve(
        x, radius, u, w, Own("m", *material), law=law, duration=dt * (steps - 0.5), timestep=dt, damping="explicit",
        records=1, balance=None, box=periodic(length, rate) if rate else None,
    )  # fmt: skip
    system = slow["system"]
    assert ours.attrs["steps"] == steps
    assert ours.n_contacts.values[-1] == slow["contacts"][-1]
    way = np.abs(system.x - x).max()
    np.testing.assert_allclose(ours.position, system.x, rtol=0, atol=2e-3 * way)
    np.testing.assert_allclose(ours.velocity, system.u, rtol=0, atol=1e-2 * speed)
    np.testing.assert_allclose(ours.spin, system.w, rtol=0, atol=2e-2 * np.abs(w).max())
    scale = slow["kinetic"]["translation"][0] + slow["kinetic"]["spin"][0] + abs(slow["work"]["box"][-1])
    assert ours.box_work.values[-1] == pytest.approx(slow["work"]["box"][-1], abs=1e-3 * scale)
    for way in ours.way.values:
        lost = slow["dissipated"][way][-1]
        assert float(ours.dissipated.sel(way=way)[-1]) == pytest.approx(lost, abs=5e-3 * scale), way
    for mode in ours.storage.values:
        held = slow["potential"][mode][-1]
        assert float(ours.stored.sel(storage=mode)[-1]) == pytest.approx(held, abs=2e-3 * scale), mode
    assert slow["dissipated"]["damping"][-1] > 0.01 * scale or "undamped" in name
