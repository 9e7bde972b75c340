"""What is recorded of a grain, as sums over a block of threads; see `ratd.engine.measure`."""

import numpy as np

from ratd.cuda.block import block_sum
from ratd.cuda.device import cuda, device_function
from ratd.engine.contacts import contact_energies, contact_start
from ratd.engine.layout import (
    CONTACTS, DRIVEN, DT, E_DAMP, E_ROLL, E_SLIDE, E_TWIST, FRAGMENTS_LOST, LARGEST_CONTACTS, LARGEST_MONOMERS,
    LOST_CONTACT, LOST_DAMP, LOST_ROLL, LOST_SLIDE, LOST_TWIST, MASS, MONOMERS, OMEGA, RADIUS, ROW, STRESS_SAMPLES,
    STRESS_SUM, TIME, TORQUE_WORK, X, Y, Z,
)  # fmt: skip
from ratd.engine.measure import contact_stress, kinetic_energy

_ROW = np.uint64(ROW)


@device_function
def total_stress(body, buffer):
    """sigma_Sigma [Pa], Eq. 32."""
    state = body.state
    stress = 0.0
    for c in range(cuda.threadIdx.x, state.counter[CONTACTS], cuda.blockDim.x):
        if state.fragment[state.pair_i[c]] == 0:
            stress += contact_stress(state, c)
    return block_sum(stress, buffer)


@device_function
def stored_kinetic_energy(body, buffer):
    """Kinetic energy [J] of the largest fragment in the inertial frame."""
    state = body.state
    energy = 0.0
    for k in range(cuda.threadIdx.x, state.counter[MONOMERS], cuda.blockDim.x):
        if state.fragment[k] == 0:
            moving, spinning = kinetic_energy(state, k)
            energy += moving + spinning
    return block_sum(energy, buffer)


@device_function
def stored_potential_energy(body, buffer):
    """Potential energy [J] of the contacts of the largest fragment."""
    state = body.state
    energy = 0.0
    for c in range(cuda.threadIdx.x, state.counter[CONTACTS], cuda.blockDim.x):
        if state.fragment[state.pair_i[c]] == 0:
            normal, sliding, rolling, twisting = contact_energies(state, c)
            energy += normal + sliding + rolling + twisting
    return block_sum(energy, buffer)


@device_function
def sum_field(body, field, lost, buffer):
    """Sum of one field of all contacts [J] and what is noted of those that are gone."""
    state = body.state
    energy = 0.0
    for c in range(cuda.threadIdx.x, state.counter[CONTACTS], cuda.blockDim.x):
        energy += state.contact[contact_start(c) + field]
    return block_sum(energy, buffer) + state.scalar[lost]


@device_function
def weighted_sum(body, column, buffer):
    """Sum of mass times one column of the monomers of the largest fragment [kg times unit]."""
    monomer = body.state.monomer
    total = 0.0
    for k in range(cuda.threadIdx.x, body.state.counter[MONOMERS], cuda.blockDim.x):
        r = np.uint64(k) * _ROW
        total += monomer[r + DRIVEN] * monomer[r + MASS] * monomer[r + column]
    return block_sum(total, buffer)


@device_function
def inertia_entry(body, first, second, own, cx, cy, buffer):
    """Sum of m times the product of two coordinates, counted from (cx, cy), and of own m a^2 over the largest fragment.

    [kg m2]
    """
    monomer = body.state.monomer
    total = 0.0
    for k in range(cuda.threadIdx.x, body.state.counter[MONOMERS], cuda.blockDim.x):
        r = np.uint64(k) * _ROW
        a = monomer[r + RADIUS]
        product = (monomer[r + first] - cx) * (monomer[r + second] - cy) + own * a * a
        total += monomer[r + DRIVEN] * monomer[r + MASS] * product
    return block_sum(total, buffer)


@device_function
def write_record(body, row, buffer):
    """Write one record (`arena.ROW_COLUMNS`) of a grain whose scalars are up to date; start a new interval."""
    state = body.state
    scalar = state.scalar
    stress = 0.0
    if scalar[STRESS_SAMPLES] > 0.0:
        stress = scalar[STRESS_SUM] / scalar[STRESS_SAMPLES]
    else:
        stress = total_stress(body, buffer)
    mass = 0.0
    for k in range(cuda.threadIdx.x, state.counter[MONOMERS], cuda.blockDim.x):
        r = np.uint64(k) * _ROW
        mass += state.monomer[r + DRIVEN] * state.monomer[r + MASS]
    mass = block_sum(mass, buffer)
    cx = weighted_sum(body, X, buffer) / mass
    cy = weighted_sum(body, Y, buffer) / mass
    cz = weighted_sum(body, Z, buffer) / mass
    # A sphere's own 2/5 m a^2 about each axis is 1/5 m a^2 in each of the two squares that make it up.
    xx = inertia_entry(body, X, X, 0.2, cx, cx, buffer)
    yy = inertia_entry(body, Y, Y, 0.2, cy, cy, buffer)
    zz = inertia_entry(body, Z, Z, 0.2, cz, cz, buffer)
    xy = inertia_entry(body, X, Y, 0.0, cx, cy, buffer)
    yz = inertia_entry(body, Y, Z, 0.0, cy, cz, buffer)
    zx = inertia_entry(body, Z, X, 0.0, cz, cx, buffer)
    sliding = sum_field(body, E_SLIDE, LOST_SLIDE, buffer)
    rolling = sum_field(body, E_ROLL, LOST_ROLL, buffer)
    twisting = sum_field(body, E_TWIST, LOST_TWIST, buffer)
    damping = sum_field(body, E_DAMP, LOST_DAMP, buffer)
    kinetic = stored_kinetic_energy(body, buffer)
    potential = stored_potential_energy(body, buffer)
    if cuda.threadIdx.x == 0:
        row[0] = scalar[OMEGA]
        row[1] = scalar[TIME]
        row[2] = mass
        row[3] = state.counter[LARGEST_MONOMERS]
        row[4] = state.counter[LARGEST_CONTACTS]
        row[5] = stress
        row[6] = yy + zz
        row[7] = zz + xx
        row[8] = xx + yy
        row[9] = -xy
        row[10] = -yz
        row[11] = -zx
        row[12] = sliding
        row[13] = rolling
        row[14] = twisting
        row[15] = damping
        row[16] = scalar[LOST_CONTACT]
        row[17] = scalar[TORQUE_WORK]
        row[18] = kinetic
        row[19] = potential
        row[20] = state.counter[FRAGMENTS_LOST]
        row[21] = scalar[DT]
        scalar[STRESS_SUM] = 0.0
        scalar[STRESS_SAMPLES] = 0.0
    cuda.syncthreads()
