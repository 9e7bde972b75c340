"""Fig. 9: disruption of the same grains with other critical rolling displacements and viscous times."""

import numpy as np
from matplotlib import colormaps
from matplotlib.lines import Line2D

from ratd.base.errors import InputError
from ratd.base.units import NM, PS
from ratd.base.words import plural
from ratd.experiments.spin_up.cells import cell_statistics, size_key
from ratd.experiments.spin_up.parameters import MARKS, OWN, PARAMETERS, effect
from ratd.experiments.spin_up.printed import VISCOUS_EFFECT
from ratd.pictures.style import (
    GREY,
    TWO_COLUMNS,
    drive_of,
    drive_text,
    logarithmic,
    nanometres,
    new_figure,
    size_limits,
    sizes_label,
    styled,
    type_style,
)
from ratd.pipeline import io

AXIS = {
    "xi_c": (NM, r"critical rolling displacement $\xi_\mathrm{c}$ [nm]", "{:g} nm"),
    "T_vis": (PS, r"viscous time $T_\mathrm{vis}$ [ps]", "{:g} ps"),
}
"""Parameter -> unit of its axis [SI], label, text of a value."""
LINES = ((0, (4, 2)), (0, (1, 1.2)), "-")
"""Lines of the types in their order; the paper has dashed BA and dotted BAM2."""
OWN_COLOUR = "black"
MARK_TEXT = {"omega_disr": r"$\omega_\mathrm{disr}$", "omega_mass_75": "25 % of the mass lost"}
MARK_FACE = {"omega_disr": None, "omega_mass_75": "white"}
"""Filled and open markers."""
STATED = {"color": "black", "marker": "x", "ms": 5.0}


@styled
def figure9(table):
    """omega_disr against size with each setting, and how far the median grain moves with it (Fig. 9).

    Parameters
    ----------
    table : pandas.DataFrame
        What `parameters.parameter_table` returns, of one drive.

    Returns
    -------
    matplotlib.figure.Figure
        A column for each of the two parameters. Above, the mean over the grains of a size, a line a setting; left out
        where all grains have one size, which makes no line. Below, the ratio of a mark to that of the same grain with
        the material as it is (the paper's value), median and its standard error.

    Raises
    ------
    InputError
        If there are no runs.

    References
    ----------
    Reissl et al. (2024), A&A 692, A60, Fig. 9 and Sect. 7.5.
    """
    if not len(table):
        raise InputError("figure9: give at least one run")
    n_grains = len(table.drop_duplicates(["material", "type", "a_eff", "seed"]))
    material = ", ".join(dict.fromkeys(table["material"]))
    several = size_key(table["a_eff"]).nunique() > 1
    of = "" if several else f" of {nanometres(table['a_eff'].iloc[0]):.4g} nm"
    title = f"{plural(n_grains, f'{material} grain')}{of} with every setting, {drive_text(drive_of(table))}"
    figure = new_figure(TWO_COLUMNS, (0.72 if several else 0.44) * TWO_COLUMNS, title)
    panels = figure.subplots(2 if several else 1, len(PARAMETERS), squeeze=False)
    style = type_style(table["type"])
    lines = {kind: LINES[k % len(LINES)] for k, kind in enumerate(style)}
    for column, parameter in zip(panels.T, PARAMETERS, strict=True):
        here = table[table["parameter"].isin((OWN, parameter))]
        _against_value(column[-1], here, parameter, style, lines)
        if several:
            _against_size(column[0], here, parameter, style, lines)
    if several:
        panels[0, 1].sharey(panels[0, 0])
        logarithmic(panels[0, 0].yaxis)
        panels[0, 0].set_ylabel(r"mean $\omega_\mathrm{disr}$ [rad s$^{-1}$]")
    panels[-1, 0].set_ylabel("$\\omega$ over that of the same\ngrain with the paper's value")
    kinds = [Line2D([], [], ls=lines[kind], label=kind, **look) for kind, look in style.items()]
    # the marks of no type in particular have a marker of none
    marks = [
        Line2D([], [], color="black", marker="D", mfc=MARK_FACE[mark], ls="none", label=MARK_TEXT[mark])
        for mark in MARKS
    ]
    stated = Line2D([], [], **STATED, ls="none", label="BAM2, stated in the paper")
    figure.legend(handles=[*kinds, *marks, stated], loc="outside lower center", ncols=6, handlelength=3.0)
    return figure


def _against_size(axes, table, parameter, style, lines):
    """Mean omega_disr against size: a colour a value, a kind of line a type."""
    unit, _, text = AXIS[parameter]
    values = np.sort(table[PARAMETERS[parameter]].unique())
    own = table.loc[table["parameter"] == OWN, PARAMETERS[parameter]].iloc[0]
    shades = dict(zip(values, colormaps["viridis"](np.linspace(0.0, 0.9, len(values))), strict=True))
    handles = []
    for value in values:
        look = {"color": OWN_COLOUR, "lw": 1.6, "zorder": 3} if value == own else {"color": shades[value], "lw": 0.8}
        for kind in style:
            part = table[(table["type"] == kind) & (table[PARAMETERS[parameter]] == value)]
            cells = cell_statistics(part, ("type", "a_eff"))
            x, mean = nanometres(cells["a_eff"]), cells["omega_disr_mean"]
            axes.plot(x, mean, ls=lines[kind], marker=style[kind]["marker"], ms=2.5, **look)
        whose = " (paper)" if value == own else ""
        handles.append(Line2D([], [], label=text.format(value / unit) + whose, **look))
    axes.set_yscale("log")
    axes.set_xlim(*nanometres(size_limits(table["a_eff"])))
    axes.set_xlabel(sizes_label())
    axes.legend(handles=handles, ncols=3, loc="lower center", bbox_to_anchor=(0.5, 1.0))


def _against_value(axes, table, parameter, style, lines):
    """Ratios of the marks to those of the same grain with the paper's value, against the value of the parameter."""
    unit, label, _ = AXIS[parameter]
    axes.axhline(1.0, color="black", lw=0.6)
    for value in table[PARAMETERS[parameter]].unique():
        axes.axvline(value / unit, color=GREY, lw=0.4, zorder=0)
    logarithm = parameter == "xi_c"  # its values double
    steps = np.array([-1.5, -0.5, 0.5, 1.5])[: len(MARKS) * len(style)]
    place = iter(steps - steps.mean())
    for kind, look in style.items():
        for mark in MARKS:
            found = effect(table[table["type"] == kind], parameter, mark)
            x, shift = found["value"].to_numpy() / unit, next(place, 0.0)
            x = x * 1.09**shift if logarithm else x + 0.24 * shift
            axes.errorbar(
                x, found["median"], found["error"], lw=0.8, elinewidth=0.8, capsize=1.5, ms=4.5, **look,
                ls=lines[kind] if mark == MARKS[0] else "none", mfc=MARK_FACE[mark],
            )  # fmt: skip
    if parameter == "T_vis":
        axes.plot(VISCOUS_EFFECT[0] / PS, VISCOUS_EFFECT[1], ls="none", **STATED)
    if logarithm:
        axes.set_xscale("log")
        logarithmic(axes.xaxis)
    axes.set_xlabel(label)


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return figure9(io.read(files["table"], "parameters").to_dataframe())
