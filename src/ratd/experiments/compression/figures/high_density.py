"""The pressure at high filling factors, and the law with a greatest filling factor fitted to it."""

import numpy as np

from ratd.aggregates.strength import compressive_strength_tatsuuma2023
from ratd.experiments.compression.figures.common import COLOURS, PHI_LABEL, RATIO_LABEL, read_sets, seeds_text
from ratd.experiments.compression.strength import fit_with_limit, mean_pressure
from ratd.pictures.style import ONE_COLUMN, logarithmic, new_figure, styled


@styled
def high_density(tables):
    """P/(P_0 phi^3), mean with one standard error as points, and c (1 - phi/phi_max)^-3 fitted from 0.1 to 0.5."""
    figure = new_figure(ONE_COLUMN, 0.95 * ONE_COLUMN, "high filling factors")
    axes = figure.subplots()
    for k, table in enumerate(tables):
        phi, P_0 = table["phi"].values, table["rolling_pressure"].values[0]
        mean, error = mean_pressure(table)
        line = P_0 * phi**3
        style = {"color": COLOURS[k], "marker": "os^"[k % 3], "ls": "none"}
        axes.errorbar(
            phi[::2],
            (mean / line)[::2],
            (error / line)[::2],
            label=f"{table.attrs['material']}, {seeds_text(table)}",
            **style,
        )
        high = min(0.5, phi[np.isfinite(mean)].max())
        c, largest = fit_with_limit(table, high=high).value
        x = np.linspace(0.08, 0.52, 60)
        fitted = c * compressive_strength_tatsuuma2023(x, 1.0, largest) / x**3
        text = rf"{c:.2f} $(1 - \phi/{largest:.2f})^{{-3}}$"
        axes.plot(x, fitted, color=COLOURS[k], lw=0.8, label=text)
    x = np.linspace(0.08, 0.52, 60)
    recalled = compressive_strength_tatsuuma2023(x, 1.0) / x**3
    axes.plot(x, recalled, color="black", ls="--", lw=0.8, label="Tatsuuma et al. 2023, recalled")
    axes.set(yscale="log", xlabel=PHI_LABEL, ylabel=RATIO_LABEL, xlim=(0.05, 0.52), ylim=(0.5, 60))
    logarithmic(axes.yaxis)
    axes.legend(loc="upper left")
    return figure


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return high_density(read_sets(files))
