"""Figs. 3 and 4: a collision in six pictures, spheres coloured by their radius, equal ones by their cluster."""

import numpy as np
from matplotlib import colormaps
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm, to_rgb

from ratd.base.errors import InputError
from ratd.experiments.collision.figures.look import cluster_text, law_text
from ratd.experiments.collision.files import with_snapshots
from ratd.pictures.snapshots import LARGEST, OTHERS
from ratd.pictures.spheres import render, scale_length, view_axes
from ratd.pictures.style import TWO_COLUMNS, new_figure, styled
from ratd.pipeline import io
from ratd.pipeline.blocks import rows

CAMERA = view_axes((0, -1, 0), (0, 0, 1))
"""Seen from the side, the clusters coming from left and right."""
PART_SHOWN = 0.998
"""Part of the spheres that each picture shows at least."""
PIXELS = 420
SIZES = colormaps["viridis"]
PANELS = 6


def positions(row):
    """Times (k,) [s], positions (k, n, 3) [m] and pieces (k, n) of a row with snapshots."""
    if not row.sizes.get("monomer", 0):
        raise InputError("figure: the collision has no snapshots; name it in collision.snapshots.runs of the config")
    row = with_snapshots(row)
    return row["snapshot_time"].values, row["snapshot_position"].values, row["snapshot_piece"].values


def origin_of(piece):
    """The cluster that each sphere came with, 0 or 1, (n,) int64: before they meet each of the two is one piece.

    Parameters
    ----------
    piece : (k, n) int array
        Of `positions`.
    """
    return (piece[0] != piece[0, 0]).astype(np.int64)


def of_one_radius(radius):
    """Whether all spheres have one radius, which colours then need not tell."""
    return radius.max() <= 1.01 * radius.min()


def colours_of(radius, piece):
    """Colours of the spheres, (n, 3): by the radius, those of equal ones by the cluster that they came with."""
    if of_one_radius(radius):
        return np.array([to_rgb(LARGEST), to_rgb(OTHERS[0])])[origin_of(piece)]
    return SIZES(size_scale(radius)(radius))[:, :3]


def size_scale(radius):
    """Scale of the colours of radii [m], matplotlib.colors.LogNorm."""
    return LogNorm(radius.min(), radius.max())


@styled
def picture(row, spacing):
    """A collision in pictures.

    Parameters
    ----------
    row : xarray.Dataset
        Of a file of collisions, with snapshots.
    spacing : float
        Time between two pictures [s]; the nearest snapshots are shown.

    Returns
    -------
    matplotlib.figure.Figure
    """
    time, place, piece = positions(row)
    radius = row["radius"].values
    # of few snapshots each once
    wanted = list(dict.fromkeys(int(np.argmin(np.abs(time - spacing * k))) for k in range(PANELS)))
    what = cluster_text(row["cluster"].item()), law_text(row["law"].item())
    title = f"{what[0]} at {row['velocity'].item():g} m s$^{{-1}}$, {what[1]}, rotation {row['seed'].item()}"
    figure = new_figure(TWO_COLUMNS, 0.62 * TWO_COLUMNS, title)
    panels = figure.subplots(2, PANELS // 2)
    colours = colours_of(radius, piece)
    # nearly all spheres of all pictures: what flies off fast is not waited for
    reach = np.max(np.abs(place[wanted] @ CAMERA.T)[..., :2] + radius[:, None], axis=-1)
    half_width = 1.06 * max(np.quantile(one, PART_SHOWN) for one in (reach[0], *reach))
    for axes in panels.ravel()[len(wanted) :]:
        axes.set_axis_off()
    for axes, k in zip(panels.ravel(), wanted, strict=False):
        at = place[k] @ CAMERA.T
        view = render(at, radius, colours, half_width, PIXELS)
        edge = half_width * 1e6
        axes.imshow(view, extent=(-edge, edge, -edge, edge), interpolation="antialiased")
        axes.set(xlim=(-edge, edge), ylim=(-edge, edge), aspect="equal")
        axes.set_axis_off()
        axes.set_title(f"{time[k] * 1e6:.2f} µs", pad=2)
        length = scale_length(0.5 * edge)
        axes.plot([0.95 * edge - length, 0.95 * edge], [-0.95 * edge] * 2, color="black", lw=1.6)
        axes.text(0.95 * edge - 0.5 * length, -0.9 * edge, f"{length:g} µm", ha="center", va="bottom")
    if not of_one_radius(radius):
        _size_bar(figure, panels, size_scale(radius))
    return figure


def _size_bar(figure, panels, scale):
    """What the colours of radii mean."""
    bar = ScalarMappable(LogNorm(scale.vmin * 1e6, scale.vmax * 1e6), SIZES)
    bar = figure.colorbar(bar, ax=panels, location="right", shrink=0.8, aspect=30, pad=0.01)
    bar.set_label("radius of the sphere [µm]")
    ticks = [tick for tick in (0.05, 0.1, 0.2, 0.5, 1.0, 2.0) if scale.vmin * 1e6 <= tick <= scale.vmax * 1e6]
    bar.set_ticks(ticks, labels=[f"{tick:g}" for tick in ticks], minor=False)
    bar.minorticks_off()


def row_of(paths, seed):
    """Row of a rotation in files of collisions."""
    for path in paths:
        for row in rows(io.read(path, "collisions"), "collisions"):
            if row["seed"].item() == seed and row.sizes.get("monomer", 0):
                return row
    raise InputError(
        f"figure: no collision with snapshots has the rotation {seed}; see collision.snapshots.runs of the config"
    )


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return picture(row_of(files["runs"], settings["rotation"]), settings["spacing"])
