"""A page for the browser in which spheres are turned with the mouse and step through the snapshots of a run.

k3d draws it and brings its own script, so a page holds all that it needs and loads nothing when it is opened. What is
told beside the spheres, and the choice of colours, is the page's own: `ratd.pictures.grain_page` is one.
"""

import re
from html import escape
from pathlib import Path
from string import Template

import k3d
import numpy as np

from ratd.base.units import NM

__all__ = ["OPENING", "SPHERES", "finished_page", "packed", "scene", "series", "spheres"]

FINENESS = 128
"""Positions are rounded to 1 nm over this power of two, which leaves bits that compress well."""
VIEW = np.array([0.75, -0.55, 0.37])
"""Direction from the origin towards the viewer at the start; z points upwards."""
OPENING = 30.0
"""Angle of view of the camera from the lower to the upper edge [degrees]."""
SPHERES = 1
"""Number of the spheres in the scene; k3d would take addresses in memory, which differ from run to run."""
SCRIPT = Path(__file__).with_name("stepper.js")
CONTROLS = Path(__file__).with_name("stepper.html")
STYLE = Path(__file__).with_name("stepper.css")


def scene(half_width, view=VIEW):
    """Empty scene without k3d's own controls, seen so that `half_width` [nm] about the origin fits in."""
    distance = 1.05 * half_width / np.sin(np.radians(OPENING / 2))
    place = distance * view / np.linalg.norm(view)
    return k3d.plot(
        camera=[*place.tolist(), 0, 0, 0, 0, 0, 1],
        camera_auto_fit=False,
        camera_fov=OPENING,
        grid_visible=False,
        axes_helper=0,
        menu_visibility=False,
        time_interpolation=False,
    )


def spheres(positions, radii, steps, colours, fineness=FINENESS):
    """Spheres at all steps, with all ways to colour them, which the script of the page chooses from.

    Parameters
    ----------
    positions : list of (n, 3) array
        One a step [m].
    radii : list of (n,) array
        [m]
    steps : dict of str to list
        What the page tells, for each step.
    colours : dict of str to list of (n, 3) array
        Name of a way to colour them -> colours, 0 to 1, for each step.
    fineness : int
        Positions are rounded to 1 nm over this.
    """
    found = k3d.points(
        series(np.float32(np.rint(place / NM * fineness) / fineness) for place in positions),
        point_sizes=series(np.float32(2 * radius / NM) for radius in radii),
        color=0xFFFFFF,  # by which those of the script are multiplied
        shader="3d",
        roughness=0.7,
        custom_data={"steps": steps, "colours": {k: series(packed(c) for c in own) for k, own in colours.items()}},
    )
    found.id = SPHERES
    return found


def series(arrays):
    """A time series of k3d, whose time is the number of the snapshot."""
    return {str(step): array for step, array in enumerate(arrays)}


def packed(colours):
    """Colours (n, 3), 0 to 1, as whole numbers 0xRRGGBB."""
    red, green, blue = np.rint(255 * np.asarray(colours)).astype(np.uint32).T
    return red << 16 | green << 8 | blue


def finished_page(plot, panel, title, script, hint, short=None):
    """HTML of a scene with its controls.

    Parameters
    ----------
    plot : k3d.Plot
    panel : str
        HTML with what the page tells, and a radio button and a legend for each way of colours.
    title : str
    script : str
        The page's own script, which has a function `tell(step)` and ends by choosing colours.
    hint : str
        HTML that stands below the slider, after what mouse and keys do.
    short : str, optional
        The same on a phone.
    """
    controls = Template(CONTROLS.read_text(encoding="utf-8"))
    panel += controls.substitute(hint=hint, short=hint if short is None else short)
    page = plot.get_snapshot(additional_js_code=SCRIPT.read_text(encoding="utf-8") + script)
    # k3d's title holds the time, and its page has no room for controls of our own
    head = f'<title>{escape(title)}</title>\n    <meta name="viewport" content="width=device-width, initial-scale=1">'
    page = re.sub("<title>.*?</title>", lambda _: head, page, count=1, flags=re.DOTALL)
    canvas = '<div id="canvasTarget"></div>'
    style = f"<style>\n{STYLE.read_text(encoding='utf-8')}</style>\n"
    return page.replace(canvas, style + panel + canvas, 1)
