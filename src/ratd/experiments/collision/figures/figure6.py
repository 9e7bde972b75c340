"""Fig. 6: X and N_s of MRN clusters against the velocity, beside the equal spheres that the paper likens them to."""

import numpy as np
import pandas as pd

from ratd.experiments.collision.figures.look import (
    MRN_STYLE,
    SMALLER,
    cluster_text,
    collisions_of,
    colour_of,
    law_text,
    marker,
    marker_of,
    plot_means,
    radius_label,
    sticking_line,
    velocity_axis,
)
from ratd.experiments.collision.fragmentation import STICKING
from ratd.experiments.collision.printed import PRINTED_RADII
from ratd.experiments.collision.likeness import of_equal_spheres
from ratd.pictures.style import HIGHLIGHT, TWO_COLUMNS, empty, new_figure, styled

CUT = MRN_STYLE | {"color": "#b3004b", "ls": "--", "mfc": "white"}
"""How the cluster without its smallest spheres looks."""
SINGLE = {"ls": "none", "mec": "black", "mfc": "white", "mew": 0.5, "ms": 3, "zorder": 3}
"""How a single collision looks, in the marker of its sample."""
ASIDE = 0.35
"""By so much [m/s] the samples are drawn aside of each other."""
BESIDE = (*SMALLER, *(PRINTED_RADII[quantity][0] for quantity in ("energy_half", "N_s", "X")))
"""Radii [m] of the equal spheres: two smaller than those of the paper, and the three that it likens MRN to."""


@styled
def figure6(table, law, mrn, cut=None):
    """X and N_s of an MRN cluster, a mark a collision, and means of equal spheres of the radii that it is likened to.

    Parameters
    ----------
    table : pandas.DataFrame
        `ratd.experiments.collision.tables.COLUMNS`.
    law, mrn : str
        Names of the law and of the MRN cluster in the config.
    cut : str, optional
        Name of the same cluster without its smallest spheres.

    Returns
    -------
    matplotlib.figure.Figure
        The level lines, one a sample, are what N_s of the MRN cluster cannot exceed: one less the largest spheres'
        part of the mass.
    """
    table = table[(table["law"] == law) & (table["impact_parameter"] == 0)]
    own, without, equal = table[table["cluster"] == mrn], table[table["cluster"] == cut], of_equal_spheres(table)
    figure = new_figure(TWO_COLUMNS, 0.42 * TWO_COLUMNS, f"MRN clusters, {law_text(law)}")
    left, right = figure.subplots(1, 2)
    if not len(own):
        empty(left, "no collisions of MRN clusters")
        return figure
    for axes, quantity in ((left, "X"), (right, "N_s")):
        for radius in BESIDE:
            part = equal[np.isclose(equal["largest_radius"], radius)]
            if len(part):
                look = {"color": colour_of(radius), "marker": marker_of(radius), "lw": 0.9}
                plot_means(axes, part, quantity, radius_label(radius), **look)
        for k, (sample, part) in enumerate(own.groupby("sample")):
            place = part["velocity"] + ASIDE * (k - 1)
            axes.plot(place, part[quantity], **SINGLE, marker=marker(k), label=f"sample {sample:g}")
        plot_means(axes, own, quantity, cluster_text(mrn), **MRN_STYLE, zorder=5)
        if len(without):
            plot_means(axes, without, quantity, cluster_text(cut), **CUT, zorder=4)
        velocity_axis(axes, pd.concat([own, without]))
        axes.set_ylim(-0.03, 1.03)
    sticking_line(left, STICKING)
    shares = own.groupby("sample")["largest_share"].first()
    for k, share in enumerate(shares):
        right.axhline(1 - share, color=HIGHLIGHT, lw=1.2, zorder=0)
        right.plot(0.5, 1 - share, marker=marker(k), **SINGLE)
    right.text(1.5, 1 - shares.min() + 0.01, "all but the largest spheres", color="#8a5a00", va="bottom")
    left.set_ylabel("agglomeration $X$")
    right.set_ylabel("fragmentation $N_\\mathrm{s}$")
    figure.legend(*left.get_legend_handles_labels(), loc="outside lower center", ncols=5)
    return figure


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return figure6(collisions_of(files), settings["law"], settings["mrn"], settings.get("cut"))
