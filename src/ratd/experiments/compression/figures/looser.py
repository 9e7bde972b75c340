"""How slow is slow for loose clusters: their pressure at some strain rates, over P_0 phi^3."""

import numpy as np

from ratd.experiments.compression.figures.common import (
    PHI_LABEL,
    RATIO_LABEL,
    looks_of,
    read_sets,
    seeds_text,
    strain_text,
)
from ratd.experiments.compression.static import box_rate, slower_than_sound_from
from ratd.experiments.compression.strength import mean_pressure
from ratd.pictures.style import ONE_COLUMN, logarithmic, new_figure, styled

MACH = 0.2
"""Speed of the faces of the box over that of sound at which each curve has its mark."""
SMOOTH = 9
"""Bins of which a curve is the mean: those within a fifth in phi."""
LOOSE = (0.0018, 0.05)
"""Filling factors that are shown."""


@styled
def looser(tables):
    """Mean pressures over P_0 phi^3 of loose clusters, with bands of one standard error.

    A mark stands where the faces of the box move at `MACH` times the speed of sound; right of it they are slower.
    """
    figure = new_figure(ONE_COLUMN, 1.1 * ONE_COLUMN, f"loose clusters of {tables[0].attrs['material']}")
    axes = figure.subplots()
    for table, (colour, dash) in zip(tables, looks_of(tables), strict=True):
        phi, (value, error) = _smooth(table)
        axes.plot(phi, value, color=colour, ls=dash, label=f"{seeds_text(table)}, {strain_text(table)}")
        axes.fill_between(phi, value - error, value + error, color=colour, alpha=0.2, lw=0)
        mark = _mark(table)
        if phi[0] < mark < phi[-1]:
            axes.plot(mark, np.interp(mark, phi, value), "o", color=colour, ms=4.5, zorder=3)
    axes.plot([], [], "o", color="black", ms=4.5, label=f"faces at {MACH:g} times the speed of sound")
    axes.axhline(1.0, color="black", lw=0.8, label=r"$P_0\phi^3$, printed")
    axes.set(xscale="log", xlabel=PHI_LABEL, ylabel=RATIO_LABEL, xlim=LOOSE, ylim=(-0.1, 1.2))
    axes.set_yticks(np.arange(0.0, 1.3, 0.2))
    logarithmic(axes.xaxis, labelled=(2, 5))
    figure.legend(loc="outside lower center", ncols=1)
    return figure


def _smooth(table):
    """Filling factors, and the mean over seeds of P/(P_0 phi^3) with its error, of `SMOOTH` bins each."""
    phi = table["phi"].values
    # over phi^3 before the mean, which would else be that of the greater phi
    ratio = table["pressure"] / table["rolling_pressure"].values[0] / table["phi"] ** 3
    mean, error = mean_pressure(table.assign(pressure=ratio.rolling(phi_bin=SMOOTH, center=True).mean()))
    there = np.isfinite(mean)
    return phi[there], (mean[there], np.nan_to_num(error[there]))


def _mark(table):
    """Filling factor from which on the faces of the box move at less than `MACH` times the speed of sound."""
    rate = box_rate(table["strain_rate"].values[0], table["time_unit"].item())
    of_cluster = (table["monomer_radius"].item(), table["density"].item(), table["rolling_pressure"].values[0])
    return slower_than_sound_from(rate, table["n_monomers"].item(), *of_cluster, MACH)


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return looser(read_sets(files))
