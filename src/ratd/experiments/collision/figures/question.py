"""Beyond the paper: what of an MRN cluster decides, by clusters that differ from it in one thing."""

import numpy as np

from ratd.experiments.collision.figures.look import CLUSTERS, collisions_of, law_text
from ratd.experiments.collision.fragmentation import STICKING, means
from ratd.pictures.style import GREY, HIGHLIGHT, TWO_COLUMNS, new_figure, styled

LOOKS = {"velocity": ("#0072B2", "o"), "spring": ("#D55E00", "s")}
QUANTITIES = {"X": "$X$", "N_s": "$N_\\mathrm{s}$", "N_s_rest": "$N_\\mathrm{s}$ of the rest"}


@styled
def question(table, velocities):
    """X and N_s of clusters that differ in one thing, at some velocities, with both frictions.

    Parameters
    ----------
    table : pandas.DataFrame
        `ratd.experiments.collision.tables.COLUMNS`.
    velocities : list of float
        A row of panels each [m/s].

    Returns
    -------
    matplotlib.figure.Figure
        Open markers are single collisions, filled ones means with a bar of one standard error. Short upright
        lines, one a sample, are what N_s cannot exceed.
    """
    table = table[(table["impact_parameter"] == 0) & table["law"].isin(LOOKS)]
    names = [name for name in CLUSTERS if (table["cluster"] == name).any()]
    height = (0.13 + 0.045 * len(names)) * len(velocities)
    figure = new_figure(TWO_COLUMNS, height * TWO_COLUMNS, "What of an MRN cluster decides")
    panels = figure.subplots(len(velocities), len(QUANTITIES), sharey=True, sharex=True, squeeze=False)
    for row, velocity in zip(panels, velocities, strict=True):
        here = table[np.isclose(table["velocity"], velocity)]
        for axes, (quantity, text) in zip(row, QUANTITIES.items(), strict=True):
            for k, (law, (colour, marker)) in enumerate(LOOKS.items()):
                for place, name in enumerate(names):
                    own = here[(here["law"] == law) & (here["cluster"] == name)]
                    if not len(own):
                        continue
                    height = place + 0.14 - 0.28 * k
                    level = np.full(len(own), height)
                    axes.plot(own[quantity], level, ls="none", marker=marker, mfc="none", mec=colour, ms=3, mew=0.5)
                    _, mean, error = means(own, quantity)
                    if len(own) > 1:
                        axes.errorbar(mean, height, xerr=error, color=colour, marker=marker, ms=4.5, capsize=1.5)
                    if quantity == "N_s" and k == 0:
                        for share in own["largest_share"].unique():
                            axes.plot([1 - share] * 2, [place - 0.35, place + 0.35], color=HIGHLIGHT, lw=1.4, zorder=0)
            if quantity == "X":
                axes.axvline(STICKING, color=GREY, lw=0.7, ls=(0, (4, 2)), zorder=0)
            axes.set(xlim=(-0.04, 1.04), ylim=(-0.6, len(names) - 0.4))
            axes.set_title(f"{text} at {velocity:g} m s$^{{-1}}$", pad=2)
        row[0].set_yticks(range(len(names)), [CLUSTERS[name] for name in names])
    for axes in panels[-1]:
        axes.set_xlabel("part of the mass")
    handles = [
        axes.plot([], [], color=colour, marker=marker, ls="none", label=law_text(law))[0]
        for law, (colour, marker) in LOOKS.items()
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=2)
    return figure


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return question(collisions_of(files), settings["velocities"])
