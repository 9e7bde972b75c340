"""Which fragmentation velocities of a table can be set beside each other."""

import numpy as np

from ratd.base.units import NM
from ratd.experiments.collision.printed import RADII

__all__ = ["head_on", "is_close", "of_paper", "of_same_energy"]

VARIED = ("longer", "half_step", "slide_4", "twist_10", "roll_100", "tau_0.1ns", "tau_2ns", "tau_10ns")
"""Laws of the study in which what is changed is no number of two spheres that meet head-on."""
WIDEST = 0.35
"""A fragmentation velocity is told if the velocities tried on both sides are no farther apart than this part of it."""


def head_on(thresholds):
    """Those of central collisions under laws that differ in what two spheres feel that meet head-on, or by springs.

    Parameters
    ----------
    thresholds : pandas.DataFrame
        `ratd.experiments.collision.tables.THRESHOLDS`, as below.
    """
    return thresholds[(thresholds["impact_parameter"] == 0) & ~thresholds["law"].isin(VARIED)]


def is_close(thresholds):
    """Whether the velocities on both sides are near enough: Series of bool, or bool of one of its rows."""
    return thresholds["above"] - thresholds["below"] <= WIDEST * thresholds["velocity"]


def of_paper(thresholds):
    """Those of equal spheres of the six radii of the paper, built as the others are (p = 0.5)."""
    return thresholds[thresholds["cluster"].isin([f"{radius / NM:.0f}nm" for radius in RADII])]


def of_same_energy(thresholds):
    """Those of the surface energy of silica."""
    return thresholds[np.isclose(thresholds["surface_energy"], 0.025)]
