"""The config of the pipeline: checked as a whole before any job starts, and turned into cells, blocks and settings.

The layout stands in `config/schema/config.schema.yaml`, where each key says in words what it may hold. Everything
that a file depends on becomes the settings of its job, and nothing else does: a change of the figures' settings
concerns the figures only, and a further seed concerns no other block than one that was not full.
"""

import math
import re
from dataclasses import asdict, dataclass
from itertools import groupby, product
from pathlib import Path

import jsonschema
import yaml

from ratd.aggregates.growth import MOST_MONOMERS, RadiusDistribution, smallest_a_eff
from ratd.base.errors import InputError
from ratd.base.materials import MATERIALS, Material, mix
from ratd.base.units import GPA, MJ_PER_M2, NM, PS
from ratd.experiments.spin_up.formulae import DAMPING, FORMULAE
from ratd.experiments.spin_up.parameters import ways

# 10.0 is no whole number here: it would not do as the length of a list
_Validator = jsonschema.validators.extend(
    jsonschema.Draft202012Validator,
    type_checker=jsonschema.Draft202012Validator.TYPE_CHECKER.redefine(
        "integer", lambda checker, value: isinstance(value, int) and not isinstance(value, bool)
    ),
)

_MATERIAL_KEYS = {
    "surface_energy_mJ_m2": ("surface_energy", MJ_PER_M2),
    "youngs_modulus_GPa": ("youngs_modulus", GPA),
    "poisson_number": ("poisson_number", 1.0),
    "density_kg_m3": ("density", 1.0),
    "critical_rolling_displacement_nm": ("critical_rolling_displacement", NM),
    "viscous_time_ps": ("viscous_time", PS),
}
"""Key in materials.yaml -> attribute of `Material` and its unit in SI."""


def read_yaml(path):
    """Content of a YAML file.

    Parameters
    ----------
    path : path-like

    Returns
    -------
    object

    Raises
    ------
    InputError
        One sentence with the file, and the line where it is not YAML.
    """
    try:
        return yaml.safe_load(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from error
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        place = getattr(error, "problem_mark", None)
        where = f"line {place.line + 1}: " if place else ""
        raise InputError(f"{path}: {where}is not YAML ({getattr(error, 'problem', error)})") from error


def merge(base, over):
    """Config with some keys replaced, as Snakemake does with `--configfile`: mappings key by key, lists as a whole.

    Parameters
    ----------
    base, over : dict

    Returns
    -------
    dict
    """
    result = dict(base)
    for key, value in over.items():
        both = isinstance(value, dict) and isinstance(base.get(key), dict)
        result[key] = merge(base[key], value) if both else value
    return result


def check_layout(content, layout, where):
    """Raise an error unless some content is laid out as a JSON schema says.

    Parameters
    ----------
    content : object
        Of a YAML file.
    layout : dict
        The JSON schema; each part has a `description` that says what is allowed.
    where : str
        Name of the content, for the message.

    Raises
    ------
    InputError
        One sentence with the key, its value and what is allowed.
    """
    errors = _Validator(layout).iter_errors(content)
    for error in sorted(errors, key=lambda error: [str(part) for part in error.absolute_path]):
        raise InputError(f"{where}: {_sentence(error, layout)}")


def _sentence(error, layout):
    """What is wrong, from an error of jsonschema."""
    key = _dotted(error.absolute_path)
    if error.validator == "additionalProperties":
        unknown = sorted(set(error.instance) - set(error.schema["properties"]), key=str)[0]
        inside = f" in {key}" if key else ""
        return f"the key {unknown!r}{inside} is unknown; allowed: {', '.join(error.schema['properties'])}"
    if error.validator == "required":
        missing = next(name for name in error.validator_value if name not in error.instance)
        part = error.schema.get("properties", {}).get(missing, error.schema)
        if "$ref" in part:
            part = layout["$defs"][part["$ref"].rpartition("/")[2]]
        return f"the key {f'{key}.{missing}' if key else missing} is missing; allowed: {part['description']}"
    return (
        f"{key or 'it'} is {error.instance!r}{_text(error)}; allowed: {error.schema.get('description', error.message)}"
    )


def _text(error):
    """A hint where a number without a point, such as 1e14, was taken for text, which YAML 1.1 does."""
    if error.validator != "type" or not isinstance(error.instance, str):
        return ""
    try:
        number = float(error.instance)
    except ValueError:
        return ""
    mantissa, e, exponent = repr(number).partition("e")
    written = f"{mantissa}{'' if '.' in mantissa else '.0'}{e}{exponent}"
    return f" (text for YAML; as a number it is written {written})" if math.isfinite(number) else ""


def _dotted(path):
    """A place in nested mappings and lists, such as ``snapshots.grains[0].seed``."""
    text = ""
    for part in path:
        text += f"[{part}]" if isinstance(part, int) else f".{part}"
    return text.removeprefix(".")


def read_materials(path, layout):
    """Materials of Table 2 together with those of a file.

    Parameters
    ----------
    path : path-like
        Such as `config/materials.yaml`.
    layout : dict
        Its JSON schema.

    Returns
    -------
    dict of str to Material

    Raises
    ------
    InputError
        One sentence with the file, the material and the key.
    """
    content = read_yaml(path)
    check_layout(content, layout, str(path))
    table = dict(MATERIALS)
    for name, entry in (content or {}).items():
        if name in MATERIALS:
            raise InputError(f"{path}: {name!r} is a material of Table 2 already; allowed: any other name")
        try:
            if "mix" in entry:
                table[name] = mix(name, entry["mix"], table)
            else:
                values = {_MATERIAL_KEYS[key][0]: value * _MATERIAL_KEYS[key][1] for key, value in entry.items()}
                table[name] = Material(name, **values)
        except InputError as error:
            raise InputError(f"{path}: {name}: {error}") from error
    return table


def load(*paths, schemas="config/schema"):
    """Plan of some config files, each of which stands over those before it.

    Parameters
    ----------
    *paths : path-like
    schemas : path-like, optional
        Folder of the JSON schemas.

    Returns
    -------
    Plan

    Raises
    ------
    InputError
        See `check`.
    """
    merged = {}
    for path in paths:
        content = read_yaml(path)
        if not isinstance(content, dict):
            raise InputError(f"{path}: is {content!r}; allowed: a mapping of the keys in {schemas}/config.schema.yaml")
        merged = merge(merged, content)
    return check(merged, schemas)


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
        One sentence that names the first key that is wrong, and what is allowed.
    """
    schemas = Path(schemas)
    config = dict(config)
    _check_finite(config, ())
    check_layout(config, read_yaml(schemas / "config.schema.yaml"), "config")
    materials = read_materials(config["materials_file"], read_yaml(schemas / "materials.schema.yaml"))
    plan = Plan(config, materials)
    for k, name in enumerate(config["materials"]):
        if name not in materials:
            raise InputError(
                f"config: materials[{k}] is {name!r}; "
                f"allowed: {', '.join(materials)}, or a material added to {config['materials_file']}"
            )
    try:
        radii = RadiusDistribution(**plan.radii)
    except InputError as error:
        raise InputError(f"config: growth: {error}") from error
    largest = (MOST_MONOMERS * radii.moment(3)) ** (1 / 3) / NM
    for k, size in enumerate(config["sizes_nm"]):
        if size > largest:
            raise InputError(
                f"config: sizes_nm[{k}] is {size!r}; allowed: at most {math.floor(largest)} nm, the size of "
                f"{MOST_MONOMERS} monomers"
            )
        for kind in config["types"]:
            smallest = smallest_a_eff(kind, radii) / NM
            # the size itself has no room for different radii: all monomers would have to be of the smallest one
            if not size > smallest * (1 + 1e-9):
                raise InputError(
                    f"config: sizes_nm[{k}] is {size!r}; allowed: above {math.ceil(100 * smallest) / 100:g} nm, "
                    f"the size of the fewest monomers that {kind} is made of"
                )
    for drive in config["drives"]:
        where = "spin_up and literal together" if drive == "literal" else "spin_up"
        for kind in config["types"]:
            laws = {key: plan.spin_up_of(drive, kind)[key] for key in ("epsilon", "angular_acceleration")}
            if sum(value is not None for value in laws.values()) != 1:
                raise InputError(
                    f"config: {where} give {laws} for {kind}; allowed: a number for one of them and null for the other"
                )
    _check_fewer(plan)
    for k, grain in enumerate(config["snapshots"]["grains"]):
        plan.find_cell(grain, f"snapshots.grains[{k}]")
        plan.find_seed(grain["seed"], plan.seeds_of(cell_of(grain)), f"snapshots.grains[{k}].seed")
    figure4, figure6 = config["figures"]["figure4"], config["figures"]["figure6"]
    if figure4 is not None:
        plan.find_cell(figure4, "figures.figure4")
        for drive in config["drives"]:
            if not plan.seeds_of(cell_of(figure4), drive):
                raise InputError(
                    f"config: figures.figure4 is a cell that seeds.fewer leaves out for the drive {drive}; "
                    "allowed: a cell with grains for every drive, or null"
                )
    if figure6 is not None:
        plan.find(figure6["material"], "materials", "figures.figure6.material")
        plan.find_each(figure6["sizes_nm"], "sizes_nm", "figures.figure6.sizes_nm")
    figure1, figure5, figure8 = (config["figures"][f"figure{number}"] for number in (1, 5, 8))
    if figure1 is not None:
        plan.find(figure1["material"], "materials", "figures.figure1.material")
        plan.find_each(figure1["sizes_nm"], "sizes_nm", "figures.figure1.sizes_nm")
        plan.find_seed(figure1["seed"], plan.seeds, "figures.figure1.seed")
    if figure5 is not None:
        if figure5 not in config["snapshots"]["grains"]:
            raise InputError(f"config: figures.figure5 is {figure5}; allowed: one of snapshots.grains, or null")
        for drive in config["drives"]:
            plan.find_seed(
                figure5["seed"], plan.seeds_of(cell_of(figure5), drive), f"figures.figure5.seed (drive {drive})"
            )
    if figure8 is not None:
        for name, key in (("material", "materials"), ("type", "types"), ("scaled_at_nm", "sizes_nm")):
            plan.find(figure8[name], key, f"figures.figure8.{name}")
    for name in ("figure9", "formulae"):
        own = config["figures"][name]
        if own is not None:
            plan.find(own["material"], "materials", f"figures.{name}.material")
            for key in ("types", "sizes_nm"):
                plan.find_each(own[key], key, f"figures.{name}.{key}")
    if config["figures"]["figure9"] is not None:
        plan.find_each(plan.parameter_sizes("literal"), "sizes_nm", "figures.figure9.literal.sizes_nm")
    own = config["figures"]["calibration"]
    if own is not None:
        plan.find_cell(own, "figures.calibration")
        labels = plan.calibration_labels
        for k, label in enumerate(labels):
            if label in labels[:k]:
                raise InputError(
                    f"config: figures.calibration.runs[{k}] has the angular_acceleration and timestep_factor of an "
                    "earlier one; allowed: each pair once, for whichever seeds"
                )
    return plan


def _check_fewer(plan):
    """Raise InputError unless `seeds.fewer` names what the ensemble has, and leaves each drive a grain."""
    for k, entry in enumerate(plan.fewer):
        where = f"seeds.fewer[{k}]"
        for key in ("drives", "materials", "types", "sizes_nm"):
            plan.find_each(entry.get(key, ()), key, f"{where}.{key}")
        if entry["number"] > len(plan.seeds):
            raise InputError(f"config: {where}.number is {entry['number']}; allowed: 0 to {len(plan.seeds)}")
    for drive in plan.config["drives"]:
        if not plan.cells_of(drive):
            raise InputError(
                f"config: seeds.fewer leaves no grain for the drive {drive}; allowed: at least one cell with seeds"
            )


def cell_of(names):
    """(material, type, size) of a mapping with material, type and size_nm, the size as in `Plan.sizes`."""
    return names["material"], names["type"], size_label(names["size_nm"])


def _check_finite(value, path):
    """YAML has .nan and .inf, which no key may hold and which pass for numbers."""
    if isinstance(value, dict):
        for key, part in value.items():
            _check_finite(part, (*path, key))
    elif isinstance(value, list):
        for k, part in enumerate(value):
            _check_finite(part, (*path, k))
    elif isinstance(value, float) and not math.isfinite(value):
        raise InputError(f"config: {_dotted(path)} is {value}; allowed: finite numbers")


def _calibration_label(run):
    return f"{run['angular_acceleration']:.6g}_{run['timestep_factor']:g}"


def consecutive(seeds):
    """Rows of whole numbers without a gap, list of lists, from numbers in ascending order."""
    # a number less its place stays the same as long as none is missing
    rows = groupby(enumerate(seeds), key=lambda item: item[1] - item[0])
    return [[seed for _, seed in row] for _, row in rows]


def size_label(size):
    """A size in nm as it stands in the name of a folder, e.g. ``"50"`` or ``"62.5"``."""
    return f"{size:.10g}"


@dataclass(frozen=True)
class Plan:
    """A checked config, and what follows from it.

    Attributes
    ----------
    config : dict
        The merged config.
    materials : dict of str to Material
        Table 2 and the materials of the user.
    """

    config: dict
    materials: dict

    @property
    def results(self):
        """Folder of all results."""
        return self.config["results"].rstrip("/") or "/"

    @property
    def sizes(self):
        """Sizes as they stand in names of folders, list of str, the largest first."""
        return [size_label(size) for size in sorted(self.config["sizes_nm"], reverse=True)]

    @property
    def seeds(self):
        """All seeds, a range."""
        first = self.config["seeds"]["first"]
        return range(first, first + self.config["seeds"]["number"])

    @property
    def fewer(self):
        """What `seeds.fewer` says of cells with fewer seeds, list of dict; a later one stands over earlier ones."""
        return self.config["seeds"].get("fewer", [])

    def seeds_of(self, cell, drive=None):
        """Seeds of one cell, a range from the first seed on.

        Parameters
        ----------
        cell : tuple of str
            (material, type, size), one of `cells`.
        drive : str, optional
            Seeds that this drive spins up; default: those that are grown, the most that any drive wants.

        Returns
        -------
        range
        """
        if drive is None:
            return max((self.seeds_of(cell, own) for own in self.config["drives"]), key=len)
        number = len(self.seeds)
        for entry in self.fewer:
            names = {"drives": drive, "materials": cell[0], "types": cell[1]}
            sizes = entry.get("sizes_nm")
            if all(name in entry.get(key, [name]) for key, name in names.items()) and (
                sizes is None or cell[2] in map(size_label, sizes)
            ):
                number = entry["number"]
        return self.seeds[:number]

    def blocks(self, cell=None, drive=None, without=()):
        """Blocks of seeds as they stand in names of files.

        Parameters
        ----------
        cell : tuple of str, optional
            See `seeds_of`; default: those of a cell with all seeds.
        drive : str, optional
            See `seeds_of`.
        without : collection of int, optional
            Seeds to leave out. A block that holds some of them falls into parts, none of which has seeds of two blocks.

        Returns
        -------
        list of str
            Such as ``"0-9"``; the last one may be shorter than the others.
        """
        return self._split(self.seeds if cell is None else self.seeds_of(cell, drive), cell, without)

    def _block_size(self, cell):
        small = self.config.get("small_grains")
        if cell is not None and small is not None and float(cell[2]) <= small["up_to_nm"]:
            return small["block_size"]
        return self.config["block_size"]

    def _split(self, seeds, cell, without=()):
        step = self._block_size(cell)
        blocks = (seeds[k : k + step] for k in range(0, len(seeds), step))
        parts = (part for block in blocks for part in consecutive(seed for seed in block if seed not in without))
        return [f"{part[0]}-{part[-1]}" for part in parts]

    def grown_block(self, cell, block):
        """Block of grown grains in which the grains of a block of some drive are, see `blocks`."""
        first = int(block.partition("-")[0])
        seeds = self.seeds_of(cell)
        return self._block_with(first, seeds if first in seeds else self.seeds, cell)

    def _block_with(self, seed, seeds, cell):
        return self._split(seeds, cell)[(seed - self.seeds[0]) // self._block_size(cell)]

    def files(self, path, drive=None):
        """Names of the files of all blocks of all cells.

        Parameters
        ----------
        path : str
            With the fields ``{material}``, ``{type}``, ``{size}``, ``{seeds}``.
        drive : str, optional
            Cells and seeds that this drive spins up; default: those that are grown.

        Returns
        -------
        list of str
            In the order of `cells`.
        """
        return [
            self.file(path, cell, seeds=block) for cell in self.cells_of(drive) for block in self.blocks(cell, drive)
        ]

    def all_files(self, path):
        """Files of the grown grains of all cells with all seeds, see `files`; `seeds.fewer` leaves none out."""
        return [self.file(path, cell, seeds=block) for cell in self.cells for block in self._split(self.seeds, cell)]

    @property
    def grows_more_anyway(self):
        """Whether all grains are grown for one drive or another, and `seeds.fewer` leaves some out for a drive."""
        grains = "{material} {type} {size} {seeds}"
        return bool(self.fewer) and self.files(grains) == self.all_files(grains)

    def grown_files(self, path, drive):
        """Files of the grown grains that a drive spins up, see `files`; they may hold more seeds than it wants."""
        return [
            self.file(path, cell, seeds=block)
            for cell in self.cells_of(drive)
            for block in self.blocks(cell)[: len(self.blocks(cell, drive))]
        ]

    @staticmethod
    def file(path, cell, **names):
        """Name of one file of a cell, see `files`."""
        return path.format(material=cell[0], type=cell[1], size=cell[2], **names)

    def cells_of(self, drive=None):
        """Those of `cells` that a drive spins up at least one grain of; default: that are grown."""
        return [cell for cell in self.cells if self.seeds_of(cell, drive)]

    @property
    def cells(self):
        """All (material, type, size), the size as in `sizes`."""
        return [
            (material, kind, size)
            for size in self.sizes
            for material in self.config["materials"]
            for kind in self.config["types"]
        ]

    @property
    def figures(self):
        """Numbers of the figures to draw for each drive, list of int."""
        return self._wanted(2, 4, 5, 6, 7, 8, 9)

    @property
    def common_figures(self):
        """Numbers of the figures to draw that do not depend on the drive, list of int."""
        return self._wanted(1, 10)

    def _wanted(self, *numbers):
        return [number for number in numbers if self.config["figures"].get(f"figure{number}", ()) is not None]

    def pattern(self, name):
        """Regular expression of what a wildcard of Snakemake can be.

        Parameters
        ----------
        name : str
            "sizes", "blocks", "calibration_labels", or a key of the config that holds a list of names.

        Returns
        -------
        str
        """
        if name == "blocks":
            drives = (None, *self.config["drives"])
            values = {block for cell in self.cells for drive in drives for block in self.blocks(cell, drive)}
            # a grain that only figure 1 shows is in a block of a cell with all seeds
            values = sorted(values | {block for cell in self.cells for block in self._split(self.seeds, cell)})
        else:
            values = getattr(self, name) if name in ("sizes", "calibration_labels") else self.config[name]
        return "|".join(re.escape(value) for value in values)

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
        return [self.file(path, cell_of(own), seeds=block) for block in self.blocks(cell_of(own), drive)]

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
        return [self.file(path, cell, seeds=self._block_with(own["seed"], self.seeds_of(cell, drive), cell))]

    @property
    def radii(self):
        """Arguments of `ratd.aggregates.growth.RadiusDistribution` [m]."""
        growth = self.config["growth"]
        return {
            "median": growth["median_nm"] * NM,
            "sigma_ln": growth["sigma_ln"],
            "smallest": growth["smallest_nm"] * NM,
            "largest": growth["largest_nm"] * NM,
        }

    def find(self, value, key, where):
        """Raise InputError unless a value is one of those that the ensemble has under a key."""
        if value not in self.config[key]:
            raise InputError(
                f"config: {where} is {value!r}; allowed: one of the {key}, {', '.join(map(str, self.config[key]))}"
            )

    def find_each(self, values, key, where):
        """Raise InputError unless each of a list is one of those that the ensemble has under a key."""
        for k, value in enumerate(values):
            self.find(value, key, f"{where}[{k}]")

    def find_seed(self, seed, seeds, where):
        """Raise InputError unless a seed is one of a range."""
        if seed not in seeds:
            allowed = f"{seeds[0]} to {seeds[-1]}" if seeds else "none, seeds.fewer leaves the cell out"
            raise InputError(f"config: {where} is {seed}; allowed: {allowed}")

    def find_cell(self, cell, where):
        """Raise InputError unless the ensemble has a cell, a dict with material, type and size_nm."""
        for name, key in (("material", "materials"), ("type", "types"), ("size_nm", "sizes_nm")):
            self.find(cell[name], key, f"{where}.{name}")

    def material(self, name):
        """Constants of a material, dict of the arguments of `ratd.base.materials.Material`."""
        return asdict(self.materials[name])

    def grow(self, material, kind, size):
        """Settings of the growth of one cell."""
        return {
            "material": self.material(material),
            "type": kind,
            "a_eff": float(size) * NM,
            "radii": self.radii,
            "migration": self.config["growth"]["migration"],
        }

    def spin_up_of(self, drive, kind=None):
        """Part of the config on the spin-up, for one drive.

        ``epsilon`` is that of a type, a number or None; with no type given as it stands in the config, where it may be
        a mapping from type to number.
        """
        own = self.config["spin_up"] | (self.config["literal"] if drive == "literal" else {})
        if kind is not None and isinstance(own["epsilon"], dict):
            own["epsilon"] = own["epsilon"].get(kind)
        return own

    def pace(self, drive):
        """How fast a drive spins up, in words, such as ``"epsilon = 0.01"``."""
        law = self.spin_up_of(drive)
        epsilon = law["epsilon"]
        if isinstance(epsilon, dict):
            return "epsilon = " + ", ".join(f"{epsilon[kind]:g} ({kind})" for kind in self.config["types"])
        if epsilon is not None:
            return f"epsilon = {epsilon:g}"
        return f"d omega/dt = {law['angular_acceleration']:.3g} rad/s²"

    def spin_up(self, drive, material, kind, size, block):
        """Settings of the spin-up of one block."""
        first, last = (int(seed) for seed in block.split("-"))
        cell = (material, kind, size)
        snapshots = [
            grain["seed"]
            for grain in self.config["snapshots"]["grains"]
            if (grain["material"], grain["type"], size_label(grain["size_nm"])) == cell
            and first <= grain["seed"] <= last
        ]
        return {
            "drive": drive,
            **self.spin_up_of(drive, kind),
            "snapshot_seeds": sorted(set(snapshots)),
            "snapshot_every": self.config["snapshots"]["every"] if snapshots else 0,
        }

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
        """Settings of the pairs of figure 10, for one material."""
        own = self.config["figures"]["figure10"]
        return {
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

    def parameters(self, drive, kind, size):
        """Settings of the runs of figure 9 of one type and size, one a way (see `ratd.experiments.spin_up.same_grains.spin_up_ways`)."""
        own = self.config["figures"]["figure9"]
        first = own["seeds"]["first"]
        paces = {
            "prescribed": {
                "epsilon": own["epsilon"],
                "angular_acceleration": None,
                "timestep_factor": own["timestep_factor"],
            },
            "literal": {"epsilon": None}
            | {name: own["literal"][name] for name in ("angular_acceleration", "timestep_factor")},
        }
        return [
            {
                "grain": self.grow(own["material"], kind, size),
                "changed": way["changed"],
                "seeds": list(range(first, first + own["seeds"]["number"])),
                "spin_up": {"drive": drive} | self.spin_up_of(drive, kind) | paces[drive],
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
        first = own["seeds"]["first"]
        pace = {"epsilon": None} | {name: own[name] for name in ("angular_acceleration", "timestep_factor")}
        return [
            {
                "grain": self.grow(own["material"], own["type"], size_label(own["size_nm"])),
                "changed": {},
                "seeds": list(range(first, first + own["seeds"]["number"])),
                "spin_up": {"drive": "literal"} | self.spin_up_of("literal", own["type"]) | pace,
                "reach": own["reach"],
            }
        ]

    @property
    def formulae(self):
        """Names of the formulae that are used as printed, one at a time; empty where that is left out."""
        return [] if self.config["figures"]["formulae"] is None else list(FORMULAE)

    def formula_runs(self, formula):
        """Settings of the runs with one formula as printed, one a type and size (see `ratd.experiments.spin_up.same_grains.spin_up_ways`).

        In the order of `formula_cells`.
        """
        own = self.config["figures"]["formulae"]
        first = own["seeds"]["first"]
        pace = {"epsilon": own["epsilon"], "angular_acceleration": None, "timestep_factor": own["timestep_factor"]}
        return [
            {
                "grain": self.grow(own["material"], kind, size),
                "changed": {"viscous_time": 0.0} if formula == DAMPING else {},
                "seeds": list(range(first, first + own["seeds"]["number"])),
                "spin_up": {"drive": "prescribed"} | self.spin_up_of("prescribed", kind) | pace,
            }
            for kind, size in self.formula_cells
        ]

    @property
    def formula_cells(self):
        """Types and labels of the sizes of the grains that are spun up with each printed formula, list of tuple."""
        own = self.config["figures"]["formulae"]
        return list(product(own["types"], map(size_label, own["sizes_nm"])))

    def figure(self, number, drive=None):
        """Settings of one figure, with its own part of the config, sizes in m."""
        own = self.config["figures"].get(f"figure{number}") or {}
        if "scaled_at_nm" in own:
            own = own | {"scaled_at": own["scaled_at_nm"] * NM}
        if "sizes_nm" in own:
            own = own | {"sizes": [size * NM for size in own["sizes_nm"]]}
        materials = {name: self.material(name) for name in self.config["materials"]}
        return {"drive": drive, "materials": materials, **own}
