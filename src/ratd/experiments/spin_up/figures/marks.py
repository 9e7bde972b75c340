"""How much the answer depends on what is called disruption."""

import numpy as np

from ratd.base.errors import InputError
from ratd.base.words import plural
from ratd.experiments.spin_up.cells import size_key
from ratd.experiments.spin_up.figures.overview import over_the_paper
from ratd.pictures.style import (
    GREY,
    TWO_COLUMNS,
    drive_of,
    drive_text,
    label_ends,
    logarithmic,
    nanometres,
    new_figure,
    size_limits,
    sizes_label,
    styled,
    type_style,
)

LINES = {
    "omega_first_loss": ("first loss of mass", {"color": GREY, "marker": "v", "ls": ":"}),
    "omega_mass_75": ("25 % of the mass lost", {"color": "#000000", "marker": "o", "ls": "-"}),
    "omega_contacts_75": ("25 % of the contacts lost", {"color": "#CC79A7", "marker": "D", "ls": "--"}),
    "omega_disr": (r"peak of the stress, $\omega_\mathrm{disr}$", {"color": "#E69F00", "marker": "s", "ls": "-."}),
}
"""Column of a mark -> its name and line."""


@styled
def marks(table, materials=None):
    """Marks of disruption over omega of the paper for the same grain, against size, a panel a type.

    Parameters
    ----------
    table : pandas.DataFrame
        One row a grain, of one drive, with what Eq. 33 needs (n_contacts, filling_factor).
    materials : optional
        Table of materials, handed to `ratd.base.materials.get_material`.

    Returns
    -------
    matplotlib.figure.Figure
        Geometric means over the grains that have all marks, so that those of one size are of the same grains. All
        panels have the same axes; the names stand at the ends of the lines.

    Raises
    ------
    InputError
        If no grain has all marks and a law in Table 3.
    """
    ratios = {mark: over_the_paper(table, mark, materials) for mark in LINES}
    known = np.all([ratio > 0 for ratio in ratios.values()], axis=0)
    if not known.any():
        raise InputError("marks: give at least one grain of Table 3 of the paper that has all marks")
    table = table.assign(**ratios)[known]
    style = type_style(table["type"])
    title = f"{plural(len(table), 'grain')} with all marks, {drive_text(drive_of(table))}"
    figure = new_figure(TWO_COLUMNS, 0.4 * TWO_COLUMNS, title)
    panels = figure.subplots(1, len(style), sharex=True, sharey=True, squeeze=False)[0]
    for axes, kind in zip(panels, style, strict=True):
        here = table[table["type"] == kind]
        groups = np.log(here[list(LINES)]).groupby(size_key(here["a_eff"]))
        means = np.exp(groups.mean())
        for mark, (_, look) in LINES.items():
            axes.plot(means.index / 1000, means[mark], lw=1.0, ms=3.0, **look)
        axes.axhline(1.0, color="black", lw=0.6, zorder=0)
        axes.set_title(kind)
        axes.set_xlabel(sizes_label())
        axes.set_yscale("log")
    logarithmic(panels[0].yaxis, labelled=(2, 5))
    panels[0].set_xlim(*nanometres(size_limits(table["a_eff"])))
    panels[0].set_ylabel("$\\omega$ over that of the paper\nfor the same grain")
    label_ends(panels[-1], [(text, means[mark].iloc[-1], look["color"]) for mark, (text, look) in LINES.items()])
    return figure
