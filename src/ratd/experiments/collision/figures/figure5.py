"""Fig. 5: X and N_s of clusters of equal spheres against the velocity."""

import numpy as np

from ratd.experiments.collision.figures.look import (
    collisions_of,
    colour_of,
    law_text,
    marker_of,
    plot_means,
    radius_label,
    sticking_line,
    velocity_axis,
)
from ratd.experiments.collision.fragmentation import STICKING
from ratd.experiments.collision.printed import PRINTED_THRESHOLDS
from ratd.experiments.collision.likeness import of_equal_spheres
from ratd.pictures.style import TWO_COLUMNS, empty, new_figure, styled


@styled
def figure5(table, law):
    """X and N_s against velocity, a curve a radius, central collisions of one law.

    Parameters
    ----------
    table : pandas.DataFrame
        `ratd.experiments.collision.tables.COLUMNS`.
    law : str
        Name of the law in the config.

    Returns
    -------
    matplotlib.figure.Figure
        Large open markers on the line X = 0.15: where the paper prints the fragmentation velocity of a radius.
    """
    shown = of_equal_spheres(table[(table["law"] == law) & (table["impact_parameter"] == 0)])
    figure = new_figure(TWO_COLUMNS, 0.42 * TWO_COLUMNS, f"Clusters of equal spheres, {law_text(law)}")
    left, right = figure.subplots(1, 2)
    if not len(shown):
        empty(left, "no collisions of equal spheres")
        return figure
    radii = np.sort(shown["largest_radius"].unique())
    for radius in radii:
        part = shown[shown["largest_radius"] == radius]
        look = {"color": colour_of(radius), "marker": marker_of(radius), "lw": 0.9}
        for axes, quantity in ((left, "X"), (right, "N_s")):
            plot_means(axes, part, quantity, radius_label(radius), **look)
        for known, velocity in PRINTED_THRESHOLDS.items():
            if abs(known / radius - 1) < 1e-6:
                printed = {"marker": look["marker"], "color": look["color"], "label": ""}
                left.plot(velocity, STICKING, ms=8, mfc="none", mew=1.2, ls="none", zorder=4, **printed)
    (mark,) = left.plot([], [], marker="o", ms=8, mfc="none", mew=1.2, color="black", ls="none")
    line = sticking_line(left, STICKING)
    left.legend([mark, line], [r"$v_\mathrm{frag}$ printed", line.get_label()], loc="upper right")
    for axes, name in ((left, "agglomeration $X$"), (right, "fragmentation $N_\\mathrm{s}$")):
        velocity_axis(axes, shown)
        axes.set(ylabel=name, ylim=(-0.03, 1.03))
    figure.legend(*right.get_legend_handles_labels(), loc="outside lower center", ncols=len(radii))
    return figure


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return figure5(collisions_of(files), settings["law"])
