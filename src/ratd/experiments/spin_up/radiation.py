"""What follows for dust: how fast radiation turns a grain, and which sizes that tears apart.

Radiative torques against drag by gas and by the grain's own infrared light, after Hoang et al. (2019, Nature Astronomy
3, 766), Hoang (2019, ApJ 876, 13) and Hoang (2020, Galaxies 8, 52), in SI units. Their rounded numbers are no input
here, but for `INFRARED`; how far they are from these formulae stands with each function. The text of the papers was not
at hand; the formulae are those of DustPOL-py, a public code of the same group (Tram, Lee & Hoang).
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.constants import Boltzmann, Planck, physical_constants, speed_of_light

from ratd.base.errors import InputError

__all__ = [
    "DIFFUSE",
    "INFRARED",
    "ISRF",
    "SEARCHED",
    "Surroundings",
    "destroyed_sizes",
    "energy_density",
    "gas_damping_time",
    "gas_drag",
    "grain_temperature",
    "infrared_coefficient",
    "infrared_damping",
    "infrared_of",
    "moment_of_inertia",
    "omega_rat",
    "radiative_torque",
    "spin_up_time",
    "torque_efficiency",
]

ISRF = 8.64e-14
"""Energy density of starlight near the sun [J m-3] (Mathis, Mezger & Panagia 1983), U = 1."""
INFRARED = 0.4
"""F_IR of a grain of 0.1 um at U = 1, n_H = 30 cm-3, T = 100 K, as printed (after Draine & Lazarian 1998). An input:
it depends on how the grain absorbs, see `infrared_coefficient`; near that of graphite."""
SILICATE_ABSORPTION = 0.18
"""Q_abs of a grain of silicate of 0.1 um, averaged over starlight (Draine 2011, Physics of the ISM, Sect. 24.1)."""
SILICATE_TEMPERATURE = 16.4
"""Of a grain of silicate of 0.1 um at U = 1 [K], from the same place."""
SILICATES = ("q-S", "co-S")
"""Materials that absorb and glow as silicate; the others do as graphite here."""
SEARCHED = (10e-9, 10e-6)
"""Sizes [m] among which those that are destroyed are sought: from the smallest monomer on."""
_HELIUM = 1.2
"""Drag by hydrogen and helium over that by hydrogen alone: 10 % of the atoms, 4 times the mass, half the speed."""
_HYDROGEN = physical_constants["proton mass"][0] + physical_constants["electron mass"][0]
_STEPS = 1200


class Surroundings(NamedTuple):
    """Gas and light around a grain; the defaults are the diffuse interstellar medium.

    Attributes
    ----------
    hydrogen : float
        Number density n_H of hydrogen nuclei [m-3].
    temperature : float
        Of the gas [K].
    anisotropy : float
        gamma_rad: 0.1 for the diffuse field, 1 for a single star.
    wavelength : float
        Mean of the light [m]: 1.2 um for the diffuse field, 0.5 um near a hot star.
    """

    hydrogen: float = 30e6
    temperature: float = 100.0
    anisotropy: float = 0.1
    wavelength: float = 1.2e-6


DIFFUSE = Surroundings()
"""The diffuse interstellar medium."""


def energy_density(strength):
    """Energy density of light [J m-3] of a strength U, U times that near the sun."""
    return ISRF * np.asarray(strength)


def torque_efficiency(size, wavelength):
    """Q_Gamma of the torque of light, averaged over its spectrum: 2 (lambda/a)^-2.7, and 0.4 above lambda/1.8.

    Parameters
    ----------
    size : array_like
        a [m].
    wavelength : float
        Mean of the light [m].

    Notes
    -----
    Hoang & Lazarian (2014, MNRAS 438, 680). The two meet within 3 %. For light of one wavelength it is 0.4 (lambda/
    (1.8 a))^-3 = 2.3 (lambda/a)^-3 (Lazarian & Hoang 2007): the 2.3 does not go with the exponent 2.7.
    """
    ratio = wavelength / np.asarray(size)
    return np.where(ratio > 1.8, 2.0 * ratio**-2.7, 0.4)


def radiative_torque(size, strength, around=DIFFUSE):
    """Torque of light on a grain [N m]: pi a^2 gamma_rad u lambda/(2 pi) Q_Gamma.

    Parameters
    ----------
    size : array_like
        a [m]; of a porous grain that of as much solid, a_eff.
    strength : array_like
        U.
    around : Surroundings

    Notes
    -----
    This defines Q_Gamma: Draine & Weingartner (1996, ApJ 470, 551); user guide of DDSCAT. Papers on disruption print
    pi a^2 gamma_rad u (lambda/2) Q_Gamma, pi times this, but their numbers are without that pi: 5.8e-29 and 8.6e-28 erg
    at a = 0.1 um, lambda = 0.5 um, gamma_rad = 1, U = 1 are 1.04 and 1.00 times this.
    """
    size = np.asarray(size)
    pressure = around.anisotropy * energy_density(strength)
    return 0.5 * size**2 * pressure * around.wavelength * torque_efficiency(size, around.wavelength)


def moment_of_inertia(size, density, inertia_ratio=1.0):
    """I [kg m2] of a grain of size a [m] and density [kg m-3] of the solid, 8/15 pi rho a^5 times `inertia_ratio`."""
    return 8.0 / 15.0 * math.pi * density * np.asarray(size) ** 5 * inertia_ratio


def gas_drag(size, around=DIFFUSE, inertia_ratio=1.0):
    """Drag of gas over angular velocity [N m s]: (4 sqrt(pi)/3) 1.2 n_H m_H sqrt(2kT/m_H) a^4.

    Parameters
    ----------
    size : array_like
        a [m] of as much solid.
    around : Surroundings
    inertia_ratio : array_like
        I of the porous grain over that of as much solid. With the same mass the grain is wider by its root, and the
        drag greater by its square.

    References
    ----------
    Draine & Weingartner (1996), ApJ 470, 551.
    """
    speed = math.sqrt(2.0 * Boltzmann * around.temperature / _HYDROGEN)
    pressure = _HELIUM * around.hydrogen * _HYDROGEN * speed
    return 4.0 * math.sqrt(math.pi) / 3.0 * pressure * np.asarray(size) ** 4 * np.square(inertia_ratio)


def gas_damping_time(size, density, around=DIFFUSE, inertia_ratio=1.0):
    """Time [s] in which gas damps a rotation, I over `gas_drag`.

    The printed 8.74e4 yr (0.1 um, 3 g cm-3, n_H = 30 cm-3, 100 K) is 1.003 times this.
    """
    return moment_of_inertia(size, density, inertia_ratio) / gas_drag(size, around, inertia_ratio)


def spin_up_time(size, density, strength, around=DIFFUSE, inertia_ratio=1.0, coefficient=INFRARED):
    """Time [s] in which light brings a grain near the angular velocity of `omega_rat`: I over all drag.

    A grain that is torn long before it turns so fast takes less, by the part of this angular velocity.
    """
    gas = gas_damping_time(size, density, around, inertia_ratio)
    return gas / (1.0 + infrared_damping(size, strength, around, inertia_ratio, coefficient))


def infrared_damping(size, strength, around=DIFFUSE, inertia_ratio=1.0, coefficient=INFRARED):
    """F_IR, drag by the grain's infrared light over that by gas: 0.4 U^(2/3) (0.1 um/a) (30 cm-3/n_H) (100 K/T)^(1/2).

    Parameters
    ----------
    size, strength, around, inertia_ratio
        As of `omega_rat`. A wider grain has more drag by gas, and no other infrared light.
    coefficient : float
        The 0.4, see `infrared_coefficient`.
    """
    gas = 30e6 / around.hydrogen * math.sqrt(100.0 / around.temperature) / np.square(inertia_ratio)
    return coefficient * np.cbrt(np.square(strength)) * 1e-7 / np.asarray(size) * gas


def grain_temperature(strength, at_one=SILICATE_TEMPERATURE):
    """Temperature [K] of a grain in light of a strength U.

    Parameters
    ----------
    strength : float or array_like
    at_one : float
        The same at U = 1 [K].

    Returns
    -------
    float or array
        at_one U^(1/6): the infrared light of a grain whose absorption grows as the frequency squared goes as T^6
        (Draine 2011, Physics of the ISM, Sect. 24.1).
    """
    return at_one * np.asarray(strength) ** (1.0 / 6.0)


def infrared_coefficient(absorption, dust_temperature):
    """F_IR at 0.1 um, U = 1, n_H = 30 cm-3, T = 100 K from how the grain absorbs.

    Parameters
    ----------
    absorption : float
        Efficiency Q_abs, averaged over starlight, of a grain of 0.1 um.
    dust_temperature : float
        Of this grain at U = 1 [K].

    Returns
    -------
    float
        With the values of Draine (2011, Physics of the ISM, Sect. 24.1) 0.44 for graphite (0.8, 22.3 K), and 0.18 for
        silicate (`SILICATE_ABSORPTION`, `SILICATE_TEMPERATURE`). The printed 0.4 is 0.9 and 2.2 times that.

    Notes
    -----
    A quantum of angular frequency w that a turning dipole emits takes 2 hbar omega/w of angular momentum on average
    (Purcell 1979, ApJ 231, 404). A grain that emits P in all, with an absorption that grows as w^2, so has the drag
    P/(2 pi^2) (h/kT_d)^2 Gamma(4) zeta(4)/(Gamma(6) zeta(6)). Here P = pi a^2 Q_abs c u.
    """
    size = 1e-7
    power = math.pi * size**2 * absorption * speed_of_light * ISRF
    spectrum = 10.5 / (20.0 * math.pi**2) * (Planck / (Boltzmann * dust_temperature)) ** 2
    return float(power / (2.0 * math.pi**2) * spectrum / gas_drag(size))


def infrared_of(material):
    """F_IR of a material by its name, at 0.1 um, U = 1, n_H = 30 cm-3, T = 100 K.

    `infrared_coefficient` of silicate for `SILICATES`, and the printed `INFRARED`, near that of graphite, for others.
    """
    return infrared_coefficient(SILICATE_ABSORPTION, SILICATE_TEMPERATURE) if material in SILICATES else INFRARED


def omega_rat(size, strength, around=DIFFUSE, inertia_ratio=1.0, coefficient=INFRARED, wide=False):
    """Angular velocity at which the drag balances the torque of light.

    Parameters
    ----------
    size : array_like
        a [m]; of a porous grain that of as much solid.
    strength : array_like
        U.
    around : Surroundings
    inertia_ratio : array_like
        I of the porous grain over that of as much solid, see `gas_drag`.
    coefficient : float
        See `infrared_damping`.
    wide : bool
        Whether light finds the porous grain as wide as gas does: its torque is that of a size greater by the root of
        `inertia_ratio`.

    Returns
    -------
    numpy.ndarray or float
        [rad s-1], torque/(drag (1 + F_IR)).

    Notes
    -----
    The moment of inertia itself cancels: a grain that is harder to turn is also damped later, and the density does not
    matter. A porous grain turns slower since gas hits more of it, by `inertia_ratio`^2 where F_IR is small, and not at
    all where it is great. A wider grain also catches more light: without `wide` its omega is a lower limit. With it the
    torque below lambda/1.8 grows by the power 2.35 of `inertia_ratio`, and the porous grain turns faster than the solid
    one. How porous grains scatter light is not known to these formulas.

    The printed 9.6e8 and 1.78e10 rad/s (gamma_rad = U = 1, a = 0.1 um, lambda = 0.5 um, n_H = 10 cm-3, 100 K, below and
    above lambda/1.8) are without the infrared light, and then 1.04 and 1.26 times this.
    """
    drag = gas_drag(size, around, inertia_ratio)
    damping = infrared_damping(size, strength, around, inertia_ratio, coefficient)
    caught = size * np.sqrt(inertia_ratio) if wide else size
    return radiative_torque(caught, strength, around) / (drag * (1.0 + damping))


def destroyed_sizes(omega_disr, strength, around=DIFFUSE, inertia_ratio=None, coefficient=INFRARED, wide=False):
    """Smallest and greatest size of the grains that light of a strength tears apart.

    Parameters
    ----------
    omega_disr : callable
        Angular velocity of disruption [rad s-1], (...', n), of sizes [m], (n,).
    strength : array_like, shape (...)
        U, above 0.
    around : Surroundings
    inertia_ratio : callable, optional
        `omega_rat` has that of each size [m]; 1 when not given.
    coefficient : float
        See `infrared_damping`.
    wide : bool
        See `omega_rat`.

    Returns
    -------
    smallest, greatest : numpy.ndarray, shape (..., ...')
        Where `omega_rat` first reaches `omega_disr` among the sizes `SEARCHED`, and where it falls below it again [m].
        NaN where it does not reach it; the greatest is infinite where it has not fallen below at their end.

    Raises
    ------
    InputError
        If a strength is no number above 0.
    """
    strength = np.asarray(strength, dtype=float)
    if not (np.isfinite(strength) & (strength > 0.0)).all():
        raise InputError(f"destroyed_sizes: the strength of the radiation is {strength}, but must be above 0")
    size = np.geomspace(*SEARCHED, _STEPS)
    ratio = 1.0 if inertia_ratio is None else inertia_ratio(size)
    torn = np.log(omega_disr(size))
    # one strength after the other: all together would be large
    turned = [np.log(omega_rat(size, one, around, ratio, coefficient, wide)) for one in strength.ravel()]
    ends = [_ends(size, omega - torn) for omega in turned]
    smallest, greatest = (np.reshape(end, strength.shape + torn.shape[:-1]) for end in zip(*ends, strict=True))
    return smallest, greatest


def _ends(size, excess):
    """Smallest and greatest size (...) at which `excess` (..., n) is above 0, as of `destroyed_sizes`."""
    above = excess >= 0.0
    first = above.argmax(axis=-1)
    # the first size beyond that is not destroyed, 0 where all are
    after = (~above & (np.arange(_STEPS) > first[..., None])).argmax(axis=-1)
    none = ~above.any(axis=-1)
    smallest = np.where(first > 0, _crossing(size, excess, first), size[0])
    greatest = np.where(after > 0, _crossing(size, excess, after), np.inf)
    return np.where(none, np.nan, smallest), np.where(none, np.nan, greatest)


def _crossing(size, excess, place):
    """Size [m] at which `excess` (..., n) is 0 between `place` - 1 and `place` (...), along a straight line in ln a."""
    place = np.maximum(place, 1)
    low, high = (np.take_along_axis(excess, (place - k)[..., None], axis=-1)[..., 0] for k in (1, 0))
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):  # what does not cross is not used
        return size[place - 1] * (size[place] / size[place - 1]) ** (low / (low - high))
