"""A page for the browser: one grain that is turned with the mouse and steps through its disruption.

k3d draws it and brings its own script, so the page holds all that it needs and loads nothing when it is opened.
"""

import re
from html import escape
from pathlib import Path
from string import Template

import k3d
import numpy as np
from matplotlib.colors import to_hex

from ratd.base.units import NM
from ratd.pictures.snapshots import (
    FARTHEST,
    FORCES,
    LARGEST,
    force_colours,
    force_scale,
    fragment_colours,
    frames,
    need_snapshots,
    title_of,
)
from ratd.pictures.spheres import scale_length
from ratd.pictures.style import GREY

FINENESS = 128
"""Positions are rounded to 1 nm over this power of two, which leaves bits that compress well."""
VIEW = np.array([0.75, -0.55, 0.37])
"""Direction from the grain towards the viewer at the start; z is the axis of rotation."""
OPENING = 30.0
"""Angle of view of the camera from the lower to the upper edge [degrees]."""
SPHERES, AXIS = 1, 2
"""Numbers of the objects in the scene; k3d would take addresses in memory, which differ from run to run."""
TEMPLATE = Path(__file__).with_name("grain_page.html")
SCRIPT = Path(__file__).with_name("grain_page.js")


def grain_page(run, omega_disr, drive=None):
    """Page with a grain that is turned with the mouse and steps through the snapshots of its spin-up.

    Parameters
    ----------
    run : xarray.Dataset
        A spin-up run with snapshots, see `ratd.spin_up`.
    omega_disr : float
        Angular velocity [rad s-1] at which the grain is disrupted, which each step is told beside.
    drive : str, optional
        Named in the title; default: what the run says.

    Returns
    -------
    str
        HTML, the same for the same run. Spheres have their true size and places, in nm, in the frame that turns with
        the grain and about the centre of mass of the largest fragment. The camera shows the largest fragment at all
        steps, but at most `FARTHEST` times as far as the grain as grown reaches.

    Raises
    ------
    InputError
        If the run has no snapshots.
    """
    need_snapshots(run, "grain_page")
    shown = frames(run)
    scale = force_scale(shown)
    reach = [np.max(np.linalg.norm(f.position[f.largest], axis=1) + f.radius[f.largest]) / NM for f in shown]
    half_width = min(max(reach), FARTHEST * reach[0])
    axis_length = scale_length(3 * half_width)
    plot = _scene(half_width)
    plot += _spheres(shown, scale, _steps(run, shown, omega_disr))
    plot += _axis(axis_length, half_width)
    title, drive_line = title_of(run, drive).split("\n")
    panel = Template(TEMPLATE.read_text(encoding="utf-8")).substitute(
        title=escape(title),
        drive=escape(drive_line),
        axis=f"{axis_length:g}",
        largest=LARGEST,
        forces=", ".join(to_hex(FORCES(part)) for part in np.linspace(0, 1, 17)),
        greatest=f"{scale.vmax / 1e-9:.3g}",
    )
    page = plot.get_snapshot(additional_js_code=SCRIPT.read_text(encoding="utf-8"))
    # k3d's title holds the time, and its page has no room for controls of our own
    head = f'<title>{escape(title)}</title>\n    <meta name="viewport" content="width=device-width, initial-scale=1">'
    page = re.sub("<title>.*?</title>", lambda _: head, page, count=1, flags=re.DOTALL)
    canvas = '<div id="canvasTarget"></div>'
    return page.replace(canvas, panel + canvas, 1)


def _steps(run, shown, omega_disr):
    """What the page tells in numbers, for each snapshot; omega/omega_disr is None where there is no omega_disr."""
    omega = run["snapshot_omega"].values
    whole = np.sum(run["monomer_radius"].values ** 3)
    known = np.isfinite(omega_disr)
    return {
        "omega": omega.tolist(),
        "ratio": (omega / omega_disr).tolist() if known else [None] * len(omega),
        "largest": [float(np.sum(frame.radius[frame.largest] ** 3) / whole) for frame in shown],
        "fragments": [len(np.unique(frame.fragment)) for frame in shown],
        "dropped": [run.sizes["monomer"] - len(frame.radius) for frame in shown],
    }


def _spheres(shown, scale, steps):
    """The monomers at all steps, with both ways to colour them, which the script of the page chooses from."""
    colours = {
        "fragment": _series(_packed(fragment_colours(frame.fragment)) for frame in shown),
        "force": _series(_packed(force_colours(frame.force, scale)) for frame in shown),
    }
    spheres = k3d.points(
        _series(np.float32(np.rint(frame.position / NM * FINENESS) / FINENESS) for frame in shown),
        point_sizes=_series(np.float32(2 * frame.radius / NM) for frame in shown),
        color=0xFFFFFF,  # by which those of the script are multiplied
        shader="3d",
        roughness=0.7,
        custom_data={"steps": steps, "colours": colours},
    )
    spheres.id = SPHERES
    return spheres


def _axis(length, half_width):
    """Axis of rotation, a thin rod of some length [nm]."""
    ends = np.array([[0, 0, -0.5], [0, 0, 0.5]], np.float32) * length
    axis = k3d.line(ends, shader="mesh", width=0.006 * half_width, color=int(GREY[1:], 16))
    axis.id = AXIS
    return axis


def _scene(half_width):
    """Empty scene without k3d's own controls, seen so that `half_width` [nm] about the origin fits in."""
    distance = 1.05 * half_width / np.sin(np.radians(OPENING / 2))
    place = distance * VIEW / np.linalg.norm(VIEW)
    return k3d.plot(
        camera=[*place.tolist(), 0, 0, 0, 0, 0, 1],
        camera_auto_fit=False,
        camera_fov=OPENING,
        grid_visible=False,
        axes_helper=0,
        menu_visibility=False,
        time_interpolation=False,
    )


def _series(arrays):
    """A time series of k3d, whose time is the number of the snapshot."""
    return {str(step): array for step, array in enumerate(arrays)}


def _packed(colours):
    """Colours (n, 3), 0 to 1, as whole numbers 0xRRGGBB."""
    red, green, blue = np.rint(255 * np.asarray(colours)).astype(np.uint32).T
    return red << 16 | green << 8 | blue
