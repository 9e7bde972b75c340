"""Fig. 7 of Kataoka et al. (2013): the pressure for different normal damping."""

from ratd.experiments.compression.figures.common import (
    damping_of, draw_curves, draw_line, draw_over, finish, read_sets, runs_text, strain_text, two_panels,
)  # fmt: skip
from ratd.experiments.compression.strength import of_same_clusters
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
    draw_over(below, tables, middle, rf"$P\,/\,P(k_\mathrm{{n}} = {damping_of(tables[middle]):g})$")
    below.set_ylim(0.6, 1.4)
    return finish(figure, above)


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return figure7(read_sets(files))
