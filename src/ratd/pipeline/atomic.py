"""Files that are complete or not there: written under another name, flushed to the disk, and only then renamed."""

import errno
import os
import shutil
from contextlib import contextmanager, suppress
from pathlib import Path

from ratd.base.errors import FileError

FULL = 2**19
"""A disk with less room than this [bytes] is full, whatever the library says that failed to write."""


@contextmanager
def atomic(path):
    """A name to write a file under, which becomes `path` when everything went well.

    Parameters
    ----------
    path : path-like
        The file to write. Its folder is made if needed.

    Yields
    ------
    Path
        ``NAME.<process number>.tmp`` in the same folder. On success it is flushed to the disk and renamed in one step;
        on failure it is removed and `path` stays as it was. What killed processes left behind is removed first.

    Raises
    ------
    FileError
        If the file cannot be written, e.g. because the disk is full.
    """
    path = Path(path)
    temporary = path.with_name(f"{path.name}.{os.getpid()}.tmp")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        _remove_left_over(path)
        yield temporary
        with open(temporary, "rb") as handle:
            os.fsync(handle.fileno())
        os.replace(temporary, path)
        folder = os.open(path.parent, os.O_RDONLY)
        try:
            os.fsync(folder)
        finally:
            os.close(folder)
    except OSError as error:
        if isinstance(error, FileError):
            raise
        raise FileError(f"{path}: cannot be written ({reason(error, path)})") from error
    finally:
        with suppress(OSError):
            temporary.unlink()


def reason(error, path):
    """Why a file cannot be written: the words of an error, or those for a full disk, which libraries do not have."""
    with suppress(OSError):
        if shutil.disk_usage(Path(path).parent).free < FULL:
            return os.strerror(errno.ENOSPC)
    return getattr(error, "strerror", None) or str(error)


def _remove_left_over(path):
    """Remove the temporary files of this path whose processes have ended."""
    for other in path.parent.glob(f"{_literal(path.name)}.*.tmp"):
        number = other.name[len(path.name) + 1 : -len(".tmp")]
        if number.isdigit() and int(number) != os.getpid() and not _is_alive(int(number)):
            other.unlink(missing_ok=True)


def _literal(name):
    """Pattern of glob that matches this name alone."""
    return "".join(f"[{letter}]" if letter in "*?[" else letter for letter in name)


def _is_alive(process):
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except OSError:  # it is somebody else's
        return True
    return True


def write_text(path, text):
    """Write a text file in one step, see `atomic`.

    Parameters
    ----------
    path : path-like
    text : str
    """
    with atomic(path) as temporary:
        temporary.write_text(text, encoding="utf-8")
