"""Constants of an adhesive contact of two spheres at rest (Sect. 4), which aggregates need too, not only the engine."""

import math

from ratd.base.jit import jit

__all__ = [
    "equilibrium_compression",
    "equilibrium_contact_radius",
    "pull_off_force",
    "reduced_radius",
    "rolling_energy",
    "touching_distance",
]


@jit
def reduced_radius(a_i, a_j):
    """R = a_i a_j/(a_i + a_j) [m] of two spheres (Sect. 4)."""
    return a_i * a_j / (a_i + a_j)


@jit
def equilibrium_contact_radius(R, surface_energy, reduced_modulus):
    """Radius of the contact area at rest, r0 = (9 pi gamma R^2/E*)^(1/3) [m] (Eq. 10).

    Parameters
    ----------
    R : float
        Reduced radius [m].
    surface_energy : float
        gamma [J m-2].
    reduced_modulus : float
        E* [Pa].
    """
    return (9.0 * math.pi * surface_energy * R * R / reduced_modulus) ** (1.0 / 3.0)


@jit
def pull_off_force(R, surface_energy):
    """Greatest pull that a contact holds, F_C = 3 pi gamma R [N] (Eq. 12), with R [m] and gamma [J m-2]."""
    return 3.0 * math.pi * surface_energy * R


@jit
def equilibrium_compression(R, surface_energy, reduced_modulus):
    """Compression of a contact at rest, delta_0 = r0^2/(3 R) [m].

    The paper prints r0/(3 R), which is not a length.

    Parameters
    ----------
    R : float
        Reduced radius [m].
    surface_energy : float
        gamma [J m-2].
    reduced_modulus : float
        E* [Pa].
    """
    r0 = equilibrium_contact_radius(R, surface_energy, reduced_modulus)
    return r0 * r0 / (3.0 * R)


@jit
def touching_distance(a_i, a_j, surface_energy, reduced_modulus):
    """Distance of the centres of two spheres of radii a_i, a_j [m] at rest, a_i + a_j - delta_0 [m]."""
    return a_i + a_j - equilibrium_compression(reduced_radius(a_i, a_j), surface_energy, reduced_modulus)


def rolling_energy(R, surface_energy, critical_rolling_displacement):
    """Energy that rolling round an equal sphere by a quarter of a circle costs, E_roll = 12 pi^2 gamma R xi_c [J].

    Parameters
    ----------
    R : float
        Reduced radius [m].
    surface_energy : float
        gamma [J m-2].
    critical_rolling_displacement : float
        xi_c [m].

    Notes
    -----
    The limiting torque of rolling, 4 F_C xi_c, times pi, by which the two then turn against each other.

    References
    ----------
    Dominik & Tielens (1997), ApJ 480, 647; Kataoka et al. (2013), A&A 554, A4, Eq. 1 (6 pi^2 gamma r_0 xi_c for equal
    spheres).
    """
    return 4.0 * math.pi * pull_off_force(R, surface_energy) * critical_rolling_displacement
