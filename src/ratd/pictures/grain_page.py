"""A page for the browser: one grain that is turned with the mouse and steps through its disruption."""

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
from ratd.pictures.stepper import OPENING, SPHERES, finished_page, scene, spheres
from ratd.pictures.style import GREY

__all__ = ["OPENING", "SPHERES", "grain_page"]

AXIS = 2
"""Number of the axis of rotation in the scene, beside that of the spheres."""
TEMPLATE = Path(__file__).with_name("grain_page.html")
SCRIPT = Path(__file__).with_name("grain_page.js")
SHORT = "The rod is {axis} nm long."
HINT = (
    "The tick below the bar marks &omega;<sub>disr</sub>. The grain is seen in the frame that turns with it. The grey "
    "rod, {axis} nm long, lies along the axis of rotation through the centre of mass of the largest fragment."
)


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
    plot = scene(half_width)
    colours = {
        "fragment": [fragment_colours(frame.fragment) for frame in shown],
        "force": [force_colours(frame.force, scale) for frame in shown],
    }
    steps = _steps(run, shown, omega_disr)
    plot += spheres([frame.position for frame in shown], [frame.radius for frame in shown], steps, colours)
    plot += _axis(axis_length, half_width)
    title, drive_line = title_of(run, drive).split("\n")
    panel = Template(TEMPLATE.read_text(encoding="utf-8")).substitute(
        title=escape(title),
        drive=escape(drive_line),
        largest=LARGEST,
        forces=", ".join(to_hex(FORCES(part)) for part in np.linspace(0, 1, 17)),
        greatest=f"{scale.vmax / 1e-9:.3g}",
    )
    short, hint = (text.format(axis=f"{axis_length:g}") for text in (SHORT, HINT))
    return finished_page(plot, panel, title, SCRIPT.read_text(encoding="utf-8"), hint, short)


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


def _axis(length, half_width):
    """Axis of rotation, a thin rod of some length [nm]."""
    ends = np.array([[0, 0, -0.5], [0, 0, 0.5]], np.float32) * length
    axis = k3d.line(ends, shader="mesh", width=0.006 * half_width, color=int(GREY[1:], 16))
    axis.id = AXIS
    return axis
