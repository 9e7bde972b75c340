"""Fig. 1: what the grains look like."""

from dataclasses import dataclass

import numpy as np
from matplotlib.colors import to_rgb

from ratd.aggregates.files import read_grains
from ratd.base.errors import InputError
from ratd.base.units import NM
from ratd.pictures.spheres import outline, render, scale_length, view_axes
from ratd.experiments.spin_up.figures.style import type_style
from ratd.pictures.style import MILLIMETRE, ONE_COLUMN, TWO_COLUMNS, nanometres, new_figure, styled

FORWARD, UP = np.array([0.35, 0.55, 1.0]), np.array([1.0, 0.0, 0.0])
"""Towards the viewer and upwards, along a_1, a_2, a_3: all three axes are seen, a_1 upright."""
NAMES = (r"$\hat{a}_1$", r"$\hat{a}_2$", r"$\hat{a}_3$")
PIXELS = 12
"""Of a picture, a millimetre in print."""

# all in mm in print
NARROWEST = 34.0
"""Least width of a column, which the numbers below a grain need."""
GAP = 3.0
"""Between columns, and between a grain and what stands above it."""
LEFT, HEAD, NUMBERS, FOOT = 6.0, 5.0, 7.5, 15.0
"""Room for the sizes, the names of the types, the numbers of a grain, and the scale bar with the axes."""
EDGE = 2.0
"""Around everything."""


@dataclass(frozen=True)
class _Seen:
    """A grain as it is seen: centres [m] in the coordinates of the picture, and their outline."""

    grain: object
    position: np.ndarray
    box: np.ndarray

    @property
    def size(self):
        """Width and height [nm]."""
        return nanometres([self.box[1] - self.box[0], self.box[3] - self.box[2]])


@styled
def figure1(grains):
    """Grains as shaded spheres, a column a type, a row a size, all on one scale (Fig. 1).

    Parameters
    ----------
    grains : sequence of ratd.Grain
        At most one of each type and size; a place without a grain stays empty.

    Returns
    -------
    matplotlib.figure.Figure
        Below each grain a_out, N_mon and N_con. All are seen from the same direction along their principal axes, which
        are drawn once.

    Raises
    ------
    InputError
        If there is no grain, or two of the same type and size.

    References
    ----------
    Reissl et al. (2024), A&A 692, A60, Fig. 1, where rows and columns are exchanged.
    """
    seen = {(grain.type, round(grain.a_eff / NM, 3)): _seen(grain) for grain in grains}
    if not seen or len(seen) < len(list(grains)):
        raise InputError("figure1: give at least one grain, and no two of the same type and size")
    types = list(dict.fromkeys(kind for kind, _ in seen))
    sizes = sorted({size for _, size in seen})
    width = (TWO_COLUMNS if len(types) > 2 else ONE_COLUMN) / MILLIMETRE - 2 * EDGE
    wide = [max(own.size[0] for (kind, _), own in seen.items() if kind == column) for column in types]
    high = [max(own.size[1] for (_, size), own in seen.items() if size == row) for row in sizes]
    scale = _scale(wide, width - LEFT - GAP * len(wide))
    widths = np.array([max(value / scale, NARROWEST) for value in wide])
    heights = np.array([value / scale + NUMBERS + GAP for value in high])
    height = heights.sum() + HEAD + FOOT
    materials = ", ".join(dict.fromkeys(grain.material.name for grain in grains))
    seeds = ", ".join(str(seed) for seed in dict.fromkeys(grain.seed for grain in grains))
    title = f"grains of {materials} as grown, seed {seeds}"
    figure = new_figure((width + 2 * EDGE) * MILLIMETRE, (height + 2 * EDGE + 5.0) * MILLIMETRE, title)
    axes = figure.subplots()
    axes.set_axis_off()
    middles = LEFT + np.cumsum(widths + GAP) - 0.5 * widths
    floors = height - HEAD - np.cumsum(heights) + NUMBERS
    colours = {kind: to_rgb(look["color"]) for kind, look in type_style(types).items()}
    for (kind, size), own in seen.items():
        _draw(axes, own, colours[kind], scale, middles[types.index(kind)], floors[sizes.index(size)])
    for kind, middle in zip(types, middles, strict=True):
        axes.text(middle, height - 0.5 * HEAD, kind, ha="center", va="center", color=colours[kind])
    for size, floor, value in zip(sizes, floors, high, strict=True):
        name = rf"$a_\mathrm{{eff}}$ = {size:g} nm"
        axes.text(0.4 * LEFT, floor + 0.5 * value / scale, name, rotation=90, ha="center", va="center")
    length = scale_length(0.25 * width * scale)
    right, bottom = LEFT + length / scale, 1.0
    axes.plot([LEFT, right], [bottom] * 2, color="black", lw=1.6, solid_capstyle="butt")
    axes.text(LEFT, bottom + 1.0, f"{length:g} nm, for all grains", va="bottom")
    _triad(axes, width - 16.0, 4.0)
    axes.set(xlim=(0, width), ylim=(0, height), aspect="equal")
    return figure


def _scale(wide, room):
    """nm in a mm with which columns of these widths [nm] fill the room [mm], none of them below `NARROWEST`."""
    fixed = 0
    for value in sorted(wide):
        rest = sum(sorted(wide)[fixed:])
        scale = rest / (room - fixed * NARROWEST)
        if fixed == len(wide) - 1 or value / scale >= NARROWEST:
            break
        fixed += 1
    return scale


def _seen(grain):
    """The grain with its centre of mass at the origin, as the camera sees it."""
    centre = np.average(grain.position, axis=0, weights=grain.mass)
    position = (grain.position - centre) @ (view_axes(FORWARD, UP) @ grain.shape.axes).T
    return _Seen(grain, position, outline(position, grain.radius))


def _draw(axes, seen, colour, scale, middle, floor):
    """One grain that stands on a floor [mm], and its numbers below it."""
    grain, (left, right, bottom, top) = seen.grain, seen.box
    half = 0.505 * max(right - left, top - bottom)
    centre = np.array([left + right, bottom + top, 0.0]) / 2
    pixels = max(60, round(2 * nanometres(half) / scale * PIXELS))
    picture = render(seen.position - centre, grain.radius, np.tile(colour, (grain.n_monomers, 1)), half, pixels)
    reach, y = nanometres(half) / scale, floor + 0.5 * seen.size[1] / scale
    axes.imshow(picture, extent=(middle - reach, middle + reach, y - reach, y + reach), interpolation="antialiased")
    text = (
        rf"$a_\mathrm{{out}}$ = {nanometres(grain.enclosing_radius):.0f} nm"
        "\n"
        rf"$N_\mathrm{{mon}}$ = {grain.n_monomers}, $N_\mathrm{{con}}$ = {grain.n_contacts}"
    )
    axes.text(middle, floor - 0.7, text, ha="center", va="top", linespacing=1.1)


def _triad(axes, x, y, length=8.0):
    """The principal axes as they lie in every picture, at a place [mm]."""
    ends = length * view_axes(FORWARD, UP)[:2].T
    arrow = {"arrowstyle": "-|>", "color": "black", "lw": 0.7, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 6}
    for name, end in zip(NAMES, ends, strict=True):
        place = np.array([x, y]) + end
        axes.annotate("", place, (x, y), arrowprops=arrow)
        axes.text(*(place + 2.2 * end / np.hypot(*end)), name, ha="center", va="center")


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    grains = [grain for path in files["grains"] for grain in read_grains(path)]
    return figure1([grain for grain in grains if grain.seed == settings["seed"]])
