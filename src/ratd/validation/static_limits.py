"""A queue of grains as grown, of which the static limit is computed: a linear programme each, no run.

    python -m ratd.validation.static_limits                # go on where it was, until all is done
    python -m ratd.validation.static_limits --minutes 30
    python -m ratd.validation.static_limits --list         # what there is and what is left

The grains are those of the ensemble, grown anew. Each becomes a row of a small table in
docs/reproduction/data/static_limits, a file a type. A row that is there is never computed again, also not with other
source: it says itself which source it is of. The large BAM2 take minutes each.
"""

import sys
from functools import partial
from pathlib import Path

import xarray as xr

from ratd.base.units import NM
from ratd.experiments.spin_up import plan as plans
from ratd.experiments.spin_up.cells import TYPES
from ratd.experiments.spin_up.firm_bound import firm_bound
from ratd.experiments.spin_up.grow import grown
from ratd.experiments.spin_up.static_limit import KIND, static_limit
from ratd.pipeline.provenance import source_hash
from ratd.pipeline.queue import Table, Task, command, key

__all__ = ["DATA", "limit_of", "main", "tasks"]

CONFIG = ("config/config.yaml", "config/spin_up.yaml")
DATA = "docs/reproduction/data/static_limits"
QUARTZ = "q-S"
SIZES_NM = (100, 200, 300, 400, 550)
SEEDS = range(5)


def tasks(plan, data):
    """What is to be done, in order: small grains first.

    Parameters
    ----------
    plan : ratd.experiments.spin_up.plan.Plan
    data : path-like
        Folder of the tables.

    Returns
    -------
    list of ratd.pipeline.queue.Task
    """
    source = source_hash(modules=["ratd.validation.static_limits"])
    tables = {
        kind: Table(
            Path(data, f"{QUARTZ}_{kind}.nc"),
            KIND,
            ("a_eff", "seed"),
            plan.materials[QUARTZ],
            {"growth": plan.growth(QUARTZ, kind)},
        )
        for kind in TYPES
    }
    return [
        Task(tables[kind], key(size * NM, seed), partial(limit_of, plan.grow(QUARTZ, kind, size), seed, source))
        for size in SIZES_NM
        for seed in SEEDS
        for kind in TYPES
    ]


def limit_of(growth, seed, source=""):
    """Both bounds of one grain, as a row of a table.

    Parameters
    ----------
    growth : dict
        As `ratd.experiments.spin_up.grow.grown` takes it.
    seed : int
    source : str
        Hash of the source.

    Returns
    -------
    row : xarray.Dataset
        Of the kind ``static_limits``.
    sentence : str
    """
    grain = grown(growth, seed)
    limit, firm = static_limit(grain), firm_bound(grain)
    row = xr.Dataset(attrs={"material": grain.material.name, "type": grain.type}).assign(
        a_eff=growth["a_eff"],
        seed=seed,
        n_monomers=grain.n_monomers,
        n_contacts=grain.n_contacts,
        firm_bound=firm,
        static_limit=limit,
        source=source,
    )
    name = f"{grain.material.name} {grain.type} {grain.a_eff / NM:.0f} nm seed {seed}"
    return row, f"{name}: {limit:.4g} rad/s, {limit / firm:.3f} of the firm bound"


def main(words=None):
    """The command; returns the exit status, see `ratd.pipeline.queue.command`."""
    return command(
        words, module=sys.modules[__name__], what="grains", config=CONFIG, data=DATA, load=plans.load, tasks=tasks
    )


if __name__ == "__main__":
    sys.exit(main())
