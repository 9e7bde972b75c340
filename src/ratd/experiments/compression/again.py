"""Compressions made again beside those that are committed.

    python -m ratd.experiments.compression.again results/compression_default

says of each set of a folder of results how many of its clusters are also in docs/compression/data, and how far their
pressures are apart. The status is 1 where one differs or none is in both.
"""

import sys
from pathlib import Path

import numpy as np

from ratd.base.errors import FileError, InputError
from ratd.base.words import plural
from ratd.experiments.compression.document import DATA
from ratd.experiments.compression.tables import shared_bins
from ratd.pipeline import io

__all__ = ["COMPARED", "beside", "main"]

COMPARED = ("pressure", "n_contacts", "work")


def beside(again, committed):
    """Clusters of two tables of a set, each with the greatest difference of its curves.

    Parameters
    ----------
    again, committed : xarray.Dataset
        Of the kind ``compression_set``.

    Returns
    -------
    dict of int to float
        Seed -> greatest difference of a quantity of `COMPARED` over its greatest value, where both have one, of the
        seeds of both tables.

    Raises
    ------
    InputError
        If the two have other bins of the filling factor.
    """
    # one of fewer clusters may begin or end elsewhere
    places = shared_bins(again, committed)
    phi = [table["phi"].values[at] for table, at in zip((again, committed), places, strict=True)]
    if not len(phi[0]) or not np.allclose(*phi, rtol=1e-9):
        raise InputError("the sets have other bins of the filling factor; nothing can be compared.")
    rows = [{seed: k for k, seed in enumerate(table["seed"].values.tolist())} for table in (again, committed)]
    found = {}
    for seed in sorted(rows[0].keys() & rows[1].keys()):
        apart = []
        for name in COMPARED:
            own, other = (
                table[name].values[row[seed], at]
                for table, row, at in zip((again, committed), rows, places, strict=True)
            )
            both = np.isfinite(own) & np.isfinite(other)
            if both.any():
                apart.append(np.abs(own[both] - other[both]).max() / np.abs(other[both]).max())
        found[seed] = float(max(apart, default=np.nan))
    return found


def main(words=None):
    """The command; returns the exit status."""
    words = sys.argv[1:] if words is None else words
    if len(words) != 1:
        print(
            "python -m ratd.experiments.compression.again FOLDER, a folder of results such as "
            "results/compression_default"
        )
        return 2
    all_same, any_found = True, False
    try:
        paths = [path for path in sorted(Path(words[0], "compression").glob("*.nc")) if path.stem != "snapshots"]
        if not paths:
            raise InputError(f"{words[0]}: has no sets; they are made by the target compression_tables of snakemake.")
        for path in paths:
            there = DATA / "sets" / path.name
            if not there.is_file():
                print(f"{path.stem}: is not among the committed sets")
                continue
            found = beside(io.read(path, "compression_set"), io.read(there, "compression_set"))
            same = sum(difference == 0.0 for difference in found.values())
            any_found |= bool(found)
            all_same &= same == len(found)
            print(f"{path.stem}: {plural(len(found), 'cluster')} in both, {same} of them the same to the last bit")
            for seed, difference in found.items():
                if difference != 0.0:
                    print(f"{path.stem}: seed {seed} differs by up to {difference:.2g} of the greatest value")
    except (InputError, FileError) as error:
        print(error, file=sys.stderr)
        return 1
    return int(not (all_same and any_found))


if __name__ == "__main__":
    sys.exit(main())
