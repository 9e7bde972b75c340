"""Finished grains of files that are not finished: kept on the disk, found again after a kill, removed at the end.

Grains that are finished go into small files, pieces, in the folder `TARGET.partial`, which Snakemake does not know of,
with the hashes of the source, settings and inputs, and the versions, that they were made with. A job that was killed
takes from there what still fits, and only that.

This module decides no number: it is left out of all source hashes (see `ratd.pipeline.provenance`).
"""

import fcntl
import os
import re
import shutil
import time
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

from ratd.base.errors import FileError
from ratd.base.materials import Material
from ratd.pipeline import blocks, io
from ratd.pipeline.provenance import settings_hash

_OWN_NAMES = r"lock|seed_\d+(\.nc|\.[0-9a-f]+\.checkpoint)(\.\d+\.tmp)?"
TRIES = 100
"""How often a lock is tried whose folder is removed meanwhile."""
WORK_BETWEEN_PIECES = 20
"""Work that a kill may cost, over the time that writing a piece takes: short grains share one."""


@dataclass(frozen=True)
class Block:
    """A file to write, with the grains of one block.

    Attributes
    ----------
    target : Path
        The file.
    material : ratd.base.materials.Material
        What the grains are made of.
    seeds : list of int
        Seeds of the grains, in the order in which they stand in the file.
    provenance : dict
        Attributes of the file, from `ratd.pipeline.provenance.provenance`.
    """

    target: Path
    material: Material
    seeds: list
    provenance: dict

    @property
    def folder(self):
        """Folder of the finished grains while the file is not finished."""
        return partial_folder(self.target)

    def piece(self, seed):
        """File of finished grains, of which this seed is the first."""
        return self.folder / f"seed_{seed}.nc"

    def checkpoint(self, seed):
        """Below this path a grain may keep what it needs to go on in its middle."""
        return self.folder / f"seed_{seed}.{settings_hash(self.provenance)}.checkpoint"

    def others(self, kind):
        """Pieces and checkpoints in the folder that were made with another provenance, list of Path."""
        own = self.checkpoint(0).name.removeprefix("seed_0")
        begun = [path for path in self.folder.glob("seed_*.checkpoint") if not path.name.endswith(own)]
        pieces = self.folder.glob("seed_*.nc")
        return begun + [path for path in pieces if io.read_made_with(path, kind, self.provenance) is None]


class Pieces:
    """The finished grains of one block: the latest in memory, those before in pieces.

    The first grain becomes a piece at once, which tells how long that takes. From then on a piece is written when
    `WORK_BETWEEN_PIECES` times as much time has gone by, with all that was finished since.

    Parameters
    ----------
    block : Block
    kind : str
        Kind of the file, see `ratd.pipeline.kinds`.
    """

    def __init__(self, block, kind):
        self._block, self._kind = block, kind
        self._files = {}  # seed -> piece
        self._rows = {}  # seed -> row that no piece holds yet
        self._pause, self._written = 0.0, time.monotonic()
        for path in sorted(block.folder.glob("seed_*.nc")):
            piece = io.read_made_with(path, kind, block.provenance)
            if piece is not None:
                self._files |= dict.fromkeys(piece["seed"].values.tolist(), path)

    def __contains__(self, seed):
        """Whether a grain is in a piece."""
        return seed in self._files

    def add(self, seed, row):
        """Keep the row (see `ratd.pipeline.blocks`) of a grain that is finished."""
        self._rows[seed] = row
        if time.monotonic() - self._written >= self._pause:
            self.write()

    def write(self):
        """Write a piece of the grains that are not in one."""
        if not self._rows:
            return
        start = time.monotonic()
        path = self._block.piece(next(iter(self._rows)))
        self._write(path, list(self._rows.values()))
        for seed in self._rows:
            self._block.checkpoint(seed).unlink(missing_ok=True)
        self._files |= dict.fromkeys(self._rows, path)
        self._rows = {}
        self._written = time.monotonic()
        self._pause = WORK_BETWEEN_PIECES * (self._written - start)

    def join(self):
        """Write the file of the block, all of whose grains are finished."""
        # the rest too becomes a piece: a row from a file has lost what the kind does not keep
        self.write()
        rows = {}
        for path in sorted(set(self._files.values())):
            file = io.read(path, self._kind)
            rows |= zip(file["seed"].values.tolist(), blocks.rows(file, self._kind), strict=True)
        self._write(self._block.target, [rows[seed] for seed in self._block.seeds])

    def _write(self, path, rows):
        io.write(path, blocks.block(rows, self._kind, self._block.material, self._block.provenance), self._kind)


def partial_folder(target):
    """Folder of the finished grains of a file that is not finished."""
    target = Path(target)
    return target.with_name(f"{target.name}.partial")


@contextmanager
def locked(path, say):
    """Hold a lock that ends with the process, however it ends; wait while another process holds it.

    Two jobs for the same file can be at work at once when Snakemake alone was killed and started again: the second
    one waits, and finds the grains of the first.

    Parameters
    ----------
    path : path-like
        The file to lock, made if needed.
    say : callable
        ``say(text)`` is called when there is something to wait for.
    """
    path = Path(path)
    tries = 0
    while True:
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            handle = open(path, "a")
        except FileNotFoundError as error:
            tries += 1
            if tries < TRIES and path.parent.parent.is_dir():  # `tidy` removed the folder at this moment
                continue
            raise FileError(f"{path}: cannot be written ({error.strerror})") from error
        except OSError as error:
            raise FileError(f"{path}: cannot be written ({error.strerror})") from error
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            say("another process is at work on the same file, waiting for it")
            fcntl.flock(handle, fcntl.LOCK_EX)
        except OSError as error:
            raise FileError(f"{path}: cannot be locked ({error.strerror})") from error
        # the file may have been removed while we waited: then the lock is on nothing
        with suppress(FileNotFoundError):
            if os.path.samestat(os.fstat(handle.fileno()), os.stat(path)):
                break
        handle.close()
    with handle:
        yield


def _is_own(folder):
    """Whether a folder holds what this module writes, and nothing else."""
    names = [path.name for path in folder.iterdir()] if folder.is_dir() and not folder.is_symlink() else []
    return "lock" in names and all(re.fullmatch(_OWN_NAMES, name) for name in names)


def tidy(*results):
    """Remove the folders of partial results whose files are finished, and that no process is at work in.

    Parameters
    ----------
    *results : path-like
        Folders of results.
    """
    for folder in sorted(folder for path in results for folder in Path(path).rglob("*.nc.partial")):
        if not folder.with_suffix("").is_file() or not _is_own(folder):
            continue
        with open(folder / "lock", "a") as handle, suppress(BlockingIOError):
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            shutil.rmtree(folder)
