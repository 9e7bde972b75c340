"""Fig. 7 of Kataoka et al. (2013): the pressure for different normal damping."""

import numpy as np

from ratd.experiments.compression.figures.common import (
    COLOURS, DASHES, damping_of, draw_curves, draw_line, finish, read_sets, runs_text, strain_text, two_panels,
)  # fmt: skip
from ratd.experiments.compression.strength import of_means, of_same_clusters
from ratd.experiments.compression.tables import bins
from ratd.pictures.style import styled


@styled
def figure7(tables):
    """Mean pressures of sets with different k_n, of the same clusters; below over that of the set in their middle.

    The curves above cover each other: what tells them apart is below, with bands of one standard error.
    """
    tables = of_same_clusters(tables)
    middle = len(tables) // 2
    labels = [rf"$k_\mathrm{{n}}$ = {damping_of(table):g}, {runs_text(table)}" for table in tables]
    title = f"{tables[0].attrs['material']}, N = {tables[0]['n_monomers'].item()}, {strain_text(tables[0])}"
    figure, above, below = two_panels(title)
    draw_curves(above, None, tables, labels)
    draw_line(above, tables[0])
    for k, table in enumerate(tables):
        if k != middle:
            phi, ratio, error = over(table, tables[middle])
            below.plot(phi, ratio, color=COLOURS[k % 5], ls=DASHES[k % 5])
            below.fill_between(phi, ratio - error, ratio + error, color=COLOURS[k % 5], alpha=0.2, lw=0)
    finish(figure, above)
    of_middle = rf"$P\,/\,P(k_\mathrm{{n}} = {damping_of(tables[middle]):g})$"
    below.set(yscale="linear", ylim=(0.6, 1.4), ylabel=of_middle)
    return figure


def over(table, other):
    """Mean pressure of a set over that of the same clusters in another, where both are static.

    Returns
    -------
    phi, ratio, error : (k,) array
    """
    numbers = [bins(each["phi"].values) for each in (table, other)]
    _, own, others = np.intersect1d(*numbers, return_indices=True)
    both = np.stack([table["pressure"].values[:, own], other["pressure"].values[:, others]], axis=1)
    phi = table["phi"].values[own]
    static = phi > max(each["static_from"].values[0] for each in (table, other))
    good = np.isfinite(both).all(axis=(0, 1)) & (both.mean(axis=0) > 0.0).all(axis=0) & static
    fit = of_means(both[:, :, good], lambda mean: mean[0] / mean[1])
    return phi[good], fit.value, fit.error


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return figure7(read_sets(files))
