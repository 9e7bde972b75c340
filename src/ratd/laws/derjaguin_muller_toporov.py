"""Normal contact of two adhesive elastic spheres (Derjaguin, Muller & Toporov 1975), as formulae.

The force is K delta^(3/2) - 4 pi gamma R, at an overlap delta of at least 0 (Umstaetter & Urbassek 2020, A&A 633, A24).

The functions `dmt_...` give the same in the units of the law of Johnson, Kendall & Roberts, r0, delta_0 and F_C: with
r^2 = R delta the compression is delta/delta_0 = 3 x^2 = 3 s^4, where x = r/r0 and s = sqrt(x).
"""

import math

from ratd.base.jit import jit


@jit
def adhesion_force(reduced_radius, surface_energy):
    """Adhesion 4 pi gamma R [N], the same at any overlap (Umstaetter & Urbassek 2020, Sect. 2.1)."""
    return 4.0 * math.pi * surface_energy * reduced_radius


@jit
def hertz_stiffness(reduced_radius, reduced_modulus):
    """K [N m^-3/2] of the force K delta^(3/2): 4/3 E* sqrt(R), which is 2/3 Y/(1 - nu^2) sqrt(R) of equal spheres."""
    return 4.0 / 3.0 * reduced_modulus * math.sqrt(reduced_radius)


@jit
def equilibrium_overlap(hertz_stiffness, adhesion_force):
    """delta_eq [m] = (4 pi gamma R/K)^(2/3), Eq. 1."""
    return (adhesion_force / hertz_stiffness) ** (2.0 / 3.0)


@jit
def breaking_energy(adhesion_force, equilibrium_overlap):
    """Energy [J] that parts two spheres at rest, E_break = 3/5 4 pi gamma R delta_eq, Eq. 2 (its last line)."""
    return 0.6 * adhesion_force * equilibrium_overlap


@jit
def vibration_period(reduced_mass, hertz_stiffness, equilibrium_overlap):
    """Period [s] of small undamped vibrations about delta_eq: 2 pi sqrt(m_red/(3/2 K sqrt(delta_eq)))."""
    return 2.0 * math.pi * math.sqrt(reduced_mass / (1.5 * hertz_stiffness * math.sqrt(equilibrium_overlap)))


def impact_duration(reduced_mass, reduced_radius, reduced_modulus, speed):
    """Time for which two elastic spheres touch that meet head-on, without adhesion.

    Parameters
    ----------
    reduced_mass : float
        Of the two [kg].
    reduced_radius : float
        [m]
    reduced_modulus : float
        E* [Pa].
    speed : float
        At which they meet [m/s].

    Returns
    -------
    float
        [s]; K. L. Johnson, Contact Mechanics (1985), Eq. 11.24.
    """
    return 2.87 * (reduced_mass**2 / (reduced_radius * reduced_modulus**2 * speed)) ** 0.2


@jit(forceinline=True)
def dmt_state(compression):
    """s = sqrt(r/r0) of a contact from its compression delta/delta_0 of at least 0: (delta/(3 delta_0))^(1/4)."""
    return math.sqrt(math.sqrt(compression * (1.0 / 3.0)))


@jit(forceinline=True)
def dmt_force(s, pull_off_force):
    """Normal force [N] along n_c, positive when it pushes the spheres apart: 4 F_C (x^3 - 1/3).

    Parameters
    ----------
    s : float
        sqrt(r/r0).
    pull_off_force : float
        F_C = 3 pi gamma R [N], that of Johnson, Kendall & Roberts: this law holds 4/3 of it, at s = 0.
    """
    s3 = s * s * s
    return 4.0 * pull_off_force * (s3 * s3 - 1.0 / 3.0)


@jit(forceinline=True)
def dmt_potential(s, pull_off_force, equilibrium_compression):
    """Potential energy [J] of the normal force, zero for separated spheres: 4 F_C delta_0 (6/5 x^5 - x^2).

    Parameters
    ----------
    s : float
        sqrt(r/r0).
    pull_off_force, equilibrium_compression : float
        F_C [N] and delta_0 [m] of Johnson, Kendall & Roberts.
    """
    x = s * s
    return 4.0 * pull_off_force * equilibrium_compression * x * x * (1.2 * x * x * x - 1.0)
