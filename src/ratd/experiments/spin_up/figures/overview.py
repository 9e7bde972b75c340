"""The answer in one figure: how fast grains turn when they break, over what the paper says for the same grains."""

import numpy as np
from matplotlib.lines import Line2D

from ratd.base.errors import InputError
from ratd.base.words import plural
from ratd.experiments.spin_up.cells import joined
from ratd.experiments.spin_up.eq33 import eq33_omega
from ratd.experiments.spin_up.marks import MARK
from ratd.experiments.spin_up.printed import PAPER_MEAN_RADIUS, TABLE_3
from ratd.experiments.spin_up.figures.style import (
    middle_and_most,
    offsets,
    open_markers,
    size_limits,
    sizes_label,
    type_style,
)
from ratd.pictures.snapshots import drive_of, drive_text
from ratd.pictures.style import TWO_COLUMNS, label_ends, logarithmic, nanometres, new_figure, styled

TITLE = "angular velocity at which a quarter of the mass is lost, over that of the paper"
APART = 1.6
"""Distance of the types at one size over that of the other figures (`offsets`)."""
BOUND = {"lw": 1.1, "ls": (0, (4, 1.5))}


@styled
def overview(prescribed, literal=None, firm=None, grown=None):
    """omega at which grains break over omega of the paper for the same grain, against size.

    Parameters
    ----------
    prescribed : pandas.DataFrame
        Table of the grains turned at the given omega, with what Eq. 33 needs (n_contacts, filling_factor).
    literal : pandas.DataFrame, optional
        The same of those turned by the equations as printed: a second panel.
    firm : pandas.DataFrame, optional
        Bounds of `firm_bound.FIRM_BOUND_COLUMNS`.
    grown : pandas.DataFrame, optional
        Grains of `firm` with what Eq. 33 needs; default: those of `prescribed`.

    Returns
    -------
    matplotlib.figure.Figure
        Medians over the grains of a size and type as markers, the middle two thirds as bars, the types side by side. 1
        is the paper: Eq. 33 with A, alpha and <a_mon> as printed, for the contacts and the filling factor of the grain.
        Dashed with the type's open marker, in each panel, the median of the bound for the grains of `firm`.

    Raises
    ------
    InputError
        If no grain has the mark and a law in Table 3.
    """
    tables = [prescribed] if literal is None else [prescribed, literal]
    tables = [table.assign(ratio=over_the_paper(table, MARK)) for table in tables]
    if not any(table["ratio"].notna().any() for table in tables):
        raise InputError(f"overview: give at least one grain of Table 3 of the paper with {MARK}")
    style = type_style([kind for table in tables for kind in table["type"]])
    figure = new_figure(TWO_COLUMNS, (0.56 if len(tables) == 1 else 0.5) * TWO_COLUMNS, TITLE)
    panels = figure.subplots(1, len(tables), sharex=True, sharey=True, squeeze=False)[0]
    every = np.concatenate([table["a_eff"] for table in tables])
    shifts = dict(zip(style, APART * offsets(every, len(style)), strict=True))
    ends = []
    for axes, table in zip(panels, tables, strict=True):
        axes.axhline(1.0, color="black", lw=0.8, zorder=1)
        for kind, look in style.items():
            here = table[table["type"] == kind]
            found = middle_and_most(axes, here["a_eff"] + shifts[kind], here["ratio"], look)
            if len(found):
                ends.append((kind, found["middle"].iloc[-1], look["color"]))
        drive = drive_of(table)
        axes.set_title(f"{int(table['ratio'].notna().sum())} of {plural(len(table), 'grain')}, {drive_text(drive)}")
        axes.set_xlabel(sizes_label())
        axes.set_yscale("log")
        if firm is not None:
            _bounds(axes, firm, prescribed if grown is None else grown, style, shifts)
    logarithmic(panels[0].yaxis, labelled=(2, 5))
    panels[0].set_xlim(*nanometres(size_limits(every)))
    panels[0].set_ylabel("$\\omega$ over that of the paper\nfor the same grain")
    handles = [Line2D([], [], color="black", lw=0.8, label="the paper: Eq. 33 with Table 3")]
    if firm is not None:
        handles.append(Line2D([], [], color="black", label="firm bound of the grain as grown", **BOUND))
    if len(panels) == 1:
        label_ends(panels[0], ends)
    else:
        handles = [Line2D([], [], ls="none", label=kind, **look) for kind, look in style.items()] + handles
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles), handlelength=2.2)
    return figure


def over_the_paper(table, column):
    """A column of omega [rad s-1] over Eq. 33 as printed for each grain, pandas.Series; NaN where one is not known."""
    return table[column].astype(float) / eq33_omega(table, TABLE_3, PAPER_MEAN_RADIUS)


def _bounds(axes, firm, grains, style, shifts):
    """Median of the bound over Eq. 33 of each type and size, a line a type, where its markers stand."""
    known = joined(grains, firm, ["firm_bound"])
    known = known.assign(ratio=over_the_paper(known, "firm_bound"))
    for kind, look in style.items():
        median = known[known["type"] == kind].groupby("size")["ratio"].median()
        sizes = median.index / 1000 + nanometres(shifts[kind])
        axes.plot(sizes, median, color=look["color"], zorder=1, **BOUND)
        open_markers(axes, sizes, median, look)
