"""The pairs of Fig. 10 under the printed equations: what the paper's own test tells of them."""

import numpy as np
import pandas as pd

from ratd import ensemble
from ratd.calibration import PRINTED_STEP
from ratd.drives import OMEGA_RAT
from ratd.laws.jkr import dissipation_time
from ratd.markdown import markdown_table
from ratd.materials import equilibrium_compression, equilibrium_contact_radius, reduced_radius
from ratd.reproduction.paper import PRINTED
from ratd.reproduction.rate import HOUR
from ratd.reproduction.text import between, number
from ratd.solid import solid_omega
from ratd.units import NM

RATES = 10.0 ** np.arange(6, 15.5, 0.5)
"""d omega/dt [rad/s2] from below an hour of drag time up to where the largest pairs would follow it no longer."""


def section(data):
    """Where pairs part under the printed equations, over where they part as the paper says.

    Parameters
    ----------
    data : ratd.reproduction.data.Data

    Returns
    -------
    str
        Markdown.
    """
    ends = smallest_and_largest(data.pairs)
    if ends is None:
        return "The pairs are not part of the data."
    ends = with_share_and_step(ends, data.plan.materials)
    rates = {"one hour of drag time": OMEGA_RAT / HOUR}
    if _calibrated(data) is not None:
        rates = {"calibrated": _calibrated(data)} | rates
    consistent = ends["parting_omega"] / ends["eq35_omega"]
    rows = [["none: consistent model, damped", "slow", *_cells(ends, consistent)]]
    rows += [
        ["explicit", f"{number(rate)} ({name})", *_cells(ends, explicit_over(ends, rate))]
        for name, rate in rates.items()
    ]
    rows.append(["exact", "any", *_cells(ends, consistent / ends["share"])])
    head = ["Coriolis term", "d omega/dt [rad/s²]", *(f"monomers of {size}" for size in _sizes(ends))]
    return "\n\n".join(
        [
            "The paper tests its code with pairs of equal monomers (Fig. 10), all of which part within "
            f"{PRINTED['pairs'].text} of Eq. 35. In the consistent model they do so where nothing damps them; damped "
            "ones part later (App. A under Other numbers of the text). Under the printed equations a pair is the "
            "simplest solid grain, and what was said of these gives where it parts; runs of the engine are within 2 % "
            "of it (`tests/test_pair_test.py`). The table has this omega over Eq. 35, at the printed step, f = "
            f"{PRINTED_STEP:g}, for the smallest and the largest pair of each material, with damping, "
            f"which Eq. 29 lacks{_undamped(data)}.",
            markdown_table(head, rows),
            "With the exact Coriolis term all pairs part too late. With the explicit one, small and large pairs cannot "
            "both part at Eq. 35: with one d omega/dt for all, from "
            f"{number(RATES[0])} to {number(RATES[-1])} rad/s², omega over Eq. 35 of the largest pair of a material is "
            f"at least {number(least_factor(ends))} times that of the smallest. So, with either form of that term and "
            "one d omega/dt for all pairs, Fig. 10 does not follow from the printed equations, and it does from the "
            "consistent model without damping; Fig. 7 lies above what the contacts of a grain that turns as a whole "
            "can hold. Whether both figures were made with the same equations is not known.",
        ]
    )


def _undamped(data):
    """Words on the exact term without damping, where such pairs are part of the data."""
    ends = smallest_and_largest(data.pairs, "undamped")
    if ends is None:
        return ""
    ends = with_share_and_step(ends, data.plan.materials)
    exact = ends["parting_omega"] / ends["eq35_omega"] / ends["share"]
    return f"; without, the exact term gives {between(exact.min(), exact.max())} times"


def in_short(data):
    """A line for the head of the document.

    Parameters
    ----------
    data : ratd.reproduction.data.Data

    Returns
    -------
    list of str
        Empty without pairs or without a calibration.
    """
    ends = smallest_and_largest(data.pairs)
    if ends is None or _calibrated(data) is None:
        return []
    ends = with_share_and_step(ends, data.plan.materials)
    cells = _cells(ends, explicit_over(ends, _calibrated(data)))
    told = " and ".join(f"{cell} (monomers of {size})" for cell, size in zip(cells, _sizes(ends), strict=True))
    exact = ends["parting_omega"] / ends["eq35_omega"] / ends["share"]
    return [
        f"**Pairs of monomers (Fig. 10)**, the paper's own test, part within {PRINTED['pairs'].text} of Eq. 35 in the "
        "paper, and in the consistent model where nothing damps them. Under the printed equations they would part at "
        f"{told} times Eq. 35 with the calibrated d omega/dt, and at {number(exact.min())} times and more with an "
        "exact Coriolis term (all of them damped, unlike Eq. 29): with either form of it, and one d omega/dt for all "
        "pairs, Fig. 10 does not follow from the printed equations."
    ]


def _calibrated(data):
    """Calibrated d omega/dt [rad/s2], None where it is not known."""
    rate = np.nan if data.calibration is None else data.calibration["calibrated"].item()
    return rate if np.isfinite(rate) else None


def _sizes(ends):
    return [f"{radius / NM:.3g} nm" for radius in sorted(ends["monomer_radius"].unique())]


def _cells(ends, over):
    """Least and greatest of the pairs of each radius, text."""
    return [
        number(own.min()) if number(own.min()) == number(own.max()) else between(own.min(), own.max())
        for _, own in over.groupby(ends["monomer_radius"])
    ]


def smallest_and_largest(pairs, start="damped"):
    """The smallest and the largest pair of each material that start in one way and part.

    Parameters
    ----------
    pairs : pandas.DataFrame or None
        Columns of `ratd.pair.PAIR_COLUMNS`.
    start : {"damped", "undamped"}

    Returns
    -------
    pandas.DataFrame or None
        None without any.
    """
    if pairs is None:
        return None
    here = pairs[(pairs["start"] == start) & pairs["parting_omega"].notna()]
    radius = here.groupby("material")["monomer_radius"]
    return here.loc[[*radius.idxmin(), *radius.idxmax()]].reset_index(drop=True) if len(here) else None


def printed_step(material, radius):
    """Time step of the paper for two equal monomers in contact, f = `ratd.calibration.PRINTED_STEP`.

    Parameters
    ----------
    material : ratd.Material
    radius : float
        [m]

    Returns
    -------
    float
        [s], f t_dis.

    References
    ----------
    Reissl et al. (2024), A&A 692, A60, Eq. 31.
    """
    R = reduced_radius(radius, radius)
    contact = equilibrium_contact_radius(R, material.surface_energy, material.reduced_modulus)
    mass = 4 / 3 * np.pi * material.density * radius**3
    return PRINTED_STEP * dissipation_time(mass, R, contact, material.surface_energy)


def with_share_and_step(pairs, materials):
    """Pairs of equal monomers with what `ratd.solid.solid_omega` asks for.

    Parameters
    ----------
    pairs : pandas.DataFrame
        Columns material and monomer_radius [m].
    materials : mapping
        Name -> `ratd.Material`.

    Returns
    -------
    pandas.DataFrame
        With share, that of the spins in the moment of inertia, 0.8/2.8 but for the overlap of the monomers, and
        timestep [s], the printed step.
    """
    rows = []
    for name, radius in zip(pairs["material"], pairs["monomer_radius"], strict=True):
        material = materials[name]
        constants = reduced_radius(radius, radius), material.surface_energy, material.reduced_modulus
        mass = 4 / 3 * np.pi * material.density * radius**3
        moment = mass * (2 * (radius - equilibrium_compression(*constants) / 2) ** 2 + 0.8 * radius**2)
        share = ensemble.spin_share(np.full(2, radius), material.density, moment)
        rows.append({"share": share, "timestep": printed_step(material, radius)})
    return pairs.assign(**pd.DataFrame(rows, index=pairs.index))


def explicit_over(pairs, rate):
    """omega at which pairs part under the printed equations, explicit Coriolis term, over Eq. 35.

    Parameters
    ----------
    pairs : pandas.DataFrame
        From `with_share_and_step`, with parting_omega [rad/s] of the consistent model and eq35_omega [rad/s].
    rate : float
        d omega/dt [rad/s2].

    Returns
    -------
    pandas.Series
        See `ratd.solid.solid_omega`.
    """
    columns = pairs[["parting_omega", "share", "timestep"]].to_numpy(float)
    parted = [solid_omega(threshold, share, rate, step)[0] for threshold, share, step in columns]
    return pd.Series(parted, index=pairs.index) / pairs["eq35_omega"]


def least_factor(pairs):
    """Least ratio, among all of `RATES`, of `explicit_over` of the largest pair of a material to that of the smallest.

    Parameters
    ----------
    pairs : pandas.DataFrame
        See `explicit_over`.

    Returns
    -------
    float
    """
    factors = []
    for _, own in pairs.groupby("material"):
        own = own.sort_values("monomer_radius")
        over = [explicit_over(own, rate) for rate in RATES]
        factors += [one.iloc[-1] / one.iloc[0] for one in over]
    return min(factors)
