"""The tables of the ensemble, from the files of its grains: the stages `ensemble` and `grown` of the pipeline."""

from ratd.experiments.spin_up.cells import cell_statistics
from ratd.experiments.spin_up.eq33 import fit_as_configured, table3, table3_dataset
from ratd.experiments.spin_up.grain_table import grain_table, table_dataset
from ratd.experiments.spin_up.run_files import read_marks
from ratd.geometry.shape import spin_share
from ratd.pipeline import io
from ratd.pipeline.blocks import rows

__all__ = ["ensemble", "grown", "read_grain_columns"]


def read_grain_columns(path):
    """What a file of grains says of each, without its monomers.

    Parameters
    ----------
    path : path-like

    Returns
    -------
    list of xarray.Dataset
        Scalars, with material and type. The share of the monomers in the moment of inertia, `spin_share`, is added: it
        needs their radii.
    """
    file = io.read(path, "grains")
    return [
        row.drop_dims("monomer").assign(
            spin_share=spin_share(row["radius"].values, file["density"].item(), row["moment_1"].item())
        )
        for row in rows(file, "grains")
    ]


def ensemble(files, settings, say):
    """All grains that a drive spins up, averages of its cells, and the fit of Eq. 33 beside Table 3.

    Parameters
    ----------
    files : mapping
        ``grains`` and ``marks``, lists of files.
    settings : dict
        ``drive``, and those of `ratd.experiments.spin_up.eq33.fit_as_configured`.
    say : callable
        Called with a sentence.

    Returns
    -------
    dict
        Name of an output -> what it holds.
    """
    grains = [row for path in files["grains"] for row in read_grain_columns(path)]
    table = grain_table(grains, [row for path in files["marks"] for row in read_marks(path)])
    # another drive may want more grains than this one
    table = table[table["drive"] == settings["drive"]].reset_index(drop=True)
    cells = cell_statistics(table)
    fit = fit_as_configured(table, settings)
    say(f"{len(table)} grains in {len(cells)} cells; {fit.attrs['missing_fits'] or 'all fits made'}")
    return {
        "table": table_dataset(table, "grain"),
        "table_csv": table,
        "cells": table_dataset(cells, "cell"),
        "cells_csv": cells,
        "fit": table3_dataset(fit),
        "fit_csv": table3(fit),
    }


def grown(files, settings, say):
    """All grains of the config as grown, those too that no drive spins up. Parameters as of `ensemble`."""
    table = grain_table([row for path in files for row in read_grain_columns(path)])
    say(f"{len(table)} grains")
    return {"table": table_dataset(table, "grain"), "table_csv": table}
