"""What the figures of the compression share: curves of the pressure with their errors, colours, labels."""

import re

import numpy as np

from ratd.aggregates.strength import compressive_strength_kataoka2013
from ratd.experiments.compression.strength import mean_pressure, of_means
from ratd.experiments.compression.tables import bins
from ratd.pictures.style import ONE_COLUMN, logarithmic, new_figure
from ratd.pipeline import io

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00")
DASHES = ("-", "--", "-.", (0, (5, 1, 1, 1, 1, 1)), ":")
"""Of the curves in a figure, told apart with any colour vision and without colours."""
WAYS = {
    "rolling": ("#0072B2", "-"),
    "twisting": ("#D55E00", "--"),
    "sliding": ("#009E73", "-."),
    "damping": ("#8A8A8A", ":"),
    "made": ("#E69F00", (0, (5, 1, 1, 1, 1, 1))),
}
"""Colour and dash of each way of dissipation."""
THIN = 0.5
"""Width of a curve where it is not static [points]."""
LEAST = 0.03
"""Lower end of a band over its curve where the error is as great as the curve, which a logarithm cannot show."""
PHI_LABEL = r"filling factor $\phi$"
RATIO_LABEL = r"$P\,/\,(P_0\phi^3)$"


def read_sets(files):
    """Tables of sets, list of xarray.Dataset."""
    return [io.read(path, "compression_set") for path in files["sets"]]


def seeds_text(table):
    """How many clusters of what a table holds, such as ``10 clusters of 1024``."""
    n = table.sizes["seed_number"]
    return f"{n} cluster{'s' if n > 1 else ''} of {table['n_monomers'].item()}"


def runs_text(table):
    """How many runs a table has, such as ``10 runs``."""
    n = table.sizes["seed_number"]
    return f"{n} run{'s' if n > 1 else ''}"


def strain_text(table):
    """Strain rate of a table in mathtext."""
    return rf"$C_\mathrm{{v}} = {power(table['strain_rate'].values[0])}$"


def power(value):
    """A number such as 3e-6 in mathtext."""
    mantissa, exponent = f"{value:.2e}".split("e")
    mantissa = f"{float(mantissa):g}"
    ten = rf"10^{{{int(exponent)}}}"
    return ten if mantissa == "1" else rf"{mantissa}\times{ten}"


def damping_of(table):
    """k_n of a table."""
    return float(re.search(r"constant_damping=([0-9.e+-]+)", table.attrs["law"])[1])


def two_panels(title):
    """Figure of two panels above each other: P against phi, and the same over P_0 phi^3."""
    figure = new_figure(ONE_COLUMN, 1.45 * ONE_COLUMN, title)
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
    above.set(xscale="log", yscale="log", ylabel=r"pressure $P$ [Pa]")
    below.set(xscale="log", yscale="log", xlabel=PHI_LABEL, ylabel=RATIO_LABEL)
    below.axhline(1.0, color="black", lw=0.8)
    return figure, above, below


def draw_line(axes, table, color="black", label=r"$P_0\phi^3$"):
    """P_0 phi^3 of a table, as far as its pressures go and somewhat on."""
    phi = table["phi"].values
    phi = np.geomspace(phi[0], 1.3 * phi[np.isfinite(table["pressure"].values).any(axis=0)].max(), 50)
    values = compressive_strength_kataoka2013(phi, table["rolling_pressure"].values[0])
    axes.plot(phi, values, color=color, lw=0.8, label=label)


def draw_curves(above, below, tables, labels, *, alone=False):
    """Mean pressures with bands of one standard error, into both panels; thin, without bands, where not static yet.

    `below` may be None.
    """
    for k, (table, label) in enumerate(zip(tables, labels, strict=True)):
        mean, error = mean_pressure(table, alone=alone)
        phi = table["phi"].values
        line = phi**3 * table["rolling_pressure"].values[0]
        style = {"color": COLOURS[k % 5], "ls": DASHES[k % 5]}
        for axes, unit in ((above, 1.0), (below, line)):
            if axes is None:
                continue
            value = np.where(mean > 0.0, mean, np.nan) / unit
            static = phi > table["static_from"].values[0]
            axes.plot(phi, np.where(static, value, np.nan), label=label, **style)
            axes.plot(phi, value, color=style["color"], lw=THIN)
            low, high = (np.maximum(mean + sign * error, LEAST * np.abs(mean)) / unit for sign in (-1, 1))
            shown = static & (mean > 0.0)
            axes.fill_between(phi, np.where(shown, low, np.nan), high, color=COLOURS[k % 5], alpha=0.2, lw=0)


def draw_over(axes, tables, which, label):
    """Mean pressures over that of one of the sets, of the same clusters, with bands of one standard error.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    tables : list of xarray.Dataset
        In the colours and dashes that `draw_curves` gives them.
    which : int
        Which of them the others are divided by.
    label : str
        Of the axis.
    """
    for k, table in enumerate(tables):
        if k != which:
            phi, ratio, error = over(table, tables[which])
            axes.plot(phi, ratio, color=COLOURS[k % 5], ls=DASHES[k % 5])
            axes.fill_between(phi, ratio - error, ratio + error, color=COLOURS[k % 5], alpha=0.2, lw=0)
    axes.set(yscale="linear", ylabel=label)


def over(table, other):
    """Mean pressure of a set over that of the same clusters in another, where both are static.

    Returns
    -------
    phi, ratio, error : (k,) array
    """
    numbers = [bins(each["phi"].values) for each in (table, other)]
    _, own, others = np.intersect1d(*numbers, return_indices=True)
    both = np.stack([table["pressure"].values[:, own], other["pressure"].values[:, others]], axis=1)
    phi = table["phi"].values[own]
    static = phi > max(each["static_from"].values[0] for each in (table, other))
    good = np.isfinite(both).all(axis=(0, 1)) & (both.mean(axis=0) > 0.0).all(axis=0) & static
    fit = of_means(both[:, :, good], lambda mean: mean[0] / mean[1])
    return phi[good], fit.value, fit.error


def finish(figure, above, below=None):
    """Readable logarithmic axes, and the legend."""
    logarithmic(above.xaxis)
    low = max(above.get_ylim()[0], 1e-2)
    above.set_ylim(bottom=low)
    logarithmic(above.yaxis)
    above.legend(loc="upper left")
    if below is not None:
        # of what is static, which is not thin
        static = [line for line in below.lines if line.get_linewidth() > THIN]
        highest = max(np.nanmax(line.get_ydata(), initial=1.0) for line in static)
        below.set_ylim(0.1, max(3.0, 1.3 * highest))
        logarithmic(below.yaxis)
    return figure


def pressures(tables, labels, title, *, alone=False):
    """The figure of mean pressures of some sets that share P_0."""
    figure, above, below = two_panels(title)
    draw_curves(above, below, tables, labels, alone=alone)
    _line_and_left_end(above, tables)
    finish(figure, above, below)
    if alone:
        # the loosest clusters press least
        below.set_ylim(bottom=0.03)
    return figure


def pressures_over(tables, labels, title, which, quotient, limits):
    """The figure of mean pressures of sets of the same clusters, and below over those of one of them.

    The curves above cover each other: what tells them apart is below.

    Parameters
    ----------
    tables : list of xarray.Dataset
    labels : list of str
    title : str
    which : int
        Which of them the others are divided by.
    quotient : str
        Label of the axis below.
    limits : (float, float)
        Of the axis below.
    """
    figure, above, below = two_panels(title)
    draw_curves(above, None, tables, labels)
    _line_and_left_end(above, tables)
    draw_over(below, tables, which, quotient)
    below.set_ylim(*limits)
    return finish(figure, above)


def _line_and_left_end(axes, tables):
    draw_line(axes, tables[0])
    # little of what is not static: there inertia is seen, and chance
    axes.set_xlim(left=0.6 * min(table["static_from"].values[0] for table in tables))
