"""The pressure of a cluster while its box shrinks, and while it grows again."""

from matplotlib.ticker import MaxNLocator

from ratd.experiments.compression.figures.common import COLOURS, DASHES
from ratd.pictures.style import ONE_COLUMN, new_figure, styled

LEAST = 0.4
"""Filling factor over that of the turn from which on the figure shows it: below nothing presses."""
WAYS = {"in": "box shrinks", "out": "box grows"}


@styled
def spring_back(table):
    """Pressure of each cluster against the volume of its box over that of its monomers, a panel for each turn.

    Areas are the work of the box over the volume of the monomers, as they would not be against phi.

    Parameters
    ----------
    table : pandas.DataFrame
        Of the kind ``validation_spring_back``.
    """
    turns = sorted(table["until_phi"].unique())
    figure = new_figure(ONE_COLUMN, 0.75 * len(turns) * ONE_COLUMN, "pressure of a box that shrinks and grows")
    for axes, turn in zip(figure.subplots(len(turns), squeeze=False).flat, turns, strict=True):
        part = table[(table["until_phi"] == turn) & (table["phi"] > LEAST * turn)]
        for (_, way), rows in part.groupby(["seed", "way"]):
            k = list(WAYS).index(way)
            axes.plot(1.0 / rows["phi"], rows["pressure"], color=COLOURS[k], ls=DASHES[k], lw=1.0)
        for k, label in enumerate(WAYS.values()):
            axes.plot([], [], color=COLOURS[k], ls=DASHES[k], label=label)
        axes.xaxis.set_major_locator(MaxNLocator(5))
        axes.axhline(0.0, color="black", lw=0.8)
        axes.set(xlabel=r"volume of the box over that of the monomers, $1/\phi$", ylabel=r"pressure $P$ [Pa]")
        axes.legend(loc="upper right")
    return figure
