"""The plan of the spin-up: a checked config, and which figures it wants from which files."""

from ratd.base.units import NM
from ratd.experiments.spin_up import plan_check
from ratd.experiments.spin_up.seeds import cell_of, size_label
from ratd.experiments.spin_up.settings import Settings
from ratd.pipeline import config as configs

__all__ = ["COMMON_FIGURES", "FIGURES", "GRAINS", "RUNS", "TITLES", "Plan", "check", "load"]

FIGURES = ("figure2", "figure4", "figure5", "figure6", "figure7", "figure8", "figure9")
"""Figures that are drawn for each drive."""
COMMON_FIGURES = ("figure1", "figure10", "calibration", "formulae")
"""Figures that have no drive to choose."""
ALL_FIGURES = ("figure1", "figure4", "figure5", "figure6", "figure8", "figure9", "figure10", "calibration", "formulae")
"""Keys of `figures`; figures 2 and 7 show all that there is."""
TITLES = {
    "figure1": "grains as grown",
    "figure2": "numbers, porosity, fractal dimension",
    "figure4": "one cell coming apart",
    "figure5": "one grain coming apart",
    "figure6": "shapes of the grains",
    "figure7": "angular velocity of disruption",
    "figure8": "tensile strengths",
    "figure9": "rolling displacement and viscous time",
    "figure10": "pairs that part",
    "calibration": "calibration of the drive literal",
    "formulae": "single formulae as printed",
}
"""What a figure shows, in the list of the report."""

GRAINS = "<results>/grains/{material}/{type}/{size}nm/seeds_{seeds}.nc"
RUNS = "<results>/spinup/{drive}/{material}/{type}/{size}nm/seeds_{seeds}.nc"


def load(*paths, schemas="config/schema"):
    """Plan of some config files, each of which stands over those before it; see `check`."""
    return check(configs.load(*paths), schemas)


def check(config, schemas="config/schema"):
    """Check a config as a whole.

    Parameters
    ----------
    config : dict
        The merged config.
    schemas : path-like, optional
        Folder of the JSON schemas.

    Returns
    -------
    Plan

    Raises
    ------
    InputError
        One sentence for each key that is wrong, with what is allowed.
    """
    shared, own, materials = configs.section(config, "spin_up", schemas)
    plan = Plan(configs.with_parts(own, {"figures": ALL_FIGURES}), materials, shared["results"])
    plan.notes = plan_check.leave_out_absent(plan, configs.base("spin_up", schemas))
    plan_check.check(plan, shared["materials_file"])
    return plan


class Plan(Settings):
    """A checked config, and what follows from it.

    Parameters
    ----------
    config : dict
        The checked keys of the spin-up.
    materials : dict of str to Material
        Table 2 and the materials of the user.
    results : str
        Folder of all results.

    Attributes
    ----------
    notes : list of str
        What was left out because the config has no such cells.
    """

    def __init__(self, config, materials, results):
        super().__init__(config, materials)
        self.results = results
        self.notes = []

    @property
    def figures(self):
        """Names of the figures to draw for each drive, list of str."""
        return [name for name in FIGURES if self._wants(name)]

    @property
    def common_figures(self):
        """Names of the figures to draw that do not depend on the drive, list of str."""
        return [name for name in COMMON_FIGURES if self._wants(name)]

    def _wants(self, name):
        return self.config["figures"].get(name, ()) is not None

    def figure(self, name, drive=None):
        """Settings of one figure, with its own part of the config, sizes in m."""
        if name in ("calibration", "formulae"):  # what their table says, and nothing else
            return {}
        own = self.config["figures"].get(name) or {}
        if "scaled_at_nm" in own:
            own = own | {"scaled_at": own["scaled_at_nm"] * NM}
        if "sizes_nm" in own:
            own = own | {"sizes": [size * NM for size in own["sizes_nm"]]}
        materials = {material: self.material(material) for material in self.config["materials"]}
        return {"drive": drive, "materials": materials, **own}

    def figure_input(self, name, drive=None):
        """Files that a figure is drawn from.

        Parameters
        ----------
        name : str
            One of `FIGURES` or `COMMON_FIGURES`.
        drive : str, optional

        Returns
        -------
        dict of str to (str or list of str)
            Name of the input -> files.
        """
        table, fit = (f"<results>/ensemble/{drive}/{name}.nc" for name in ("grains", "table3"))
        # What needs no spin-up is said of all grown grains, where no grain is grown for that alone.
        grown = ["<results>/ensemble/grown.nc"] if self.grows_more_anyway else []
        return {
            "figure1": lambda: {"grains": self.figure1_files(GRAINS)},
            "figure2": lambda: {"table": table},
            "figure4": lambda: {"runs": self.figure4_files(RUNS, drive)},
            "figure5": lambda: {"runs": self.figure5_files(RUNS, drive)},
            "figure6": lambda: {"table": table},
            "figure7": lambda: {"table": table, "fit": fit, "grown": grown},
            "figure8": lambda: {"table": table, "fit": fit, "grown": grown},
            "figure9": lambda: {"table": f"<results>/parameters/{drive}.nc"},
            "figure10": lambda: {"pairs": [f"<results>/pairs/{name}.nc" for name in self.config["materials"]]},
            "calibration": lambda: {"fit": "<results>/calibration/fit.nc"},
            "formulae": lambda: {"table": "<results>/formulae/table.nc"},
        }[name]()

    def figure4_files(self, path, drive=None):
        """Files of all blocks of the cell that figure 4 shows.

        Parameters
        ----------
        path : str
            With the fields ``{material}``, ``{type}``, ``{size}``, ``{seeds}``.
        drive : str, optional
            See `seeds_of`.

        Returns
        -------
        list of str
            Empty where the figure is left out.
        """
        own = self.config["figures"]["figure4"]
        if own is None:
            return []
        return self.run_files(path, cell_of(own), drive)

    def figure1_files(self, path):
        """Files with the grains that figure 1 shows, see `figure4_files`.

        A grain that no drive spins up is grown for the figure, in a block of a cell with all seeds.
        """
        own = self.config["figures"]["figure1"]
        if own is None:
            return []
        cells = [(own["material"], kind, size_label(size)) for kind in self.config["types"] for size in own["sizes_nm"]]
        return [
            self.file(path, cell, seeds=self._block_with(own["seed"], seeds, cell))
            for cell in cells
            for seeds in [self.seeds_of(cell) if own["seed"] in self.seeds_of(cell) else self.seeds]
        ]

    def figure5_files(self, path, drive=None):
        """File with the run that figure 5 shows, in a list, see `figure4_files`."""
        own = self.config["figures"]["figure5"]
        if own is None:
            return []
        cell = cell_of(own)
        block = self._block_with(own["seed"], self.seeds_of(cell, drive), cell)
        return [self.file(path, cell, drive=drive, seeds=block)]
