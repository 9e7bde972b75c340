"""Keep a run in a file, and go on from it with the same bits."""

import hashlib
import os
import warnings
import zipfile
from functools import cache
from pathlib import Path

import numpy as np

from ratd.base.errors import FileError, InputError
from ratd.engine.state import State, copied
from ratd.pipeline.atomic import atomic
from ratd.pipeline.provenance import source_hash


_FIRST = b"key.npy"
"""Name of the first member of a checkpoint; names stand 30 bytes behind the beginning of a member of a zip."""


def fingerprint(module, arrays, *settings):
    """What a checkpoint must have been made with to be of use. What one source has begun no other goes on with.

    Parameters
    ----------
    module : str
        Name of the module that makes the run.
    arrays : iterable of array
    settings
        With a plain `repr`.

    Returns
    -------
    str
        Hash of all of them, and of the source of the module and of those of ratd that it imports.
    """
    digest = hashlib.sha256(_source(module).encode())
    for array in arrays:
        digest.update(np.ascontiguousarray(array).tobytes())
    digest.update(repr(settings).encode())
    return digest.hexdigest()


@cache
def _source(module):
    return source_hash(modules=[module])


def save(path, key, state, **tables):
    """Write a state and tables of numbers to a file, which is replaced whole or not at all."""
    tables = {f"table_{name}": np.array(table) for name, table in tables.items()}
    with atomic(path) as temporary, open(temporary, "wb") as file:
        np.savez(file, key=key, **tables, **state._asdict())


def load(path, key):
    """State and dict of tables of a file; None when there is none, or it is damaged or of another run.

    Raises
    ------
    InputError, FileError
        If no checkpoint can be written there, or a file of another kind stands there, which the next checkpoint would
        replace: that is better known before a long run than in its middle.

    Warns
    -----
    UserWarning
        If there is one of another run, which the next checkpoint replaces.
    """
    if path is None:
        return None
    if not isinstance(path, str | os.PathLike):
        raise InputError(f"checkpoint is {path!r}; it must be the path of a file, or None.")
    _check_place(Path(path))
    if not Path(path).exists():
        return None
    try:
        with np.load(path, allow_pickle=False) as file:
            if str(file["key"]) != key:
                warnings.warn(
                    f"{path}: is the checkpoint of a run with other arguments, or of another version of ratd; this run "
                    "begins anew, and its first checkpoint, in a minute, replaces that one",
                    UserWarning,
                    stacklevel=4,
                )
                return None
            state = copied(State(**{name: file[name] for name in State._fields}))
            tables = {name[6:]: file[name] for name in file.files if name.startswith("table_")}
            return state, tables
    # a damaged file may say anything of itself, also that it is encrypted
    except (OSError, ValueError, KeyError, EOFError, NotImplementedError, RuntimeError, zipfile.BadZipFile):
        return None


def _check_place(path):
    """Raise FileError where no file can be written."""
    if path.is_dir():
        raise FileError(f"{path}: is a folder; allowed: the name of a file for the checkpoint")
    if path.exists() and path.stat().st_size and not _begins_as_one(path):
        raise FileError(f"{path}: holds something else than a checkpoint; allowed: the name of a new file, or of one")
    folder = next(folder for folder in path.absolute().parents if folder.exists())
    if not folder.is_dir() or not os.access(folder, os.W_OK):
        raise FileError(f"{path}: no checkpoint can be written below {folder}")


def _begins_as_one(path):
    """Whether a file begins as `save` writes it, a zip with the key as its first member; also one that was cut off."""
    with open(path, "rb") as file:
        head = file.read(30 + len(_FIRST))
    return head[:2] == b"PK" and head[30:] == _FIRST
