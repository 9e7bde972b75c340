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
def figure4(tables):
    """Pressures of all clusters grey, the mean of each set coloured with its standard error, P_0 phi^3 black.

    The first set tells from where on it is static.
    """
    first = tables[0]
    figure, above, below = two_panels(f"{first.attrs['material']}, {strain_text(first)}")
    singles = [(table["phi"], pressure) for table in tables for pressure in table["pressure"].values]
    for k, (phi, pressure) in enumerate(singles):
        value = np.where(pressure > 0.0, pressure, np.nan)
        above.plot(phi, value, color=GREY, lw=0.4, label=None if k else "single clusters")
    draw_curves(above, below, tables, [f"mean of {seeds_text(table)}".removeprefix("mean of 1 ") for table in tables])
    start = first["static_from"].values[0]
    # below the legend, and over the curves
    for axes, top in ((above, 0.68), (below, 1.0)):
        axes.axvline(start, ymax=top, color=COLOURS[0], lw=0.6, ls=":")
    below.text(
        start,
        0.96,
        r" static $\rightarrow$",
        color=COLOURS[0],
        transform=below.get_xaxis_transform(),
        va="top",
    )
    draw_line(above, tables[-1])
    # little of what is not static: there inertia is seen, and chance
    above.set_xlim(left=0.3 * start)
    return finish(figure, above, below)


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return figure4(read_sets(files))
