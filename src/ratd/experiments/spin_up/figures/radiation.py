"""The largest grain that radiation leaves whole, against the strength of the radiation."""

import numpy as np
from matplotlib.lines import Line2D

from ratd.experiments.spin_up.surviving import COMPUTED, is_extrapolated, surviving
from ratd.experiments.spin_up.figures.style import type_style
from ratd.pictures.style import GREY, ONE_COLUMN, TWO_COLUMNS, empty, logarithmic, nanometres, new_figure, styled

STRENGTHS = np.geomspace(0.1, 1e5, 121)
SIZES = (40e-9, 700e-9)
"""Ends of the axis of sizes [m]."""
LINES = {"ours": {"ls": "-", "lw": 1.6}, "printed": {"ls": (0, (4, 2)), "lw": 1.1, "mfc": "white", "mew": 0.8}}
"""How the lines of a law look, with open markers for the printed one."""
BEYOND = {"ls": (0, (1, 1.4))}
"""How they look where the law is extrapolated."""
MARKED, STAGGER = 26, 9
"""A line has a marker at one of so many strengths, that of the next type so many strengths further on."""


@styled
def radiation(table, grown):
    """Largest surviving grain against the strength of the radiation, a panel a material.

    Parameters
    ----------
    table : pandas.DataFrame
        Grains that were spun up, of one drive.
    grown : pandas.DataFrame
        Grains as grown.

    Returns
    -------
    matplotlib.figure.Figure
        By the law of this work as solid lines, with bars up to the size that the stronger drag leaves, by gas that hits
        all of the porous grain; by the printed Table 3 as dashed lines. Both have markers of the type, filled and open
        ones. Dotted where the size is none of those that were spun up, which the grey areas show. A line begins where
        the first size is destroyed.
    """
    found, stronger = (surviving(table, grown, STRENGTHS, porous=porous, draws=0) for porous in (False, True))
    # where the stronger drag lets no grain be torn, the bar has no end
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
            _line(axes, line, LINES[law], style[kind], list(style).index(kind) * STAGGER)
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


def _line(axes, line, look, style, first):
    """One law of one type: within the sizes that were spun up as it looks, beyond them dotted.

    Its markers, and the bars of our law, stand at every `MARKED`th strength from the first one on.
    """
    strength, size = line["strength"].to_numpy(), nanometres(line["a_disr"])
    beyond = is_extrapolated(line["a_disr"].to_numpy())
    inside = np.where(beyond, np.nan, size)
    axes.plot(strength, inside, markevery=(first, MARKED), **style | look)
    # with the first one inside, so that the two meet
    near = beyond | np.append(False, beyond[:-1]) | np.append(beyond[1:], False)
    axes.plot(strength, np.where(near, size, np.nan), color=style["color"], **look | BEYOND)
    if look is LINES["ours"]:
        some = slice(first, None, MARKED)
        end = nanometres(line["with_stronger"].clip(upper=2 * SIZES[1]))  # beyond the edge of the panel
        bars = np.array([0 * size, end - size])[:, some]
        axes.errorbar(strength[some], inside[some], bars, fmt="none", ecolor=style["color"], elinewidth=0.8, capsize=2)


def _legend(figure, style, wide):
    """One legend for all panels: types, then what the lines are."""
    entries = {kind: Line2D([], [], **look | LINES["ours"]) for kind, look in style.items()}
    entries["this work"] = Line2D([], [], color="black", **LINES["ours"])
    entries["up to the stronger drag"] = Line2D([], [], color="black", ls="none", marker="|", ms=9)
    entries["Table 3 as printed"] = Line2D([], [], color="black", **LINES["printed"])
    entries["extrapolated"] = Line2D([], [], color="black", lw=1.4, **BEYOND)
    figure.legend(
        entries.values(), entries.keys(), loc="outside lower center", handlelength=2.2, ncols=7 if wide else 2
    )
