"""What a grain that LAMMPS drives had reached at its last hold, so that a killed run goes on from there.

Beside each other stand the holds so far, PATH.npz, and the spheres, PATH.NUMBER.restart, which the holds name. What is
not LAMMPS' own, and was finished before, is kept by `once`.
"""

from pathlib import Path

import numpy as np

from ratd.pipeline.atomic import atomic

__all__ = ["forget", "keep", "last_hold", "once"]


def _files_of(checkpoint):
    """The holds so far, and all states of the spheres."""
    holds = Path(f"{checkpoint}.npz")
    return [holds, *sorted(holds.parent.glob(f"{holds.stem}.*.restart"))]


def keep(checkpoint, grain, rows, risen):
    """Write a checkpoint: first the spheres under a name of their own, then the holds, which name them.

    Parameters
    ----------
    checkpoint : path-like or None
        None for no checkpoint.
    grain : ratd.validation.lammps.InLammps
    rows : list of tuple of float
        Holds so far, of `ratd.validation.lammps.driven`.
    risen : int
        Steps of the rise before them.
    """
    if checkpoint is None:
        return
    holds, *older = _files_of(checkpoint)
    spheres = holds.with_name(f"{holds.stem}.{risen + len(rows)}.restart")
    with atomic(spheres) as temporary:
        grain.save(temporary)
    with atomic(holds) as temporary, open(temporary, "wb") as handle:
        np.savez(handle, rows=np.reshape(rows, (-1, 4)), risen=risen, spheres=spheres.name)
    for path in older:
        if path != spheres:
            path.unlink(missing_ok=True)


def last_hold(checkpoint):
    """Rows, steps of the rise and file of the spheres of a checkpoint; None where there is none."""
    if checkpoint is None or not (holds := _files_of(checkpoint)[0]).is_file():
        return None
    with np.load(holds) as found:
        rows, risen = [tuple(row) for row in found["rows"].tolist()], int(found["risen"])
        return rows, risen, holds.with_name(str(found["spheres"]))


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
