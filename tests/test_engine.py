"""The engine: against the slow reference, conservation laws, order of the scheme, contacts, fragments."""

import numpy as np
import pytest

import naive_engine
from ratd.bound import cut_bound
from ratd.drives import AT_REST, OMEGA_RAT, angular_velocity, make_drive
from ratd.engine import layout
from ratd.engine.advance import REACHED, STEPS_DONE, advance
from ratd.engine.contacts import contact_energies, update_contact_rates
from ratd.engine.forces import SCRATCH_SIZE, contact_forces, forces_between
from ratd.engine.fragments import find_fragments
from ratd.engine.measure import dissipated, total_stress
from ratd.engine.state import contact_blocks, contact_field, monomer_rows, new_state
from ratd.grain import Grain
from ratd.growth import grow
from ratd.materials import MATERIALS
from ratd.spinup import _advance, relax

MATERIAL = MATERIALS["q-S"]
VELOCITY = slice(int(layout.VX), int(layout.VX) + 3)
SPIN = slice(int(layout.WX), int(layout.WX) + 3)


def state_of(grain, timestep_factor=0.02, implicit=True):
    state = new_state(
        grain.position, grain.radius, grain.material, grain.contacts,
        timestep_factor=timestep_factor, implicit_damping=implicit,
    )  # fmt: skip
    find_fragments(state)
    return state


def shaken(grain, speed, spin, seed=0, **options):
    """State of a grain whose monomers have random velocities and spins."""
    state = state_of(grain, **options)
    rng = np.random.default_rng(seed)
    rows = monomer_rows(state)
    rows[:, VELOCITY] = speed * rng.normal(size=(len(rows), 3))
    rows[:, SPIN] = spin * rng.normal(size=(len(rows), 3))
    find_fragments(state)
    return state


def with_field(state, field, value):
    """Set one field of all contacts."""
    contact_blocks(state)[:, int(field) // layout.LANES, :] = value


def forces(state, dt_drift, dt):
    contact_forces(
        state.monomer, state.force, state.contact, state.pair_i, state.pair_j, np.zeros(SCRATCH_SIZE),
        state.counter[layout.CONTACTS], dt_drift, dt,
    )  # fmt: skip
    rows = state.force.reshape(-1, layout.FORCE_ROW)[: state.counter[layout.MONOMERS]]
    return rows[:, :3].copy(), rows[:, 4:7].copy()


def momenta(state):
    """Linear and angular momentum about the origin, each with the sum of the magnitudes of its parts."""
    rows = monomer_rows(state)
    m, inertia = rows[:, 12:13], rows[:, 13:14]
    linear = m * rows[:, VELOCITY]
    angular = np.cross(rows[:, :3], linear) + inertia * rows[:, SPIN]
    return linear.sum(0), np.linalg.norm(linear, axis=1).sum(), angular.sum(0), np.linalg.norm(angular, axis=1).sum()


def kinetic(rows):
    return 0.5 * (rows[:, 12] @ (rows[:, VELOCITY] ** 2).sum(1) + rows[:, 13] @ (rows[:, SPIN] ** 2).sum(1))


@pytest.mark.parametrize("kind", ["BA", "BAM2"])
def test_contacts_one_by_one_have_the_forces_of_whole_blocks(kind):
    grain = grow(kind, 120e-9, MATERIAL, 1)
    state = shaken(grain, 1.0, 1e8)
    dt = state.scalar[layout.DT]
    wanted, scratch = np.zeros((2, grain.n_monomers, 3)), np.zeros(SCRATCH_SIZE)
    one = state._replace(contact=state.contact.copy())
    for k, (i, j) in enumerate(zip(state.pair_i, state.pair_j, strict=True)):
        if k < state.counter[layout.CONTACTS]:
            forces_between(one.monomer, one.contact, one.pair_i, one.pair_j, scratch, k, 1, dt, dt)
            push, turn_i, turn_j = scratch[int(layout.FX) :: layout.LANES].reshape(3, 3)
            wanted[0, i] += push
            wanted[0, j] -= push
            wanted[1, i] += turn_i
            wanted[1, j] += turn_j
    for found, exact in zip(forces(state, dt, dt), wanted, strict=True):
        np.testing.assert_allclose(found, exact, rtol=0, atol=1e-14 * np.abs(exact).max())
    np.testing.assert_allclose(state.contact, one.contact, rtol=1e-13, atol=1e-25)


def potential(state):
    return sum(sum(contact_energies(state, k)) for k in range(state.counter[layout.CONTACTS]))


@pytest.mark.parametrize("kind", ["BA", "BAM2"])
@pytest.mark.parametrize("displacement", [1e-4, 3e-2])
def test_forces_are_those_of_the_slow_reference(kind, displacement):
    """Random displacements, below and far beyond the inelastic limits; radii from 10 to 100 nm."""
    grain = grow(kind, 120e-9, MATERIAL, 1)
    state = shaken(grain, 1.0, 1e8)
    rng = np.random.default_rng(5)
    k = state.counter[layout.CONTACTS]
    fields = contact_blocks(state)
    for first in (layout.NIX, layout.NJX):
        lane = int(first) // layout.LANES
        pointer = fields[:, lane : lane + 3, :]
        pointer += displacement * rng.normal(size=pointer.shape)
        pointer /= np.linalg.norm(pointer, axis=1, keepdims=True)
    with_field(state, layout.PHI, displacement * rng.normal(size=layout.LANES))
    dt = state.scalar[layout.DT]
    force, torque, details = naive_engine.all_contacts(state, MATERIAL, dt)
    # the reference finds the contact radius from scratch; let the engine's Newton steps arrive
    for _ in range(10):
        trial = state._replace(contact=state.contact.copy(), force=state.force.copy())
        forces(trial, 0.0, dt)
        with_field(state, layout.S, 1.0)
        lane = int(layout.S) // layout.LANES
        fields[:, lane, :] = trial.contact.reshape(fields.shape)[:, lane, :]
    found_force, found_torque = forces(state, dt, dt)
    np.testing.assert_allclose(found_force, force, atol=1e-12 * np.abs(force).max(), rtol=0)
    np.testing.assert_allclose(found_torque, torque, atol=1e-12 * np.abs(torque).max(), rtol=0)
    np.testing.assert_allclose(contact_field(state, layout.PHI), [d["phi"] for d in details], rtol=1e-12, atol=1e-18)
    for column, field in enumerate((layout.E_SLIDE, layout.E_ROLL, layout.E_TWIST, layout.E_DAMP)):
        lost = np.array([d["lost"][column] for d in details])
        np.testing.assert_allclose(contact_field(state, field), lost, rtol=1e-9)
    assert len(details) == k and (displacement < 1e-3 or min(d["lost"][0] for d in details) > 0.0)


@pytest.mark.parametrize("radii", [(30e-9, 30e-9), (10e-9, 100e-9)])
def test_forces_and_torques_are_derivatives_of_the_potentials(radii):
    """Every coordinate of both monomers: moved and turned a little, the energy changes by -force times move."""
    a_i, a_j = radii
    grain = Grain(np.array([[0.0, 0, 0], [0, 0, a_i + a_j - 1e-11]]), np.array(radii), MATERIAL)

    def at_limit_free_state():
        state = state_of(grain)
        with_field(state, layout.INV_ZETA2, 0.0)
        with_field(state, layout.INV_XI2, 0.0)
        with_field(state, layout.NIX, 2e-3)
        with_field(state, layout.NJY, -3e-3)
        with_field(state, layout.PHI, 5e-3)
        fields = contact_blocks(state)
        for first in (layout.NIX, layout.NJX):
            lane = int(first) // layout.LANES
            fields[0, lane : lane + 3, 0] /= np.linalg.norm(fields[0, lane : lane + 3, 0])
        return state

    state = at_limit_free_state()
    for _ in range(10):
        force, torque = forces(state, 0.0, 0.0)
        state.force[:] = 0.0
    scale_force, scale_torque = np.abs(force).max(), np.abs(torque).max()

    def energy(monomer, axis, move, turn):
        trial = at_limit_free_state()
        rows = monomer_rows(trial)
        rows[monomer, axis] += move
        rows[monomer, int(layout.WX) + axis] = turn  # turned by a unit of time, which the forces do first
        for number in range(10):
            forces(trial, 1.0 if number == 0 else 0.0, 0.0)
        return potential(trial)

    for monomer in range(2):
        for axis in range(3):
            h = 1e-13
            numerical = -(energy(monomer, axis, h, 0.0) - energy(monomer, axis, -h, 0.0)) / (2 * h)
            assert numerical == pytest.approx(force[monomer, axis], abs=2e-6 * scale_force)
            h = 1e-5
            numerical = -(energy(monomer, axis, 0.0, h) - energy(monomer, axis, 0.0, -h)) / (2 * h)
            assert numerical == pytest.approx(torque[monomer, axis], abs=2e-6 * scale_torque)


def test_momenta_are_conserved_with_all_dissipation_at_work():
    """1e5 steps of a free aggregate with damping and all inelastic limits: 1e-10 of either momentum."""
    state = shaken(grow("BAM1", 110e-9, MATERIAL, 2), 0.3, 3e7)
    _, size_p, before, size_l = momenta(state)
    assert np.linalg.norm(before) > 0.01 * size_l
    state, code = _advance(state, AT_REST, np.inf, 100_000, -1, 0.02, True)
    assert code == STEPS_DONE and state.counter[layout.STEPS] == 100_000
    assert state.counter[layout.LARGEST_MONOMERS] == len(state.identity), "the test needs an aggregate that holds"
    linear, _, after, _ = momenta(state)
    lost = dissipated(state)
    assert (lost[:4] > 0.0).all(), "sliding, rolling, twisting and damping must all have dissipated"
    assert np.linalg.norm(linear) < 1e-10 * size_p
    assert np.linalg.norm(after - before) < 1e-10 * np.linalg.norm(before)


def elastic(grain, factor):
    """A gently shaken grain without damping and without limits."""
    state = shaken(grain, 1e-3, 1e5, timestep_factor=factor)
    for field, value in ((layout.DAMPING, 0.0), (layout.INV_ZETA2, 0.0), (layout.INV_XI2, 0.0)):
        with_field(state, field, value)
    return state


def energy_errors(grain, factor, time):
    """Greatest change of the energy over a run, relative to the kinetic energy at the start."""
    state = elastic(grain, factor)
    dt = state.scalar[layout.DT]
    rows = monomer_rows(state)
    before = rows[:, 4:11].copy()
    start = kinetic(rows)
    energies = []
    for step in range(1, round(time / dt) + 1):
        position = potential(state)  # pointers lag behind the positions until the forces are computed
        advance(state, AT_REST, np.inf, step, -1, factor, True)
        rows = monomer_rows(state)
        # velocities half a step before and after the positions for which `potential` will be right
        middle = rows.copy()
        middle[:, 4:11] = 0.5 * (before + rows[:, 4:11])
        before = rows[:, 4:11].copy()
        position = potential(state)
        energies.append(kinetic(middle) + position)
    energies = np.array(energies)
    return np.abs(energies - energies[0]).max() / start


def test_energy_error_falls_as_the_square_of_the_step():
    grain = grow("BAM2", 70e-9, MATERIAL, 4)
    time = 400 * state_of(grain, 0.04).scalar[layout.DT]
    errors = [energy_errors(grain, factor, time) for factor in (0.04, 0.02, 0.01)]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert (orders > 1.7).all() and (orders < 2.3).all(), (errors, orders)


def test_energy_stays_at_the_production_step():
    grain = grow("BAM2", 70e-9, MATERIAL, 4)
    assert energy_errors(grain, 0.05, 4000 * state_of(grain, 0.05).scalar[layout.DT]) < 5e-3


def test_frames_agree():
    """A free, spinning, vibrating aggregate in the inertial frame and in one that turns ever faster."""
    grain = grow("BAM1", 90e-9, MATERIAL, 3)
    start = relax(grain, timestep_factor=0.01)
    acceleration, time = 3e15, 4e-9
    drive = make_drive("prescribed", omega_1=1.0, angular_acceleration=acceleration)._replace(torque=False)
    t_0 = 2e7 / acceleration  # when the frame turns with about 2e7 rad/s
    omega_0, _ = angular_velocity(drive, t_0)

    def angle(t):
        """Integral of Eq. 24."""
        tau = OMEGA_RAT / acceleration
        return OMEGA_RAT * (t + tau * np.expm1(-t / tau))

    def copy():
        return start._replace(**{name: array.copy() for name, array in start._asdict().items()})

    rng = np.random.default_rng(1)
    noise = rng.normal(size=(len(monomer_rows(start)), 6))

    def initial(state, spinning):
        rows = monomer_rows(state)
        rows[:, VELOCITY] = 0.05 * noise[:, :3]
        rows[:, SPIN] = 1e6 * noise[:, 3:]
        if spinning:
            rows[:, 4] -= omega_0 * rows[:, 1]
            rows[:, 5] += omega_0 * rows[:, 0]
            rows[:, 10] += omega_0
        return state

    results = []
    for factor in (0.01, 0.005):
        fixed = initial(copy(), True)
        turning = initial(copy(), False)
        for state in (fixed, turning):
            update_contact_rates(state, factor, True)
        # the frame starts at omega_0 and gains speed; the aggregate is free
        turning.scalar[layout.TIME] = t_0
        n = round(time / fixed.scalar[layout.DT])
        advance(fixed, AT_REST, np.inf, n, -1, factor, True)
        advance(turning, drive, np.inf, n, -1, factor, True)
        elapsed = n * fixed.scalar[layout.DT]
        assert turning.scalar[layout.TIME] - t_0 == pytest.approx(elapsed)
        turn = angle(t_0 + elapsed) - angle(t_0)
        c, s = np.cos(turn), np.sin(turn)
        back = monomer_rows(turning)[:, :3] @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
        moved = np.abs(monomer_rows(fixed)[:, :3] - monomer_rows(start)[:, :3]).max()
        results.append(np.abs(back - monomer_rows(fixed)[:, :3]).max() / moved)
    # first order in the step at the start, where the velocities of both runs are taken half a step apart
    assert results[0] < 1e-3 and results[1] < 0.7 * results[0], results


def test_two_monomers_that_meet_stick_and_lose_energy():
    a = 20e-9
    gap = 1e-9
    touching = Grain(np.array([[0.0, 0, 0], [2 * a, 0, 0]]), np.array([a, a]), MATERIAL)
    state = state_of(touching)
    from ratd.engine.contacts import remove_contact

    remove_contact(state, 0)
    rows = monomer_rows(state)
    rows[0, 0] -= gap
    rows[:, 4] = [0.05, -0.05]
    total = kinetic(rows)
    state.scalar[:] = 0.0
    state.scalar[layout.DT] = 1e-13
    _, code = _advance(state, AT_REST, np.inf, 300_000, -1, 0.02, True)
    assert code == STEPS_DONE
    assert state.counter[layout.CONTACTS] == 1 and state.counter[layout.LARGEST_MONOMERS] == 2
    assert contact_field(state, layout.COMPRESSION)[0] == pytest.approx(1.0, abs=1e-3)
    lost = dissipated(state)
    assert lost[3] > 0.0 and lost[4] > 0.0
    assert kinetic(monomer_rows(state)) + potential(state) + lost.sum() == pytest.approx(total, abs=0.02 * lost.sum())


def test_fragment_that_leaves_is_dropped_and_noted():
    grain = grow("BA", 100e-9, MATERIAL, 5)
    state = state_of(grain)
    from ratd.engine.contacts import remove_contact

    mass = monomer_rows(state)[:, 12].copy()
    n = len(mass)
    # cut off an end monomer and give it a push outwards
    ends = np.bincount(np.concatenate([state.pair_i[: n - 1], state.pair_j[: n - 1]]).astype(int), minlength=n)
    rows = monomer_rows(state)
    end = int(np.argmax(np.where(ends[:n] == 1, np.linalg.norm(rows[:, :3], axis=1), 0.0)))
    k = next(q for q in range(n - 1) if end in (int(state.pair_i[q]), int(state.pair_j[q])))
    remove_contact(state, k)
    rows[end, VELOCITY] = 50.0 * rows[end, :3] / np.linalg.norm(rows[end, :3])
    before = state.counter[layout.CONTACTS]
    _, code = _advance(state, AT_REST, np.inf, 100_000, -1, 0.02, True)
    assert state.counter[layout.FRAGMENTS_LOST] == 1
    assert state.lost[0, 0] == pytest.approx(mass[end]) and state.lost[0, 1] == 1
    assert end not in state.identity[: state.counter[layout.MONOMERS]]
    assert state.counter[layout.MONOMERS] == n - 1 and state.counter[layout.CONTACTS] == before
    left = np.delete(mass, end)
    np.testing.assert_array_equal(monomer_rows(state)[:, 12], left)
    np.testing.assert_allclose(left @ monomer_rows(state)[:, :3] / left.sum(), 0.0, atol=1e-12)


def test_outer_torque_keeps_the_fragment_at_rest_in_the_frame():
    grain = grow("BAM2", 100e-9, MATERIAL, 6)
    state = relax(grain)
    state.scalar[layout.DT_DRIFT] = state.scalar[layout.DT]
    drive = make_drive("prescribed", omega_1=1e8, epsilon=0.05)
    assert _advance(state, drive, 3e7, 10**9, 0, 0.05, True)[1] == REACHED
    rows = monomer_rows(state)
    momentum = rows[:, 12] @ (rows[:, 0] * rows[:, 5] - rows[:, 1] * rows[:, 4]) + rows[:, 13] @ rows[:, 10]
    inertia = rows[:, 12] @ (rows[:, 0] ** 2 + rows[:, 1] ** 2) + rows[:, 13].sum()
    assert abs(momentum / inertia) < 1e-7 * state.scalar[layout.OMEGA]
    # and the work of the torque is the energy of the rotation, up to the small strain
    assert state.scalar[layout.TORQUE_WORK] == pytest.approx(0.5 * inertia * state.scalar[layout.OMEGA] ** 2, rel=1e-2)


def test_a_long_stretch_without_a_record_stays_centred():
    """Unequal monomers, slowly: an offset of the centre of mass would grow from rounding to tear them apart early."""
    a_i, a_j = 12e-9, 60e-9
    grain = Grain(np.array([[0.0, 0, 0], [a_i + a_j - 1e-10, 0, 0]]), np.array([a_i, a_j]), MATERIAL)
    state = relax(grain)
    state.scalar[layout.DT_DRIFT] = state.scalar[layout.DT]
    omega_1 = cut_bound(grain)
    drive = make_drive("prescribed", omega_1=omega_1, epsilon=0.0005)
    _advance(state, drive, 0.97 * omega_1, 10**9, 0, 0.05, True)
    assert state.counter[layout.CONTACTS] == 1
    rows = monomer_rows(state)
    assert np.abs(rows[:, 12] @ rows[:, :3]).max() / rows[:, 12].sum() < 1e-6 * a_i


def test_stress_is_the_sum_of_eq_32():
    state = shaken(grow("BAM1", 100e-9, MATERIAL, 7), 0.05, 1e6)
    _advance(state, AT_REST, np.inf, 500, -1, 0.02, True)
    r = np.sqrt(1.0 / (np.pi * contact_field(state, layout.INV_AREA))) * contact_field(state, layout.S) ** 2
    expected = (np.abs(contact_field(state, layout.NORMAL)) / (np.pi * r**2)).sum()
    assert total_stress(state) == pytest.approx(expected, rel=1e-12)


def test_idle_contacts_do_nothing():
    state = state_of(grow("BA", 60e-9, MATERIAL, 8))
    n = state.counter[layout.MONOMERS]
    for _ in range(3):
        forces(state, 1e-12, 1e-12)
    assert (state.force.reshape(-1, layout.FORCE_ROW)[n:] == 0.0).all()
