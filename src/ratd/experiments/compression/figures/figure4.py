"""Fig. 4 of Kataoka et al. (2013): pressure against filling factor, single clusters and their mean."""

import numpy as np

from ratd.experiments.compression.figures.common import (
    COLOURS,
    draw_curves,
    draw_line,
    finish,
    read_sets,
    seeds_text,
    strain_text,
    two_panels,
)
from ratd.pictures.style import GREY, styled


@styled
def figure4(table):
    """Pressures of all clusters of a set grey, their mean coloured with its standard error, P_0 phi^3 black."""
    figure, above, below = two_panels(f"{table.attrs['material']}, {seeds_text(table)}, {strain_text(table)}")
    for k, pressure in enumerate(table["pressure"].values):
        value = np.where(pressure > 0.0, pressure, np.nan)
        above.plot(table["phi"], value, color=GREY, lw=0.4, label=None if k else "single clusters")
    draw_curves(above, below, [table], ["mean"])
    start = table["static_from"].values[0]
    # below the legend, and over the curves
    for axes, top in ((above, 0.72), (below, 1.0)):
        axes.axvline(start, ymax=top, color=COLOURS[1], lw=0.6, ls=":")
    below.text(start, 0.96, " static from here", color=COLOURS[1], transform=below.get_xaxis_transform(), va="top")
    draw_line(above, table)
    return finish(figure, above, below)


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return figure4(read_sets(files)[0])
