"""A page for the browser: a cluster in its periodic box, turned with the mouse and stepped through."""

from html import escape
from pathlib import Path
from string import Template

import k3d
import numpy as np
from matplotlib import colormaps
from matplotlib.colors import to_hex, to_rgb

from ratd.base.units import NM
from ratd.geometry.neighbours import close_pairs
from ratd.pictures.snapshots import LARGEST, OTHERS
from ratd.pictures.stepper import finished_page, scene, series, spheres

__all__ = ["box_page"]

NUMBERS = colormaps["viridis"]
MOST = 6
"""Contacts of a monomer from which on all have one colour."""
FINENESS = 16
TEMPLATE = Path(__file__).with_name("box_page.html")
SCRIPT = Path(__file__).with_name("box_page.js")
CORNERS = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
EDGES = np.array(
    [[i, j] for i in range(8) for j in range(i + 1, 8) if np.sum(CORNERS[i] != CORNERS[j]) == 1], dtype=np.uint32
)

HINT = "The box goes on in all directions with copies of itself."


def box_page(phi, box_length, position, radius, title):
    """Page with a cluster that is squeezed by its own copies, turned with the mouse and stepped through.

    Parameters
    ----------
    phi : (k,) array
        Filling factors of the snapshots.
    box_length : (k,) array
        Edges of the box [m].
    position : (k, n, 3) array
        Centres [m]; copies that lie in the box are drawn.
    radius : (n,) array
        Radii [m].
    title : str

    Returns
    -------
    str
        HTML, the same for the same input.
    """
    length = np.asarray(box_length, dtype=float)
    inside = position - length[:, None, None] * np.round(position / length[:, None, None])
    touching = [_contacts(place, radius, edge) for place, edge in zip(inside, length, strict=True)]
    steps = {
        "phi": np.asarray(phi, dtype=float).tolist(),
        "length": length.tolist(),
        "contacts": [float(number.mean()) for number in touching],
    }
    middle = np.tile(to_rgb(LARGEST), (len(radius), 1))
    colours = {
        "contacts": [NUMBERS(np.minimum(number, MOST) / MOST)[:, :3] for number in touching],
        "cluster": [middle] * len(length),
    }
    plot = scene(0.9 * length[0] / NM)
    plot += spheres(list(inside), [radius] * len(length), steps, colours, fineness=FINENESS)
    corners = series(np.float32(edge / NM * CORNERS) for edge in length)
    plot += k3d.lines(corners, EDGES, indices_type="segment", color=int(OTHERS[0].lstrip("#"), 16), shader="simple")
    for number, drawn in enumerate(plot.objects, start=1):
        drawn.id = number  # addresses in memory differ from run to run
    panel = Template(TEMPLATE.read_text(encoding="utf-8")).substitute(
        title=escape(title),
        numbers=", ".join(to_hex(NUMBERS(part)) for part in np.linspace(0, 1, 17)),
        most=MOST,
        colour=LARGEST,
    )
    return finished_page(plot, panel, title, SCRIPT.read_text(encoding="utf-8"), HINT)


def _contacts(place, radius, edge):
    """Touching neighbours of each monomer, copies counted."""
    own = np.arange(len(radius))
    number = np.zeros(len(radius), dtype=int)
    shifts = [np.array([x, y, z]) for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1)]
    places = np.concatenate([place + edge * shift for shift in shifts])
    near = np.all(np.abs(places) < 0.5 * edge + 2 * radius.max(), axis=1)
    pairs = close_pairs(np.ascontiguousarray(places[near]), np.tile(radius, len(shifts))[near], 0.0)
    which = np.flatnonzero(near)
    home = len(own) * next(k for k, shift in enumerate(shifts) if not shift.any())
    for end in (0, 1):
        at = which[pairs[:, end]] - home
        np.add.at(number, at[(at >= 0) & (at < len(own))], 1)
    return number
