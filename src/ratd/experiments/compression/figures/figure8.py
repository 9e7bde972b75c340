"""Fig. 8 of Kataoka et al. (2013): where the energy goes."""

import numpy as np

from ratd.experiments.compression.figures.common import DASHES, PHI_LABEL, damping_of, read_sets, strain_text
from ratd.experiments.compression.losses import rates
from ratd.experiments.compression.strength import of_clusters
from ratd.pictures.style import ENERGY_COLOURS, ONE_COLUMN, logarithmic, new_figure, styled

WAY_DASHES = dict(zip(("rolling", "twisting", "sliding", "made", "damping"), DASHES, strict=True))
LOWEST = 1e-21
"""Lower end of the axis of energy [J]."""
LEAST = 0.03
"""Lower end of a band over its curve where the error is as great as the curve, which a logarithm cannot show."""
NAMES = {"damping": "damping and long steps", "made": "new contacts"}
"""What a curve is called where it is more than its name says."""


def panel(axes, table, text):
    """Energy dissipated while ln phi grows by 1, over N, by way, with bands of one standard error."""
    phi, _ = rates(table, ())
    n = table["n_monomers"].item()
    for way, colour in ENERGY_COLOURS.items():
        found = of_clusters(table.sizes["seed_number"], lambda own, way=way: rates(table, (way,), own)[1][way] / n)
        rate = np.where(found.value > 0.0, found.value, np.nan)
        axes.plot(phi, rate, color=colour, ls=WAY_DASHES[way], label=NAMES.get(way, way))
        # a curve below the axis has no band that reaches into it
        low = np.where(rate > LOWEST, np.maximum(rate - found.error, LEAST * rate), np.nan)
        axes.fill_between(phi, low, rate + found.error, color=colour, alpha=0.2, lw=0)
    axes.set(xscale="log", yscale="log", xlabel=PHI_LABEL, ylim=(LOWEST, 3e-14), xlim=(phi[0], 0.5))
    axes.set_title(text)
    logarithmic(axes.xaxis)
    logarithmic(axes.yaxis)


def panels(tables, texts, title):
    """One panel a set, above each other, with one legend."""
    figure = new_figure(ONE_COLUMN, (0.35 + 0.6 * len(tables)) * ONE_COLUMN, title)
    every = figure.subplots(len(tables), 1, sharex=True, squeeze=False)[:, 0]
    for axes, table, text in zip(every, tables, texts, strict=True):
        panel(axes, table, text)
        axes.set_ylabel(r"d$E$/d ln $\phi$ / $N$ [J]")
        axes.label_outer()
    every[0].legend(loc="upper left")
    return figure


@styled
def figure8(tables):
    """Energy dissipated by each way, sets with different k_n below each other."""
    texts = [rf"$k_\mathrm{{n}}$ = {damping_of(table):g}, N = {table['n_monomers'].item()}" for table in tables]
    return panels(tables, texts, f"{tables[0].attrs['material']}: energy dissipated, {strain_text(tables[0])}")


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return figure8(read_sets(files))
