"""Spheres in files of other programs: text, CSV, extended XYZ and LAMMPS dumps, read and written."""

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
import xarray as xr

from ratd.aggregates.grain import Grain
from ratd.base.checks import LARGEST_RADIUS, SMALLEST_RADIUS, is_dust, is_number, is_whole, likely_unit
from ratd.base.errors import FileError, InputError
from ratd.base.materials import Material
from ratd.pipeline.atomic import write_text

__all__ = ["Particles", "read_particles", "write_particles"]

UNITS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "nm": 1e-9, "angstrom": 1e-10}
"""Units of length in files, in m."""
_USUAL, _DOUBTFUL = "nm", 1e-9
"""The unit of a file that states none, and the median radius [m] below which another one is likely."""
_COLUMNS = {"x": "x", "y": "y", "z": "z", "r": "radius", "radius": "radius", "xu": "x", "yu": "y", "zu": "z"}
_STYLES = {"m": "si", "cm": "cgs", "um": "micro", "nm": "nano", "angstrom": "metal"}
"""Unit of length -> style of units in LAMMPS, which its dumps may name."""
_LENGTHS = {style: unit for unit, style in _STYLES.items()} | {"real": "angstrom"}
"""Style of units in LAMMPS -> unit of length; others have none that dust is measured in."""
_BRACKETS = re.compile(r"[\[(]\s*([^\])]+?)\s*[\])]")
_OTHER_NAMES = {"micron": "um", "microns": "um", "micrometer": "um", "a": "angstrom", "å": "angstrom"}
"""Other names of `UNITS`."""
_UNIT = re.compile(r"[\s\[(_]([a-z]+)")
_TABLES = {".csv": ",", ".txt": " ", ".dat": " "}
_PARTED = {",": "commas", " ": "blanks or tabs"}
_XYZ, _DUMP = (".xyz", ".extxyz"), (".dump", ".lammpstrj", ".lammps")
SUFFIXES = (*_TABLES, *_XYZ, *_DUMP)


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
        """The aggregate of these spheres, see `ratd.Grain`."""
        return Grain(self.position, self.radius, material, **about)


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
        in the names of its columns, ``unit=um`` in extended XYZ, the style of units of LAMMPS), or nm. A unit in
        brackets that is none is an error.
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
    path = _path(path)
    if unit is not None:
        _factor(unit)
    reader = _reader(path)
    if not is_whole(frame):
        raise InputError(f"frame is {frame!r}; it must be a whole number")
    try:
        table, box, stated = reader(path, frame)
        missing = [name for name in ("x", "y", "z", "radius") if name not in table]
        if missing:
            hint = ""
            if len(table.columns) == 1 and path.suffix in _TABLES:
                hint = f"; in a {path.suffix} file columns are parted by {_PARTED[_TABLES[path.suffix]]}"
            raise ValueError(f"there is no column {', '.join(missing)}; the columns are {', '.join(table)}{hint}")
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
    factor = _factor(unit or stated or _USUAL)
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


def _path(path):
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


def _factor(unit):
    if unit not in UNITS:
        raise InputError(f"unit is {unit!r}; allowed: {', '.join(UNITS)}")
    return UNITS[unit]


def _reader(path):
    if path.suffix in _TABLES:
        return _read_table
    if path.suffix in _XYZ:
        return _read_xyz
    if path.suffix in _DUMP:
        return _read_dump
    raise InputError(f"{path}: has the suffix {path.suffix!r}; allowed: {', '.join(SUFFIXES)}")


def _read_table(path, frame):
    """Columns x, y, z and r or radius, by their names or, without these, in this order."""
    separator = "," if path.suffix == ".csv" else r"\s+"
    # some programs begin a file with a mark of its encoding
    lines = path.read_text(encoding="utf-8-sig").splitlines()
    # the names of the columns may stand in a comment, below others
    for k, line in enumerate(takewhile(lambda line: line.startswith("#"), lines)):
        if _names_columns(line.lstrip("# "), separator):
            lines[k] = line.lstrip("# ")
            break
    lines = [line.partition("#")[0].strip() for line in lines]
    lines = [line for line in lines if line]
    if not lines:
        raise ValueError("it is empty")
    words = _words(lines[0], separator)
    named = any(re.match(r"[a-z]", word) and word not in ("nan", "inf") for word in words)
    table = pd.read_csv(StringIO("\n".join(lines[int(named) :])), sep=separator, header=None)
    if named and len(words) != len(table.columns):
        raise ValueError(f"its first line names {len(words)} columns, and the next one has {len(table.columns)}")
    names = ["x", "y", "z", "radius"]
    if not named and len(table.columns) > len(names):
        raise ValueError(f"it has {len(table.columns)} columns; more than x y z r need their names in the first line")
    table.columns = [_name(word) for word in words] if named else names[: len(table.columns)]
    of_lengths = [word for word in words if _name(word) in names]
    stated = {_unit(unit) for word in of_lengths for unit in _BRACKETS.findall(word)}
    stated |= {unit for word in of_lengths for unit in _UNIT.findall(word)} & set(UNITS)
    if len(stated) > 1:
        raise ValueError(f"its columns are in several units, {', '.join(sorted(stated))}")
    return table, None, next(iter(stated), None)


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
    while lines and any(line.strip() for line in lines):
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


def _read_xyz(path, frame):
    lines = path.read_text(encoding="utf-8-sig").splitlines()
    if lines and not re.fullmatch(r"\s*(-?\d+)?\s*", lines[0]):
        raise ValueError("its first line must be the number of spheres; columns x y z r belong into .txt, .dat or .csv")
    frames = _frames(lines, lambda lines: int(lines[0]) + 2)
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
    table = pd.read_csv(StringIO("\n".join(lines[2:])), sep=r"\s+", header=None, names=names)
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
    body = StringIO("\n".join(lines[begin + 1 :]))
    table = pd.read_csv(body, sep=r"\s+", header=None, names=[_COLUMNS.get(name, name) for name in names])
    if "id" in table:
        table = table.sort_values("id", ignore_index=True)
    periodic = _periodic(lines[at].split("BOUNDS")[1].split(), "pp")
    return table, bounds[:, 1] - bounds[:, 0] if periodic else None, stated


def write_particles(content, path: str | Path, unit: str = "nm") -> None:
    """Write spheres to a file that OVITO, ASE and others read.

    Parameters
    ----------
    content : ratd.Grain, Particles, or xarray.Dataset
        A grain; what `read_particles` gives; or a run: its snapshots, a frame each, or its last state without any.
    path : path-like
        By its suffix one of the formats of `read_particles`. Text and CSV hold one frame.
    unit : str, optional
        Of all lengths in the file; forces are in nN.

    Notes
    -----
    A unit other than nm is stated in the file: in the names of the columns (``x[um]``), or as LAMMPS states it. Text
    and CSV do not hold the periodic box, of which a warning tells.

    Besides positions and radii the columns are: ``fragment``, the number of the fragment or piece, 0 being the largest;
    ``normal_force``, that of greatest magnitude on each monomer, above 0 where it pushes [nN]. Monomers that were
    dropped are left out. The frames of a spin-up are those of the frame that turns with the grain.

    Raises
    ------
    InputError
        If the content, the unit or the suffix is not one of these, or the run has nothing to write.
    """
    path = _path(path)
    factor = _factor(unit)
    _reader(path)
    if not isinstance(content, Grain | Particles | xr.Dataset):
        raise InputError(
            f"content is of type {type(content).__name__}; it must be a ratd.Grain, spheres of ratd.read_particles, or "
            "a run"
        )
    frames = list(_contents(content))
    if not frames:
        raise InputError(
            f"{path}: the run holds no snapshots to write and no last state; make it with snapshot_every above 0 (a "
            "compression with snapshots, a list of filling factors)"
        )
    if path.suffix in _TABLES:
        if len(frames) > 1:
            raise InputError(f"{path}: a {path.suffix} file holds one frame, but there are {len(frames)}; use .xyz")
        if frames[0][1] is not None:
            warnings.warn(f"{path}: a {path.suffix} file does not hold the periodic box; use .xyz", stacklevel=2)
        text = frames[0][0].rename(columns={"radius": "r"}).assign(**_scaled(frames[0][0], factor, radius="r"))
        if unit != "nm":
            text = text.rename(columns={name: f"{name}[{unit}]" for name in "xyzr"})
        text = text.to_csv(sep=_TABLES[path.suffix], index=False, float_format="%.12g")
    else:
        write = _xyz if path.suffix in _XYZ else _dump
        if write is _dump and unit not in _STYLES:
            raise InputError(f"{path}: LAMMPS has no units with {unit}; allowed: {', '.join(_STYLES)}")
        text = "".join(
            write(
                table.assign(**_scaled(table, factor)), None if box is None else box / factor, about | {"unit": unit}, k
            )
            for k, (table, box, about) in enumerate(frames)
        )
    write_text(path, text)


def _scaled(table, factor, radius="radius"):
    """Columns of lengths in the unit of the file."""
    names = {"x": "x", "y": "y", "z": "z", "radius": radius}
    return {new: table[name] / factor for name, new in names.items()}


def _contents(content):
    """Frames: a table of columns in SI units (forces in nN), edges of the box or None, and what is said of it."""
    if isinstance(content, Grain | Particles):
        yield _table(content.position, content.radius), getattr(content, "box", None), {}
    elif "snapshot_omega" in content:
        for k in range(content.sizes["snapshot"]):
            snapshot = content.isel(snapshot=k)
            fragment = snapshot["snapshot_fragment"].values
            position = np.stack([snapshot[f"snapshot_{axis}"].values for axis in "xyz"], axis=1)
            force = snapshot["snapshot_normal_force"].values * 1e9
            table = _table(position, content["monomer_radius"].values, fragment=fragment, normal_force=force)
            yield table[fragment >= 0], None, {"omega": float(snapshot["snapshot_omega"])}
    elif content.sizes.get("snapshot", 0):
        for k in range(content.sizes["snapshot"]):
            if "snapshot_time" in content:
                time = float(content["snapshot_time"].values[k])
                record = int(np.abs(content["time"].values - time).argmin())
                more, about = {"fragment": content["snapshot_piece"].values[k]}, {"time": time}
            else:
                phi = float(content["snapshot_phi"].values[k])
                record = int(np.abs(content["phi"].values - phi).argmin())
                more, about = {}, {"phi": phi}
            yield _table(content["snapshot_position"].values[k], _radii(content), **more), _box(content, record), about
    elif "position" in content:
        more = {"fragment": content["piece"].values} if "piece" in content else {}
        about = {"time": float(content["time"].values[-1])}
        yield _table(content["position"].values, _radii(content), **more), _box(content, -1), about


def _radii(run):
    return run["radius" if "radius" in run else "monomer_radius"].values


def _box(run, record):
    """Edges of the box at a record, None in open space."""
    box = run["box_length"].values[record] if "box_length" in run else np.zeros(3)
    return box if np.all(box > 0) else None


def _table(position, radius, **more):
    return pd.DataFrame(dict(zip("xyz", np.transpose(position), strict=True)) | {"radius": radius} | more)


def _rows(table):
    return table.to_csv(sep=" ", header=False, index=False, float_format="%.12g", lineterminator="\n")


def _xyz(table, box, about, step):
    kinds = {name: "I" if table[name].dtype.kind == "i" else "R" for name in table if name not in ("x", "y", "z")}
    properties = "species:S:1:pos:R:3:" + ":".join(f"{name}:{kind}:1" for name, kind in kinds.items())
    words = [f"Properties={properties}", *(f"{name}={_word(value)}" for name, value in about.items())]
    if box is not None:
        words.append(f'Lattice="{box[0]:.12g} 0 0 0 {box[1]:.12g} 0 0 0 {box[2]:.12g}" pbc="T T T"')
    else:
        words.append('pbc="F F F"')
    # no monomer is an atom: X is ASE's name for what is none
    return f"{len(table)}\n{' '.join(words)}\n{_rows(table.assign(species='X')[['species', *table]])}"


def _word(value):
    return f"{value:.9g}" if is_number(value) else value


def _dump(table, box, about, step):
    place = table[["x", "y", "z"]]
    low, high = place.min() - table["radius"].max(), place.max() + table["radius"].max()
    if box is not None:
        low, high = pd.Series(np.zeros(3), list("xyz")), pd.Series(box, list("xyz"))
    edges = "".join(f"{low[axis]:.12g} {high[axis]:.12g}\n" for axis in "xyz")
    sides = "pp pp pp" if box is not None else "ff ff ff"
    columns = "id type " + " ".join("xu yu zu".split() + list(table.columns[3:]))
    rows = _rows(table.assign(id=table.index + 1, type=1)[["id", "type", *table]])
    first = f"ITEM: UNITS\n{_STYLES[about['unit']]}\n" if step == 0 and about["unit"] != "nm" else ""
    return (
        f"{first}ITEM: TIMESTEP\n{step}\nITEM: NUMBER OF ATOMS\n{len(table)}\nITEM: BOX BOUNDS {sides}\n{edges}"
        f"ITEM: ATOMS {columns}\n{rows}"
    )
