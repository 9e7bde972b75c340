"""The largest grain that radiation leaves whole, against the strength of the radiation."""

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from ratd.experiments.spin_up.radiation import DIFFUSE
from ratd.experiments.spin_up.surviving import COMPUTED, is_extrapolated, surviving
from ratd.experiments.spin_up.figures.style import type_style
from ratd.pictures.style import GREY, ONE_COLUMN, TWO_COLUMNS, empty, logarithmic, nanometres, new_figure, styled

STRENGTHS = np.geomspace(0.1, 1e5, 121)
SIZES = (40e-9, 700e-9)
"""Ends of the axis of sizes [m]."""
LINES = {"ours": {"ls": "-", "lw": 1.6}, "printed": {"ls": (0, (4, 2)), "lw": 1.1}}
"""How the lines of a law look."""
BEYOND = {"ls": (0, (1, 1.4))}
"""How they look where the law is extrapolated."""
_PALE = 0.5


@styled
def radiation(table, grown, mark="omega_mass_75", around=DIFFUSE, materials=None):
    """Largest surviving grain against the strength of the radiation, a panel a material.

    Parameters
    ----------
    table : pandas.DataFrame
        Grains that were spun up, of one drive.
    grown : pandas.DataFrame
        Grains as grown.
    mark : str
        omega of disruption of this work.
    around : ratd.experiments.spin_up.radiation.Surroundings
    materials : optional
        Table of materials, handed to `ratd.base.materials.get_material`.

    Returns
    -------
    matplotlib.figure.Figure
        By the law of this work as solid lines, each with a band up to the size that the stronger drag leaves, by gas
        that hits all of the porous grain; by the printed Table 3 as dashed lines, paler. Dotted where the size is none
        of those that were spun up, which the grey areas show. A line begins where the first size is destroyed.
    """
    found, stronger = (
        surviving(table, grown, STRENGTHS, mark, around=around, materials=materials, porous=porous, draws=0)
        for porous in (False, True)
    )
    # where the stronger drag lets no grain be torn, the band has no end
    found["with_stronger"] = stronger["a_disr"].fillna(np.inf)
    names = list(dict.fromkeys(found["material"])) or [""]
    wide = len(names) > 1
    title = "Radiation destroys grains above a line"
    figure = new_figure(TWO_COLUMNS if wide else ONE_COLUMN, 0.48 * TWO_COLUMNS, title)
    panels = figure.subplots(1, len(names), sharex=True, sharey=True, squeeze=False)[0]
    style = type_style(found["type"])
    for axes, name in zip(panels, names, strict=True):
        axes.set_title(name)
        axes.set_xlabel("strength of the radiation $U$")
        _ground(axes)
        here = found[found["material"] == name]
        if not here["a_disr"].notna().any():
            empty(axes, "no grain is destroyed")
        for (kind, law), line in here.groupby(["type", "law"], sort=False):
            _line(axes, line, LINES[law], _shade(style[kind]["color"], law))
    panels[0].set_ylabel("largest grain that survives, $a_\\mathrm{eff}$ [nm]")
    panels[0].set_xlim(STRENGTHS[0], STRENGTHS[-1])
    panels[0].set_ylim(*nanometres(SIZES))
    logarithmic(panels[0].xaxis)
    logarithmic(panels[0].yaxis)
    _legend(figure, style, wide)
    return figure


def _ground(axes):
    """Logarithmic axes, the sizes that were not spun up in grey, and the field near the sun."""
    axes.set_xscale("log")
    axes.set_yscale("log")
    for low, high in ((SIZES[0], COMPUTED[0]), (COMPUTED[1], SIZES[1])):
        axes.axhspan(*nanometres([low, high]), color=GREY, alpha=0.18, lw=0)
    axes.axvline(1.0, color=GREY, lw=0.7)
    axes.text(1.15, nanometres(SIZES[0]) * 1.04, "starlight\nnear the sun", color="black", va="bottom")


def _line(axes, line, look, colour):
    """One law of one type: within the sizes that were spun up as it looks, beyond them dotted."""
    strength, size = line["strength"].to_numpy(), nanometres(line["a_disr"])
    if look is LINES["ours"]:
        end = nanometres(line["with_stronger"].clip(upper=SIZES[1]))
        axes.fill_between(strength, size, end, color=colour, alpha=0.15, lw=0)
    beyond = is_extrapolated(line["a_disr"].to_numpy())
    axes.plot(strength, np.where(beyond, np.nan, size), color=colour, **look)
    # with the first one inside, so that the two meet
    near = beyond | np.append(False, beyond[:-1]) | np.append(beyond[1:], False)
    axes.plot(strength, np.where(near, size, np.nan), color=colour, **look | BEYOND)


def _shade(colour, law):
    """The colour of a type, paler and greyer for the printed law."""
    if law == "ours":
        return colour
    rgb, grey = (np.array([int(text[k : k + 2], 16) for k in (1, 3, 5)]) / 255 for text in (colour, GREY))
    return tuple((1 - _PALE) * rgb + _PALE * grey)


def _legend(figure, style, wide):
    """One legend for all panels: types, then what the lines are."""
    entries = {kind: Line2D([], [], color=look["color"], **LINES["ours"]) for kind, look in style.items()}
    entries["this work"] = Line2D([], [], color="black", **LINES["ours"])
    entries["stronger drag"] = Patch(color="black", alpha=0.15, lw=0)
    entries["Table 3 as printed"] = Line2D([], [], color=_shade("#000000", "printed"), **LINES["printed"])
    entries["extrapolated"] = Line2D([], [], color="black", lw=1.4, **BEYOND)
    figure.legend(
        entries.values(), entries.keys(), loc="outside lower center", handlelength=2.2, ncols=7 if wide else 2
    )
