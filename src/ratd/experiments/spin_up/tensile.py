"""Angular velocity of disruption from a tensile strength, the estimate that the simulations are compared with (Fig. 8).

The strengths of Greenberg et al. and Seizinger et al. hold constants that the paper does not give; what is used of them
is how they depend on the grain. That of Tatsuuma et al. has an absolute value.
"""

import numpy as np
import pandas as pd

from ratd.aggregates.strength import tensile_strength_tatsuuma2019
from ratd.experiments.spin_up.cells import size_key

__all__ = [
    "SCALINGS",
    "eq27",
    "fractal_exponent",
    "predictions",
    "tensile_strength_greenberg1995",
]

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
    for the porous grain; with its real extent a_eff phi^(-1/3) omega is phi^(-1/6) of this (`midplane_tension`).
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
_DEPENDS_ON = ("n_contacts", "n_monomers", "filling_factor", "fractal_dimension", "mean_monomer_radius")
"""What the strengths depend on."""


def predictions(cells, material, scaled_at, grown=None):
    """omega [rad s-1] of Eq. 27 for each cell, with the strengths of the literature.

    Parameters
    ----------
    cells : pandas.DataFrame
        What `cells.cell_statistics` returns, of one material and type.
    material : ratd.Material
    scaled_at : float
        Size a_eff [m] at which a strength that is known up to a factor is scaled to the mean omega_disr of the cell.
    grown : pandas.DataFrame, optional
        Table of grains as grown, of all cells or more, which N_con, N_mon, phi, a_mon and D_f are taken from; default:
        the means in `cells`.

    Returns
    -------
    curves : pandas.DataFrame
        A column a model, a row a cell: those of `SCALINGS`, scaled, and "absolute", the strength of Tatsuuma et al.
        2019 as it stands, with the mean monomer radius of the cell. NaN where a cell lacks a value.
    anchor : dict of str to float
        Size [m] at which each was scaled: the nearest to `scaled_at` at which both are known; NaN if there is none.

    Notes
    -----
    Strengths are those of the mean N_con/N_mon and phi and of one D_f of a cell: a mean over strengths of single grains
    would rest on the few with D_f near 3, where the exponent 2/(3 - D_f) has no bound. With `grown`, D_f is the median
    of those below 3: no body in space has more, such a value comes from a fit to few monomers.
    """
    size = cells["a_eff"].to_numpy(float)
    found = cells["omega_disr_mean"].to_numpy(float)
    at_rest = _at_rest(cells, grown)
    phi, dimension, radius = (at_rest[name] for name in ("filling_factor", "fractal_dimension", "mean_monomer_radius"))
    contacts = at_rest["n_contacts"] / at_rest["n_monomers"]
    curves, anchor = {}, {}
    for name, (_, strength) in SCALINGS.items():
        shape = eq27(size, strength(contacts, phi, dimension), material.density)
        known = np.flatnonzero(np.isfinite(shape) & np.isfinite(found))
        if not len(known):
            curves[name], anchor[name] = np.full(len(size), np.nan), np.nan
            continue
        k = known[np.argmin(np.abs(size[known] - scaled_at))]
        curves[name], anchor[name] = shape * (found[k] / shape[k]), size[k]
    strength = tensile_strength_tatsuuma2019(material.surface_energy, radius, phi)
    curves["absolute"] = eq27(size, strength, material.density)
    return pd.DataFrame(curves, index=cells.index), anchor


def _at_rest(cells, grown):
    """Name of `_DEPENDS_ON` -> its value in each cell, see `predictions`."""
    if grown is None:
        return {name: cells[f"{name}_mean"].to_numpy(float) for name in _DEPENDS_ON}
    keys = ["material", "type", "size"]
    possible = grown["fractal_dimension"].where(grown["fractal_dimension"] < 3)
    groups = grown.assign(size=size_key(grown["a_eff"]), fractal_dimension=possible).groupby(keys)
    wanted = pd.MultiIndex.from_frame(cells.assign(size=size_key(cells["a_eff"]))[keys])
    found = groups[list(_DEPENDS_ON)].mean().reindex(wanted)
    found["fractal_dimension"] = groups["fractal_dimension"].median()
    return {name: found[name].to_numpy(float) for name in _DEPENDS_ON}
