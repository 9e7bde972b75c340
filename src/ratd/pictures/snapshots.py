"""What all pictures of a grain coming apart share: where its monomers are at a snapshot, and their colours."""

from dataclasses import dataclass

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import Normalize, to_rgb

from ratd.base.errors import InputError
from ratd.base.units import NM

LARGEST = "#0072B2"
OTHERS = ("#E69F00", "#009E73", "#CC79A7", "#D55E00", "#56B4E9", "#F0E442")
"""Colours of the fragments, told apart with any colour vision; the largest is blue as in the paper."""
FORCES = colormaps["PuOr"]
"""Orange pulls, purple pushes (the paper: red and green)."""
CROWDED = 0.98
"""Part of the forces that the scale of colours covers; the few above have the colour of its end."""
FARTHEST = 2.0
"""Half width of the pictures in the greatest distance of a monomer in the first one; what flew farther is not shown."""

DRIVE_NAMES = {"prescribed": "driven", "torque": "driven by a torque", "literal": "printed terms"}
"""Drive of the code -> what it is, for people."""


@dataclass(frozen=True)
class Frame:
    """The monomers that have not been dropped, at one snapshot.

    Attributes
    ----------
    position : (n, 3) numpy.ndarray
        In the turning frame, about the centre of mass of the largest fragment [m].
    radius : (n,) numpy.ndarray
        Radii [m].
    fragment : (n,) numpy.ndarray of int
        0 the largest, 1, 2, ... others.
    force : (n,) numpy.ndarray
        Normal force of greatest magnitude on each, > 0 pushing, 0 where there is no contact [N].
    """

    position: np.ndarray
    radius: np.ndarray
    fragment: np.ndarray
    force: np.ndarray

    @property
    def largest(self):
        """Which monomers belong to the largest fragment, (n,) numpy.ndarray of bool."""
        return self.fragment == 0


def need_snapshots(run, name):
    """Raise an InputError that names the picture if a run has no snapshots."""
    if "snapshot_omega" not in run or not run.sizes.get("snapshot", 0):
        raise InputError(f"{name}: the run has no snapshots; set snapshots in the config, or snapshot_every")


def frames(run, chosen=None):
    """Monomers of a run at its snapshots.

    Parameters
    ----------
    run : xarray.Dataset
        A spin-up run with snapshots, see `ratd.spin_up`.
    chosen : iterable of int, optional
        Numbers of the snapshots; default all.

    Returns
    -------
    list of Frame
    """
    radius = run["monomer_radius"].values
    chosen = range(run.sizes["snapshot"]) if chosen is None else chosen
    return [_frame(run.isel(snapshot=k), radius) for k in chosen]


def _frame(snapshot, radius):
    there = snapshot["snapshot_fragment"].values >= 0
    position = np.stack([snapshot[f"snapshot_{axis}"].values for axis in "xyz"], axis=1)[there]
    fragment = snapshot["snapshot_fragment"].values[there]
    position = position - np.average(position, axis=0, weights=radius[there] ** 3 * (fragment == 0))
    return Frame(position, radius[there], fragment, np.nan_to_num(snapshot["snapshot_normal_force"].values[there]))


def displacements(run, chosen):
    """How far monomers have moved since the first snapshot, beyond the motion of the largest fragment as a rigid body.

    Parameters
    ----------
    run : xarray.Dataset
        A spin-up run with snapshots, see `ratd.spin_up`.
    chosen : iterable of int
        Numbers of snapshots.

    Returns
    -------
    list of (n,) numpy.ndarray
        Of the monomers of each of the `frames` [m]. The rotation and translation taken off are those that bring the
        monomers of the largest fragment nearest to where they are, in the mean square weighted by mass.
    """
    place = np.stack([run[f"snapshot_{axis}"].values for axis in "xyz"], axis=-1)
    fragment, weight = run["snapshot_fragment"].values, run["monomer_radius"].values ** 3
    found = []
    for k in chosen:
        there = fragment[k] >= 0
        largest = fragment[k] == 0
        turned = _carried(place[0], place[k], largest, weight)
        found.append(np.linalg.norm(place[k] - turned, axis=1)[there])
    return found


def _carried(start, end, chosen, weight):
    """Places (n, 3) that a rigid motion takes to the ends of the chosen ones as near as can be (Kabsch 1976)."""
    weight = weight[chosen]
    start_middle, end_middle = (np.average(at[chosen], axis=0, weights=weight) for at in (start, end))
    moment = ((start[chosen] - start_middle) * weight[:, None]).T @ (end[chosen] - end_middle)
    left, _, right = np.linalg.svd(moment)
    sense = np.sign(np.linalg.det(left @ right))  # a mirror image is no motion
    return (start - start_middle) @ (left * [1.0, 1.0, sense]) @ right + end_middle


def fragment_colours(fragment):
    """Colours (n, 3) of monomers by the number of their fragment (n,): 0 the largest."""
    fragment = np.asarray(fragment)
    others = np.array([to_rgb(colour) for colour in OTHERS])[(fragment - 1) % len(OTHERS)]
    return np.where((fragment == 0)[:, None], to_rgb(LARGEST), others)


def force_scale(shown):
    """Symmetric scale for the colours of the forces of some frames [N], matplotlib.colors.Normalize."""
    greatest = np.quantile(np.abs(np.concatenate([frame.force for frame in shown])), CROWDED) or 1e-9
    return Normalize(-greatest, greatest)


def force_colours(force, scale):
    """Colours (n, 3) of monomers by the normal force on them (n,) [N], see `force_scale`."""
    return FORCES(scale(force))[:, :3]


def title_of(run, drive=None):
    """Title of the pictures of one run, in two lines; the drive that it names itself if none is given."""
    attrs = run.attrs
    size = f"{float(attrs['a_eff']) / NM:.4g} nm"
    title = f"{attrs['material']} {attrs['type']} {size}, seed {attrs['seed']}\n"
    return title + drive_text(drive_of([run]) if drive is None else drive)


def drive_text(drive):
    """How the drive is named in a title."""
    return DRIVE_NAMES.get(drive, f"drive: {drive}") if drive else "drive not stated"


def drive_of(table):
    """The drives that a table or a list of runs names, joined.

    Parameters
    ----------
    table : pandas.DataFrame or sequence of xarray.Dataset

    Returns
    -------
    str
        Empty if none is named.
    """
    if isinstance(table, list | tuple):
        drives = {run.attrs.get("drive", "") for run in table}
    else:
        drives = set(table["drive"].dropna()) if "drive" in table else set()
    return ", ".join(sorted(drives - {""}))
