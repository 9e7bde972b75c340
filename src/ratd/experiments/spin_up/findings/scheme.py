"""What the document tells of the scheme of the spin-up: marks of the same grains, with one thing changed."""

import numpy as np

from ratd.base.measured import geometric_mean, median
from ratd.experiments.spin_up.cells import GRAIN, joined
from ratd.experiments.spin_up.findings.claims import is_near_quarter
from ratd.experiments.spin_up.marks import MARK
from ratd.experiments.spin_up.size_law import SPLIT

__all__ = ["of_scheme"]

CHANGES = {"slow": ("pace", 0.005), "torque": ("drive", 1.0), "drag": ("drag", 0.3)}
"""Word -> what is changed, and its value, as in the check ``quasi_static``: a quarter of the pace, a torque in place of
a given omega, a third of the drag."""
MARKS = {"quarter": MARK, "disr": "omega_disr"}


def of_scheme(table):
    """Marks of BA from `SPLIT` on with one thing changed, over those of the same grains as in the ensemble.

    Parameters
    ----------
    table : pandas.DataFrame
        Of the check ``quasi_static``.

    Returns
    -------
    dict
        For a word of `CHANGES`, such as ``scheme.slow``: ``grains``; ``quarter`` and ``disr``, geometric means of the
        ratio; ``before`` and ``after``, the median of omega_disr over a quarter. ``scheme.torque all`` is the mean of
        the quarter of all grains. ``scheme.holds quarter BA large`` is the verdict on omega_disr over a quarter, open
        where it hangs on the pace.
    """
    # two parts of the check have some of the grains both
    usual = table[table["vary"] == "production"].drop_duplicates(GRAIN)
    values = {}
    for word, (name, value) in CHANGES.items():
        changed = table[(table["vary"] == name) & np.isclose(table["value"], value, atol=0.0)].drop_duplicates(GRAIN)
        every = joined(changed, usual, list(MARKS.values()), suffix="_usual").dropna(subset=_both())
        own = every[(every["type"] == "BA") & (every["a_eff"] > 0.99 * SPLIT)]
        values[f"scheme.{word} grains"] = len(own)
        for short, mark in MARKS.items():
            values[f"scheme.{word} {short}"] = geometric_mean(own[mark] / own[f"{mark}_usual"])
        values[f"scheme.{word} all"] = geometric_mean(every[MARK] / every[f"{MARK}_usual"])
        for behind, when in (("_usual", "before"), ("", "after")):
            values[f"scheme.{word} {when}"] = median(own[f"omega_disr{behind}"] / own[f"{MARK}{behind}"])
    verdicts = {is_near_quarter(values[f"scheme.slow {when}"]) for when in ("before", "after")}
    values["scheme.holds quarter BA large"] = verdicts.pop() if len(verdicts) == 1 else "open"
    return values


def _both():
    return [f"{mark}{behind}" for mark in MARKS.values() for behind in ("", "_usual")]
