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

RATES = 10.0 ** np.arange(6, 18.5, 0.5)
"""d omega/dt [rad/s2] among which the one is looked for that suits all pairs: from below an hour of drag time on."""


def section(data):
    """Where pairs part under the printed equations, over where they part as the paper says, Markdown."""
    ends = smallest_and_largest(data.pairs)
    if ends is None:
        return "The pairs are not part of the data."
    ends = with_share_and_step(ends, data.plan.materials)
    rates = {"one hour of drag time": OMEGA_RAT / HOUR}
    if data.calibration is not None and np.isfinite(data.calibration["calibrated"].item()):
        rates = {"calibrated": data.calibration["calibrated"].item()} | rates
    rows = [
        _row("explicit", f"{number(rate)} ({name})", ends, explicit_over(ends, rate)) for name, rate in rates.items()
    ]
    rows.append(_row("exact", "any", ends, 1 / ends["share"]))
    head = ["Coriolis term", "d omega/dt [rad/s²]", *(f"pairs of {size}" for size in _sizes(ends))]
    best, over = suiting_both(ends)
    return "\n\n".join(
        [
            "The paper tests its code with pairs of equal monomers (Fig. 10), all of which part within "
            f"{PRINTED['pairs'].text} of Eq. 35, as undamped ones of the consistent model do (App. A under Other "
            "numbers of the text). Under the printed equations a pair is the simplest solid grain, and what was said "
            "of these gives where it parts; runs of the engine are within 2 % of it (`tests/test_pair_test.py`). The "
            "table has this omega over that of the same pair in the consistent model, at the printed step, f = "
            f"{PRINTED_STEP:g}, for the smallest and the largest pair of each material.",
            markdown_table(head, rows),
            "So with neither form of the Coriolis term do the printed equations give what the paper finds: with the "
            "exact one all pairs part too late, and with the explicit one no d omega/dt suits small and large pairs "
            f"together. That which suits them best of those from {number(RATES[0])} to {number(RATES[-1])} rad/s² is "
            f"{number(best)} rad/s², with which they part at {between(over.min(), over.max())} times that omega. Fig. "
            "10 is what the consistent model gives; Fig. 7 lies above what the contacts of a grain that turns as a "
            "whole can hold. Whether both were made with the same equations is not known.",
        ]
    )


def in_short(data):
    """A line for the head of the document, in a list; nothing without pairs or calibration."""
    ends = smallest_and_largest(data.pairs)
    if ends is None or data.calibration is None:
        return []
    ends = with_share_and_step(ends, data.plan.materials)
    cells = _row("", "", ends, explicit_over(ends, data.calibration["calibrated"].item()))[2:]
    told = " and ".join(f"{cell} (of {size})" for cell, size in zip(cells, _sizes(ends), strict=True))
    return [
        f"**Pairs of monomers (Fig. 10)**, the paper's own test, part within {PRINTED['pairs'].text} of Eq. 35 in the "
        "paper, and in the consistent model where nothing damps them. Under the printed equations they would part at "
        f"{told} times the omega of the same pair in the consistent model with the calibrated d omega/dt, and at "
        f"{number((1 / ends['share']).mean())} times with an exact Coriolis term: Fig. 10 does not follow from the "
        "printed equations."
    ]


def _sizes(ends):
    return [f"{radius / NM:.3g} nm" for radius in sorted(ends["monomer_radius"].unique())]


def _row(coriolis, rate, ends, over):
    of_size = over.groupby(ends["monomer_radius"])
    return [coriolis, rate, *(number(own.min()) if len({number(one) for one in own}) == 1
                              else between(own.min(), own.max()) for _, own in of_size)]  # fmt: skip


def smallest_and_largest(pairs):
    """The smallest and the largest pair of each material that start at rest and part, a table; None without any."""
    if pairs is None:
        return None
    here = pairs[(pairs["start"] == "damped") & pairs["parting_omega"].notna()]
    radius = here.groupby("material")["monomer_radius"]
    return here.loc[[*radius.idxmin(), *radius.idxmax()]].reset_index(drop=True) if len(here) else None


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
        contact = equilibrium_contact_radius(*constants)
        step = PRINTED_STEP * dissipation_time(mass, constants[0], contact, material.surface_energy)
        rows.append({"share": share, "timestep": step})
    return pairs.assign(**pd.DataFrame(rows, index=pairs.index))


def explicit_over(pairs, rate):
    """omega at which pairs part under the printed equations, explicit Coriolis term, over that in the consistent model.

    Parameters
    ----------
    pairs : pandas.DataFrame
        From `with_share_and_step`, with parting_omega [rad/s] of the consistent model.
    rate : float
        d omega/dt [rad/s2].

    Returns
    -------
    pandas.Series
        See `ratd.solid.solid_omega`.
    """
    columns = pairs[["parting_omega", "share", "timestep"]].to_numpy(float)
    parted = [solid_omega(threshold, share, rate, step)[0] for threshold, share, step in columns]
    return pd.Series(parted, index=pairs.index) / pairs["parting_omega"]


def suiting_both(pairs):
    """Of `RATES` that with which all pairs part nearest to the consistent omega.

    Parameters
    ----------
    pairs : pandas.DataFrame
        See `explicit_over`.

    Returns
    -------
    rate : float
        d omega/dt [rad/s2] with the least of the greatest |ln of the ratio|.
    over : pandas.Series
        From `explicit_over` at that rate.
    """
    found = {rate: explicit_over(pairs, rate) for rate in RATES}
    best = min(found, key=lambda rate: np.abs(np.log(found[rate])).max())
    return float(best), found[best]
