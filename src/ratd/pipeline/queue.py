"""A queue of long computations whose rows are kept in small files: stopped at any time, it goes on where it was.

A row that is there is never computed again, also not with other source: it says itself which source it is of.
"""

import argparse
import sys
import time
from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, wait
from pathlib import Path
from typing import NamedTuple

from ratd.base.errors import FileError, GrainError, InputError, is_of_one_grain
from ratd.pipeline import blocks, io
from ratd.pipeline.kinds import kind_of
from ratd.pipeline.partial import locked
from ratd.pipeline.provenance import canonical, settings_hash

__all__ = ["Table", "Task", "command", "key", "state", "work"]

WRITE_EVERY = 20.0
"""Rows of a table that are finished within so long [s] are written together, and one that took longer at once: a kill
costs little more than that."""


def key(*numbers):
    """What names a row, tuple of numbers: those that differ by rounding alone are the same; seeds stay as they are."""
    return tuple(number if isinstance(number, int) else float(f"{number:.9g}") for number in numbers)


class Table:
    """The rows that there are, in a file.

    Parameters
    ----------
    path : path-like
    kind : str
        A kind of file, see `ratd.pipeline.kinds`.
    key : sequence of str
        The variables, or attributes of a row, that name a row.
    material : ratd.Material
    settings : dict
        What all rows have in common: those of a file that is there must be the same.

    Raises
    ------
    InputError
        If the file is of other settings.
    """

    def __init__(self, path, kind, key, material, settings):
        self.path, self._kind, self._key, self._material = Path(path), kind, key, material
        self._attributes = {"settings": canonical(settings), "settings_hash": settings_hash(settings)}
        self.rows = []
        if self.path.exists():
            file = io.read(self.path, kind)
            if file.attrs.get("settings_hash") != self._attributes["settings_hash"]:
                raise InputError(
                    f"{self.path}: holds rows with other settings than the config has; give what changed another name "
                    "there, or remove the file"
                )
            self.rows = blocks.rows(file, kind)
        self.keys = {self.key_of(row) for row in self.rows}
        self._written = -WRITE_EVERY
        self._waiting = False

    def key_of(self, row):
        """What names a row."""
        return key(*(row[name].item() if name in row.variables else row.attrs[name] for name in self._key))

    def add(self, row):
        """Put a row to the others; `write_if_due` writes the file.

        Of its attributes those stay that a file of the kind has, so that it is like one that was read.
        """
        kept = {*kind_of(self._kind).attributes, *kind_of(self._kind).of_row}
        row.attrs = {name: value for name, value in row.attrs.items() if name in kept}
        self.rows.append(row)
        self.keys.add(self.key_of(row))
        self._waiting = True

    def write_if_due(self):
        """Write the file if that was not done just before."""
        if time.monotonic() - self._written > WRITE_EVERY:
            self.write()

    def write(self):
        """Write the rows that are not yet in the file, in the order of the keys."""
        if self._waiting:
            self.rows.sort(key=self.key_of)
            io.write(self.path, blocks.block(self.rows, self._kind, self._material, self._attributes), self._kind)
            self._written, self._waiting = time.monotonic(), False


class Task(NamedTuple):
    """A row to compute.

    Attributes
    ----------
    table : Table
    key : tuple of float
        From `key`.
    make : callable
        Without arguments; returns the row and a sentence on it. For several processes it has to be picklable.
    """

    table: Table
    key: tuple
    make: object


def work(tasks, *, until=None, say=print, processes=1):
    """Compute the rows that are not there.

    Parameters
    ----------
    tasks : iterable of Task
        In the order in which they are to be computed.
    until : float, optional
        `time.monotonic()` after which none is begun.
    say : callable
        Told in a sentence what was done.
    processes : int

    Returns
    -------
    int
        How many rows are left, those that failed among them.
    """
    left = [task for task in tasks if task.key not in task.table.keys]
    tables = {id(task.table): task.table for task in left}.values()
    done = 0
    results = _one_by_one(left, until) if processes == 1 else _side_by_side(left, until, processes)
    try:
        for task, row, sentence, seconds in results:
            if row is not None:
                task.table.add(row)
                done += 1
            # all of them: a table whose rows are all there gets no row more that would have it written
            for table in tables:
                table.write_if_due()
            if seconds > WRITE_EVERY:
                task.table.write()
            say(f"{sentence}, {seconds:.0f} s, {len(left) - done} left")
    finally:
        for table in tables:
            table.write()
    return len(left) - done


def _one_by_one(tasks, until):
    for task in tasks:
        if until is not None and time.monotonic() > until:
            return
        yield task, *_timed(task.make)


def _side_by_side(tasks, until, processes):
    """As `_one_by_one`, in the order in which rows are finished."""
    coming, running, failed = iter(tasks), {}, None
    with ProcessPoolExecutor(processes) as pool:
        while True:
            while failed is None and len(running) < processes and not (until is not None and time.monotonic() > until):
                task = next(coming, None)
                if task is None:
                    break
                running[pool.submit(_timed, task.make)] = task
            if not running:
                if failed is not None:
                    raise failed
                return
            finished, _ = wait(running, return_when=FIRST_COMPLETED)
            for future in finished:
                task = running.pop(future)
                if future.exception() is None:
                    yield task, *future.result()
                else:  # an error of the program: what else is at work is kept first
                    failed = failed or future.exception()


def _timed(make):
    """The row, None where the computation failed, a sentence on it, and how long it took [s]."""
    start = time.monotonic()
    try:
        row, sentence = make()
    except (RuntimeError, GrainError) as error:
        if not is_of_one_grain(error):
            raise
        row, sentence = None, f"failed: {error}"
    return row, sentence, time.monotonic() - start


def _processes(word):
    """A number of processes on the command line."""
    if not word.isdecimal() or int(word) < 1:
        raise argparse.ArgumentTypeError(f"{word!r}; allowed: a whole number of at least 1")
    return int(word)


def state(tasks, what):
    """What there is of some tasks, a line each table; `what` are the rows, in the plural."""
    lines = {}
    for task in tasks:
        there, wanted = lines.get(task.table.path, (0, 0))
        lines[task.table.path] = there + (task.key in task.table.keys), wanted + 1
    return "\n".join(f"{path}: {there} of {wanted} {what}" for path, (there, wanted) in lines.items())


def command(words, *, module, what, config, data, load, tasks, study=None):
    """The command of a queue.

    Parameters
    ----------
    words : sequence of str or None
        The command line.
    module : module
        Whose text is the help.
    what : str
        The rows, in the plural.
    config : sequence of str
        Config files, each over those before it, where none is given.
    data : str
        Folder of the tables where none is given.
    load : callable
        Config files -> plan, with `results`.
    tasks : callable
        Plan, folder of the tables -> list of `Task`.
    study : str, optional
        Name of the study where none is given. `config` and `data` then have the field ``{study}``.

    Returns
    -------
    int
        The exit status: 0, 1 for bad input, 3 where the time was up before all was done.
    """
    parser = argparse.ArgumentParser(
        prog=f"python -m {module.__spec__.name}",
        description=module.__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    if study is not None:
        parser.add_argument("--study", default=study, help=f"what to compute (default {study})")
    parser.add_argument("--config", action="append", help=f"config files (default {', '.join(map(str, config))})")
    parser.add_argument("--data", help=f"folder of the tables (default {data})")
    parser.add_argument("--minutes", type=float, help=f"begin no {what} after so long")
    parser.add_argument("--processes", type=_processes, default=1, help=f"{what} side by side (default 1)")
    parser.add_argument("--list", action="store_true", help="say what there is and what is left")
    arguments = parser.parse_args(words)
    name = getattr(arguments, "study", "")

    def say(text):
        print(text, file=sys.stderr, flush=True)

    try:
        plan = load(*(arguments.config or [path.format(study=name) for path in config]))
        folder = arguments.data or data.format(study=name)
        if arguments.list:
            print(state(tasks(plan, folder), what))
            return 0
        with locked(Path(folder, ".lock"), say):
            # read once nobody else writes them: a command that had to wait goes on from what the other one left
            wanted = tasks(plan, folder)
            until = None if arguments.minutes is None else time.monotonic() + 60 * arguments.minutes
            left = work(wanted, until=until, say=say, processes=arguments.processes)
    except (InputError, FileError) as error:
        say(f"error: {error}")
        return 1
    return 3 if left else 0
