"""The time loop of a grain, run by one thread block: see `ratd.engine.advance`, whose order of things it keeps."""

import math

import numpy as np

from ratd.cuda.arena import (
    ACCELERATION, CODE, EPSILON, EXPLICIT_CORIOLIS, FEWEST, GOALS, KINETIC, LAW, OMEGA_1, RELAXING, RESIDUAL, ROWS,
    SEGMENT_END, SPIN_TERMS, STEPS_GOAL, TORQUE,
)  # fmt: skip
from ratd.cuda.block import block_max, block_sum
from ratd.cuda.body import body_of
from ratd.cuda.device import MAX_THREADS, cuda, device_function, kernel
from ratd.cuda.forces import contact_pass, monomer_pass, residual_force
from ratd.cuda.fragments import drop_departed, find_fragments
from ratd.cuda.lists import (
    FAR_REFERENCE,
    NEAR_REFERENCE,
    farthest_move,
    find_far,
    find_near,
    link_contacts,
    update_rates,
)
from ratd.cuda.measure import stored_kinetic_energy, total_stress, write_record
from ratd.drives import Drive, angular_velocity, turn_to_take_out, turning_step
from ratd.engine.advance import (
    CENTRE_EVERY,
    FAR,
    FEW_CONTACTS,
    FULL,
    NEAR,
    NOT_FINITE,
    REACHED,
    STEPS_DONE,
    STRESS_EVERY,
    gap,
)
from ratd.engine.contacts import append_contact, contact_start, remove_contact
from ratd.engine.layout import (
    COMPRESSION, CONTACTS, DT, DT_DRIFT, EXCESS, LARGEST_CONTACTS, MONOMERS, OMEGA, RADIUS, ROW, SEARCHES, STEPS,
    STRESS_SAMPLES, STRESS_SUM, TIME, TORQUE_WORK, UNWIND, VX, WX,
)  # fmt: skip
from ratd.laws.jkr import COMPRESSION_END
from ratd.spinup import round_of

RESTED, PAUSED = 5, 6
"""Further reasons why a grain stopped, next to those of `ratd.engine.advance`: relaxed; end of its segment."""

_ROW = np.uint64(ROW)
_BUFFER = 3 * MAX_THREADS


@device_function
def drive_of(row):
    """`Drive` from its row of numbers."""
    return Drive(
        np.int64(row[LAW]), row[EPSILON], row[OMEGA_1], row[ACCELERATION],
        row[TORQUE] > 0.0, row[EXPLICIT_CORIOLIS] > 0.0, row[SPIN_TERMS] > 0.0,
    )  # fmt: skip


@device_function
def radii(body, buffer):
    """Smallest and mean radius [m] of the monomers that are left."""
    state = body.state
    n = state.counter[MONOMERS]
    smallest = np.inf
    total = 0.0
    for k in range(cuda.threadIdx.x, n, cuda.blockDim.x):
        a = state.monomer[np.uint64(k) * _ROW + RADIUS]
        smallest = min(smallest, a)
        total += a
    return -block_max(-smallest, buffer), block_sum(total, buffer) / n


@device_function
def come_to_rest(body):
    """Set all velocities and spins to zero."""
    monomer = body.state.monomer
    for k in range(cuda.threadIdx.x, body.state.counter[MONOMERS], cuda.blockDim.x):
        r = np.uint64(k) * _ROW
        for axis in range(3):
            offset = np.uint64(axis)
            monomer[r + VX + offset] = 0.0
            monomer[r + WX + offset] = 0.0
    cuda.syncthreads()


@device_function
def is_relaxed(body, drive, buffer):
    """A round of the relaxation (`ratd.spinup.relax`) is over: whether it was the last.

    Velocities are set to zero when the kinetic energy has fallen since the last round.
    """
    state = body.state
    if state.counter[STEPS] > 0:
        kinetic = stored_kinetic_energy(body, buffer)
        fell = kinetic <= drive[KINETIC]
        cuda.syncthreads()
        if fell:
            come_to_rest(body)
            kinetic = 0.0
        if cuda.threadIdx.x == 0:
            drive[KINETIC] = kinetic
    return residual_force(body, buffer) <= drive[RESIDUAL]


@device_function
def break_and_make(body, pairs, ended, dt):
    """Remove the contacts that have ended and add those that were made, in the order of the CPU; one thread's work."""
    state = body.state
    if ended:
        for c in range(state.counter[CONTACTS] - 1, -1, -1):
            if state.contact[contact_start(c) + COMPRESSION] < COMPRESSION_END:
                remove_contact(state, c)
    for p in range(pairs):
        if gap(state, body.near[p, 0], body.near[p, 1]) <= 0.0:
            append_contact(state, body.near[p, 0], body.near[p, 1], dt, False)


@kernel
def advance_grains(arena, active, timestep_factor, implicit_damping):
    """Run some grains, one a block, until the host is needed or the segment of each is over.

    Parameters
    ----------
    arena : Arena
    active : (blocks,) int64 array
        Number of the grain of each block.
    timestep_factor : float
        f of dt = f min(t_dis, t_vel).
    implicit_damping : bool
    """
    buffer = cuda.shared.array(_BUFFER, np.float64)
    counts = cuda.shared.array(MAX_THREADS, np.int64)
    grain = active[cuda.blockIdx.x]
    thread = cuda.threadIdx.x
    body = body_of(arena, grain)
    state = body.state
    scalar = state.scalar
    counter = state.counter
    task = arena.task[grain]
    goals = arena.goal[grain]
    law = drive_of(arena.drive[grain])
    relaxing = task[RELAXING] > 0
    turning = not law.torque  # the grain stays behind the frame

    smallest, mean = radii(body, buffer)
    far_reach = FAR * mean
    near_reach = NEAR * mean
    pairs = 0  # of the near list
    far_pairs = -1  # of the far list; -1: there is none that is good
    fragments = 1
    travel = 0.0
    made = 0  # records
    # What is to be done at the top of the loop: everything at first; after contacts were made or broken, or monomers
    # dropped; the near list only. Each function is called in one place, because the compiler copies it to each.
    renew = True
    changed = False
    stale = False
    centred = -1  # step at which the origin was last put to the centre of mass
    code = PAUSED

    steps = counter[STEPS]
    time = scalar[TIME]
    dt = scalar[DT]
    dt_drift = scalar[DT_DRIFT]
    unwind = scalar[UNWIND]
    excess = scalar[EXCESS]
    work = scalar[TORQUE_WORK]
    stress_sum = scalar[STRESS_SUM]
    stress_samples = scalar[STRESS_SAMPLES]
    omega, domega = angular_velocity(law, time)
    while True:
        round_over = relaxing and round_of(steps)[1] == 0
        if renew or changed:
            link_contacts(body, counts)
        if changed:
            # They were those of the old fragment.
            unwind = 0.0
            excess = math.nan
            update_rates(body, timestep_factor, implicit_damping, buffer)
            dt = scalar[DT]
        if renew or changed or ((round_over or steps % CENTRE_EVERY == 0) and steps != centred):
            fragments = find_fragments(body, buffer, counts)
            centred = steps
        if renew or changed or stale:
            if far_pairs < 0 or farthest_move(body, FAR_REFERENCE, turning, buffer) > 0.5 * (far_reach - near_reach):
                far_pairs = find_far(body, far_reach, counts)
                if thread == 0:
                    counter[SEARCHES] += 1
                if far_pairs > body.far.shape[0]:
                    code = FULL
                    break
            pairs = find_near(body, far_pairs, near_reach, counts)
            travel = 0.0
        renew = False
        changed = False
        stale = False
        if counter[LARGEST_CONTACTS] <= task[FEWEST]:
            code = FEW_CONTACTS
            break
        if not relaxing and omega >= goals[made]:
            # The last of the goals is the host's: it wants to see the state there.
            if made + 1 == task[GOALS]:
                code = REACHED
                break
            if thread == 0:
                scalar[TIME] = time
                scalar[OMEGA] = omega
                scalar[DT] = dt
                scalar[TORQUE_WORK] = work
                scalar[STRESS_SUM] = stress_sum
                scalar[STRESS_SAMPLES] = stress_samples
            cuda.syncthreads()
            write_record(body, arena.row[grain, made], buffer)
            stress_sum = 0.0
            stress_samples = 0.0
            made += 1
            # Everything from anew, of what is left, as on the processor: when a fragment is seen to have left depends
            # on when the list of near pairs was made.
            renew = True
            far_pairs = -1
            smallest, mean = radii(body, buffer)
            far_reach = FAR * mean
            near_reach = NEAR * mean
            continue
        if steps >= task[STEPS_GOAL]:
            code = STEPS_DONE
            break
        if steps >= task[SEGMENT_END]:
            break
        if counter[CONTACTS] + pairs > state.pair_i.shape[0]:
            code = FULL
            break
        if round_over:
            if thread == 0:
                counter[STEPS] = steps
                scalar[OMEGA] = omega
            cuda.syncthreads()
            if is_relaxed(body, arena.drive[grain], buffer):
                code = RESTED
                break

        ended = cuda.syncthreads_or(contact_pass(body, dt_drift, dt))
        if steps % STRESS_EVERY == 0:
            stress_sum += total_stress(body, buffer)
            stress_samples += 1.0
            cuda.syncthreads()
        momentum, inertia, fastest = monomer_pass(body, dt, turning_step(dt, omega, domega, unwind, law), buffer)
        if law.torque:
            # Power of the body force m alpha x X: alpha times the angular momentum in the inertial frame.
            work += (domega * dt + unwind) * (inertia * omega + momentum)
            last_excess = excess
            excess = momentum / inertia
            unwind = turn_to_take_out(excess, last_excess, unwind)
        dt_drift = dt
        time += dt
        omega, domega = angular_velocity(law, time)
        steps += 1
        if not (fastest < np.inf and abs(momentum) < np.inf):
            code = NOT_FINITE
            break

        touched = 0
        p = thread
        while p < pairs:
            if gap(state, body.near[p, 0], body.near[p, 1]) <= 0.0:
                touched = 1
            p += cuda.blockDim.x
        if pairs > 0:
            touched = cuda.syncthreads_or(touched)
        if ended or touched:
            changed = True
            if thread == 0:
                break_and_make(body, pairs, ended, dt)
            cuda.syncthreads()
        travel += fastest * dt
        if travel > 0.5 * near_reach and not changed:
            travel = farthest_move(body, NEAR_REFERENCE, turning, buffer)
            if travel > 0.25 * near_reach:
                dropped = False
                if fragments > 1:
                    if thread == 0:
                        scalar[TIME] = time
                        scalar[OMEGA] = omega
                    dropped = drop_departed(body, fragments, buffer)
                if dropped:
                    changed = True
                    far_pairs = -1  # monomers have other numbers
                else:
                    stale = True
        if fastest * dt > timestep_factor * smallest:
            dt = timestep_factor * smallest / fastest

    cuda.syncthreads()
    if thread == 0:
        scalar[TIME] = time
        scalar[OMEGA] = omega
        scalar[DT] = dt
        scalar[DT_DRIFT] = dt_drift
        scalar[UNWIND] = unwind
        scalar[EXCESS] = excess
        scalar[TORQUE_WORK] = work
        scalar[STRESS_SUM] = stress_sum
        scalar[STRESS_SAMPLES] = stress_samples
        counter[STEPS] = steps
        task[CODE] = code
        task[ROWS] = made
