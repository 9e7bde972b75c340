"""Files of runs that ``python -m ratd show`` is given: those of ratd, and runs that users saved with `to_netcdf`."""

import netCDF4
import xarray as xr

from ratd.base.errors import FileError

__all__ = ["KNOWN_BY", "kind_in", "runs_in"]

KNOWN_BY = {
    "spinup": {"fragment_omega", "end_reason"},
    "stretched": {"tension", "tensile_strength"},
    "compression": {"static_from", "snapshot_phi"},
    "collisions": {"cluster", "impact_energy"},
}
"""Kind of file -> variables and attributes that only a run of this kind has, as the functions of `ratd` return it."""


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


def runs_in(path, read):
    """Runs of a file of ratd, or the one that its user saved with `to_netcdf`.

    Parameters
    ----------
    path : path-like
    read : callable
        ``read(path)`` gives the runs of a file of ratd.

    Returns
    -------
    list of xarray.Dataset
        As the functions of `ratd` return them.
    """
    return read(path) if kind_in(path)[1] else [xr.load_dataset(path, engine="netcdf4", decode_times=False)]
