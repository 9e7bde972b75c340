"""Fig. 12 of Kataoka et al. (2013): Fig. 4 for silicate."""

from ratd.experiments.compression.figures.figure4 import draw

__all__ = ["draw"]
