"""Fig. 5: one grain coming apart, in three pictures."""

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize

from ratd.experiments.spin_up.marks import disruption
from ratd.experiments.spin_up.run_files import run_of_seed
from ratd.pictures.snapshots import (
    FARTHEST,
    FORCES,
    force_colours,
    force_scale,
    fragment_colours,
    frames,
    need_snapshots,
    title_of,
)
from ratd.pictures.spheres import render, show, view_axes
from ratd.pictures.style import ONE_COLUMN, empty, new_figure, styled

MOMENTS = (0.1, 0.8, 1.0)
"""omega/omega_disr of the three pictures."""
CAMERA = view_axes((0, 0, 1), (0, 1, 0))
"""The pictures are seen along the axis of rotation."""


def nearest_snapshots(run, omega_disr):
    """Numbers of the snapshots of a run nearest to `MOMENTS` times omega_disr [rad s-1], list of int."""
    omega = run["snapshot_omega"].values
    return [int(np.argmin(np.abs(omega - part * omega_disr))) for part in MOMENTS]


@styled
def figure5(run, mark=None, drive=None):
    """Snapshots of a spin-up, coloured by fragment and by normal force (Fig. 5).

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
        Seen along the axis of rotation. A row a snapshot, that nearest to each of `MOMENTS`; the rows tell at which
        omega/omega_disr it really is. A run without omega_disr gives an empty panel that says so.

    Raises
    ------
    InputError
        If the run has no snapshots.

    References
    ----------
    Reissl et al. (2024), A&A 692, A60, Fig. 5.
    """
    mark = disruption(run) if mark is None else mark
    omega_disr = float(mark["omega_disr"])
    need_snapshots(run, "figure5")
    figure = new_figure(ONE_COLUMN, 1.85 * ONE_COLUMN, title_of(run, drive))
    if not np.isfinite(omega_disr):
        empty(figure.subplots(), "the run has no peak of the stress")
        return figure
    chosen = nearest_snapshots(run, omega_disr)
    shown = frames(run, chosen)
    places = [frame.position @ CAMERA.T for frame in shown]
    reach = [np.max(np.linalg.norm(at[:, :2], axis=1) + f.radius) for at, f in zip(places, shown, strict=True)]
    half_width = 1.12 * min(max(reach), FARTHEST * reach[0])
    scale = force_scale(shown)
    panels = figure.subplots(len(chosen), 2, squeeze=False)
    for row, k, at, frame in zip(panels, chosen, places, shown, strict=True):
        colours = fragment_colours(frame.fragment), force_colours(frame.force, scale)
        for axes, colour in zip(row, colours, strict=True):
            show(axes, render(at, frame.radius, colour, half_width), half_width)
        ratio = float(run["snapshot_omega"][k]) / omega_disr
        dropped = run.sizes["monomer"] - len(frame.radius)
        away = int(np.sum(np.max(np.abs(at[:, :2]), axis=1) - frame.radius > half_width)) + dropped
        row[0].set_title(rf"$\omega/\omega_\mathrm{{disr}}$ = {ratio:.2f}", pad=2)
        contacts = int(run["n_contacts"].values[np.argmin(np.abs(run["omega"].values - ratio * omega_disr))])
        row[1].set_title(rf"$N_\mathrm{{con}}$ = {contacts}", pad=2)
        if away:
            row[0].text(0.03, 0.01, f"{away} farther", transform=row[0].transAxes, zorder=3)
    bar = ScalarMappable(Normalize(scale.vmin / 1e-9, scale.vmax / 1e-9), FORCES)
    bar = figure.colorbar(bar, ax=panels, location="bottom", shrink=0.8, aspect=30, pad=0.01, extend="both")
    bar.set_label(r"normal force $F_\mathrm{N}$ of greatest magnitude [nN], > 0 pushing")
    return figure


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return figure5(run_of_seed(files["runs"], settings["seed"]), drive=settings["drive"])
