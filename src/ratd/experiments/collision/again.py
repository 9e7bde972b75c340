"""Collisions made again beside those that are committed.

    python -m ratd.experiments.collision.again results/collision_default

says how many collisions of a folder of results are also in docs/collision/data, and how far X, N_s and the energy left
are apart. The status is 1 where one differs or none is in both.
"""

import sys
from pathlib import Path

import pandas as pd

from ratd.base.errors import FileError, InputError
from ratd.experiments.collision.document_plan import run_files
from ratd.experiments.collision.tables import collision_table, read_collisions

__all__ = ["beside", "main"]

CELL = ["law", "cluster", "sample", "velocity", "impact_parameter", "seed", "damping_time", "timestep", "duration"]
COMPARED = ["X", "N_s", "energy_end"]


def beside(again, committed):
    """Collisions of two tables that have the same settings, with the greatest difference of `COMPARED` of each.

    Parameters
    ----------
    again, committed : pandas.DataFrame
        `ratd.experiments.collision.tables.COLUMNS`.

    Returns
    -------
    pandas.DataFrame
        `CELL` and ``difference``.
    """
    both = again.merge(committed, on=CELL, suffixes=("", "_committed"), validate="one_to_one")
    apart = pd.concat([(both[name] - both[f"{name}_committed"]).abs() for name in COMPARED], axis=1)
    return both[CELL].assign(difference=apart.max(axis=1))


def main(words=None):
    """The command; returns the exit status."""
    words = sys.argv[1:] if words is None else words
    if len(words) != 1:
        print(
            "python -m ratd.experiments.collision.again FOLDER, a folder of results such as results/collision_default"
        )
        return 2
    try:
        paths = sorted(Path(words[0]).glob("collision/runs/*/*/*/*.nc"))
        if not paths:
            raise InputError(f"{words[0]}: has no collisions; they are made by the target collision of snakemake.")
        again = collision_table(read_collisions(paths))
        both = beside(again, collision_table(read_collisions(run_files())))
    except (InputError, FileError) as error:
        print(error, file=sys.stderr)
        return 1
    same = int((both["difference"] == 0.0).sum())
    print(f"{len(both)} of {len(again)} collisions are among the committed ones too, {same} to the last bit.")
    for row in both[both["difference"] > 0.0].to_dict("records"):
        names = f"{row['law']} {row['cluster']} sample {row['sample']} {row['velocity']:g} m/s rotation {row['seed']}"
        print(f"{names}: differs by up to {row['difference']:.2g}")
    return int(same < len(both) or not len(both))


if __name__ == "__main__":
    sys.exit(main())
