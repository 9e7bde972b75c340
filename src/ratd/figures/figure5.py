"""Fig. 5: one grain coming apart, in three pictures."""

import numpy as np
from matplotlib import colormaps
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize, to_rgb

from ratd.errors import InputError
from ratd.figures.spheres import render, show, view_axes
from ratd.figures.style import ONE_COLUMN, drive_of, drive_text, empty, new_figure, styled
from ratd.marks import disruption
from ratd.units import NM

MOMENTS = (0.1, 0.8, 1.0)
"""omega/omega_disr of the three pictures."""
LARGEST = "#0072B2"
OTHERS = ("#E69F00", "#009E73", "#CC79A7", "#D55E00", "#56B4E9", "#F0E442")
"""Colours of the fragments, told apart with any colour vision; the largest is blue as in the paper."""
FORCES = colormaps["PuOr"]
"""Orange pulls, purple pushes (the paper: red and green)."""
CROWDED = 0.98
"""Part of the forces that the scale of colours covers; the few above have the colour of its end."""
FARTHEST = 2.0
"""Half width of the pictures in the greatest distance of a monomer in the first one; what flew farther is not shown."""


def nearest_snapshots(run, omega_disr):
    """Numbers of the snapshots of a run nearest to `MOMENTS` times omega_disr [rad s-1], list of int."""
    omega = run["snapshot_omega"].values
    return [int(np.argmin(np.abs(omega - part * omega_disr))) for part in MOMENTS]


def fragment_colours(fragment):
    """Colours (n, 3) of monomers by the number of their fragment (n,): 0 the largest."""
    fragment = np.asarray(fragment)
    others = np.array([to_rgb(colour) for colour in OTHERS])[(fragment - 1) % len(OTHERS)]
    return np.where((fragment == 0)[:, None], to_rgb(LARGEST), others)


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
    if "snapshot_omega" not in run or not run.sizes.get("snapshot", 0):
        raise InputError("figure5: the run has no snapshots; set snapshots in the config, or snapshot_every")
    attrs = run.attrs
    size = f"{float(attrs['a_eff']) / NM:.4g} nm"
    title = f"{attrs['material']} {attrs['type']} {size}, seed {attrs['seed']}\n"
    title += drive_text(drive_of([run]) if drive is None else drive)
    figure = new_figure(ONE_COLUMN, 1.85 * ONE_COLUMN, title)
    if not np.isfinite(omega_disr):
        empty(figure.subplots(), "the run has no peak of the stress")
        return figure
    chosen = [run.isel(snapshot=k) for k in nearest_snapshots(run, omega_disr)]
    radius = run["monomer_radius"].values
    frames = [_frame(snapshot, radius) for snapshot in chosen]
    reach = [np.max(np.linalg.norm(at[:, :2], axis=1) + a) for at, a, _, _ in frames]
    half_width = 1.12 * min(max(reach), FARTHEST * reach[0])
    forces = np.abs(np.concatenate([force for *_, force in frames]))
    greatest = np.quantile(forces, CROWDED) or 1e-9
    scale = Normalize(-greatest, greatest)
    panels = figure.subplots(len(chosen), 2, squeeze=False)
    for row, snapshot, (at, a, fragment, force) in zip(panels, chosen, frames, strict=True):
        for axes, colour in zip(row, (fragment_colours(fragment), FORCES(scale(force))[:, :3]), strict=True):
            show(axes, render(at, a, colour, half_width), half_width)
        ratio = float(snapshot["snapshot_omega"]) / omega_disr
        away = int(np.sum(np.max(np.abs(at[:, :2]), axis=1) - a > half_width)) + len(radius) - len(a)
        row[0].set_title(rf"$\omega/\omega_\mathrm{{disr}}$ = {ratio:.2f}", pad=2)
        contacts = int(run["n_contacts"].values[np.argmin(np.abs(run["omega"].values - ratio * omega_disr))])
        row[1].set_title(rf"$N_\mathrm{{con}}$ = {contacts}", pad=2)
        if away:
            row[0].text(0.03, 0.01, f"{away} farther", transform=row[0].transAxes, zorder=3)
    bar = ScalarMappable(Normalize(scale.vmin / 1e-9, scale.vmax / 1e-9), FORCES)
    bar = figure.colorbar(bar, ax=panels, location="bottom", shrink=0.8, aspect=30, pad=0.01, extend="both")
    bar.set_label(r"normal force $F_\mathrm{N}$ of greatest magnitude [nN], > 0 pushing")
    return figure


def _frame(snapshot, radius):
    """Coordinates in the picture, radii, fragments and forces of the monomers that have not left."""
    there = snapshot["snapshot_fragment"].values >= 0
    position = np.stack([snapshot[f"snapshot_{axis}"].values for axis in "xyz"], axis=1)[there]
    largest = snapshot["snapshot_fragment"].values[there] == 0
    weight = radius[there] ** 3 * largest
    position = position - np.average(position, axis=0, weights=weight)
    force = np.nan_to_num(snapshot["snapshot_normal_force"].values[there])
    camera = view_axes((0, 0, 1), (0, 1, 0))
    return position @ camera.T, radius[there], snapshot["snapshot_fragment"].values[there], force
