"""Compiled code on disk, shared by all processes of a user: what one compiles the others wait for and load.

numba's cache leaves two things to chance. Processes that start together, such as the jobs of a pipeline, compile the
same function each for itself, which takes minutes in place of the seconds of loading it. And two of them that save
other signatures of one function at the same moment may write the code of one under the name of the other. A third
thing costs time: it keeps the code of two checkouts apart, though their sources are the same.
"""

import fcntl
import hashlib
import os
import time
from pathlib import Path

from numba.core import config, types
from numba.core.caching import CompileResultCacheImpl, FunctionCache, UserProvidedCacheLocator

__all__ = ["OwnCache"]

PATIENCE = 600.0
"""Seconds that a process waits for the code that another one compiles, before it compiles it itself."""
LOOKS = 0.05
"""Seconds between two looks."""

_PACKAGE = Path(__file__).parent.parent
_held = {}  # path of a lock -> its open file


class _InPackage(UserProvidedCacheLocator):
    """A place by the path below the package, the same in every checkout; that of other files is left to numba."""

    def __init__(self, function, file):
        super().__init__(function, file)
        self._cache_path = os.path.join(config.CACHE_DIR, Path(file).relative_to(_PACKAGE).with_suffix(""))

    @classmethod
    def from_function(cls, function, file):
        return super().from_function(function, file) if Path(file).is_relative_to(_PACKAGE) else None


class _Saved(CompileResultCacheImpl):
    _locator_classes = [_InPackage, *CompileResultCacheImpl._locator_classes]


class OwnCache(FunctionCache):
    """Compiled code on disk, but not that of parts from outside the package: it would not notice when they change."""

    _impl_class = _Saved

    def load_overload(self, sig, target_context):
        if _foreign(sig):
            return None
        found = super().load_overload(sig, target_context)
        if found is None and _take(self._lock(sig)):
            # another process may have compiled it meanwhile
            found = super().load_overload(sig, target_context)
            if found is not None:
                _give(self._lock(sig))
        return found

    def save_overload(self, sig, data):
        if _foreign(sig):
            return
        # the index of a function is read and written as a whole
        whole = self._lock("index")
        _take(whole)
        try:
            super().save_overload(sig, data)
        finally:
            _give(whole)
            _give(self._lock(sig))

    def _lock(self, sig):
        name = hashlib.sha256(str(sig).encode()).hexdigest()[:16]
        return Path(self.cache_path) / f"{self._impl.filename_base}.{name}.lock"


def _take(path):
    """Wait until no other process holds a lock, `PATIENCE` at most, and hold it; whether it is held now.

    False where files cannot be locked: then each process is on its own, as with numba's cache.
    """
    if path in _held:
        return True
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        file = open(path, "wb")
    except OSError:
        return False
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            time.sleep(LOOKS)
        except OSError:
            break
        else:
            _held[path] = file
            return True
    file.close()
    return False


def _give(path):
    """Let go of a lock."""
    file = _held.pop(path, None)
    if file is not None:
        file.close()


def _foreign(kinds):
    for kind in kinds:
        if isinstance(kind, types.NamedTuple | types.NamedUniTuple):
            if not kind.instance_class.__module__.startswith("ratd.") or _foreign(kind):
                return True
    return False
