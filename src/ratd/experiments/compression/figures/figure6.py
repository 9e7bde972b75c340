"""Fig. 6 of Kataoka et al. (2013): the pressure for clusters of different numbers of monomers."""

from ratd.experiments.compression.figures.common import pressures, read_sets, runs_text, strain_text
from ratd.pictures.style import styled


@styled
def figure6(tables):
    """Mean pressures of sets with different N; a cluster that does not touch its copies yet counts with P = 0."""
    labels = [f"N = {t['n_monomers'].item()}, {runs_text(t)}, {strain_text(t)}" for t in tables]
    return pressures(tables, labels, f"{tables[0].attrs['material']}: size of the cluster", alone=True)


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return figure6(read_sets(files))
