"""Fig. 11 of Kataoka et al. (2013): how many monomers are near a monomer."""

import numpy as np

from ratd.experiments.compression.figures.common import COLOURS, DASHES, read_sets, seeds_text
from ratd.experiments.compression.tables import snapshots_at
from ratd.pictures.style import GREY, ONE_COLUMN, empty, logarithmic, new_figure, styled


@styled
def figure11(table, wanted=(0.003, 0.01, 0.03, 0.1)):
    """N(<r) at some filling factors, mean over seeds; thin, phi (r/r_0)^3; grey, a slope of 2."""
    figure = new_figure(ONE_COLUMN, 1.15 * ONE_COLUMN, f"{table.attrs['material']}, {seeds_text(table)}")
    axes = figure.subplots()
    distance, found = table["distance"].values, table["snapshot_phi"].values
    kept = snapshots_at(found, wanted)
    if not kept:
        empty(axes, "no snapshot at these filling factors")
    for k, (phi, at) in enumerate(kept.items()):
        numbers = table["number_within"].values[:, at]
        numbers = numbers[np.isfinite(numbers[:, 0])].mean(axis=0)
        label = rf"$\phi$ = {phi:g}"
        axes.plot(distance, numbers, color=COLOURS[k], ls=DASHES[k], label=label)
        uniform = "thin: uniform density" if k == len(kept) - 1 else None
        axes.plot(distance, found[at] * distance**3, color=COLOURS[k], lw=0.5, label=uniform)
    axes.plot(distance, 0.75 * distance**2, color=GREY, lw=0.8, label=r"$\propto r^2$")
    n = table["n_monomers"].item()
    axes.axhline(n, color="black", lw=0.6, ls=":")
    axes.text(2.1, 1.1 * n, "all monomers of the box")
    axes.set(xscale="log", yscale="log", xlabel=r"distance $r/r_0$", ylabel=r"$N(<r)$", ylim=(1, 6 * n), xlim=(2, 200))
    logarithmic(axes.xaxis)
    logarithmic(axes.yaxis)
    figure.legend(loc="outside lower center", ncols=2)
    return figure


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return figure11(read_sets(files)[0])
