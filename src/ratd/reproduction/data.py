"""The committed data that the document is drawn from: what is there, and where.

Everything but the config may be missing: a drive, a figure, a study. What is not there is None.
"""

from dataclasses import astuple, dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import pandas as pd

from ratd import io
from ratd.beyond import LEFT_OUT, cross_validation
from ratd.calibration import CALIBRATION_COLUMNS, calibrate
from ratd.config import Plan, read_materials, read_yaml
from ratd.ensemble import size_key
from ratd.fragmentation import fragment_table
from ratd.growth import RadiusDistribution
from ratd.marks import disruption
from ratd.validation.data import FOLDER as CHECKED
from ratd.validation.data import check_table, table_path
from ratd.validation.growth import NOT

FOLDER = "docs/reproduction/data"
CONFIG = "config.yaml"
MATERIALS_SCHEMA = "config/schema/materials.schema.yaml"
GROWN = "grown.nc"
FIRM_BOUNDS = "firm_bounds.nc"
PARAMETERS = "parameters_{drive}.nc"
CALIBRATION = "calibration.nc"
FORMULAE = "formulae.nc"
FROM_RESULTS = {
    "parameters/{drive}.nc": PARAMETERS,
    "calibration/fit.nc": CALIBRATION,
    "formulae/table.nc": FORMULAE,
}
"""File of a study below the results -> its name here. A study may have been made with another config."""
STUDIES = ("lammps", "literal", "convergence", "damping", "growth")
"""Checks of the validation that the document takes numbers from."""
DRAWN_STUDIES = ("lammps", "literal")
"""Those of `STUDIES` that it has a figure of."""
DRIVEN_FIGURES = {
    4: {"runs": "figure4/{drive}.nc"},
    5: {"runs": "figure5/{drive}.nc"},
    6: {"table": "ensemble/{drive}/grains.nc"},
    7: {"table": "ensemble/{drive}/grains.nc", "fit": "ensemble/{drive}/table3.nc"},
    8: {"table": "ensemble/{drive}/grains.nc"},
    9: {"table": PARAMETERS},
}
"""Number of a figure that has a drive -> the data that it is drawn from, below the folder."""
WITH_GROWN = (7, 8)
"""Numbers of figures that tell of all grown grains too, where these are part of the data."""
COMMON_FIGURES = {1: "figure1/*.nc", 2: GROWN, 10: "pairs/*.nc"}
"""Number of a figure without a drive -> pattern of its data."""


@dataclass(frozen=True)
class Data:
    """A folder of data.

    Parameters
    ----------
    folder : str
        Such as `FOLDER`.
    checks : str
        Folder of the tables of the validation, see `ratd.validation.data`.
    """

    folder: str = FOLDER
    checks: str = CHECKED

    def path(self, name):
        """Path of a file, str."""
        return str(Path(self.folder, name))

    def has(self, name):
        """Whether a file is there."""
        return Path(self.folder, name).is_file()

    @property
    def files(self):
        """All data, list of str; none where there is no config, without which they cannot be read."""
        files = [str(path) for path in sorted(Path(self.folder).rglob("*.nc"))]
        files += [table_path(self.checks, name) for name in STUDIES if self.has_study(name)]
        return [*files, self.path(CONFIG)] if self.has(CONFIG) else []

    @cached_property
    def plan(self):
        """`ratd.config.Plan` of the config that the data were made with.

        It was checked then, and is not now: keys that came later do not matter for what is drawn.
        """
        config = read_yaml(self.path(CONFIG))
        return Plan(config, read_materials(config["materials_file"], read_yaml(MATERIALS_SCHEMA)))

    @property
    def drives(self):
        """Drives with a table of grains, in the order of the config; none without data."""
        if not self.has(CONFIG):
            return []
        return [drive for drive in self.plan.config["drives"] if self.has(f"ensemble/{drive}/grains.nc")]

    def figure_files(self, number, drive=None):
        """Data of a figure, empty where some are missing or the config leaves the figure out.

        Returns
        -------
        dict of str to str or list of str
            Name of an input -> path or paths, of which there may be none.
        """
        if self.plan.config["figures"].get(f"figure{number}", ()) is None:
            return {}
        if number in COMMON_FIGURES:
            paths = sorted(str(path) for path in Path(self.folder).glob(COMMON_FIGURES[number]))
            return {"data": paths} if paths else {}
        names = {key: name.format(drive=drive) for key, name in DRIVEN_FIGURES[number].items()}
        if not all(map(self.has, names.values())):
            return {}
        files = {key: self.path(name) for key, name in names.items()}
        if number in WITH_GROWN:
            files["grown"] = self.path(GROWN) if self.has(GROWN) else []
        return files

    @property
    def figures(self):
        """Names of the figures of the paper that can be drawn, list of str such as "figure7_literal"."""
        if not self.drives:
            return []
        names = [f"figure{number}" for number in COMMON_FIGURES if self.figure_files(number)]
        names += [f"figure{number}_{drive}" for number in DRIVEN_FIGURES for drive in self.drives
                  if self.figure_files(number, drive)]  # fmt: skip
        return names

    @property
    def further_figures(self):
        """Names of the figures that the paper does not have, as far as there are data for them, list of str."""
        names = ["overview", "bound"] if self.drives else []
        if any(self.has(f"fragments/{drive}.nc") for drive in self.drives):
            names.append("fragments")
        if not self.drives:
            return names
        names += [name for name in ("calibration", "formulae") if self.has(f"{name}.nc")]
        return names + [name for name in DRAWN_STUDIES if self.has_study(name)]

    def _each_drive(self, name, read):
        return {drive: read(self.path(name.format(drive=drive))) for drive in self.drives
                if self.has(name.format(drive=drive))}  # fmt: skip

    @cached_property
    def tables(self):
        """Drive -> table of its grains."""
        return self._each_drive("ensemble/{drive}/grains.nc", io.read_table)

    @cached_property
    def grown(self):
        """Table of the grains as grown: of all of them where that is part of the data, else of those of a drive.

        It has the column ``firm_bound`` [rad/s], see `ratd.firm_bound`, of NaN where it is not part of the data.
        """
        table = io.read_table(self.path(GROWN)) if self.has(GROWN) else max(self.tables.values(), key=len)
        if not self.has(FIRM_BOUNDS):
            return table.assign(firm_bound=np.nan)
        firm = io.read(self.path(FIRM_BOUNDS), "firm_bounds").to_dataframe()
        key = ["material", "type", "seed", "size"]
        parts = [part.assign(size=size_key(part["a_eff"])) for part in (table, firm)]
        joined = parts[0].merge(parts[1][[*key, "firm_bound"]], how="left", on=key, validate="one_to_one")
        return joined.drop(columns="size")

    @cached_property
    def alike(self):
        """More grains than the ensemble has, grown like those of it, for what is said of them as grown: table or None.

        Those of the check of growth, which has the radii that `ratd.growth.RadiusDistribution` has by default.
        """
        growth = self.plan.config["growth"]
        radii = RadiusDistribution(**self.plan.radii)
        if not self.has_study("growth") or not np.allclose(astuple(radii), astuple(RadiusDistribution()), atol=0.0):
            return None
        table = self.study("growth")
        return table[(table["study"] == "grains") & table["migration"].isin([growth["migration"], NOT])]

    @cached_property
    def at_rest(self):
        """Grains for what is said of them as grown, a table: `alike` where that has no fewer of a type and size.

        If it has fewer of any that were grown, all are those of `grown`. Columns material, type, a_eff, n_monomers,
        porosity, fractal_dimension, axis_a, axis_b, axis_c are there in both cases.
        """
        if self.alike is None:
            return self.grown
        own, other = (_type_and_size(table) for table in (self.grown, self.alike))
        fewest, number = own.value_counts(), other.value_counts()
        if (number.reindex(fewest.index, fill_value=0) < fewest).any():
            return self.grown
        return self.alike[other.isin(fewest.index)]

    @cached_property
    def fits(self):
        """Drive -> fit of Eq. 33 beside Table 3."""
        return self._each_drive("ensemble/{drive}/table3.nc", io.read_fit)

    @cached_property
    def predictions(self):
        """Drive -> what grains are left out by -> scatter of the predictors, see `ratd.beyond.cross_validation`."""
        return {
            drive: {by: cross_validation(table, by=by, materials=self.plan.materials) for by in LEFT_OUT}
            for drive, table in self.tables.items()
        }

    @cached_property
    def fragments(self):
        """Drive -> table of fragments, see `ratd.fragmentation.fragment_table`."""
        return self._each_drive("fragments/{drive}.nc", lambda path: fragment_table(io.read(path, "fragments")))

    @cached_property
    def course(self):
        """Drive -> spin-up runs of the cell of Fig. 4 and their marks, list of pairs of datasets."""
        return self._each_drive("figure4/{drive}.nc", _marked_runs)

    @cached_property
    def shown(self):
        """Drive -> spin-up run of the grain of Fig. 5 and its marks, in a list."""
        return self._each_drive("figure5/{drive}.nc", _marked_runs)

    @cached_property
    def grains(self):
        """Grains of Fig. 1, list of `ratd.Grain`."""
        paths = self.figure_files(1).get("data", []) if self.drives else []
        return [grain for path in paths for grain in io.read_grains(path)]

    @cached_property
    def pairs(self):
        """Pairs of Fig. 10, a table, or None."""
        paths = sorted(Path(self.folder, "pairs").glob("*.nc"))
        return (
            pd.concat([io.read(path, "pairs").to_dataframe() for path in paths], ignore_index=True) if paths else None
        )

    @cached_property
    def parameters(self):
        """Drive -> table of the study of xi_c and T_vis (Fig. 9)."""
        return self._each_drive(PARAMETERS, lambda path: io.read(path, "parameters").to_dataframe())

    @cached_property
    def calibration(self):
        """Calibration of the drive literal, a Dataset, or None. The fit is made anew from the runs in the file."""
        if not self.has(CALIBRATION):
            return None
        found = io.read(self.path(CALIBRATION), "calibration")
        runs = found[list(CALIBRATION_COLUMNS)]
        return runs.merge(calibrate(runs.to_dataframe(), found["omega_onset"].item()))

    @cached_property
    def formulae(self):
        """Grains spun up with single formulae as printed, a table, or None."""
        return io.read(self.path(FORMULAE), "formulae").to_dataframe() if self.has(FORMULAE) else None

    def has_study(self, name):
        """Whether the table of a check of the validation is there."""
        return Path(table_path(self.checks, name)).is_file()

    def study(self, name):
        """Table of a check of the validation, one of `STUDIES`, or None."""
        return check_table(self.checks, name) if self.has_study(name) else None


def _type_and_size(table):
    return pd.MultiIndex.from_arrays([table["type"], size_key(table["a_eff"])])


def _marked_runs(path):
    """Spin-up runs of a file, each with its marks."""
    return [(run, disruption(run)) for run in io.read_runs(path)]
