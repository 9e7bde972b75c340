"""What a grain that LAMMPS drives had reached at its last hold, so that a killed run goes on from there.

Beside each other stand the holds so far, PATH.npz, and the spheres, PATH.NUMBER.restart, which the holds name. The
holds say how they were made, and none that is made in another way goes on from there. What was finished before is kept
by `once`.
"""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from ratd.base.errors import InputError
from ratd.pipeline.atomic import atomic

__all__ = ["Drive", "Holds", "forget", "keep", "last_hold", "once"]


class Drive(NamedTuple):
    """How a grain is driven.

    Attributes
    ----------
    code : str
        What LAMMPS is made with.
    step, rotations : float
        See `ratd.validation.lammps.driven`.
    """

    code: str
    step: float
    rotations: float


class Holds(NamedTuple):
    """What was held so far.

    Attributes
    ----------
    start : float
        omega that the rise leads to [rad/s].
    risen : int
        Steps of the rise.
    rows : list of tuple of float
        Of `ratd.validation.lammps.driven`, behind the rise.
    """

    start: float
    risen: int
    rows: list


def _files_of(checkpoint):
    """The holds so far, and all states of the spheres."""
    holds = Path(f"{checkpoint}.npz")
    return [holds, *sorted(holds.parent.glob(f"{holds.stem}.*.restart"))]


def keep(checkpoint, grain, drive, held):
    """Write a checkpoint: first the spheres under a name of their own, then the holds, which name them.

    Parameters
    ----------
    checkpoint : path-like or None
        None for no checkpoint.
    grain : ratd.validation.lammps.InLammps
    drive : Drive
    held : Holds
    """
    if checkpoint is None:
        return
    holds, *older = _files_of(checkpoint)
    spheres = holds.with_name(f"{holds.stem}.{held.risen + len(held.rows)}.restart")
    with atomic(spheres) as temporary:
        grain.save(temporary)
    with atomic(holds) as temporary, open(temporary, "wb") as handle:
        own = held._asdict() | {"rows": np.reshape(held.rows, (-1, 4))}
        np.savez(handle, **drive._asdict(), **own, spheres=spheres.name)
    for path in older:
        if path != spheres:
            path.unlink(missing_ok=True)


def last_hold(checkpoint, drive):
    """`Holds` and file of the spheres of a checkpoint; None where there is none.

    Raises
    ------
    InputError
        If it was made in another way.
    """
    holds = _files_of(checkpoint)[0]
    if not holds.is_file():
        return None
    with np.load(holds) as found:
        before = Drive(str(found["code"]), float(found["step"]), float(found["rotations"]))
        if before != drive:
            raise InputError(f"{holds} is of {before}, and does not go on with {drive}: remove it to begin anew.")
        rows = [tuple(row) for row in found["rows"].tolist()]
        return Holds(float(found["start"]), int(found["risen"]), rows), holds.with_name(str(found["spheres"]))


def forget(checkpoint):
    """Remove all files of a checkpoint."""
    if checkpoint is not None:
        for path in _files_of(checkpoint):
            path.unlink(missing_ok=True)


def once(path, make):
    """An array from a file, which is made first where it is not there; made anew each time where the path is None."""
    if path is None:
        return make()
    path = Path(path)
    if not path.is_file():
        found = make()
        with atomic(path) as temporary, open(temporary, "wb") as handle:
            np.save(handle, found)
    return np.load(path)
