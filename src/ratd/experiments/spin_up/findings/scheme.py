"""What the document tells of the scheme of the spin-up: marks of the same grains, with one thing changed."""

import numpy as np

from ratd.base.measured import geometric_mean, median
from ratd.experiments.spin_up.cells import GRAIN
from ratd.experiments.spin_up.findings.claims import is_near_quarter
from ratd.experiments.spin_up.marks import MARK
from ratd.experiments.spin_up.size_law import SPLIT

__all__ = ["of_scheme", "paired"]

CHANGES = {"slow": ("pace", 0.005), "torque": ("drive", 1.0), "drag": ("drag", 0.3)}
"""Word -> what is changed, and its value, as in the check ``quasi_static``: a quarter of the pace, a torque in place of
a given omega, a third of the drag."""
MARKS = {"quarter": MARK, "disr": "omega_disr"}


def paired(table, own, vary, value):
    """Rows of one change beside those of production of the same grain.

    Parameters
    ----------
    table : pandas.DataFrame
        Of the check ``quasi_static``. A grain that two groups of it hold counts once.
    own : pandas.DataFrame
        Its rows of production, a grain once.
    vary : str
    value : float

    Returns
    -------
    pandas.DataFrame
        In the order of `table`; columns of `own` that both have end with ``_own``.
    """
    part = table[(table["vary"] == vary) & np.isclose(table["value"], value, atol=0.0)].drop_duplicates(GRAIN)
    return part.merge(own, on=GRAIN, suffixes=("", "_own"))


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
    usual = table[table["vary"] == "production"].drop_duplicates(GRAIN)
    values = {}
    for word, (name, value) in CHANGES.items():
        every = paired(table, usual, name, value).dropna(subset=_both())
        own = every[(every["type"] == "BA") & (every["a_eff"] > 0.99 * SPLIT)]
        values[f"scheme.{word} grains"] = len(own)
        for short, mark in MARKS.items():
            values[f"scheme.{word} {short}"] = geometric_mean(own[mark] / own[f"{mark}_own"])
        values[f"scheme.{word} all"] = geometric_mean(every[MARK] / every[f"{MARK}_own"])
        for behind, when in (("_own", "before"), ("", "after")):
            values[f"scheme.{word} {when}"] = median(own[f"omega_disr{behind}"] / own[f"{MARK}{behind}"])
    verdicts = {is_near_quarter(values[f"scheme.slow {when}"]) for when in ("before", "after")}
    values["scheme.holds quarter BA large"] = verdicts.pop() if len(verdicts) == 1 else "open"
    return values


def _both():
    return [f"{mark}{behind}" for mark in MARKS.values() for behind in ("", "_own")]
