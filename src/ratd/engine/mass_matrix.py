"""The mass matrix of the semi-implicit step (`ratd.engine.semi_implicit`), and the forces that it weighs."""

import math

import numpy as np

from ratd.base.jit import jit
from ratd.base.vectors import add8, load8, multiply8, spread8, store8
from ratd.engine.block_factor import BLOCK, PADDED, factorise, solve
from ratd.engine.contacts import contact_start, difference, get_image
from ratd.engine.layout import (
    CONTACTS, FASTEST, FORCE_ROW, FORCE_X, MASS, MONOMERS, RADIUS, ROW, TORQUE_X, VX, WX,
)  # fmt: skip
from ratd.laws.contact_fields import NCX, NCY, NCZ

TURNED = 0.005
"""Angle [rad] by which a contact may have turned since the matrix of its fragment was made."""
SPHERE = 0.4
"""Moment of inertia of a sphere over m a^2."""

_ROW = np.uint64(ROW)
_FORCE_ROW = np.uint64(FORCE_ROW)
_PADDED = np.uint64(PADDED)
_NORMAL, _TWIST, _OF_I, _OF_J = (np.uint64(PADDED * row) for row in (0, 1, 2, 4))
_FROM_I_TO_J = np.uint64(2 * PADDED)


# Inlined, so that there is one compiled version of it: a process that compiles the time loop would else call another
# one than a process that loads it, which rounds differently.
@jit(forceinline=True)
def make_matrix(state, law, box, theta, dt, work):
    """Make M' and factorise it; where it is there for this step, the parts of those fragments that have turned.

    Parameters
    ----------
    state : State
    law, box : parts
    theta : float
    dt : float
        Step [s].
    work : Work

    Notes
    -----
    The unknowns of a monomer are v and a w, velocity and spin times radius, so that all blocks are masses. With n from
    j to i the contact points slide by P g, P = 1 - n n^T and g = v_i - v_j + arm_i x (a_i w_i) + arm_j x (a_j w_j); a
    rigid motion has g = 0 (`arms`). After rolling the arms are not along n, and a contact that twists slides as well.
    Taken along n they would tell the step too little stiffness: a grain that has rolled by more than about r_0 would
    never come to rest.

    In a box that changes with H the velocities are peculiar, and the points recede by H d as well. M' needs it not,
    but calming does: else it would slow down rigid bodies, which move against the box.

    Fragments share no contact, so each has a part of the matrix that is made and factorised by itself. Most parts
    that are made anew are those of small pieces that spin away.
    """
    factor, strain, chosen, turned, rows = work.factor, work.strain, work.chosen, work.turned, work.rows
    diagonal, lower = factor.diagonal, factor.lower
    whole = work.made[0] != dt
    for i in range(state.counter[MONOMERS]):
        p = factor.place[i]
        chosen[p] = whole or turned[state.fragment[i]] > TURNED
        if chosen[p]:
            strain[PADDED * p : PADDED * (p + 1)] = 0.0
            diagonal[BLOCK * p : BLOCK * (p + 1)] = 0.0
            lower[BLOCK * factor.first[p] : BLOCK * factor.first[p + 1]] = 0.0
            m = state.monomer[np.uint64(i) * _ROW + MASS]
            for c in range(3):
                diagonal[BLOCK * p + (PADDED + 1) * c] = m
                diagonal[BLOCK * p + (PADDED + 1) * (c + 3)] = SPHERE * m
    edges = box.edges(state.scalar)
    hx, hy, hz = box.rates()
    changing = hx != 0.0 or hy != 0.0 or hz != 0.0
    weight = theta * dt * dt
    for k in range(state.counter[CONTACTS]):
        i, j = np.int64(state.pair_i[k]), np.int64(state.pair_j[k])
        if not chosen[factor.place[i]]:
            continue
        at = contact_start(law, k)
        n = (state.contact[at + NCX], state.contact[at + NCY], state.contact[at + NCZ])
        a_i = state.monomer[np.uint64(i) * _ROW + RADIUS]
        a_j = state.monomer[np.uint64(j) * _ROW + RADIUS]
        dx, dy, dz, distance = difference(state, edges, i, j, get_image(state, k))
        p_i, p_j = law.pointers(state.contact, at)
        arm_i, arm_j = arms(n, a_i, p_i, a_j, p_j, distance)
        k_n, k_s, k_r, k_t = law.stiffness(state.contact, at)
        k_n = weight * k_n + dt * law.damping_now(state.contact, at)
        k_s, k_r, k_t = weight * k_s, weight * k_r, weight * k_t
        _write_rows(rows, n, arm_i, arm_j)
        own_i, own_j = np.uint64(BLOCK * factor.place[i]), np.uint64(BLOCK * factor.place[j])
        both = -1.0 / (a_i * a_j)
        _add_block(diagonal, own_i, rows, _OF_I, _OF_I, k_n, k_s, k_r / (a_i * a_i), k_t / (a_i * a_i))
        _add_block(diagonal, own_j, rows, _OF_J, _OF_J, k_n, k_s, k_r / (a_j * a_j), k_t / (a_j * a_j))
        if i == j:
            _add_block(diagonal, own_i, rows, _OF_I, _OF_J, -k_n, k_s, k_r * both, k_t * both)
            _add_block(diagonal, own_i, rows, _OF_J, _OF_I, -k_n, k_s, k_r * both, k_t * both)
        else:
            of_row, of_column = (_OF_I, _OF_J) if work.block[k] % 2 == 1 else (_OF_J, _OF_I)
            shared = np.uint64(BLOCK * (work.block[k] // 2))
            _add_block(lower, shared, rows, of_row, of_column, -k_n, k_s, k_r * both, k_t * both)
        if changing:
            recede = (hx * dx, hy * dy, hz * dz)
            _add_strain(strain, PADDED * factor.place[i], recede, n, k_n, k_s, 1.0, arm_i)
            _add_strain(strain, PADDED * factor.place[j], recede, n, k_n, k_s, -1.0, arm_j)
    if not factorise(factor, chosen):
        state.scalar[FASTEST] = math.nan
    for i in range(state.counter[MONOMERS]):
        if chosen[factor.place[i]]:
            turned[state.fragment[i]] = 0.0
    work.made[0], work.made[1] = dt, 0.0


@jit(forceinline=True)
def arms(n, a_i, p_i, a_j, p_j, distance):
    """Arms of a contact over the radii: its points recede by v_i - v_j + arm_i x (a_i w_i) + arm_j x (a_j w_j).

    Parameters
    ----------
    n : tuple of float
        Direction from j to i.
    a_i, a_j : float
        Radii [m].
    p_i, p_j : tuple of float
        Unit vectors from the contact to the centre of i, and from that of j to the contact, fixed in the monomers:
        after rolling they are not along n.
    distance : float
        Of the centres [m].

    Returns
    -------
    arm_i, arm_j : tuple of float
        p_i and p_j scaled, less what the contact has slid, so that a rigid motion makes nothing recede.
    """
    x = a_i * p_i[0] + a_j * p_j[0]
    y = a_i * p_i[1] + a_j * p_j[1]
    z = a_i * p_i[2] + a_j * p_j[2]
    along = x * n[0] + y * n[1] + z * n[2]
    scale = distance / along
    slid = 1.0 / (a_i + a_j)
    x, y, z = slid * (x - along * n[0]), slid * (y - along * n[1]), slid * (z - along * n[2])
    return (
        (scale * (p_i[0] - x), scale * (p_i[1] - y), scale * (p_i[2] - z)),
        (scale * (p_j[0] - x), scale * (p_j[1] - y), scale * (p_j[2] - z)),
    )


@jit(forceinline=True)
def _write_rows(rows, n, arm_i, arm_j):
    """Write what the motion of i and j does at their contact: rows of J, each for six unknowns, padded to eight.

    With the tangents e1, e2 of the direction n these are n for the velocity (from `_NORMAL` on), n for the spin (from
    `_TWIST`), and for each monomer (+-e1, e1 x arm) and (+-e2, e2 x arm), from `_OF_I` and `_OF_J`: P [arm x] is the
    sum over the tangents of e (e x arm)^T.
    """
    first, second = tangents(n)
    for c in range(3):
        rows[_NORMAL + np.uint64(c)] = rows[_TWIST + np.uint64(c + 3)] = n[c]
    q = _OF_I
    for e in (first, second):
        turn_i, turn_j = _cross(e, arm_i), _cross(e, arm_j)
        for c in range(3):
            axis, spin = np.uint64(c), np.uint64(c + 3)
            rows[q + axis], rows[q + spin] = e[c], turn_i[c]
            rows[q + _FROM_I_TO_J + axis], rows[q + _FROM_I_TO_J + spin] = -e[c], turn_j[c]
        q += _PADDED


@jit(forceinline=True)
def tangents(n):
    """Two unit vectors normal to a third and to each other (Duff et al. 2017, J. Comput. Graph. Tech. 6, 1)."""
    x, y, z = n
    sign = math.copysign(1.0, z)
    a = -1.0 / (sign + z)
    b = x * y * a
    return (1.0 + sign * x * x * a, sign * b, -sign * x), (b, sign + y * y * a, -y)


@jit(forceinline=True)
def _add_block(target, at, rows, left, right, k_n, k_s, k_r, k_t):
    """Add J_left^T K J_right of one contact to a block that is kept column by column.

    The rolling stiffness counts for all spins, that of twisting for what is left along n.
    """
    normal = multiply8(spread8(k_n), load8(rows, _NORMAL))
    twist = multiply8(spread8(k_t - k_r), load8(rows, _TWIST))
    slide_1 = multiply8(spread8(k_s), load8(rows, left))
    slide_2 = multiply8(spread8(k_s), load8(rows, left + _PADDED))
    for column in range(3):
        c = np.uint64(column)
        t = at + _PADDED * c
        s = add8(load8(target, t), multiply8(normal, spread8(rows[_NORMAL + c])))
        s = add8(s, multiply8(slide_1, spread8(rows[right + c])))
        store8(target, t, add8(s, multiply8(slide_2, spread8(rows[right + _PADDED + c]))))
    for column in range(3, 6):
        c = np.uint64(column)
        t = at + _PADDED * c
        s = add8(load8(target, t), multiply8(twist, spread8(rows[_TWIST + c])))
        s = add8(s, multiply8(slide_1, spread8(rows[right + c])))
        store8(target, t, add8(s, multiply8(slide_2, spread8(rows[right + _PADDED + c]))))
        target[t + c] += k_r


@jit(forceinline=True)
def _add_strain(target, at, recede, n, k_n, k_s, sign, arm):
    """J^T K H d of one contact, rows of one of its monomers, from the velocity H d at which its points recede."""
    along = n[0] * recede[0] + n[1] * recede[1] + n[2] * recede[2]
    slide = (
        k_s * (recede[0] - along * n[0]),
        k_s * (recede[1] - along * n[1]),
        k_s * (recede[2] - along * n[2]),
    )
    moment = _cross(slide, arm)
    for c in range(3):
        target[at + c] += sign * (k_n * along * n[c] + slide[c])
        target[at + 3 + c] += moment[c]


@jit(forceinline=True)
def _cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@jit
def weigh(state, rate, last, dt, rates, work):
    """Turn the forces F into M (M'^-1 (F + D + rate (M v - s)) - rate v) - D, which moves monomers as M' says.

    The terms with the rate [1/s] take stiff motion away and leave soft motion, for which M'^-1 (M v - s) is v. s is the
    `strain` of the box. D is the force of a box that changes, -M H v of the peculiar velocities v, which the drive adds
    for the true masses.

    Parameters
    ----------
    state : State
    rate : float
    last, dt : float
        Durations of the last move and of the next one [s]; the kick between them is their mean.
    rates : tuple of float
        H of the box along x, y, z [1/s].
    work : Work

    Returns
    -------
    float
        Work of the forces along half of both moves less that of what they are turned into [J]: it is missing in the
        motion, and counts as damped.

    Notes
    -----
    With F(x) linear in x, potential energy changes by -(F + F')/2 dx in a move between the forces F and F'. So to F
    belongs F (v last + v' dt)/2, where v' = v + kick rise. That is kick F (v + v')/2, which the kinetic energy goes
    with, and (dt - last)/4 F (v' - v), which would be lost untold where a step is longer than the last one.

    A body that does not follow the box has v = -H x and keeps it if the contacts bear the force M H^2 x. Were D left to
    the true masses, they would have to bear -M' H v, theta k H^2 dt^2 d more in a contact of length d: a tension that
    grows with the step and makes the pressure of loose clusters too low.
    """
    kick, longer = 0.5 * (last + dt), 0.25 * (dt - last)
    drag = (
        math.expm1(-rates[0] * kick) / kick,
        math.expm1(-rates[1] * kick) / kick,
        math.expm1(-rates[2] * kick) / kick,
    )
    monomer, force, x, strain = state.monomer, state.force, work.x, work.strain
    place = work.factor.place
    n = state.counter[MONOMERS]
    for k in range(n):
        q = np.uint64(k) * _FORCE_ROW
        to = PADDED * place[k]
        r = np.uint64(k) * _ROW
        radius = monomer[r + RADIUS]
        inv = 1.0 / radius
        pull = rate * monomer[r + MASS]
        turn = rate * SPHERE * monomer[r + MASS] * radius
        for axis in range(3):
            a = np.uint64(axis)
            slowed = drag[axis] * monomer[r + MASS]
            x[to + axis] = force[q + FORCE_X + a] + (pull + slowed) * monomer[r + VX + a] - rate * strain[to + axis]
            turned = turn * monomer[r + WX + a] - rate * strain[to + 3 + axis]
            x[to + 3 + axis] = force[q + TORQUE_X + a] * inv + turned
    solve(work.factor, x)
    taken = 0.0
    for k in range(n):
        r = np.uint64(k) * _ROW
        q = np.uint64(k) * _FORCE_ROW
        to = PADDED * place[k]
        m = monomer[r + MASS]
        radius = monomer[r + RADIUS]
        inv = 1.0 / radius
        spin = SPHERE * m * radius
        for axis in range(3):
            a = np.uint64(axis)
            v, w = monomer[r + VX + a], monomer[r + WX + a]
            rise = x[to + axis] - (rate + drag[axis]) * v
            turn = (x[to + 3 + axis] - rate * radius * w) * inv
            pull, twist = force[q + FORCE_X + a], force[q + TORQUE_X + a]
            taken += (pull - m * rise) * (v + 0.5 * kick * rise) + longer * pull * rise
            taken += (twist - spin * radius * turn) * (w + 0.5 * kick * turn) + longer * twist * turn
            force[q + FORCE_X + a] = m * rise
            force[q + TORQUE_X + a] = spin * radius * turn
    return kick * taken
