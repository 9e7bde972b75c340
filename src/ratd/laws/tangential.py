"""Sliding, rolling and twisting of two spheres in contact, with their inelastic limits.

Each monomer of a contact carries a contact pointer, a unit vector from its centre to the contact, fixed in the
monomer (Dominik & Nuebold 2002). All displacements follow from the two pointers, the direction n_c from j to i, and
the twisting angle.

Vectors are passed as three numbers each, so that the compiler can treat many contacts at once.
"""

import math

from ratd.base.fastmath import rough_reciprocal_root
from ratd.base.jit import jit

TWISTING_LIMIT = 1.0 / (16.0 * math.pi)
"""phi_c [rad], critical twisting angle (Sect. 6 of the paper)."""


@jit
def sliding_stiffness(equilibrium_contact_radius, sliding_modulus):
    """k_s [N m-1] = 8 r0 G*, with G* = G/(2(2 - nu)) for two equal materials (Mindlin 1949).

    Printed with G* = G/(2 - 2 nu^2), 1.9 times stiffer (Reissl et al. 2024, Eq. 13).
    """
    return 8.0 * equilibrium_contact_radius * sliding_modulus


@jit
def sliding_limit(equilibrium_contact_radius, poisson_number):
    """zeta_c [m] = r0 (2 - nu)/(16 pi) (printed 1 - nu; docs/model/laws.md)."""
    return equilibrium_contact_radius * (2.0 - poisson_number) / (16.0 * math.pi)


@jit
def rolling_stiffness(pull_off_force, reduced_radius):
    """k_r [N m] = 4 F_C R: rolling torque on i is -k_r n_i x n_j, potential k_r |n_i + n_j|^2/2 (Eq. 16)."""
    return 4.0 * pull_off_force * reduced_radius


@jit
def twisting_stiffness(equilibrium_contact_radius, twisting_modulus):
    """k_t [N m rad-1] = 16/3 G' r0^3 with G' = G/2 for equal materials (printed G*; Reissl et al. 2024, Eq. 17)."""
    return 16.0 / 3.0 * twisting_modulus * equilibrium_contact_radius**3


@jit(forceinline=True)
def rotate_pointer(nx, ny, nz, tx, ty, tz):
    """Turn a vector by the rotation whose half-angle vector is t = w dt/2: n + 2 t x n + 2 t x (t x n).

    The turning angle is |w| dt up to a relative error of (w dt)^2/6, and the length grows by a part of at most
    (w dt)^4/8: `nearly_unit` takes that back.
    """
    ux = ty * nz - tz * ny
    uy = tz * nx - tx * nz
    uz = tx * ny - ty * nx
    return (
        nx + 2.0 * (ux + (ty * uz - tz * uy)),
        ny + 2.0 * (uy + (tz * ux - tx * uz)),
        nz + 2.0 * (uz + (tx * uy - ty * ux)),
    )


@jit(forceinline=True)
def sliding_displacement(a_i, nix, niy, niz, a_j, njx, njy, njz, ncx, ncy, ncz):
    """Sliding displacement zeta = w - (w.n_c) n_c [m] with w = a_i n_i - a_j n_j.

    Returns
    -------
    tuple of float
        w.n_c [m] and the three components of zeta [m].

    Notes
    -----
    docs/model/laws.md. Eq. 14 is printed with signs that make it measure rolling.
    """
    wx = a_i * nix - a_j * njx
    wy = a_i * niy - a_j * njy
    wz = a_i * niz - a_j * njz
    wn = wx * ncx + wy * ncy + wz * ncz
    return wn, wx - wn * ncx, wy - wn * ncy, wz - wn * ncz


@jit(forceinline=True)
def excess_fraction(square):
    """Part of a displacement that lies beyond its limit: max(0, 1 - limit/|displacement|).

    Parameters
    ----------
    square : float
        Square of the displacement over its limit.
    """
    return 1.0 - rough_reciprocal_root(max(1.0, square))


@jit(forceinline=True)
def slide_back(fraction, inv_sum, nix, niy, niz, njx, njy, njz, zx, zy, zz):
    """Pointers after the excess Delta = fraction * zeta has slipped: n_i -= Delta/(a_i+a_j), n_j += the same.

    `inv_sum` is 1/(a_i + a_j). n_i + n_j, hence the rolling displacement, stays as it is. The pointers are no longer
    unit vectors.
    """
    g = fraction * inv_sum
    return nix - g * zx, niy - g * zy, niz - g * zz, njx + g * zx, njy + g * zy, njz + g * zz


@jit(forceinline=True)
def roll_back(fraction, inv_sum, a_i, nix, niy, niz, a_j, njx, njy, njz):
    """Pointers after the excess Delta = fraction * R (n_i + n_j) has rolled off: n_k -= Delta/a_k.

    `inv_sum` is 1/(a_i + a_j). a_i n_i - a_j n_j, hence the sliding displacement, stays as it is. The pointers are no
    longer unit vectors.
    """
    g = fraction * inv_sum
    g_i = g * a_j  # R/a_i
    g_j = g * a_i
    x = nix + njx
    y = niy + njy
    z = niz + njz
    return nix - g_i * x, niy - g_i * y, niz - g_i * z, njx - g_j * x, njy - g_j * y, njz - g_j * z


@jit(forceinline=True)
def nearly_unit(x, y, z):
    """Unit vector from one whose length differs from 1 by e << 1, to second order in e (no root, no division)."""
    f = 1.5 - 0.5 * (x * x + y * y + z * z)
    return f * x, f * y, f * z
