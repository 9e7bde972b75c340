"""Strengths of aggregates, as fitted by others to simulations and experiments, and the tension in a turning one."""

import math

import numpy as np

from ratd.laws.contact_constants import rolling_energy

__all__ = [
    "PHI_MAX",
    "TENSILE_FACTOR",
    "compressive_strength_kataoka2013",
    "compressive_strength_tatsuuma2023",
    "filling_factor_guettler2009",
    "midplane_tension",
    "rolling_pressure",
    "sound_speed_kataoka2013",
    "tensile_strength_tatsuuma2019",
]

PHI_MAX = 0.74
"""phi_max of Tatsuuma et al. (2023): close packing of equal spheres."""
TENSILE_FACTOR = 0.6
"""S a_mon/(gamma phi^1.8) of Tatsuuma et al. (2019)."""


def rolling_pressure(surface_energy, critical_rolling_displacement, monomer_radius):
    """P_0 = E_roll/r_0^3 [Pa], E_roll being the energy that rolling by a quarter of a circle costs.

    Parameters
    ----------
    surface_energy : float
        gamma [J m-2].
    critical_rolling_displacement : float
        xi_c [m].
    monomer_radius : float
        r_0 [m].

    References
    ----------
    Kataoka et al. (2013), A&A 554, A4, Eqs. 1 and 25.
    """
    return rolling_energy(0.5 * monomer_radius, surface_energy, critical_rolling_displacement) / monomer_radius**3


def compressive_strength_kataoka2013(filling_factor, rolling_pressure):
    """P = P_0 phi^3 [Pa]; Kataoka et al. (2013), A&A 554, A4, Eq. 25, with P_0 of `rolling_pressure`."""
    return rolling_pressure * np.asarray(filling_factor) ** 3


def compressive_strength_tatsuuma2023(filling_factor, rolling_pressure, largest=PHI_MAX):
    """P = P_0 (1/phi - 1/phi_max)^-3 [Pa], for high filling factors too.

    References
    ----------
    Tatsuuma, Kataoka, Okuzumi & Tanaka (2023), ApJ 953, 6, as recalled.
    """
    return rolling_pressure / (1.0 / np.asarray(filling_factor) - 1.0 / largest) ** 3


def power_kataoka2013(dimension):
    """Power of phi with which P goes where the monomers of a cluster go as this power of its radius: 3/(3 - D).

    A part of the radius r is pressed as soon as it fills its share of the box, phi ~ r^(D - 3), by E_roll/r^3.

    References
    ----------
    Kataoka et al. (2013), A&A 554, A4, Sect. 4, who have D = 2 and so the power 3; derived here for another D.
    """
    return 3.0 / (3.0 - dimension)


def power_tatsuuma2023(filling_factor, largest=PHI_MAX):
    """d ln P/d ln phi of `compressive_strength_tatsuuma2023`, 3/(1 - phi/phi_max)."""
    return 3.0 / (1.0 - np.asarray(filling_factor) / largest)


def sound_speed_kataoka2013(filling_factor, rolling_pressure, density):
    """Effective speed of sound sqrt(P_0/(4/3 pi rho_0)) phi [m/s].

    References
    ----------
    Kataoka et al. (2013), A&A 554, A4, Eq. 27, with the mass m_0 = 4/3 pi rho_0 r_0^3 where they have rho_0 r_0^3 in
    between; Eq. 28 is the value with m_0.
    """
    return math.sqrt(rolling_pressure / (4.0 / 3.0 * math.pi * density)) * np.asarray(filling_factor)


def filling_factor_guettler2009(pressure):
    """Filling factor of compressed dust cakes of silica, phi = phi_2 - (phi_2 - phi_1)/(exp((lg P/P_m)/D) + 1).

    Parameters
    ----------
    pressure : array_like
        P [Pa].

    Notes
    -----
    phi_1 = 0.12, phi_2 = 0.58, D = 0.58, P_m = 13 kPa, all as recalled (Guettler et al. 2009, ApJ 701, 130). At 300 Pa
    this gives 0.146, where Kataoka et al. (2013) read 0.17 from it.
    """
    low, high, width, middle = 0.12, 0.58, 0.58, 13e3
    return high - (high - low) / (np.exp(np.log10(np.asarray(pressure) / middle) / width) + 1.0)


def tensile_strength_tatsuuma2019(surface_energy, monomer_radius, filling_factor):
    """Tensile strength S = 0.6 gamma/a_mon phi^1.8 [Pa].

    Parameters
    ----------
    surface_energy : float
        gamma [J m-2].
    monomer_radius : float
        a_mon [m] (r_0 in the source: the radius of the monomers, not that of a contact).
    filling_factor : float
        phi [1].

    Notes
    -----
    Tatsuuma, Kataoka & Tanaka 2019, ApJ 874, 159: a fit to pulled aggregates of equal monomers. The paper could not be
    opened; the factor is that of programs of others that use its formula, such as Phantom (src/main/porosity.f90). A
    factor of 0.951 is told as well. It is a slip: for gamma = 0.1 J m-2 and a_mon = 0.1 um the formula is 9.51 kPa
    (phi/0.1)^1.8, and 0.951 keeps the digits and forgets the 0.1.
    """
    return TENSILE_FACTOR * surface_energy / monomer_radius * filling_factor**1.8


def midplane_tension(omega, density, filling_factor, outer_radius):
    """Mean tension across the plane through the axis of a turning porous sphere, rho phi omega^2 a_out^2/4 [Pa].

    Half the sphere, of mass 2/3 pi rho phi a_out^3 with its centre of mass at 3/8 a_out, pulls at the area pi a_out^2.

    Parameters
    ----------
    omega : float
        Angular velocity [rad s-1].
    density : float
        rho [kg m-3] of the solid.
    filling_factor : float
        phi [1].
    outer_radius : float
        a_out [m].
    """
    return 0.25 * density * filling_factor * (omega * outer_radius) ** 2
