"""Words, numbers and tables in texts and titles."""

import numpy as np

__all__ = ["markdown_table", "measured", "measured_range", "plural"]


def plural(n, word):
    """Such as '1 grain', '30 grains'."""
    return f"{n} {word}" if n == 1 else f"{n} {word}s"


def measured(value, error):
    """A value with its uncertainty, to two figures of the uncertainty, such as "1.013 ± 0.024"."""
    if not np.isfinite(value):
        return "–"
    if not 1e-12 * abs(value) < error < np.inf:  # less is the rounding of equal values
        return f"{value:.3g}"
    digits = max(0, 1 - int(np.floor(np.log10(error))))
    return f"{value:.{digits}f} ± {error:.{digits}f}"


def measured_range(found):
    """A median of `ratd.base.statistics.median_of` with its error and the range of 68 %, "1.02 ± 0.03 (0.98–1.05)"."""
    value = measured(found["median"], found["error"])
    return f"{value} ({found['low']:.2f}–{found['high']:.2f})" if found["n"] else value


def markdown_table(header, rows):
    """A table in Markdown.

    Parameters
    ----------
    header : sequence of str
    rows : sequence of sequences of str

    Returns
    -------
    str
    """
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join(map(str, line)) + " |" for line in lines)
