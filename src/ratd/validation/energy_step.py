"""Energy of a free grain that vibrates and turns without dissipation: how well the scheme keeps it, against the step.

There is no damping, and sliding and rolling have no limits; twisting stays below its limit, which the column
``dissipated`` proves.
"""

from dataclasses import replace

from ratd.aggregates.growth import grow
from ratd.experiments.evolve import evolve
from ratd.experiments.spin_up.same_grains import first_step
from ratd.laws.jkr_with_springs import jkr
from ratd.validation.free_grain import random_motion
from ratd.validation.tables import GRAIN_COLUMNS, grain_values, table_kind

COLUMNS = {
    **GRAIN_COLUMNS,
    "timestep_factor": ("1", "f in the time step f min(t_dis, t_vel)"),
    "time": ("s", "time since the start"),
    "error": ("1", "energy less that at the start, over the kinetic energy at the start"),
    "dissipated": ("1", "energy dissipated so far over the kinetic energy at the start"),
    "contacts_made": ("1", "contacts more than at the start"),
}
KIND = table_kind("energy_step", "Energy of elastic free grains against the step", COLUMNS)
ELASTIC = jkr(damping="none", sliding_limit=1e12)
NO_ROLLING_LIMIT = 1.0
"""Critical rolling displacement that no contact gets to [m]."""


def course(grain, speed, timestep_factor, duration, samples):
    """Energy of one free elastic grain, as rows of `COLUMNS`.

    Parameters
    ----------
    grain : ratd.Grain
    speed : float
        Standard deviation of each component of the velocities, and of the spins times the greatest radius; also the
        angular velocity of the whole, about z, times the effective radius [m/s].
    timestep_factor : float
        f of Eq. 31.
    duration : float
        Length of the run [s].
    samples : int
        How often the energy is taken.

    Returns
    -------
    list of dict
    """
    velocity, spin = random_motion(grain, speed, speed / grain.radius.max(), speed / grain.effective_radius)
    run = evolve(
        grain.position,
        grain.radius,
        velocity,
        spin,
        replace(grain.material, critical_rolling_displacement=NO_ROLLING_LIMIT),
        law=ELASTIC,
        contacts=grain.contacts,
        duration=duration,
        timestep_factor=timestep_factor,
        records=samples,
        balance=None,
    )
    start = float(run["kinetic_translation"][0] + run["kinetic_spin"][0])
    return [
        dict(
            **grain_values(grain),
            timestep_factor=timestep_factor,
            time=float(row["time"]),
            error=float(row["residual"]) / start,
            dissipated=float(row["dissipated"].sum()) / start,
            contacts_made=int(row["n_contacts"]) - grain.n_contacts,
        )
        for row in (run.isel(record=k) for k in range(1, samples + 1))
    ]


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
    duration = settings["steps"] * first_step(grain, settings["steps_at"])
    rows = []
    for f in settings["timestep_factor"]:
        rows += course(grain, settings["speed"], f, duration, settings["samples"])
        if progress is not None:
            progress(f"f = {f:g}: greatest error {max(abs(row['error']) for row in rows):.1e} so far")
    return rows
