"""Fig. 12 of Kataoka et al. (2013): Fig. 4 for silicate."""

from ratd.experiments.compression.figures.figure4 import draw
from ratd.experiments.compression.figures.figure4 import figure4 as figure12

__all__ = ["draw", "figure12"]
