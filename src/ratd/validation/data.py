"""The tables that docs/validation.md is written from: one file a check, with the cases of its pieces.

The checks take hours to compute, and what they find is small. So the tables are kept, and the document can be written
from them at any time. A piece stays as long as the config asks for it with the same settings; the source may have
changed since, and stands in the file.
"""

import json
from importlib import import_module
from pathlib import Path

from ratd.base.errors import FileError
from ratd.base.markdown import markdown_table
from ratd.pipeline import io
from ratd.pipeline.provenance import file_hash, settings_hash
from ratd.validation.tables import CASE, read_tables

FOLDER = "docs/validation/data"
README = "README.md"
KEPT = ("settings_hash", "code_hash", "versions")
"""Attributes of each piece that its table keeps."""


def kind_of(check):
    """Kind of the files of a check, by its name."""
    return import_module(f"ratd.validation.{check}").KIND


def table_path(folder, check):
    """File of a check, str."""
    return str(Path(folder, f"{check}.nc"))


def present(folder, checks):
    """Files of some checks, as far as they are there; list of str."""
    return [path for path in (table_path(folder, check) for check in checks) if Path(path).is_file()]


def check_table(folder, check):
    """Cases of a check, see `ratd.validation.tables.read_tables`."""
    return read_tables([table_path(folder, check)], kind_of(check))


def read_pieces(folder, check):
    """Pieces of a table.

    Parameters
    ----------
    folder : path-like
    check : str

    Returns
    -------
    dict of str to xarray.Dataset
        Name -> its cases, with the attributes `KEPT`. None of a table that is damaged or not there.
    """
    try:
        table = io.read(table_path(folder, check), kind_of(check))
    except FileError:
        return {}
    found, first = {}, 0
    bare = table.drop_attrs()
    for name, cases, kept in json.loads(table.attrs.get("pieces", "[]")):
        found[name] = bare.isel({CASE: slice(first, first + cases)}).assign_attrs(kept)
        first += cases
    return found


def lacking(there, pieces):
    """Names of the pieces that a table lacks, or has with other settings.

    Parameters
    ----------
    there : dict
        From `read_pieces`.
    pieces : dict
        Name of a piece -> its settings, as in `ratd.validation.plan.Plan.pieces`.

    Returns
    -------
    list of str
    """
    return [
        name
        for name, settings in pieces.items()
        if name not in there or there[name].attrs["settings_hash"] != settings_hash(settings)
    ]


def is_whole(there, pieces):
    """Whether a table has all pieces and no other. Parameters as of `lacking`."""
    return list(there) == list(pieces) and not lacking(there, pieces)


def whole_tables(folder, checks):
    """Tables of some checks.

    Parameters
    ----------
    folder : path-like
    checks : dict
        Check -> its pieces, as of `lacking`.

    Returns
    -------
    dict of str to pandas.DataFrame or None
        Check -> its cases, see `ratd.validation.tables.read_tables`; None where `is_whole` does not hold.
    """
    found = {}
    for check, pieces in checks.items():
        there = read_pieces(folder, check)
        whole = is_whole(there, pieces)
        found[check] = io.join_tables(list(there.values())).to_dataframe() if whole else None
    return found


def collect(folder, check, paths, pieces):
    """Write the table of a check from those of its pieces that it has, and the files of others.

    Parameters
    ----------
    folder : path-like
    check : str
    paths : list of path-like
        Files of pieces, named after them.
    pieces : dict
        As of `lacking`. Pieces that are not among them are left out.

    Raises
    ------
    FileError
        If a file was made with other settings.
    """
    kind = kind_of(check)
    there = read_pieces(folder, check)
    if not paths and is_whole(there, pieces):
        return
    there = {name: there[name] for name in pieces.keys() - set(lacking(there, pieces))}
    for path in map(Path, paths):
        there[path.stem] = io.read(path, kind)
        if there[path.stem].attrs["settings_hash"] != settings_hash(pieces[path.stem]):
            raise FileError(
                f"{path}: was made with other settings than the config has; allowed: results of this config "
                "(remove the file to make it anew)"
            )
    parts = {name: there[name] for name in pieces if name in there}
    index = [
        [name, part.sizes[CASE], {attribute: part.attrs[attribute] for attribute in KEPT}]
        for name, part in parts.items()
    ]
    table = io.join_tables(list(parts.values())).assign_attrs(pieces=json.dumps(index))
    io.write(table_path(folder, check), table, kind)


def finish(folder, checks, command):
    """Remove tables that are not asked for, and say what the folder holds.

    Parameters
    ----------
    folder : path-like
    checks : dict
        Check -> its pieces, as of `lacking`.
    command : str
        What collected them.
    """
    for path in set(Path(folder).glob("*.nc")) - {Path(table_path(folder, check)) for check in checks}:
        path.unlink()
    rows = []
    for check, pieces in checks.items():
        held = read_pieces(folder, check).values()
        cases, source = sum(piece.sizes[CASE] for piece in held), sorted({piece.attrs["code_hash"] for piece in held})
        for path in map(Path, present(folder, [check])):
            cells = [f"{len(held)} of {len(pieces)}", cases, "; ".join(source)]
            rows.append([f"`{path.name}`", *cells, f"{path.stat().st_size / 1e3:.1f}", file_hash(path)])
    table = markdown_table(["file", "pieces", "cases", "source", "kB", "hash"], rows)
    io.write_text(Path(folder, README), TEXT.format(command=command, table=table))


TEXT = """# Data behind docs/validation.md

Collected by

    {command}

from what `config/validation.yaml` asks for. `snakemake --cores 2 validation_report` draws the figures and writes the
document from these files alone. A piece of a check stays while the config asks for it with the same settings, also when
the source has changed since; to have a check computed anew, remove its table and run the command again. Each table
names in its attribute `pieces` its pieces one after the other: how many cases, the hash of the settings and of the
source, and the versions that it was made with:

{table}
"""
