"""Fig. 9 of Kataoka et al. (2013): the pressure for different critical rolling displacements."""

from ratd.base.units import NM
from ratd.experiments.compression.figures.common import (
    draw_curves,
    finish,
    looks_by_order,
    read_sets,
    runs_text,
    strain_text,
    two_panels,
)
from ratd.experiments.compression.strength import of_same_clusters
from ratd.pictures.style import styled


@styled
def figure9(tables):
    """Mean pressures of sets with different xi_c, and below over P_0 phi^3, each with the P_0 of its own xi_c."""
    tables = sorted(of_same_clusters(tables), key=lambda table: table["critical_rolling_displacement"].item())
    title = f"{tables[0].attrs['material']}, N = {tables[0]['n_monomers'].item()}, {strain_text(tables[0])}"
    figure, above, below = two_panels(title)
    labels = [
        rf"$\xi_\mathrm{{c}}$ = {table['critical_rolling_displacement'].item() / NM:g} nm, "
        f"{runs_text(table)}"
        for table in tables
    ]
    draw_curves(above, below, tables, labels, looks_by_order(tables))
    return finish(figure, above, below)


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return figure9(read_sets(files))
