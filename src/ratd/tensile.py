"""Angular velocity of disruption from a tensile strength, the estimate that the simulations are compared with (Fig. 8).

The strengths of Greenberg et al. and Seizinger et al. hold constants that the paper does not give; what is used of them
is how they depend on the grain. That of Tatsuuma et al. has an absolute value, `ratd.bound`.
"""

import numpy as np

__all__ = ["SCALINGS", "eq27", "fractal_exponent", "tensile_strength_greenberg1995"]

SEIZINGER_2013 = (1.6, 1.9)
"""Exponents of phi for quartz BA, BAM and hexagonal aggregates (Seizinger et al. 2013, A&A 559, A19)."""
TATSUUMA_2019 = 1.8
"""Exponent of phi for BCCA aggregates (Tatsuuma et al. 2019, ApJ 874, 159)."""


def eq27(a_eff, tensile_strength, density):
    """Angular velocity that a sphere of this tensile strength holds, omega = 2/a_eff sqrt(S/rho) [rad s-1].

    Parameters
    ----------
    a_eff : array_like
        Effective radius [m].
    tensile_strength : array_like
        S [Pa].
    density : array_like
        Density rho of the solid [kg m-3].

    Returns
    -------
    numpy.ndarray or float
        Shape by broadcasting.

    References
    ----------
    Reissl et al. (2024), A&A 692, A60, Eq. 27; Hoang (2020), Galaxies 8, 52. It takes the solid sphere of the same mass
    for the porous grain; with its real extent a_eff phi^(-1/3) omega is phi^(-1/6) of this (`ratd.bound`).
    """
    return 2.0 / np.asarray(a_eff) * np.sqrt(np.asarray(tensile_strength) / density)


def tensile_strength_greenberg1995(contacts_per_monomer, filling_factor, binding_energy, monomer_radius, overlap):
    """Tensile strength S = 3/2 <N_con> phi E/(a_mon^2 h) [Pa].

    Parameters
    ----------
    contacts_per_monomer : array_like
        <N_con> [1].
    filling_factor : array_like
        phi [1].
    binding_energy : float
        Energy E of a contact [J].
    monomer_radius : float
        a_mon [m] of equal monomers.
    overlap : float
        h [m], the way over which a contact parts.

    Returns
    -------
    numpy.ndarray or float

    References
    ----------
    Greenberg, Mizutani & Yamamoto (1995), A&A 295, L35; Li & Greenberg (1997), A&A 323, 566. Reissl et al. (2024),
    Eq. 28, print a_mon in place of a_mon^2, which is no pressure.
    """
    bonds = np.asarray(contacts_per_monomer) * np.asarray(filling_factor)
    return 1.5 * bonds * binding_energy / (monomer_radius**2 * overlap)


def fractal_exponent(fractal_dimension):
    """Exponent 2/(3 - D_f) of phi in the tensile strength of a grain of fractal dimension D_f, NaN from 3 on.

    References
    ----------
    Tatsuuma, Kataoka & Tanaka (2019), ApJ 874, 159; Reissl et al. (2024), Sect. 5.
    """
    rest = 3.0 - np.asarray(fractal_dimension, dtype=float)
    return np.divide(2.0, rest, out=np.full(rest.shape, np.nan), where=rest > 0)


def _greenberg(contacts_per_monomer, filling_factor, fractal_dimension):
    # E, a_mon and h are the same for all grains and fall out where the curve is scaled.
    return tensile_strength_greenberg1995(contacts_per_monomer, filling_factor, 1.0, 1.0, 1.0)


def _power(exponent):
    return lambda contacts_per_monomer, filling_factor, fractal_dimension: filling_factor**exponent


def _fractal(contacts_per_monomer, filling_factor, fractal_dimension):
    return filling_factor ** fractal_exponent(fractal_dimension)


SCALINGS = {
    "G95": (r"G95: $\langle N_\mathrm{con}\rangle\,\phi$", _greenberg),
    "S13 low": (rf"S13: $\phi^{{{SEIZINGER_2013[0]}}}$", _power(SEIZINGER_2013[0])),
    "S13 high": (rf"S13: $\phi^{{{SEIZINGER_2013[1]}}}$", _power(SEIZINGER_2013[1])),
    "T19": (rf"T19: $\phi^{{{TATSUUMA_2019}}}$", _power(TATSUUMA_2019)),
    "T19 fractal": (r"T19: $\phi^{2/(3-D_\mathrm{f})}$", _fractal),
}
"""Model -> text and the tensile strength up to a factor, of (<N_con>, phi, D_f)."""
