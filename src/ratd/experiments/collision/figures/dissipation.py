"""Beyond the paper: where the energy of the impact goes."""

import numpy as np

from ratd.experiments.collision.figures.look import (
    cluster_text,
    collisions_of,
    label_of,
    law_text,
    velocity_axis,
)
from ratd.experiments.collision.fragmentation import means
from ratd.experiments.collision.likeness import is_equal
from ratd.pictures.style import ENERGY_COLOURS, TWO_COLUMNS, empty, new_figure, styled

WAYS = {
    "by_damping": ("normal damping", ENERGY_COLOURS["damping"], "o"),
    "by_sliding": ("sliding", ENERGY_COLOURS["sliding"], "s"),
    "by_twisting": ("twisting", ENERGY_COLOURS["twisting"], "^"),
    "by_rolling": ("rolling", ENERGY_COLOURS["rolling"], "v"),
    "energy_end": ("still moving", "black", "D"),
}
"""Column -> label, colour, marker."""


@styled
def dissipation(table, law, clusters):
    """Part of E_0 that each way takes, against velocity, a panel a cluster.

    Parameters
    ----------
    table : pandas.DataFrame
        `ratd.experiments.collision.tables.COLUMNS`.
    law : str
    clusters : list of str
        Names in the config.

    Returns
    -------
    matplotlib.figure.Figure
    """
    table = table[(table["law"] == law) & (table["impact_parameter"] == 0)]
    figure = new_figure(TWO_COLUMNS, 0.42 * TWO_COLUMNS, f"Where the energy of the impact goes, {law_text(law)}")
    panels = figure.subplots(1, len(clusters), sharey=True, squeeze=False)[0]
    for axes, name in zip(panels, clusters, strict=True):
        own = table[table["cluster"] == name]
        axes.set_title(label_of(own) if len(own) else cluster_text(name), pad=2)
        if not len(own):
            empty(axes, "no collisions")
            continue
        for column, (label, colour, marker) in WAYS.items():
            x, y, error = means(own, column)
            axes.errorbar(x, y, error, color=colour, marker=marker, capsize=1.5, elinewidth=0.7, label=label)
        velocity_axis(axes, own)
        axes.set_ylim(-0.02, 1.02)
    panels[0].set_ylabel("part of $E_0$")
    panels[0].legend(loc="upper right")
    return figure


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    table = collisions_of(files)
    equal = table[is_equal(table) & (table["law"] == settings["law"])]
    largest = equal["cluster"].iloc[int(np.argmax(equal["largest_radius"]))] if len(equal) else settings["twin"]
    return dissipation(table, settings["law"], list(dict.fromkeys([largest, settings["twin"], settings["mrn"]])))
