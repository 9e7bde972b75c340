"""The same bits whether a run goes on at once, in pieces, or from a file: over laws, drives and boxes."""

import numpy as np
import pytest

from ratd.base.materials import MATERIALS
from ratd.drives.free import free
from ratd.drives.quasi_static import quasi_static
from ratd.drives.rotating import rotating
from ratd.drives.squeezing import squeezing
from ratd.engine.checkpoint import load, save
from ratd.engine.layout import CONTACTS, FRAGMENTS_LOST, SEARCHES, STEPS
from ratd.engine.leapfrog import leapfrog
from ratd.engine.semi_implicit import semi_implicit
from ratd.engine.state import copied, new_state
from ratd.engine.step import run, until
from ratd.geometry.box import open_space, periodic, touching_pairs
from ratd.laws import dmt, jkr
from systems import tree, used

N = 16
LAWS = {
    "jkr": jkr(),
    "jkr-dmt": jkr(normal_force="DMT"),
    "dmt-spring": dmt(viscous_time=0.5e-9, friction="spring"),
    "dmt-velocity": dmt(viscous_time=0.5e-9, friction="velocity"),
}
SLOW, FAST = (rotating("prescribed", omega_1=3e8, angular_acceleration=a) for a in (1e17, 3e18))
EXPLICIT = leapfrog()
LONG = semi_implicit(longest=1e-9, calming=0.1)
DRIVES = {  # box, drive, integrator, speed [m/s] with which contacts come and go, with JKR
    "free": (open_space(), free(), EXPLICIT, 20.0),
    "squeezing": (periodic(500e-9, -4e7), squeezing(), EXPLICIT, 20.0),
    "rotating": (open_space(), SLOW, EXPLICIT, 3.0),
    "leaving": (open_space(), FAST, EXPLICIT, 20.0),
    "squeezing in long steps": (periodic(500e-9, -4e7), squeezing(), LONG, 20.0),
    "waiting": (open_space(), quasi_static("prescribed", omega_1=3e8), LONG, 20.0),
}
OF_SEQUENCE = ("leaving", "squeezing in long steps", "waiting")
"""What has left is dropped, and the matrix of a long step is made anew, at times that another sequence of calls shifts:
the same sequence gives the same bits, another one need not."""


def start(law, box, integrator, speed):
    """Sixteen spheres of two materials, hot enough to make and break contacts, some through faces."""
    rng = np.random.default_rng(2)
    radius = rng.uniform(15e-9, 50e-9, N)
    position = tree(radius, "q-S", 3)
    materials = [MATERIALS["q-S"], MATERIALS["a-C"]]
    motion = rng.normal(size=(2, N, 3)) * np.array([speed, 2.5e7 * speed])[:, None, None]
    parts = law, box, integrator
    contacts = touching_pairs(position, radius, box)
    return new_state(
        position, radius, materials, contacts, *parts, velocity=motion[0], spin=motion[1], kind=rng.integers(0, 2, N)
    )  # fmt: skip


def same(first, second, but=()):
    first, second = used(first), used(second)
    for name in first:
        if name == "counter":
            for array in (first, second):
                array[name][list(but)] = 0
        assert first[name].tobytes() == second[name].tobytes(), name


CASES = [(law, drive) for law in LAWS for drive in DRIVES if drive not in OF_SEQUENCE]
CASES += [("jkr", drive) for drive in OF_SEQUENCE] + [("jkr-dmt", "squeezing in long steps"), ("jkr-dmt", "waiting")]


@pytest.mark.parametrize(("law", "drive"), CASES)
def test_same_bits(law, drive, tmp_path):
    name = drive
    gentle = law.startswith("jkr")
    law, (box, drive, integrator, speed) = LAWS[law], DRIVES[drive]
    begin = start(law, box, integrator, speed if gentle else 20.0)

    def go(state, *goals):
        for goal in goals:
            state, _ = run(state, law, drive, box, integrator, until(steps=goal))
        return state

    whole = go(copied(begin), 400)
    assert whole.counter[STEPS] == 400
    assert set(map(tuple, pairs(whole))) != set(map(tuple, pairs(begin)))
    half = go(copied(begin), 150)
    save(tmp_path / "half.npz", "key", half)
    again, _ = load(tmp_path / "half.npz", "key")
    again = go(again, 400)
    same(go(half, 400), again)
    assert load(tmp_path / "half.npz", "other key") is None
    if name == "leaving":
        assert whole.counter[FRAGMENTS_LOST] > 0
    if name in OF_SEQUENCE:
        return
    assert whole.counter[FRAGMENTS_LOST] == 0
    # Lists are made anew at every call: how often they were must not matter.
    same(again, whole, but=[SEARCHES])
    same(go(copied(begin), *range(7, 400, 31), 400), whole, but=[SEARCHES])


def pairs(state):
    return np.sort(np.array([state.pair_i, state.pair_j]).T[: state.counter[CONTACTS]].astype(int), axis=1)
