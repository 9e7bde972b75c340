"""Whether grains are oblate, at rest and when they are disrupted."""

import numpy as np

from ratd.base.statistics import mean_of
from ratd.experiments.spin_up.cells import cell_of

__all__ = ["is_oblate", "oblate_change", "oblate_share"]


def is_oblate(a, b, c):
    """Whether ellipsoids of semi-axes a < b < c are oblate, b/a > c/b; False where an axis is not known."""
    return np.square(b) > np.multiply(a, c)


def oblate_share(table, when):
    """Share of oblate grains, all cells counting alike.

    Parameters
    ----------
    table : pandas.DataFrame
        One row a grain, of one drive.
    when : {"start", "disr"}
        At rest, or the largest fragment at omega_disr.

    Returns
    -------
    share, error : float
        See `ratd.base.statistics.mean_of`; NaN where no shape is known.
    n_oblate, n : int
        Oblate grains, and those whose shape is known.
    """
    known, oblate = _shapes(table, when)
    return *mean_of(oblate[known], cell_of(table[known])), int(oblate.sum()), int(known.sum())


def oblate_change(table, by_cell=True):
    """What the share of oblate grains gains from rest to omega_disr, of the grains whose shape is known at both.

    Parameters
    ----------
    table : pandas.DataFrame
        One row a grain, of one drive.
    by_cell : bool
        Whether all cells count alike; otherwise all grains do, where some cells have one or two.

    Returns
    -------
    change, error : float
        See `ratd.base.statistics.mean_of`, of what each grain changes: its two shapes are alike, so that the errors of
        the two shares do not add up.
    """
    (known, before), (known_after, after) = (_shapes(table, when) for when in ("start", "disr"))
    both = known & known_after
    return mean_of(after[both].astype(float) - before[both], cell_of(table[both]) if by_cell else None)


def _shapes(table, when):
    """Whether the shape of each grain is known, and whether it is oblate."""
    axes = [table[f"axis_{axis}_{when}"].to_numpy(float) for axis in "abc"]
    known = np.isfinite(axes).all(axis=0) & (axes[0] > 0)
    return known, known & is_oblate(*axes)
