"""Which fragments leave while the first half of the mass of a grain goes."""

import numpy as np
import pandas as pd
from matplotlib.patches import Patch

from ratd.base.errors import InputError
from ratd.base.words import plural
from ratd.experiments.spin_up.fragmentation import SIZE_CLASSES, STAGES, mass_shares, size_class
from ratd.experiments.spin_up.figures.style import type_style
from ratd.pictures.snapshots import drive_text
from ratd.pictures.style import GREY, TWO_COLUMNS, logarithmic, new_figure, styled

EXPONENT = 3.5
"""Of a number of fragments by radius to compare with, dN/da ~ a^-3.5, that of models of shattering (Sect. 7.2)."""
SHARES = {
    "single monomers": (1, "#000000"),
    "2 to 10 monomers": (10, "#8A8A8A"),
    "more than 10": (np.inf, "#DDDDDD"),
}
"""Name of a class of fragments -> greatest number of monomers, colour."""
GREATEST = {name: most for name, (most, _) in SHARES.items()}
LINES = {"BA": "-", "BAM1": (0, (5, 1.5)), "BAM2": (0, (1.5, 1))}


@styled
def fragments(table, drive=None, stage="half"):
    """Cumulative number of fragments by mass, and the shares of small ones in the mass, a column a class of size.

    Parameters
    ----------
    table : pandas.DataFrame
        From `fragmentation.spun_up_fragments`, of one drive.
    drive : str, optional
        Named in the title.
    stage : str
        One of `fragmentation.STAGES`.

    Returns
    -------
    matplotlib.figure.Figure
        Above, the mean number in a grain of fragments that have a part of its mass or more, beside the slope of a^-3.5,
        m^(-5/6). Below, shares of the mass that leaves as monomers, as small fragments and as others, and the greatest
        of their standard errors. All columns have the same axes; all cells (material, type, size) of a class count
        alike.

    Raises
    ------
    InputError
        If no fragment is of the stage.

    References
    ----------
    Reissl et al. (2024), A&A 692, A60, Sect. 7.2, who expect the size distribution of the monomers.
    """
    table = table[table[stage]]
    if not len(table):
        raise InputError(f"fragments: give at least one fragment that leaves {STAGES[stage]}")
    named = f", {drive_text(drive)}" if drive else ""
    counted = f"{plural(len(table), 'fragment')} of {plural(table['grain'].nunique(), 'grain')}"
    figure = new_figure(TWO_COLUMNS, 0.62 * TWO_COLUMNS, f"{counted}, {STAGES[stage]}{named}")
    names = size_class(table["a_eff"])
    classes = [name for name in SIZE_CLASSES if (names == name).any()]
    panels = figure.subplots(2, len(classes), sharex="row", sharey="row", squeeze=False, height_ratios=[3, 1])
    style = type_style(table["type"])
    for (top, bottom), name in zip(panels.T, classes, strict=True):
        here = table[names == name]
        top.set_title(f"{name}, {plural(here['grain'].nunique(), 'grain')}")
        top.set(xscale="log", yscale="log")
        for kind, look in style.items():
            number = cumulative(here[here["type"] == kind])
            line = {"color": look["color"], "ls": LINES.get(kind, "-"), "lw": 1.2}
            top.plot(number["mass_fraction"], number["number"], drawstyle="steps-pre", label=kind, **line)
        top.set_xlabel("mass of a fragment $m/M$")
        most = _bars(bottom, here, style)
        errors = f",\nstandard errors up to {100 * most:.2g}" if most > 0 else ""
        bottom.set_xlabel(f"share of the lost mass [%]{errors}")
    top, bottom = panels[:, 0]
    for axis in (top.xaxis, top.yaxis):
        logarithmic(axis)
    for axes in panels[0]:
        _slope(axes)
    top.set_ylabel("fragments of a grain\nof $m/M$ or more")
    bottom.set_yticks(-np.arange(len(style)), list(style))
    for label, look in zip(bottom.get_yticklabels(), style.values(), strict=True):
        label.set_color(look["color"])
    handles = [*top.get_legend_handles_labels()[0], *(Patch(color=c, label=name) for name, (_, c) in SHARES.items())]
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles), handlelength=2.0)
    return figure


def cumulative(table):
    """Mean number in a grain of fragments that have at least some part of its mass.

    Parameters
    ----------
    table : pandas.DataFrame
        Of one type and class.

    Returns
    -------
    pandas.DataFrame
        Columns mass_fraction, ascending, and number, each grain with its weight.
    """
    table = table.sort_values("mass_fraction", kind="stable")
    grains = table.drop_duplicates("grain")["weight"].sum()
    number = table["weight"][::-1].cumsum()[::-1] / grains
    return pd.DataFrame({"mass_fraction": table["mass_fraction"], "number": number}).reset_index(drop=True)


def _bars(axes, table, style):
    """Bars of the shares, one a type; those of 10 % and more tell their number. Returns the greatest error."""
    most = 0.0
    for row, kind in enumerate(style):
        here = table[table["type"] == kind]
        if not len(here):
            continue
        left = 0.0
        for name, (share, error) in mass_shares(here, GREATEST).items():
            colour, most = SHARES[name][1], np.fmax(most, error)
            axes.barh(-row, 100 * share, left=left, height=0.7, color=colour)
            if share >= 0.1:
                ink = "white" if colour == "#000000" else "black"
                axes.text(left + 50 * share, -row, f"{100 * share:.0f}", ha="center", va="center", color=ink)
            left += 100 * share
    axes.set(xlim=(0, 100), xticks=(0, 25, 50, 75, 100))
    axes.tick_params(axis="y", length=0)
    return most


def _slope(axes):
    """Line with the slope of a^-3.5 through two fragments of a tenth of the mass, near which most grains lie."""
    low, high = axes.get_xlim()
    slope = (1.0 - EXPONENT) / 3.0  # N(> a) ~ a^(1 - 3.5), a ~ m^(1/3)
    x = np.array([low, high])
    axes.plot(x, 2.0 * (x / 0.1) ** slope, color=GREY, lw=0.9, zorder=0, scalex=False, scaley=False)
    top = axes.get_ylim()[1]
    place = {"textcoords": "offset points", "xytext": (12, -2), "ha": "left", "va": "top", "color": GREY}
    axes.annotate(rf"$a^{{-{EXPONENT:g}}}$", (0.1 * (0.45 * top) ** (1.0 / slope), 0.9 * top), **place)
