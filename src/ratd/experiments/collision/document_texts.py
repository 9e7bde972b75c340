"""How docs/collision.md writes a number with its error, and a radius with its range."""

import numpy as np

from ratd.aggregates.mrn import moment_of_length
from ratd.base.units import NM

__all__ = ["moment_text", "radius_text", "with_error"]

LENGTHS = ("radius", "radius_low", "radius_high")
"""Columns of the radius that a cluster is like, and of its range."""


def with_error(mean, error, digits=None):
    """Such as "0.16 ± 0.03", as many decimals as make two digits of the error; the value alone without an error."""
    if not np.isfinite(mean):
        return "–"
    if not (np.isfinite(error) and error > 0.0):
        return f"{mean:.2f}" if digits is None else f"{mean:.{digits}f}"
    if digits is None:
        digits = min(3 if error >= 0.0005 else 4, max(0, 1 - int(np.floor(np.log10(error)))))
    return f"{mean:.{digits}f} ± {error:.{digits}f}"


def radius_text(row):
    """The radius [nm] that a cluster is like, and from 16 to 84 %; a row of `likeness_table`."""
    return _alike([row[name] / NM for name in LENGTHS], row["at_end"], 0)


def moment_text(row, smallest):
    """The moment q of the law from `smallest` [m] on that has this radius."""
    return _alike([moment_of_length(row[name], smallest) for name in LENGTHS], row["at_end"], 1)


def _alike(numbers, at_end, digits):
    """The best number and its ends, 16 and 84 %."""
    if not np.isfinite(numbers[0]):
        return "–"
    best, low, high = (f"{number:.{digits}f}" for number in numbers)
    return f"{best} ({low}–{high})" + (" (end of the range)" if at_end else "")
