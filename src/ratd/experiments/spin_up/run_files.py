"""Files of the spin-up: how runs are written, and how runs, marks, tables and fits are read.

Every reader names what is wrong with a damaged or foreign file, see `ratd.pipeline.io.read`.
"""

from ratd.base.errors import InputError
from ratd.experiments.made_with import constants_of
from ratd.pipeline import io
from ratd.pipeline.blocks import material_of, rows
from ratd.pipeline.kinds import MATERIAL

__all__ = ["read_fit", "read_grown", "read_marks", "read_runs", "read_table", "run_of_seed", "run_row", "runs"]


def run_row(run):
    """Row of a spin-up run in a file of spin-ups.

    Parameters
    ----------
    run : xarray.Dataset
        From `ratd.spin_up`.

    Returns
    -------
    xarray.Dataset
        The run, with what is over (snapshot, monomer) along one dimension `snapshot_monomer`.
    """
    flat = [name for name in run.variables if run[name].dims == ("snapshot", "monomer")]
    row = run.drop_vars(flat)
    # which a file has once, beside the rows
    row.attrs = {name: value for name, value in run.attrs.items() if name not in MATERIAL}
    for name in flat:
        row[name] = ("snapshot_monomer", run[name].values.ravel(), run[name].attrs)
    return row


def runs(dataset):
    """Runs of a file of spin-ups.

    Parameters
    ----------
    dataset : xarray.Dataset
        From `ratd.pipeline.io.read`.

    Returns
    -------
    list of xarray.Dataset
        As `ratd.spin_up` returns them; ``law`` is not in files of before ratd named it there.
    """
    result = []
    told = {name: dataset.attrs[name] for name in ("source", "law") if name in dataset.attrs}
    about = constants_of(material_of(dataset)) | told
    for row in rows(dataset, "spinup"):
        flat = [name for name in row.variables if row[name].dims == ("snapshot_monomer",)]
        run = row.drop_vars(flat)
        if row.sizes["snapshot"] == 0:
            run = run.drop_dims(["snapshot", "monomer"])
        else:
            shape = row.sizes["snapshot"], row.sizes["monomer"]
            for name in flat:
                run[name] = (("snapshot", "monomer"), row[name].values.reshape(shape), row[name].attrs)
        run.attrs |= about
        result.append(run)
    return result


def read_runs(path):
    """Spin-up runs of a file, list of datasets as `ratd.spin_up` returns them."""
    return runs(io.read(path, "spinup"))


def read_marks(path):
    """Marks of the grains of a file, list of datasets as `ratd.disruption` returns them."""
    return rows(io.read(path, "disruption"), "disruption")


def run_of_seed(paths, seed):
    """The spin-up run of one seed, among those of some files."""
    found = [run for path in paths for run in read_runs(path) if run.attrs["seed"] == seed]
    if not found:
        raise InputError(f"{', '.join(map(str, paths))}: no run has the seed {seed}")
    return found[0]


def read_table(path):
    """Table of all grains, a file ``grains.nc`` of the pipeline.

    Parameters
    ----------
    path : path-like

    Returns
    -------
    pandas.DataFrame
        A row a grain; `ratd.fit_ensemble` takes it.

    Raises
    ------
    FileError
        If there is none, it is damaged, or no such table.
    """
    return io.read(path, "table").to_pandas()


def read_grown(paths):
    """Table of all grown grains where there is one, in a list of at most one file; else None."""
    return read_table(paths[0]) if paths else None


def read_fit(path):
    """Fit of Eq. 33, xarray.Dataset, as `eq33.table3_dataset` made it."""
    return io.read(path, "fit")
