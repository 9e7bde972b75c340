"""How slow is slow: the strain rate of the box, and from which filling factor on a compression is static."""

import math

from ratd.aggregates.strength import sound_speed_kataoka2013
from ratd.base.materials import sphere_mass
from ratd.laws.johnson_kendall_roberts import contact_time

__all__ = [
    "INERTIAL_SHARE",
    "box_rate",
    "box_size",
    "face_speed",
    "filling_factor_bcca",
    "inertial_tension",
    "slower_than_sound_from",
    "static_from",
    "time_unit",
]

INERTIAL_SHARE = 0.05
"""Part of P_0 phi^3 that the pressure of the inertia may be where a compression counts as static."""


def time_unit(material, monomer_radius):
    """Unit of time t_0 [s] of equal monomers.

    Parameters
    ----------
    material : Material
    monomer_radius : float
        r_0 [m].

    References
    ----------
    Kataoka et al. (2013), A&A 554, A4, Eq. 2, with E* where they print E; see `contact_time`.
    """
    mass = sphere_mass(monomer_radius, material.density)
    return contact_time(0.5 * mass, 0.5 * monomer_radius, material.reduced_modulus, material.surface_energy)


def box_rate(strain_rate, time_unit):
    """H = (dL/dt)/L = -2 C_v/t_0 [1/s] of a box that shrinks with the strain rate C_v.

    References
    ----------
    Kataoka et al. (2013), A&A 554, A4, Eqs. 6 and 7.
    """
    return -2.0 * strain_rate / time_unit


def box_size(n, monomer_radius, filling_factor):
    """Edge L = (4/3 pi N/phi)^(1/3) r_0 [m] of the box that N monomers of the radius r_0 [m] fill to phi."""
    return (4.0 / 3.0 * math.pi * n / filling_factor) ** (1.0 / 3.0) * monomer_radius


def face_speed(rate, n, monomer_radius, filling_factor):
    """v_d = |H| L [m/s], with which two opposite faces of the box approach each other.

    References
    ----------
    Kataoka et al. (2013), A&A 554, A4, Eq. 26.
    """
    return abs(rate) * box_size(n, monomer_radius, filling_factor)


def filling_factor_bcca(n):
    """phi = (3/5)^(3/2) N^(-1/2) of a cluster with r_g = N^(1/2) r_0; Kataoka et al. (2013), A&A 554, A4, Eq. 24."""
    return 0.6**1.5 / math.sqrt(n)


def static_from(rate, n, monomer_radius, density, rolling_pressure):
    """Filling factor from which on inertia is small: rho (H L)^2/8 = 0.05 P_0 phi^3.

    Parameters
    ----------
    rate : float
        H [1/s].
    n : int
        Number of monomers.
    monomer_radius : float
        r_0 [m].
    density : float
        rho_0 [kg m-3] of the solid.
    rolling_pressure : float
        P_0 [Pa].

    Returns
    -------
    float

    Notes
    -----
    rho = rho_0 phi, and L is that of `box_size`. A box of the size L that shrinks at the rate H carries the mean
    square speed (H L)^2/4 along each axis at its faces, of which the mean over the box is a third; rho (H L)^2/8 is by
    how much the pressure differs between a box that carries everything along and one in which monomers fly straight.
    What stays behind can need more than that: where this measure is just met, clusters of 16 384 press two to three
    times as much as in a slower squeeze (docs/compression.md, "Looser").
    """
    size = box_size(n, monomer_radius, 1.0)
    return (density * (rate * size) ** 2 / (8.0 * INERTIAL_SHARE * rolling_pressure)) ** 0.375


def inertial_tension(rate, size, density, strain):
    """Tension [Pa] that an aggregate at rest shows when its box begins to grow, in a mean over the first ln L.

    Parameters
    ----------
    rate : float
        H [1/s], at which the box grows along an axis.
    size : float
        L [m], its edge there.
    density : float
        rho [kg m-3], the mean one in the box.
    strain : float
        ln L over which the mean is taken.

    Returns
    -------
    float

    Notes
    -----
    The box carries everything along with the speed H x. What is not held by its copies takes this motion back by its
    own contacts, whatever they bear: their tension times its duration, strain/H, is sum m H x^2 over the volume, that
    is rho H L^2/12. Derived here; a test pulls a cluster that does not hold to its copies.
    """
    return density * (rate * size) ** 2 / (12.0 * strain)


def slower_than_sound_from(rate, n, monomer_radius, density, rolling_pressure, part=1.0):
    """Filling factor from which on the faces of the box are slower than a part of the speed of sound in the cluster.

    Parameters
    ----------
    rate, n, monomer_radius, density, rolling_pressure
        As of `static_from`.
    part : float
        Of the speed of sound.

    Returns
    -------
    float

    Notes
    -----
    The speed of the faces goes as phi^(-1/3) and that of sound as phi (Kataoka et al. 2013, A&A 554, A4, Eqs. 26 and
    27).
    """
    sound = part * float(sound_speed_kataoka2013(1.0, rolling_pressure, density))
    return (face_speed(rate, n, monomer_radius, 1.0) / sound) ** 0.75
