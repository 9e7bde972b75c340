"""What all figures share: colours, markers, sizes in print, and saving to the same bytes each time.

No pyplot: figures are plain `Figure` objects, so that nothing depends on a display or on what was drawn before.
"""

import functools
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib import font_manager
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator

from ratd.base.errors import InputError
from ratd.base.units import NM
from ratd.pipeline.atomic import atomic

MILLIMETRE = 1 / 25.4
"""Millimetre in inches, the unit of matplotlib."""
ONE_COLUMN = 88 * MILLIMETRE
"""Width of one column of the journal."""
TWO_COLUMNS = 180 * MILLIMETRE
"""Width of two columns of the journal."""

# Of Okabe and Ito's palette, told apart with any colour vision.
HIGHLIGHT = "#E69F00"
GREY = "#8A8A8A"
TYPE_COLOUR = {"BA": "#D55E00", "BAM1": "#009E73", "BAM2": "#0072B2"}
"""Colour of each type of growth, nearest to the paper's red, green and blue."""
ENERGY_COLOURS = {
    "rolling": "#0072B2",
    "twisting": "#D55E00",
    "sliding": "#009E73",
    "damping": GREY,
    "made": HIGHLIGHT,
}
"""Colour of each way in which energy is lost; "made" is what a new contact radiates as it forms."""

RC = {
    "font.family": "DejaVu Sans",  # comes with matplotlib: the same on every machine, see `own_fonts_first`
    "mathtext.fontset": "dejavusans",
    "font.size": 7.5,
    "axes.labelsize": 8,
    "axes.titlesize": 8,
    "figure.titlesize": 8,
    "legend.fontsize": 7.5,
    "legend.frameon": False,
    "legend.handletextpad": 0.5,
    "legend.columnspacing": 1.5,
    "xtick.labelsize": 7.5,
    "ytick.labelsize": 7.5,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.top": True,
    "ytick.right": True,
    "axes.linewidth": 0.6,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.minor.width": 0.4,
    "ytick.minor.width": 0.4,
    "lines.linewidth": 1.0,
    "lines.markersize": 3.5,
    "axes.unicode_minus": True,
    "pdf.fonttype": 42,
    "savefig.dpi": 300,
    "svg.hashsalt": "ratd",
}
"""matplotlib settings of every figure; texts are 7.5 points or larger at print width."""


def own_fonts_first():
    """Let the fonts that come with matplotlib win over fonts of the system that have the same name.

    Which of them is found depends on the order in which the system lists its files, and their glyphs differ.
    """
    own = Path(matplotlib.get_data_path())
    fonts = font_manager.fontManager
    fonts.ttflist.sort(key=lambda font: not Path(font.fname).is_relative_to(own))
    fonts.addfont(own / "fonts" / "ttf" / "DejaVuSans.ttf")  # forgets what was found before


own_fonts_first()


def styled(draw):
    """Decorate a function so that it draws with `RC` and leaves the user's matplotlib settings alone."""

    @functools.wraps(draw)
    def wrapper(*args, **kwargs):
        with matplotlib.rc_context():
            matplotlib.rcdefaults()
            matplotlib.rcParams.update(RC)
            return draw(*args, **kwargs)

    return wrapper


def new_figure(width, height, title):
    """Empty figure with a title line.

    Parameters
    ----------
    width, height : float
        Size in print [inches].
    title : str
        What is shown and with which drive.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = Figure(figsize=(width, height), layout="constrained")
    figure.get_layout_engine().set(w_pad=0.03, h_pad=0.03, wspace=0.03, hspace=0.03)
    figure.suptitle(title)
    return figure


def plain(name):
    """The name of a file or of a user as text of a figure, in which a $ begins no formula."""
    return str(name).replace("$", r"\$")


@styled
def save(figure, *paths):
    """Write a figure to each path, in the format of its suffix, the same bytes each time.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
    *paths : str or pathlib.Path
        Names that end in .pdf, .png or .svg. A file appears only when it is complete.

    Raises
    ------
    InputError
        If a suffix is none of these.
    """
    # No date, no version: nothing that differs between two runs may stand in the file.
    metadata = {
        "pdf": {"CreationDate": None, "Creator": None, "Producer": None},
        "png": {"Software": None},
        "svg": {"Date": None, "Creator": None},
    }
    for path in map(Path, paths):
        kind = path.suffix.removeprefix(".").lower()
        if kind not in metadata:
            raise InputError(f"figure file '{path}': the name must end in .pdf, .png or .svg")
        with atomic(path) as part:
            figure.savefig(part, format=kind, metadata=metadata[kind])


def logarithmic(axis, least=0.6, labelled=None):
    """Make the limits of a logarithmic axis fit for reading: a least width, and numbers that do not crowd.

    All numbers of an axis are plain ones, or all are powers of 10 where one that is labelled has more than four digits.

    Parameters
    ----------
    axis : matplotlib.axis.Axis
        With the data in place.
    least : float
        Least width in decades; a narrower axis is widened to both sides.
    labelled : sequence of int, optional
        Digits besides 1 that are labelled in each decade; default: the fewer the wider the axis is.
    """
    low, high = np.log10(axis.get_view_interval())
    extra = max(0.0, least - (high - low)) / 2
    low, high = low - extra, high + extra
    set_limits = axis.axes.set_xlim if axis.axis_name == "x" else axis.axes.set_ylim
    set_limits(10**low, 10**high)
    # Where fewer than two decades stand on the axis, 2 and 5 are labelled too, and on half a decade still more.
    if labelled is None:
        labelled = () if high - low >= 2 else (2, 5) if high - low > 0.55 else (2, 3, 4, 5, 7)
    axis.set_major_locator(LogLocator(subs=(1,)))
    axis.set_minor_locator(LogLocator(subs=range(2, 10)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: _tick_text(value, _plain(axis, labelled))))
    axis.set_minor_formatter(FuncFormatter(lambda value, _: _tick_text(value, _plain(axis, labelled), labelled)))


def _plain(axis, labelled):
    """Whether no number of a logarithmic axis is less than 0.001 or has more than four digits."""
    low, high = np.log10(np.sort(axis.get_view_interval()))
    if not labelled:  # powers of 10 alone
        low, high = np.ceil(low - 1e-9), np.floor(high + 1e-9)
    return low > -3.0 - 1e-6 and high < 4.0 - 1e-6


def _tick_text(value, plain, labelled=(1,)):
    """Text of a tick m 10^e of a logarithmic axis, empty unless m is to be labelled."""
    exponent = int(np.floor(np.log10(value) + 1e-9))
    digit = round(value / 10.0**exponent)
    if digit not in labelled:
        return ""
    if plain:
        return f"{value:g}"
    return f"$10^{{{exponent}}}$" if digit == 1 else rf"${digit}\times10^{{{exponent}}}$"


def bar_lengths(middle, low, high):
    """Lengths of error bars, never below zero.

    Parameters
    ----------
    middle, low, high : array_like, shape (n,)

    Returns
    -------
    numpy.ndarray, shape (2, n)
        Below and above the middle.
    """
    middle = np.asarray(middle, dtype=float)
    # the mean of equal values may differ from them by rounding, and matplotlib refuses negative lengths
    return np.maximum([middle - low, high - middle], 0.0)


def label_ends(axes, ends, apart=0.08, at=1.02, end=None, **look):
    """Write names beside lines, right of a panel, moved up or down where they would stand on each other.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        With its limits in place.
    ends : list of (str, float, str)
        Text, height of the end of its line on the axis, and colour; a height that is no number is left out.
    apart : float
        Height of a line of text in heights of the panel.
    at : float
        Where the texts begin, in widths of the panel.
    end : float, optional
        Where the lines end on the other axis; thin lines then lead from there to the names.
    **look
        Of the texts.
    """
    to_panel = axes.transData + axes.transAxes.inverted()
    x = axes.get_xlim()[1]
    ends = [(text, float(to_panel.transform((x, y))[1]), colour) for text, y, colour in ends if np.isfinite(y)]
    ends.sort(key=lambda one: one[1])
    sizes = [apart * (1 + text.count("\n")) for text, _, _ in ends]
    for (text, height, colour), y in zip(ends, _moved_apart([height for _, height, _ in ends], sizes), strict=True):
        axes.text(at, y, text, transform=axes.transAxes, color=colour, ha="left", va="center", **look)
        if end is not None:
            start = to_panel.transform((end, axes.get_ylim()[0]))[0] + 0.01
            line = {"arrowstyle": "-", "color": colour, "lw": 0.4, "shrinkA": 0, "shrinkB": 0}
            places = {"xycoords": "axes fraction", "textcoords": "axes fraction", "annotation_clip": False}
            axes.annotate("", (start, height), (at - 0.01, y), arrowprops=line, **places)


def _moved_apart(heights, sizes):
    """Middles of things of some sizes at ascending heights, moved so that none overlap, by the least squares."""
    groups = []  # of things that touch: where the first one has its middle, and the heights and sizes of all
    for height, size in zip(heights, sizes, strict=True):
        groups.append((height, [height], [size]))
        while len(groups) > 1:
            (first, low, below), (second, high, above) = groups[-2:]
            if second - first >= _steps(below + above[:1])[-1] - 1e-12:
                break
            every, wide = low + high, below + above
            groups[-2:] = [(float(np.mean(every - _steps(wide))), every, wide)]
    return [first + step for first, _, wide in groups for step in _steps(wide)]


def _steps(sizes):
    """Middles of things that touch, over that of the first one."""
    sizes = np.asarray(sizes, dtype=float)
    return np.cumsum(sizes) - 0.5 * sizes - 0.5 * sizes[0]


def empty(axes, text="no grains"):
    """Say in a panel that it has nothing to show."""
    axes.text(0.5, 0.5, text, transform=axes.transAxes, ha="center", va="center", color=GREY)


def nanometres(values):
    """Lengths [m] in nm."""
    return np.asarray(values, dtype=float) / NM


def power_of_ten(values):
    """Power of ten that brings the greatest finite value between 1 and 10, with the text for an axis label.

    Parameters
    ----------
    values : array_like

    Returns
    -------
    exponent : int
        0 where there is no value above zero, or where the values need no scaling.
    text : str
        Such as ``10^{-16} `` in mathtext, empty for exponent 0.
    """
    values = np.asarray(values, dtype=float)
    values = values[np.isfinite(values) & (values > 0)]
    exponent = int(np.floor(np.log10(values.max()))) if len(values) else 0
    if -1 <= exponent <= 3:
        return 0, ""
    return exponent, rf"$10^{{{exponent}}}$ "
