"""Energy of a free grain that vibrates and turns without dissipation: how well the scheme keeps it, against the step.

Damping and the limits of sliding and rolling are switched off; twisting stays below its limit, which the column
``dissipated`` proves.
"""

import numpy as np

from ratd.aggregates.growth import grow
from ratd.engine.layout import CONTACTS, STEPS
from ratd.engine.measure import dissipated
from ratd.engine.state import monomer_rows
from ratd.validation.free_grain import energy_after_step, go_on, kinetic_energy, make_elastic, shaken, turn
from ratd.validation.tables import GRAIN_COLUMNS, grain_values, table_kind

COLUMNS = {
    **GRAIN_COLUMNS,
    "timestep_factor": ("1", "f in the time step f min(t_dis, t_vel)"),
    "step": ("1", "steps made before the energies of the sample"),
    "error": ("1", "energy less that of the first step, over the kinetic energy at the start, mean of the sample"),
    "greatest": ("1", "greatest magnitude of the same in the sample"),
    "dissipated": ("1", "energy dissipated so far over the kinetic energy at the start"),
    "contacts_made": ("1", "contacts more than at the start"),
}
KIND = table_kind("energy_step", "Energy of elastic free grains against the step", COLUMNS)
SAMPLE = 10
"""Steps of a sample that follow each other."""


def moving(grain, speed, timestep_factor):
    """State of an elastic grain that vibrates and turns.

    Parameters
    ----------
    grain : ratd.Grain
    speed : float
        Standard deviation of each component of the velocities, and of the spins times the greatest radius; also the
        angular velocity of the whole, about z, times the effective radius [m/s].
    timestep_factor : float
        f of Eq. 31.

    Returns
    -------
    State
    """
    state = shaken(grain, speed, speed / grain.radius.max(), grain.seed, timestep_factor=timestep_factor)
    turn(monomer_rows(state), np.array([0.0, 0.0, speed / grain.effective_radius]))
    make_elastic(state)
    return state


def course(grain, speed, timestep_factor, steps, samples):
    """Energy of one free elastic grain, as rows of `COLUMNS`.

    Parameters
    ----------
    grain : ratd.Grain
    speed, timestep_factor : float
        See `moving`.
    steps, samples : int
        Length of the run, and number of samples in it, each of `SAMPLE` steps.

    Returns
    -------
    list of dict
    """
    state = moving(grain, speed, timestep_factor)
    start, contacts = kinetic_energy(monomer_rows(state)), state.counter[CONTACTS]

    def go(state, number=1):
        go_on(state, grain, state.counter[STEPS] + number, timestep_factor)

    first, rows = None, []
    between = steps // samples - SAMPLE
    for _ in range(samples):
        number = state.counter[STEPS]
        energies = np.array([sum(energy_after_step(state, go)) for _ in range(SAMPLE)])
        first = energies[0] if first is None else first
        error = (energies - first) / start
        rows.append(
            dict(
                **grain_values(grain),
                timestep_factor=timestep_factor,
                step=number,
                error=error.mean(),
                greatest=np.abs(error).max(),
                dissipated=dissipated(state).sum() / start,
                contacts_made=state.counter[CONTACTS] - contacts,
            )
        )
        go(state, max(between, 0))
    return rows


def compute(settings, progress=None):
    """One grain with all steps, each for the same time.

    Parameters
    ----------
    settings : dict
        material, type, a_eff [m], seed, speed [m/s], timestep_factor (list), steps (at the f ``steps_at``), samples.
    progress : callable, optional
        Called with a sentence after each run.

    Returns
    -------
    list of dict
        Rows of `COLUMNS`.
    """
    grain = grow(settings["type"], settings["a_eff"], settings["material"], settings["seed"])
    rows = []
    for f in settings["timestep_factor"]:
        steps = round(settings["steps"] * settings["steps_at"] / f)
        rows += course(grain, settings["speed"], f, steps, settings["samples"])
        if progress is not None:
            progress(f"f = {f:g}: {steps} steps, greatest error {max(row['greatest'] for row in rows):.1e} so far")
    return rows
