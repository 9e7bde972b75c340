"""How long a contact holds a pull that is below the greatest one: heat carries it over the barrier that is left.

A pull F at which a contact breaks by itself is the greatest one of its law: F_C (JKR), 4 pi gamma R (DMT). Below it the
energy of the contact and of the pull has a minimum, where the contact rests, and an end, beyond which it parts. The
difference of the two is the barrier. A load is F over the greatest pull, from 0 to 1.
"""

import math

import numpy as np
import pandas as pd
from scipy.constants import Boltzmann, electron_volt
from scipy.optimize import brentq

from ratd.base.errors import InputError
from ratd.base.materials import get_material, sphere_mass
from ratd.base.units import NM
from ratd.laws import contact_constants, derjaguin_muller_toporov
from ratd.laws.johnson_kendall_roberts import S_END, compression_of, equilibrium_stiffness, normal_potential

__all__ = [
    "HOUR",
    "REACH",
    "attempt_frequency",
    "contact_barriers",
    "dmt_barrier",
    "jkr_barrier",
    "life_temperature",
    "mean_life",
    "pull_off_share",
    "table",
]

HOUR = 3600.0
"""Time of a spin-up [s] in Reissl et al. (2024), Sect. 6, who say that in space it is days to centuries."""
REACH = 0.17e-9
"""Closest distance z0 of two surfaces [m], the least of the values in use (0.17 to 0.4 nm; Israelachvili 2011)."""


def jkr_barrier(load, pull_off_force, equilibrium_compression):
    """Barrier of a JKR contact under a constant pull.

    Parameters
    ----------
    load : array_like
        F/F_C, 0 to 1.
    pull_off_force : float
        F_C [N].
    equilibrium_compression : float
        delta_0 [m].

    Returns
    -------
    numpy.ndarray or float
        [J], of the shape of `load`.

    Notes
    -----
    U + F delta at the end less that at rest, with the law of `ratd.laws.johnson_kendall_roberts`. With y = x^(3/2) a
    pull F is balanced where 4 (y - y^2) = F/F_C. The greater y is stable, the smaller one is the top of the barrier.
    Below 5/9 F_C the smaller one lies beyond the end of the branch; the barrier then ends there, with the contact. At
    no load it is 1.273 F_C delta_0. Towards F_C it is (8/9) 2^(2/3) (1 - F/F_C)^(3/2) F_C delta_0.

    The contact area follows the distance at once, as in the engine. An area that fluctuates by itself reaches the
    smaller y also below 5/9 F_C, which takes a little less: 1.2 F_C delta_0 at no load.
    """
    load = _load(load)
    root = np.sqrt(1.0 - load)
    s_rest = np.cbrt(0.5 * (1.0 + root))
    s_top = np.maximum(np.cbrt(0.5 * (1.0 - root)), S_END)
    at_top, at_rest = (
        normal_potential(s, pull_off_force, equilibrium_compression)
        + load * pull_off_force * equilibrium_compression * compression_of(s)
        for s in (s_top, s_rest)
    )
    return at_top - at_rest


def dmt_barrier(load, adhesion_force, equilibrium_overlap, reach=0.0):
    """Barrier of a DMT contact under a constant pull.

    Parameters
    ----------
    load : array_like
        F/(4 pi gamma R), 0 to 1.
    adhesion_force : float
        F_a = 4 pi gamma R [N].
    equilibrium_overlap : float
        delta_eq [m].
    reach : float
        z0 [m], how far the adhesion reaches; 0: it ends with the contact, as in the engine.

    Returns
    -------
    numpy.ndarray or float
        [J], of the shape of `load`.

    Notes
    -----
    Up to the overlap 0 it is 3/5 F_a delta_eq (1 - F/F_a)^(5/3), with the law of `ratd.laws.derjaguin_muller_toporov`.
    Van der Waals forces do not end there: at the distance d between the surfaces they are F_a (z0/(z0 + d))^2
    (Derjaguin 1934, Hamaker 1937), 2 gamma being the energy per area at z0. They balance the pull at z0 + d =
    z0 sqrt(F_a/F), and up to there add F_a z0 (1 - sqrt(F/F_a))^2. The monomers of space dust have z0 >> delta_eq, so
    that this is most of the barrier: the DMT law alone, and the JKR law, which has no reach, are lower limits for them.
    """
    load = _load(load)
    contact = 0.6 * equilibrium_overlap * (1.0 - load) ** (5.0 / 3.0)
    return adhesion_force * (contact + reach * (1.0 - np.sqrt(load)) ** 2)


def attempt_frequency(stiffness, reduced_mass):
    """How often a contact tries to part: its frequency [Hz] at rest, sqrt(k/m_red)/(2 pi), k [N m-1], m_red [kg].

    Under a load it is lower. What is left then of the stiffness matters only as its logarithm.
    """
    return np.sqrt(stiffness / reduced_mass) / (2.0 * math.pi)


def mean_life(barrier, temperature, frequency, damping_ratio=0.0):
    """Mean life of a contact before heat breaks it.

    Parameters
    ----------
    barrier : array_like
        [J].
    temperature : array_like
        [K].
    frequency : array_like
        `attempt_frequency` [Hz].
    damping_ratio : array_like
        zeta of the contact at rest; 0 gives the life of transition state theory, which is the shortest.

    Returns
    -------
    numpy.ndarray or float
        [s]: exp(barrier/kT)/(frequency (sqrt(1 + zeta^2) - zeta)).

    References
    ----------
    Kramers (1940), Physica 7, 284; the top is taken to be as curved as the rest.
    """
    slowed = np.sqrt(1.0 + np.square(damping_ratio)) - damping_ratio
    return np.exp(np.asarray(barrier) / (Boltzmann * np.asarray(temperature))) / (frequency * slowed)


def life_temperature(barrier, frequency, duration):
    """Temperature at which a contact lives for a given time on average.

    Parameters
    ----------
    barrier : array_like
        [J]; `contact_barriers` has that of a contact of given radii and load.
    frequency : array_like
        `attempt_frequency` [Hz].
    duration : array_like
        [s], longer than one attempt.

    Returns
    -------
    numpy.ndarray or float
        [K], barrier/(k ln(frequency duration)). Warmer contacts live shorter.

    Raises
    ------
    InputError
        If the duration is no longer than one attempt.
    """
    return np.asarray(barrier) / (Boltzmann * _attempts(frequency, duration))


def pull_off_share(barrier_of, temperature, frequency, duration):
    """Pull that a contact holds for a given time, over the greatest one.

    Parameters
    ----------
    barrier_of : callable
        Barrier [J] of a load.
    temperature : float
        [K].
    frequency : float
        `attempt_frequency` [Hz].
    duration : float
        [s], longer than one attempt.

    Returns
    -------
    float
        Load at which the mean life is the duration, barrier = kT ln(frequency duration); 0 where heat breaks the
        contact without any. A load that grows all the time, as in a spin-up, breaks it at a slightly greater one.

    Raises
    ------
    InputError
        If the duration is no longer than one attempt.
    """
    needed = Boltzmann * temperature * float(_attempts(frequency, duration))
    if barrier_of(0.0) <= needed:
        return 0.0
    return float(brentq(lambda load: float(barrier_of(load)) - needed, 0.0, 1.0, xtol=1e-12))


def contact_barriers(material, radius, reach=REACH):
    """Barriers of the contact of two equal monomers, by each law.

    Parameters
    ----------
    material : str or Material
    radius : float
        Of each monomer [m].
    reach : float
        Of the adhesion, see `dmt_barrier` [m].

    Returns
    -------
    dict
        "JKR", "DMT" and "DMT with reach" -> (barrier [J] as a function of the load, attempt frequency [Hz]).
    """
    material = get_material(material)
    gamma, modulus = material.surface_energy, material.reduced_modulus
    reduced_mass = 0.5 * sphere_mass(radius, material.density)
    reduced = contact_constants.reduced_radius(radius, radius)
    force = contact_constants.pull_off_force(reduced, gamma)
    compression = contact_constants.equilibrium_compression(reduced, gamma, modulus)
    adhesion = derjaguin_muller_toporov.adhesion_force(reduced, gamma)
    hertz = derjaguin_muller_toporov.hertz_stiffness(reduced, modulus)
    overlap = derjaguin_muller_toporov.equilibrium_overlap(hertz, adhesion)
    jkr = attempt_frequency(equilibrium_stiffness(force, compression), reduced_mass)
    dmt = 1.0 / derjaguin_muller_toporov.vibration_period(reduced_mass, hertz, overlap)
    return {
        "JKR": (lambda load: jkr_barrier(load, force, compression), jkr),
        "DMT": (lambda load: dmt_barrier(load, adhesion, overlap), dmt),
        "DMT with reach": (lambda load: dmt_barrier(load, adhesion, overlap, reach), dmt),
    }


def table(
    materials=("a-C", "q-S", "co-S"),
    radii=(10 * NM, 20 * NM, 30 * NM, 50 * NM, 100 * NM),
    temperatures=(20.0, 100.0, 300.0, 1000.0),
    duration=HOUR,
    reach=REACH,
):
    """What heat leaves of the strength of contacts in a spin-up.

    Parameters
    ----------
    materials : sequence of str or Material
    radii : sequence of float
        Of two equal monomers [m].
    temperatures : sequence of float
        [K].
    duration : float
        Of the spin-up [s].
    reach : float
        Of the adhesion in "DMT with reach" [m].

    Returns
    -------
    pandas.DataFrame
        A row a material, law, radius and temperature: material, law, radius, temperature; barrier_eV and barrier_kT at
        no load; life [s] at no load; life_temperature [K] of the duration; pull_off, what `pull_off_share` says of it;
        omega, the root of that: the angular velocity of disruption, if all contacts were such, over that without heat.
    """
    rows = []
    for material in map(get_material, materials):
        for radius in radii:
            for law, (barrier_of, frequency) in contact_barriers(material, radius, reach).items():
                barrier = float(barrier_of(0.0))
                for temperature in temperatures:
                    share = pull_off_share(barrier_of, temperature, frequency, duration)
                    row = {"material": material.name, "law": law, "radius": radius, "temperature": temperature}
                    row |= {"barrier_eV": barrier / electron_volt, "barrier_kT": barrier / (Boltzmann * temperature)}
                    with np.errstate(over="ignore"):  # a life longer than any number is infinite
                        row["life"] = float(mean_life(barrier, temperature, frequency))
                    row["life_temperature"] = float(life_temperature(barrier, frequency, duration))
                    rows.append(row | {"pull_off": share, "omega": math.sqrt(share)})
    return pd.DataFrame(rows)


def _load(load):
    """A load as an array, checked."""
    load = np.asarray(load, dtype=float)
    if not np.all((load >= 0.0) & (load <= 1.0)):
        raise InputError("The load of a contact is the pull over the greatest one, and must lie from 0 to 1.")
    return load


def _attempts(frequency, duration):
    """ln of how often a contact tries to part within a time."""
    attempts = np.asarray(frequency) * np.asarray(duration)
    if not np.all(attempts > 1.0):
        raise InputError("The time that a contact is to live must be longer than one attempt, 1/frequency.")
    return np.log(attempts)
