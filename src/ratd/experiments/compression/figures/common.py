"""What the figures of the compression share: curves of the pressure with their errors, colours, labels."""

import re

import numpy as np

from ratd.aggregates.strength import compressive_strength_kataoka2013
from ratd.base.words import plural
from ratd.experiments.compression.strength import mean_pressure, of_means
from ratd.experiments.compression.tables import shared_bins
from ratd.pictures.style import ONE_COLUMN, logarithmic, new_figure
from ratd.pipeline import io

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00")
DASHES = ("-", "--", "-.", (0, (5, 1, 1, 1, 1, 1)), ":")
"""Of the curves in a figure, told apart with any colour vision and without colours."""
USUAL_RATE = 3e-7
"""Strain rate C_v of the sets that differ in their size; their curves are blue."""
OF_SIZE = {1024: ("#56B4E9", "--"), 4096: ("#332288", "-."), 16384: ("#0072B2", "-")}
"""Colour and dash of a set at the usual rate, by its number of monomers."""
OF_RATE = {
    3e-8: ("#CC79A7", DASHES[3]),
    1e-7: ("#D55E00", ":"),
    1e-6: ("#009E73", "-"),
    3e-6: ("#E69F00", DASHES[3]),
    1e-5: ("#555555", "--"),
}
"""Colour and dash of a set at another rate."""
OTHERS = (("#882255", "--"), ("#117733", "-."), ("#999933", ":"), ("#44AA99", DASHES[3]), ("#AA4499", "-"))
"""Colours and dashes of sets of other sizes or rates, and of a second set of one size or rate in a figure."""
THIN = 0.5
"""Width of a curve where it is not static, or not sure [points]."""
UNSURE = 0.5
"""Error over the mean above which a curve is thin: a band on a logarithmic axis would hide the others."""
BEFORE = 0.5
"""Where a curve begins over where it is static from: looser, inertia is seen, and chance."""
FEWEST = 3
"""Clusters that a set needs for a band: two may be alike by chance."""
UNTOLD = 0.3
"""Error of a ratio of two pressures over the ratio above which it says nothing, and is not drawn."""
PHI_LABEL = r"filling factor $\phi$"
RATIO_LABEL = r"$P\,/\,(P_0\phi^3)$"


def read_sets(files):
    """Tables of sets, list of xarray.Dataset."""
    return [io.read(path, "compression_set") for path in files["sets"]]


def seeds_text(table):
    """How many clusters of what a table holds, such as ``10 clusters of 1024``."""
    return f"{plural(table.sizes['seed_number'], 'cluster')} of {table['n_monomers'].item()}"


def runs_text(table):
    """How many runs a table has, such as ``10 runs``."""
    return plural(table.sizes["seed_number"], "run")


def strain_text(table):
    """Strain rate of a table in mathtext."""
    return rf"$C_\mathrm{{v}} = {power(table['strain_rate'].values[0])}$"


def power(value):
    """A number such as 3e-6 in mathtext."""
    mantissa, exponent = f"{value:.2e}".split("e")
    mantissa = f"{float(mantissa):g}"
    ten = rf"10^{{{int(exponent)}}}"
    return ten if mantissa == "1" else rf"{mantissa}\times{ten}"


def looks_of(tables):
    """Colour and dash of each set, the same in all figures, by its rate and, at the usual rate, by its size.

    Returns
    -------
    list of (str, dash)
    """
    wanted = [_look(table) for table in tables]
    found = [None if look in wanted[:k] else look for k, look in enumerate(wanted)]
    for k, look in enumerate(found):
        if look is None:
            taken = [other[1] for other in found if other is not None]
            free = [other for other in OTHERS if other[1] not in taken]
            found[k] = free[0] if free else OTHERS[k % len(OTHERS)]
    return found


def _look(table):
    """Colour and dash of a set, None where its size or rate has none."""
    rate = float(f"{table['strain_rate'].values[0]:.3g}")
    return OF_SIZE.get(table["n_monomers"].item()) if rate == USUAL_RATE else OF_RATE.get(rate)


def looks_by_order(tables):
    """Colour and dash of each set by its place, where neither size nor rate tells them apart."""
    return [(COLOURS[k % 5], DASHES[k % 5]) for k in range(len(tables))]


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


def draw_line(axes, table):
    """P_0 phi^3 of a table, from the left end of the axes to somewhat beyond its pressures."""
    phi = table["phi"].values
    last = phi[np.isfinite(table["pressure"].values).any(axis=0)].max()
    phi = np.geomspace(axes.get_xlim()[0], 1.3 * last, 50)
    values = compressive_strength_kataoka2013(phi, table["rolling_pressure"].values[0])
    axes.plot(phi, values, color="black", lw=0.8, label=r"$P_0\phi^3$")


def right_of_all(bad):
    """Whether an entry lies right of all that are bad, (k,) bool."""
    return ~np.logical_or.accumulate(bad[::-1])[::-1]


def draw_curves(above, below, tables, labels, looks, *, alone=False):
    """Mean pressures with bands of one standard error, into both panels, and the ends of the axes where they end.

    Curves are thin, and have no band, where they are not static yet or where the error is more than half of the mean.
    They begin at half the filling factor from which they are static, and where the mean stays above its error. Sets of
    less than `FEWEST` clusters have no band.

    Parameters
    ----------
    above, below : matplotlib.axes.Axes
        `below`, for the pressures over P_0 phi^3, may be None.
    tables : list of xarray.Dataset
    labels : list of str
    looks : list of (str, dash)
    alone : bool
        See `mean_pressure`.
    """
    for table, label, (colour, dash) in zip(tables, labels, looks, strict=True):
        mean, error = mean_pressure(table, alone=alone)
        phi, static_from = table["phi"].values, table["static_from"].values[0]
        if table.sizes["seed_number"] < FEWEST:
            error = np.full(len(mean), np.nan)
        there = right_of_all(mean <= np.nan_to_num(error)) & (phi > BEFORE * static_from)
        sure = there & right_of_all((phi <= static_from) | (error > UNSURE * mean))
        # up to the first sure one, so that the two parts of the curve meet
        thin = there & ~np.concatenate([[False], sure[:-1]])
        for axes, unit in ((above, 1.0), (below, phi**3 * table["rolling_pressure"].values[0])):
            if axes is None:
                continue
            axes.plot(phi, np.where(sure, mean / unit, np.nan), color=colour, ls=dash, label=label)
            axes.plot(phi, np.where(thin, mean / unit, np.nan), color=colour, lw=THIN)
            low, high = (np.where(sure, mean + sign * error, np.nan) / unit for sign in (-1, 1))
            axes.fill_between(phi, low, high, color=colour, alpha=0.2, lw=0)
    points = _points(above)
    if len(points):
        above.set(xlim=(0.9 * points[:, 0].min(), None), ylim=(0.5 * points[:, 1].min(), None))


def _points(axes):
    """All finite points of the lines in some axes but of those across, (k, 2)."""
    points = np.concatenate([line.get_xydata() for line in axes.lines if len(line.get_xdata()) > 2])
    return points[np.isfinite(points).all(axis=1)]


def draw_over(axes, tables, looks, which, label):
    """Mean pressures over that of one of the sets, of the same clusters, with bands of one standard error.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        With the filling factors that are shown in place.
    tables : list of xarray.Dataset
    looks : list of (str, dash)
    which : int
        Which of them the others are divided by.
    label : str
        Of the axis.
    """
    for k, (table, (colour, dash)) in enumerate(zip(tables, looks, strict=True)):
        if k != which:
            phi, ratio, error = over(table, tables[which])
            told = right_of_all(error > UNTOLD * ratio) & (phi > axes.get_xlim()[0])
            phi, ratio, error = phi[told], ratio[told], error[told]
            axes.plot(phi, ratio, color=colour, ls=dash)
            axes.fill_between(phi, ratio - error, ratio + error, color=colour, alpha=0.2, lw=0)
    axes.set(yscale="linear", ylabel=label)


def over(table, other):
    """Mean pressure of a set over that of the same clusters in another, where both are static.

    Returns
    -------
    phi, ratio, error : (k,) array
    """
    own, others = shared_bins(table, other)
    both = np.stack([table["pressure"].values[:, own], other["pressure"].values[:, others]], axis=1)
    phi = table["phi"].values[own]
    static = phi > max(each["static_from"].values[0] for each in (table, other))
    good = np.isfinite(both).all(axis=(0, 1)) & (both.mean(axis=0) > 0.0).all(axis=0) & static
    fit = of_means(both[:, :, good], lambda mean: mean[0] / mean[1])
    return phi[good], fit.value, fit.error


def finish(figure, above, below=None):
    """Readable logarithmic axes, and the legend."""
    logarithmic(above.xaxis)
    logarithmic(above.yaxis)
    above.legend(loc="upper left")
    if below is not None:
        ratios = _points(below)[:, 1]
        below.set_ylim(0.5 * ratios.min(initial=0.5), 1.25 * ratios.max(initial=2.0))
        logarithmic(below.yaxis)
    return figure


def pressures(tables, labels, title, *, alone=False):
    """The figure of mean pressures of some sets that share P_0."""
    figure, above, below = two_panels(title)
    draw_curves(above, below, tables, labels, looks_of(tables), alone=alone)
    draw_line(above, tables[0])
    return finish(figure, above, below)


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
    looks = looks_by_order(tables)
    draw_curves(above, None, tables, labels, looks)
    draw_line(above, tables[0])
    draw_over(below, tables, looks, which, quotient)
    below.set_ylim(*limits)
    return finish(figure, above)
