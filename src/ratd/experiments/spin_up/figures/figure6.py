"""Fig. 6: axis ratios at the start and at disruption."""

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from ratd.base.units import NM
from ratd.base.words import plural
from ratd.experiments.spin_up.oblateness import oblate_counts
from ratd.experiments.spin_up.run_files import read_table
from ratd.pictures.style import (
    GREY,
    ONE_COLUMN,
    TWO_COLUMNS,
    drive_of,
    drive_text,
    empty,
    new_figure,
    styled,
    type_style,
)

SIZES = (200e-9, 350e-9, 500e-9)
"""Sizes [m] that the paper shows."""


@styled
def figure6(table, material="a-C", sizes=SIZES, drive=None):
    """Axis ratios c/b against b/a at the start and at disruption, a panel per size (Fig. 6).

    Parameters
    ----------
    table : pandas.DataFrame
        What `grain_table` returns.
    material : str
        Material shown.
    sizes : sequence of float
        Effective radii [m], a panel each.
    drive : str, optional
        Named in the title; default: what the table says.

    Returns
    -------
    matplotlib.figure.Figure
        Dots: relaxed grain at rest; crosses: largest fragment at omega_disr. Above the diagonal, c/b > b/a, a grain
        is rather prolate, below it rather oblate, which the corners name; each panel counts the oblate ones at the
        start and at disruption.

    References
    ----------
    Reissl et al. (2024), A&A 692, A60, Fig. 6.
    """
    drive = drive_of(table) if drive is None else drive
    table = table[table["material"] == material]
    style = type_style(table["type"])
    width = ONE_COLUMN if len(sizes) == 1 else TWO_COLUMNS
    figure = new_figure(width, 0.46 * TWO_COLUMNS, f"{material}, {drive_text(drive)}")
    panels = figure.subplots(1, len(sizes), sharex=True, sharey=True, squeeze=False)[0]
    greatest = np.array([1.5, 1.5])  # of b/a and c/b in all panels
    for axes, size in zip(panels, sizes, strict=True):
        here = table[np.isclose(table["a_eff"].astype(float), size, rtol=1e-6, atol=0)]
        axes.set_title(rf"$a_\mathrm{{eff}}$ = {size / NM:.4g} nm, {plural(len(here), 'grain')}")
        if not len(here):
            empty(axes)
        lines = 0
        for kind, look in style.items():
            grains = here[here["type"] == kind]
            if not len(grains):
                continue
            start, end = axis_ratios(grains, "start"), axis_ratios(grains, "disr")
            axes.plot(*start, **_dot(look))
            axes.plot(*end, **_cross(look))
            greatest = np.nanmax(np.column_stack([greatest, start, end]), axis=1)
            (counts,) = oblate_counts(grains).to_dict("records")
            first, last = (f"{counts[f'{when}_oblate']}/{counts[f'{when}_known']}" for when in ("start", "disr"))
            text = f"{kind} oblate: {first} \N{RIGHTWARDS ARROW} {last}"
            axes.text(0.97, 0.97 - 0.07 * lines, text, transform=axes.transAxes, ha="right", va="top", c=look["color"])
            lines += 1

    right, top = 1.1 * greatest
    # Strips without points: above all of them stand the counts, below 1, where no ratio is, a word.
    top *= (top / 0.95) ** 0.5
    bottom = top**-0.12
    end = min(right, top)
    for axes in panels:
        axes.plot([1, end], [1, end], color=GREY, lw=0.8, zorder=1)
        axes.set(xscale="log", yscale="log", xlim=(0.95, right), ylim=(bottom, top))
        axes.set_xlabel("axis ratio $b/a$")
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_locator(FixedLocator([1, 1.2, 1.5, 2, 3, 5, 10, 20, 50]))
            axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            axis.set_minor_locator(NullLocator())
        axes.text(0.03, 0.97, "prolate", transform=axes.transAxes, color=GREY, va="top")
        axes.text(0.97, 0.02, "oblate", transform=axes.transAxes, color=GREY, ha="right", va="bottom")
    panels[0].set_ylabel("axis ratio $c/b$")
    handles = []
    for kind, look in style.items():
        handles.append(Line2D([], [], label=f"{kind} at rest", **_dot(look)))
        handles.append(Line2D([], [], label=rf"{kind} at $\omega_\mathrm{{disr}}$", **_cross(look)))
    columns = 2 if len(sizes) == 1 else len(handles)
    if handles:
        figure.legend(handles=handles, loc="outside lower center", ncols=columns)
    return figure


def _dot(look):
    """Filled marker of a type: a grain at rest."""
    return {"ls": "none", "marker": look["marker"], "ms": 3.2, "mfc": look["color"], "mec": "white", "mew": 0.3}


def _cross(look):
    """Cross of a type, with other arms for each: a grain at disruption."""
    cross = {"o": "x", "s": "+", "^": (6, 2, 0)}.get(look["marker"], (5, 2, 0))
    return {"ls": "none", "marker": cross, "ms": 4.2, "mec": look["color"], "mew": 0.8, "zorder": 3}


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
