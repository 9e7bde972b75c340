"""A page for the browser: two clusters that collide, turned with the mouse and stepped through."""

from html import escape
from pathlib import Path
from string import Template

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import LogNorm, to_hex, to_rgb

from ratd.base.units import NM
from ratd.pictures.snapshots import LARGEST, OTHERS, fragment_colours
from ratd.pictures.stepper import finished_page, scene, spheres
from ratd.pictures.style import GREY

__all__ = ["collision_page"]

SIZES = colormaps["viridis"]
VIEW = np.array([0.15, -0.95, 0.28])
"""Direction towards the viewer at the start: from the side."""
TEMPLATE = Path(__file__).with_name("collision_page.html")
SCRIPT = Path(__file__).with_name("collision_page.js")

SHORT = "The clusters come in along x, from left and right."
HINT = f"{SHORT} X: what the heaviest piece has more than the second; N<sub>s</sub>: what is in neither; of all mass."


def collision_page(time, position, radius, piece, origin, title):
    """Page with a collision that is turned with the mouse and steps through its snapshots.

    Parameters
    ----------
    time : (k,) array
        [s]
    position : (k, n, 3) array
        Centres [m].
    radius : (n,) array
        Radii [m].
    piece : (k, n) int array
        Number of the piece of each sphere, 0 the heaviest.
    origin : (n,) int array
        0 or 1, the cluster that it came with.
    title : str

    Returns
    -------
    str
        HTML, the same for the same input.
    """
    mass = radius**3 / np.sum(radius**3)
    scale = LogNorm(radius.min(), max(radius.max(), 1.5 * radius.min()))
    by_size = SIZES(scale(radius))[:, :3]
    by_origin = np.array([to_rgb(LARGEST), to_rgb(OTHERS[0])])[origin]
    shares = [np.sort(np.bincount(own, mass))[::-1] for own in piece]
    steps = {
        "time": np.asarray(time, dtype=float).tolist(),
        "pieces": [len(own) for own in shares],
        "first": [float(own[0]) for own in shares],
        "second": [float(own[1]) if len(own) > 1 else 0.0 for own in shares],
    }
    colours = {
        "size": [by_size] * len(time),
        "piece": [_piece_colours(own) for own in piece],
        "origin": [by_origin] * len(time),
    }
    half_width = np.max(np.linalg.norm(position[0], axis=1) + radius) / NM
    plot = scene(half_width, VIEW)
    plot += spheres(list(position), [radius] * len(time), steps, colours, fineness=1)
    panel = Template(TEMPLATE.read_text(encoding="utf-8")).substitute(
        title=escape(title),
        sizes=", ".join(to_hex(SIZES(part)) for part in np.linspace(0, 1, 17)),
        smallest=f"{radius.min() * 1e6:.3g}",
        largest=f"{radius.max() * 1e6:.3g}",
        first=LARGEST,
        one=LARGEST,
        other=OTHERS[0],
    )
    return finished_page(plot, panel, title, SCRIPT.read_text(encoding="utf-8"), HINT, SHORT)


def _piece_colours(piece):
    """Colours (n, 3) of spheres by the number of their piece, single ones grey."""
    colours = fragment_colours(piece)
    single = np.bincount(piece)[piece] == 1
    colours[single] = to_rgb(GREY)
    return colours
