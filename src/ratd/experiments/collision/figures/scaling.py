"""Beyond the paper: the fragmentation velocity of clusters beside the sticking velocity of two of their spheres."""

import numpy as np
from matplotlib.lines import Line2D

from ratd.experiments.collision.figures.look import colour_of, radius_label
from ratd.experiments.collision.thresholds import head_on, is_close
from ratd.pictures.style import ONE_COLUMN, empty, logarithmic, new_figure, styled
from ratd.pipeline import io

RATIO = 35.0
"""v_frag/v_stick that the printed velocities have at A = 0.5 ns (34 to 36)."""
FACES = {"velocity": None, "spring": "white"}
LARGE = 6.5
"""Size of the markers of another surface energy."""
MARKS = {0.5e-9: "o", 1.0e-9: "s", 1.5e-9: "^"}


@styled
def scaling(thresholds):
    """v_frag against v_stick: a colour a radius, a marker a damping time, open with springs.

    Large markers have another surface energy.

    Parameters
    ----------
    thresholds : pandas.DataFrame
        `ratd.experiments.collision.tables.THRESHOLDS`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    own = head_on(thresholds)
    own = own[own["sticking_velocity"].notna() & is_close(own) & own["friction"].isin(FACES)]
    figure = new_figure(ONE_COLUMN, 1.25 * ONE_COLUMN, "Clusters and pairs of their spheres")
    axes = figure.subplots()
    if not len(own):
        empty(axes, "no fragmentation velocities")
        return figure
    for _, row in own.iterrows():
        colour = colour_of(row["radius"])
        other = abs(row["surface_energy"] - 0.025) > 1e-6
        # what lies below a large marker is seen through it
        face = FACES[row["friction"]] or (*colour[:3], 0.3 if other else 1.0)
        marker = next((mark for time, mark in MARKS.items() if np.isclose(time, row["damping_time"], atol=0.0)), "D")
        axes.errorbar(
            row["sticking_velocity"], row["velocity"], row["error"], marker=marker, color=colour, mfc=face, capsize=1.5,
            ms=LARGE if other else 4.0, zorder=2 if other else 3, ls="none",
        )  # fmt: skip
    line = np.array([own["sticking_velocity"].min() / 1.5, own["sticking_velocity"].max() * 1.5])
    axes.plot(line, RATIO * line, color="black", lw=0.8, ls=(0, (4, 2)))
    axes.set(xscale="log", yscale="log")
    # the dashed line goes on beyond the points
    axes.set_ylim(0.8 * own["velocity"].min(), 1.8 * own["velocity"].max())
    logarithmic(axes.xaxis)
    logarithmic(axes.yaxis)
    axes.set(xlabel="sticking velocity of two spheres [m s$^{-1}$]", ylabel="fragmentation velocity [m s$^{-1}$]")
    handles = [
        Line2D([], [], ls="none", marker="o", color=colour_of(radius), label=radius_label(radius))
        for radius in sorted(own["radius"].unique())
    ]
    handles += [
        Line2D([], [], ls="none", marker=marker, color="black", label=f"A = {time * 1e9:g} ns")
        for time, marker in MARKS.items()
        if np.isclose(own["damping_time"], time, atol=0.0).any()
    ]
    handles += [
        Line2D([], [], ls="none", marker="o", color="black", mfc="white", label="springs"),
        Line2D([], [], ls="none", marker="o", color="black", ms=LARGE, label="other $\\gamma$"),
        Line2D([], [], color="black", lw=0.8, ls=(0, (4, 2)), label=f"{RATIO:g} times"),
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=3)
    return figure


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return scaling(io.read(files["thresholds"], "collision_thresholds").to_dataframe())
