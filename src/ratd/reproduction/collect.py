"""Collect from the results of a run of the pipeline what the document is drawn from, a few MB."""

import json
import shutil
from pathlib import Path

import pandas as pd
import yaml

from ratd import io
from ratd.ensemble import GRAIN_COLUMNS, fit_as_configured, grain_table, sort_cells, table3_dataset, table_dataset
from ratd.errors import FileError, InputError
from ratd.figures.figure5 import nearest_snapshots
from ratd.fragmentation import fragmentation, join
from ratd.markdown import markdown_table
from ratd.marks import disruption
from ratd.provenance import file_hash, settings_hash, source_hash
from ratd.reproduction.collected import AT_REST, INDEX, RECORDS, SNAPSHOTS, Collected, grain_key, table_keys
from ratd.reproduction.data import CALIBRATION, CONFIG, GROWN
from ratd.reproduction.kept import read_kept

README = "README.md"
KEPT = "as it was before this collection"
REFITTED = {CALIBRATION: "; the document makes its fit anew from its runs"}


class Collection:
    """A folder of data in the making.

    Grains that are there already and that the config would make alike stay, next to the new ones.

    Parameters
    ----------
    folder : path-like
    plan : ratd.config.Plan
        Of the config that the results were made with.
    provenance : dict
        Attributes of files that are made here, from `ratd.provenance.provenance`.

    Attributes
    ----------
    collected : ratd.reproduction.collected.Collected
        The grains of the folder.
    written : dict of str to str
        Name of a file below the folder -> what it holds.
    """

    def __init__(self, folder, plan, provenance):
        self.folder, self.plan, self.provenance = Path(folder), plan, provenance
        self.collected = Collected(folder, plan)
        # what will not stay is forgotten first: after a kill no grain may be said to be there that is not
        self.collected.write()
        self.written = {}
        text = yaml.safe_dump(plan.config, sort_keys=False, allow_unicode=True)
        io.write_text(self._new(CONFIG, "the config"), text)

    def _new(self, name, what):
        self.written[name] = what
        return self.folder / name

    def copy(self, source, name, what):
        """Copy a file of the results as it is."""
        with io.atomic(self._new(name, what)) as temporary:
            shutil.copyfile(source, temporary)

    def grains(self, paths, seed):
        """The grains of figure 1: one file a type, of each size the grain of this seed."""
        by_type = {}
        for path in paths:
            file = io.read(path, "grains")
            rows = [row for row in io.rows(file, "grains") if row["seed"].item() == seed]
            by_type.setdefault(file.attrs["type"], (io.material_of(file), []))[1].extend(rows)
        for kind, (material, rows) in by_type.items():
            dataset = io.block(rows, "grains", material)
            self._write(f"figure1/{kind}.nc", f"grains of Fig. 1, {kind}", dataset, "grains")

    def grown(self, path=None):
        """Copy the table of all grains as grown; without one, that of the folder stays."""
        if path is None:
            self.written[GROWN] = KEPT
            return
        self.copy(path, GROWN, "all grains of the config as grown")
        for cell in self.plan.cells:
            self.collected.grains.pop((AT_REST, *cell), None)
        file = io.read(path, "table")
        for *cell, seed in table_keys(file.to_pandas()):
            self.collected.add(AT_REST, cell, seed, file.attrs["code_hash"])

    def runs(self, paths, drive):
        """Take all spin-ups of a drive: marks and fit, fragments, the records and pictures that figures show.

        Parameters
        ----------
        paths : list of path-like
            Files of spin-ups. They may lack grains that the folder has.
        drive : str
        """
        kept = read_kept(self.folder, drive, self.collected)
        marks, fragments, course, pictures = {}, kept.fragments, kept.course, kept.pictures
        marks_source = source_hash(modules=["ratd.marks"])
        for path in paths:
            file = io.read(path, "spinup")
            self._check_law(path, file)
            for run in io.runs(file):
                key = grain_key(run.attrs)
                marks[key] = disruption(run)
                fragments[key] = fragmentation(run, marks[key])
                shown = self.collected.shown((drive, *key[:3]), key[3])
                if RECORDS in shown:
                    course[key] = run.drop_dims(["snapshot", "monomer"], errors="ignore")
                if SNAPSHOTS in shown:
                    pictures[key] = _shown(run, marks[key])
                self.collected.add(drive, key[:3], key[3], file.attrs["code_hash"], marks_source)
        table = self._table(kept.table, marks)
        self._write(f"ensemble/{drive}/grains.nc", f"all grains, drive {drive}", table_dataset(table), "table")
        fit = table3_dataset(fit_as_configured(table, self.plan.ensemble(drive)))
        self._write(f"ensemble/{drive}/table3.nc", f"fit of Eq. 33, drive {drive}", fit, "fit")
        what = f"fragments that leave until half of the mass has left, drive {drive}"
        joined = join([fragments[key] for key in table_keys(table)]).assign_attrs(drive=drive)
        self._write(f"fragments/{drive}.nc", what, joined, "fragments")
        for number, runs in ((4, course), (5, pictures)):
            if runs:
                what = f"the spin-ups of Fig. {number}, drive {drive}"
                material = self.plan.materials[next(iter(runs))[0]]
                rows = io.block([io.run_row(runs[key]) for key in sorted(runs)], "spinup", material)
                self._write(f"figure{number}/{drive}.nc", what, rows, "spinup")

    def _check_law(self, path, file):
        """Raise FileError where a file was made with another law than the config has: it would be taken for the new."""
        made = json.loads(file.attrs["settings"])
        for name, wanted in self.plan.spin_up_of(made["drive"], file.attrs["type"]).items():
            if made[name] != wanted:
                raise FileError(
                    f"{path}: was made with {name} = {made[name]!r}, but the config has {wanted!r}; "
                    "allowed: results of this config (remove the file to make it anew)"
                )

    def _table(self, old, marks):
        """Table of the grains with new marks, and of those of an older table that have none."""
        parts = []
        if old is not None:
            parts.append(old[[key not in marks for key in table_keys(old)]])
        if marks:
            grown = io.read_table(self.folder / GROWN)[list(GRAIN_COLUMNS)]
            parts.append(grain_table(grown[[key in marks for key in table_keys(grown)]], list(marks.values())))
        if not parts:
            raise InputError(f"{self.folder}: there is no spin-up to collect, and none from before")
        return sort_cells(pd.concat(parts, ignore_index=True))

    def _write(self, name, what, dataset, kind):
        io.write(self._new(name, what), dataset.assign_attrs(self.provenance), kind)

    def tables(self, paths, kind, name, what):
        """Several files of tables of one kind as one file."""
        self._write(name, what, io.join_tables([io.read(path, kind) for path in paths]), kind)

    def finish(self, command):
        """Remove data of an earlier collection, and write the index and the README of the folder.

        Studies stay: they may come from other results than the ensemble.
        """
        for path in sorted(self.folder.rglob("*.nc")):
            name = str(path.relative_to(self.folder))
            if name in self.written:
                continue
            if path.parent == self.folder:
                self.written[name] = KEPT + REFITTED.get(name, "")
            else:
                path.unlink()
        self.collected.write()
        self.written[INDEX] = "which grains are there, and what made them"
        rows = [
            [f"`{name}`", what, f"{(self.folder / name).stat().st_size / 1e3:.1f}", file_hash(self.folder / name)]
            for name, what in sorted(self.written.items())
        ]
        text = TEXT.format(
            command=command,
            code=self.provenance["code_hash"],
            config=settings_hash(self.plan.config),
            versions=self.provenance["versions"],
            index=INDEX,
            sources=markdown_table(["drive", "grains", "source", "source of the marks"], self.collected.summary()),
            table=markdown_table(["file", "what it holds", "kB", "hash"], rows),
        )
        io.write_text(self.folder / README, text)


TEXT = """# Data behind docs/reproduction.md

Collected by

    {command}

from the results of the pipeline with the config that stands in `config.yaml` (hash {config}). Source of the collection:
{code}. {versions}. Each netCDF file names in its attributes the settings, the hash of the source and of the inputs that
it was made with; files of the pipeline are copied as they are. `snakemake --cores 2 redraw` draws all figures and
writes docs/reproduction.md from these files and those of docs/validation/data alone.

The ensemble was computed in pieces. The same command spins up only what the config wants and `{index}` does not name,
and adds it to what is here; grains that another config or another law would make are dropped. Grains that were spun up
by older source stay until they are dropped from `{index}`:

{sources}

{table}
"""


def _shown(run, mark):
    """A run with only the snapshots that figure 5 shows; all of them where it is not known which those are."""
    omega_disr = float(mark["omega_disr"])
    if not omega_disr > 0:
        return run
    return run.isel(snapshot=sorted(set(nearest_snapshots(run, omega_disr))))
