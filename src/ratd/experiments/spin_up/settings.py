"""Settings of every job of the spin-up, from its config: in SI units, and nothing but what the output depends on."""

from dataclasses import asdict
from itertools import product

from ratd.base.units import NM, PS
from ratd.experiments.spin_up.formulae import DAMPING, FORMULAE
from ratd.experiments.spin_up.parameters import ways
from ratd.experiments.spin_up.seeds import Cells, size_label
from ratd.pipeline.places import seeds_of

__all__ = ["Settings"]


def _calibration_label(run):
    return f"{run['angular_acceleration']:.6g}_{run['timestep_factor']:g}"


def _seeds(own):
    """All seeds of a study, list of int."""
    return list(range(own["seeds"]["first"], own["seeds"]["first"] + own["seeds"]["number"]))


class Settings(Cells):
    """Settings of the jobs, one method a stage.

    Parameters
    ----------
    config : dict
        The checked keys of the spin-up.
    materials : dict of str to Material
        Table 2 and the materials of the user.
    """

    def __init__(self, config, materials):
        super().__init__(config)
        self.materials = materials

    @property
    def snapshot_grains(self):
        """Grains whose positions are kept, list of dict; empty where snapshots is null."""
        return (self.config["snapshots"] or {"grains": []})["grains"]

    @property
    def radii(self):
        """Arguments of `ratd.aggregates.radii.RadiusDistribution` [m]."""
        growth = self.config["growth"]
        return {
            "median": growth["median_nm"] * NM,
            "sigma_ln": growth["sigma_ln"],
            "smallest": growth["smallest_nm"] * NM,
            "largest": growth["largest_nm"] * NM,
        }

    def material(self, name):
        """Constants of a material, dict of the arguments of `ratd.base.materials.Material`."""
        return asdict(self.materials[name])

    def growth(self, material, kind):
        """Settings of the growth that all sizes of a material and type have in common."""
        return {
            "material": self.material(material),
            "type": kind,
            "radii": self.radii,
            "migration": self.config["growth"]["migration"],
        }

    def grow(self, material, kind, size):
        """Settings of the growth of one cell."""
        return self.growth(material, kind) | {"a_eff": float(size) * NM}

    def spin_up_of(self, drive, kind=None):
        """Part of the config on the spin-up, for one drive.

        ``epsilon`` is that of a type, a number or None; with no type given as it stands in the config, where it may be
        a mapping from type to number. ``law`` is there only where one is named, so that nothing else depends on it.
        """
        own = self.config["run"] | (self.config["literal"] if drive == "literal" else {})
        if own.get("law") is None:
            own.pop("law", None)
        if kind is not None and isinstance(own["epsilon"], dict):
            own["epsilon"] = own["epsilon"].get(kind)
        return own

    def pace(self, drive):
        """How fast a drive spins up, in words, such as ``"epsilon = 0.01"``."""
        own = self.spin_up_of(drive)
        if own["stretch"] is not None:
            return f"stretch = {own['stretch']:g} m"
        epsilon = own["epsilon"]
        if isinstance(epsilon, dict):
            return "epsilon = " + ", ".join(f"{epsilon[kind]:g} ({kind})" for kind in self.config["types"])
        if epsilon is not None:
            return f"epsilon = {epsilon:g}"
        return f"d omega/dt = {own['angular_acceleration']:.3g} rad/s²"

    def spin_up(self, drive, material, kind, size, block):
        """Settings of the spin-up of one block."""
        first, last = (int(seed) for seed in block.split("-"))
        cell = (material, kind, size)
        snapshots = [
            grain["seed"]
            for grain in self.snapshot_grains
            if (grain["material"], grain["type"], size_label(grain["size_nm"])) == cell
            and first <= grain["seed"] <= last
        ]
        return {
            "drive": drive,
            **self.spin_up_of(drive, kind),
            "snapshot_seeds": sorted(set(snapshots)),
            "snapshot_every": self.config["snapshots"]["every"] if snapshots else 0,
        }

    @staticmethod
    def spin_up_minutes(size, block, attempt=1):
        """Time limit of the spin-up of one block [min], for a cluster: some six times what the slowest grains take.

        These are BA grains of 550 nm with 20 min each, and the time goes with the fourth power of the size
        (benchmarks/results/cost_cells.csv). A job that ran into its limit goes on, and has more with each try.
        """
        minutes = 20 * len(seeds_of(block)) * (float(size) / 550) ** 4
        return int(attempt * (30 + 6 * minutes))

    def ensemble(self, drive):
        """Settings of the statistics and the fit."""
        ensemble = self.config["ensemble"]
        return {
            "drive": drive,
            "materials": {name: self.material(name) for name in self.config["materials"]},
            "mean_monomer_radius": [
                value if value == "own" else value * NM for value in ensemble["mean_monomer_radius_nm"]
            ],
            "bootstrap": ensemble["bootstrap"],
            "confidence": ensemble["confidence"],
            "seed": ensemble["seed"],
        }

    def pairs(self, material):
        """Settings of the pairs of figure 10, for one material; None where that is left out."""
        own = self.config["figures"]["figure10"]
        return own and {
            "material": self.material(material),
            "smallest": self.radii["smallest"],
            "largest": self.radii["largest"],
            **own,
        }

    @property
    def parameter_ways(self):
        """What figure 9 varies, list of dict: parameter, changed (constants), label (in names of files).

        Empty where the figure is left out.
        """
        own = self.config["figures"]["figure9"]
        if own is None:
            return []
        units = {"xi_c": ("nm", NM), "T_vis": ("ps", PS)}
        values = {name: [value * units[name][1] for value in own[f"{name}_{units[name][0]}"]] for name in units}
        found = []
        for parameter, changed in ways(self.materials[own["material"]], values):
            unit, factor = units.get(parameter, ("", 1.0))
            label = "".join(f"_{value / factor:.6g}{unit}" for value in changed.values())
            found.append({"parameter": parameter, "changed": changed, "label": f"{parameter}{label}"})
        return found

    def parameter_sizes(self, drive):
        """Sizes [nm] of the grains of figure 9, those of the drive literal where it has its own."""
        own = self.config["figures"]["figure9"]
        return (own["literal"] if drive == "literal" else {}).get("sizes_nm", own["sizes_nm"])

    def parameter_files(self, path, drive):
        """Files of all types, sizes and ways of figure 9.

        Parameters
        ----------
        path : str
            With the fields ``{drive}``, ``{type}``, ``{size}``, ``{label}``.
        drive : str

        Returns
        -------
        list of str
            The ways of one type and size stand together.
        """
        own = self.config["figures"]["figure9"]
        return [
            path.format(drive=drive, type=kind, size=size_label(size), label=way["label"])
            for kind in (own["types"] if own else ())
            for size in self.parameter_sizes(drive)
            for way in self.parameter_ways
        ]

    def parameter_table(self, drive):
        """Settings of the table of figure 9: of each of `parameter_files` what is varied in it."""
        names = [way["parameter"] for way in self.parameter_ways]
        return {"parameters": names * (len(self.parameter_files("", drive)) // max(1, len(names)))}

    def parameters(self, drive, kind, size):
        """Settings of the runs of figure 9 of one type and size, one a way (see `same_grains.spin_up_ways`)."""
        own = self.config["figures"]["figure9"]
        pace = {}
        if drive == "literal":
            pace = {"epsilon": None} | {
                name: own["literal"][name] for name in ("angular_acceleration", "timestep_factor")
            }
        return [
            {
                "grain": self.grow(own["material"], kind, size),
                "changed": way["changed"],
                "seeds": _seeds(own),
                "spin_up": {"drive": drive} | self.spin_up_of(drive, kind) | pace,
            }
            for way in self.parameter_ways
        ]

    @property
    def calibration_labels(self):
        """Names of the files of the calibration, d omega/dt [rad/s2] and f of the runs; empty where it is left out."""
        own = self.config["figures"]["calibration"]
        return [] if own is None else [_calibration_label(run) for run in own["runs"]]

    def calibration_runs(self, label):
        """Settings of the runs of the calibration at one angular acceleration and step, in a list of one way.

        The cell is that of the config, and so are all other settings of the literal drive. `seeds` and `reach` of the
        runs themselves stand over those of the study.
        """
        own = self.config["figures"]["calibration"]
        own = own | next(run for run in own["runs"] if _calibration_label(run) == label)
        pace = {"epsilon": None} | {name: own[name] for name in ("angular_acceleration", "timestep_factor")}
        return [
            {
                "grain": self.grow(own["material"], own["type"], size_label(own["size_nm"])),
                "changed": {},
                "seeds": _seeds(own),
                "spin_up": {"drive": "literal"} | self.spin_up_of("literal", own["type"]) | pace,
                "reach": own["reach"],
            }
        ]

    @property
    def calibration_fit(self):
        """Settings of the fit of the calibration."""
        own = self.config["figures"]["calibration"]
        return {} if own is None else {"omega_onset": own["omega_onset"]}

    @property
    def formulae(self):
        """Names of the formulae that are used as printed, one at a time; empty where that is left out."""
        return [] if self.config["figures"]["formulae"] is None else list(FORMULAE)

    def formula_runs(self, formula):
        """Settings of the runs with one formula as printed, one a type and size (see `same_grains.spin_up_ways`).

        In the order of `formula_cells`.
        """
        own = self.config["figures"]["formulae"]
        runs = [
            {
                "grain": self.grow(own["material"], kind, size),
                "changed": {"viscous_time": 0.0} if formula == DAMPING else {},
                "seeds": _seeds(own),
                "spin_up": {"drive": "prescribed"} | self.spin_up_of("prescribed", kind),
            }
            for kind, size in self.formula_cells
        ]
        for run in runs:  # each formula makes a law of its own
            run["spin_up"].pop("law", None)
        return runs

    @property
    def formula_cells(self):
        """Types and labels of the sizes of the grains that are spun up with each printed formula, list of tuple."""
        own = self.config["figures"]["formulae"]
        return [] if own is None else list(product(own["types"], map(size_label, own["sizes_nm"])))

    @property
    def formula_table(self):
        """Settings of the table of these runs: of each file the name of its formula."""
        return {"formulae": [formula for formula in self.formulae for _ in self.formula_cells]}
