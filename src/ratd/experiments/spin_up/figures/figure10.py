"""Fig. 10: the angular velocity at which two monomers part, against two references."""

import numpy as np
import pandas as pd
from matplotlib.lines import Line2D

from ratd.base.errors import InputError
from ratd.base.words import plural
from ratd.experiments.spin_up.cells import sort_cells
from ratd.experiments.spin_up.printed import PAIR_ERROR
from ratd.pictures.snapshots import drive_text
from ratd.pictures.style import GREY, ONE_COLUMN, TWO_COLUMNS, logarithmic, nanometres, new_figure, styled
from ratd.pipeline import io

LOOK = {
    "damped": {"color": "#0072B2", "marker": "o", "ms": 3.0},
    "undamped": {"color": "#D55E00", "marker": "s", "ms": 3.0, "mfc": "white"},
}
REFERENCE = {"damped": "force_controlled_omega", "undamped": "eq35_omega"}
"""Start -> the column of its reference."""
LINES = {
    "force_controlled_omega": (r"slow load, $\sqrt{3\pi\gamma/2m}$", {"color": "black", "lw": 0.9}),
    "eq35_omega": (r"Eq. 35, $\sqrt{5\pi\gamma/6m}$", {"color": "black", "lw": 0.9, "ls": (0, (4, 2))}),
}
"""Column of a reference -> its name and line."""
SHOWN = 9
"""Pairs of each start whose omega is shown: more would hide the lines."""


def relative_error(table):
    """(reference - simulated)/reference of each pair, the reference being that of its start."""
    reference = np.select(
        [table["start"] == start for start in REFERENCE], [table[name] for name in REFERENCE.values()]
    )
    return 1.0 - table["parting_omega"].to_numpy(float) / reference


@styled
def figure10(table):
    """omega of parting against radius, a column a material, and the relative error below (Fig. 10).

    Parameters
    ----------
    table : pandas.DataFrame
        Columns of `pairs.PAIR_COLUMNS`.

    Returns
    -------
    matplotlib.figure.Figure
        The materials stand in the paper's order. Above, `SHOWN` pairs of each start, spread over the radii; below all,
        over the reference of their start, less 1. The title tells f of the steps, the legend epsilon of the spin-ups.

    Raises
    ------
    InputError
        If there is no pair.

    References
    ----------
    Reissl et al. (2024), A&A 692, A60, Fig. 10, Eq. 35.
    """
    if not len(table):
        raise InputError("figure10: give at least one pair")
    table = table.assign(over=-100 * relative_error(table))
    names = list(sort_cells(table[["material"]].drop_duplicates())["material"])
    radii = np.unique(table["monomer_radius"])
    wide = len(names) > 1
    steps = ", ".join(f"{factor:g}" for factor in dict.fromkeys(table["timestep_factor"]))
    of_each = " of each material" if wide else ""
    title = (
        f"{plural(len(radii), 'pair')} of equal monomers{of_each}, above {len(_spread(radii))} of them",
        f"{drive_text('prescribed')}, $f$ = {steps}",
    )
    title = (", " if wide else "\n").join(title)
    figure = new_figure(TWO_COLUMNS if wide else ONE_COLUMN, 0.6 * TWO_COLUMNS, title)
    panels = figure.subplots(2, len(names), sharex=True, sharey="row", squeeze=False, height_ratios=[2, 1])
    for (top, bottom), name in zip(panels.T, names, strict=True):
        here = table[table["material"] == name].sort_values("monomer_radius")
        radius = nanometres(here["monomer_radius"])
        top.set_title(name)
        for column, (_, line) in LINES.items():
            top.plot(radius, here[column], zorder=3, **line)
        for start, look in LOOK.items():
            part = here[here["start"] == start]
            few = _spread(part["monomer_radius"].to_numpy())
            x = nanometres(part["monomer_radius"])
            top.plot(x[few], part["parting_omega"].to_numpy()[few], ls="none", mew=0.6, zorder=2, **look | {"ms": 4.5})
            bottom.plot(x, part["over"], ls="none", mew=0.6, **look)
        lost = int(here["parting_omega"].isna().sum())
        if lost:
            top.text(0.97, 0.95, f"never parted: {lost}", transform=top.transAxes, ha="right", va="top")
        bottom.axhline(0.0, color="black", lw=0.6)
        for sign in (-1, 1):
            bottom.axhline(100 * sign * PAIR_ERROR, color=GREY, lw=0.6, ls=(0, (3, 2)))
        bottom.set_xlabel("radius of both monomers [nm]")
    top.set_yscale("log")
    logarithmic(panels[0, 0].yaxis)
    limit = 1.15 * max(100 * PAIR_ERROR, np.nanmax(np.abs(table["over"]), initial=0.0))
    panels[1, 0].set_ylim(-limit, limit)
    line = panels[1, 0].get_yaxis_transform()
    text = f"paper: {100 * PAIR_ERROR:g} %"
    panels[1, 0].text(0.98, 96 * PAIR_ERROR, text, transform=line, ha="right", va="top", color=GREY)
    panels[0, 0].set_ylabel(r"$\omega$ of parting [rad s$^{-1}$]")
    panels[1, 0].set_ylabel("over its line,\nless 1 [%]")
    rates = table.groupby("start")["epsilon"].first()
    handles = [
        Line2D([], [], ls="none", label=rf"{start} pairs, $\epsilon$ = {rates[start]:g}", mew=0.6, **look)
        for start, look in LOOK.items()
        if start in rates
    ]
    handles += [Line2D([], [], label=text, **line) for text, line in LINES.values()]
    figure.legend(handles=handles, loc="outside lower center", ncols=4 if wide else 2)
    return figure


def _spread(radius):
    """Numbers of at most `SHOWN` of some radii, ascending ones, evenly spread over them."""
    wanted = np.linspace(radius[0], radius[-1], SHOWN) if len(radius) else []
    return np.unique([np.argmin(np.abs(radius - value)) for value in wanted]).astype(int)


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    tables = [io.read(path, "pairs").to_dataframe() for path in files["pairs"]]
    return figure10(pd.concat(tables, ignore_index=True))
