"""Fig. 4 of Kataoka et al. (2013): pressure against filling factor, single clusters and their mean."""

import numpy as np

from ratd.experiments.compression.figures.common import (
    BEFORE,
    draw_curves,
    draw_line,
    finish,
    looks_of,
    read_sets,
    seeds_text,
    strain_text,
    two_panels,
)
from ratd.experiments.compression.strength import mean_pressure
from ratd.pictures.style import GREY, styled


@styled
def figure4(tables):
    """Pressures of all clusters grey, the mean of each set coloured with its standard error, P_0 phi^3 black.

    The first set tells from where on it is static.
    """
    first = tables[0]
    figure, above, below = two_panels(f"{first.attrs['material']}, {strain_text(first)}")
    draw_curves(above, below, tables, [_label(table) for table in tables], looks_of(tables))
    _single_clusters(above, tables)
    start = first["static_from"].values[0]
    # below the legend, and over the curves
    for axes, top in ((above, 0.68), (below, 1.0)):
        axes.axvline(start, ymax=top, color="black", lw=0.6, ls=":")
    below.text(start, 0.96, r" static $\rightarrow$", transform=below.get_xaxis_transform(), va="top")
    draw_line(above, tables[-1])
    return finish(figure, above, below)


def _single_clusters(axes, tables):
    """Pressures of all clusters, behind the curves and cut where the axes of these end."""
    bottom, label = axes.get_ylim()[0], "single clusters"
    for table in tables:
        static = table["phi"].values > BEFORE * table["static_from"].values[0]
        for pressure in table["pressure"].values:
            value = np.where(static & (pressure > 0.0), pressure, np.nan)
            axes.plot(table["phi"], value, color=GREY, lw=0.4, zorder=1, label=label)
            label = None
    axes.set_ylim(bottom=bottom)


def _label(table):
    """How many clusters a mean is of, and up to which filling factor it goes."""
    last = table["phi"].values[np.isfinite(mean_pressure(table)[0])].max()
    return rf"mean of {seeds_text(table)}, to $\phi$ = {last:.2g}".removeprefix("mean of 1 ")


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return figure4(read_sets(files))
