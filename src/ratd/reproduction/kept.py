"""What a folder of data holds of the grains that stay in it while others are added."""

from dataclasses import dataclass, field

import pandas as pd

from ratd import io
from ratd.errors import FileError
from ratd.reproduction.collected import INDEX, RECORDS, SNAPSHOTS, grain_key, table_keys


@dataclass
class Kept:
    """The grains of a drive that stay.

    Attributes
    ----------
    table : pandas.DataFrame or None
        As `ratd.ensemble.grain_table` made it; None without grains.
    fragments : dict of tuple to xarray.Dataset
        Key of a grain (see `ratd.reproduction.collected.grain_key`) -> row from `ratd.fragmentation.fragmentation`.
    course, pictures : dict of tuple to xarray.Dataset
        Key of a grain -> spin-up that Fig. 4 or Fig. 5 shows.
    """

    table: pd.DataFrame | None = None
    fragments: dict = field(default_factory=dict)
    course: dict = field(default_factory=dict)
    pictures: dict = field(default_factory=dict)


def read_kept(folder, drive, collected):
    """Read what a folder holds of the grains of a drive.

    Parameters
    ----------
    folder : Path
    drive : str
    collected : ratd.reproduction.collected.Collected
        The grains that stay.

    Returns
    -------
    Kept

    Raises
    ------
    FileError
        If a file is not there, is damaged, or lacks one of the grains.
    """
    keys = collected.keys(drive)
    if not keys:
        return Kept()
    path = folder / f"ensemble/{drive}/grains.nc"
    table = io.read_table(path)
    places = _those(path, {key: k for k, key in enumerate(table_keys(table))}, keys)
    path = folder / f"fragments/{drive}.nc"
    rows = [row.assign(row.attrs) for row in io.rows(io.read(path, "fragments"), "fragments")]
    fragments = _those(path, {grain_key(row): row for row in rows}, keys)
    return Kept(
        table.iloc[sorted(places.values())],
        fragments,
        _runs(folder / f"figure4/{drive}.nc", collected.keys(drive, RECORDS)),
        _runs(folder / f"figure5/{drive}.nc", collected.keys(drive, SNAPSHOTS)),
    )


def _runs(path, keys):
    return _those(path, {grain_key(run.attrs): run for run in io.read_runs(path)}, keys) if keys else {}


def _those(path, found, keys):
    """The entries of these keys."""
    lacking = sorted(keys - found.keys())
    if lacking:
        material, kind, size, seed = lacking[0]
        raise FileError(
            f"{path}: lacks {material} {kind} {size} nm seed {seed}, which {INDEX} names; "
            f"allowed: files of one collection (remove {INDEX} to begin anew)"
        )
    return {key: found[key] for key in sorted(keys)}
