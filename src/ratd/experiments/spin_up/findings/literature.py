"""What the paper says of tensile strengths and of porosity, beside what the grains here do."""

import numpy as np

from ratd.base.materials import get_material
from ratd.base.measured import Measured, geometric_mean
from ratd.base.statistics import mean_of
from ratd.experiments.spin_up.cells import MATERIALS, TYPES, cell_of, cell_statistics
from ratd.experiments.spin_up.findings.claims import is_above
from ratd.experiments.spin_up.findings.ensemble import of_class
from ratd.experiments.spin_up.tensile import SCALINGS, eq27, predictions

__all__ = ["of_literature", "needed_strength"]

SCALED_AT = 100e-9
"""Size [m] at which the paper scales the strengths in its Fig. 8."""
SIZES = (100, 300, 550)
"""Sizes [nm] whose strength is told."""


def needed_strength(a_eff, omega, density):
    """Tensile strength S [Pa] with which Eq. 27 gives an omega, rho (omega a_eff/2)^2.

    Parameters
    ----------
    a_eff : array_like
        Effective radius [m].
    omega : array_like
        [rad s-1]
    density : array_like
        Density rho of the solid [kg m-3].

    Returns
    -------
    numpy.ndarray or float

    References
    ----------
    Reissl et al. (2024), A&A 692, A60, Eq. 27, solved for S.
    """
    return (np.asarray(omega) / eq27(a_eff, 1.0, density)) ** 2


def of_literature(table, grown):
    """Values of the slots on tensile strengths and porosity.

    Parameters
    ----------
    table : pandas.DataFrame
        Driven grains, as `ratd.experiments.spin_up.findings.ensemble.beside_print` returns them.
    grown : pandas.DataFrame
        All grains as grown.

    Returns
    -------
    dict
        ``literature.TYPE MODEL``, MODEL of `SCALINGS`: at the largest size the omega of Eq. 27, scaled to omega_disr at
        `SCALED_AT`, over omega_disr; geometric mean over the materials, with the error from their scatter.
        ``literature.TYPE SIZE S``: strength [kPa] that omega_disr of the cells of a size needs, geometric mean, and
        with ``printed`` behind it the one that Eq. 33 with Table 3 needs [MPa]. ``literature.TYPE porosity start``,
        ``disr`` and ``change``: of grains of 300 to 550 nm at rest and of what is left at omega_disr, in per cent.
        ``literature.powers``: "too slowly" where all strengths that go with phi or a power of it give too much at the
        largest size, by two standard errors.
    """
    values = {}
    for kind in TYPES:
        part = table[table["type"] == kind]
        for name, ratios in _at_largest(part, grown).items():
            values[f"literature.{kind} {name}"] = geometric_mean(ratios)
        density = np.array([get_material(name).density for name in part["material"]])
        for size in SIZES:
            here = np.isclose(part["nm"], size)
            own, cell = part[here], cell_of(part[here])
            for behind, omega, unit in (("", "omega_disr", 1e3), (" printed", "printed", 1e6)):
                strength = needed_strength(own["a_eff"], own[omega], density[here]) / unit
                values[f"literature.{kind} {size} S{behind}"] = geometric_mean(strength, cell)
        large = of_class(part, "large")
        start, end = (100.0 * large[f"porosity_{when}"].to_numpy() for when in ("start", "disr"))
        for name, own in (("start", start), ("disr", end), ("change", end - start)):
            values[f"literature.{kind} porosity {name}"] = Measured(*mean_of(own, cell_of(large)))
    of_phi = [values[f"literature.{kind} {name}"] for kind in TYPES for name in SCALINGS if name != "T19 fractal"]
    slow = all(is_above(ratio, 1.0) == "yes" for ratio in of_phi)
    return values | {"literature.powers": "too slowly" if slow else "not all too slowly"}


def _at_largest(table, grown):
    """Model -> what it predicts over what is found at the largest size, a number a material."""
    found = {name: [] for name in SCALINGS}
    for name in MATERIALS:
        cells = cell_statistics(table[table["material"] == name])
        kind = cells["type"].iloc[0]
        own = grown[(grown["material"] == name) & (grown["type"] == kind)]
        curves, _ = predictions(cells, get_material(name), SCALED_AT, own)
        for model, ratios in found.items():
            ratios.append(float(curves[model].iloc[-1] / cells["omega_disr_mean"].iloc[-1]))
    return found
