"""What the figures of the spin-up share: colours and markers of the types of growth, and axes of sizes."""

import numpy as np
import pandas as pd

from ratd.pictures.style import TYPE_COLOUR, bar_lengths, nanometres

TYPE_MARKER = {"BA": "o", "BAM1": "s", "BAM2": "^"}
_OTHER_COLOURS = ("#CC79A7", "#000000", "#56B4E9")
_OTHER_MARKERS = ("D", "v", "P")


def type_style(types):
    """Colour and marker of each growth type.

    Parameters
    ----------
    types : iterable of str

    Returns
    -------
    dict
        type -> {"color", "marker"}; types that the paper does not have get colours of their own.
    """
    others = [kind for kind in dict.fromkeys(types) if kind not in TYPE_COLOUR]
    style = {}
    for kind in dict.fromkeys(types):
        k = others.index(kind) % len(_OTHER_COLOURS) if kind in others else 0
        colour = TYPE_COLOUR.get(kind, _OTHER_COLOURS[k])
        style[kind] = {"color": colour, "marker": TYPE_MARKER.get(kind, _OTHER_MARKERS[k])}
    return style


def offsets(a_eff, n):
    """Small shifts in size that keep the points of n types apart (paper, Fig. 2).

    Parameters
    ----------
    a_eff : array_like
        Sizes in the figure [m].
    n : int
        Number of types.

    Returns
    -------
    numpy.ndarray, shape (n,)
        Shifts [m], symmetric about zero, 14 % of `size_step` apart.
    """
    return 0.14 * size_step(a_eff) * (np.arange(n) - (n - 1) / 2)


def open_markers(axes, x, y, look):
    """A few open markers on a line, which tell its type where colours cannot be seen.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        With a logarithmic axis of y.
    x, y : array_like, shape (n,)
        Points of the line.
    look : dict
        Colour and marker of the type.
    """
    # half way between points, where no other marker stands
    x, y = np.asarray(x, dtype=float), np.log(np.asarray(y, dtype=float))
    x, y = 0.5 * (x[1:] + x[:-1]), np.exp(0.5 * (y[1:] + y[:-1]))
    some = slice(min(1, max(len(x) - 1, 0)), None, 3)
    axes.plot(x[some], y[some], ls="none", ms=4.0, mfc="white", mew=0.8, zorder=1, **look)


def size_step(a_eff):
    """Smallest step between the sizes of a figure [m], half of a lone size."""
    sizes = np.unique(np.rint(np.asarray(a_eff, dtype=float) / 1e-12)) * 1e-12
    return np.diff(sizes).min() if len(sizes) > 1 else 0.5 * sizes[0]


def size_limits(a_eff):
    """Ends of an axis of sizes [m] with room for bars and offsets, also for one size alone."""
    margin = 0.08 * np.ptp(a_eff) + 0.3 * size_step(a_eff)
    return np.min(a_eff) - margin, np.max(a_eff) + margin


def mean_and_range(axes, x, cells, name, style, label=None):
    """Means as markers and minima to maxima as vertical bars.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    x : array_like
        Places of the cells on the axis.
    cells : pandas.DataFrame
        What `ratd.experiments.spin_up.cells.cell_statistics` returns.
    name : str
        Column of the grain table; cells without a value are left out.
    style : dict
        Colour and marker.
    label : str, optional
        Text in the legend.
    """
    mean, low, high = (cells[f"{name}_{part}"].to_numpy(float) for part in ("mean", "minimum", "maximum"))
    there = np.isfinite(mean)
    x, mean, low, high = (np.asarray(values)[there] for values in (x, mean, low, high))
    bars = bar_lengths(mean, low, high)
    axes.errorbar(x, mean, bars, ls="none", elinewidth=0.8, capsize=1.5, label=label, **style)


def middle_and_most(axes, a_eff, values, style, label=None):
    """Medians as markers and the middle two thirds as vertical bars, a marker a size.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        With sizes [nm] along x.
    a_eff : pandas.Series
        Where each grain stands [m].
    values : pandas.Series
        NaN are left out.
    style : dict
        Of the markers.
    label : str, optional
        Text in the legend.

    Returns
    -------
    pandas.DataFrame
        Columns a_eff, low, middle, high, a row a size.
    """
    known = pd.DataFrame({"a_eff": a_eff, "value": values.astype(float)})
    known = known[np.isfinite(known["value"])]
    parts = known.groupby(np.rint(known["a_eff"] / 1e-12))["value"]
    rows = [(size * 1e-12, *np.quantile(part, [1 / 6, 1 / 2, 5 / 6])) for size, part in parts]
    found = pd.DataFrame(rows, columns=["a_eff", "low", "middle", "high"])
    bars = bar_lengths(found["middle"], found["low"], found["high"])
    look = {"ls": "none", "elinewidth": 0.8, "capsize": 1.5} | style
    axes.errorbar(nanometres(found["a_eff"]), found["middle"].to_numpy(), bars, label=label, **look)
    return found


def sizes_label():
    """Text of an axis of effective radii."""
    return r"effective radius $a_\mathrm{eff}$ [nm]"
