"""How alike the pressure is along the three axes."""

import numpy as np

from ratd.experiments.compression.figures.common import COLOURS, DASHES, PHI_LABEL, read_sets, runs_text
from ratd.experiments.compression.strength import anisotropy, mean_pressure
from ratd.pictures.style import ONE_COLUMN, logarithmic, new_figure, styled


@styled
def isotropy(tables):
    """Standard deviation of P_xx, P_yy, P_zz over the mean pressure against phi, from where that is surely above 0."""
    figure = new_figure(ONE_COLUMN, 0.8 * ONE_COLUMN, "spread of the pressure over the axes")
    axes = figure.subplots()
    for k, table in enumerate(tables):
        label = f"{table.attrs['material']}, N = {table['n_monomers'].item()}, {runs_text(table)}"
        mean, error = mean_pressure(table)
        # of a single run nothing says how sure it is
        known = np.where(mean > 3.0 * np.nan_to_num(error), anisotropy(table), np.nan)
        axes.plot(table["phi"], known, color=COLOURS[k % 5], ls=DASHES[k % 5], label=label)
    axes.set(xscale="log", yscale="log", xlabel=PHI_LABEL, ylabel="standard deviation / $P$", ylim=(0.02, 2))
    axes.set_xlim(0.01, 0.5)
    logarithmic(axes.xaxis)
    logarithmic(axes.yaxis)
    axes.legend(loc="upper right")
    return figure


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return isotropy(read_sets(files))
