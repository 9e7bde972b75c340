"""Which grains the data of the document hold already, so that only the others have to be spun up.

The ensemble takes days of computing, in pieces, and what its spin-ups write takes gigabytes, which nobody keeps as long
as the data of a few MB that are collected from it. So the data themselves say what they hold: a table of text,
`INDEX`, with a line for each row of seeds that were made alike. A grain counts as collected where the config in use
would grow and spin it up with the same settings; the source may have changed since, and stands in the table.
"""

import csv
from collections import Counter
from dataclasses import astuple, dataclass, fields, replace
from io import StringIO
from itertools import groupby
from pathlib import Path

import numpy as np

from ratd import io
from ratd.config import cell_of, consecutive, size_label
from ratd.errors import InputError
from ratd.provenance import settings_hash
from ratd.units import NM

INDEX = "collected.csv"
AT_REST = "none"
"""Stands for the drive of grains that are grown, and not spun up."""
RECORDS, SNAPSHOTS = "records", "snapshots"
"""What the data may hold of a spin-up besides its marks and fragments."""


@dataclass(frozen=True)
class Origin:
    """How one grain of the data was made.

    Attributes
    ----------
    settings : str
        Hash of all settings of its growth and spin-up.
    source : str
        Hash of the source that grew it, or that spun it up.
    marks_source : str
        Hash of the source that found the marks; empty for a grain at rest.
    also : str
        `RECORDS`, `SNAPSHOTS`, both with a blank between them, or nothing.
    """

    settings: str
    source: str
    marks_source: str = ""
    also: str = ""


COLUMNS = ["drive", "material", "type", "size_nm", "first_seed", "last_seed", *(part.name for part in fields(Origin))]
"""Columns of the index."""


class Collected:
    """The grains of a folder of data that need not be made again for a config.

    Parameters
    ----------
    folder : path-like
        See `ratd.reproduction.data.Data`; it may have no index yet.
    plan : ratd.config.Plan

    Attributes
    ----------
    grains : dict of tuple to dict
        (drive, material, type, size), `AT_REST` for a drive and the size as in `Plan.sizes` -> seed -> `Origin`.

    Raises
    ------
    InputError
        If the index is damaged.
    """

    def __init__(self, folder, plan):
        self._path, self._plan = Path(folder, INDEX), plan
        self.grains = {}
        known = {(drive, *cell) for drive in (AT_REST, *plan.config["drives"]) for cell in plan.cells}
        for place, seeds, origin in self._lines():
            if place not in known or origin.settings != self._settings(place):
                continue
            for seed in seeds:
                also = self.shown(place, seed)
                if also <= set(origin.also.split()):
                    self.grains.setdefault(place, {})[seed] = replace(origin, also=_words(also))

    def _settings(self, place):
        drive, *cell = place
        own = {"grow": self._plan.grow(*cell)}
        if drive != AT_REST:
            own["spin_up"] = {"drive": drive} | self._plan.spin_up_of(drive, cell[1])
        return settings_hash(own)

    def _lines(self):
        """The lines of the index, each as a place, seeds, and `Origin`."""
        if not self._path.is_file():
            return
        with open(self._path, encoding="utf-8", newline="") as handle:
            lines = csv.reader(handle)
            if next(lines, None) != COLUMNS:
                raise InputError(f"{self._path}: is damaged in line 1; allowed: {','.join(COLUMNS)}")
            for line in lines:
                first, last = line[4:6] if len(line) == len(COLUMNS) else ("", "")
                if not (first.isdigit() and last.isdigit()):
                    raise InputError(
                        f"{self._path}: is damaged in line {lines.line_num}; allowed: a value for each column, "
                        "whole numbers for the seeds"
                    )
                yield tuple(line[:4]), range(int(first), int(last) + 1), Origin(*line[6:])

    def write(self):
        """Write the index."""
        rows = [COLUMNS]
        for place, grains in sorted(self.grains.items(), key=lambda item: (*item[0][:3], float(item[0][3]))):
            for origin, alike in groupby(sorted(grains), key=grains.get):
                rows += [[*place, part[0], part[-1], *astuple(origin)] for part in consecutive(alike)]
        text = StringIO()
        csv.writer(text, lineterminator="\n").writerows(rows)
        io.write_text(self._path, text.getvalue())

    def add(self, drive, cell, seed, source, marks_source=""):
        """Note a grain that is now part of the data."""
        place = (drive, *cell)
        origin = Origin(self._settings(place), source, marks_source, _words(self.shown(place, seed)))
        self.grains.setdefault(place, {})[seed] = origin

    def seeds(self, drive, cell):
        """Seeds of a cell that are there with all that the figures show of them, set of int."""
        return set(self.grains.get((drive, *cell), ()))

    def keys(self, drive, also=""):
        """Keys of the grains of a drive, set of tuples (see `grain_key`); of those with `also`, if given."""
        return {
            (*place[1:], seed)
            for place, grains in self.grains.items()
            for seed, origin in grains.items()
            if place[0] == drive and (not also or also in origin.also.split())
        }

    def shown(self, place, seed):
        """What the figures show of a grain besides its marks.

        Parameters
        ----------
        place : tuple of str
            (drive, material, type, size).
        seed : int

        Returns
        -------
        set of str
            `RECORDS`, `SNAPSHOTS`.
        """
        drive, *cell = place
        if drive == AT_REST:
            return set()
        figure4, figure5 = (self._plan.config["figures"][name] for name in ("figure4", "figure5"))
        wanted = set()
        if figure4 is not None and tuple(cell) == cell_of(figure4):
            wanted.add(RECORDS)
        if figure5 is not None and (*cell, seed) == (*cell_of(figure5), figure5["seed"]):
            wanted.add(SNAPSHOTS)
        return wanted

    @property
    def grown(self):
        """Whether all grains of the config are there as grown."""
        return all(self.seeds(AT_REST, cell) >= set(self._plan.seeds) for cell in self._plan.cells)

    def missing(self, drive):
        """Blocks of grains that the config wants to be spun up and that are not there.

        Returns
        -------
        list of tuple
            (cell, block), see `ratd.config.Plan.blocks`. A block of which a part is there is cut shorter, but not for
            a GPU.
        """
        found = []
        for cell in self._plan.cells_of(drive):
            there = self.seeds(drive, cell)
            if self._plan.config["engine"] == "cuda" and not there >= set(self._plan.seeds_of(cell, drive)):
                there = ()  # one job has all blocks of a cell and more
            found += [(cell, block) for block in self._plan.blocks(cell, drive, without=there)]
        return found

    @property
    def blocks(self):
        """Names of all blocks that are missing, sorted list of str."""
        return sorted({block for drive in self._plan.config["drives"] for _, block in self.missing(drive)})

    def summary(self):
        """How many grains come from which source, list of (drive, number, source, source of the marks)."""
        counts = Counter(
            (place[0], origin.source, origin.marks_source)
            for place, grains in self.grains.items()
            for origin in grains.values()
        )
        return [(drive, number, *sources) for (drive, *sources), number in sorted(counts.items())]


def grain_key(values):
    """What names a grain of one drive: (material, type, size, seed), the size as in `Plan.sizes`.

    Parameters
    ----------
    values : mapping
        With material, type, a_eff [m] and seed, e.g. a row of a table, or a dataset of scalars.
    """
    material, kind, a_eff, seed = (np.asarray(values[name]).item() for name in ("material", "type", "a_eff", "seed"))
    return material, kind, size_label(round(a_eff / NM, 6)), seed


def table_keys(table):
    """Key of each grain of a table (a DataFrame) in its order, list of tuples, see `grain_key`."""
    return [grain_key(row) for row in table.to_dict("records")]


def _words(names):
    return " ".join(sorted(names))
