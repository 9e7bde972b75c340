"""What pulled clusters say of the tensile strength, and grains that were spun up beside them."""

import numpy as np

from ratd.aggregates.strength import midplane_tension, tensile_strength_tatsuuma2019
from ratd.base.materials import get_material
from ratd.base.measured import Measured, median, quotient
from ratd.base.statistics import jackknife_error, mean_of
from ratd.experiments.compression.strength import measured, of_means

__all__ = ["in_units", "main_pulls", "nominal_phi", "of_spun", "of_tension", "spun_up"]

HELD = 0.01
"""Strength over that of the formula above which a cluster is said to hold to its copies; less is inertia."""
TENSION_FROM = 0.05
"""Filling factor from which on the power law of the tensile strength is fitted; looser clusters scatter too much."""


def main_pulls(entries):
    """Rate and number of monomers of most pulls along one axis, (float, int)."""
    own = entries.isel(entry=(entries["n_axes"].values == 1) & (entries["unloaded"].values == 0))
    pairs = np.stack([own["strain_rate"].values, own["n_monomers"].values], axis=1)
    every, number = np.unique(pairs, axis=0, return_counts=True)
    rate, n = every[np.argmax(number)]
    return float(rate), int(n)


def nominal_phi(entries):
    """Filling factors up to which clusters were compressed, rounded as a config has them."""
    return np.round(entries["phi_compressed"].values, 3)


def in_units(entries):
    """Strength over gamma/r_0, and the same by the formula, of entries of the kind ``tension_set``."""
    unit = entries["surface_energy"] / entries["monomer_radius"]
    return (entries["strength"] / unit).values, tensile_strength_tatsuuma2019(1.0, 1.0, entries["phi"].values)


def of_tension(entries):
    """Strength over the formula of Tatsuuma et al. and the place of the peak, by way of pulling and phi.

    Parameters
    ----------
    entries : xarray.Dataset
        Of the kind ``tension_set``.

    Returns
    -------
    dict
        Slots ``tension_WAY.WHAT_PHI``, PHI being the filling factor of the compression. WAY is ``x`` or ``xyz`` for
        what most pulls along one axis were made with (`main_pulls`); ``unloaded`` where the box let go of the cluster
        first; ``rate_RATE`` and ``N_NUMBER`` where the pull had another rate or number of monomers. WHAT is ``over``
        for these last three, the strength over that of the main pulls along one axis. ``tension_formula``: whether the
        formula holds for the main pulls; ``tension_x.kPa_0.1``: their strength [kPa] from 0.1.
    """
    strength, formula = in_units(entries)
    rate, n = main_pulls(entries)
    rates, numbers, phi = entries["strain_rate"].values, entries["n_monomers"].values, nominal_phi(entries)
    seed, unloaded = entries["seed"].values, entries["unloaded"].values == 1
    one_axis, alike = entries["n_axes"].values == 1, (rates == rate) & (numbers == n)
    main = one_axis & alike & ~unloaded
    ways = {"x": main, "xyz": ~one_axis & alike & ~unloaded, "unloaded": one_axis & alike & unloaded}
    for other in np.unique(rates[rates != rate]):
        ways[f"rate_{other:.0e}"] = one_axis & ~unloaded & (rates == other) & (numbers == n)
    for other in np.unique(numbers[numbers != n]):
        ways[f"N_{other}"] = one_axis & ~unloaded & (rates == rate) & (numbers == other)
    peak = entries["phi_strength"].values / entries["phi"].values
    found = {"tension_x.rate": rate, "tension_x.N": n}
    for way, own in ways.items():
        for each in np.unique(phi[own]):
            here = own & (phi == each)
            held = here & (strength > HELD * formula)
            mean = entries["strength"].values[here].mean()
            pressed = entries["residual"].values[here] / (mean if mean > 0.0 else np.nan)
            found |= {
                f"tension_{way}.{each:g}": Measured(*mean_of((strength / formula)[here])),
                f"tension_{way}.peak_{each:g}": Measured(*mean_of(peak[held])),
                f"tension_{way}.n_{each:g}": int(here.sum()),
                f"tension_{way}.held_{each:g}": int(held.sum()),
                f"tension_{way}.of_held_{each:g}": Measured(*mean_of((strength / formula)[held])),
                f"tension_{way}.residual_{each:g}": Measured(*mean_of(pressed)),
                f"tension_{way}.scatter_{each:g}": float(np.std(strength[here], ddof=1) / np.mean(strength[here]))
                if here.sum() > 1
                else np.nan,
            }
            beside = main & (phi == each)
            if way not in ("x", "xyz") and beside.any():
                found[f"tension_{way}.over_{each:g}"] = _over(
                    strength, seed, here, beside, same=not way.startswith("N")
                )
    ratios = [own.value for name, own in found.items() if ".over_" in name and "tension_N" not in name]
    if ratios:
        found["tension_ways"] = "by less than a tenth" if np.abs(np.array(ratios) - 1.0).max() < 0.1 else "by more"
    over_formula = [found[f"tension_x.{each:g}"].value for each in np.unique(phi[main]) if each >= TENSION_FROM]
    if over_formula:
        found["tension_formula"] = "holds" if np.abs(np.array(over_formula) - 1.0).max() < 0.15 else "fails"
    tenth = main & (phi == 0.1)
    if tenth.any():
        found["tension_x.kPa_0.1"] = Measured(*mean_of(1e-3 * entries["strength"].values[tenth]))
    fitted = main & (phi >= TENSION_FROM) & (strength > 0.0)
    if len(np.unique(phi[fitted])) > 1:
        found["tension_x.exponent"] = _slope(np.log(phi[fitted]), np.log(strength[fitted]), seed[fitted])
    return found


def of_spun(spun):
    """Strength that spin implies (of `spun_up`) over the formula of Tatsuuma et al.

    Returns
    -------
    dict
        ``spun.TYPE``, the median; ``spun.TYPE least`` and ``most``; ``spun.TYPE least power`` and ``most power`` of phi
        with which it grows in one material; and ``spun.TYPE least phi`` and ``most phi``, the filling factor at which
        the power law of one material is 1.
    """
    over = spun["strength"] / tensile_strength_tatsuuma2019(1.0, 1.0, spun["phi"])
    found = {}
    for kind in np.unique(spun["type"]):
        own, phi = over[spun["type"] == kind], spun["phi"][spun["type"] == kind]
        found |= {f"spun.{kind}": median(own), f"spun.{kind} least": own.min(), f"spun.{kind} most": own.max()}
        of_material = [spun["material"][spun["type"] == kind] == name for name in np.unique(spun["material"])]
        fits = [np.polyfit(np.log(phi[each]), np.log(own[each]), 1) for each in of_material if each.sum() > 2]
        if fits:
            power, at_1 = np.array(fits).T
            for name, told in (("power", power), ("phi", np.exp(-at_1 / power))):
                found |= {f"spun.{kind} least {name}": told.min(), f"spun.{kind} most {name}": told.max()}
    return found


def _over(values, seed, own, other, same):
    """Mean of some values over that of others; of the same clusters where these are the same ones."""
    if same:
        common = np.intersect1d(seed[own], seed[other])
        pairs = np.array([[values[each & (seed == one)][0] for each in (own, other)] for one in common])
        return measured(of_means(pairs, lambda mean: mean[0] / mean[1]))
    return quotient(mean_of(values[own]), mean_of(values[other]))


def _slope(x, y, seed):
    """Slope of y over x by least squares, with the error of leaving one seed out at a time."""
    left = [seed != one for one in np.unique(seed)]
    whole = len(left) > 1 and all(len(np.unique(x[own])) > 1 for own in left)
    slopes = [np.polyfit(x[own], y[own], 1)[0] for own in left] if whole else []
    return Measured(float(np.polyfit(x, y, 1)[0]), jackknife_error(np.array(slopes)))


def spun_up(grains, mark="omega_disr"):
    """Tensile strengths that the disruption of spun-up grains implies.

    Parameters
    ----------
    grains : pandas.DataFrame
        Table of the ensemble of the spin-up.
    mark : str
        Which angular velocity.

    Returns
    -------
    dict
        ``phi``, ``strength`` (S a/gamma), ``type``, ``material``: (k,) arrays, one number a material, type and size,
        means over seeds; a is the mean radius of the monomers.

    Notes
    -----
    S is the mean tension across the plane through the axis of a porous sphere of the grain's mass and filling factor
    that turns at the mark (`midplane_tension`).
    """
    grains = grains[grains[mark].notna()]
    gamma = grains["material"].map(lambda name: get_material(name).surface_energy).to_numpy(float)
    density = grains["material"].map(lambda name: get_material(name).density).to_numpy(float)
    phi = grains["filling_factor"].to_numpy(float)
    outer = grains["a_eff"].to_numpy(float) * phi ** (-1.0 / 3.0)
    tension = midplane_tension(grains[mark].to_numpy(float), density, phi, outer)
    strength = tension * grains["mean_monomer_radius"].to_numpy(float) / gamma
    own = grains.assign(strength=strength, size=np.round(grains["a_eff"] / 1e-9))
    cells = own.groupby(["material", "type", "size"], as_index=False)[["filling_factor", "strength"]].mean()
    return {
        "phi": cells["filling_factor"].to_numpy(),
        "strength": cells["strength"].to_numpy(),
        "type": cells["type"].to_numpy(),
        "material": cells["material"].to_numpy(),
    }
