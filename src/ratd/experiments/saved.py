"""Files of runs: those that ratd writes, and runs that users saved with `to_netcdf`."""

from importlib import import_module

import netCDF4
import xarray as xr

from ratd.base.errors import FileError, InputError

__all__ = ["KNOWN_BY", "kind_in", "read_runs"]

KNOWN_BY = {
    "spinup": {"fragment_omega", "end_reason"},
    "stretched": {"tension", "tensile_strength"},
    "compression": {"static_from", "snapshot_phi"},
    "collisions": {"cluster", "impact_energy"},
}
"""Kind of file -> variables and attributes that only a run of this kind has, as the functions of `ratd` return it."""
_READERS = {
    "spinup": ("spin_up.run_files", "read_runs"),
    "stretched": ("compression.files", "read_pulls"),
    "compression": ("compression.files", "read_runs"),
    "collisions": ("collision.files", "read_runs"),
}
"""Kind of file -> module of `ratd.experiments` and its function that reads such a file of ratd."""


def kind_in(path):
    """Kind of a netCDF file of results, and whether ratd wrote it.

    Parameters
    ----------
    path : path-like

    Returns
    -------
    kind : str or None
        See `ratd.pipeline.kinds`; for a run that its user saved with `to_netcdf`, the kind of file such runs stand in.
    by_ratd : bool

    Raises
    ------
    FileError
        If it is no netCDF file.
    """
    try:
        with netCDF4.Dataset(path) as file:
            kind = getattr(file, "file_kind", None)
            names = {*file.variables, *file.ncattrs()}
    except OSError as error:
        raise FileError(f"{path}: cannot be read as netCDF ({error})") from error
    if kind is not None:
        return kind, True
    return next((kind for kind, own in KNOWN_BY.items() if own <= names), None), False


def read_runs(path):
    """Runs of a file of the command line or the pipeline, or the one that its user saved with `to_netcdf`.

    Parameters
    ----------
    path : path-like

    Returns
    -------
    list of xarray.Dataset
        As `ratd.spin_up`, `ratd.compress`, `ratd.stretch` or `ratd.collide` returned them. From files of ratd those of
        compressions and pulls are without the state at their end and its step of time, so that they cannot be pulled
        on, pulls also without radii, and collisions have what their tables need, N_s and X among it.

    Raises
    ------
    FileError
        If the file cannot be read, or is damaged.
    InputError
        If it holds no runs.
    """
    kind, by_ratd = kind_in(path)
    if kind not in _READERS:
        what = "holds no runs" if kind is None else f"is a file of {kind}"
        raise InputError(f"{path}: {what}; allowed: what ratd.spin_up, compress, stretch or collide returned, saved.")
    if not by_ratd:
        return [xr.load_dataset(path, engine="netcdf4", decode_times=False)]
    module, reader = _READERS[kind]
    return getattr(import_module(f"ratd.experiments.{module}"), reader)(path)
