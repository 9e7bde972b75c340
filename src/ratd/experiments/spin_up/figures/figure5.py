"""Fig. 5: one grain coming apart, in three pictures."""

import numpy as np
from matplotlib import colormaps
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm, Normalize
from matplotlib.ticker import FuncFormatter

from ratd.base.units import NM
from ratd.experiments.spin_up.marks import disruption
from ratd.experiments.spin_up.run_files import run_of_seed
from ratd.pictures.snapshots import (
    CROWDED,
    FARTHEST,
    FORCES,
    displacements,
    force_colours,
    force_scale,
    frames,
    need_snapshots,
    title_of,
)
from ratd.pictures.spheres import outline, render, scale_length, view_axes
from ratd.pictures.style import TWO_COLUMNS, empty, nanometres, new_figure, styled

MOMENTS = (0.1, 0.8, 1.0)
"""omega/omega_disr of the three pictures."""
CAMERA = view_axes((0, 0, 1), (0, 1, 0))
"""The pictures are seen along the axis of rotation."""
MOVED = colormaps["YlGnBu"]
START = (0.75, 0.75, 0.75)
"""Colour of monomers in the picture from which displacements are counted, where none has moved."""
LEAST = 0.1 * NM
"""Displacement [m] at the lower end of the scale, about the depth to which two monomers in contact overlap."""
PIXELS = 720


def nearest_snapshots(run, omega_disr):
    """Numbers of the snapshots of a run nearest to `MOMENTS` times omega_disr [rad s-1], list of int."""
    omega = run["snapshot_omega"].values
    return [int(np.argmin(np.abs(omega - part * omega_disr))) for part in MOMENTS]


@styled
def figure5(run, mark=None, drive=None):
    """Snapshots of a spin-up, coloured by how far each monomer has moved and by the force on it (Fig. 5).

    Parameters
    ----------
    run : xarray.Dataset
        A spin-up run with snapshots, see `ratd.spin_up`.
    mark : xarray.Dataset, optional
        What `ratd.disruption` returns for it; found here if not given.
    drive : str, optional
        Named in the title; default: what the run says.

    Returns
    -------
    matplotlib.figure.Figure
        Seen along the axis of rotation, all on one scale. A column a snapshot, that nearest to each of `MOMENTS`; the
        columns tell at which omega/omega_disr it really is, and how much has parted. Above, the displacement since the
        first snapshot of the run, beyond the motion as a rigid body (`displacements`); a picture of that one itself is
        grey and says so. Below, the normal force. A run without omega_disr gives an empty panel that says so.

    Raises
    ------
    InputError
        If the run has no snapshots.

    References
    ----------
    Reissl et al. (2024), A&A 692, A60, Fig. 5, where the fragments have the colours of the displacement here.
    """
    mark = disruption(run) if mark is None else mark
    omega_disr = float(mark["omega_disr"])
    need_snapshots(run, "figure5")
    title = title_of(run, drive).replace("\n", ", ")
    if not np.isfinite(omega_disr):
        figure = new_figure(TWO_COLUMNS, 0.3 * TWO_COLUMNS, title)
        empty(figure.subplots(), "the run has no peak of the stress")
        return figure
    chosen = nearest_snapshots(run, omega_disr)
    shown, moved = frames(run, chosen), displacements(run, chosen)
    places = [frame.position @ CAMERA.T for frame in shown]
    box = _box(places, shown)
    shape = (box[3] - box[2]) / (box[1] - box[0])
    figure = new_figure(TWO_COLUMNS, (2 * 0.29 * min(shape, 1.5) + 0.12) * TWO_COLUMNS, title)
    panels = figure.subplots(2, len(chosen), squeeze=False)
    how_far, pull = _moved_scale(moved), force_scale(shown)
    for column, k, at, frame, distance in zip(panels.T, chosen, places, shown, moved, strict=True):
        way = MOVED(how_far(np.maximum(distance, how_far.vmin)))[:, :3] if k else np.tile(START, (len(distance), 1))
        _show(column, at, frame.radius, (way, force_colours(frame.force, pull)), box)
        column[0].set_title(_words(run, k, frame, omega_disr), pad=3)
        dropped = run.sizes["monomer"] - len(frame.radius)
        inside = np.array([1, -1, 1, -1]) * (np.repeat(at[:, :2], 2, axis=1) - box) > -frame.radius[:, None]
        away = int(np.sum(~inside.all(axis=1))) + dropped
        if away or not k:
            text = f"{away} flew off" if away else "counted from here"
            column[0].text(0.03, 0.01, text, transform=column[0].transAxes, zorder=3)
    _scale_bar(panels[1, 0], box)
    first = float(run["snapshot_omega"][0]) / omega_disr
    far = ScalarMappable(LogNorm(how_far.vmin / NM, how_far.vmax / NM), MOVED)
    force = ScalarMappable(Normalize(pull.vmin / 1e-9, pull.vmax / 1e-9), FORCES)
    labels = (
        rf"moved since $\omega/\omega_\mathrm{{disr}}$ = {first:.2f} [nm]",
        "normal force $F_\\mathrm{N}$ of greatest\nmagnitude [nN], > 0 pushing",
    )
    for row, bar, label in zip(panels, (far, force), labels, strict=True):
        scale = figure.colorbar(bar, ax=row, shrink=0.9, aspect=18, pad=0.01, extend="both")
        scale.set_label(label)
        if bar is far:
            scale.ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    return figure


def _box(places, shown):
    """Left, right, bottom, top of all pictures [m]: of all monomers, but for those that flew far out of the first."""
    boxes = np.array([outline(at, frame.radius) for at, frame in zip(places, shown, strict=True)])
    reach = FARTHEST * np.max(np.abs(boxes[0]))
    box = np.clip([boxes[:, 0].min(), boxes[:, 1].max(), boxes[:, 2].min(), boxes[:, 3].max()], -reach, reach)
    margin = 0.02 * max(box[1] - box[0], box[3] - box[2])
    return box + margin * np.array([-1, 1, -1, 1])


def _moved_scale(moved):
    """Logarithmic scale of displacements [m] from `LEAST` on, of whole decades, so that several figures share it."""
    greatest = max(np.quantile(np.concatenate(moved), CROWDED), 2 * LEAST)
    return LogNorm(LEAST, LEAST * 10 ** np.ceil(np.log10(greatest / LEAST)))


def _words(run, k, frame, omega_disr):
    """What stands above a column: omega, the contacts, and what has parted."""
    ratio = float(run["snapshot_omega"][k]) / omega_disr
    contacts = int(run["n_contacts"].values[np.argmin(np.abs(run["omega"].values - ratio * omega_disr))])
    share = np.sum(frame.radius[frame.largest] ** 3) / np.sum(run["monomer_radius"].values ** 3)
    whole = "in one piece" if share > 1 - 1e-9 else f"{100 * share:.0f} % in one piece"
    return rf"$\omega/\omega_\mathrm{{disr}}$ = {ratio:.2f}" f"\n$N_\\mathrm{{con}}$ = {contacts}, {whole}"


def _show(panels, at, radius, colours, box):
    """Spheres in panels with axes in nm that show a box [m], in each with other colours."""
    centre = np.array([box[0] + box[1], box[2] + box[3], 0.0]) / 2
    half = 0.5 * max(box[1] - box[0], box[3] - box[2])
    (x, y, _), reach = nanometres(centre), nanometres(half)
    left, right, bottom, top = nanometres(box)
    for axes, picture in zip(panels, render(at - centre, radius, colours, half, PIXELS), strict=True):
        axes.imshow(picture, extent=(x - reach, x + reach, y - reach, y + reach), interpolation="antialiased", zorder=2)
        axes.set(xlim=(left, right), ylim=(bottom, top), aspect="equal")
        axes.set_axis_off()


def _scale_bar(axes, box):
    """Scale bar at the lower left of a panel, with its length."""
    left, right, bottom, top = nanometres(box)
    length, gap = scale_length(0.3 * (right - left)), 0.02 * (top - bottom)
    axes.plot([left, left + length], [bottom + gap] * 2, color="black", lw=1.6, solid_capstyle="butt", zorder=3)
    axes.text(left, bottom + 2 * gap, f"{length:g} nm", va="bottom", zorder=3)


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return figure5(run_of_seed(files["runs"], settings["seed"]), drive=settings["drive"])
