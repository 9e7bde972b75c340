"""Fig. 6: axis ratios at the start and at disruption."""

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from ratd.base.units import NM
from ratd.base.words import plural
from ratd.experiments.spin_up.oblateness import oblate_share
from ratd.experiments.spin_up.run_files import read_table
from ratd.experiments.spin_up.figures.style import type_style
from ratd.pictures.snapshots import drive_of, drive_text
from ratd.pictures.style import GREY, ONE_COLUMN, TWO_COLUMNS, empty, new_figure, styled

SIZES = (200e-9, 350e-9, 500e-9)
"""Sizes [m] that the paper shows."""
START = {"ls": "none", "marker": "o", "ms": 3.2, "mfc": "white", "mec": "black", "mew": 0.7, "zorder": 3}
END = {"ls": "none", "marker": "o", "ms": 3.4, "mfc": "black", "mec": "black", "mew": 0.3, "zorder": 4}
"""Markers of a grain at rest and at disruption, whose colour and form a type gives."""


@styled
def figure6(table, material="a-C", sizes=SIZES, drive=None):
    """Axis ratios c/b against b/a at the start and at disruption, a panel a type and size (Fig. 6).

    Parameters
    ----------
    table : pandas.DataFrame
        What `grain_table` returns.
    material : str
        Material shown.
    sizes : sequence of float
        Effective radii [m], a column each.
    drive : str, optional
        Named in the title; default: what the table says.

    Returns
    -------
    matplotlib.figure.Figure
        Open markers: relaxed grain at rest; filled ones: largest fragment at omega_disr; a line joins those of a grain.
        Above the diagonal, c/b > b/a, a grain is rather prolate, below it rather oblate, which the corners name; each
        panel counts the oblate ones at the start and at disruption. The panels of a type have the same axes.

    References
    ----------
    Reissl et al. (2024), A&A 692, A60, Fig. 6, where all types stand in one panel and no grain is joined.
    """
    drive = drive_of(table) if drive is None else drive
    table = table[table["material"] == material]
    style = type_style(table["type"]) or {"": {}}
    width = ONE_COLUMN if len(sizes) == 1 else TWO_COLUMNS
    height = (0.09 + 0.25 * len(style)) * TWO_COLUMNS
    figure = new_figure(width, height, f"{material}, {drive_text(drive)}")
    panels = figure.subplots(len(style), len(sizes), sharex="row", sharey="row", squeeze=False)
    for row, (kind, look) in zip(panels, style.items(), strict=True):
        greatest = np.array([1.5, 1.5])  # of b/a and c/b in the row
        for axes, size in zip(row, sizes, strict=True):
            here = table[np.isclose(table["a_eff"].astype(float), size, rtol=1e-6, atol=0) & (table["type"] == kind)]
            axes.set_title(rf"{kind}, $a_\mathrm{{eff}}$ = {size / NM:.4g} nm, {plural(len(here), 'grain')}", pad=3)
            if not len(here):
                empty(axes)
                continue
            ends = _joined(axes, here, look)
            greatest = np.nanmax(np.column_stack([greatest, *ends]), axis=1)
            counts = (oblate_share(here, when)[2:] for when in ("start", "disr"))
            first, last = (f"{oblate}/{known}" for oblate, known in counts)
            text = f"oblate: {first} \N{RIGHTWARDS ARROW} {last}"
            axes.text(0.97, 0.96, text, transform=axes.transAxes, ha="right", va="top", color=look["color"])
        _axes(row, greatest)
    for axes in panels[-1]:
        axes.set_xlabel("axis ratio $b/a$")
    handles = [Line2D([], [], label="at rest", **START), Line2D([], [], label=r"at $\omega_\mathrm{disr}$", **END)]
    figure.legend(handles=handles, loc="outside lower center", ncols=2)
    return figure


def _joined(axes, table, look):
    """Draw each grain of a panel at rest and at disruption, joined; returns the axis ratios of both, (2, n) each."""
    start, end = axis_ratios(table, "start"), axis_ratios(table, "disr")
    axes.plot(*np.stack([start, end], axis=1), color=look["color"], lw=0.6, alpha=0.6, zorder=2)
    marker = {"marker": look["marker"], "mec": look["color"]}
    axes.plot(*start, **START | marker)
    axes.plot(*end, **END | marker | {"mfc": look["color"]})
    return start, end


def _axes(row, greatest):
    """Limits, ticks, diagonal and words of a row of panels, with room for the greatest b/a and c/b."""
    right, top = 1.1 * greatest
    # Strips without points: above all of them stand the counts, below 1, where no ratio is, a word.
    top *= (top / 0.95) ** 0.25
    bottom = top**-0.16
    end = min(right, top)
    for axes in row:
        axes.plot([1, end], [1, end], color=GREY, lw=0.8, zorder=1)
        axes.set(xscale="log", yscale="log", xlim=(0.95, right), ylim=(bottom, top))
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_locator(FixedLocator([1, 1.2, 1.5, 2, 3, 5, 10, 20, 50]))
            axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            axis.set_minor_locator(NullLocator())
        axes.text(0.03, 0.96, "prolate", transform=axes.transAxes, color=GREY, va="top")
        axes.text(0.97, 0.02, "oblate", transform=axes.transAxes, color=GREY, ha="right", va="bottom")
    row[0].set_ylabel("axis ratio $c/b$")


def axis_ratios(table, when):
    """Axis ratios b/a and c/b of each grain.

    Parameters
    ----------
    table : pandas.DataFrame
        Grain table.
    when : {"start", "disr"}
        At rest, or at disruption.

    Returns
    -------
    numpy.ndarray, shape (2, n)
        b/a and c/b, NaN where an axis is undefined.
    """
    a, b, c = (table[f"axis_{axis}_{when}"].to_numpy(float) for axis in "abc")
    return np.array([b / a, c / b])


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return figure6(read_table(files["table"]), settings["material"], settings["sizes"], drive=settings["drive"])
