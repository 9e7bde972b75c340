"""What a job of the pipeline needs around the calculation: log, provenance, blocks of grains that outlive a kill.

What a job computes is a function of ratd, named in the params of its rule (`task`) and called by one of a few general
scripts. This module decides no number: it is left out of all source hashes (see `ratd.pipeline.provenance`).
"""

import fcntl
import logging
import sys
import time
from contextlib import ExitStack, contextmanager, suppress
from importlib import import_module
from pathlib import Path

import pandas as pd
import xarray as xr

from ratd.base.errors import FileError, GrainError, InputError, is_of_one_grain
from ratd.pipeline import first_error, io
from ratd.pipeline.kinds import fingerprint
from ratd.pipeline.partial import Block, Pieces, locked
from ratd.pipeline.places import seeds_of
from ratd.pipeline.provenance import provenance, source_hash

PROGRESS_INTERVAL = 10.0
"""Least time between two messages of progress of one grain [s]."""

_held = []  # open files whose locks last as long as the process


def task(script, function, *writes):
    """What a rule is to do, and the hash of all source that its output depends on.

    Parameters
    ----------
    script : path-like
        The script of the rule, which says how the function is called and what becomes of its result.
    function : str
        Module and name, such as ``"ratd.experiments.spin_up.disrupt:disrupt"``.
    *writes : str
        Kinds of files that are written; their layout is part of the hash.

    Returns
    -------
    dict
        For ``params.task`` of the rule, from which `Job` takes it.
    """
    module, _, name = function.partition(":")
    layout = [name, *map(fingerprint, writes)]
    return {
        "script": Path(script).name,
        "function": function,
        "writes": list(writes),
        "hash": source_hash(script, modules=[module], extra=layout),
    }


@contextmanager
def failure_told(number, done):
    """A context in which a grain is made: that it cannot be made is told by ``done``, and ends nothing else.

    Parameters
    ----------
    number : int
        Place of the grain among those that wait.
    done : callable
        See `Job.blocks`.
    """
    try:
        yield
    except (RuntimeError, GrainError) as error:
        if not is_of_one_grain(error):
            raise
        done(number, failure=error)


class _LogFile(logging.FileHandler):
    """A log file that is silent where it cannot be written: the job has its own word on a full disk."""

    def emit(self, record):
        with suppress(OSError):
            super().emit(record)

    def handleError(self, record):
        pass


class Job:
    """One job, as a context: logs to its file and the terminal, and ends with one sentence on bad input.

    Parameters
    ----------
    snakemake : snakemake.script.Snakemake
        The object of this name in a script. ``params.task`` is from `task`, ``params.settings`` is a dict of all that
        the output depends on, next to the inputs.

    Attributes
    ----------
    settings : dict
        As given.
    input, output, wildcards : snakemake.io.Namedlist
        Of the job.
    log : logging.Logger
        Writes to the first log file of the rule and to the terminal.
    provenance : dict
        Attributes for the files that the job writes, from `ratd.pipeline.provenance.provenance`.
    """

    def __init__(self, snakemake):
        self._snakemake = snakemake
        self._task = snakemake.params.task
        self.settings = snakemake.params.settings
        self.input, self.output, self.wildcards = snakemake.input, snakemake.output, snakemake.wildcards
        self.log = logging.getLogger("ratd.job")

    def __enter__(self):
        self._set_up_log()
        try:
            script = Path(self._snakemake.scriptdir, self._task["script"])
            if task(script, self._task["function"], *self._task["writes"]) != self._task:
                raise InputError("the source was changed after snakemake was started: start the same command again")
            self.provenance = self.provenance_of(self.settings, self.input)
        except (InputError, FileError) as error:
            self._fail(error)
        return self

    @property
    def function(self):
        """The function that the rule names."""
        module, _, name = self._task["function"].partition(":")
        return getattr(import_module(module), name)

    def _set_up_log(self):
        """Full messages into the log file, the same with the name of the job in front on the terminal."""
        self.log.setLevel(logging.INFO)
        self.log.propagate = False
        words = [f"{word} nm" if name == "size" else word for name, word in self.wildcards.items()]
        label = " ".join([self._snakemake.rule, *words]).replace("%", "%%")
        self._label = label
        for handler, form in (
            (_LogFile(self._snakemake.log[0], delay=True), "%(asctime)s %(message)s"),
            (logging.StreamHandler(sys.stderr), f"{label}: %(message)s"),
        ):
            handler.setFormatter(logging.Formatter(form))
            self.log.addHandler(handler)

    def __exit__(self, kind, error, traceback):
        if isinstance(error, InputError | FileError):
            self._fail(error)
        elif error is not None and not isinstance(error, SystemExit):
            self.log.error("failed", exc_info=(kind, error, traceback))
            first_error.keep(f"{self._label}: {kind.__name__}: {error}")
        return False

    def _fail(self, error):
        self.log.error(f"error: {error}")
        first_error.keep(f"{self._label}: error: {error}")
        sys.exit(1)

    def write(self, name, content):
        """Write one output of the rule.

        Parameters
        ----------
        name : str
            Of the output, and for a dataset that of the kind of file as well.
        content : xarray.Dataset, pandas.DataFrame or str
            Becomes netCDF, CSV or text.
        """
        path = self.output[name]
        if isinstance(content, xr.Dataset):
            self._writes(name)
            io.write(path, content.assign_attrs(self.provenance), name)
        elif isinstance(content, pd.DataFrame):
            io.write_text(path, content.to_csv(index=False, float_format="%.9g"))
        else:
            io.write_text(path, content)
        self.log.info(f"{path} written")

    def _writes(self, kind):
        if kind not in self._task["writes"]:
            raise InputError(
                f"{self._task['function']} writes {kind}, which its rule does not name; "
                f"allowed: {', '.join(self._task['writes']) or 'no netCDF'}"
            )

    def block(self, target, kind, material, seeds, make):
        """Write the file of a block of grains, grain by grain, going on where a killed job was.

        Parameters
        ----------
        target : path-like
            The file to write.
        kind : str
            One of those that the rule writes.
        material : ratd.base.materials.Material
            What the grains are made of.
        seeds : sequence of int
            Seeds of the grains, in the order in which they stand in the file. Where the rule has the wildcard `seeds`,
            those outside it are left out: a file of grains may hold more of them than a drive wants.
        make : callable
            ``make(seed, checkpoint)`` returns the row of a grain (see `ratd.pipeline.blocks`). Below the path
            `checkpoint` it may keep what it needs to go on in the middle of a grain; a file made with other source,
            settings or inputs has another name and is never found. If it raises RuntimeError the other grains are made
            all the same.

        Raises
        ------
        InputError
            If grains failed: one sentence with the seed and the reason of each.
        """
        wanted = self.wildcards.get("seeds")
        if wanted:
            seeds = [seed for seed in seeds if seed in seeds_of(wanted)]
        block = Block(Path(target), material, list(seeds), self.provenance)

        def make_all(waiting, done):
            for number, (block, seed) in enumerate(waiting):
                with failure_told(number, done):
                    done(number, make(seed, block.checkpoint(seed)))

        self.blocks([block], kind, make_all)

    def blocks(self, blocks, kind, make):
        """Write the files of some blocks of grains together, going on where a killed job was.

        Parameters
        ----------
        blocks : list of Block
        kind : str
            One of those that the rule writes.
        make : callable
            ``make(waiting, done)`` computes the grains that are not finished yet, ``waiting``, a list of pairs of a
            block and a seed, in any order. It calls ``done(number, row)`` with the place in this list and the row
            (see `ratd.pipeline.blocks`) of each grain that it has finished, or ``done(number, failure=reason)``.

        Raises
        ------
        InputError
            If grains failed: one sentence with the seed and the reason of each.
        """
        self._writes(kind)
        with ExitStack() as locks:
            for block in sorted(blocks, key=lambda block: block.target):
                locks.enter_context(locked(block.folder / "lock", self.log.info))
            pieces = {block.target: Pieces(block, kind) for block in blocks}
            waiting = [(block, seed) for block in blocks for seed in block.seeds if seed not in pieces[block.target]]
            every = sum(len(block.seeds) for block in blocks)
            kept = every - len(waiting)
            finished = kept
            start = time.monotonic()
            failures = []
            where = blocks[0].target if len(blocks) == 1 else f"{len(blocks)} files"

            def done(number, row=None, *, failure=None):
                nonlocal finished, start
                block, seed = waiting[number]
                name = f"{block.target.parent.name} seed {seed}" if len(blocks) > 1 else f"seed {seed}"
                if failure is not None:
                    failures.append(f"{name}: {failure}")
                    self.log.error(failures[-1])
                    return
                pieces[block.target].add(seed, row)
                finished += 1
                seconds = time.monotonic() - start
                start = time.monotonic()
                self.log.info(f"{name}: done in {seconds:.1f} s ({finished} of {every} grains)")

            try:
                if waiting:
                    make(waiting, done)
                if failures:
                    raise InputError(
                        f"{where}: {len(failures)} of {len(waiting)} grains failed, the others are kept: "
                        + "; ".join(failures)
                    )
            except BaseException:
                for own in pieces.values():
                    with suppress(FileError):  # the first error is the one to tell
                        own.write()
                raise
            for own in pieces.values():
                own.join()
            self.log.info(f"{every} grains written to {where}, {kept} of them were finished before")

    def provenance_of(self, settings, inputs):
        """Attributes of one of several files that the job writes, which has settings and inputs of its own."""
        return provenance(self._task["hash"], settings, inputs)

    def progress(self, name):
        """Something that tells how far one grain is, but not too often.

        Parameters
        ----------
        name : str
            Of the grain.

        Returns
        -------
        callable
            ``say(tell)``: calls ``tell()`` for a text and logs it, at most every `PROGRESS_INTERVAL`.
        """
        last = time.monotonic()

        def say(tell):
            nonlocal last
            now = time.monotonic()
            if now - last >= PROGRESS_INTERVAL:
                last = now
                self.log.info(f"{name}: {tell()}")

        return say


def duration(seconds):
    """A length of time in words, such as ``"about 4 min"``; "unknown time" where it is no finite number."""
    if seconds is None or not 0 <= seconds < float("inf"):
        return "unknown time"
    for unit, length in (("d", 86400), ("h", 3600), ("min", 60)):
        if seconds >= 2 * length:
            return f"about {seconds / length:.0f} {unit}"
    return f"about {seconds:.0f} s"


def release_stale_locks(folder=".snakemake"):
    """Remove the locks that a killed Snakemake left behind, unless another one is running here.

    Snakemake locks its outputs by files that name no process, so after a `kill -9` it cannot know that nobody is left
    to remove them, and asks for `--unlock`. Here every Snakemake holds a shared lock of the operating system while it
    lives. Whoever can have that lock alone is the only one, and what Snakemake's own locks say is out of date. While
    another one lives they are left in place, and Snakemake refuses to work on the same files at the same time.

    Parameters
    ----------
    folder : path-like
        Snakemake's own folder.
    """
    folder = Path(folder)
    folder.mkdir(exist_ok=True)
    handle = open(folder / "ratd.lock", "a")
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        pass
    else:
        for lock in (folder / "locks").glob("*.lock"):
            lock.unlink(missing_ok=True)
    # waits only for another one that is in the lines above
    fcntl.flock(handle, fcntl.LOCK_SH)
    _held.append(handle)
