"""A queue of spin-ups: the ensemble of the paper, grain by grain, which may be stopped at any time, and other studies.

    python -m ratd.experiments.spin_up.study --processes 2             # go on where it was, until all is done
    python -m ratd.experiments.spin_up.study --processes 2 --minutes 30
    python -m ratd.experiments.spin_up.study --list                    # what there is and what is left
    python -m ratd.experiments.spin_up.study --study dmt               # another study than the ensemble

What there is to do stands in config/studies/NAME.yaml, which stands over config/spin_up.yaml; the ensemble is spun_up.
One seed of all materials, types and sizes comes before the next, so that what is there is an ensemble at any time, a
smaller one. Each grain becomes a row of a small table in docs/reproduction/data/NAME, a file a drive, material and
type: its marks of disruption, what it was just before, and the fragments that left. A row that is there is never
computed again, also not with other source: it says itself which source it is of. docs/quasi_static.md tells of the
ensemble: after more rows `python -m ratd.validation.quasi_static_document redraw` writes it anew.
"""

import sys
from functools import partial
from pathlib import Path

from ratd.base.units import NM
from ratd.experiments.spin_up import plan as plans
from ratd.experiments.spin_up.fragmentation import fragmentation
from ratd.experiments.spin_up.grow import grown
from ratd.experiments.spin_up.marks import before_marks, disruption
from ratd.experiments.spin_up.spin import arguments, turn
from ratd.pipeline.provenance import settings_hash, source_hash
from ratd.pipeline.queue import Table, Task, command, key

__all__ = ["CONFIG", "DATA", "ENSEMBLE", "main", "settings_of", "tasks"]

ENSEMBLE = "spun_up"
CONFIG = ("config/config.yaml", "config/spin_up.yaml", "config/studies/{study}.yaml")
DATA = "docs/reproduction/data/{study}"
_KEY = ("a_eff", "seed")


def tasks(plan, data):
    """What a plan asks for, in order.

    Parameters
    ----------
    plan : ratd.experiments.spin_up.plan.Plan
    data : path-like
        Folder of the tables.

    Returns
    -------
    list of ratd.pipeline.queue.Task
    """
    source = source_hash(modules=["ratd.experiments.spin_up.study"])
    checkpoints = Path(plan.results, "checkpoints")
    found = []
    for drive in plan.config["drives"]:
        tables = {
            (material, kind): _table(plan, data, drive, material, kind)
            for material in plan.config["materials"]
            for kind in plan.config["types"]
        }
        wanted = [(seed, cell) for cell in plan.cells_of(drive) for seed in plan.seeds_of(cell, drive)]
        for seed, cell in sorted(wanted, key=lambda pair: pair[0]):
            growth = plan.grow(*cell)
            how = arguments(plan.spin_up(drive, *cell, f"{seed}-{seed}"))
            checkpoint = checkpoints / f"{settings_hash({'growth': growth, 'turn': how})}_{seed}"
            make = partial(spun_up, growth, how, seed, checkpoint=checkpoint, source=source)
            found.append(Task(tables[cell[:2]], key(float(cell[2]) * NM, seed), make))
    return found


def _table(plan, data, drive, material, kind):
    """The table of a drive, material and type."""
    settings = settings_of(plan, drive, material, kind)
    path = Path(data, drive, f"{material}_{kind}.nc")
    return Table(path, "spun_up", _KEY, plan.materials[material], settings)


def settings_of(plan, drive, material, kind):
    """What all spin-ups of a drive, material and type have in common: the settings that a table is known by, dict."""
    return {"growth": plan.growth(material, kind), "spin_up": {"drive": drive, **plan.spin_up_of(drive, kind)}}


def spun_up(growth, how, seed, *, checkpoint=None, source=""):
    """One grain, grown and spun up, as a row of a table.

    Parameters
    ----------
    growth : dict
        As `ratd.experiments.spin_up.grow.grown` takes it.
    how : dict
        As `ratd.experiments.spin_up.spin.turn` takes it.
    seed : int
    checkpoint : path-like, optional
        Of a long run; removed when it is finished.
    source : str
        Hash of the source.

    Returns
    -------
    row : xarray.Dataset
        Of the kind spun_up.
    sentence : str
    """
    run = turn(grown(growth, seed), how, checkpoint=checkpoint)
    row = disruption(run)
    for name, value in (before_marks(run, row) | {"source": source}).items():
        row[name] = value
    row.update(fragmentation(run, row))
    row["missing_marks"] = row.attrs.pop("missing_marks")
    if checkpoint is not None:
        Path(checkpoint).unlink(missing_ok=True)
    return row, (
        f"{how['drive']} {run.attrs['material']} {run.attrs['type']} {run.attrs['a_eff'] / NM:.0f} nm seed {seed}: "
        f"omega_disr {row['omega_disr'].item():.3g} rad/s, {run.attrs['steps']} steps"
    )


def main(words=None):
    """The command; returns the exit status, see `ratd.pipeline.queue.command`."""
    return command(
        words, module=sys.modules[__name__], what="grains", config=CONFIG, data=DATA, load=plans.load, tasks=tasks,
        study=ENSEMBLE,
    )  # fmt: skip


if __name__ == "__main__":
    sys.exit(main())
