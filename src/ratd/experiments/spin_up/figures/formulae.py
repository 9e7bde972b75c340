"""What single formulae of the paper change when they are used as printed."""

import numpy as np
from matplotlib.lines import Line2D

from ratd.base.errors import InputError
from ratd.base.words import plural
from ratd.experiments.spin_up.formulae import OWN, formula_effects
from ratd.experiments.spin_up.parameters import MARKS
from ratd.pictures.style import TWO_COLUMNS, drive_of, drive_text, new_figure, styled, type_style
from ratd.pipeline import io

TEXT = {
    "sliding_stiffness": "sliding stiffness\n$G^*=G/(2-2\\nu^2)$",
    "sliding_limit": "sliding limit\n$\\propto 1-\\nu$",
    "twisting_stiffness": "twisting stiffness\n$G^*=G/(2-2\\nu^2)$",
    "damping": "no damping",
}
TITLE = {"omega_disr": r"$\omega_\mathrm{disr}$", "omega_mass_75": "25 % of the mass lost"}
ALL = {"color": "black", "marker": "D"}


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
        A row a size, a panel a mark. Medians over the grains of a type, and over all, with their standard errors.

    Raises
    ------
    InputError
        If there is no run with a printed formula.
    """
    names = list(dict.fromkeys(table.loc[table["formula"] != OWN, "formula"]))
    if not names:
        raise InputError("formulae: give at least one run with a printed formula")
    own = table[table["formula"] == OWN]
    grains = plural(len(own), f"{own.iloc[0]['material']} grain")
    title = f"{grains} with every formula, {drive_text(drive_of(table))}"
    effects = {mark: formula_effects(table, mark) for mark in MARKS}
    sizes = np.unique(effects[MARKS[0]]["nm"])
    figure = new_figure(TWO_COLUMNS, (0.1 + 0.32 * len(sizes)) * TWO_COLUMNS, title)
    looks = type_style(table["type"]) | {"all": ALL}
    panels = figure.subplots(len(sizes), len(MARKS), sharex="col", sharey=True, squeeze=False)
    for (mark, found), column in zip(effects.items(), panels.T, strict=True):
        for nm, axes in zip(sizes, column, strict=True):
            axes.axvline(1.0, color="black", lw=0.6)
            for k, (kind, look) in enumerate(looks.items()):
                here = found[(found["type"] == kind) & (found["nm"] == nm)].set_index("formula").reindex(names)
                y = -np.arange(len(names)) - 0.16 * (k - (len(looks) - 1) / 2)
                axes.errorbar(here["median"], y, xerr=here["error"], ls="none", elinewidth=0.8, capsize=1.5, **look)
            axes.set_yticks(-np.arange(len(names)), [TEXT.get(name, name) for name in names])
            axes.tick_params(axis="y", which="both", length=0)
            axes.set_title(f"{TITLE[mark]}, {nm:g} nm")
        axes.set_xlabel("$\\omega$ over that in the consistent model")
    handles = [Line2D([], [], ls="none", label=kind, **look) for kind, look in looks.items()]
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles))
    return figure


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return formulae(io.read(files["table"], "formulae").to_dataframe())
