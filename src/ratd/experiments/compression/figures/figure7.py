"""Fig. 7 of Kataoka et al. (2013): the pressure for different normal damping."""

from ratd.experiments.compression.figures.common import damping_of, pressures_over, read_sets, runs_text, strain_text
from ratd.experiments.compression.strength import of_same_clusters
from ratd.pictures.style import styled


@styled
def figure7(tables):
    """Mean pressures of sets with different k_n, of the same clusters; below over that of the set in their middle."""
    tables = of_same_clusters(tables)
    middle = len(tables) // 2
    labels = [rf"$k_\mathrm{{n}}$ = {damping_of(table):g}, {runs_text(table)}" for table in tables]
    title = f"{tables[0].attrs['material']}, N = {tables[0]['n_monomers'].item()}, {strain_text(tables[0])}"
    quotient = rf"$P\,/\,P(k_\mathrm{{n}} = {damping_of(tables[middle]):g})$"
    return pressures_over(tables, labels, title, middle, quotient, (0.7, 1.3))


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return figure7(read_sets(files))
