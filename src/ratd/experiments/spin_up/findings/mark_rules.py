"""What the document tells of omega_disr by other rules, see `ratd.validation.mark_rules`."""

import numpy as np

from ratd.base.measured import Measured, geometric_mean
from ratd.base.statistics import slope_error, slope_of
from ratd.base.units import NM
from ratd.experiments.spin_up.cells import GRAIN, TYPES, size_key
from ratd.experiments.spin_up.marks import MAJORITY, MEDIAN_WINDOW

__all__ = ["of_mark_rules"]

LARGE = 299.0
"""Sizes from this one on count for the power of size [nm]."""
MOVED = 0.1
"""Part by which a mark has moved that is told of."""


def of_mark_rules(table):
    """omega_disr by each rule over that by the usual one, of the same grains.

    Parameters
    ----------
    table : pandas.DataFrame
        Of the kind ``validation_mark_rules``.

    Returns
    -------
    dict
        ``rules.grains``; for a window and a majority, such as ``rules.9 0.5 BA``, the geometric mean of the ratio, with
        `` moved`` behind it the share of grains whose mark moves by more than `MOVED`, with `` power`` what the power
        of size of large grains changes by; ``rules.most moved`` the greatest share, ``rules.farthest power`` the
        greatest change of a power.
    """
    usual = (table["window"] == MEDIAN_WINDOW) & (table["majority"] == MAJORITY)
    beside = table[usual].set_index(GRAIN)["omega_disr"]
    values = {"rules.grains": len(beside)}
    powers, shares = [], []
    for (window, majority), part in table[~usual].groupby(["window", "majority"]):
        part = part.set_index(GRAIN)
        ratio = (part["omega_disr"] / beside).dropna().rename("ratio").reset_index()
        for kind in TYPES:
            own = ratio[ratio["type"] == kind]
            start = f"rules.{window:g} {majority:g} {kind}"
            large = own[own["a_eff"] > LARGE * NM]
            values[start] = geometric_mean(own["ratio"], size_key(own["a_eff"]))
            values[f"{start} moved"] = float((np.abs(own["ratio"] - 1.0) > MOVED).mean())
            power, influence = slope_of(np.log(large["a_eff"]), np.log(large["ratio"]))
            values[f"{start} power"] = Measured(power, slope_error(influence))
            shares.append(values[f"{start} moved"])
            powers.append(values[f"{start} power"].value)
    values["rules.most moved"] = max(shares)
    values["rules.farthest power"] = max(powers, key=abs)
    return values
