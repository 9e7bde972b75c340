"""The pressure at high filling factors, and the law with a greatest filling factor fitted to it."""

import numpy as np

from ratd.aggregates.strength import compressive_strength_tatsuuma2023
from ratd.experiments.compression.figures.common import COLOURS, DASHES, PHI_LABEL, RATIO_LABEL, read_sets, seeds_text
from ratd.experiments.compression.strength import LIMIT_RANGE, fit_with_limit, mean_pressure
from ratd.pictures.style import ONE_COLUMN, logarithmic, new_figure, styled

SHOWN = (0.08, 0.52)
"""Filling factors that are shown."""


@styled
def high_density(tables):
    """P/(P_0 phi^3), mean with one standard error as points, and c (1 - phi/phi_max)^-3 where it is fitted."""
    figure = new_figure(ONE_COLUMN, 0.95 * ONE_COLUMN, "high filling factors")
    axes = figure.subplots()
    for k, table in enumerate(tables):
        phi, P_0 = table["phi"].values, table["rolling_pressure"].values[0]
        mean, error = mean_pressure(table)
        every = np.flatnonzero(phi > SHOWN[0])[::2]
        line = P_0 * phi**3
        style = {"color": COLOURS[k % 5], "marker": "os^"[k % 3], "ls": "none"}
        label = f"{table.attrs['material']}, {seeds_text(table)}"
        axes.errorbar(phi[every], (mean / line)[every], (error / line)[every], label=label, **style)
        high = min(LIMIT_RANGE[1], phi[np.isfinite(mean)].max())
        x = np.geomspace(LIMIT_RANGE[0], high, 60)
        c, largest = fit_with_limit(table, high=high).value
        fitted = c * compressive_strength_tatsuuma2023(x, 1.0, largest) / x**3
        text = rf"{c:.2f} $(1 - \phi/{largest:.2f})^{{-3}}$"
        axes.plot(x, fitted, color=COLOURS[k % 5], ls=DASHES[2 * k % 5], lw=0.8, label=text)
    x = np.geomspace(*SHOWN, 60)
    recalled = compressive_strength_tatsuuma2023(x, 1.0) / x**3
    axes.plot(x, recalled, color="black", ls="--", lw=0.8, label="Tatsuuma et al. 2023, recalled")
    # logarithmic in phi, so that marks do not hide each other where they lie close
    axes.set(xscale="log", yscale="log", xlabel=PHI_LABEL, ylabel=RATIO_LABEL, xlim=SHOWN, ylim=(0.5, 100))
    logarithmic(axes.xaxis, labelled=(2, 3, 5, 8))
    logarithmic(axes.yaxis)
    axes.legend(loc="upper left")
    return figure


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return high_density(read_sets(files))
