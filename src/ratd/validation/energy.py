"""Energy of a spin-up: the work of the outer torque against what is stored and dissipated, mode by mode."""

import numpy as np

from ratd.aggregates.growth import grow
from ratd.experiments.spin_up.run import spin_up
from ratd.validation.lammps import MARKS
from ratd.validation.tables import GRAIN_COLUMNS, grain_values, table_kind

MODES = ("sliding", "rolling", "twisting", "damping", "contact", "drag")
SETTLED = 0.01
"""Part of the whole work from which on a gap counts: at the start it is a part of nothing."""
COLUMNS = {
    **GRAIN_COLUMNS,
    "epsilon": ("1", "(d omega/dt)/omega^2; NaN for a spin-up that waits"),
    "timestep_factor": ("1", "f in the time step f min(t_dis, t_vel); NaN for a spin-up that waits"),
    "omega": ("rad s-1", "angular velocity of the last record before the first loss of mass; energies are those there"),
    "work": ("J", "work done by the outer torque since the start"),
    "kinetic": ("J", "kinetic energy in the inertial frame"),
    "potential": ("J", "potential energy of the contacts, less that at the start"),
    **{f"dissipated_{mode}": ("J", f"energy dissipated since the start: {mode}") for mode in MODES},
    "worst_to_quarter": ("1", "greatest gap over the work up to the loss of a quarter of the mass"),
    "worst": ("1", "greatest gap over the work in the whole run, fragments that left included"),
}
table_kind("energy", "Balance of energy", COLUMNS)


def compute(settings, progress=None):
    """Spin grains up, and compare the energies before the first loss of mass, and over the whole run.

    Parameters
    ----------
    settings : dict
        material, type, a_eff [m], seeds; epsilon and timestep_factor for spin-ups that do not wait.
    progress : callable, optional
        Called with a sentence.

    Returns
    -------
    list of dict
        Rows of `COLUMNS`, one a grain.
    """
    how = {name: settings[name] for name in ("epsilon", "timestep_factor") if name in settings}
    rows = []
    for seed in range(settings["seeds"]):
        grain = grow(settings["type"], settings["a_eff"], settings["material"], seed)
        rows.append(
            grain_values(grain) | {"epsilon": np.nan, "timestep_factor": np.nan} | how | gaps(spin_up(grain, **how))
        )
        if progress is not None:
            progress(f"seed {seed}: the balance is off by {rows[-1]['worst']:.1e} of the work at most")
    return rows


def gaps(run):
    """Columns of `COLUMNS` from ``omega`` on.

    Parameters
    ----------
    run : xarray.Dataset
        From `ratd.spin_up`.

    Returns
    -------
    dict
    """
    mass, work = run["mass"].values, run["torque_work"].values
    whole = np.flatnonzero(mass > mass[0] * MARKS["first loss"])[-1]
    settled = work > SETTLED * work[-1]
    gap = np.where(settled, np.abs(run["energy_residual"].values) / np.where(settled, work, np.nan), 0.0)
    quarter = np.flatnonzero(mass >= MARKS["25 % of the mass"] * mass[0])[-1] + 1
    return {
        "omega": run["omega"].values[whole],
        "work": work[whole],
        "kinetic": run["kinetic_energy"].values[whole] - run["kinetic_energy"].values[0],
        "potential": run["potential_energy"].values[whole] - run["potential_energy"].values[0],
        **{f"dissipated_{m}": np.diff(run[f"dissipated_{m}"].values[[0, whole]])[0] for m in MODES},
        "worst_to_quarter": gap[: quarter + 1].max(),
        "worst": gap.max(),
    }
