"""Fig. 9: disruption of the same grains with other critical rolling displacements and viscous times."""

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from ratd.base.errors import InputError
from ratd.base.units import NM, PS
from ratd.base.words import plural
from ratd.experiments.spin_up.cells import GRAIN, size_key
from ratd.experiments.spin_up.parameters import MARKS, OWN, PARAMETERS, effect
from ratd.experiments.spin_up.printed import VISCOUS_EFFECT
from ratd.experiments.spin_up.figures.style import type_style
from ratd.pictures.snapshots import drive_of, drive_text
from ratd.pictures.style import GREY, TWO_COLUMNS, new_figure, styled
from ratd.pipeline import io

AXIS = {
    "xi_c": (NM, r"critical rolling displacement $\xi_\mathrm{c}$ [nm]"),
    "T_vis": (PS, r"viscous time $T_\mathrm{vis}$ [ps]"),
}
"""Parameter -> unit of its axis [SI], label."""
MARK_TEXT = {"omega_disr": r"$\omega_\mathrm{disr}$", "omega_mass_75": "25 % of the mass lost"}
MARK_FACE = {"omega_disr": None, "omega_mass_75": "white"}
"""Filled and open markers."""
STATED = {"color": "black", "marker": "x", "ms": 5.0}
BASE = {"color": GREY, "marker": "o", "ms": 4.0, "mfc": "white", "ls": "none"}
"""The paper's value, with which the ratio is 1."""
LEAST = (0.92, 1.16)
"""The axis reaches at least from the one to the other, so that drives can be compared."""


@styled
def figure9(table):
    """How far disruption of the same grains moves with each value of two constants of the material (Fig. 9).

    Parameters
    ----------
    table : pandas.DataFrame
        What `parameters.parameter_table` returns, of one drive.

    Returns
    -------
    matplotlib.figure.Figure
        A panel for each of the two parameters, with one axis: the ratio of a mark to that of the same grain with the
        material as it is (the paper's value), median over all sizes and its standard error. At the paper's value, where
        all ratios are 1 by definition, one grey marker.

    Raises
    ------
    InputError
        If there are no runs.

    References
    ----------
    Reissl et al. (2024), A&A 692, A60, Fig. 9 and Sect. 7.5. The paper draws omega over size, a line a value, where the
    lines of one type lie on each other.
    """
    if not len(table):
        raise InputError("figure9: give at least one run")
    n_grains = len(table.drop_duplicates(GRAIN))
    material = ", ".join(dict.fromkeys(table["material"]))
    sizes = ", ".join(f"{size / 1000:.4g}" for size in np.unique(size_key(table["a_eff"])))
    title = f"{plural(n_grains, f'{material} grain')} of {sizes} nm with every setting, {drive_text(drive_of(table))}"
    figure = new_figure(TWO_COLUMNS, 0.42 * TWO_COLUMNS, title)
    panels = figure.subplots(1, len(PARAMETERS), sharey=True)
    style = type_style(table["type"])
    ends = list(LEAST)
    for axes, parameter in zip(panels, PARAMETERS, strict=True):
        ends += _against_value(axes, table[table["parameter"].isin((OWN, parameter))], parameter, style)
    margin = 0.04 * (np.nanmax(ends) - np.nanmin(ends))
    panels[0].set_ylim(np.nanmin(ends) - margin, np.nanmax(ends) + margin)
    panels[0].set_ylabel("$\\omega$ over that of the same\ngrain with the paper's value")
    kinds = [Line2D([], [], ls="none", label=kind, **look) for kind, look in style.items()]
    # the marks of no type in particular have a marker of none
    marks = [
        Line2D([], [], color="black", marker="D", mfc=MARK_FACE[mark], ls="none", label=MARK_TEXT[mark])
        for mark in MARKS
    ]
    figure.legend(handles=[*kinds, *marks], loc="outside lower center", ncols=len(kinds) + len(marks))
    return figure


def _against_value(axes, table, parameter, style):
    """Ratios of the marks to those of the same grain with the paper's value, against the value of the parameter.

    Returns the ends of all error bars.
    """
    unit, label = AXIS[parameter]
    axes.axhline(1.0, color="black", lw=0.6)
    values = np.sort(table[PARAMETERS[parameter]].unique()) / unit
    own = table.loc[table["parameter"] == OWN, PARAMETERS[parameter]].iloc[0] / unit
    logarithm = parameter == "xi_c"  # its values double
    signs = len(MARKS) * len(style)
    place = iter(np.arange(signs) - 0.5 * (signs - 1))
    ends = []
    for kind, look in style.items():
        for mark in MARKS:
            found = effect(table[table["type"] == kind], parameter, mark)
            found = found[~np.isclose(found["value"] / unit, own)]
            x, shift = found["value"].to_numpy() / unit, next(place)
            x = x * 1.12**shift if logarithm else x + 0.3 * shift
            median, error = found["median"].to_numpy(), np.nan_to_num(found["error"].to_numpy())
            form = {"ls": "none", "elinewidth": 0.8, "capsize": 1.5, "ms": 4.0, "mfc": MARK_FACE[mark]}
            axes.errorbar(x, median, error, **look | form)
            ends += [*(median - error), *(median + error)]
    axes.plot(own, 1.0, **BASE)
    # beside the edge of the panel the words stand inside
    side, away = ("left", -4) if own <= values[0] else ("right", 4) if own >= values[-1] else ("center", 0)
    below = {"textcoords": "offset points", "xytext": (away, -5), "ha": side, "va": "top", "color": GREY}
    axes.annotate("1 by definition", (own, 1.0), **below)
    if parameter == "T_vis":
        time, ratio = VISCOUS_EFFECT
        axes.plot(time / PS, ratio, ls="none", **STATED)
        place = {"textcoords": "offset points", "xytext": (-6, 0), "ha": "right", "va": "center"}
        axes.annotate("paper, BAM2", (time / PS, ratio), **place)
    if logarithm:
        axes.set_xscale("log")
    axes.xaxis.set_major_locator(FixedLocator(values))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_xlabel(f"{label}, paper: {own:g}")
    return ends


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return figure9(io.read(files["table"], "parameters").to_dataframe())
