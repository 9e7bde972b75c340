"""What the document tells of grains that radiation destroys."""

import math
from functools import partial

import numpy as np
from scipy.optimize import brentq

from ratd.base.measured import Measured
from ratd.base.units import NM
from ratd.experiments.spin_up.cells import TYPES
from ratd.experiments.spin_up.radiation import DIFFUSE, INFRARED, grain_temperature, infrared_of, omega_rat
from ratd.experiments.spin_up.surviving import COMPUTED, surviving

__all__ = ["NONE", "of_radiation"]

SURROUNDINGS = {
    "one star": DIFFUSE._replace(anisotropy=1.0, wavelength=0.5e-6),
    "directed": DIFFUSE._replace(anisotropy=0.7),
    "bluer": DIFFUSE._replace(wavelength=0.8e-6),
    "a third": DIFFUSE._replace(anisotropy=DIFFUSE.anisotropy / 3.0),
    "thrice": DIFFUSE._replace(anisotropy=3.0 * DIFFUSE.anisotropy),
    "denser": DIFFUSE._replace(hydrogen=10.0 * DIFFUSE.hydrogen),
}
"""Name of a variant -> what surrounds the grain; the torque goes with the anisotropy."""
SURFACE_ENERGIES = {"half gamma": 0.5, "five gamma": 5.0}
"""Name of a variant -> surface energy over that of the material; five times that of q-S is that of ice."""
DMT = math.sqrt(4.0 / 3.0)
"""omega that a pull-off force 4/3 as great would hold, over that of JKR; driven grains come to 1.11 to 1.15."""
BILLION = (50, 100, 300)
"""Sizes [nm]."""
FARTHEST = 2.0 * COMPUTED[1]
"""Greatest size [m] that is told: the laws are of grains half as large."""
NONE = "none"
"""What stands in a document where no size is destroyed."""
HARDLY = 1.03
"""Sizes that light weaker by this factor would leave whole, all of them, count as not destroyed: where it just touches
omega of disruption, the smallest size says nothing, and the torque is not known so well."""

WAYS = {
    "": {},
    " porous": {"porous": True},
    " wide": {"porous": True, "wide": True},
    " graphite": {"coefficient": INFRARED},
}
"""Ways to count, by the word behind their slots."""


def of_radiation(table, grown, strengths=(1.0, 1e2, 1e4), mark="omega_mass_75", shown=("q-S", 1e2), **options):
    """Smallest and greatest sizes that radiation destroys.

    Parameters
    ----------
    table, grown
        As of `ratd.experiments.spin_up.surviving.surviving`.
    strengths : sequence of float
        U of the radiation.
    mark : str
        Which omega is ours.
    shown : (str, float)
        Material and strength for which variants are told.
    **options
        Of `surviving`, but those of `WAYS`.

    Returns
    -------
    dict
        "radiation.q-S BAM1 100 ours" -> a_disr [nm] as a `Measured`, or the text `NONE` where no size is destroyed, or
        only `HARDLY`; the same with "printed" for "ours", and with " porous" behind it, where gas hits all of the
        porous grain, with " wide" where light does so too, or with " graphite", where the grain sheds infrared light
        as graphite does.
        With " greatest" behind it the largest size that is destroyed, `NONE` also where there is no end to them, and
        with " range" the text of both drags. With "over" for "ours" ours over the printed one. "radiation.most error"
        is the greatest relative error of ours for the material of `shown`. For `shown` also, without errors, with
        " first" the first loss in place of the mark, with " DMT" omega `DMT` times as great; for its material, with a
        name of `SURROUNDINGS` or `SURFACE_ENERGIES`, and as "radiation.most around ours" the greatest factor by which
        one of the former moves it;
        ``radiation.SIZE billion`` and ``radiation.SIZE billion K`` of `_billion`.
    """
    values = _billion(shown[0])
    for behind, how in WAYS.items():
        values |= _sizes(table, grown, strengths, behind, mark=mark, **how, **options)
    for key in [key for key in values if key.endswith((" ours", " printed"))]:
        ends = [_text(values[key + behind]) for behind in ("", " porous")]
        values[f"{key} range"] = " to ".join(dict.fromkeys(ends))
    material, strength = shown
    told = [values[f"radiation.{material} {kind} {each:g} ours"] for kind in TYPES for each in strengths]
    values["radiation.most error"] = max(size.error / size.value for size in told if size != NONE)
    own = table[table["material"] == material]
    plain = {"draws": 0} | {name: value for name, value in options.items() if name != "draws"}
    values |= _sizes(own, grown, [strength], " first", mark="omega_first_loss", **plain)
    values |= _sizes(own.assign(**{mark: DMT * own[mark]}), grown, [strength], " DMT", mark=mark, **plain)
    for name, around in SURROUNDINGS.items():
        values |= _sizes(own, grown, strengths, f" {name}", mark=mark, around=around, **plain)
    for name, factor in SURFACE_ENERGIES.items():
        values |= _sizes(own, grown, strengths, f" {name}", mark=mark, surface_energy=factor, **plain)
    for law in ("ours", "printed"):
        every = [f"radiation.{material} {kind} {strength:g} {law}" for kind in TYPES]
        moved = [
            abs(math.log(values[f"{key} {name}"].value / values[key].value))
            for key in every
            for name in SURROUNDINGS
            if NONE not in (values[key], values[f"{key} {name}"])
        ]
        values[f"radiation.most around {law}"] = math.exp(max(moved, default=math.nan))
    return values


def _billion(material):
    """Strength U of light that turns grains at 1e9 rad/s, and how warm they are in it [K], of some sizes [nm]."""
    values = {}
    for size in BILLION:
        excess = partial(_short_of, 1e9, size * NM, infrared_of(material))
        strength = values[f"radiation.{size} billion"] = math.exp(brentq(excess, 0.0, 30.0))
        values[f"radiation.{size} billion K"] = float(grain_temperature(strength))
    return values


def _short_of(omega, size, coefficient, log_strength):
    return math.log(float(omega_rat(size, math.exp(log_strength), coefficient=coefficient)) / omega)


def _text(size):
    return size if isinstance(size, str) else f"{size.value:.0f}"


def _sizes(table, grown, strengths, behind, around=DIFFUSE, **how):
    """Slots of one way to count, with its name behind them."""
    values, ours = {}, {}
    sizes = surviving(table, grown, strengths, around=around, **how)
    weaker = around._replace(anisotropy=around.anisotropy / HARDLY)
    hardly = surviving(table, grown, strengths, around=weaker, **(how | {"draws": 0}))["a_disr"].isna()
    sizes.loc[hardly, ["a_disr", "a_disr_error", "greatest"]] = np.nan
    for row in sizes.to_dict("records"):
        start = f"radiation.{row['material']} {row['type']} {row['strength']:g}"
        key = f"{start} {row['law']}{behind}"
        for end, size, error in (("", "a_disr", row["a_disr_error"]), (" greatest", "greatest", np.nan)):
            found = np.isfinite(row[size])
            values[key + end] = Measured(row[size] / NM, error / NM) if found else NONE
        if row["a_disr"] > FARTHEST:
            values[key] = f"over {FARTHEST / NM:.0f}"
        if row["law"] == "ours":
            ours[start] = row["a_disr"]
        else:
            ratio = ours[start] / row["a_disr"]
            values[f"{start} over{behind}"] = ratio if np.isfinite(ratio) else NONE
    return values
