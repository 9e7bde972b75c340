"""How alike the pressure is along the three axes."""

import numpy as np

from ratd.experiments.compression.figures.common import PHI_LABEL, looks_of, read_sets, right_of_all, runs_text
from ratd.experiments.compression.strength import anisotropy, mean_pressure, of_clusters
from ratd.pictures.style import ONE_COLUMN, logarithmic, new_figure, styled


@styled
def isotropy(tables):
    """Standard deviation of P_xx, P_yy, P_zz over the mean pressure against phi, from where that is surely above 0.

    Bands are one standard error, by leaving out one cluster at a time.
    """
    figure = new_figure(ONE_COLUMN, 0.8 * ONE_COLUMN, "spread of the pressure over the axes")
    axes = figure.subplots()
    for table, (colour, dash) in zip(tables, looks_of(tables), strict=True):
        label = f"{table.attrs['material']}, N = {table['n_monomers'].item()}, {runs_text(table)}"
        mean, error = mean_pressure(table)
        found = of_clusters(table.sizes["seed_number"], lambda own, table=table: anisotropy(table, own))
        # of a single run nothing says how sure it is
        known = np.where(right_of_all(mean <= 3.0 * np.nan_to_num(error)), found.value, np.nan)
        axes.plot(table["phi"], known, color=colour, ls=dash, label=label)
        low, high = (known + sign * found.error for sign in (-1, 1))
        axes.fill_between(table["phi"], low, high, color=colour, alpha=0.2, lw=0)
    axes.set(xscale="log", yscale="log", xlabel=PHI_LABEL)
    axes.set_ylabel(r"spread of $P_{xx}$, $P_{yy}$, $P_{zz}$ over $P$")
    if not any(np.isfinite(line.get_ydata()).any() for line in axes.lines):
        # without data a logarithmic axis has no ends
        axes.set(xlim=(0.01, 0.5), ylim=(0.02, 2.0))
    logarithmic(axes.xaxis)
    logarithmic(axes.yaxis)
    axes.legend(loc="upper right")
    return figure


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return isotropy(read_sets(files))
