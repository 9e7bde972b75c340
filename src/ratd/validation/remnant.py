"""What is left of a grain after a loss of mass: does it turn its own axis of greatest inertia into the rotation axis?

Every grain is spun up as in production, and looked at every few hundred steps: how much of it is left, and by which
angle the axis of greatest inertia of the largest fragment stands off the axis about which it turns. A turn of the grain
is the unit of time, since the drag in the turning frame decays in 1/(c omega).
"""

import numpy as np
import pandas as pd

from ratd.aggregates.growth import grow
from ratd.drives.largest import OMEGA
from ratd.engine.layout import DRIVEN, MASS, RADIUS, STEPS, TIME, X
from ratd.engine.state import monomer_rows
from ratd.engine.step import FEW_CONTACTS, until
from ratd.engine.step import run as go_on
from ratd.experiments.relax import relax
from ratd.experiments.spin_up.cells import GRAIN
from ratd.experiments.spin_up.cut_bound import cut_bound
from ratd.experiments.spin_up.how import how_to_turn
from ratd.geometry.box import open_space
from ratd.geometry.shape import principal_axes
from ratd.laws.jkr_with_springs import jkr
from ratd.validation.tables import GRAIN_COLUMNS, grain_values, table_kind

COLUMNS = {
    **GRAIN_COLUMNS,
    "drag": ("1", "c: motion in the turning frame decays at the rate c omega"),
    "turns": ("1", "turns of the grain since its first loss of mass"),
    "omega": ("rad s-1", "angular velocity"),
    "mass_fraction": ("1", "mass of the largest fragment over that of the grain"),
    "tilt": ("rad", "angle between its axis of greatest inertia and the rotation axis"),
    "roundness": ("1", "I_2/I_1 of the largest fragment: near 1 the axis of greatest inertia is not defined"),
    "steps": ("1", "time steps so far"),
}
table_kind("remnant", "Turning of what is left of a grain", COLUMNS)
LOSS = 0.05
"""A loss of at least this part of the grain between two looks is an event of `events`."""
FEWEST = 4
"""A remnant of fewer monomers is not looked at."""


def compute(settings, progress=None):
    """Follow one grain until little is left of it, once with each drag.

    Parameters
    ----------
    settings : dict
        material, type, a_eff [m], seed; ``drag``: list of numbers; ``every``: steps between two looks; ``mass_left``:
        part of the mass at which the run ends.
    progress : callable, optional
        Called with a sentence after each run.

    Returns
    -------
    list of dict
        Rows of `COLUMNS`, from the last look before the first loss of mass on.
    """
    grain = grow(settings["type"], settings["a_eff"], settings["material"], settings["seed"])
    rows = []
    for drag in settings["drag"]:
        found = list(_looks(grain, drag, settings["every"], settings["mass_left"]))
        rows += [{**grain_values(grain), "drag": drag, **row} for row in found]
        if progress is not None:
            progress(f"drag {drag}: {len(found)} looks")
    return rows


def _looks(grain, drag, every, mass_left):
    """What is seen of a grain, a dict a look."""
    how = how_to_turn(grain.type, cut_bound(grain), drag=drag)
    law = jkr()
    state = relax(grain, law=law)
    whole = monomer_rows(state)[:, MASS].sum()
    turns, before, last = 0.0, state.scalar[TIME], None
    code = None
    while code != FEW_CONTACTS:
        goal = until(steps=state.counter[STEPS] + every, fewest_contacts=1)
        state, code = go_on(state, law, how.motion, open_space(), how.integrator, goal)
        rows = monomer_rows(state)
        rows = rows[rows[:, DRIVEN] > 0.0]
        fraction = rows[:, MASS].sum() / whole
        moments, axes = principal_axes(rows[:, X : X + 3], rows[:, MASS], rows[:, RADIUS])
        omega = state.drive[OMEGA]
        look = {
            "turns": turns,
            "omega": omega,
            "mass_fraction": fraction,
            "tilt": np.arccos(min(1.0, abs(axes[0, 2]))),
            "roundness": moments[1] / moments[0],
            "steps": float(state.counter[STEPS]),
        }
        if fraction < 1.0 - 1e-9:
            if last is not None:
                yield last
                last = None
            turns += omega * (state.scalar[TIME] - before) / (2.0 * np.pi)
            yield look | {"turns": turns}
        else:
            last = look
        before = state.scalar[TIME]
        if fraction < mass_left or len(rows) < FEWEST:
            return


def events(table):
    """Each loss of much mass: how far the axis stood off after it, and how soon that was over.

    Parameters
    ----------
    table : pandas.DataFrame
        Rows of `COLUMNS`.

    Returns
    -------
    pandas.DataFrame
        The columns of the grain, drag, mass_fraction (after the loss), tilt (greatest before the next event [rad]),
        turns (from there until it stays below 1/e of that; NaN where the next event comes first), end (tilt at the
        last look before the next event [rad]), roundness.
    """
    found = []
    keys = [*GRAIN, "drag"]
    for key, run in table.groupby(keys, sort=False):
        mass, tilt, turns = (run[name].to_numpy() for name in ("mass_fraction", "tilt", "turns"))
        starts = np.flatnonzero(-np.diff(mass) >= LOSS) + 1
        for start, end in zip(starts, [*starts[1:], len(run)], strict=True):
            top = start + int(np.argmax(tilt[start:end]))
            # it may swing: over when it stays below
            quiet = top + int(np.flatnonzero(tilt[top:end] > tilt[top] / np.e)[-1]) + 1
            found.append(
                dict(zip(keys, key, strict=True))
                | {
                    "mass_fraction": mass[start],
                    "tilt": tilt[top],
                    "turns": turns[quiet] - turns[top] if quiet < end else np.nan,
                    "end": tilt[end - 1],
                    "roundness": run["roundness"].to_numpy()[start],
                }
            )
    return pd.DataFrame(found)
