"""Lists of near pairs: no contact is missed, and changes of contacts cost no full search."""

import numpy as np
import pytest

from ratd.base.materials import MATERIALS
from ratd.drives.free import free
from ratd.drives.squeezing import squeezing
from ratd.engine.contacts import get_image
from ratd.engine.layout import CONTACTS, SEARCHES
from ratd.engine.leapfrog import leapfrog
from ratd.engine.state import copied, monomer_rows, new_state
from ratd.engine.step import run, until
from ratd.geometry.box import open_space, periodic
from ratd.laws import dmt, jkr
from systems import tree

LAW, INTEGRATOR = jkr(damping="none", friction="none"), leapfrog()
NOTHING = np.zeros((0, 2), dtype=np.int64)


def dense(edges, rate, n=150, size=30e-9):
    """Spheres in a periodic box, put there at random without overlap, hot: box, drive, positions, radii."""
    rng = np.random.default_rng(4)
    radius = size * rng.uniform(0.6, 1.4, n)
    radius = np.sort(radius)[::-1]
    edges = np.array(edges)
    position = np.zeros((n, 3))
    for k in range(n):
        while True:
            position[k] = rng.uniform(0, edges)
            d = position[:k] - position[k]
            d -= edges * np.round(d / edges)
            if (np.linalg.norm(d, axis=1) > radius[:k] + radius[k]).all():
                break
    # unwrapped: some far outside
    return periodic(edges, rate), squeezing(), position + edges * rng.integers(-2, 3, (n, 3)), radius


def cluster(ratio, n=40):
    """A cluster in open space, two spheres of it larger than the others by this ratio: as `dense`."""
    radius = 30e-9 * np.random.default_rng(4).uniform(0.6, 1.4, n)
    radius[:2] *= ratio
    return open_space(), free(), tree(radius, "q-S", 5), radius


CASES = {  # system, speed [m/s]
    "open": (cluster(1.0), 1.0),
    "1:50": (cluster(50.0), 2.0),
    "shrinking": (dense([400e-9] * 3, -5e6), 6.0),
    "unevenly": (dense([360e-9, 400e-9, 440e-9], [-8e6, 0, 3e6]), 6.0),
}


def touching(state, box):
    """Pairs whose surfaces overlap, with their images, from all differences."""
    rows, edges = monomer_rows(state), np.array(box.edges(state.scalar))
    x, a = rows[:, :3], rows[:, 3]
    i, j = np.triu_indices(len(a), 1)
    d = x[i] - x[j]
    home = -np.round(d / edges) if edges[0] > 0 else np.zeros_like(d)
    cells = np.array(np.meshgrid(*[[-1, 0, 1]] * 3)).reshape(3, -1).T if edges[0] > 0 else np.zeros((1, 3))
    found = set()
    for cell in cells:
        n = home + cell
        for p in np.flatnonzero(np.linalg.norm(d + n * edges, axis=1) < a[i] + a[j]):
            found.add((i[p], j[p], *map(int, n[p])))
    return found


def in_contact(state):
    """Pairs in contact, with their images, the smaller number first."""
    found = set()
    for k in range(state.counter[CONTACTS]):
        i, j, image = int(state.pair_i[k]), int(state.pair_j[k]), np.array(get_image(state, k))
        sign = 1 if i < j else -1
        found.add((min(i, j), max(i, j), *map(int, sign * image)))
    return found


@pytest.mark.parametrize("name", CASES)
def test_no_contact_is_missed_and_few_searches_are_made(name):
    """Contacts come and go all the time; lists that are made anew every few steps lead to the same bits."""
    (box, drive, position, radius), speed = CASES[name]
    velocity = speed * np.random.default_rng(6).normal(size=(len(radius), 3))
    state = new_state(position, radius, MATERIALS["q-S"], NOTHING, LAW, box, INTEGRATOR, velocity=velocity)
    fresh, steps, changes, before = copied(state), 3000, 0, set()
    for goal in range(10, steps + 1, 10):
        fresh, _ = run(fresh, LAW, drive, box, INTEGRATOR, until(steps=goal))
        now = in_contact(fresh)
        changes += len(now ^ before)
        before = now
    for goal in (steps // 3, 2 * steps // 3, steps):
        state, _ = run(state, LAW, drive, box, INTEGRATOR, until(steps=goal))
        assert touching(state, box) <= in_contact(state) and len(in_contact(state)) > 10
    assert fresh.monomer.tobytes() == state.monomer.tobytes()
    assert changes > 30
    # measured 14 to 18 of 60 changes in the clusters, 200 of 3000 to 4000 in the boxes
    assert 0 < state.counter[SEARCHES] < (0.1 if len(radius) > 100 else 0.5) * changes


def test_spheres_at_rest_in_a_shrinking_box_meet():
    """Lists wear by the shrinking alone: nothing moves against the box."""
    a, length = 30e-9, 1e-6
    box, rest = periodic(length, -1e7), np.zeros((2, 3))
    position = np.array([[0.0, 0, 0], [80e-9, 0, 0]])
    state = new_state(position, np.full(2, a), MATERIALS["q-S"], NOTHING, LAW, box, INTEGRATOR, velocity=rest)
    touch = np.log(60 / 80) / -1e7
    state, _ = run(state, LAW, squeezing(), box, INTEGRATOR, until(time=0.999 * touch))
    assert state.counter[CONTACTS] == 0
    # from the start once more, in one call
    state = new_state(position, np.full(2, a), MATERIALS["q-S"], NOTHING, LAW, box, INTEGRATOR, velocity=rest)
    state, _ = run(state, LAW, squeezing(), box, INTEGRATOR, until(time=1.001 * touch))
    assert state.counter[CONTACTS] == 1


def test_a_contact_that_has_broken_can_form_again_at_once():
    """A small sphere bounces between two heavy ones, a thousandth of its radius apart: no list is worn meanwhile."""
    a, law = 30e-9, dmt(viscous_time=0.0, friction="none")
    radius = np.array([10 * a, a, 10 * a])
    position = np.zeros((3, 3))
    position[1, 0], position[2, 0] = 11 * a + 5e-4 * a, 22 * a + 1e-3 * a
    velocity = np.array([[0.0, 0, 0], [3.0, 0, 0], [0, 0, 0]])
    state = new_state(position, radius, MATERIALS["q-S"], NOTHING, law, open_space(), INTEGRATOR, velocity=velocity)
    fresh, seen = copied(state), []
    for goal in range(1, 301):
        fresh, _ = run(fresh, law, free(), open_space(), INTEGRATOR, until(steps=goal))
        seen.append(fresh.counter[CONTACTS])
    state, _ = run(state, law, free(), open_space(), INTEGRATOR, until(steps=300))
    assert (np.diff(seen) == 1).sum() > 2
    assert fresh.monomer.tobytes() == state.monomer.tobytes()
