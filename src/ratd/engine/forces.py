"""Forces and torques of all contacts at one step: the hot loop of ratd.

Three passes over one block of contacts after the other: gather what depends on the two monomers, compute all
contacts of the block, sum forces and torques per monomer. The middle pass has no branches and runs on whole vector
registers.
"""

import numpy as np

from ratd._accelerate import jit
from ratd._fastmath import reciprocal, reciprocal_root
from ratd.engine.layout import (
    A_I, A_J, BLOCK, COMPRESSION, DAMPING, DAMPING_RATE, DVX, DVY, DVZ, DX, DY, DZ, E_DAMP, E_ROLL, E_SLIDE, E_TWIST,
    FORCE_ROW, FORCE_X, FORCE_Y, FORCE_Z, FX, FY, FZ, INV_DELTA0, INV_SUM, INV_XI2, INV_ZETA2, K_ROLL, K_SLIDE,
    K_TWIST, LANES, NCX, NCY, NCZ, NIX, NIY, NIZ, NJX, NJY, NJZ, NORMAL, N_SCRATCH, PHI, PULL_OFF, ROW, S, TIX, TIY,
    TIZ, TJX, TJY, TJZ, TORQUE_X, TORQUE_Y, TORQUE_Z, VECTOR, VX, VY, VZ, WIX, WIY, WIZ, WJX, WJY, WJZ, WX, WY, WZ, X,
    Y, Z,
)  # fmt: skip
from ratd.laws.jkr import COMPRESSION_END, contact_state, normal_force
from ratd.laws.tangential import (
    TWISTING_LIMIT,
    excess_fraction,
    nearly_unit,
    roll_back,
    rotate_pointer,
    slide_back,
    sliding_displacement,
)

_ROW = np.uint64(ROW)
_FORCE_ROW = np.uint64(FORCE_ROW)
SCRATCH_SIZE = N_SCRATCH * LANES


@jit(forceinline=True)
def _gather(monomer, pair_i, pair_j, scratch, first, count):
    for lane in range(count):
        q = np.uint64(lane)
        i = pair_i[first + q] * _ROW
        j = pair_j[first + q] * _ROW
        scratch[DX + q] = monomer[i + X] - monomer[j + X]
        scratch[DY + q] = monomer[i + Y] - monomer[j + Y]
        scratch[DZ + q] = monomer[i + Z] - monomer[j + Z]
        scratch[DVX + q] = monomer[i + VX] - monomer[j + VX]
        scratch[DVY + q] = monomer[i + VY] - monomer[j + VY]
        scratch[DVZ + q] = monomer[i + VZ] - monomer[j + VZ]
        scratch[WIX + q] = monomer[i + WX]
        scratch[WIY + q] = monomer[i + WY]
        scratch[WIZ + q] = monomer[i + WZ]
        scratch[WJX + q] = monomer[j + WX]
        scratch[WJY + q] = monomer[j + WY]
        scratch[WJZ + q] = monomer[j + WZ]


@jit(forceinline=True)
def _normal_and_twist(contact, scratch, start, count, dt_drift, dt):
    """Directions, normal forces with damping, and twisting angles after the last move.

    Leaves the normal force in `scratch` at FX and 1/|X_i - X_j| at FY. Returns the number of contacts beyond the end
    of the branch.
    """
    ended = 0
    for lane in range(count):
        q = np.uint64(lane)
        k = start + q
        dx = scratch[DX + q]
        dy = scratch[DY + q]
        dz = scratch[DZ + q]
        square = dx * dx + dy * dy + dz * dz
        inv = reciprocal_root(square)
        distance = square * inv
        ncx = dx * inv
        ncy = dy * inv
        ncz = dz * inv
        # Mean of the old and the new direction: the last move was along it, which keeps twisting second order, and a
        # pair that turns as a whole free of damping.
        mx = 0.5 * (ncx + contact[NCX + k])
        my = 0.5 * (ncy + contact[NCY + k])
        mz = 0.5 * (ncz + contact[NCZ + k])
        contact[NCX + k] = ncx
        contact[NCY + k] = ncy
        contact[NCZ + k] = ncz

        k_t = contact[K_TWIST + k]
        phi = contact[PHI + k] + dt_drift * (
            (scratch[WIX + q] - scratch[WJX + q]) * mx
            + (scratch[WIY + q] - scratch[WJY + q]) * my
            + (scratch[WIZ + q] - scratch[WJZ + q]) * mz
        )
        kept = min(max(phi, -TWISTING_LIMIT), TWISTING_LIMIT)
        contact[E_TWIST + k] += 0.5 * k_t * (phi - kept) * (phi + kept)
        contact[PHI + k] = kept

        compression = (contact[A_I + k] + contact[A_J + k] - distance) * contact[INV_DELTA0 + k]
        ended += compression < COMPRESSION_END
        s = contact_state(compression, contact[S + k])
        normal = normal_force(s, contact[PULL_OFF + k])
        contact[COMPRESSION + k] = compression
        contact[S + k] = s
        contact[NORMAL + k] = normal
        x = s * s
        receding = scratch[DVX + q] * mx + scratch[DVY + q] * my + scratch[DVZ + q] * mz
        damping = contact[DAMPING + k] * x * reciprocal(1.0 + dt * x * contact[DAMPING_RATE + k])
        contact[E_DAMP + k] += dt * damping * receding * receding
        scratch[FX + q] = normal - damping * receding
        scratch[FY + q] = inv
    return ended


@jit(forceinline=True)
def _turn_and_slide(contact, scratch, start, count, dt_drift):
    """Pointers turned by the last move, and cut back to the limit of sliding; not yet unit vectors."""
    h = 0.5 * dt_drift
    for lane in range(count):
        q = np.uint64(lane)
        k = start + q
        nix, niy, niz = rotate_pointer(
            contact[NIX + k], contact[NIY + k], contact[NIZ + k],
            h * scratch[WIX + q], h * scratch[WIY + q], h * scratch[WIZ + q],
        )  # fmt: skip
        njx, njy, njz = rotate_pointer(
            contact[NJX + k], contact[NJY + k], contact[NJZ + k],
            h * scratch[WJX + q], h * scratch[WJY + q], h * scratch[WJZ + q],
        )  # fmt: skip
        _, zx, zy, zz = sliding_displacement(
            contact[A_I + k], nix, niy, niz, contact[A_J + k], njx, njy, njz,
            contact[NCX + k], contact[NCY + k], contact[NCZ + k],
        )  # fmt: skip
        square = zx * zx + zy * zy + zz * zz
        slipped = excess_fraction(square * contact[INV_ZETA2 + k])
        contact[E_SLIDE + k] += 0.5 * contact[K_SLIDE + k] * square * slipped * (2.0 - slipped)
        inv_sum = contact[INV_SUM + k]
        nix, niy, niz, njx, njy, njz = slide_back(slipped, inv_sum, nix, niy, niz, njx, njy, njz, zx, zy, zz)
        contact[NIX + k] = nix
        contact[NIY + k] = niy
        contact[NIZ + k] = niz
        contact[NJX + k] = njx
        contact[NJY + k] = njy
        contact[NJZ + k] = njz


@jit(forceinline=True)
def _roll(contact, start, count):
    """Pointers cut back to the limit of rolling and made unit vectors again."""
    for lane in range(count):
        k = start + np.uint64(lane)
        nix = contact[NIX + k]
        niy = contact[NIY + k]
        niz = contact[NIZ + k]
        njx = contact[NJX + k]
        njy = contact[NJY + k]
        njz = contact[NJZ + k]
        square = (nix + njx) ** 2 + (niy + njy) ** 2 + (niz + njz) ** 2
        rolled = excess_fraction(square * contact[INV_XI2 + k])
        contact[E_ROLL + k] += 0.5 * contact[K_ROLL + k] * square * rolled * (2.0 - rolled)
        nix, niy, niz, njx, njy, njz = roll_back(
            rolled, contact[INV_SUM + k], contact[A_I + k], nix, niy, niz, contact[A_J + k], njx, njy, njz
        )
        nix, niy, niz = nearly_unit(nix, niy, niz)
        njx, njy, njz = nearly_unit(njx, njy, njz)
        contact[NIX + k] = nix
        contact[NIY + k] = niy
        contact[NIZ + k] = niz
        contact[NJX + k] = njx
        contact[NJY + k] = njy
        contact[NJZ + k] = njz


@jit(forceinline=True)
def _forces_and_torques(contact, scratch, start, count):
    """Force on i and torques on i and j, into `scratch`.

    Sliding force k_s (w.n_c) zeta/|X_i - X_j| on i; torques -k_s a_i n_i x zeta and k_s a_j n_j x zeta; rolling torque
    -k_r n_i x n_j and twisting torque -k_t phi n_c on i, the opposite on j.
    """
    for lane in range(count):
        q = np.uint64(lane)
        k = start + q
        nix = contact[NIX + k]
        niy = contact[NIY + k]
        niz = contact[NIZ + k]
        njx = contact[NJX + k]
        njy = contact[NJY + k]
        njz = contact[NJZ + k]
        ncx = contact[NCX + k]
        ncy = contact[NCY + k]
        ncz = contact[NCZ + k]
        a_i = contact[A_I + k]
        a_j = contact[A_J + k]
        k_s = contact[K_SLIDE + k]
        k_r = contact[K_ROLL + k]
        normal = scratch[FX + q]
        wn, zx, zy, zz = sliding_displacement(a_i, nix, niy, niz, a_j, njx, njy, njz, ncx, ncy, ncz)
        g = k_s * wn * scratch[FY + q]
        scratch[FX + q] = normal * ncx + g * zx
        scratch[FY + q] = normal * ncy + g * zy
        scratch[FZ + q] = normal * ncz + g * zz
        t = contact[K_TWIST + k] * contact[PHI + k]
        rx = k_r * (niy * njz - niz * njy) + t * ncx
        ry = k_r * (niz * njx - nix * njz) + t * ncy
        rz = k_r * (nix * njy - niy * njx) + t * ncz
        g = k_s * a_i
        scratch[TIX + q] = -g * (niy * zz - niz * zy) - rx
        scratch[TIY + q] = -g * (niz * zx - nix * zz) - ry
        scratch[TIZ + q] = -g * (nix * zy - niy * zx) - rz
        g = k_s * a_j
        scratch[TJX + q] = g * (njy * zz - njz * zy) + rx
        scratch[TJY + q] = g * (njz * zx - njx * zz) + ry
        scratch[TJZ + q] = g * (njx * zy - njy * zx) + rz


@jit(forceinline=True)
def _scatter(force, pair_i, pair_j, scratch, first, count):
    for lane in range(count):
        q = np.uint64(lane)
        i = pair_i[first + q] * _FORCE_ROW
        j = pair_j[first + q] * _FORCE_ROW
        fx = scratch[FX + q]
        fy = scratch[FY + q]
        fz = scratch[FZ + q]
        force[i + FORCE_X] += fx
        force[i + FORCE_Y] += fy
        force[i + FORCE_Z] += fz
        force[i + TORQUE_X] += scratch[TIX + q]
        force[i + TORQUE_Y] += scratch[TIY + q]
        force[i + TORQUE_Z] += scratch[TIZ + q]
        force[j + FORCE_X] -= fx
        force[j + FORCE_Y] -= fy
        force[j + FORCE_Z] -= fz
        force[j + TORQUE_X] += scratch[TJX + q]
        force[j + TORQUE_Y] += scratch[TJY + q]
        force[j + TORQUE_Z] += scratch[TJZ + q]


@jit
def contact_forces(monomer, force, contact, pair_i, pair_j, scratch, n_contacts, dt_drift, dt):
    """Add the forces and torques of all contacts to `force`.

    Parameters
    ----------
    monomer, force, contact, pair_i, pair_j : arrays
        See `State`. The pointers and twisting angles in `contact` are advanced by the last move, and cut back to
        their limits.
    scratch : (SCRATCH_SIZE,) float64 array
        Working space.
    n_contacts : int
        Number of contacts.
    dt_drift : float
        Duration of the last move [s].
    dt : float
        Duration of the kick to come [s].

    Returns
    -------
    int
        Number of contacts that are beyond the end of the branch, to be removed.
    """
    ended = 0
    for first in range(0, n_contacts, LANES):
        count = min(LANES, (n_contacts - first + VECTOR - 1) // VECTOR * VECTOR)
        start = np.uint64(first // LANES * BLOCK)
        at = np.uint64(first)
        _gather(monomer, pair_i, pair_j, scratch, at, count)
        ended += _normal_and_twist(contact, scratch, start, count, dt_drift, dt)
        _turn_and_slide(contact, scratch, start, count, dt_drift)
        _roll(contact, start, count)
        _forces_and_torques(contact, scratch, start, count)
        _scatter(force, pair_i, pair_j, scratch, at, count)
    return ended
