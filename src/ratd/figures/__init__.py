"""Figures of the paper, drawn from tables and Datasets; each function returns a matplotlib Figure."""

from ratd.figures.calibration import calibration
from ratd.figures.figure1 import figure1
from ratd.figures.figure2 import figure2
from ratd.figures.figure4 import figure4
from ratd.figures.figure5 import figure5
from ratd.figures.figure6 import figure6
from ratd.figures.figure7 import figure7
from ratd.figures.figure8 import figure8
from ratd.figures.figure9 import figure9
from ratd.figures.figure10 import figure10
from ratd.figures.formulae import formulae
from ratd.figures.style import save

__all__ = [
    "calibration",
    "figure1",
    "figure5",
    "figure10",
    "figure2",
    "figure4",
    "figure6",
    "figure7",
    "figure8",
    "figure9",
    "formulae",
    "save",
]
