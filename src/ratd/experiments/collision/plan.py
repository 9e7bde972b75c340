"""The plan of the collisions: a checked config, and which cells it wants from which files.

A *cell* is a law, a cluster, one of its samples, a velocity and an impact parameter; its rotations are one file.
"""

from dataclasses import asdict, dataclass, replace
from functools import partial

from ratd.base.errors import InputError
from ratd.base.units import NM
from ratd.pipeline import config as configs
from ratd.pipeline.places import any_of

__all__ = ["BUILT", "FIGURES", "RELAXED", "RUNS", "TITLES", "Cell", "Plan", "check", "load"]

FIGURES = {
    "figure1": ("figure1", "built"),
    "figure2": ("figure2", "built"),
    "figure3": ("snapshots", "pictures"),
    "figure4": ("snapshots", "pictures"),
    "figure5": ("figure5", "table"),
    "figure6": ("figure6", "table"),
    "figure7": ("figure7", "runs"),
    "figure8": ("figure8", "table"),
    "dissipation": ("dissipation", "table"),
    "masses": ("masses", "runs"),
    "scaling": ("scaling", "thresholds"),
}
"""Figure -> module that draws it, and what it is drawn from."""
TITLES = {
    "figure1": "the MRN law and its samples",
    "figure2": "lengths that stand for the MRN law",
    "figure3": "a collision at the lower velocity",
    "figure4": "a collision at the higher velocity",
    "figure5": "X and N_s of equal spheres",
    "figure6": "X and N_s of MRN clusters",
    "figure7": "kinetic energy against time",
    "figure8": "kinetic energy against radius",
    "dissipation": "where the energy goes",
    "masses": "masses of the pieces",
    "scaling": "fragmentation beside sticking",
}
"""Figure -> what it shows, in the list of the report."""
SPACING = {"figure3": 0.1e-6, "figure4": 0.15e-6}
"""Time between two pictures [s], as printed."""

BUILT = "<results>/collision/built/{material}/{cluster}.nc"
RELAXED = "<results>/collision/relaxed/{law}/{cluster}.nc"
RUNS = "<results>/collision/runs/{law}/{cluster}/sample_{sample}/{velocity}mps_b{impact}.nc"
_WHERE = "config: collision"


@dataclass(frozen=True)
class Cell:
    """One cell, with what its runs need.

    Attributes
    ----------
    law, cluster : str
        Names in the config.
    sample : int
    velocity : float
        [m/s]
    impact_parameter : float
    rotations : tuple of int
    timestep : float or None
        [s]
    duration : float
        [s]
    """

    law: str
    cluster: str
    sample: int
    velocity: float
    impact_parameter: float
    rotations: tuple
    timestep: float | None
    duration: float

    @property
    def names(self):
        """Wildcards of its file, dict of str."""
        return {
            "law": self.law,
            "cluster": self.cluster,
            "sample": str(self.sample),
            "velocity": f"{self.velocity:g}",
            "impact": f"{self.impact_parameter:g}",
        }


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
    shared, own, materials = configs.section(config, "collision", schemas)
    mistakes = [
        f"{_WHERE}.runs[{k}].{key} has {name!r}; allowed: {', '.join(own[key])}, the keys of {key}"
        for k, entry in enumerate(own["runs"])
        for key in ("laws", "clusters")
        for name in entry[key]
        if name not in own[key]
    ]
    named = {"material": own["material"]} | {
        f"laws.{name}.material": law["material"] for name, law in own["laws"].items() if "material" in law
    }
    mistakes += [
        f"{_WHERE}.{key} is {name!r}; allowed: {', '.join(materials)}"
        for key, name in named.items()
        if name not in materials
    ]
    if mistakes:
        raise InputError("\n".join(mistakes))
    plan = Plan(own, materials, shared["results"])
    plan.check_figures()
    return plan


class Plan:
    """A checked config, and what follows from it.

    Parameters
    ----------
    config : dict
        The checked keys of the collision.
    materials : dict of str to Material
    results : str
        Folder of all results.
    """

    def __init__(self, config, materials, results):
        self.config, self.materials = config, materials
        self.results = results
        self.entries = [self._cells(entry) for entry in self.config["runs"]]
        self.cells = self._joined()

    def _cells(self, entry):
        """Cells of an entry of `runs`, list of Cell."""
        first = entry["rotations"]["first"]
        timestep = entry["timestep_ps"]
        rest = {
            "rotations": tuple(range(first, first + entry["rotations"]["number"])),
            "timestep": None if timestep is None else timestep * 1e-12,
            "duration": entry["duration_us"] * 1e-6,
        }
        return [
            Cell(law, cluster, sample, velocity, entry["impact_parameter"], **rest)
            for law in entry["laws"]
            for cluster in entry["clusters"]
            for sample in range(1, entry["samples"] + 1)
            for velocity in entry["velocities"]
        ]

    def _joined(self):
        """All cells in the order of the config; one that several entries have, with the rotations of all of them."""
        cells = {}
        for k, entry in enumerate(self.entries):
            for cell in entry:
                known = cells.setdefault(tuple(cell.names.values()), cell)
                if (known.timestep, known.duration) != (cell.timestep, cell.duration):
                    raise InputError(
                        f"{_WHERE}.runs[{k}] has {cell.cluster} at {cell.velocity:g} m/s, law {cell.law}, sample "
                        f"{cell.sample}, that an earlier entry has with another timestep_ps or duration_us; allowed: "
                        "the same for all rotations"
                    )
                rotations = tuple(sorted({*known.rotations, *cell.rotations}))
                cells[tuple(cell.names.values())] = replace(known, rotations=rotations)
        return list(cells.values())

    def queue(self):
        """All (cell, rotation), entry by entry; in an entry one rotation of all cells comes before the next."""
        seen = set()
        for cells in self.entries:
            for turn in range(max(len(cell.rotations) for cell in cells)):
                for cell in cells:
                    key = (*cell.names.values(), cell.rotations[turn])
                    if key not in seen:
                        seen.add(key)
                        yield cell, cell.rotations[turn]

    def pattern(self, name):
        """Regular expression of what a wildcard of Snakemake can be."""
        if name == "material":
            values = {self.material_of(cell.law).name for cell in self.cells}
        else:
            values = {cell.names[name] for cell in self.cells}
        return any_of(sorted(values))

    def run_files(self, path=RUNS, *, laws=None, clusters=None):
        """Files of all cells, or of those of some laws and clusters, list of str."""
        return [
            path.format(**cell.names)
            for cell in self.cells
            if (laws is None or cell.law in laws) and (clusters is None or cell.cluster in clusters)
        ]

    def pairs(self):
        """All (law, cluster) that are collided, in the order of the config."""
        return list(dict.fromkeys((cell.law, cell.cluster) for cell in self.cells))

    def clusters_files(self, path=RELAXED):
        """Files of all clusters at rest, list of str."""
        return [path.format(law=law, cluster=cluster) for law, cluster in self.pairs()]

    def material_of(self, law):
        """Material of the collisions of a law, `ratd.Material`."""
        own = self.config["laws"][law]
        material = self.materials[own.get("material", self.config["material"])]
        if "surface_energy_mJ_m2" in own:
            energy = own["surface_energy_mJ_m2"]
            material = replace(material, name=f"{material.name}_{energy:g}mJ", surface_energy=energy * 1e-3)
        return material

    def law(self, name):
        """Settings of a law, as `ratd.experiments.collision.stages.law_from` takes them."""
        own = self.config["laws"][name]
        options = {key: value for key, value in own.items() if key not in ("material", "surface_energy_mJ_m2")}
        for key in ("viscous_time", "friction_time"):
            if f"{key}_ns" in options:
                options[key] = options.pop(f"{key}_ns") * 1e-9
        return options

    def samples(self, cluster):
        """Samples of a cluster that some cell wants, ascending list of int."""
        return sorted({cell.sample for cell in self.cells if cell.cluster == cluster})

    def build(self, material, cluster):
        """Settings of the stage `build` of one cluster."""
        named = {self.material_of(cell.law).name: self.material_of(cell.law) for cell in self.cells}
        return self.cluster(named[material], cluster) | {"samples": self.samples(cluster)}

    def cluster(self, material, name):
        """Settings of one cluster, as `ratd.experiments.collision.stages.built` takes them."""
        own = self.config["clusters"][name]
        radius = self.config["cluster_radius_um"] * 1e-6
        settings = {
            "name": name,
            "radii": own["radii"],
            "cluster_radius": radius,
            "total_cube": self.config["filling_factor"] * radius**3,
            "second_contact": own["second_contact"],
            "material": asdict(material),
        }
        if own["radii"] == "mrn":
            settings |= {
                "number": own["number"],
                "smallest": own["smallest_nm"] * NM,
                "largest": own["largest_nm"] * NM,
                "drop_below": own.get("drop_below_nm", 0) * NM,
                "mass_within": own["mass_within"],
                "length_within": own["length_within"],
            }
        else:
            giant = own.get("giant_nm")
            settings |= {"radius": own["radius_nm"] * NM, "giant": None if giant is None else giant * NM}
        return settings

    def collide(self, names):
        """Settings of the stage `collide` of the cell of some wildcards."""
        (cell,) = [cell for cell in self.cells if cell.names == dict(names)]
        return self.settings_of(cell)

    def settings_of(self, cell):
        """Settings of the collisions of one cell; `snapshots`: rotation -> records from one snapshot to the next."""
        pictures = self.config["snapshots"]
        return {
            "law": self.law(cell.law),
            "law_name": cell.law,
            "cluster_name": cell.cluster,
            "second_contact": self.config["clusters"][cell.cluster]["second_contact"],
            "sample": cell.sample,
            "velocity": cell.velocity,
            "impact_parameter": cell.impact_parameter,
            "rotations": list(cell.rotations),
            "timestep": cell.timestep,
            "duration": cell.duration,
            "records": self.config["records"],
            "snapshots": {
                str(one["rotation"]): one.get("every", pictures["every"])
                for one in pictures["runs"]
                if (one["law"], one["cluster"], one["sample"], one["velocity"])
                == (cell.law, cell.cluster, cell.sample, cell.velocity)
            },
        }

    def work(self, names):
        """How long the collisions of a cell take, in some unit, for their order."""
        (cell,) = [cell for cell in self.cells if cell.names == dict(names)]
        own = self.config["clusters"][cell.cluster]
        spheres = own["number"] if own["radii"] == "mrn" else (own["radius_nm"] / 1000.0) ** -3
        return spheres * cell.duration / (cell.timestep or 1e-12)

    @property
    def analysis(self):
        """Settings of the tables."""
        return {"bootstrap": self.config["bootstrap"]}

    @property
    def pictures(self):
        """Collisions whose snapshots figures 3 and 4 and the page show, list of dict."""
        return self.config["snapshots"]["runs"][:2]

    @property
    def figures(self):
        """Names of the figures to draw, list of str: those whose collisions some run has."""
        return [name for name in FIGURES if self._can_draw(name)]

    @property
    def notes(self):
        """What was left out because no run has such collisions, list of str."""
        left_out = [name for name in FIGURES if name not in self.figures and FIGURES[name][1] != "pictures"]
        if not left_out:
            return []
        own = self.config["figures"]
        return [
            f"config: left out is collision.figures.{', '.join(left_out)}: no run has the clusters mrn and twin, "
            f"{own['mrn']!r} and {own['twin']!r}, under the law {own['law']!r}"
        ]

    def _can_draw(self, name):
        """Whether all that a figure shows is computed."""
        source = FIGURES[name][1]
        if source == "pictures":
            return self._picture(name) is not None
        if source == "thresholds":
            return True
        own = self.config["figures"]
        shown = ("mrn",) if source == "built" else ("mrn", "twin")
        return all((own["law"], own[key]) in self.pairs() for key in shown)

    def _picture(self, name):
        """The collision that a figure or the page shows, None for none: the first, or the second for figure 4."""
        shown = self.pictures
        return shown[min(name == "figure4", len(shown) - 1)] if shown else None

    @staticmethod
    def figure_module(name):
        """Module that draws a figure."""
        return FIGURES[name][0]

    def figure_input(self, name):
        """Files that a figure, or the page, is drawn from, dict of name to list of str."""
        source = "pictures" if name == "page" else FIGURES[name][1]
        own = self.config["figures"]
        if source == "built":
            material = self.material_of(own["law"]).name
            return {"built": [BUILT.format(material=material, cluster=own["mrn"])]}
        if source == "pictures":
            shown = self._picture(name)
            return {"runs": [self.snapshot_file(shown)] if shown else []}
        if source == "runs":
            return {"runs": self.run_files(laws=[own["law"]], clusters=[own["mrn"], own["twin"]])}
        return {source: f"<results>/collision/tables/collision_{source}.nc"}

    def figure(self, name):
        """Settings of a figure, or of the page."""
        if name == "page" or name in SPACING:
            shown = self._picture(name)
            settings = {"rotation": shown["rotation"] if shown else None}
            return settings | ({"spacing": SPACING[name]} if name in SPACING else {})
        own = dict(self.config["figures"])
        cluster = self.config["clusters"].get(own["mrn"], {})
        if FIGURES[name][1] == "built" and cluster.get("radii") == "mrn":
            own["ends"] = [cluster["smallest_nm"] * NM, cluster["largest_nm"] * NM]
        return own

    def snapshot_file(self, one):
        """File of a run with snapshots, named as in `snapshots.runs`."""
        return RUNS.format(**self.cell_of(one).names)

    def cell_of(self, one):
        """The cell of a collision of `snapshots.runs`."""
        found = [
            cell
            for cell in self.cells
            if (cell.law, cell.cluster, cell.sample, cell.velocity)
            == (one["law"], one["cluster"], one["sample"], one["velocity"])
            and one["rotation"] in cell.rotations
        ]
        if not found:
            raise InputError(f"{_WHERE}.snapshots.runs has {one}; allowed: a collision of `runs`")
        return found[0]

    def check_figures(self):
        """Raise InputError unless all that is to be drawn is computed."""
        configs.together(
            *(partial(self.snapshot_file, one) for one in self.config["snapshots"]["runs"]),
            *(partial(self._check_name, key) for key in ("law", "mrn", "twin")),
        )

    def _check_name(self, key):
        """Raise InputError unless there is the law or the cluster that the figures name."""
        name, table = self.config["figures"][key], "laws" if key == "law" else "clusters"
        if name not in self.config[table]:
            allowed = f"{', '.join(self.config[table])}, the keys of {table}"
            raise InputError(f"{_WHERE}.figures.{key} is {name!r}; allowed: {allowed}")
