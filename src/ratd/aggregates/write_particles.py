"""Spheres in files of other programs: text, CSV, extended XYZ and LAMMPS dumps, written."""

import warnings
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr

from ratd.aggregates.grain import Grain
from ratd.aggregates.particles import STYLES, TABLES, XYZ, Particles, factor_of, path_of, reader_of, suffix_of
from ratd.base.checks import is_number
from ratd.base.errors import InputError
from ratd.pipeline.atomic import write_text

__all__ = ["write_particles"]


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
    path = path_of(path)
    factor = factor_of(unit)
    reader_of(path)
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
    if suffix_of(path) in TABLES:
        if len(frames) > 1:
            raise InputError(f"{path}: a {path.suffix} file holds one frame, but there are {len(frames)}; use .xyz")
        if frames[0][1] is not None:
            warnings.warn(f"{path}: a {path.suffix} file does not hold the periodic box; use .xyz", stacklevel=2)
        text = frames[0][0].rename(columns={"radius": "r"}).assign(**_scaled(frames[0][0], factor, radius="r"))
        if unit != "nm":
            text = text.rename(columns={name: f"{name}[{unit}]" for name in "xyzr"})
        text = text.to_csv(sep=TABLES[suffix_of(path)], index=False, float_format="%.12g")
    else:
        write = _xyz if suffix_of(path) in XYZ else _dump
        if write is _dump and unit not in STYLES:
            raise InputError(f"{path}: LAMMPS has no units with {unit}; allowed: {', '.join(STYLES)}")
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
    first = f"ITEM: UNITS\n{STYLES[about['unit']]}\n" if step == 0 and about["unit"] != "nm" else ""
    return (
        f"{first}ITEM: TIMESTEP\n{step}\nITEM: NUMBER OF ATOMS\n{len(table)}\nITEM: BOX BOUNDS {sides}\n{edges}"
        f"ITEM: ATOMS {columns}\n{rows}"
    )
