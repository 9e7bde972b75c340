"""Collect from the results of a run of the pipeline what the document is drawn from, a few MB."""

import shutil
from pathlib import Path

import xarray as xr
import yaml

from ratd import io
from ratd.figures.figure5 import nearest_snapshots
from ratd.fragmentation import fragmentation, join
from ratd.markdown import markdown_table
from ratd.marks import disruption
from ratd.provenance import file_hash, settings_hash
from ratd.reproduction.data import CONFIG
from ratd.units import NM

README = "README.md"


class Collection:
    """A folder of data in the making.

    Parameters
    ----------
    folder : path-like
    config : dict
        The config that the results were made with.
    provenance : dict
        Attributes of files that are made here, from `ratd.provenance.provenance`.

    Attributes
    ----------
    written : dict of str to str
        Name of a file below the folder -> what it holds.
    """

    def __init__(self, folder, config, provenance):
        self.folder, self.config, self.provenance = Path(folder), config, provenance
        self.written = {}
        self._cells = {name: self._cell(config["figures"].get(name)) for name in ("figure4", "figure5")}
        io.write_text(self._new(CONFIG, "the config"), yaml.safe_dump(config, sort_keys=False, allow_unicode=True))

    @staticmethod
    def _cell(own):
        return own and (own["material"], own["type"], round(own["size_nm"], 6))

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
            dataset = io.block(rows, "grains", material, self.provenance)
            io.write(self._new(f"figure1/{kind}.nc", f"grains of Fig. 1, {kind}"), dataset, "grains")

    def runs(self, paths, drive):
        """Of all spin-ups of a drive the fragments; the records of the cell of figure 4; the pictures of figure 5."""
        rows, course = [], []
        for path in paths:
            file = io.read(path, "spinup")
            cell = (file.attrs["material"], file.attrs["type"])
            for run in io.runs(file):
                mark = disruption(run)
                rows.append(fragmentation(run, mark))
                here = (*cell, round(run.attrs["a_eff"] / NM, 6))
                if here == self._cells["figure4"]:
                    course.append((io.material_of(file), _without_snapshots(run)))
                if here == self._cells["figure5"] and run.attrs["seed"] == self.config["figures"]["figure5"]["seed"]:
                    shown = [(io.material_of(file), _shown(run, mark))]
                    self._write_runs(f"figure5/{drive}.nc", f"the run of Fig. 5, drive {drive}", shown)
        dataset = join(rows).assign_attrs(drive=drive, **self.provenance)
        what = f"fragments that leave until half of the mass has left, drive {drive}"
        io.write(self._new(f"fragments/{drive}.nc", what), dataset, "fragments")
        if course:
            self._write_runs(f"figure4/{drive}.nc", f"the runs of Fig. 4, drive {drive}", course)

    def _write_runs(self, name, what, runs):
        material = runs[0][0]
        dataset = io.block([io.run_row(run) for _, run in runs], "spinup", material, self.provenance)
        io.write(self._new(name, what), dataset, "spinup")

    def tables(self, paths, kind, name, what):
        """Several files of tables of one kind as one file."""
        parts = [io.read(path, kind) for path in paths]
        joined = xr.concat(parts, dim=next(iter(parts[0].sizes)), data_vars="all").drop_attrs()
        io.write(self._new(name, what), joined.assign_attrs(self.provenance), kind)

    def finish(self, command):
        """Remove data of an earlier collection, and write the README of the folder.

        Studies and checks of the validation stay: they may come from other results than the ensemble.
        """
        for path in sorted(self.folder.rglob("*.nc")):
            name = str(path.relative_to(self.folder))
            if name in self.written:
                continue
            if path.parent == self.folder or path.parent.name == "validation":
                self.written[name] = "as it was before this collection"
            else:
                path.unlink()
        rows = [
            [f"`{name}`", what, f"{(self.folder / name).stat().st_size / 1e3:.1f}", file_hash(self.folder / name)]
            for name, what in sorted(self.written.items())
        ]
        text = TEXT.format(
            command=command,
            code=self.provenance["code_hash"],
            config=settings_hash(self.config),
            versions=self.provenance["versions"],
            table=markdown_table(["file", "what it holds", "kB", "hash"], rows),
        )
        io.write_text(self.folder / README, text)


TEXT = """# Data behind docs/reproduction.md

Collected by

    {command}

from the results of the pipeline with the config that stands in `config.yaml` (hash {config}). Source of the collection:
{code}. {versions}. Each netCDF file names in its attributes the settings, the hash of the source and of the
inputs that it was made with; files of the pipeline are copied as they are. `snakemake --cores 2 redraw` draws all
figures and writes docs/reproduction.md from these files alone.

{table}
"""


def _without_snapshots(run):
    """A run without its snapshots."""
    return run.drop_dims(["snapshot", "monomer"], errors="ignore")


def _shown(run, mark):
    """A run with only the snapshots that figure 5 shows; all of them where it is not known which those are."""
    omega_disr = float(mark["omega_disr"])
    if not omega_disr > 0:
        return run
    return run.isel(snapshot=sorted(set(nearest_snapshots(run, omega_disr))))
