"""The largest grain that radiation leaves whole: `radiation` against omega of disruption, ours and that of Table 3."""

import numpy as np
import pandas as pd

from ratd.base.errors import InputError
from ratd.base.materials import get_material
from ratd.experiments.spin_up.cells import as_frame, size_key
from ratd.experiments.spin_up.eq33 import eq33
from ratd.experiments.spin_up.printed import PAPER_MEAN_RADIUS, TABLE_3
from ratd.experiments.spin_up.radiation import DIFFUSE, destroyed_sizes, infrared_of

__all__ = ["COMPUTED", "grown_inertia", "is_extrapolated", "measured_law", "printed_law", "surviving"]

COMPUTED = (50e-9, 550e-9)
"""Sizes [m] that were spun up; beyond them a law is extrapolated."""


OUTER = 4
"""Sizes from whose means a law is extrapolated."""
ROUNDING = 1e-9
"""Part of a size by which drawn ones differ at least where the scatter of the grains is known."""


def measured_law(table, mark, material, kind, draws=0, rng=None):
    """omega of disruption as it was found: geometric means of each size, along straight lines in ln a.

    A power of size for all sizes misses single ones by up to a sixth, see `size_law`.

    Parameters
    ----------
    table : pandas.DataFrame
        Grains that were spun up, of one drive.
    mark : str
        Which omega.
    material, kind : str
        Which grains.
    draws : int
        How many laws to draw, each mean with its standard error.
    rng : numpy.random.Generator, optional
        Draws them.

    Returns
    -------
    best, drawn : callable
        Of sizes [m] (n,) -> omega [rad s-1] (n,) and (draws, n), the best one where nothing is drawn; beyond the sizes
        that were spun up as the power of the `OUTER` next ones.

    Raises
    ------
    InputError
        If fewer than two sizes of these grains were spun up.
    """
    part = table[(table["material"] == material) & (table["type"] == kind) & (table[mark].astype(float) > 0.0)]
    value = np.log(part[mark].astype(float))
    place, mean = _by_size(part, value)
    if len(mean) < 2:
        raise InputError(f"surviving: fewer than two sizes of {material} {kind} were spun up; give at least two")
    each = value.groupby(size_key(part["a_eff"]).to_numpy())
    scatter = each.std().sort_index()
    # a size with one grain has the scatter of the others
    scatter = scatter.fillna(np.sqrt((scatter**2).mean())).fillna(0.0)
    error = (scatter / np.sqrt(each.size().sort_index())).to_numpy()
    best = _along_lines(*_extended(place, mean[None]))
    spread = error * (rng.normal(size=(draws, len(mean))) if draws else np.zeros((1, 1)))
    return lambda size: best(size)[0], _along_lines(*_extended(place, mean + spread))


def _extended(place, value):
    """Places and (k, n) values with a point more beyond each end, along the slope of the `OUTER` next ones."""
    ends = []
    for near, far in ((slice(None, OUTER), -1.0), (slice(-OUTER, None), 1.0)):
        slope = np.polyfit(place[near], value[:, near].T, 1)[0]
        end = 0 if far < 0.0 else -1
        ends.append((place[end] + far, value[:, end] + far * slope))
    (first, before), (last, after) = ends
    return np.concatenate([[first], place, [last]]), np.column_stack([before, value, after])


def _along_lines(place, value):
    """exp of straight lines in ln a through (..., k) values, the first and the last of them also beyond the ends."""

    def found(size):
        x = np.log(np.asarray(size))
        k = np.clip(np.searchsorted(place, x) - 1, 0, len(place) - 2)
        part = (x - place[k]) / (place[k + 1] - place[k])
        return np.exp((1.0 - part) * value[..., k] + part * value[..., k + 1])

    return found


def printed_law(grown, material, kind):
    """omega of disruption of Eq. 33 with the printed Table 3 and <a_mon> = 20 nm.

    Parameters
    ----------
    grown : pandas.DataFrame
        Grains as grown.
    material : Material
    kind : str
        Type of the grains.

    Returns
    -------
    callable
        Of sizes [m] (n,) -> omega [rad s-1] (n,). ln(N_con phi) is that of the mean of the grown grains of each size,
        along straight lines in ln a, the first and the last of them also beyond the sizes that were grown.

    Raises
    ------
    InputError
        If Table 3 does not have the grains, or fewer than two sizes of them were grown.
    """
    if (material.name, kind) not in TABLE_3:
        raise InputError(f"printed_law: Table 3 has no {material.name} {kind}")
    part = _cell(grown, material.name, kind)
    place, value = _by_size(part, part["n_contacts"] * part["filling_factor"])
    contacts = _along_lines(place, np.log(value))

    def omega(size):
        scale = material.surface_energy, material.density, PAPER_MEAN_RADIUS
        return eq33(size, *scale, contacts(size), 1.0, *TABLE_3[material.name, kind])

    return omega


def grown_inertia(grown, material, kind):
    """Moment of inertia of grown grains over that of as much solid, (b^2 + c^2)/(2 a_eff^2).

    Parameters
    ----------
    grown : pandas.DataFrame
        Grains as grown.
    material, kind : str
        Which grains.

    Returns
    -------
    callable
        Of sizes [m] (n,) -> ratio (n,): means of the grains of each size, along straight lines in ln a, and the same
        beyond as at the last size.
    """
    part = _cell(grown, material, kind)
    place, value = _by_size(part, (part["axis_b"] ** 2 + part["axis_c"] ** 2) / (2.0 * part["a_eff"] ** 2))
    return lambda size: np.interp(np.log(size), place, value)


def is_extrapolated(size):
    """Whether a size [m] lies outside of those that were spun up."""
    size = np.asarray(size)
    return (size < COMPUTED[0]) | (size > COMPUTED[1])


def surviving(
    table,
    grown,
    strengths,
    mark="omega_mass_75",
    *,
    around=DIFFUSE,
    porous=False,
    wide=False,
    coefficient=None,
    surface_energy=1.0,
    draws=400,
    seed=0,
):
    """Sizes that radiation destroys, for each material and type, by our omega of disruption and by the printed one.

    Parameters
    ----------
    table : pandas.DataFrame
        Grains that were spun up, of one drive.
    grown : pandas.DataFrame
        Grains as grown, for N_con phi and the moments of inertia.
    strengths : array_like
        U of the radiation.
    mark : str
        Which omega is ours.
    around : radiation.Surroundings
    porous : bool
        Whether gas hits all of the porous grain (`radiation.gas_drag`), or as much of it as of a solid sphere of its
        mass.
    wide : bool
        Whether light finds it as wide as the gas then does (`radiation.omega_rat`); else the torque is that of a_eff.
    coefficient : float, optional
        See `radiation.infrared_damping`; that of each material when not given, `radiation.infrared_of`.
    surface_energy : float
        Over that of the material: both laws go as its root.
    draws, seed : int
        Of the laws that are drawn with the standard errors of the means of `measured_law`.

    Returns
    -------
    pandas.DataFrame
        A row a material, type, law ("ours", "printed") and strength: a_disr, the smallest size that is destroyed, up to
        which grains survive, with `_error`, and low and high, 16 and 84 % of the draws; greatest, the largest size that
        is destroyed; all [m], NaN where no size is, as in the share 1 - `share` of the draws; extrapolated, whether
        a_disr is. The printed law has no errors: NaN. That grains scatter about the laws is left out.

    Raises
    ------
    InputError
        If a material or type that was spun up has too few grown grains for a law, or a strength is not above 0.
    """
    table = as_frame(table, "surviving", ("material", "type", "a_eff", mark))
    strengths = np.atleast_1d(np.asarray(strengths, dtype=float))
    rng = np.random.Generator(np.random.PCG64(seed))
    rows = []
    for name in dict.fromkeys(table["material"]):
        material = get_material(name)
        infrared = infrared_of(name) if coefficient is None else coefficient
        for kind in dict.fromkeys(table.loc[table["material"] == name, "type"]):
            ratio = grown_inertia(grown, name, kind) if porous else None
            candidates = {"ours": measured_law(table, mark, name, kind, draws, rng)}
            if (name, kind) in TABLE_3:
                candidates["printed"] = printed_law(grown, material, kind), None
            for which, laws in candidates.items():
                omega, spread = (law and _times(law, surface_energy**0.5) for law in laws)
                found = _sizes(omega, spread, strengths, around, ratio, infrared, wide)
                rows += [{"material": name, "type": kind, "law": which} | own for own in found]
    return pd.DataFrame(rows)


def _times(law, factor):
    """A law of sizes, times a factor."""
    return lambda size: factor * law(size)


def _sizes(omega, spread, strengths, *given):
    """Numbers of the rows of `surviving` for the best law and the drawn ones, a dict a strength."""
    ends = destroyed_sizes(omega, strengths, *given)
    several = [None] * len(strengths) if spread is None else destroyed_sizes(spread, strengths, *given)[0]
    rows = []
    for strength, smallest, greatest, drawn in zip(
        strengths.tolist(), *(end.tolist() for end in ends), several, strict=True
    ):
        row = {"strength": strength, "a_disr": smallest, "a_disr_error": np.nan, "low": np.nan, "high": np.nan}
        row |= {"greatest": greatest, "share": float(np.isfinite(smallest))}
        if drawn is not None:
            row["share"] = float(np.isfinite(drawn).mean())
            drawn = drawn[np.isfinite(drawn)]
            if np.isfinite(smallest) and len(drawn) > 1 and np.ptp(drawn) > ROUNDING * smallest:
                row["a_disr_error"] = float(np.std(drawn, ddof=1))
                row["low"], row["high"] = (float(size) for size in np.quantile(drawn, [0.16, 0.84]))
        rows.append(row | {"extrapolated": bool(np.isfinite(smallest) and is_extrapolated(smallest))})
    return rows


def _cell(grown, material, kind):
    """Grown grains of one material and type, of at least two sizes."""
    part = grown[(grown["material"] == material) & (grown["type"] == kind)]
    if size_key(part["a_eff"]).nunique() < 2:
        raise InputError(f"surviving: fewer than two sizes of {material} {kind} were grown")
    return part


def _by_size(part, values):
    """ln a and mean of the values of each size, in the order of the sizes."""
    mean = values.astype(float).groupby(size_key(part["a_eff"]).to_numpy()).mean().sort_index()
    return np.log(mean.index.to_numpy() * 1e-12), mean.to_numpy()
