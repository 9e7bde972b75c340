"""A queue of collisions for the document, which takes days and may be stopped at any time.

    python -m ratd.experiments.collision.study             # go on where it was, until all is done
    python -m ratd.experiments.collision.study --minutes 30
    python -m ratd.experiments.collision.study --list      # what there is and what is left

The order is that of `runs` in config/collision_study.yaml, which stands over config/collision.yaml; in an entry one
rotation of all its cells comes before the next. Each collision becomes a row of a small table in docs/collision/data, a
file a law and a cluster. A row that is there is never computed again, also not with other source: it says itself which
source it is of. A killed collision goes on from its checkpoint. The two collisions of `snapshots.runs` come first, with
their snapshots, each in a file of its own.
"""

import sys
from functools import partial
from pathlib import Path

from ratd.experiments.collision import plan as plans
from ratd.experiments.collision.document_plan import CONFIG, DATA
from ratd.experiments.collision.run import at_rest
from ratd.experiments.collision.stages import built, collided, law_from
from ratd.pipeline.provenance import settings_hash, source_hash
from ratd.pipeline.queue import Table, Task, command, key

__all__ = ["CONFIG", "DATA", "PICTURES", "main", "tasks"]

PICTURES = ("pictures/figure3.nc", "pictures/figure4.nc")
"""Files in it of the collisions with snapshots."""
_clusters = {}
_KEY = ("sample", "velocity", "impact_parameter", "seed")


def tasks(plan, data):
    """What a plan asks for, in order.

    Parameters
    ----------
    plan : ratd.experiments.collision.plan.Plan
    data : path-like
        Folder of the tables.

    Returns
    -------
    list of ratd.pipeline.queue.Task
    """
    tables = {pair: _table(plan, data, *pair) for pair in plan.pairs()}
    source = source_hash(modules=["ratd.experiments.collision.stages"])
    wanted = []
    for name, one in zip(PICTURES, plan.pictures, strict=False):
        cell, rotation = plan.cell_of(one), one["rotation"]
        every = plan.settings_of(cell)["snapshots"][str(rotation)]
        wanted.append((_table(plan, data, cell.law, cell.cluster, name), cell, rotation, every))
    wanted += [(tables[cell.law, cell.cluster], cell, rotation, 0) for cell, rotation in plan.queue()]
    return [
        Task(
            table,
            key(cell.sample, cell.velocity, cell.impact_parameter, rotation),
            partial(_collision, plan, cell, rotation, source, every),
        )
        for table, cell, rotation, every in wanted
    ]


def _table(plan, data, law, cluster, name=None):
    """The table of a law and a cluster, in a file of that name when none is given."""
    material = plan.material_of(law)
    settings = {"law": plan.law(law), "cluster": plan.cluster(material, cluster)}
    return Table(Path(data, name or f"{law}/{cluster}.nc"), "collisions", _KEY, material, settings)


def _at_rest(cluster, law, sample):
    """A sample of a cluster at rest under a law; each is made once in a process."""
    name = (settings_hash({"cluster": cluster, "law": law}), sample)
    if name not in _clusters:
        _clusters[name] = at_rest(built(cluster, sample), law_from(law))
    return _clusters[name]


def _collision(plan, cell, rotation, source, snapshot_every):
    settings = plan.settings_of(cell)
    own = plan.cluster(plan.material_of(cell.law), cell.cluster)
    cluster = _at_rest(own, settings["law"], cell.sample)
    # whatever other rotations the cell has
    own_alone = {key: value for key, value in settings.items() if key not in ("rotations", "snapshots")}
    checkpoint = Path(plan.results, "checkpoints", f"{settings_hash(own_alone)}_{rotation}_{snapshot_every}.npz")
    row = collided(cluster, settings, rotation, snapshot_every=snapshot_every, checkpoint=checkpoint, source=source)
    checkpoint.unlink(missing_ok=True)
    return row, (
        f"{cell.law} {cell.cluster} sample {cell.sample} {cell.velocity:g} m/s rotation {rotation}: "
        f"X {row['X'].item():.3f}, N_s {row['N_s'].item():.3f}, balance {row['balance'].item():.1%}"
    )


def main(words=None):
    """The command; returns the exit status, see `ratd.pipeline.queue.command`."""
    return command(
        words, module=sys.modules[__name__], what="collisions", config=CONFIG, data=DATA, load=plans.load, tasks=tasks
    )


if __name__ == "__main__":
    sys.exit(main())
