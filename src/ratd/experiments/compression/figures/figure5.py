"""Fig. 5 of Kataoka et al. (2013): the pressure at different strain rates."""

from ratd.experiments.compression.figures.common import pressures, read_sets, runs_text, strain_text
from ratd.experiments.compression.strength import of_same_clusters
from ratd.pictures.style import styled


@styled
def figure5(tables):
    """Mean pressures of sets with different C_v, of the same clusters."""
    tables = of_same_clusters(tables)
    labels = [f"{strain_text(table)}, {runs_text(table)}" for table in tables]
    return pressures(tables, labels, f"{tables[0].attrs['material']}, N = {tables[0]['n_monomers'].item()}")


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return figure5(read_sets(files))
