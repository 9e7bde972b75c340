"""Figures of the paper, drawn from tables and Datasets; each function returns a matplotlib Figure."""

from ratd.experiments.spin_up.figures.calibration import calibration
from ratd.experiments.spin_up.figures.figure1 import figure1
from ratd.experiments.spin_up.figures.figure2 import figure2
from ratd.experiments.spin_up.figures.figure4 import figure4
from ratd.experiments.spin_up.figures.figure5 import figure5
from ratd.experiments.spin_up.figures.figure6 import figure6
from ratd.experiments.spin_up.figures.figure7 import figure7
from ratd.experiments.spin_up.figures.figure8 import figure8
from ratd.experiments.spin_up.figures.figure9 import figure9
from ratd.experiments.spin_up.figures.figure10 import figure10
from ratd.experiments.spin_up.figures.formulae import formulae
from ratd.pictures.style import save

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
