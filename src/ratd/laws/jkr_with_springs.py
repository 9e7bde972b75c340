"""The law of Johnson, Kendall & Roberts with friction: springs that slide, roll and twist (Dominik & Nuebold 2002).

The formulae of the normal force stand in `ratd.laws.johnson_kendall_roberts`, those of the springs and their limits in
displacement in `ratd.laws.tangential`. Here they make a law for the time loop. The normal force alone may be that of
Derjaguin, Muller & Toporov instead, which tells what of an aggregate's strength hangs on it. A block of contacts goes
through short loops on whole vector registers, so that the processor works on several rounds at once; cutting back to
the limits is left out for blocks without a contact beyond them.
"""

from typing import NamedTuple

import numpy as np

from ratd.base.checks import is_number
from ratd.base.errors import InputError
from ratd.base.fastmath import reciprocal, reciprocal_root
from ratd.base.jit import jit
from ratd.base.parts import part
from ratd.laws.contact_constants import (
    equilibrium_compression,
    equilibrium_contact_radius,
    pull_off_force,
    reduced_radius,
)
from ratd.laws.contact_fields import (
    A_I, A_J, COMMON, DAMPING_RATE, DVX, DVY, DVZ, DX, DY, DZ, E_DAMP, E_ROLL, E_SLIDE, E_TWIST, FX, FY, FZ, NCX,
    NCY, NCZ, NORMAL, STEP, SX, SY, SZ, TIX, TIY, TIZ, TJX, TJY, TJZ, WIX, WIY, WIZ, WJX, WJY, WJZ, law_fields,
)  # fmt: skip
from ratd.laws.derjaguin_muller_toporov import dmt_force, dmt_potential, dmt_state
from ratd.laws.johnson_kendall_roberts import (
    COMPRESSION_END, S_END, S_TOUCH, contact_state, contact_time, dissipation_time, normal_force, normal_potential,
    viscoelastic_damping,
)  # fmt: skip
from ratd.laws.tangential import (
    TWISTING_LIMIT, excess_fraction, nearly_unit, roll_back, rolling_stiffness, rotate_pointer, slide_back,
    sliding_displacement, sliding_limit, sliding_stiffness, twisting_stiffness,
)  # fmt: skip

NORMAL_FORCES = ("JKR", "DMT")
JKR_FORCE, DMT_FORCE = range(len(NORMAL_FORCES))
DAMPINGS = ("viscoelastic", "constant", "none")
VISCOELASTIC, CONSTANT, NO_DAMPING = range(len(DAMPINGS))
FRICTIONS = ("springs", "none")

N_OWN = 20
(
    NIX, NIY, NIZ, NJX, NJY, NJZ,  # contact pointers in monomers i and j
    PHI,  # twisting angle [rad]
    S,  # sqrt(r/r0)
    COMPRESSION,  # delta/delta_0, with delta_0 of JKR
    IMPULSE,  # of the damping in the last kick [N s]
    # constants of the contact
    INV_SUM, INV_DELTA0, PULL_OFF, K_SLIDE, INV_ZETA2, K_ROLL, INV_XI2, K_TWIST, DAMPING, RADIUS_0,
) = law_fields(N_OWN)  # fmt: skip


@jit(forceinline=True)
def _direct_and_twist(contact, scratch, start, count, dt_drift, end):
    """Directions, compressions and twisting angles after the last move.

    Leaves 1/|X_i - X_j| in `scratch` at FY and the rate at which the monomers recede at FX. Returns the number of
    contacts beyond the end of the branch, at the compression `end`.
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
        contact[PHI + k] = phi

        compression = (contact[A_I + k] + contact[A_J + k] - square * inv) * contact[INV_DELTA0 + k]
        contact[COMPRESSION + k] = compression
        ended += compression < end
    return ended


@jit(forceinline=True)
def _push_and_damp(contact, scratch, start, count, dt, constant):
    """Normal forces of JKR with damping, left in `scratch` at FX."""
    for lane in range(count):
        q = np.uint64(lane)
        k = start + q
        # beyond the end of the branch there is no root: Newton's steps would run away
        s = contact_state(max(contact[COMPRESSION + k], COMPRESSION_END), contact[S + k])
        _damp(contact, scratch, k, q, s, normal_force(s, contact[PULL_OFF + k]), dt, constant)


@jit(forceinline=True)
def _push_and_damp_dmt(contact, scratch, start, count, dt, constant):
    """Normal forces of DMT with damping, left in `scratch` at FX."""
    for lane in range(count):
        q = np.uint64(lane)
        k = start + q
        s = dmt_state(max(contact[COMPRESSION + k], 0.0))
        _damp(contact, scratch, k, q, s, dmt_force(s, contact[PULL_OFF + k]), dt, constant)


@jit(forceinline=True)
def _damp(contact, scratch, k, q, s, normal, dt, constant):
    """State and normal force of one contact, kept in it, and the force with damping, left in `scratch` at FX."""
    contact[S + k] = s
    contact[NORMAL + k] = normal
    x = 1.0 if constant else s * s
    receding = scratch[FX + q]
    damping = contact[DAMPING + k] * x * reciprocal(1.0 + dt * x * contact[DAMPING_RATE + k])
    drag = damping * receding
    # The work of the damping over the last kick and this one, each at its mean velocity: exact for leapfrog.
    impulse = dt * drag
    contact[E_DAMP + k] += 0.5 * (contact[IMPULSE + k] + impulse) * receding
    contact[IMPULSE + k] = impulse
    scratch[FX + q] = normal - drag


@jit(forceinline=True)
def _turn(contact, scratch, start, count, dt_drift):
    """Pointers turned by the last move. Their length grows by a part of (w dt)^4/8, which `_slip` takes back."""
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
        contact[NIX + k] = nix
        contact[NIY + k] = niy
        contact[NIZ + k] = niz
        contact[NJX + k] = njx
        contact[NJY + k] = njy
        contact[NJZ + k] = njz


@jit(forceinline=True)
def _displace(contact, scratch, start, count):
    """Sliding displacements: k_s zeta, left in `scratch` at SX, SY, SZ, and (w.n_c)/|X_i - X_j| at FY.

    Returns the number of limits of sliding, rolling and twisting that are exceeded.
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
        exceeded += abs(contact[PHI + k]) > TWISTING_LIMIT
        exceeded += (zx * zx + zy * zy + zz * zz) * contact[INV_ZETA2 + k] > 1.0
        exceeded += ((nix + njx) ** 2 + (niy + njy) ** 2 + (niz + njz) ** 2) * contact[INV_XI2 + k] > 1.0
        k_s = contact[K_SLIDE + k]
        scratch[SX + q] = k_s * zx
        scratch[SY + q] = k_s * zy
        scratch[SZ + q] = k_s * zz
        scratch[FY + q] *= wn
    return exceeded


@jit(forceinline=True)
def _slip(contact, scratch, start, count):
    """Pointers and angles cut back to their limits, and the pointers made unit vectors again.

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
        wn, zx, zy, zz = sliding_displacement(
            a_i, nix, niy, niz, a_j, njx, njy, njz, contact[NCX + k], contact[NCY + k], contact[NCZ + k]
        )
        zeta2 = zx * zx + zy * zy + zz * zz
        xi2 = (nix + njx) ** 2 + (niy + njy) ** 2 + (niz + njz) ** 2
        slipped = excess_fraction(zeta2 * contact[INV_ZETA2 + k])
        rolled = excess_fraction(xi2 * contact[INV_XI2 + k])
        # limit times excess
        phi = contact[PHI + k]
        kept_phi = min(max(phi, -TWISTING_LIMIT), TWISTING_LIMIT)
        contact[E_TWIST + k] += contact[K_TWIST + k] * kept_phi * (phi - kept_phi)
        contact[PHI + k] = kept_phi
        contact[E_SLIDE + k] += contact[K_SLIDE + k] * zeta2 * slipped * (1.0 - slipped)
        contact[E_ROLL + k] += contact[K_ROLL + k] * xi2 * rolled * (1.0 - rolled)
        nix, niy, niz, njx, njy, njz = slide_back(slipped, inv_sum, nix, niy, niz, njx, njy, njz, zx, zy, zz)
        nix, niy, niz, njx, njy, njz = roll_back(rolled, inv_sum, a_i, nix, niy, niz, a_j, njx, njy, njz)
        nix, niy, niz = nearly_unit(nix, niy, niz)
        njx, njy, njz = nearly_unit(njx, njy, njz)
        contact[NIX + k] = nix
        contact[NIY + k] = niy
        contact[NIZ + k] = niz
        contact[NJX + k] = njx
        contact[NJY + k] = njy
        contact[NJZ + k] = njz
        # Anew from the pointers as they are now: else the torques would not match the force.
        unit_wn, zx, zy, zz = sliding_displacement(
            a_i, nix, niy, niz, a_j, njx, njy, njz, contact[NCX + k], contact[NCY + k], contact[NCZ + k]
        )
        k_s = contact[K_SLIDE + k]
        scratch[SX + q] = k_s * zx
        scratch[SY + q] = k_s * zy
        scratch[SZ + q] = k_s * zz
        scratch[FY + q] *= unit_wn / wn


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
        sx = scratch[SX + q]
        sy = scratch[SY + q]
        sz = scratch[SZ + q]
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


@part
class JKR(NamedTuple):
    """The law of this module, with its options; made by `jkr`.

    Attributes
    ----------
    normal_force : int
        `JKR_FORCE` or `DMT_FORCE`.
    damping : int
        `VISCOELASTIC` (Eq. 22: proportional to the contact radius), `CONSTANT` or `NO_DAMPING`.
    constant_damping : float
        k_n of Kataoka et al. (2013), Eq. 4: the coefficient is k_n m0/t0; for unequal spheres m0 = 2 m_red.
    friction : bool
        Whether contacts resist sliding, rolling and twisting.
    sliding_stiffness, sliding_limit, twisting_stiffness : float
        Factors of k_s, zeta_c and k_t, 1 for the model.
    """

    normal_force: int
    damping: int
    constant_damping: float
    friction: bool
    sliding_stiffness: float
    sliding_limit: float
    twisting_stiffness: float

    def n_fields(self):
        return COMMON + N_OWN

    def vectors(self):
        return NIX, NJX

    def idle(self, contact, at):
        contact[at + NIX] = -1.0
        contact[at + NJX] = 1.0
        contact[at + S] = S_TOUCH

    def begin(self, contact, at, pair, mass_i, mass_j, normal, distance, spin_i, spin_j, back, at_rest):
        a_i = contact[at + A_I]
        a_j = contact[at + A_J]
        gamma = pair.surface_energy
        r = reduced_radius(a_i, a_j)
        r0 = equilibrium_contact_radius(r, gamma, pair.reduced_modulus)
        delta0 = equilibrium_compression(r, gamma, pair.reduced_modulus)
        f_c = pull_off_force(r, gamma)
        on = 1.0 if self.friction else 0.0
        contact[at + INV_SUM] = 1.0 / (a_i + a_j)
        contact[at + INV_DELTA0] = 1.0 / delta0
        contact[at + PULL_OFF] = f_c
        contact[at + RADIUS_0] = r0
        contact[at + K_SLIDE] = on * self.sliding_stiffness * sliding_stiffness(r0, pair.sliding_modulus)
        contact[at + INV_ZETA2] = (self.sliding_limit * sliding_limit(r0, pair.poisson_number)) ** -2
        contact[at + K_ROLL] = on * rolling_stiffness(f_c, r)
        contact[at + INV_XI2] = (r / pair.rolling_limit) ** 2
        contact[at + K_TWIST] = on * self.twisting_stiffness * twisting_stiffness(r0, pair.twisting_modulus)
        if self.damping == VISCOELASTIC:
            contact[at + DAMPING] = viscoelastic_damping(r0, pair.reduced_modulus, pair.viscosity)
        elif self.damping == CONSTANT:
            reduced_mass = mass_i * mass_j / (mass_i + mass_j)
            time = contact_time(reduced_mass, r, pair.reduced_modulus, gamma)
            contact[at + DAMPING] = self.constant_damping * 2.0 * reduced_mass / time
        else:
            contact[at + DAMPING] = 0.0
        contact[at + STEP] = dissipation_time(min(mass_i, mass_j), r, r0, gamma)

        compression = (a_i + a_j - distance) / delta0
        s = S_TOUCH
        radiated = 0.0
        if self.normal_force == DMT_FORCE:
            # there is no neck that would jump
            s = dmt_state(max(compression, 0.0))
        elif at_rest:
            for _ in range(40):
                s = contact_state(max(compression, COMPRESSION_END), s)
        else:
            radiated = -normal_potential(S_TOUCH, f_c, delta0)
        contact[at + S] = s
        contact[at + COMPRESSION] = compression
        contact[at + NORMAL] = dmt_force(s, f_c) if self.normal_force == DMT_FORCE else normal_force(s, f_c)

        # The forces of the next step turn the pointers by the last move; they are turned back by as much here, so that
        # they then point exactly at the other monomer.
        h = -0.5 * back
        nx, ny, nz = normal
        x, y, z = rotate_pointer(-nx, -ny, -nz, h * spin_i[0], h * spin_i[1], h * spin_i[2])
        contact[at + NIX], contact[at + NIY], contact[at + NIZ] = x, y, z
        x, y, z = rotate_pointer(nx, ny, nz, h * spin_j[0], h * spin_j[1], h * spin_j[2])
        contact[at + NJX], contact[at + NJY], contact[at + NJZ] = x, y, z
        contact[at + PHI] = -back * (
            (spin_i[0] - spin_j[0]) * nx + (spin_i[1] - spin_j[1]) * ny + (spin_i[2] - spin_j[2]) * nz
        )
        return radiated

    def forces(self, contact, scratch, start, count, dt_drift, dt):
        ended = _direct_and_twist(contact, scratch, start, count, dt_drift, end_of(self.normal_force))
        # chosen here, so that neither loop asks
        if self.normal_force == DMT_FORCE:
            _push_and_damp_dmt(contact, scratch, start, count, dt, self.damping == CONSTANT)
        else:
            _push_and_damp(contact, scratch, start, count, dt, self.damping == CONSTANT)
        _turn(contact, scratch, start, count, dt_drift)
        if _displace(contact, scratch, start, count) > 0:
            _slip(contact, scratch, start, count)
        _forces_and_torques(contact, scratch, start, count)
        return ended

    def ended(self, contact, at):
        return contact[at + COMPRESSION] < end_of(self.normal_force)

    def energies(self, contact, at):
        nix, niy, niz = contact[at + NIX], contact[at + NIY], contact[at + NIZ]
        njx, njy, njz = contact[at + NJX], contact[at + NJY], contact[at + NJZ]
        _, zx, zy, zz = sliding_displacement(
            contact[at + A_I], nix, niy, niz, contact[at + A_J], njx, njy, njz,
            contact[at + NCX], contact[at + NCY], contact[at + NCZ],
        )  # fmt: skip
        rolled = (nix + njx) ** 2 + (niy + njy) ** 2 + (niz + njz) ** 2
        s, f_c, delta0 = contact[at + S], contact[at + PULL_OFF], 1.0 / contact[at + INV_DELTA0]
        return (
            dmt_potential(s, f_c, delta0) if self.normal_force == DMT_FORCE else normal_potential(s, f_c, delta0),
            0.5 * contact[at + K_SLIDE] * (zx * zx + zy * zy + zz * zz),
            0.5 * contact[at + K_ROLL] * rolled,
            0.5 * contact[at + K_TWIST] * contact[at + PHI] ** 2,
        )

    def damping_coefficient(self, contact, at):
        return contact[at + DAMPING]

    def damping_now(self, contact, at):
        s = contact[at + S]
        return contact[at + DAMPING] * (1.0 if self.damping == CONSTANT else s * s)

    def contact_radius(self, contact, at):
        x = contact[at + S] ** 2
        if self.normal_force == DMT_FORCE:
            # it shrinks to a point as the spheres part, where the stress of Eq. 32 would be infinite
            x = max(x, S_END**2)
        return contact[at + RADIUS_0] * x

    def pointers(self, contact, at):
        return (
            (-contact[at + NIX], -contact[at + NIY], -contact[at + NIZ]),
            (contact[at + NJX], contact[at + NJY], contact[at + NJZ]),
        )

    def stiffness(self, contact, at):
        # In F_C/delta_0 the normal stiffness is 1.2 at equilibrium and stays below 2 x; with DMT it is 2 x, 1.39 at
        # equilibrium. 2.5 covers contacts pressed to 4 delta_0.
        s = contact[at + S]
        k_n = contact[at + PULL_OFF] * contact[at + INV_DELTA0] * max(2.5, 2.0 * s * s)
        return k_n, contact[at + K_SLIDE], contact[at + K_ROLL], contact[at + K_TWIST]


@jit
def end_of(normal_force):
    """delta/delta_0 below which a contact is gone: the end of the branch of JKR, or 0, where DMT has no neck."""
    return 0.0 if normal_force == DMT_FORCE else COMPRESSION_END


def jkr(
    *,
    normal_force="JKR",
    damping="viscoelastic",
    constant_damping=0.01,
    friction="springs",
    sliding_stiffness=1.0,
    sliding_limit=1.0,
    twisting_stiffness=1.0,
):
    """The law of Johnson, Kendall & Roberts with friction of limited displacement.

    Parameters
    ----------
    normal_force : {"JKR", "DMT"}
        The normal force, or that of Derjaguin, Muller & Toporov in its place, which holds 4/3 of the pull. Damping,
        springs and their limits stay, with r0 and F_C of Johnson, Kendall & Roberts.
    damping : {"viscoelastic", "constant", "none"}
        Normal damping: Eq. 22 of Reissl et al. (2024) with T_vis of the material, or Eq. 4 of Kataoka et al. (2013).
    constant_damping : float
        k_n of Eq. 4 [1], used with "constant".
    friction : {"springs", "none"}
        Whether contacts resist sliding, rolling and twisting.
    sliding_stiffness, sliding_limit, twisting_stiffness : float
        Factors of k_s, zeta_c and k_t; 1 is the model.

    Returns
    -------
    JKR

    Raises
    ------
    InputError
    """
    if normal_force not in NORMAL_FORCES:
        raise InputError(f"normal_force is {normal_force!r}; allowed are {', '.join(NORMAL_FORCES)}.")
    if damping not in DAMPINGS:
        raise InputError(f"damping is {damping!r}; allowed are {', '.join(DAMPINGS)}.")
    if friction not in FRICTIONS:
        raise InputError(f"friction is {friction!r}; allowed are {', '.join(FRICTIONS)}.")
    numbers = {
        "constant_damping": constant_damping,
        "sliding_stiffness": sliding_stiffness,
        "sliding_limit": sliding_limit,
        "twisting_stiffness": twisting_stiffness,
    }
    for name, value in numbers.items():
        if not (is_number(value) and value > 0.0 or value == 0.0 and name == "constant_damping"):
            raise InputError(f"{name} is {value!r}; it must be a number above 0.")
    numbers = {name: float(value) for name, value in numbers.items()}
    return JKR(
        normal_force=NORMAL_FORCES.index(normal_force),
        damping=DAMPINGS.index(damping),
        friction=friction == "springs",
        **numbers,
    )
