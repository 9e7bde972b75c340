"""The engine: against the slow reference, conservation laws, order of the scheme, contacts, fragments."""

import numpy as np
import pytest

import naive_engine
from ratd.aggregates.grain import Grain
from ratd.aggregates.growth import grow
from ratd.base.materials import MATERIALS
from ratd.drives.rotating import AT_REST, make_drive
from ratd.engine import layout
from ratd.engine.advance import REACHED, STEPS_DONE
from ratd.engine.contacts import contact_energies
from ratd.engine.forces import SCRATCH_SIZE, contact_forces, forces_between
from ratd.engine.measure import dissipated, total_stress
from ratd.engine.state import contact_blocks, contact_field, monomer_rows
from ratd.experiments.spin_up.cut_bound import cut_bound
from ratd.experiments.spin_up.run import _advance, relax
from ratd.validation.free_grain import VELOCITY, kinetic_energy, shaken, state_of, with_field

MATERIAL = MATERIALS["q-S"]


def forces(state, dt_drift, dt):
    contact_forces(
        state.monomer, state.force, state.contact, state.pair_i, state.pair_j, np.zeros(SCRATCH_SIZE),
        state.counter[layout.CONTACTS], dt_drift, dt,
    )  # fmt: skip
    rows = state.force.reshape(-1, layout.FORCE_ROW)[: state.counter[layout.MONOMERS]]
    return rows[:, :3].copy(), rows[:, 4:7].copy()


def potential(state):
    return sum(sum(contact_energies(state, k)) for k in range(state.counter[layout.CONTACTS]))


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
    total = kinetic_energy(rows)
    state.scalar[:] = 0.0
    state.scalar[layout.DT] = 1e-13
    _, code = _advance(state, AT_REST, np.inf, 300_000, -1, 0.02, True)
    assert code == STEPS_DONE
    assert state.counter[layout.CONTACTS] == 1 and state.counter[layout.LARGEST_MONOMERS] == 2
    assert contact_field(state, layout.COMPRESSION)[0] == pytest.approx(1.0, abs=1e-3)
    lost = dissipated(state)
    assert lost[3] > 0.0 and lost[4] > 0.0
    assert kinetic_energy(monomer_rows(state)) + potential(state) + lost.sum() == pytest.approx(
        total, abs=0.02 * lost.sum()
    )


def turned(state, omega, monomers=slice(None)):
    """The state, with these monomers turning as a whole about z."""
    rows = monomer_rows(state)[monomers]
    rows[:, 4], rows[:, 5] = -omega * rows[:, 1], omega * rows[:, 0]
    rows[:, 10] = omega
    return state


def test_a_grain_that_turns_as_a_whole_needs_no_new_lists():
    omega = 2e7
    state = relax(grow("BAM2", 100e-9, MATERIAL, 6))
    state.scalar[layout.DT_DRIFT] = state.scalar[layout.DT]
    before = monomer_rows(turned(state, omega))[:, :3].copy()
    steps = int(2.0 / omega / state.scalar[layout.DT])  # two radians
    state, code = _advance(state, AT_REST, np.inf, steps, -1, 0.125, True)
    assert code == STEPS_DONE and state.counter[layout.SEARCHES] == 0
    x, y = monomer_rows(state)[:, :2].T
    angle = np.arctan2(before[:, 0] * y - before[:, 1] * x, before[:, 0] * x + before[:, 1] * y)
    assert np.median(angle) == pytest.approx(2.0, abs=0.1)


def test_a_turning_grain_misses_no_contact():
    """A monomer that meets the middle of a chain of three whose ends have moved by several reaches of the lists."""
    a, omega = 20e-9, 5e7
    chain = Grain(np.array([[0.0, 0, 0], [-2 * a, 0, 0], [2 * a, 0, 0], [0, 2 * a, 0]]), np.full(4, a), MATERIAL)
    state = state_of(chain)
    from ratd.engine.contacts import remove_contact

    apart = next(k for k in range(3) if 3 in (int(state.pair_i[k]), int(state.pair_j[k])))
    remove_contact(state, apart)
    rows = monomer_rows(turned(state, omega, slice(3)))
    rows[3, 1] += 30e-9
    rows[3, 5] = -10.0
    state, _ = _advance(state, AT_REST, np.inf, int(3.5e-9 / state.scalar[layout.DT]), -1, 0.125, True)
    pairs = [{int(state.pair_i[k]), int(state.pair_j[k])} for k in range(state.counter[layout.CONTACTS])]
    assert len(pairs) == 3 and {0, 3} in pairs


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
