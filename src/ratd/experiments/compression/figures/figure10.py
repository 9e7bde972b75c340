"""Fig. 10 of Kataoka et al. (2013): where the energy goes for different critical rolling displacements."""

from ratd.base.units import NM
from ratd.experiments.compression.figures.common import read_sets, strain_text
from ratd.experiments.compression.figures.figure8 import panels
from ratd.pictures.style import styled


@styled
def figure10(tables):
    """Energy dissipated by each way, sets with different xi_c below each other."""
    texts = [rf"$\xi_\mathrm{{c}}$ = {t['critical_rolling_displacement'].item() / NM:g} nm" for t in tables]
    return panels(tables, texts, f"{tables[0].attrs['material']}: energy dissipated, {strain_text(tables[0])}")


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return figure10(read_sets(files))
