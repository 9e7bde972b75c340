"""Tensile strength against filling factor: grains squeezed and pulled in a box, pulled by their ends, and turned."""

import numpy as np

from ratd.aggregates.strength import TENSILE_FACTOR, tensile_strength_tatsuuma2019
from ratd.experiments.spin_up.cells import TYPES, size_key
from ratd.experiments.spin_up.pulled import MARKS, beside_spin, usual
from ratd.experiments.spin_up.figures.style import type_style
from ratd.pictures.style import GREY, TWO_COLUMNS, bar_lengths, empty, logarithmic, new_figure, styled

PANELS = {"box": "squeezed, pulled in the box", "ends": "as grown, pulled by the ends", "spin": "as grown, turned"}
"""Panel -> its title."""
_STATED = rf"${TENSILE_FACTOR:g}\,\phi^{{1.8}}$"
_SUMMARY = {"ms": 5.5, "mfc": "white", "mew": 1.2, "capsize": 2.5, "elinewidth": 1.2, "ls": "none"}


@styled
def pulled(table, spun):
    """S <a>/gamma against phi in three panels, the same grains in each.

    Parameters
    ----------
    table : pandas.DataFrame
        Of `ratd.experiments.spin_up.pulled.read_pulled`.
    spun : pandas.DataFrame
        Of `ratd.experiments.spin_up.grain_table.spun_up_table`.

    Returns
    -------
    matplotlib.figure.Figure
        Points are grains; open markers with bars are geometric means of a type over all its grains, and the middle two
        thirds of these. For turned grains S is the tension at the loss of a quarter of the mass. The line is that of
        Tatsuuma et al. (2019).
    """
    own = beside_spin(usual(table), spun)
    figure = new_figure(TWO_COLUMNS, 0.42 * TWO_COLUMNS, f"tensile strength, {_grains(own)} grains")
    panels = figure.subplots(1, 3, sharex=True, sharey=True)
    shown = {name: _points(own, name) for name in PANELS}
    every = np.concatenate([phi for phi, _, _ in shown.values()])
    line = np.geomspace(0.85 * every.min(), 1.15 * every.max(), 20)
    for axes, (name, title) in zip(panels, PANELS.items(), strict=True):
        axes.set(title=title, xscale="log", yscale="log", xlabel=r"filling factor $\phi$")
        axes.plot(line, tensile_strength_tatsuuma2019(1.0, 1.0, line), color=GREY, label=f"{_STATED} (Tatsuuma et al.)")
        phi, strength, kind = shown[name]
        if not len(phi):
            empty(axes)
        for word in [word for word in TYPES if (kind == word).any()]:
            style = type_style([word])[word]
            here = kind == word
            axes.plot(phi[here], strength[here], ls="none", ms=2.5, alpha=0.6, mew=0.0, label=word, **style)
            _summary(axes, phi[here], strength[here], style)
    panels[0].set_ylabel(r"tensile strength $S\,\langle a\rangle/\gamma$")
    logarithmic(panels[0].xaxis)
    logarithmic(panels[0].yaxis)
    panels[0].errorbar([], [], [], label="mean, middle two thirds", color="black", marker="D", **_SUMMARY)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=5)
    return figure


def _grains(own):
    return len(own.assign(size=size_key(own["a_eff"]))[["material", "type", "size", "seed"]].drop_duplicates())


def _points(own, name):
    """phi, S <a>/gamma and type of the points of a panel."""
    if name == "spin":
        part = own[own["way"] == "ends"]
        phi, ratio = part["filling_factor"], part[f"spin_{MARKS['']}"]
    else:
        part = own[own["way"] == name]
        phi, ratio = part["phi"], part["ratio"]
    there = np.isfinite(ratio.to_numpy())
    strength = (ratio * tensile_strength_tatsuuma2019(1.0, 1.0, phi) / TENSILE_FACTOR).to_numpy()
    return phi.to_numpy()[there], strength[there], part["type"].to_numpy()[there]


def _summary(axes, phi, strength, style):
    """Geometric mean of a type at its mean phi as its marker, open, and the middle two thirds of its grains."""
    ratio = strength / phi**1.8
    x = np.exp(np.log(phi).mean())
    middle, low, high = (value * x**1.8 for value in (np.exp(np.log(ratio).mean()), *np.quantile(ratio, [0.16, 0.84])))
    bars = bar_lengths([middle], [low], [high])
    axes.errorbar(x, middle, bars, zorder=5, **style, **_SUMMARY)
