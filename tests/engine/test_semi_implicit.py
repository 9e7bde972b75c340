"""The semi-implicit step: its matrix, what it keeps, and what it shares with the explicit one."""

import numpy as np
import pytest

from ratd.base.errors import InputError
from ratd.base.materials import MATERIALS
from ratd.drives.free import free, rest
from ratd.engine.layout import CONTACTS, DT, DT_DRIFT, FORCE_ROW, MASS, RADIUS, VX, WX, X
from ratd.engine.leapfrog import leapfrog
from ratd.engine.mass_matrix import TURNED, make_matrix, weigh
from ratd.engine.semi_implicit import RUNG, _work, add_turns, contact_speeds, rung_below, semi_implicit
from ratd.engine.state import contact_field, copied, monomer_rows, new_state
from ratd.engine.step import run, until
from ratd.geometry.box import open_space, periodic, touching_pairs
from ratd.laws import jkr
from ratd.laws.contact_fields import LANES, NCX, NCY, NCZ
from ratd.laws.jkr_with_springs import NIX, NJX
from ratd.observables.energy import DISSIPATED, dissipated, in_step, kinetic, momenta, stored
from systems import tree

N = 12
LAW, BOX = jkr(), open_space()
STILL = BOX.rates()


def cluster(speed=0.0, integrator=None, law=LAW):
    rng = np.random.default_rng(8)
    radius = rng.uniform(12e-9, 60e-9, N)
    position = tree(radius, "q-S", 5)
    motion = rng.normal(size=(2, N, 3)) * np.array([speed, speed / 30e-9])[:, None, None]
    contacts = touching_pairs(position, radius, BOX)
    return new_state(
        position, radius, MATERIALS["q-S"], contacts, law, BOX, integrator or leapfrog(),
        velocity=motion[0], spin=motion[1],
    )  # fmt: skip


def rolled(state, angle=0.2):
    """The same with the pointers of all contacts turned by about an angle, as after rolling, sliding and twisting."""
    rng = np.random.default_rng(4)
    for k in range(state.counter[CONTACTS]):
        for first in (NIX, NJX):
            at = int(first) + LANES * np.arange(3) + k  # in the first block
            pointer = state.contact[at] + rng.normal(size=3) * angle
            state.contact[at] = pointer / np.linalg.norm(pointer)
    return state


def dense_matrix(state, theta, dt):
    """M' of velocities and spins, contact by contact from the definition of J."""
    rows = monomer_rows(state)
    n = len(rows)
    matrix = np.zeros((6 * n, 6 * n))
    for k in range(n):
        m, a = rows[k, MASS], rows[k, RADIUS]
        matrix[6 * k : 6 * k + 6, 6 * k : 6 * k + 6] = np.diag([m] * 3 + [0.4 * m * a**2] * 3)
    normals = np.array([contact_field(state, field) for field in (NCX, NCY, NCZ)]).T
    for k in range(state.counter[CONTACTS]):
        i, j = int(state.pair_i[k]), int(state.pair_j[k])
        normal = normals[k]
        distance = np.linalg.norm(rows[i, X : X + 3] - rows[j, X : X + 3])
        a_i, a_j = rows[i, RADIUS], rows[j, RADIUS]
        at = np.uint64(k)  # in the first block
        along = np.outer(normal, normal)
        across = np.eye(3) - along
        pointers = [np.array(pointer) for pointer in LAW.pointers(state.contact, at)]
        seen = a_i * pointers[0] + a_j * pointers[1]
        slide, turn = np.zeros((3, 6 * n)), np.zeros((3, 6 * n))
        for who, sign, a, pointer in ((i, 1.0, a_i, pointers[0]), (j, -1.0, a_j, pointers[1])):
            x, y, z = distance / (seen @ normal) * (pointer - across @ seen / (a_i + a_j))
            cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
            slide[:, 6 * who : 6 * who + 3] = sign * np.eye(3)
            slide[:, 6 * who + 3 : 6 * who + 6] = a * across @ cross
            turn[:, 6 * who + 3 : 6 * who + 6] = sign * np.eye(3)
        k_n, k_s, k_r, k_t = LAW.stiffness(state.contact, at)
        damping = LAW.damping_now(state.contact, at)
        for j_c, weight in (
            (slide, (theta * dt**2 * k_n + dt * damping) * along + theta * dt**2 * k_s * across),
            (turn, theta * dt**2 * (k_r * across + k_t * along)),
        ):
            matrix += j_c.T @ weight @ j_c
    return matrix


@pytest.mark.parametrize("angle", [0.0, 0.2])
def test_forces_are_weighed_by_the_matrix_of_the_contacts(angle):
    state = rolled(cluster(), angle)
    theta, dt = 0.5, 3e-11
    work = _work(state)
    make_matrix(state, LAW, BOX, theta, dt, work)
    rng = np.random.default_rng(3)
    rows = monomer_rows(state)
    force = state.force.reshape(-1, FORCE_ROW)[:N]
    pulls = rng.normal(size=(N, 6)) * np.array([1e-9] * 3 + [1e-17] * 3)
    force[:, 0:3], force[:, 4:7] = pulls[:, :3], pulls[:, 3:]
    weigh(state, 0.0, dt, dt, STILL, work)
    expected = np.linalg.solve(dense_matrix(state, theta, dt), pulls.ravel()).reshape(N, 6)
    np.testing.assert_allclose(force[:, 0:3] / rows[:, MASS, None], expected[:, :3], rtol=1e-7)
    inertia = 0.4 * rows[:, MASS] * rows[:, RADIUS] ** 2
    np.testing.assert_allclose(force[:, 4:7] / inertia[:, None], expected[:, 3:], rtol=1e-7)


def test_what_the_step_takes_is_the_work_of_the_forces_less_that_of_the_motion():
    """The work of the forces along half of the last move and half of the next, against the change of kinetic energy."""
    state = cluster(0.5)
    last, dt = 2e-11, 7e-11
    work = _work(state)
    make_matrix(state, LAW, BOX, 0.5, dt, work)
    rows = monomer_rows(state)
    force = state.force.reshape(-1, FORCE_ROW)[:N]
    pulls = np.random.default_rng(3).normal(size=(N, 6)) * np.array([1e-9] * 3 + [1e-17] * 3)
    force[:, 0:3], force[:, 4:7] = pulls[:, :3], pulls[:, 3:]
    taken = weigh(state, 0.0, last, dt, STILL, work)
    mass = np.repeat(rows[:, [MASS, MASS]] * np.array([1.0, 0.4]) * rows[:, [RADIUS, RADIUS]] ** [0, 2], 3, axis=1)
    before = np.hstack([rows[:, VX : VX + 3], rows[:, WX : WX + 3]])
    after = before + 0.5 * (last + dt) * np.hstack([force[:, 0:3], force[:, 4:7]]) / mass
    gained = 0.5 * np.sum(mass * (after**2 - before**2))
    assert taken == pytest.approx(np.sum(pulls * 0.5 * (before * last + after * dt)) - gained, rel=1e-9)
    assert taken > 0.0


@pytest.mark.parametrize("angle", [0.0, 0.2])
def test_rigid_motion_has_its_true_mass_and_is_not_calmed(angle):
    state = rolled(cluster(), angle)
    work = _work(state)
    make_matrix(state, LAW, BOX, 0.5, 1e-10, work)
    rows = monomer_rows(state)
    rng = np.random.default_rng(0)
    shift, turn = rng.normal(size=3), rng.normal(size=3) * 1e7
    rows[:, VX : VX + 3] = shift + np.cross(turn, rows[:, X : X + 3])
    rows[:, WX : WX + 3] = turn
    force = state.force.reshape(-1, FORCE_ROW)[:N]
    force[:] = 0.0
    weigh(state, 1e9, 1e-10, 1e-10, STILL, work)  # with the rate alone: M (rate M'^-1 M v - rate v) is 0
    limit = 1e9 * rows[:, MASS, None] * np.abs(rows[:, VX : VX + 3]).max()
    assert (np.abs(force[:, :3]) < 1e-8 * limit).all()


@pytest.mark.parametrize("rate", [-3e3, (5e3, 0.0, -2e3)])
def test_rigid_motion_is_not_calmed_in_a_box_that_changes(rate):
    state = rolled(cluster())
    box = periodic(1e-6, rate)
    work = _work(state)
    make_matrix(state, LAW, box, 0.5, 1e-10, work)
    rows = monomer_rows(state)
    rows[:, VX : VX + 3] = -np.array(box.rates()) * rows[:, X : X + 3]  # peculiar: at rest in space
    force = state.force.reshape(-1, FORCE_ROW)[:N]
    force[:] = 0.0
    weigh(state, 1e9, 1e-10, 1e-10, STILL, work)
    limit = 1e9 * rows[:, MASS, None] * np.abs(rows[:, VX : VX + 3]).max()
    assert (np.abs(force[:, :3]) < 1e-8 * limit).all()
    assert (np.abs(force[:, 4:7]) < 1e-8 * limit * rows[:, RADIUS, None]).all()


def test_a_body_at_rest_in_a_box_that_changes_needs_the_force_of_its_true_mass():
    """Forces that keep it against the drag of the box are not changed, and leave its velocities as they are."""
    state = rolled(cluster())
    box, dt = periodic(1e-6, (-3e3, 2e3, -1e3)), 1e-10
    work = _work(state)
    make_matrix(state, LAW, box, 0.5, dt, work)
    rows = monomer_rows(state)
    rows[:, VX : VX + 3] = -np.array(box.rates()) * rows[:, X : X + 3]
    held = -rows[:, MASS, None] * rows[:, VX : VX + 3] * np.expm1(-np.array(box.rates()) * dt) / dt
    force = state.force.reshape(-1, FORCE_ROW)[:N]
    force[:] = 0.0
    force[:, :3] = held
    weigh(state, 0.0, dt, dt, box.rates(), work)
    np.testing.assert_allclose(force[:, :3], held, rtol=1e-9, atol=1e-9 * np.abs(held).max())
    assert np.abs(force[:, 4:7]).max() < 1e-9 * np.abs(held).max() * rows[:, RADIUS].max()


def test_longer_steps_calm_less():
    """From `calmed` on the part that is taken away falls as the inverse of the step."""
    moved = []
    for calmed in (np.inf, 1e-10, 0.5e-10):
        integrator = semi_implicit(longest=2e-10, displacement=1.0, travel=1.0, calming=0.1, calmed=calmed)
        state = cluster(0.1, integrator)
        state.scalar[DT] = state.scalar[DT_DRIFT] = 2e-10
        state, _ = run(state, LAW, free(), BOX, integrator, until(steps=1))
        moved.append(monomer_rows(state)[:, VX : VX + 3].copy())
    none, half, quarter = moved
    calm = none - half  # a half of what is taken without a limit
    np.testing.assert_allclose(half - quarter, 0.5 * calm, atol=1e-6 * np.abs(calm).max())
    assert np.abs(calm).max() > 1e-4


@pytest.mark.parametrize("calming", [0.0, 0.2])
def test_momenta(calming):
    """Momentum is kept; angular momentum but for the half step and the angle by which the matrix lags."""
    integrator = semi_implicit(longest=1e-10, calming=calming)
    state = cluster(0.1, integrator)
    before = momenta(state)
    state, _ = run(state, LAW, free(), BOX, integrator, until(steps=2000))
    change = np.abs(momenta(state) - before).max(axis=1) / np.abs(before).max(axis=1)
    assert change[0] < 1e-11
    assert change[1] < 0.1


def test_long_steps_are_stable_where_explicit_ones_are_not():
    undamped = jkr(damping="none")
    integrator = semi_implicit(longest=4e-10, displacement=1.0, travel=1.0)
    state = cluster(1e-4, integrator, undamped)
    explicit_limit = cluster(0.0, leapfrog(timestep_factor=1.0), undamped).scalar[DT]
    state.scalar[DT] = integrator.longest
    assert integrator.longest > 5 * explicit_limit
    energies = []
    for goal in range(1000, 20001, 1000):
        state, _ = run(state, undamped, free(), BOX, integrator, until(steps=goal))
        energies.append(sum(kinetic(state, 0.0, False)))
    assert state.scalar[DT] == integrator.longest
    assert max(energies[10:]) < 3 * max(energies[:10])


def test_short_steps_move_as_explicit_ones_do():
    start = cluster(0.5)
    dt = 0.01 * start.scalar[DT] / 0.125
    ends = []
    for integrator in (
        leapfrog(timestep=dt, damping="explicit"),
        semi_implicit(longest=dt, displacement=1.0, travel=1.0),
    ):
        state = copied(start)
        state.scalar[DT] = dt
        state, _ = run(state, LAW, free(), BOX, integrator, until(steps=500))
        ends.append(monomer_rows(state)[:, X : X + 3] - monomer_rows(start)[:, X : X + 3])
    moved = np.abs(ends[0]).max()
    assert np.abs(ends[0] - ends[1]).max() < 5e-3 * moved


def test_it_comes_to_rest_where_the_explicit_step_does():
    ends = []
    for integrator, steps in ((leapfrog(), 60000), (semi_implicit(longest=1e-9, calming=0.1), 4000)):
        state = cluster(0.01, integrator)
        state, _ = run(state, LAW, rest(1e8), BOX, integrator, until(steps=steps))
        rows = monomer_rows(state)
        assert np.abs(rows[:, VX : VX + 3]).max() < 1e-3
        i, j = state.pair_i[: N - 1].astype(int), state.pair_j[: N - 1].astype(int)
        ends.append(np.linalg.norm(rows[i, X : X + 3] - rows[j, X : X + 3], axis=1))
    np.testing.assert_allclose(ends[1], ends[0], atol=2e-12)


def test_steps_are_rungs_of_a_ladder():
    for step in (1e-9, 0.9e-9, 3e-11, 1e-13):
        found = rung_below(1e-9, step)
        assert found <= step * (1 + 1e-9) and found > RUNG * step * (1 - 1e-9)


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"longest": 0.0}, "longest is 0.0"),
        ({"theta": 0.1}, "theta"),
        ({"calming": 1.0}, "calming"),
        ({"landing": 0.0}, "landing is 0.0"),
    ],
)
def test_bad_options_get_a_sentence(wrong, words):
    with pytest.raises(InputError, match=words):
        semi_implicit(**({"longest": 1e-9} | wrong))


@pytest.mark.parametrize("gap", [5.1e-9, 5.25e-9, 5.4e-9, 5.6e-9])
def test_spheres_land_with_a_small_overlap(gap):
    """However the long steps fall: the contact is there when they touch, and the next step knows it."""
    radius = np.full(2, 20e-9)
    position = np.array([[0.0, 0.0, 0.0], [2 * radius[0] + gap, 0.0, 0.0]])
    integrator = semi_implicit(longest=2.5e-10, displacement=2e-10, travel=2e-9)
    velocity = np.array([[1.5, 0.0, 0.0], [-1.5, 0.0, 0.0]])
    state = new_state(position, radius, MATERIALS["q-S"], [], LAW, BOX, integrator, velocity=velocity)
    state.scalar[DT] = 2.5e-10
    overlap = []
    while not overlap or state.counter[CONTACTS] == 0:
        state, _ = run(state, LAW, free(), BOX, integrator, until(steps=int(state.counter[0]) + 1))
        rows = monomer_rows(state)
        overlap.append(2 * radius[0] - np.linalg.norm(rows[0, X : X + 3] - rows[1, X : X + 3]))
    assert (np.array(overlap[:-1]) < 0.0).all() and 0.0 < overlap[-1] <= 2.001e-10
    state, _ = run(state, LAW, free(), BOX, integrator, until(steps=int(state.counter[0]) + 1))
    assert state.scalar[DT] * 3.0 < 3e-10


@pytest.mark.parametrize("gap", [5e-11, 2e-10, 3e-10, 4.1e-10])
def test_the_fall_into_a_new_contact_keeps_the_balance_of_energy(gap):
    """In short steps, and not in long ones; of two ice spheres of a compression that slowly meet."""
    law, radius, t_0 = jkr(damping="constant", constant_damping=0.01), 1e-7, 1.94e-10
    position = np.array([[radius + 0.5 * gap, 0.0, 0.0], [-radius - 0.5 * gap, 0.0, 0.0]])
    velocity = np.array([[-2.5e-3, 0.0, 0.0], [2.5e-3, 0.0, 0.0]])
    missing = []
    for landing in (0.2 * t_0, np.inf):
        integrator = semi_implicit(
            longest=30 * t_0, displacement=5e-11, travel=5e-11, calming=0.1, landing=landing
        )  # fmt: skip
        sizes = np.full(2, radius), MATERIALS["ice"], []
        state = new_state(position, *sizes, law, BOX, integrator, velocity=velocity)
        before = sum(kinetic(state, 0.0, False))
        state, _ = run(state, law, free(), BOX, integrator, until(time=2e-7))
        now = in_step(state, law, BOX, kick=False)
        gone = dissipated(now, law)
        total = sum(kinetic(now, 0.0, False)) + stored(now, law, False).sum() + gone.sum()
        missing.append(abs(total - before) / gone[DISSIPATED.index("made")])
    assert missing[0] < 2e-3, missing
    assert missing[1] > 1e-2, missing


def two_clusters():
    """The cluster twice, out of reach of each other, as two fragments."""
    one = cluster()
    rows, n = monomer_rows(one), one.counter[CONTACTS]
    position = np.vstack([rows[:, X : X + 3], rows[:, X : X + 3] + [1e-6, 0.0, 0.0]])
    pairs = np.array([one.pair_i[:n], one.pair_j[:n]], dtype=np.int64).T
    both = np.vstack([pairs, pairs + N])
    state = new_state(position, np.tile(rows[:, RADIUS], 2), MATERIALS["q-S"], both, LAW, BOX, leapfrog())
    state.fragment[N:] = 1
    return state


def weighed(state, work):
    """Random forces after `weigh`."""
    force = state.force.reshape(-1, FORCE_ROW)[: 2 * N]
    force[:] = 0.0
    pulls = np.random.default_rng(3).normal(size=(2 * N, 6)) * np.array([1e-9] * 3 + [1e-17] * 3)
    force[:, 0:3], force[:, 4:7] = pulls[:, :3], pulls[:, 3:]
    weigh(state, 0.0, 3e-11, 3e-11, STILL, work)
    return force.copy()


def test_the_part_of_a_fragment_that_has_turned_is_made_anew_and_no_other():
    state = two_clusters()
    work = _work(state)
    make_matrix(state, LAW, BOX, 0.5, 3e-11, work)
    before = weighed(state, work)
    turned = rolled(state)  # the contacts of both
    work.turned[1] = 2 * TURNED
    make_matrix(turned, LAW, BOX, 0.5, 3e-11, work)
    found = weighed(turned, work)
    fresh = _work(turned)
    make_matrix(turned, LAW, BOX, 0.5, 3e-11, fresh)
    wanted = weighed(turned, fresh)
    np.testing.assert_array_equal(found[:N], before[:N])
    np.testing.assert_array_equal(found[N:], wanted[N:])
    assert np.abs(wanted[:N] - before[:N]).max() > 1e-3 * np.abs(before[:N]).max()
    assert (work.turned == 0.0).all()


def test_angles_are_counted_for_each_fragment():
    state = two_clusters()
    rows = monomer_rows(state)
    rows[N:, VX : VX + 3] = np.cross([0.0, 0.0, 2e6], rows[N:, X : X + 3] - rows[N, X : X + 3])
    work = _work(state)
    greatest, stretching = contact_speeds(state, LAW, work.turn_rate)
    assert work.turn_rate[0] == 0.0 and 0.0 < work.turn_rate[1] <= 2e6
    assert add_turns(work, 1e-9) == work.turned[1] == pytest.approx(1e-9 * work.turn_rate[1])
    assert greatest > 0.0 and stretching < 1e-9 * greatest


def test_a_monomer_that_touches_its_own_copy_is_weighed_too():
    """One sphere and its copies, a row along x: they keep their distance, and slide on each other when they spin."""
    radius = 30e-9
    box = periodic((1.99 * radius, 1e-6, 1e-6))
    state = new_state(
        np.zeros((1, 3)), np.array([radius]), MATERIALS["q-S"],
        touching_pairs(np.zeros((1, 3)), np.array([radius]), box), LAW, box, leapfrog(),
    )  # fmt: skip
    assert state.counter[CONTACTS] == 1
    work = _work(state)
    dt = 3e-11
    make_matrix(state, LAW, box, 0.5, dt, work)
    row = monomer_rows(state)[0]
    _, k_s, _, _ = LAW.stiffness(state.contact, np.uint64(0))
    inertia = 0.4 * row[MASS] * radius**2
    # both surfaces move against each other by w times the distance of the centres
    slow = inertia + 0.5 * dt**2 * k_s * (1.99 * radius) ** 2
    state.force[4:7] = 1e-20
    weigh(state, 0.0, dt, dt, STILL, work)
    np.testing.assert_allclose(state.force[4:7], 1e-20 * inertia / np.array([inertia, slow, slow]), rtol=1e-9)
