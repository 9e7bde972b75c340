"""Fig. 9 of Kataoka et al. (2013): the pressure for different critical rolling displacements."""

from ratd.base.units import NM
from ratd.experiments.compression.figures.common import (
    COLOURS,
    draw_curves,
    draw_line,
    finish,
    read_sets,
    runs_text,
    strain_text,
    two_panels,
)
from ratd.experiments.compression.strength import of_same_clusters
from ratd.pictures.style import GREY, styled


@styled
def figure9(tables):
    """Mean pressures of sets with different xi_c, each with its own P_0 phi^3 thin in the same colour."""
    tables = sorted(of_same_clusters(tables), key=lambda table: table["critical_rolling_displacement"].item())
    title = f"{tables[0].attrs['material']}, N = {tables[0]['n_monomers'].item()}, {strain_text(tables[0])}"
    figure, above, below = two_panels(title)
    labels = [
        rf"$\xi_\mathrm{{c}}$ = {table['critical_rolling_displacement'].item() / NM:g} nm, "
        f"{runs_text(table)}"
        for table in tables
    ]
    draw_curves(above, below, tables, labels)
    for k, table in enumerate(tables):
        draw_line(above, table, COLOURS[k % 5], label=None)
    above.plot([], [], color=GREY, lw=0.8, label=r"$P_0\phi^3$ of each")
    return finish(figure, above, below)


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return figure9(read_sets(files))
