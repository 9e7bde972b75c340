"""Fig. 7 of Kataoka et al. (2013): the pressure for different normal damping."""

from ratd.experiments.compression.figures.common import damping_of, pressures, read_sets, strain_text
from ratd.experiments.compression.strength import of_same_clusters
from ratd.pictures.style import styled


@styled
def figure7(tables):
    """Mean pressures of sets with different k_n, of the same clusters."""
    tables = of_same_clusters(tables)
    labels = [rf"$k_\mathrm{{n}}$ = {damping_of(table):g}, {table.sizes['seed_number']} runs" for table in tables]
    title = f"{tables[0].attrs['material']}, N = {tables[0]['n_monomers'].item()}, {strain_text(tables[0])}"
    return pressures(tables, labels, title)


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return figure7(read_sets(files))
