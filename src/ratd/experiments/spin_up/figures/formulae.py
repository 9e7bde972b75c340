"""What single formulae of the paper change when they are used as printed."""

import numpy as np
from matplotlib.lines import Line2D

from ratd.base.errors import InputError
from ratd.base.words import plural
from ratd.experiments.spin_up.cells import size_key
from ratd.experiments.spin_up.formulae import OWN
from ratd.experiments.spin_up.parameters import MARKS
from ratd.experiments.spin_up.figures.style import type_style
from ratd.pictures.snapshots import drive_of, drive_text
from ratd.pictures.style import TWO_COLUMNS, logarithmic, new_figure, styled
from ratd.pipeline import io

TEXT = {
    "sliding_stiffness": "sliding stiffness\n$G^*=G/(2-2\\nu^2)$",
    "sliding_limit": "sliding limit\n$\\propto 1-\\nu$",
    "twisting_stiffness": "twisting stiffness\n$G^*=G/(2-2\\nu^2)$",
    "damping": "no damping",
}
TITLE = {"omega_disr": r"$\omega_\mathrm{disr}$", "omega_mass_75": "25 % of the mass lost"}
LANE = 0.21
"""Distance of the lanes of the types of a formula, whose distance is 1."""
GRAIN = {"ls": "none", "ms": 2.8, "mew": 0.6}
MEDIAN = {"color": "black", "lw": 1.4, "solid_capstyle": "butt"}


@styled
def formulae(table):
    """Ratio of each mark to that of the same grain in the consistent model, for each printed formula.

    Parameters
    ----------
    table : pandas.DataFrame
        What `formula_table` returns.

    Returns
    -------
    matplotlib.figure.Figure
        A panel a mark; a marker a grain, in a lane a type, open for the smallest size and filled for the others. The
        short lines are medians over all grains of a lane; there are few of them, so that they have no error.

    Raises
    ------
    InputError
        If there is no run with a printed formula.
    """
    names = list(dict.fromkeys(table.loc[table["formula"] != OWN, "formula"]))
    if not names:
        raise InputError("formulae: give at least one run with a printed formula")
    own = table[table["formula"] == OWN]
    sizes = np.unique(size_key(table["a_eff"]))
    style = type_style(table["type"])
    each = int(np.median(own.groupby(["type", size_key(own["a_eff"])]).size()))
    grains = plural(len(own), f"{own.iloc[0]['material']} grain")
    title = f"{grains}, {each} of each type and size, {drive_text(drive_of(table))}"
    figure = new_figure(TWO_COLUMNS, 0.45 * TWO_COLUMNS, title)
    panels = figure.subplots(1, len(MARKS), sharex=True, sharey=True)
    for axes, mark in zip(panels, MARKS, strict=True):
        axes.set_xscale("log")
        axes.axvline(1.0, color="0.6", lw=0.6, zorder=0)
        for row, name in enumerate(names):
            for k, (kind, look) in enumerate(style.items()):
                here = table[(table["formula"] == name) & (table["type"] == kind)]
                y = -row - LANE * (k - (len(style) - 1) / 2)
                _lane(axes, here, f"{mark}_ratio", y, look, sizes)
        axes.set_yticks(-np.arange(len(names)), [TEXT.get(name, name) for name in names])
        axes.tick_params(axis="y", which="both", length=0)
        axes.set_title(TITLE[mark])
        axes.set_xlabel("$\\omega$ over that in the consistent model")
    logarithmic(panels[0].xaxis, labelled=(2, 3, 5, 7))
    panels[0].set_ylim(-len(names) + 0.5, 0.5)
    handles = [Line2D([], [], ls="none", label=kind, **look) for kind, look in style.items()]
    handles += [
        Line2D([], [], color="black", marker="o", mfc=face, label=f"{size / 1000:.4g} nm", **GRAIN)
        for size, face in zip(sizes, _faces(sizes), strict=True)
    ]
    handles.append(Line2D([], [], label="median", **MEDIAN))
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles), handlelength=1.2)
    return figure


def _lane(axes, table, name, y, look, sizes):
    """Ratios of the grains of one type with one formula, at one height, and their median."""
    for size, face in zip(sizes, _faces(sizes), strict=True):
        ratio = table.loc[size_key(table["a_eff"]) == size, name]
        axes.plot(ratio, np.full(len(ratio), y), **look | GRAIN | {"mfc": face or look["color"]})
    if table[name].notna().any():
        axes.plot([table[name].median()] * 2, [y - 0.45 * LANE, y + 0.45 * LANE], zorder=3, **MEDIAN)


def _faces(sizes):
    """Faces of the markers of the sizes: white for the first of several, that of the type (None) for the others."""
    return ["white" if k == 0 and len(sizes) > 1 else None for k in range(len(sizes))]


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return formulae(io.read(files["table"], "formulae").to_dataframe())
