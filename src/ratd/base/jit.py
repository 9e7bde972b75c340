"""The one place that holds the flags of every compiled function.

numba's own cache notices a change of the file that a function stands in, but not of the files that it calls into.
The cache folder is therefore keyed by the content of every source file of the package that compiled code may depend on:
a change in any of them compiles anew, a change of a figure does not.
"""

import hashlib
import os
from pathlib import Path

import numba
import numpy as np

from ratd.base.own_cache import OwnCache
from ratd.base.parts import FLAGS

COMPILED = ("base", "laws", "geometry", "engine", "drives", "observables", "aggregates", "experiments")
"""Layers with compiled code."""


def _source_digest():
    root = Path(__file__).parent.parent
    digest = hashlib.sha256()
    for layer in COMPILED:
        for path in sorted((root / layer).rglob("*.py")):
            text = path.read_bytes()
            if b"base.jit import jit" in text or b"base.parts import" in text or layer in ("base", "laws", "engine"):
                digest.update(str(path.relative_to(root)).encode())
                digest.update(text)
    digest.update(f"numba {numba.__version__} numpy {np.__version__}".encode())
    return digest.hexdigest()[:16]


def _cache_root():
    """Folder for compiled code: RATD_CACHE, else the user's cache folder."""
    if "RATD_CACHE" in os.environ:
        return Path(os.environ["RATD_CACHE"])
    base = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(base) / "ratd"


numba.config.CACHE_DIR = str(_cache_root() / f"numba-{_source_digest()}")


def cache_file(name):
    """A path in the folder of the compiled code of this version."""
    return Path(numba.config.CACHE_DIR) / name


def jit(function=None, **options):
    """`numba.njit` with the flags of the package (`ratd.base.parts.FLAGS`) and a cache on disk; a decorator."""
    if function is None:
        return lambda inner: jit(inner, **options)
    compiled = numba.njit(**(FLAGS | options))(function)
    compiled._cache = OwnCache(function)
    return compiled
