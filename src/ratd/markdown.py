"""Numbers and tables in Markdown."""

import numpy as np

__all__ = ["markdown_table", "measured"]


def measured(value, error):
    """A value with its uncertainty, to two figures of the uncertainty, such as "1.013 ± 0.024"."""
    if not np.isfinite(value):
        return "–"
    if not np.isfinite(error) or error <= 0:
        return f"{value:.3g}"
    digits = max(0, 1 - int(np.floor(np.log10(error))))
    return f"{value:.{digits}f} ± {error:.{digits}f}"


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
