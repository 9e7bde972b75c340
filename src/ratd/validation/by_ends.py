"""A grain that is taken by two opposite ends and drawn apart, as it stands: no box, nothing squeezed before.

The ends are those monomers along an axis that hold `HELD` of the mass on each side. They are given an inertia `HEAVY`
times their own, so that they keep the velocities that they are given, and nothing is changed at their contacts. What
holds them back is the force of the contacts; a mean of it follows from the momentum that they lose.
"""

from typing import NamedTuple

import numpy as np

from ratd.base.errors import InputError
from ratd.drives.free import free
from ratd.engine.layout import INERTIA, INV_INERTIA, INV_MASS, MASS, STEPS, TIME, VX, X
from ratd.engine.semi_implicit import semi_implicit
from ratd.engine.state import copied, monomer_rows
from ratd.engine.step import run, until
from ratd.experiments.relax import start_anew
from ratd.experiments.spin_up.how import STEP
from ratd.geometry.box import open_space
from ratd.laws.jkr_with_springs import jkr

__all__ = ["HELD", "Pull", "lever", "pull_by_ends"]

HELD = 0.25
"""Part of the mass of the grain that is held at each end, at least: it is whole monomers."""
HEAVY = 1e9
"""Inertia of a monomer that is held, over its own."""
RECORD_STRAIN = 1e-4
"""Way of the ends against each other between two records, over their distance at the start. It is short: BAM grains are
brittle, and give way after some 7e-4."""
IN_A_RECORD = 8
"""Steps of a record at least."""
LONGEST = 0.6
"""... at which the pulling ends at the latest."""
FALLEN = 0.3
"""The pulling ends where the force has fallen to this part of its greatest value."""
FEWEST = 100
"""Records that are made at least."""


class Pull(NamedTuple):
    """What the pulling found.

    Attributes
    ----------
    force : float
        The greatest force [N] that the grain held, in the mean over a record and both ends.
    strain : float
        Way of the ends there, over their distance at the start.
    unequal : float
        Difference of the forces at both ends, mean of its absolute value over the records, over `force`: 0 where the
        grain is in equilibrium at all times.
    steps : int
    """

    force: float
    strain: float
    unequal: float
    steps: int


def lever(state, axis):
    """Sum of m |x|/2 over the monomers [kg m], x along an axis from the centre of mass.

    Each half of a grain, divided at its centre of mass, has this much; the centrifugal force on it is omega^2 times
    that, where the axis is normal to the rotation.

    Parameters
    ----------
    state : State
        With the centre of mass at the origin, see `ratd.experiments.relax.relax`.
    axis : int
    """
    rows = monomer_rows(state)
    return 0.5 * float(rows[:, MASS] @ np.abs(rows[:, X + np.uint64(axis)]))


def pull_by_ends(state, axis, rate, *, held=HELD, integrator=None):
    """Draw the ends of a grain apart along one axis, until they let go.

    Parameters
    ----------
    state : State
        Of `ratd.experiments.relax.relax`; it is copied.
    axis : int
        0, 1 or 2.
    rate : float
        Speed of the ends against each other over their distance at the start [1/s].
    held : float
        See `HELD`.
    integrator : part, optional
        That of the spin-up by default, with `IN_A_RECORD` steps a record at least.

    Returns
    -------
    Pull

    Raises
    ------
    InputError
        If the two ends would have monomers in common.
    """
    if integrator is None:
        integrator = semi_implicit(**STEP | {"longest": min(STEP["longest"], RECORD_STRAIN / rate / IN_A_RECORD)})
    law, box = jkr(), open_space()
    state = copied(state)
    start_anew(state, law, integrator)
    ends, distance = _take(state, axis, rate, held)
    momentum, time, force, middle = [_momentum(state, end, axis) for end in ends], 0.0, [], []
    while time * rate < LONGEST:
        # a long step of another integrator may pass over several records
        number = np.floor(time * rate / RECORD_STRAIN * (1.0 + 1e-12)) + 1.0
        state, _ = run(state, law, free(), box, integrator, until(time=number * RECORD_STRAIN / rate))
        now = [_momentum(state, end, axis) for end in ends]
        lasted, time = state.scalar[TIME] - time, state.scalar[TIME]
        force.append(((now[0] - momentum[0]) / lasted, (momentum[1] - now[1]) / lasted))
        middle.append((time - 0.5 * lasted) * rate)
        momentum = now
        mean = np.mean(force, axis=1)
        if len(force) > FEWEST and mean[-1] < FALLEN * mean.max():
            break
    force = np.array(force)
    best = int(np.argmax(mean))
    return Pull(
        force=float(mean[best]),
        strain=float(middle[best]),
        unequal=float(np.abs(force[:, 0] - force[:, 1]).mean() / mean[best]),
        steps=int(state.counter[STEPS]),
    )


def _take(state, axis, rate, held):
    """Take hold of the ends: their monomers become heavy and move, those between go along in proportion.

    Returns
    -------
    ends : list of (n,) bool array
        The lower one and the upper one.
    distance : float
        Of their centres of mass [m].
    """
    rows = monomer_rows(state)
    x, mass = rows[:, X + np.uint64(axis)].copy(), rows[:, MASS].copy()
    ends = [_outermost(place, mass, held) for place in (x, -x)]
    if (ends[0] & ends[1]).any():
        raise InputError(f"held is {held:g}; the two ends of this grain would have monomers in common.")
    low, high = (float(mass[end] @ x[end] / mass[end].sum()) for end in ends)
    distance = high - low
    # from -1 to 1 between the ends, so that nothing has to be set in motion
    along = np.interp(x, [x[ends[0]].max(), x[ends[1]].min()], [-1.0, 1.0])
    along[ends[0]], along[ends[1]] = -1.0, 1.0
    rows[:, VX + np.uint64(axis)] = 0.5 * rate * distance * along
    taken = ends[0] | ends[1]
    for field, factor in ((MASS, HEAVY), (INERTIA, HEAVY), (INV_MASS, 1.0 / HEAVY), (INV_INERTIA, 1.0 / HEAVY)):
        rows[taken, field] *= factor
    return ends, distance


def _outermost(x, mass, held):
    """The monomers of least x that together have a part `held` of the mass, (n,) bool."""
    order = np.argsort(x, kind="stable")
    before = np.cumsum(mass[order]) - mass[order]
    end = np.zeros(len(x), dtype=bool)
    end[order[before < held * mass.sum()]] = True
    return end


def _momentum(state, end, axis):
    rows = monomer_rows(state)[end]
    return float(rows[:, MASS] @ rows[:, VX + np.uint64(axis)])
