"""Unequal monomers: what takes the place of r_0 in P_0 phi^3."""

import math

from ratd.aggregates.strength import rolling_pressure

__all__ = ["LENGTHS", "derived_pressure", "predicted_pressures"]

LENGTHS = {
    "derived": r"$\langle E_\mathrm{roll}\rangle\, l^6/\langle a^3\rangle^3$",
    "mean": r"$r_0 = \langle a\rangle$",
    "square": r"$r_0 = \langle a^2\rangle^{1/2}$",
    "volume": r"$r_0 = \langle a^3\rangle^{1/3}$",
}
"""Ways to a P_0, with their text."""


def derived_pressure(rolling_energy, length, volume):
    """P/phi^3 = E l^6/v^3 [Pa] of a cluster of r_g^2 = N l^2.

    Parameters
    ----------
    rolling_energy : float
        E, mean of E_roll over the contacts [J].
    length : float
        l [m].
    volume : float
        v = <a^3> [m3].

    Notes
    -----
    Section 4 of Kataoka et al. (2013) with l^2 in place of r_0^2: a part of N monomers has the extent N^(1/2) l and
    the filling factor phi = N v/(N^(1/2) l)^3, so that its extent is v/(phi l^2). P = E over the cube of this extent.
    """
    return rolling_energy * length**6 / volume**3


def predicted_pressures(table, equal):
    """P_0 [Pa] of a set by each of `LENGTHS`.

    Parameters
    ----------
    table : xarray.Dataset
        Of the kind ``compression_set``.
    equal : xarray.Dataset
        The same of equal monomers, with the same number: l is r_0 there, and goes with the measured r_g.

    Returns
    -------
    dict of str to float
    """
    square = table["mean_square_gyration"].item() / equal["mean_square_gyration"].item()
    length = math.sqrt(square) * equal["monomer_radius"].item()
    radii = {
        "mean": table["mean_radius"].item(),
        "square": math.sqrt(table["mean_square_radius"].item()),
        "volume": table["monomer_radius"].item(),
    }
    own = table["surface_energy"].item(), table["critical_rolling_displacement"].item()
    found = {"derived": derived_pressure(table["mean_rolling_energy"].item(), length, radii["volume"] ** 3)}
    return found | {name: rolling_pressure(*own, radius) for name, radius in radii.items()}
