"""The largest grain that radiation leaves whole: `radiation` against omega of disruption, ours and that of Table 3."""

import numpy as np
import pandas as pd

from ratd.base.errors import InputError
from ratd.base.materials import get_material
from ratd.experiments.spin_up.cells import as_frame, size_key
from ratd.experiments.spin_up.eq33 import eq33
from ratd.experiments.spin_up.printed import PAPER_MEAN_RADIUS, TABLE_3
from ratd.experiments.spin_up.radiation import DIFFUSE, INFRARED, destroyed_sizes
from ratd.experiments.spin_up.size_law import SPLIT, size_law, unit_of

__all__ = ["COMPUTED", "grown_inertia", "is_extrapolated", "power_law", "printed_law", "surviving"]

COMPUTED = (50e-9, 550e-9)
"""Sizes [m] that were spun up; beyond them a law is extrapolated."""


def power_law(C, p, material):
    """omega of disruption of `size_law.size_law`, C sqrt(gamma/(rho a0^3)) (a/a0)^-p with a0 = `SPLIT`.

    Parameters
    ----------
    C, p : array_like, shape (...)
    material : Material

    Returns
    -------
    callable
        Of sizes [m] (n,) -> omega [rad s-1] (..., n).
    """
    C, p = np.asarray(C)[..., None], np.asarray(p)[..., None]
    return lambda size: C * unit_of(material) * (np.asarray(size) / SPLIT) ** -p


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
    value = np.log(value)

    def omega(size):
        x = np.log(size)
        contacts = np.interp(x, place, value)
        for end, inner, beyond in ((0, 1, x < place[0]), (-1, -2, x > place[-1])):
            slope = (value[end] - value[inner]) / (place[end] - place[inner])
            contacts = np.where(beyond, value[end] + slope * (x - place[end]), contacts)
        scale = material.surface_energy, material.density, PAPER_MEAN_RADIUS
        return eq33(size, *scale, np.exp(contacts), 1.0, *TABLE_3[material.name, kind])

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
    coefficient=INFRARED,
    materials=None,
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
        mass. The torque is that of a_eff in both.
    coefficient : float
        See `radiation.infrared_damping`.
    materials : optional
        Table of materials, handed to `ratd.base.materials.get_material`.
    draws, seed : int
        Of the Monte Carlo draws of C and p of `size_law`, which are taken to be normal and independent (a0 lies in the
        middle of the sizes).

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
    laws = size_law(table, mark, materials).set_index("type")
    rng = np.random.Generator(np.random.PCG64(seed))
    rows = []
    for name in dict.fromkeys(table["material"]):
        material = get_material(name, materials)
        for kind, law in laws.iterrows():
            if not len(table[(table["material"] == name) & (table["type"] == kind)]):
                continue
            ratio = grown_inertia(grown, name, kind) if porous else None
            drawn = np.exp(rng.normal(np.log(law["C"]), law["C_error"] / law["C"], draws))
            slopes = rng.normal(law["p"], law["p_error"], draws)
            candidates = {"ours": (power_law(law["C"], law["p"], material), power_law(drawn, slopes, material))}
            if (name, kind) in TABLE_3:
                candidates["printed"] = printed_law(grown, material, kind), None
            for which, (omega, spread) in candidates.items():
                found = _sizes(omega, spread, strengths, around, ratio, coefficient)
                rows += [{"material": name, "type": kind, "law": which} | own for own in found]
    return pd.DataFrame(rows)


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
            if np.isfinite(smallest) and len(drawn) > 1:
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
