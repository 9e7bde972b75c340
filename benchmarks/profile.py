"""Part (e): at which angular velocities the steps of a spin-up and its contact updates are made.

Counted, not timed: from the records of whole runs at the settings of the config. A step takes about as long as it has
contacts to update, so the shares of the updates say where the time goes.
"""

import numpy as np

from benchmarks import tables
from benchmarks.cost import arguments_of, grain_of
from ratd import spin_up
from ratd.experiments.spin_up.how import FIRST_LOSS

DRIVE = "prescribed"
EDGES = (0.0, FIRST_LOSS, 1.0, 2.0, np.inf)
"""Bands of omega in units of the cut bound: elastic, first losses, disruption, what is left of the grain."""


def measure(out, plan, *, sizes, about, say):
    """Run one grain of each type and size and write ``profile.csv``, a row a band.

    Parameters
    ----------
    out : pathlib.Path
        Folder of the results.
    plan : ratd.experiments.spin_up.plan.Plan
        The config; its first material and first seed are taken.
    sizes : list of str
        Sizes, a subset of those of the plan.
    about : dict
        Columns that each row gets: the machine and the versions.
    say : callable
        Told how far it is.
    """
    rows = []
    material = plan.config["materials"][0]
    for size in sizes:
        for kind in plan.config["types"]:
            grain = grain_of(plan, (material, kind, size), plan.seeds[0])
            run = spin_up(grain, **arguments_of(plan, DRIVE, kind, 1))
            cell = {"drive": DRIVE, "material": material, "type": kind, "size_nm": size}
            for low, high, steps, updates in shares(run):
                rows.append(
                    cell | {"from_bound": low, "to_bound": high, "steps": steps, "contact_updates": updates} | about
                )
            say(f"profile: {kind} {size} nm: {run.attrs['steps']} steps")
    tables.write(out / "profile.csv", rows)


def shares(run):
    """Shares of the steps and of the contact updates of a run in each band of `EDGES`.

    Parameters
    ----------
    run : xarray.Dataset
        From `ratd.spin_up`.

    Returns
    -------
    list of tuple of float
        Both edges of the band [cut bound], share of the time, share of the time times the number of contacts of the
        largest fragment. The time step hardly changes within a run, so that shares of the time are shares of the steps.
    """
    ratio = run["omega"].values[1:] / run.attrs["cut_bound"]
    time = np.diff(run["time"].values)
    contacts = run["n_contacts"].values
    updates = time * 0.5 * (contacts[1:] + contacts[:-1])
    band = np.searchsorted(EDGES, ratio, side="right") - 1
    return [
        (EDGES[k], EDGES[k + 1], time[band == k].sum() / time.sum(), updates[band == k].sum() / updates.sum())
        for k in range(len(EDGES) - 1)
    ]
