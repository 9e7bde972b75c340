"""Normal contact of two adhesive elastic spheres (Derjaguin, Muller & Toporov 1975), as formulae.

The force is K delta^(3/2) - 4 pi gamma R, at an overlap delta of at least 0 (Umstaetter & Urbassek 2020, A&A 633, A24).
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
