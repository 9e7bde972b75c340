"""Keep a run in a file, and go on from it with the same bits."""

import hashlib
import os
import zipfile
from functools import cache
from pathlib import Path

import numpy as np

from ratd.engine.state import State, copied
from ratd.pipeline.provenance import source_hash


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
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f"{path.name}.{os.getpid()}.tmp")
    with open(temporary, "wb") as file:
        tables = {f"table_{name}": np.array(table) for name, table in tables.items()}
        np.savez(file, key=key, **tables, **state._asdict())
        file.flush()
        os.fsync(file.fileno())
    os.replace(temporary, path)


def load(path, key):
    """State and dict of tables of a file; None when there is none, or it is damaged or of another run."""
    if path is None or not Path(path).exists():
        return None
    try:
        with np.load(path, allow_pickle=False) as file:
            if str(file["key"]) != key:
                return None
            state = copied(State(**{name: file[name] for name in State._fields}))
            tables = {name[6:]: file[name] for name in file.files if name.startswith("table_")}
            return state, tables
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
        return None
