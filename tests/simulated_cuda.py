"""The kernels of the engine on CUDA in numba's simulation, against the engine on the processor. Run by test_cuda.py in
a process of its own, because the simulation has to be asked for before numba is imported:

NUMBA_ENABLE_CUDASIM=1 python -m pytest tests/simulated_cuda.py
NUMBA_ENABLE_CUDASIM=1 PYTHONPATH=tests python -m pytest -p watched_cuda tests/simulated_cuda.py

The second line watches all accesses to memory for races (see watched_cuda.py).
"""

import time

import numpy as np
import pytest

from ratd.cuda import advance, arena, block, body
from ratd.cuda import spin_up as cuda_spin_up
from ratd.cuda.advance import PAUSED, advance_grains
from ratd.cuda.arena import CODE, FEWEST, GOALS, ROWS, SEGMENT_END, STEPS_GOAL, Batch, write_drive
from ratd.cuda.block import block_max, block_sum, prefix_sum
from ratd.cuda.body import body_of
from ratd.cuda.device import SIMULATED, cuda, kernel
from ratd.cuda.forces import contact_pass, residual_force, sum_forces
from ratd.cuda.fragments import drop_departed, find_fragments, label_pieces
from ratd.cuda.lists import find_far, find_near, link_contacts, update_rates
from ratd.cuda.measure import write_record
from ratd.cuda.spin_up import record_of, spin_up_many
from ratd.drives import make_drive
from ratd.engine import advance as cpu_advance
from ratd.engine import fragments as cpu_fragments
from ratd.engine import layout
from ratd.engine.contacts import remove_contact, update_contact_rates
from ratd.engine.forces import SCRATCH_SIZE, contact_forces
from ratd.engine.state import contact_blocks, monomer_rows, new_state, with_room
from ratd.grain import connected_components
from ratd.growth import grow
from ratd.materials import MATERIALS
from ratd.neighbours import close_pairs
from ratd.spinup import _record, spin_up
from runs_cuda import FAST, assert_close, assert_same_run, copy, pressed_pair

MATERIAL = MATERIALS["q-S"]
THREADS = 3
if not SIMULATED:
    pytest.skip("the simulation has to be asked for by NUMBA_ENABLE_CUDASIM=1", allow_module_level=True)


def shaken(kind, size, seed, displacement=0.0):
    """State of a grain whose monomers have random velocities and spins, and whose contacts are displaced."""
    grain = grow(kind, size, MATERIAL, seed)
    state = new_state(grain.position, grain.radius, MATERIAL, grain.contacts, timestep_factor=0.02)
    cpu_fragments.find_fragments(state)
    rng = np.random.default_rng(seed)
    rows = monomer_rows(state)
    rows[:, :3] += 3e-12 * rng.normal(size=(len(rows), 3))
    rows[:, 4:7] = rng.normal(size=(len(rows), 3))
    rows[:, 8:11] = 1e8 * rng.normal(size=(len(rows), 3))
    fields = contact_blocks(state)
    for first in (layout.NIX, layout.NJX):
        lane = int(first) // layout.LANES
        pointer = fields[:, lane : lane + 3, :]
        pointer += displacement * rng.normal(size=pointer.shape)
        pointer /= np.linalg.norm(pointer, axis=1, keepdims=True)
    return state


@kernel
def block_kernel(values, sums, whole, totals):
    buffer = cuda.shared.array(32, np.float64)
    counts = cuda.shared.array(32, np.int64)
    thread = cuda.threadIdx.x
    total = block_sum(values[thread], buffer)
    greatest = block_max(values[thread], buffer)
    last = prefix_sum(whole, whole.shape[0], counts)
    sums[thread, 0] = total
    sums[thread, 1] = greatest
    totals[thread] = last


@pytest.mark.parametrize(("threads", "warp"), [(1, 2), (4, 2), (7, 2), (7, 4)])
def test_sums_over_a_block(threads, warp, monkeypatch):
    monkeypatch.setattr(block, "WARP", warp)
    rng = np.random.default_rng(threads)
    values = rng.normal(size=threads)
    whole = rng.integers(0, 9, size=17)
    sums, totals, prefix = np.zeros((threads, 2)), np.zeros(threads, dtype=np.int64), whole.copy()
    block_kernel[1, threads](values, sums, prefix, totals)
    np.testing.assert_allclose(sums[:, 0], values.sum(), rtol=1e-13)
    assert (sums[:, 0] == sums[0, 0]).all() and (sums[:, 1] == values.max()).all()
    assert (totals == whole.sum()).all()
    np.testing.assert_array_equal(prefix, np.cumsum(whole) - whole)
    values[threads // 2] = np.nan
    block_kernel[1, threads](values, sums, prefix, totals)
    assert np.isnan(sums[:, 1]).all()


@kernel
def sharing_kernel(found):
    shared = cuda.shared.array(1, np.int64)
    if cuda.threadIdx.x == 0:
        shared[0] = 7
    cuda.syncthreads()
    found[cuda.threadIdx.x] = shared[0]


def test_threads_that_ask_for_shared_memory_at_once_get_the_same(monkeypatch):
    """The simulation of numba by itself gives each its own."""
    empty, found = np.empty, np.zeros(THREADS)

    def slow(*arguments):
        time.sleep(0.05)
        return empty(*arguments)

    monkeypatch.setattr(np, "empty", slow)
    sharing_kernel[1, THREADS](found)
    assert (found == 7).all()


@kernel
def force_kernel(arena, dt_drift, dt, forces, ended):
    counts = cuda.shared.array(8, np.int64)
    body = body_of(arena, cuda.blockIdx.x)
    link_contacts(body, counts)
    ended[cuda.threadIdx.x] = contact_pass(body, dt_drift, dt)
    cuda.syncthreads()
    for k in range(cuda.threadIdx.x, forces.shape[0], cuda.blockDim.x):
        sum_forces(body, np.uint64(k), forces[k])


@pytest.mark.parametrize(("kind", "size", "displacement"), [("BA", 90e-9, 1e-4), ("BAM2", 150e-9, 3e-2)])
def test_forces_and_torques_of_one_step_are_those_of_the_processor(kind, size, displacement):
    """To 1e-12, below and far beyond the inelastic limits, and with them all fields of the contacts."""
    state = shaken(kind, size, 1, displacement)
    dt = state.scalar[layout.DT]
    batch = Batch([state], 1)
    n = state.counter[layout.MONOMERS]
    forces, ended = np.zeros((n, layout.FORCE_ROW)), np.zeros(THREADS, dtype=np.int64)
    force_kernel[1, THREADS](batch.device, dt, dt, forces, ended)
    expected = contact_forces(
        state.monomer, state.force, state.contact, state.pair_i, state.pair_j, np.zeros(SCRATCH_SIZE),
        state.counter[layout.CONTACTS], dt, dt,
    )  # fmt: skip
    rows = state.force.reshape(-1, layout.FORCE_ROW)[:n]
    assert ended.sum() == expected
    for columns in (slice(0, 3), slice(4, 7)):
        scale = np.abs(rows[:, columns]).max()
        np.testing.assert_allclose(forces[:, columns], rows[:, columns], rtol=0, atol=1e-12 * scale)
    assert_close(batch.state(0), state)


@pytest.mark.parametrize(
    "drive",
    [make_drive("prescribed", omega_1=1e8, epsilon=0.1), make_drive("literal", omega_1=1e8, angular_acceleration=1e16)],
)
def test_steps_are_those_of_the_processor(drive):
    """Twenty steps from omega = 1e8 rad/s, in two segments."""
    state = shaken("BAM1", 90e-9, 2)
    state.scalar[layout.DT_DRIFT] = state.scalar[layout.DT]
    state.scalar[layout.TIME] = 1e8 / (drive.acceleration or drive.epsilon * drive.omega_1**2)
    batch = Batch([state], 2)
    run(batch, drive, 10)
    run(batch, drive, 20)
    for steps in (10, 20):
        cpu_advance.advance(state, drive, np.inf, steps, -1, 0.02, True)
    found = batch.state(0)
    assert state.scalar[layout.TORQUE_WORK] != 0.0 or not drive.torque
    assert_close(found, state, 1e-10)


def test_a_grain_that_turns_as_a_whole_needs_no_new_search():
    """In a few steps it turns by more than the reach of the far list, too fast to hold for long."""
    omega = 1e10
    state = shaken("BAM1", 90e-9, 2)
    rows = monomer_rows(state)
    rows[:, 4:11] = 0.0
    rows[:, 4], rows[:, 5], rows[:, 10] = -omega * rows[:, 1], omega * rows[:, 0], omega
    before = rows[:, :3].copy()
    batch = Batch([state], 2)
    run(batch, make_drive("literal", omega_1=1e8, angular_acceleration=1.0), 16)
    found = batch.state(0)
    moved = np.linalg.norm(monomer_rows(found)[:, :3] - before, axis=1)
    assert moved.max() > 0.6 * cpu_advance.FAR * rows[:, 3].mean() and found.counter[layout.SEARCHES] == 1


def run(batch, drive, segment_end, expected=PAUSED):
    """Run the first grain of a batch with a drive up to a number of steps."""
    task = batch.host.task[0]
    write_drive(batch.host.drive[0], drive)
    task[[STEPS_GOAL, SEGMENT_END, FEWEST, GOALS]] = 10**9, segment_end, -1, 1
    batch.host.goal[0, 0] = np.inf
    batch.send_tasks()
    advance_grains[1, THREADS](batch.device, np.array([0]), 0.02, True)
    batch.fetch_tasks()
    assert batch.host.task[0, CODE] == expected and batch.host.task[0, ROWS] == 0


def test_too_little_room_is_told_before_anything_moves():
    state = shaken("BAM2", 150e-9, 3)
    contacts = state.counter[layout.CONTACTS]
    slots = -(-contacts // layout.LANES) * layout.LANES
    tight = state._replace(
        contact=state.contact[: slots * layout.N_FIELDS].copy(),
        pair_i=state.pair_i[:slots].copy(),
        pair_j=state.pair_j[:slots].copy(),
    )
    drive = make_drive("prescribed", omega_1=1e8, epsilon=0.1)
    # monomers that almost touch fill the room that is left
    near = cpu_advance._near_pairs(state, all_pairs(state, 1.0), 1.0)
    assert len(near) > slots - contacts
    batch = Batch([tight], 2)
    keep = advance.NEAR, advance.FAR
    try:
        advance.NEAR, advance.FAR = 50.0, 60.0
        run(batch, drive, 5, cpu_advance.FULL)
    finally:
        advance.NEAR, advance.FAR = keep
    found = batch.state(0)
    assert found.counter[layout.STEPS] == 0
    batch = Batch([with_room(found, 2 * slots)], 2)
    run(batch, drive, 5)
    cpu_advance.advance(state, drive, np.inf, 5, -1, 0.02, True)
    assert_close(batch.state(0)._replace(pair_i=state.pair_i, pair_j=state.pair_j), state, 1e-10)


def all_pairs(state, reach):
    position, radius = cpu_advance._positions(state)
    return close_pairs(position, radius, reach)


@kernel
def list_kernel(arena, far_reach, near_reach, numbers):
    buffer = cuda.shared.array(32, np.float64)
    counts = cuda.shared.array(32, np.int64)
    body = body_of(arena, cuda.blockIdx.x)
    link_contacts(body, counts)
    update_rates(body, 0.03, True, buffer)
    far = find_far(body, far_reach, counts)
    near = find_near(body, far, near_reach, counts)
    if cuda.threadIdx.x == 0:
        numbers[0] = far
        numbers[1] = near


def test_lists_and_rates_are_those_of_the_processor():
    state = shaken("BAM1", 120e-9, 4)
    batch, numbers = Batch([state], 1), np.zeros(2, dtype=np.int64)
    list_kernel[1, THREADS](batch.device, 30e-9, 10e-9, numbers)
    far = all_pairs(state, 30e-9)
    near = cpu_advance._near_pairs(state, far, 10e-9)
    assert len(far) > len(near) > 1
    np.testing.assert_array_equal(batch.device.far[: numbers[0]], far)
    np.testing.assert_array_equal(batch.device.near[: numbers[1]], near)
    update_contact_rates(state, 0.03, True)
    assert_close(batch.state(0), state)


@kernel
def label_kernel(arena):
    label_pieces(body_of(arena, cuda.blockIdx.x))


@pytest.mark.parametrize("contacts", [5, 15, 40])
def test_pieces_of_any_graph_are_labelled_by_their_first_monomer(contacts):
    """Contacts in no order, which takes more than one round of joining labels."""
    state = shaken("BA", 110e-9, 7)
    n = state.counter[layout.MONOMERS]
    pairs = np.random.default_rng(contacts).integers(n, size=(contacts, 2))
    state.pair_i[:contacts], state.pair_j[:contacts] = pairs.T
    state.counter[layout.CONTACTS] = contacts
    batch = Batch([state], 1)
    label_kernel[1, THREADS](batch.device)
    piece = connected_components(n, pairs)
    expected = [np.flatnonzero(piece == of)[0] for of in piece]
    np.testing.assert_array_equal(batch.device.label[:n], expected)


@kernel
def fragment_kernel(arena, drop, numbers):
    buffer = cuda.shared.array(32, np.float64)
    counts = cuda.shared.array(32, np.int64)
    body = body_of(arena, cuda.blockIdx.x)
    fragments = find_fragments(body, buffer, counts)
    dropped = False
    if drop:
        dropped = drop_departed(body, fragments, buffer)
    if cuda.threadIdx.x == 0:
        numbers[0] = fragments
        numbers[1] = dropped


@pytest.mark.parametrize("seed", range(4))
def test_fragments_are_found_and_dropped_as_on_the_processor(seed):
    """A chain-like grain without some of its contacts, as it stands and with its pieces far apart."""
    state = shaken("BA", 110e-9, seed)
    rng = np.random.default_rng(seed)
    for _ in range(1 + 3 * seed):
        remove_contact(state, int(rng.integers(state.counter[layout.CONTACTS])))
    for drop in (False, True):
        batch, numbers = Batch([state], 1), np.zeros(2, dtype=np.int64)
        fragment_kernel[1, THREADS](batch.device, drop, numbers)
        fragments = cpu_fragments.find_fragments(state)
        assert numbers[0] == fragments == 2 + 3 * seed
        if drop:
            dropped = cpu_fragments.drop_departed(state, fragments)
            assert dropped > 0 and numbers[1] == 1
            assert state.counter[layout.FRAGMENTS_LOST] == dropped
        assert_close(batch.state(0), state)
        rows = monomer_rows(state)
        for fragment in range(1, fragments):
            inside = state.fragment[: len(rows)] == fragment
            away = rng.normal(size=3)
            rows[inside, :3] += 3e-6 * away
            rows[inside, 4:7] = 10.0 * away


@kernel
def record_kernel(arena):
    buffer = cuda.shared.array(32, np.float64)
    write_record(body_of(arena, cuda.blockIdx.x), arena.row[cuda.blockIdx.x, 0], buffer)


def test_record_is_that_of_the_processor():
    state = shaken("BA", 110e-9, 5, 1e-3)
    cpu_advance.advance(state, make_drive("prescribed", omega_1=1e8, epsilon=0.1), np.inf, 30, -1, 0.02, True)
    remove_contact(state, 3)
    cpu_fragments.find_fragments(state)
    for samples in (1.0, 0.0):
        state.scalar[layout.STRESS_SAMPLES] = samples
        batch = Batch([state], 1)
        record_kernel[1, THREADS](batch.device)
        batch.fetch_tasks()
        expected = _record(state, MATERIAL.density)
        np.testing.assert_allclose(record_of(batch.host.row[0, 0], MATERIAL.density), expected, rtol=1e-11)
        assert expected[3] < len(state.identity)  # not the whole grain


@kernel
def residual_kernel(arena, found):
    buffer = cuda.shared.array(32, np.float64)
    counts = cuda.shared.array(32, np.int64)
    body = body_of(arena, cuda.blockIdx.x)
    link_contacts(body, counts)
    found[cuda.threadIdx.x] = residual_force(body, buffer)


def test_residual_force_is_that_of_the_processor():
    state = shaken("BAM1", 90e-9, 6, 1e-4)
    batch, found = Batch([copy(state)], 1), np.zeros(THREADS)
    residual_kernel[1, THREADS](batch.device, found)
    np.testing.assert_allclose(found, cpu_advance.residual_force(state), rtol=1e-12)


@pytest.mark.parametrize("per_slot", [1, 4])
def test_a_grain_that_needs_more_room_gets_it(monkeypatch, per_slot):
    """All pairs of monomers count as near: at first there is no room for their list, or for contacts of all of them."""
    grains = [pressed_pair(20e-9), grow("BAM1", 50e-9, "q-S", 0)]
    n = grains[1].n_monomers
    assert layout.LANES < n * (n - 1) // 2 < 2 * layout.LANES
    monkeypatch.setattr(advance, "NEAR", 50.0)
    monkeypatch.setattr(advance, "FAR", 60.0)
    for module in (arena, body):
        monkeypatch.setattr(module, "FAR_PER_SLOT", per_slot)
    slots = []
    with_room = cuda_spin_up.with_room
    monkeypatch.setattr(cuda_spin_up, "with_room", lambda state, room: slots.append(room) or with_room(state, room))
    found = spin_up_many(grains, max_steps=20, **FAST)
    assert slots and set(slots) == {2 * layout.LANES}
    for run, grain in zip(found, grains, strict=True):
        assert_same_run(run, spin_up(grain, max_steps=20, **FAST), 1e-8)
