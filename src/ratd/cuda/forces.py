"""One step of a grain: its contacts, then its monomers, each shared out over the threads of a block."""

import math

import numpy as np

from ratd.cuda.block import block_max, greater, over_warps, tree
from ratd.cuda.device import cuda, device_function
from ratd.cuda.lists import link_to
from ratd.drives import kick_and_drift_one
from ratd.engine.forces import SCRATCH_SIZE, forces_between
from ratd.engine.layout import (
    CONTACTS, FORCE_ROW, FORCE_X, FORCE_Y, FORCE_Z, FX, FY, FZ, LANES, MONOMERS, RADIUS, ROW, TIX, TIY, TIZ, TJX, TJY,
    TJZ, TORQUE_X, TORQUE_Y, TORQUE_Z,
)  # fmt: skip

_ROW = np.uint64(ROW)
_AXIS = np.uint64(LANES)
_TORQUE_I = np.uint64(3 * LANES)
_TORQUE_J = np.uint64(6 * LANES)
_ONE = np.uint64(1)


@device_function
def contact_pass(body, dt_drift, dt):
    """Advance all contacts, and leave their forces and torques in `result`, one LANES after the other.

    Returns
    -------
    int
        Number of contacts of this thread that are beyond the end of the branch.
    """
    state = body.state
    result = body.result
    scratch = cuda.local.array(SCRATCH_SIZE, np.float64)
    contacts = state.counter[CONTACTS]
    ended = 0
    # No range with a step, here and below: the number of its turns takes a division.
    c = cuda.threadIdx.x
    while c < contacts:
        ended += forces_between(state.monomer, state.contact, state.pair_i, state.pair_j, scratch, c, 1, dt_drift, dt)
        at = link_to(c, 0) >> _ONE
        result[at] = scratch[FX]
        result[at + _AXIS] = scratch[FY]
        result[at + _AXIS + _AXIS] = scratch[FZ]
        at += _TORQUE_I
        result[at] = scratch[TIX]
        result[at + _AXIS] = scratch[TIY]
        result[at + _AXIS + _AXIS] = scratch[TIZ]
        at += _TORQUE_I
        result[at] = scratch[TJX]
        result[at + _AXIS] = scratch[TJY]
        result[at + _AXIS + _AXIS] = scratch[TJZ]
        c += cuda.blockDim.x
    return ended


@device_function
def sum_forces(body, k, force):
    """Force and torque on monomer k (uint64), into `force` (FORCE_ROW numbers), summed in the order of the contacts."""
    result = body.result
    fx = 0.0
    fy = 0.0
    fz = 0.0
    tx = 0.0
    ty = 0.0
    tz = 0.0
    p = np.uint64(body.begin[k])
    last = np.uint64(body.begin[k + _ONE])
    while p < last:
        at = body.link[p] >> _ONE
        sign = 1.0
        torque = at + _TORQUE_I
        if body.link[p] & _ONE:
            sign = -1.0
            torque = at + _TORQUE_J
        fx += sign * result[at]
        fy += sign * result[at + _AXIS]
        fz += sign * result[at + _AXIS + _AXIS]
        tx += result[torque]
        ty += result[torque + _AXIS]
        tz += result[torque + _AXIS + _AXIS]
        p += _ONE
    force[FORCE_X] = fx
    force[FORCE_Y] = fy
    force[FORCE_Z] = fz
    force[TORQUE_X] = tx
    force[TORQUE_Y] = ty
    force[TORQUE_Z] = tz


@device_function
def monomer_pass(body, dt, turn, buffer):
    """Sum the forces on all monomers and move them by one step.

    Parameters
    ----------
    body : Body
    dt : float
        Step [s].
    turn : ratd.drives.TurningStep
    buffer : float64 array
        Shared memory with three numbers for each thread; nobody may still be reading it.

    Returns
    -------
    angular_momentum, inertia, fastest : float
        As of `ratd.drives.kick_and_drift`, the same in all threads.
    """
    state = body.state
    threads = cuda.blockDim.x
    force = cuda.local.array(FORCE_ROW, np.float64)
    angular_momentum = 0.0
    inertia = 0.0
    fastest = 0.0
    n = np.uint64(state.counter[MONOMERS])
    k = np.uint64(cuda.threadIdx.x)
    while k < n:
        sum_forces(body, k, force)
        momentum_k, inertia_k, speed = kick_and_drift_one(state.monomer, force, k * _ROW, np.uint64(0), dt, turn)
        angular_momentum += momentum_k
        inertia += inertia_k
        fastest = greater(fastest, speed)
        k += np.uint64(threads)
    buffer[cuda.threadIdx.x] = angular_momentum
    buffer[threads + cuda.threadIdx.x] = inertia
    buffer[2 * threads + cuda.threadIdx.x] = fastest
    tree(buffer, 2, 1)
    cuda.syncthreads()
    return (
        over_warps(buffer, 0, False), over_warps(buffer, threads, False),
        math.sqrt(over_warps(buffer, 2 * threads, True)),
    )  # fmt: skip


@device_function
def residual_force(body, buffer):
    """Greatest net force on any monomer [N] in a frame at rest; torques count as force times radius."""
    contact_pass(body, 0.0, 0.0)
    cuda.syncthreads()
    state = body.state
    force = cuda.local.array(FORCE_ROW, np.float64)
    greatest = 0.0
    for k in range(cuda.threadIdx.x, state.counter[MONOMERS], cuda.blockDim.x):
        sum_forces(body, np.uint64(k), force)
        a = state.monomer[np.uint64(k) * _ROW + RADIUS]
        f = force[FORCE_X] ** 2 + force[FORCE_Y] ** 2 + force[FORCE_Z] ** 2
        t = force[TORQUE_X] ** 2 + force[TORQUE_Y] ** 2 + force[TORQUE_Z] ** 2
        greatest = max(greatest, max(f, t / (a * a)))
    return math.sqrt(block_max(greatest, buffer))
