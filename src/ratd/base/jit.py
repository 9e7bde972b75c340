"""The one place that holds the flags of every compiled function.

numba's own cache notices a change of the file that a function stands in, but not of the files that it calls into.
The cache folder is therefore keyed by the content of every source file that compiled code may depend on: a change in
any of them compiles anew, a change of a figure does not.
"""

import hashlib
import os
import re
from functools import partial
from pathlib import Path

import numba
import numpy as np


def _source_digest():
    """Hash of the files with compiled code and of all files of the package that they import, directly or not."""
    root = Path(__file__).parent.parent
    names = {".".join(path.relative_to(root.parent).with_suffix("").parts): path for path in root.rglob("*.py")}
    texts = {name: path.read_bytes() for name, path in names.items()}
    wanted = [name for name, text in texts.items() if b"ratd.base.jit import" in text]
    needed = set()
    while wanted:
        name = wanted.pop()
        if name in texts and name not in needed:
            needed.add(name)
            wanted += [found.decode() for found in re.findall(rb"^from (ratd[\w.]*) import", texts[name], re.MULTILINE)]
    digest = hashlib.sha256()
    for name in sorted(needed):
        digest.update(name.encode())
        digest.update(texts[name])
    digest.update(f"numba {numba.__version__} numpy {np.__version__}".encode())
    return digest.hexdigest()[:16]


def _cache_root():
    """Folder for compiled code: RATD_CACHE, else the user's cache folder."""
    if "RATD_CACHE" in os.environ:
        return Path(os.environ["RATD_CACHE"])
    base = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(base) / "ratd"


numba.config.CACHE_DIR = str(_cache_root() / f"numba-{_source_digest()}")

# error_model="numpy": a division by zero gives inf, as in numpy; the check for it would block vectorisation.
# contract: a*b + c may become one fused instruction. Nothing else is relaxed, so results repeat bit for bit.
FLAGS = dict(cache=True, error_model="numpy", fastmath={"contract"}, nogil=True)

jit = partial(numba.njit, **FLAGS)
