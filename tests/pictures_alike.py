"""Whether figures that are drawn anew look as the committed ones."""

import numpy as np
from matplotlib.image import imread

ALIKE = 0.002
"""Mean difference of the brightness of two pictures, 0 to 1, up to which they show the same: rounding and fonts of
another machine give less, a marker that is gone or a line that has moved gives more."""


def unlike(drawn, committed):
    """Names of the pictures in a folder that another lacks, or has with another look.

    Parameters
    ----------
    drawn, committed : pathlib.Path

    Returns
    -------
    list of str
    """
    return [path.name for path in sorted(drawn.glob("*.png")) if difference(path, committed / path.name) > ALIKE]


def difference(path, other):
    """Mean difference of two pictures, 1 where one is missing or has another size."""
    if not other.is_file():
        return 1.0
    first, second = imread(path), imread(other)
    return float(np.abs(first - second).mean()) if first.shape == second.shape else 1.0
