"""On request: at which angular velocities the steps of a spin-up are made, and what it waits for meanwhile.

Counted, not timed: from whole runs at the settings of the config. A step takes about as long as it has contacts to
update, so the shares of the updates say where the time goes.
"""

import numpy as np

from benchmarks import tables
from benchmarks.cost import arguments_of, grain_of
from ratd import spin_up
from ratd.drives.largest import OMEGA, UNREST
from ratd.engine.layout import LARGEST_CONTACTS, STEPS, STRETCH
from ratd.engine.step import FEW_CONTACTS, until
from ratd.engine.step import run as go_on
from ratd.experiments.relax import relax
from ratd.experiments.spin_up.cut_bound import cut_bound
from ratd.experiments.spin_up.how import FIRST_LOSS, how_to_turn
from ratd.geometry.box import open_space
from ratd.laws.jkr_with_springs import jkr

DRIVE = "prescribed"
EDGES = (0.0, FIRST_LOSS, 1.0, 2.0, np.inf)
"""Bands of omega in units of the cut bound: elastic, first losses, disruption, what is left of the grain."""
EVERY = 20
"""Steps from one look to the next at what a spin-up waits for."""
WAITS = ("unrest", "stretch", "neither")


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
            arguments = arguments_of(plan, DRIVE, kind, 1)
            run = spin_up(grain, **arguments)
            waited = waits(grain) if arguments["stretch"] is not None else [dict.fromkeys(WAITS, np.nan)] * 4
            cell = {"drive": DRIVE, "material": material, "type": kind, "size_nm": size}
            for (low, high, steps, updates), own in zip(shares(run), waited, strict=True):
                band = {"from_bound": low, "to_bound": high, "steps": steps, "contact_updates": updates}
                rows.append(cell | band | own | about)
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
        Both edges of the band [cut bound], share of the steps, share of the steps times the number of contacts of the
        largest fragment.
    """
    ratio = run["omega"].values[1:] / run.attrs["cut_bound"]
    steps = np.diff(run["steps_so_far"].values)
    contacts = run["n_contacts"].values
    updates = steps * 0.5 * (contacts[1:] + contacts[:-1])
    band = np.searchsorted(EDGES, ratio, side="right") - 1
    return [
        (EDGES[k], EDGES[k + 1], steps[band == k].sum() / steps.sum(), updates[band == k].sum() / updates.sum())
        for k in range(len(EDGES) - 1)
    ]


def waits(grain):
    """What the spin-up of a grain waits for, in each band of `EDGES`.

    Returns
    -------
    list of dict
        Shares of the contact updates of all bands together: while the unrest, while the stretch takes at least half of
        the rise away (the greater of the two counts), and while neither does.
    """
    how, law = how_to_turn(grain.type, cut_bound(grain)), jkr()
    state, code = relax(grain, law=law), None
    looks = []
    while code != FEW_CONTACTS:
        goal = until(steps=state.counter[STEPS] + EVERY, fewest_contacts=1)
        state, code = go_on(state, law, how.motion, open_space(), how.integrator, goal)
        taken = [(state.drive[UNREST] / how.motion.unrest) ** 2, (state.scalar[STRETCH] / how.motion.stretch) ** 2]
        cause = int(np.argmax(taken)) if max(taken) >= 0.5 else 2
        looks.append((state.drive[OMEGA], cause, state.counter[LARGEST_CONTACTS]))
    omega, cause, updates = np.array(looks, dtype=float).T
    band = np.searchsorted(EDGES, omega / cut_bound(grain), side="right") - 1
    return [
        {name: updates[(band == k) & (cause == number)].sum() / updates.sum() for number, name in enumerate(WAITS)}
        for k in range(len(EDGES) - 1)
    ]
