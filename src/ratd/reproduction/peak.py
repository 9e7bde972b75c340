"""Rows of the peak of the stress, and of what leaves at once (Fig. 4, Sects. 7.1 and 8)."""

import numpy as np

from ratd.ensemble import cell_of
from ratd.marks import running_median
from ratd.reproduction.text import Answer, all_of, between, drive_rows, lies_in, number, with_error
from ratd.statistics import median_of

STEADY = 0.1
"""Fall of the stress over its peak up to which it rises steadily."""
ABRUPT = 1.1
"""omega over omega_disr up to which a fall to half is abrupt."""
QUARTER = (0.15, 0.35)
"""Loss of mass that is roughly a quarter."""
SMALL = 0.1
"""Part of the mass that a grain may lose at once while it loses its mass continuously."""


def rows(data):
    """Rows of the peak, list of Row."""
    return [
        drive_rows("stress_rise", data.course, _of_runs(greatest_fall, STEADY)),
        drive_rows(
            "stress_drop",
            data.course,
            _of_runs(omega_of_half, ABRUPT),
            "In part by definition: the peak is looked for before half of the mass is lost.",
        ),
        drive_rows(
            "peak_mass",
            data.tables,
            lambda table, p: _of_types(table, lambda own: 1 - own["mass_fraction_disr"], *QUARTER),
            "Where a grain parts at once the stress peaks just before any mass is lost; where pieces have left before, "
            "it peaks in what is left.",
        ),
        drive_rows(
            "abrupt",
            {drive: _largest_pieces(table) for drive, table in data.fragments.items()},
            lambda table, p: _of_types(table, lambda own: own["mass_fraction"], -np.inf, SMALL),
            "A piece is one fragment as it leaves, not all that leave within a record.",
        ),
    ]


def _of_runs(measure, limit):
    """What evaluates the median over runs of what is measured of each, which is to lie below a limit."""

    def evaluate(runs, printed):
        values = np.array([measure(run, mark) for run, mark in runs])
        values = values[np.isfinite(values)]
        if not len(values):
            return None
        middle = float(np.median(values))
        text = f"{number(middle)} ({between(values.min(), values.max())} of {len(values)})"
        return Answer(text, holds=bool(middle < limit))

    return evaluate


def _stress(run, mark):
    """Running median of the stress over the whole run, and the record of omega_disr; None where the run has none."""
    omega = float(mark["omega_disr"])
    stress = running_median(run["total_stress"].values)
    return stress, (int(np.searchsorted(run["omega"].values, omega * (1 - 1e-12))) if np.isfinite(omega) else None)


def greatest_fall(run, mark):
    """Greatest fall of the stress below what it was before, up to omega_disr.

    Parameters
    ----------
    run : xarray.Dataset
        A spin-up run, see `ratd.spin_up`.
    mark : xarray.Dataset
        Its marks, from `ratd.marks.disruption`.

    Returns
    -------
    float
        Over the stress at omega_disr; NaN for a run without it.
    """
    stress, peak = _stress(run, mark)
    if peak is None:
        return np.nan
    before = stress[: peak + 1]
    return float(np.max(np.maximum.accumulate(before) - before) / stress[peak])


def omega_of_half(run, mark):
    """omega at which the stress has fallen to half of its peak.

    Parameters
    ----------
    run : xarray.Dataset
        A spin-up run, see `ratd.spin_up`.
    mark : xarray.Dataset
        Its marks, from `ratd.marks.disruption`.

    Returns
    -------
    float
        That of the first such record behind the peak, over omega_disr; NaN where there is none.
    """
    stress, peak = _stress(run, mark)
    if peak is None:
        return np.nan
    low = np.flatnonzero(stress[peak:] <= 0.5 * stress[peak])
    omega = run["omega"].values[peak:]
    return float(omega[low[0]] / omega[0]) if len(low) else np.nan


def _largest_pieces(fragments):
    """The largest fragment of each grain among those of the first half of the mass, a row a grain."""
    half = fragments[fragments["half"]]
    return half.loc[half.groupby("grain")["mass_fraction"].idxmax()]


def _of_types(table, values, low, high):
    """Answer with the median of some values of each type, each of which is to lie between `low` and `high`."""
    parts, verdicts = [], []
    for kind, own in table.groupby("type", sort=False):
        found = median_of(values(own), cell=cell_of(own))
        if found["n"]:
            spread = between(found["low"], found["high"])
            parts.append(f"{kind} {with_error(found['median'], found['error'])} ({spread})")
            verdicts.append(lies_in(found["median"], found["error"], low, high))
    return Answer("; ".join(parts), holds=all_of(verdicts)) if parts else None
