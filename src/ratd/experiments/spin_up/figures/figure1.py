"""Fig. 1: what the grains look like."""

import numpy as np
from matplotlib.colors import to_rgb

from ratd.aggregates.files import read_grains
from ratd.base.errors import InputError
from ratd.base.units import NM
from ratd.pictures.spheres import render, show, view_axes
from ratd.pictures.style import TWO_COLUMNS, nanometres, new_figure, styled, type_style

FORWARD, UP = np.array([0.35, 0.55, 1.0]), np.array([1.0, 0.0, 0.0])
"""Towards the viewer and upwards, along a_1, a_2, a_3: all three axes are seen, a_1 nearly upright."""
MARGIN = 1.25
"""Half width of a picture in enclosing radii, with room for the names of the axes."""
NAMES = (r"$\hat{a}_1$", r"$\hat{a}_2$", r"$\hat{a}_3$")


@styled
def figure1(grains):
    """Grains as shaded spheres with their principal axes, a row a type, a column a size (Fig. 1).

    Parameters
    ----------
    grains : sequence of ratd.Grain
        At most one of each type and size; a place without a grain stays empty.

    Returns
    -------
    matplotlib.figure.Figure
        Below each grain a_out, N_mon and N_con. Each picture has its own scale.

    Raises
    ------
    InputError
        If there is no grain, or two of the same type and size.

    References
    ----------
    Reissl et al. (2024), A&A 692, A60, Fig. 1.
    """
    places = {(grain.type, round(grain.a_eff / NM, 3)): grain for grain in grains}
    if not places or len(places) < len(list(grains)):
        raise InputError("figure1: give at least one grain, and no two of the same type and size")
    types = list(dict.fromkeys(kind for kind, _ in places))
    sizes = sorted({size for _, size in places})
    materials = ", ".join(dict.fromkeys(grain.material.name for grain in grains))
    seeds = ", ".join(str(seed) for seed in dict.fromkeys(grain.seed for grain in grains))
    width = TWO_COLUMNS * max(len(sizes), 2) / 3
    title = f"grains of {materials} as grown, seed {seeds}"
    figure = new_figure(width, (0.375 * len(types) + 0.03) * width / max(len(sizes), 2) * 3, title)
    panels = figure.subplots(len(types), len(sizes), squeeze=False)
    colours = {kind: look["color"] for kind, look in type_style(types).items()}
    for (i, kind), (j, size) in ((row, column) for row in enumerate(types) for column in enumerate(sizes)):
        axes = panels[i, j]
        axes.set_axis_off()
        if (kind, size) in places:
            _draw(axes, places[kind, size], to_rgb(colours[kind]))
            axes.set_title(rf"{kind}, $a_\mathrm{{eff}}$ = {size:g} nm")
    return figure


def _draw(axes, grain, colour):
    """One grain, its axes and its numbers."""
    centre = np.average(grain.position, axis=0, weights=grain.mass)
    camera = view_axes(FORWARD, UP)
    picture_axes = camera @ grain.shape.axes  # the camera is given along the principal axes
    position = (grain.position - centre) @ picture_axes.T
    half_width = MARGIN * max(grain.enclosing_radius, np.max(np.linalg.norm(position, axis=1) + grain.radius) / 1.1)
    picture = render(position, grain.radius, np.tile(colour, (grain.n_monomers, 1)), half_width)
    show(axes, picture, half_width)
    # Behind the picture, so that only what stands out of the grain is seen.
    for name, (x, y, _) in zip(NAMES, camera.T, strict=True):
        end = nanometres(0.84 * half_width) * np.array([x, y]) / np.hypot(x, y)  # directions, all of one length
        arrow = {"arrowstyle": "-|>", "color": "black", "lw": 0.7, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 6}
        axes.annotate("", end, (0, 0), arrowprops=arrow, zorder=1)
        axes.text(*(1.1 * end), name, ha="center", va="center", zorder=3)
    text = (
        rf"$a_\mathrm{{out}}$ = {nanometres(grain.enclosing_radius):.1f} nm, "
        rf"$N_\mathrm{{mon}}$ = {grain.n_monomers}, $N_\mathrm{{con}}$ = {grain.n_contacts}"
    )
    axes.text(0.5, -0.02, text, transform=axes.transAxes, ha="center", va="top")


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    grains = [grain for path in files["grains"] for grain in read_grains(path)]
    return figure1([grain for grain in grains if grain.seed == settings["seed"]])
