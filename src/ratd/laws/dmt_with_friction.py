"""The law of Derjaguin, Muller & Toporov with viscoelastic damping and friction of limited force.

The law of collisions (Umstaetter & Urbassek 2020, A&A 633, A24; Sect. 2.1). A contact exists exactly while the spheres
overlap. The paper leaves out its friction; the limits are those of Dominik & Tielens (1997), and how the force grows up
to them is a choice: with the rate of motion (`velocity`), or with a displacement (`spring`).
"""

import math
from typing import NamedTuple

import numpy as np

from ratd.base.checks import is_number
from ratd.base.errors import InputError
from ratd.base.fastmath import reciprocal, reciprocal_root, rough_reciprocal_root
from ratd.base.jit import jit
from ratd.base.parts import part
from ratd.laws.contact_constants import reduced_radius
from ratd.laws.contact_fields import (
    A_I, A_J, COMMON, DAMPING_RATE, DVX, DVY, DVZ, DX, DY, DZ, E_DAMP, E_ROLL, E_SLIDE, E_TWIST, FX, FY, FZ, NCX,
    NCY, NCZ, NORMAL, STEP, TIX, TIY, TIZ, TJX, TJY, TJZ, WIX, WIY, WIZ, WJX, WJY, WJZ, law_fields,
)  # fmt: skip
from ratd.laws.derjaguin_muller_toporov import adhesion_force, equilibrium_overlap, hertz_stiffness, vibration_period
from ratd.laws.johnson_kendall_roberts import S_END

FRICTIONS = ("none", "velocity", "spring")
NO_FRICTION, VELOCITY, SPRING = range(len(FRICTIONS))

PERIOD_PARTS = 20.0
"""The friction that grows with the rate follows it within 1/20 of the period in which the pair vibrates."""

OF_MATERIAL = -1.0
"""Viscous time of a law that takes that of the materials."""
VISCOSITY_PART = 1.5
"""A over T_vis/nu^2, see `viscous_time_of`."""

N_OWN = 17
(
    OVERLAP,  # delta [m]
    IMPULSE,  # of the damping in the last kick [N s]
    ZETA_X, ZETA_Y, ZETA_Z, ROLL_X, ROLL_Y, ROLL_Z, PHI,  # displacements of the springs: [m], and angles
    # constants of the contact
    HERTZ, ADHESION, REDUCED, SHEAR, DAMPING,
    SLIDE_STIFFNESS, ROLL_STIFFNESS,  # of springs, or force over rate
    ROLL_LIMIT,
) = law_fields(N_OWN)  # fmt: skip


@jit(forceinline=True)
def _normal(contact, scratch, start, count, dt):
    """Normal forces with damping, left at FX; the number of contacts that have ended.

    The direction for rates is the mean of the old and the new one, since velocities stand half a step behind. It stays
    at TIX, TIY, TIZ; the new one goes to NCX, NCY, NCZ, and the distance to TJX.
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
        mx = 0.5 * (ncx + contact[NCX + k])
        my = 0.5 * (ncy + contact[NCY + k])
        mz = 0.5 * (ncz + contact[NCZ + k])
        contact[NCX + k] = ncx
        contact[NCY + k] = ncy
        contact[NCZ + k] = ncz
        receding = scratch[DVX + q] * mx + scratch[DVY + q] * my + scratch[DVZ + q] * mz
        distance = square * inv
        delta = contact[A_I + k] + contact[A_J + k] - distance
        touching = 1.0 if delta >= 0.0 else 0.0
        ended += delta < 0.0
        root = math.sqrt(max(delta, 0.0))
        normal = (contact[HERTZ + k] * delta * root - contact[ADHESION + k]) * touching
        damping = contact[DAMPING + k] * root
        damping = damping * reciprocal(1.0 + dt * root * contact[DAMPING_RATE + k])
        contact[OVERLAP + k] = delta
        contact[NORMAL + k] = normal
        drag = damping * receding
        # The work of the damping over the last kick and this one, each at its mean velocity: exact for leapfrog.
        impulse = dt * drag
        contact[E_DAMP + k] += 0.5 * (contact[IMPULSE + k] + impulse) * receding
        contact[IMPULSE + k] = impulse
        scratch[FX + q] = normal - drag
        scratch[TIX + q] = mx
        scratch[TIY + q] = my
        scratch[TIZ + q] = mz
        scratch[TJX + q] = distance
        scratch[TJY + q] = receding
        scratch[TJZ + q] = root
    return ended


@jit(forceinline=True)
def _push(contact, scratch, start, count):
    """Normal forces alone, as vectors."""
    for lane in range(count):
        q = np.uint64(lane)
        k = start + q
        normal = scratch[FX + q]
        scratch[FX + q] = normal * contact[NCX + k]
        scratch[FY + q] = normal * contact[NCY + k]
        scratch[FZ + q] = normal * contact[NCZ + k]
        scratch[TIX + q] = scratch[TIY + q] = scratch[TIZ + q] = 0.0
        scratch[TJX + q] = scratch[TJY + q] = scratch[TJZ + q] = 0.0


@jit(forceinline=True)
def kept_fraction(square, limit):
    """Part of a force or torque of the given square that its limit leaves: min(1, limit/|force|)."""
    return rough_reciprocal_root(min(max(1.0, square / max(limit * limit, 1e-300)), 1e30))


@jit(forceinline=True)
def _rates(contact, scratch, k, q):
    """Levers of i and j, the velocity of sliding, the spin of rolling, and the rate of twisting of one contact.

    Returns
    -------
    l_i, l_j : float
        Parts of the distance that belong to i and j [m].
    tx, ty, tz : float
        Velocity of the contact points against each other, normal to the direction [m/s].
    wx, wy, wz : float
        Spin of i against j, normal to the direction [rad/s].
    twist : float
        ... along it.
    """
    mx = scratch[TIX + q]
    my = scratch[TIY + q]
    mz = scratch[TIZ + q]
    receding = scratch[TJY + q]
    inv_sum = scratch[TJX + q] / (contact[A_I + k] + contact[A_J + k])
    l_i = contact[A_I + k] * inv_sum
    l_j = contact[A_J + k] * inv_sum
    ux = l_i * scratch[WIX + q] + l_j * scratch[WJX + q]
    uy = l_i * scratch[WIY + q] + l_j * scratch[WJY + q]
    uz = l_i * scratch[WIZ + q] + l_j * scratch[WJZ + q]
    tx = scratch[DVX + q] - receding * mx - (uy * mz - uz * my)
    ty = scratch[DVY + q] - receding * my - (uz * mx - ux * mz)
    tz = scratch[DVZ + q] - receding * mz - (ux * my - uy * mx)
    wx = scratch[WIX + q] - scratch[WJX + q]
    wy = scratch[WIY + q] - scratch[WJY + q]
    wz = scratch[WIZ + q] - scratch[WJZ + q]
    twist = wx * mx + wy * my + wz * mz
    return l_i, l_j, tx, ty, tz, wx - twist * mx, wy - twist * my, wz - twist * mz, twist


@jit(forceinline=True)
def _give(contact, scratch, k, q, l_i, l_j, sx, sy, sz, px, py, pz):
    """Leave the force on i and the torques of one contact, from the friction s on i and the torque p on i."""
    ncx = contact[NCX + k]
    ncy = contact[NCY + k]
    ncz = contact[NCZ + k]
    normal = scratch[FX + q]
    scratch[FX + q] = normal * ncx + sx
    scratch[FY + q] = normal * ncy + sy
    scratch[FZ + q] = normal * ncz + sz
    bx = ncy * sz - ncz * sy
    by = ncz * sx - ncx * sz
    bz = ncx * sy - ncy * sx
    scratch[TIX + q] = px - l_i * bx
    scratch[TIY + q] = py - l_i * by
    scratch[TIZ + q] = pz - l_i * bz
    scratch[TJX + q] = -px - l_j * bx
    scratch[TJY + q] = -py - l_j * by
    scratch[TJZ + q] = -pz - l_j * bz


@jit(forceinline=True)
def _drag(contact, scratch, start, count, dt, limits):
    """Friction that grows with the rate up to its limit: forces and torques from what `_normal` has left."""
    slide_scale, roll_scale, twist_scale = limits
    for lane in range(count):
        q = np.uint64(lane)
        k = start + q
        ncx = contact[NCX + k]
        ncy = contact[NCY + k]
        ncz = contact[NCZ + k]
        mx = scratch[TIX + q]
        my = scratch[TIY + q]
        mz = scratch[TIZ + q]
        root = scratch[TJZ + q]
        delta = root * root
        l_i, l_j, tx, ty, tz, wx, wy, wz, twist = _rates(contact, scratch, k, q)

        touching = 1.0 if contact[OVERLAP + k] >= 0.0 else 0.0
        area = delta * contact[REDUCED + k]
        slide2 = tx * tx + ty * ty + tz * tz
        roll2 = wx * wx + wy * wy + wz * wz
        modulus = contact[SHEAR + k]
        slide_limit = slide_scale * modulus * area / (2.0 * math.pi)
        roll_limit = roll_scale * contact[ROLL_LIMIT + k]
        twist_limit = twist_scale * modulus * area * math.sqrt(area) / (3.0 * math.pi)
        eta = contact[SLIDE_STIFFNESS + k] * touching
        eta_w = contact[ROLL_STIFFNESS + k] * touching
        g = eta * kept_fraction(eta * eta * slide2, slide_limit)
        h = eta_w * kept_fraction(eta_w * eta_w * roll2, roll_limit)
        e = eta_w * kept_fraction(eta_w * eta_w * twist * twist, twist_limit)
        contact[E_SLIDE + k] += dt * g * slide2
        contact[E_ROLL + k] += dt * h * roll2
        contact[E_TWIST + k] += dt * e * twist * twist

        sx = -g * tx
        sy = -g * ty
        sz = -g * tz
        # only what is normal to the direction at hand: else it would push
        along = sx * ncx + sy * ncy + sz * ncz
        sx -= along * ncx
        sy -= along * ncy
        sz -= along * ncz
        px = -h * wx - e * twist * mx
        py = -h * wy - e * twist * my
        pz = -h * wz - e * twist * mz
        _give(contact, scratch, k, q, l_i, l_j, sx, sy, sz, px, py, pz)


@jit(forceinline=True)
def _spring(contact, scratch, start, count, dt_drift, limits):
    """Friction that grows with a displacement up to its limit: forces and torques from what `_normal` has left.

    The displacements of sliding and rolling lie in the plane normal to the direction: they are turned with the pair,
    about its direction by the mean spin, and keep their length. Beyond the limit they are cut back, which dissipates
    limit times slip. The stiffnesses follow the contact radius, so the springs are not exactly conservative.
    """
    slide_scale, roll_scale, twist_scale = limits
    for lane in range(count):
        q = np.uint64(lane)
        k = start + q
        ncx = contact[NCX + k]
        ncy = contact[NCY + k]
        ncz = contact[NCZ + k]
        mx = scratch[TIX + q]
        my = scratch[TIY + q]
        mz = scratch[TIZ + q]
        root = scratch[TJZ + q]
        delta = root * root
        l_i, l_j, tx, ty, tz, wx, wy, wz, twist = _rates(contact, scratch, k, q)
        wix = scratch[WIX + q]
        wiy = scratch[WIY + q]
        wiz = scratch[WIZ + q]
        wjx = scratch[WJX + q]
        wjy = scratch[WJY + q]
        wjz = scratch[WJZ + q]
        about = 0.5 * dt_drift * ((wix + wjx) * mx + (wiy + wjy) * my + (wiz + wjz) * mz)

        zx, zy, zz = _turned(contact[ZETA_X + k], contact[ZETA_Y + k], contact[ZETA_Z + k], ncx, ncy, ncz, about)
        zx += dt_drift * tx
        zy += dt_drift * ty
        zz += dt_drift * tz
        rx, ry, rz = _turned(contact[ROLL_X + k], contact[ROLL_Y + k], contact[ROLL_Z + k], ncx, ncy, ncz, about)
        rx += dt_drift * wx
        ry += dt_drift * wy
        rz += dt_drift * wz
        phi = contact[PHI + k] + dt_drift * twist

        touching = 1.0 if contact[OVERLAP + k] >= 0.0 else 0.0
        area = delta * contact[REDUCED + k]
        a = math.sqrt(area)
        modulus = contact[SHEAR + k]
        k_s = contact[SLIDE_STIFFNESS + k] * a * touching
        k_r = contact[ROLL_STIFFNESS + k] * touching
        k_t = 8.0 / 3.0 * modulus * area * a * touching
        slide_limit = slide_scale * modulus * area / (2.0 * math.pi)
        roll_limit = roll_scale * contact[ROLL_LIMIT + k]
        twist_limit = twist_scale / (8.0 * math.pi)

        square = k_s * k_s * (zx * zx + zy * zy + zz * zz)
        f = kept_fraction(square, slide_limit)
        contact[E_SLIDE + k] += (1.0 - f) * f * square / max(k_s, 1e-300)
        zx *= f
        zy *= f
        zz *= f
        square = k_r * k_r * (rx * rx + ry * ry + rz * rz)
        f = kept_fraction(square, roll_limit)
        contact[E_ROLL + k] += (1.0 - f) * f * square / max(k_r, 1e-300)
        rx *= f
        ry *= f
        rz *= f
        kept = min(max(phi, -twist_limit), twist_limit)
        contact[E_TWIST + k] += k_t * kept * (phi - kept)
        contact[ZETA_X + k] = zx
        contact[ZETA_Y + k] = zy
        contact[ZETA_Z + k] = zz
        contact[ROLL_X + k] = rx
        contact[ROLL_Y + k] = ry
        contact[ROLL_Z + k] = rz
        contact[PHI + k] = kept

        sx = -k_s * zx
        sy = -k_s * zy
        sz = -k_s * zz
        e = k_t * kept
        px = -k_r * rx - e * ncx
        py = -k_r * ry - e * ncy
        pz = -k_r * rz - e * ncz
        _give(contact, scratch, k, q, l_i, l_j, sx, sy, sz, px, py, pz)


@jit(forceinline=True)
def _turned(x, y, z, ncx, ncy, ncz, about):
    """A vector turned by a small angle about the direction, laid into the plane normal to it, its length kept."""
    square = x * x + y * y + z * z
    tx = x + about * (ncy * z - ncz * y)
    ty = y + about * (ncz * x - ncx * z)
    tz = z + about * (ncx * y - ncy * x)
    along = tx * ncx + ty * ncy + tz * ncz
    tx -= along * ncx
    ty -= along * ncy
    tz -= along * ncz
    f = math.sqrt(square / max(tx * tx + ty * ty + tz * tz, 1e-200)) if square > 0.0 else 1.0
    return f * tx, f * ty, f * tz


@part
class DMT(NamedTuple):
    """The law of this module, with its options; made by `dmt`.

    Attributes
    ----------
    viscous_time : float
        A [s] of the damping K A sqrt(delta) d(delta)/dt; `OF_MATERIAL` for that of the materials.
    friction : int
        `NO_FRICTION`, `VELOCITY` or `SPRING`.
    friction_time : float
        tau [s] of friction that grows with the rate; 0 for `PERIOD_PARTS` of each pair's own period.
    sliding_limit, rolling_limit, twisting_limit : float
        Factors of the limits.
    """

    viscous_time: float
    friction: int
    friction_time: float
    sliding_limit: float
    rolling_limit: float
    twisting_limit: float

    def n_fields(self):
        return COMMON + N_OWN

    def vectors(self):
        return ZETA_X, ROLL_X

    def idle(self, contact, at):
        contact[at + OVERLAP] = 1.0
        contact[at + REDUCED] = 0.5

    def begin(self, contact, at, pair, mass_i, mass_j, normal, distance, spin_i, spin_j, back, at_rest):
        a_i = contact[at + A_I]
        a_j = contact[at + A_J]
        r = reduced_radius(a_i, a_j)
        reduced_mass = mass_i * mass_j / (mass_i + mass_j)
        light = min(mass_i, mass_j)
        hertz = hertz_stiffness(r, pair.reduced_modulus)
        adhesion = adhesion_force(r, pair.surface_energy)
        overlap = equilibrium_overlap(hertz, adhesion)
        modulus = 2.0 * pair.twisting_modulus
        contact[at + HERTZ] = hertz
        contact[at + ADHESION] = adhesion
        contact[at + REDUCED] = r
        contact[at + SHEAR] = modulus
        viscous_time = self.viscous_time
        if viscous_time == OF_MATERIAL:
            viscous_time = VISCOSITY_PART * pair.viscosity
        contact[at + DAMPING] = hertz * viscous_time
        contact[at + ROLL_LIMIT] = 2.0 * adhesion * pair.rolling_limit
        if self.friction == VELOCITY:
            tau = self.friction_time
            if tau == 0.0:
                tau = vibration_period(reduced_mass, hertz, overlap) / PERIOD_PARTS
            own_i = 0.4 * mass_i * a_i * a_i
            own_j = 0.4 * mass_j * a_j * a_j
            contact[at + SLIDE_STIFFNESS] = 2.0 / 7.0 * reduced_mass / tau
            contact[at + ROLL_STIFFNESS] = own_i * own_j / (own_i + own_j) / tau
        else:
            contact[at + SLIDE_STIFFNESS] = 8.0 * pair.sliding_modulus
            contact[at + ROLL_STIFFNESS] = 2.0 * adhesion * r
        elastic = math.sqrt(light / (1.5 * hertz * math.sqrt(overlap)))
        viscous = light / max(hertz * viscous_time * math.sqrt(overlap), 1e-300)
        contact[at + STEP] = min(elastic, viscous)
        if self.friction == VELOCITY:
            # explicit, and stable up to 2 tau over the number of contacts of a sphere
            contact[at + STEP] = min(contact[at + STEP], 2.0 * tau)
        delta = max(a_i + a_j - distance, 0.0)
        contact[at + OVERLAP] = delta
        contact[at + NORMAL] = hertz * delta**1.5 - adhesion
        return 0.0

    def forces(self, contact, scratch, start, count, dt_drift, dt):
        ended = _normal(contact, scratch, start, count, dt)
        limits = (self.sliding_limit, self.rolling_limit, self.twisting_limit)
        if self.friction == VELOCITY:
            _drag(contact, scratch, start, count, dt, limits)
        elif self.friction == SPRING:
            _spring(contact, scratch, start, count, dt_drift, limits)
        else:
            _push(contact, scratch, start, count)
        return ended

    def ended(self, contact, at):
        return contact[at + OVERLAP] < 0.0

    def energies(self, contact, at):
        delta = max(contact[at + OVERLAP], 0.0)
        normal = 0.4 * contact[at + HERTZ] * delta**2.5 - contact[at + ADHESION] * delta
        if self.friction != SPRING:
            return normal, 0.0, 0.0, 0.0
        area = delta * contact[at + REDUCED]
        a = math.sqrt(area)
        zeta2 = contact[at + ZETA_X] ** 2 + contact[at + ZETA_Y] ** 2 + contact[at + ZETA_Z] ** 2
        rolled2 = contact[at + ROLL_X] ** 2 + contact[at + ROLL_Y] ** 2 + contact[at + ROLL_Z] ** 2
        return (
            normal,
            0.5 * contact[at + SLIDE_STIFFNESS] * a * zeta2,
            0.5 * contact[at + ROLL_STIFFNESS] * rolled2,
            4.0 / 3.0 * contact[at + SHEAR] * area * a * contact[at + PHI] ** 2,
        )

    def damping_coefficient(self, contact, at):
        # `_normal` weighs the rate with sqrt(delta)
        return contact[at + DAMPING]

    def contact_radius(self, contact, at):
        # it shrinks to a point as the spheres part, where a stress would be infinite: that of JKR ends at S_END^2 of
        # the radius at rest, and so does this one
        at_rest = equilibrium_overlap(contact[at + HERTZ], contact[at + ADHESION])
        return math.sqrt(max(contact[at + OVERLAP], S_END**4 * at_rest) * contact[at + REDUCED])


def viscous_time_of(law, material):
    """A [s] of the damping under a law of `dmt` in contacts of a material.

    Where the law does not say it, A = 3/2 T_vis/nu^2: then K A sqrt(delta) = 4/3 E* A a is the damping
    2 E* a T_vis/nu^2 that JKR has at the same contact radius a (Eq. 22 of Reissl et al. 2024).

    Parameters
    ----------
    law : DMT
    material : ratd.Material
    """
    if law.viscous_time != OF_MATERIAL:
        return law.viscous_time
    return VISCOSITY_PART * material.viscous_time / material.poisson_number**2


def dmt(
    *,
    viscous_time=None,
    friction="velocity",
    friction_time=0.0,
    sliding_limit=1.0,
    rolling_limit=1.0,
    twisting_limit=1.0,
):
    """The law of Derjaguin, Muller & Toporov with viscoelastic damping and friction of limited force.

    Parameters
    ----------
    viscous_time : float, optional
        A [s] of the damping force K A sqrt(delta) d(delta)/dt; it decides how much of an impact is dissipated. That of
        the material when not given, see `viscous_time_of`: 0.5 ns for silica, as recalled of the group of Umstaetter &
        Urbassek (2020), who do not print it.
    friction : {"none", "velocity", "spring"}
        How sliding, rolling and twisting are resisted: not; by a force that grows with their rate, min(limit, eta
        |rate|); by springs that are cut back at the limit.
    friction_time : float
        tau [s] in eta = 2/7 m_red/tau (sliding) and I_red/tau (rolling, twisting); 0 for a twentieth of the period of
        each pair.
    sliding_limit, rolling_limit, twisting_limit : float
        Factors of G a^2/(2 pi), 2 (4 pi gamma R) xi_c and G a^3/(3 pi), a being the contact radius.

    Returns
    -------
    DMT

    Raises
    ------
    InputError
    """
    if friction not in FRICTIONS:
        raise InputError(f"friction is {friction!r}; allowed are {', '.join(FRICTIONS)}.")
    if viscous_time is not None and not (is_number(viscous_time) and viscous_time >= 0.0):
        raise InputError(f"viscous_time is {viscous_time!r}; it must be a number of at least 0, or None.")
    numbers = {
        "friction_time": friction_time,
        "sliding_limit": sliding_limit,
        "rolling_limit": rolling_limit,
        "twisting_limit": twisting_limit,
    }
    for name, value in numbers.items():
        if not (is_number(value) and value >= 0.0):
            raise InputError(f"{name} is {value!r}; it must be a number of at least 0.")
    viscous_time = OF_MATERIAL if viscous_time is None else float(viscous_time)
    return DMT(viscous_time, FRICTIONS.index(friction), **{name: float(value) for name, value in numbers.items()})
