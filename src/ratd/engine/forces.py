"""Forces and torques of all contacts at one step: the hot loop of ratd.

Three passes over one block of contacts after the other: gather what depends on the two monomers, compute all
contacts of the block, sum forces and torques per monomer. The middle pass runs on whole vector registers, in short
loops, so that the processor works on several rounds at once; cutting back to the limits of sliding and rolling is left
out for blocks without a contact beyond them.
"""

import numpy as np

from ratd.base.jit import jit
from ratd.base.fastmath import reciprocal, reciprocal_root
from ratd.base.rows import add_columns, gather_differences, gather_sides
from ratd.engine.contacts import contact_start
from ratd.engine.layout import (
    A_I, A_J, BLOCK, COMPRESSION, DAMPING, DAMPING_RATE, DVX, DVY, DVZ, DX, DY, DZ, E_DAMP, E_ROLL, E_SLIDE, E_TWIST,
    FX, FY, FZ, INV_DELTA0, INV_SUM, INV_XI2, INV_ZETA2, K_ROLL, K_SLIDE,
    K_TWIST, LANES, NCX, NCY, NCZ, NIX, NIY, NIZ, NJX, NJY, NJZ, NORMAL, N_SCRATCH, PHI, PULL_OFF, ROW, S, TIX, TIY,
    TIZ, TJX, TJY, TJZ, VECTOR, VX, VY, VZ, WIX, WIY, WIZ, WJX, WJY, WJZ, WX, WY, WZ, X, Y, Z,
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

_LANES = np.uint64(LANES)
_ROW = np.uint64(ROW)
SCRATCH_SIZE = N_SCRATCH * LANES


@jit(forceinline=True)
def _gather(monomer, pair_i, pair_j, scratch, first, count):
    for lane in range(0, count, VECTOR):
        q = np.uint64(lane)
        gather_differences(monomer, pair_i, pair_j, first + q, scratch, DX + q, _LANES)
        gather_sides(monomer, pair_i, pair_j, first + q, scratch, WIX + q, _LANES)


@jit(forceinline=True)
def _direct_and_twist(contact, scratch, start, count, dt_drift):
    """Directions, compressions and twisting angles after the last move.

    Leaves 1/|X_i - X_j| in `scratch` at FY and the rate at which the monomers recede at FX. Returns the number of
    contacts beyond the end of the branch.
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
        scratch[FX + q] = scratch[DVX + q] * mx + scratch[DVY + q] * my + scratch[DVZ + q] * mz
        scratch[FY + q] = inv

        phi = contact[PHI + k] + dt_drift * (
            (scratch[WIX + q] - scratch[WJX + q]) * mx
            + (scratch[WIY + q] - scratch[WJY + q]) * my
            + (scratch[WIZ + q] - scratch[WJZ + q]) * mz
        )
        kept = min(max(phi, -TWISTING_LIMIT), TWISTING_LIMIT)
        contact[E_TWIST + k] += 0.5 * contact[K_TWIST + k] * (phi - kept) * (phi + kept)
        contact[PHI + k] = kept

        compression = (contact[A_I + k] + contact[A_J + k] - square * inv) * contact[INV_DELTA0 + k]
        contact[COMPRESSION + k] = compression
        ended += compression < COMPRESSION_END
    return ended


@jit(forceinline=True)
def _push_and_damp(contact, scratch, start, count, dt):
    """Normal forces with damping, left in `scratch` at FX."""
    for lane in range(count):
        q = np.uint64(lane)
        k = start + q
        s = contact_state(contact[COMPRESSION + k], contact[S + k])
        normal = normal_force(s, contact[PULL_OFF + k])
        contact[S + k] = s
        contact[NORMAL + k] = normal
        x = s * s
        receding = scratch[FX + q]
        damping = contact[DAMPING + k] * x * reciprocal(1.0 + dt * x * contact[DAMPING_RATE + k])
        contact[E_DAMP + k] += dt * damping * receding * receding
        scratch[FX + q] = normal - damping * receding


@jit(forceinline=True)
def _turn(contact, scratch, start, count, dt_drift):
    """Pointers turned by the last move, as unit vectors: cutting them back has changed their lengths a little."""
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
        nix, niy, niz = nearly_unit(nix, niy, niz)
        njx, njy, njz = nearly_unit(njx, njy, njz)
        contact[NIX + k] = nix
        contact[NIY + k] = niy
        contact[NIZ + k] = niz
        contact[NJX + k] = njx
        contact[NJY + k] = njy
        contact[NJZ + k] = njz


@jit(forceinline=True)
def _displace(contact, scratch, start, count):
    """Sliding displacements: k_s zeta, left in `scratch` at DX, DY, DZ, and (w.n_c)/|X_i - X_j| at FY.

    Returns the number of limits of sliding and rolling that are exceeded.
    """
    exceeded = 0
    for lane in range(count):
        q = np.uint64(lane)
        k = start + q
        nix = contact[NIX + k]
        niy = contact[NIY + k]
        niz = contact[NIZ + k]
        njx = contact[NJX + k]
        njy = contact[NJY + k]
        njz = contact[NJZ + k]
        wn, zx, zy, zz = sliding_displacement(
            contact[A_I + k], nix, niy, niz, contact[A_J + k], njx, njy, njz,
            contact[NCX + k], contact[NCY + k], contact[NCZ + k],
        )  # fmt: skip
        exceeded += (zx * zx + zy * zy + zz * zz) * contact[INV_ZETA2 + k] > 1.0
        exceeded += ((nix + njx) ** 2 + (niy + njy) ** 2 + (niz + njz) ** 2) * contact[INV_XI2 + k] > 1.0
        k_s = contact[K_SLIDE + k]
        scratch[DX + q] = k_s * zx
        scratch[DY + q] = k_s * zy
        scratch[DZ + q] = k_s * zz
        scratch[FY + q] *= wn
    return exceeded


@jit(forceinline=True)
def _slip(contact, scratch, start, count):
    """Pointers cut back to the limits of sliding and rolling; what is not beyond its limit keeps its bits.

    Sliding shortens zeta by what has slipped, and changes neither w.n_c nor n_i + n_j; rolling does not change w.
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
        a_i = contact[A_I + k]
        a_j = contact[A_J + k]
        inv_sum = contact[INV_SUM + k]
        _, zx, zy, zz = sliding_displacement(
            a_i, nix, niy, niz, a_j, njx, njy, njz, contact[NCX + k], contact[NCY + k], contact[NCZ + k]
        )
        zeta2 = zx * zx + zy * zy + zz * zz
        xi2 = (nix + njx) ** 2 + (niy + njy) ** 2 + (niz + njz) ** 2
        slipped = excess_fraction(zeta2 * contact[INV_ZETA2 + k])
        rolled = excess_fraction(xi2 * contact[INV_XI2 + k])
        contact[E_SLIDE + k] += 0.5 * contact[K_SLIDE + k] * zeta2 * slipped * (2.0 - slipped)
        contact[E_ROLL + k] += 0.5 * contact[K_ROLL + k] * xi2 * rolled * (2.0 - rolled)
        nix, niy, niz, njx, njy, njz = slide_back(slipped, inv_sum, nix, niy, niz, njx, njy, njz, zx, zy, zz)
        nix, niy, niz, njx, njy, njz = roll_back(rolled, inv_sum, a_i, nix, niy, niz, a_j, njx, njy, njz)
        contact[NIX + k] = nix
        contact[NIY + k] = niy
        contact[NIZ + k] = niz
        contact[NJX + k] = njx
        contact[NJY + k] = njy
        contact[NJZ + k] = njz
        kept = 1.0 - slipped
        scratch[DX + q] *= kept
        scratch[DY + q] *= kept
        scratch[DZ + q] *= kept


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
        sx = scratch[DX + q]
        sy = scratch[DY + q]
        sz = scratch[DZ + q]
        normal = scratch[FX + q]
        g = scratch[FY + q]
        scratch[FX + q] = normal * ncx + g * sx
        scratch[FY + q] = normal * ncy + g * sy
        scratch[FZ + q] = normal * ncz + g * sz
        t = contact[K_TWIST + k] * contact[PHI + k]
        k_r = contact[K_ROLL + k]
        rx = k_r * (niy * njz - niz * njy) + t * ncx
        ry = k_r * (niz * njx - nix * njz) + t * ncy
        rz = k_r * (nix * njy - niy * njx) + t * ncz
        a_i = contact[A_I + k]
        scratch[TIX + q] = -a_i * (niy * sz - niz * sy) - rx
        scratch[TIY + q] = -a_i * (niz * sx - nix * sz) - ry
        scratch[TIZ + q] = -a_i * (nix * sy - niy * sx) - rz
        a_j = contact[A_J + k]
        scratch[TJX + q] = a_j * (njy * sz - njz * sy) + rx
        scratch[TJY + q] = a_j * (njz * sx - njx * sz) + ry
        scratch[TJZ + q] = a_j * (njx * sy - njy * sx) + rz


@jit(forceinline=True)
def _scatter(force, pair_i, pair_j, scratch, first, count):
    for lane in range(0, count, VECTOR):
        q = np.uint64(lane)
        add_columns(force, pair_i, first + q, scratch, FX + q, TIX + q, _LANES, 1.0)
        add_columns(force, pair_j, first + q, scratch, FX + q, TJX + q, _LANES, -1.0)


@jit(forceinline=True)
def _compute(contact, scratch, start, count, dt_drift, dt):
    """The arithmetic of `count` contacts of one block, between gathering and summing; see `contact_forces`."""
    ended = _direct_and_twist(contact, scratch, start, count, dt_drift)
    _push_and_damp(contact, scratch, start, count, dt)
    _turn(contact, scratch, start, count, dt_drift)
    if _displace(contact, scratch, start, count) > 0:
        _slip(contact, scratch, start, count)
    _forces_and_torques(contact, scratch, start, count)
    return ended


@jit(forceinline=True)
def forces_between(monomer, contact, pair_i, pair_j, scratch, first, count, dt_drift, dt):
    """Advance `count` contacts of one block, from contact `first` on, and leave their forces in `scratch`.

    One number after the other, where `contact_forces` takes eight contacts at once: for processors that have no
    vectors, and to test the gathering of that.

    Parameters
    ----------
    monomer, contact, pair_i, pair_j, scratch, dt_drift, dt
        As for `contact_forces`.
    first : int
        Number of the first contact.
    count : int
        Number of contacts; they stand in one block.

    Returns
    -------
    int
        Number of contacts that are beyond the end of the branch.
    """
    for lane in range(count):
        q = np.uint64(lane)
        i = pair_i[np.uint64(first) + q] * _ROW
        j = pair_j[np.uint64(first) + q] * _ROW
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
    return _compute(contact, scratch, contact_start(first), count, dt_drift, dt)


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
        ended += _compute(contact, scratch, start, count, dt_drift, dt)
        _scatter(force, pair_i, pair_j, scratch, at, count)
    return ended
