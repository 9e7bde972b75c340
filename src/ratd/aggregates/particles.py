"""Spheres in files of other programs: text, CSV, extended XYZ and LAMMPS dumps, read."""

import os
import re
import shlex
import warnings
from io import StringIO
from itertools import pairwise, takewhile
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd

from ratd.aggregates.grain import Grain
from ratd.base.checks import LARGEST_RADIUS, SMALLEST_RADIUS, is_dust, is_whole, likely_unit
from ratd.base.errors import FileError, InputError
from ratd.base.materials import Material
from ratd.base.words import plural
from ratd.geometry.box import periodic, touching_pairs

__all__ = [
    "STYLES",
    "TABLES",
    "XYZ",
    "Particles",
    "factor_of",
    "path_of",
    "read_particles",
    "reader_of",
    "suffix_of",
]

UNITS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "nm": 1e-9, "angstrom": 1e-10}
"""Units of length in files, in m."""
_USUAL, _DOUBTFUL = "nm", 1e-9
"""The unit of a file that states none, and the median radius [m] below which another one is likely."""
_COLUMNS = {"x": "x", "y": "y", "z": "z", "r": "radius", "radius": "radius", "xu": "x", "yu": "y", "zu": "z"}
STYLES = {"m": "si", "cm": "cgs", "um": "micro", "nm": "nano", "angstrom": "metal"}
"""Unit of length -> style of units in LAMMPS, which its dumps may name."""
_LENGTHS = {style: unit for unit, style in STYLES.items()} | {"real": "angstrom"}
"""Style of units in LAMMPS -> unit of length; others have none that dust is measured in."""
_BRACKETS = re.compile(r"[\[(]\s*([^\])]+?)\s*[\])]")
_OTHER_NAMES = {"micron": "um", "microns": "um", "micrometer": "um", "a": "angstrom", "å": "angstrom"}
"""Other names of `UNITS`."""
_UNIT = re.compile(r"[\s\[(_]([a-z]+)")
_STATED = re.compile(r"#\s*(?:length\s+)?units?\s*[:=]\s*(\S+)\s*$", re.IGNORECASE)
"""A comment that states the unit of a table."""
TABLES = {".csv": ",", ".txt": " ", ".dat": " "}
_PARTED = {",": "commas", " ": "blanks or tabs"}
XYZ, DUMP = (".xyz", ".extxyz"), (".dump", ".lammpstrj", ".lammps")
SUFFIXES = (*TABLES, *XYZ, *DUMP)
TOUCHING = 1e-9
"""Part of their radii by which spheres may be apart and touch all the same, since files round."""


class Particles(NamedTuple):
    """Spheres of a file.

    Attributes
    ----------
    position : (n, 3) float64 array
        Centres [m].
    radius : (n,) float64 array
        Radii [m].
    box : (3,) float64 array or None
        Edges of the periodic box along x, y, z [m]; None in open space.
    """

    position: np.ndarray
    radius: np.ndarray
    box: np.ndarray | None = None

    def grain(self, material: str | Material, **about) -> Grain:
        """The aggregate of these spheres in open space, see `ratd.Grain`; warns of contacts that the box would add."""
        grain = Grain(self.position, self.radius, material, **about)
        through = 0 if self.box is None else _through_the_faces(self.position, self.radius, self.box)
        if through:
            warnings.warn(
                f"{plural(through, 'contact')} of these spheres reach through the faces of their periodic box; the "
                "grain is in open space, without them",
                stacklevel=2,
            )
        return grain


def read_particles(path: str | Path, unit: str | None = None, frame: int = -1) -> Particles:
    """Read spheres from a file.

    Parameters
    ----------
    path : path-like
        By its suffix: ``.txt``, ``.dat`` (columns x y z r, with or without their names above) or ``.csv``;
        ``.xyz``, ``.extxyz`` (extended XYZ with a column ``radius``); ``.dump``, ``.lammpstrj`` (text dump of LAMMPS
        with x y z or xu yu zu, and radius).
    unit : str, optional
        Of all lengths in the file: m, cm, mm, um, nm or angstrom. If not given, that which the file states (``x [um]``
        in the names of its columns, a comment ``# unit: um``, ``unit=um`` in extended XYZ, the style of units of
        LAMMPS), or nm. A unit in brackets that is none is an error.
    frame : int, optional
        Which one, in a file of several; the last if not given.

    Returns
    -------
    Particles

    Raises
    ------
    FileError
        One sentence with the file and what is wrong with it.
    InputError
        If the unit is unknown or another one than the file states, or the radii are not those of dust in it.
    """
    path = path_of(path)
    if unit is not None:
        factor_of(unit)
    reader = reader_of(path)
    if not is_whole(frame):
        raise InputError(f"frame is {frame!r}; it must be a whole number")
    try:
        table, box, stated = reader(path, frame)
        missing = [name for name in ("x", "y", "z", "radius") if name not in table]
        if missing:
            hint = ""
            if len(table.columns) == 1 and suffix_of(path) in TABLES:
                hint = f"; in a {path.suffix} file columns are parted by {_PARTED[TABLES[suffix_of(path)]]}"
            raise ValueError(f"there is no column {', '.join(missing)}; the columns are {', '.join(table)}{hint}")
        twice = table.columns[table.columns.duplicated()]
        if len(twice):
            raise ValueError(f"it has more than one column {twice[0]}")
        values = np.stack([_numbers(table[name], name) for name in ("x", "y", "z", "radius")], axis=1)
    except OSError as error:
        raise FileError(f"{path}: cannot be read ({error.strerror})") from error
    except (ValueError, IndexError, KeyError, TypeError, UnicodeDecodeError) as error:
        raise FileError(f"{path}: is no {path.suffix} file of spheres ({error})") from error
    wrong = np.flatnonzero(~(np.isfinite(values).all(axis=1) & (values[:, 3] > 0)))
    if not len(values) or len(wrong):
        which = f"; sphere {wrong[0] + 1} has {', '.join(map(str, values[wrong[0]]))}" if len(wrong) else ""
        raise FileError(
            f"{path}: holds {len(values)} spheres; allowed: finite numbers x, y, z and radii above 0{which}"
        )
    if stated is not None and stated not in UNITS:
        if unit is None:
            raise InputError(
                f"{path}: is in the units {stated} of LAMMPS; allowed: {', '.join(_LENGTHS)}, or give the unit of its "
                "lengths"
            )
        stated = None
    if None not in (unit, stated) and unit != stated:
        raise InputError(f"{path}: states that its lengths are in {stated}, and was to be read in {unit}")
    _check_unit(path, unit or stated, values[:, 3])
    factor = factor_of(unit or stated or _USUAL)
    values = values * factor
    return Particles(values[:, :3].copy(), values[:, 3].copy(), None if box is None else box * factor)


def _numbers(column, name):
    """A column as numbers; ValueError with the first that is none."""
    numbers = pd.to_numeric(column, errors="coerce").to_numpy(dtype=float)
    # what is empty, or says itself that it is no number, is told with its sphere
    wrong = np.flatnonzero(np.isnan(numbers) & column.notna().to_numpy())
    wrong = [k for k in wrong if str(column.iloc[k]).strip().lower() != "nan"]
    if wrong:
        raise ValueError(f"{name} of sphere {wrong[0] + 1} is {column.iloc[wrong[0]]!r}, which is no number")
    return numbers


def path_of(path):
    """What a user gave for a path, as a Path."""
    if not isinstance(path, str | os.PathLike):
        raise InputError(f"path is {path!r}; it must be the path of a file")
    return Path(path)


def _check_unit(path, unit, radius):
    """Raise an error for radii that no dust has in a unit, with the one in which they would most likely be.

    In that which is taken where none is stated, radii below `_DOUBTFUL` are an error too.
    """
    metres = radius * UNITS[unit or _USUAL]
    if is_dust(metres) and (unit is not None or np.median(metres) >= _DOUBTFUL):
        return
    likely = likely_unit(radius, UNITS)
    if is_dust(metres):
        raise InputError(
            f"{path}: states no unit, and read in {_USUAL} the radii have the median {np.median(metres):g} m: give the "
            f"unit, which is {likely} in all likelihood."
        )
    hint = "" if likely is None else f"; read in {likely} they would: give that as the unit"
    raise InputError(
        f"{path}: read in {unit or _USUAL} the radii have the median {np.median(metres):g} m, and those of dust lie "
        f"between {SMALLEST_RADIUS:g} and {LARGEST_RADIUS:g} m{hint}."
    )


def factor_of(unit):
    """Length of a unit of files [m]."""
    if unit not in UNITS:
        raise InputError(f"unit is {unit!r}; allowed: {', '.join(UNITS)}")
    return UNITS[unit]


def _through_the_faces(position, radius, box):
    """How many pairs of spheres touch through the faces of a periodic box with edges (3,)."""
    pairs = touching_pairs(position, radius * (1.0 + TOUCHING), periodic(box))
    return int(pairs[:, 2:].any(axis=1).sum())


def suffix_of(path):
    """That of a path in small letters."""
    return path.suffix.lower()


def reader_of(path):
    """The function that reads files with the suffix of a path; InputError where there is none."""
    if suffix_of(path) in TABLES:
        return _read_table
    if suffix_of(path) in XYZ:
        return _read_xyz
    if suffix_of(path) in DUMP:
        return _read_dump
    raise InputError(f"{path}: has the suffix {path.suffix!r}; allowed: {', '.join(SUFFIXES)}")


def _read_table(path, frame):
    """Columns x, y, z and r or radius, by their names or, without these, in this order."""
    separator = "," if suffix_of(path) == ".csv" else r"\s+"
    # some programs begin a file with a mark of its encoding
    lines = path.read_text(encoding="utf-8-sig").splitlines()
    # the names of the columns may stand in a comment, below others
    for k, line in enumerate(takewhile(lambda line: line.startswith("#"), lines)):
        if _names_columns(line.lstrip("# "), separator):
            lines[k] = line.lstrip("# ")
            break
    comments = [found[1] for line in lines if (found := _STATED.match(line))]
    lines = [line.partition("#")[0].strip() for line in lines]
    lines = [line for line in lines if line]
    if not lines:
        raise ValueError("it is empty")
    words = _words(lines[0], separator)
    named = any(re.match(r"[a-z]", word) and word not in ("nan", "inf") for word in words)
    names = ["x", "y", "z", "radius"]
    table = _columns(lines[int(named) :], [_name(word) for word in words] if named else None, separator)
    if not named:
        if len(table.columns) > len(names):
            raise ValueError(
                f"it has {len(table.columns)} columns; more than x y z r need their names in the first line"
            )
        table.columns = names[: len(table.columns)]
    of_lengths = [word for word in words if _name(word) in names]
    stated = {_unit(unit) for word in of_lengths for unit in _BRACKETS.findall(word)}
    stated |= {unit for word in of_lengths for unit in _UNIT.findall(word)} & set(UNITS)
    stated |= {_unit(_plain(unit)) for unit in comments}
    if len(stated) > 1:
        raise ValueError(f"its columns are in several units, {', '.join(sorted(stated))}")
    return table, None, next(iter(stated), None)


def _columns(lines, names, separator=r"\s+"):
    """The columns of some lines as text and numbers, as many as there are names where these are given."""
    if not lines:
        raise ValueError("it holds no spheres")
    try:
        table = pd.read_csv(StringIO("\n".join(lines)), sep=separator, header=None)
    except pd.errors.ParserError as error:
        raise ValueError("its rows differ in their number of columns") from error
    if names is not None:
        if len(names) != len(table.columns):
            raise ValueError(
                f"it names {len(names)} columns, {', '.join(names)}, and its rows have {len(table.columns)}"
            )
        table.columns = names
    return table


def _unit(name):
    """The unit of a name that a file has for it."""
    unit = _OTHER_NAMES.get(name, name)
    if unit not in UNITS:
        raise ValueError(f"its unit is {name!r}; allowed: {', '.join(UNITS)}")
    return unit


def _words(line, separator):
    """Words of a line of a table; a unit in brackets belongs to the name before it."""
    line = re.sub(r"\s+(?=[\[(])", "", line)
    return [_plain(word.strip().strip('"')) for word in re.split(separator, line)]


def _plain(word):
    """A word in small letters, with u for the letter mu, of which there are two."""
    return word.lower().replace("µ", "u").replace("μ", "u")


def _name(word):
    """Name of a column as we call it, without its unit."""
    return _COLUMNS.get(re.split(r"[\s\[(_]", word)[0], word)


def _names_columns(line, separator):
    """Whether a line names all columns that are needed."""
    return {"x", "y", "z", "radius"} <= {_name(word) for word in _words(line, separator)}


def _frames(lines, length):
    """Frames of a file as lists of lines; `length` gives that of the one that begins with some lines."""
    frames = []
    while lines:
        if not lines[0].strip():
            lines = lines[1:]
            continue
        n = length(lines)
        if n < 1:
            raise ValueError(f"a frame begins with {lines[0]!r}; allowed: the number of its spheres")
        if n > len(lines):
            raise ValueError(f"the last frame has {len(lines)} lines instead of {n}")
        frames.append(lines[:n])
        lines = lines[n:]
    return frames


def _chosen(frames, frame):
    if not -len(frames) <= frame < len(frames):
        raise ValueError(f"it has {len(frames)} frames, and frame {frame} was asked for")
    return frames[frame]


def _xyz_length(lines):
    """How many lines the first frame of a file has."""
    if not re.fullmatch(r"\s*-?\d+\s*", lines[0]):
        raise ValueError(f"a frame begins with {lines[0]!r}; allowed: the number of its spheres")
    return int(lines[0]) + 2


def _read_xyz(path, frame):
    lines = path.read_text(encoding="utf-8-sig").splitlines()
    if lines and not re.fullmatch(r"\s*(-?\d+)?\s*", lines[0]):
        raise ValueError("its first line must be the number of spheres; columns x y z r belong into .txt, .dat or .csv")
    frames = _frames(lines, _xyz_length)
    lines = _chosen(frames, frame)
    try:
        about = dict(word.partition("=")[::2] for word in shlex.split(lines[1]))
    except ValueError:  # a quotation that does not end, as in words of everyday language
        about = {}
    if "Properties" not in about:
        raise ValueError(
            "it has no radii; its second line must be that of extended XYZ: Properties=species:S:1:pos:R:3:radius:R:1"
        )
    fields = about["Properties"].split(":")
    names = []
    for name, _, width in zip(fields[::3], fields[1::3], fields[2::3], strict=True):
        names += (
            ["x", "y", "z"]
            if name == "pos"
            else [_COLUMNS.get(name, name)]
            if width == "1"
            else [f"{name}_{k}" for k in range(int(width))]
        )
    table = _columns(lines[2:], names)
    periodic = _periodic(about.get("pbc", "T T T" if "Lattice" in about else "F F F").split(), "T", "True", "true", "1")
    stated = about.get("unit", about.get("units"))
    stated = None if stated is None else _unit(_plain(stated))
    if "Lattice" not in about or not periodic:
        return table, None, stated
    return table, _diagonal(np.array(about["Lattice"].split(), dtype=float).reshape(3, 3)), stated


def _periodic(sides, *words):
    """Whether the edges of a box, as words of a file, are periodic, which these words mean."""
    found = {side in words for side in sides}
    if len(found) > 1:
        raise ValueError(f"the box is periodic along some axes only, {' '.join(sides)}; allowed: all of them, or none")
    return found == {True}


def _diagonal(lattice):
    if np.any(lattice - np.diag(np.diag(lattice))):
        raise ValueError("the box is not rectangular; allowed: edges along x, y and z")
    return np.diag(lattice).copy()


def _read_dump(path, frame):
    """One step of a text dump of LAMMPS."""
    lines = path.read_text(encoding="utf-8-sig").splitlines()
    # said once, before the first frame
    style = next((after for line, after in pairwise(lines) if line.startswith("ITEM: UNITS")), None)
    stated = None if style is None else _LENGTHS.get(style.strip(), style.strip())

    def length(lines):
        return section(lines, "ITEM: ATOMS") + 1 + int(lines[section(lines, "ITEM: NUMBER OF ATOMS") + 1])

    def section(lines, name):
        at = next((k for k, line in enumerate(lines) if line.startswith(name)), None)
        if at is None:
            raise ValueError(f"it has no line {name}")
        return at

    lines = _chosen(_frames(lines, length), frame)
    at, begin = section(lines, "ITEM: BOX BOUNDS"), section(lines, "ITEM: ATOMS")
    bounds = np.array([line.split() for line in lines[at + 1 : at + 4]], dtype=float)
    if bounds.shape[1] != 2:
        raise ValueError("the box is not rectangular; allowed: edges along x, y and z")
    names = lines[begin].split()[2:]
    if {"xu", "yu", "zu"} <= set(names):  # beside those that are wrapped into the box
        names = [f"{name}_wrapped" if name in ("x", "y", "z") else name for name in names]
    table = _columns(lines[begin + 1 :], [_COLUMNS.get(name, name) for name in names])
    if "id" in table:
        table = table.sort_values("id", ignore_index=True)
    periodic = _periodic(lines[at].split("BOUNDS")[1].split(), "pp")
    return table, bounds[:, 1] - bounds[:, 0] if periodic else None, stated
