"""A queue of collisions for the document, which takes days and may be stopped at any time.

    python -m ratd.experiments.collision.study             # go on where it was, until all is done
    python -m ratd.experiments.collision.study --minutes 30
    python -m ratd.experiments.collision.study --list      # what there is and what is left

The order is that of `runs` in config/collision_study.yaml, which stands over config/collision.yaml; in an entry one
rotation of all its cells comes before the next. Each collision becomes a row of a small table in docs/collision/data, a
file a law and a cluster, written anew when the collision is finished. A row that is there is never computed again, also
not with other source: it says itself which source it is of. A killed collision goes on from its checkpoint.
"""

import argparse
import sys
import time
from pathlib import Path

from ratd.base.errors import FileError, InputError
from ratd.experiments.collision import plan as plans
from ratd.experiments.collision.run import at_rest
from ratd.experiments.collision.stages import built, collided, law_from
from ratd.pipeline import blocks, io
from ratd.pipeline.partial import locked
from ratd.pipeline.provenance import canonical, settings_hash, source_hash

__all__ = ["CONFIG", "DATA", "Table", "main", "work"]

CONFIG = ("config/config.yaml", "config/collision.yaml", "config/collision_study.yaml")
DATA = "docs/collision/data"
PICTURES = "pictures"
"""Folder in it of the collisions with snapshots."""
_KEY = ("sample", "velocity", "impact_parameter", "seed")


class Table:
    """The collisions of one law and cluster that there are, in a file.

    Parameters
    ----------
    path : path-like
    material : ratd.Material
    settings : dict
        Of the law and the cluster: those of a table that is there must be the same.

    Raises
    ------
    InputError
        If the file is of other settings.
    """

    def __init__(self, path, material, settings):
        self.path, self._material = Path(path), material
        self._attributes = {"settings": canonical(settings), "settings_hash": settings_hash(settings)}
        self.rows = []
        if self.path.exists():
            file = io.read(self.path, "collisions")
            if file.attrs.get("settings_hash") != self._attributes["settings_hash"]:
                raise InputError(
                    f"{self.path}: holds collisions of a law or cluster with other settings; give the changed one "
                    "another name in the config, or remove the file"
                )
            self.rows = blocks.rows(file, "collisions")
        self.keys = {tuple(float(row[name]) for name in _KEY) for row in self.rows}

    def add(self, row):
        """Put a row to the others, in the order of the keys, and write the file."""
        self.rows = sorted([*self.rows, row], key=lambda row: [float(row[name]) for name in _KEY])
        self.keys.add(tuple(float(row[name]) for name in _KEY))
        io.write(self.path, blocks.block(self.rows, "collisions", self._material, self._attributes), "collisions")


def _table(plan, data, law, cluster):
    """The table of a law and a cluster."""
    material = plan.material_of(law)
    settings = {"law": plan.law(law), "cluster": plan.cluster(material, cluster)}
    return Table(Path(data, law, f"{cluster}.nc"), material, settings)


def work(plan, data, *, until=None, say=print):
    """Compute what a plan has and a folder has not.

    Parameters
    ----------
    plan : ratd.experiments.collision.plan.Plan
    data : path-like
        Folder of the tables.
    until : float, optional
        `time.monotonic()` after which no collision is begun.
    say : callable
        Told in a sentence what was done.

    Returns
    -------
    int
        How many collisions are left.
    """
    tables = {pair: _table(plan, data, *pair) for pair in plan.pairs()}
    source = source_hash(modules=["ratd.experiments.collision.stages"])
    clusters = {}
    left = [
        (cell, rotation)
        for cell, rotation in plan.queue()
        if _key(cell, rotation) not in tables[cell.law, cell.cluster].keys
    ]
    for number, (cell, rotation) in enumerate(left):
        if until is not None and time.monotonic() > until:
            return len(left) - number
        start = time.monotonic()
        settings = plan.settings_of(cell)
        name = (cell.law, cell.cluster, cell.sample)
        if name not in clusters:
            own = plan.cluster(plan.material_of(cell.law), cell.cluster)
            clusters[name] = at_rest(built(own, cell.sample), law_from(settings["law"]))
        checkpoint = Path(plan.results, "checkpoints", f"{settings_hash(settings)}_{rotation}.npz")
        row = collided(clusters[name], settings, rotation, checkpoint=checkpoint, source=source)
        tables[cell.law, cell.cluster].add(row)
        checkpoint.unlink(missing_ok=True)
        say(
            f"{cell.law} {cell.cluster} sample {cell.sample} {cell.velocity:g} m/s rotation {rotation}: "
            f"X {row['X'].item():.3f}, N_s {row['N_s'].item():.3f}, balance {row['balance'].item():.1%}, "
            f"{time.monotonic() - start:.0f} s, {len(left) - number - 1} left"
        )
    return 0


def _key(cell, rotation):
    return (float(cell.sample), float(cell.velocity), float(cell.impact_parameter), float(rotation))


def state(plan, data):
    """What there is of a plan, a line each law and cluster."""
    lines = []
    for law, cluster in plan.pairs():
        keys = _table(plan, data, law, cluster).keys
        wanted = {_key(cell, turn) for cell, turn in plan.queue() if (cell.law, cell.cluster) == (law, cluster)}
        lines.append(f"{law} {cluster}: {len(wanted & keys)} of {len(wanted)} collisions")
    return "\n".join(lines)


def main(words=None):
    """The command; returns the exit status: 0, 1 for bad input, 3 where the time was up before all was done."""
    parser = argparse.ArgumentParser(prog="python -m ratd.experiments.collision.study", description=__doc__)
    parser.add_argument("--config", action="append", help="config files, each over those before it")
    parser.add_argument("--data", default=DATA, help=f"folder of the tables (default {DATA})")
    parser.add_argument("--minutes", type=float, help="begin no collision after so long")
    parser.add_argument("--list", action="store_true", help="say what there is and what is left")
    arguments = parser.parse_args(words)

    def say(text):
        print(text, file=sys.stderr, flush=True)

    try:
        plan = plans.load(*(arguments.config or CONFIG))
        if arguments.list:
            print(state(plan, arguments.data))
            return 0
        until = None if arguments.minutes is None else time.monotonic() + 60 * arguments.minutes
        with locked(Path(plan.results, "queue.lock"), _Log(say)):
            left = work(plan, arguments.data, until=until, say=say)
    except (InputError, FileError) as error:
        say(f"error: {error}")
        return 1
    return 3 if left else 0


class _Log:
    """What `locked` takes for a log."""

    def __init__(self, say):
        self.info = say


if __name__ == "__main__":
    sys.exit(main())
