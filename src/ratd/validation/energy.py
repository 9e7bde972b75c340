"""Energy: the work of the outer torque against what is stored and dissipated, mode by mode."""

import numpy as np

from ratd.aggregates.growth import grow
from ratd.experiments.spin_up.run import spin_up
from ratd.validation.tables import GRAIN_COLUMNS, grain_values, table_kind

MODES = ("sliding", "rolling", "twisting", "damping", "contact")
COLUMNS = {
    **GRAIN_COLUMNS,
    "epsilon": ("1", "(d omega/dt)/omega^2"),
    "timestep_factor": ("1", "f in the time step f min(t_dis, t_vel)"),
    "omega": ("rad s-1", "angular velocity"),
    "first_loss": ("rad s-1", "angular velocity at which the first part left the grain"),
    "work": ("J", "work done by the outer torque since the start"),
    "kinetic": ("J", "kinetic energy in the inertial frame"),
    "potential": ("J", "potential energy of the contacts, less that at the start"),
    **{f"dissipated_{mode}": ("J", f"energy dissipated since the start: {mode}") for mode in MODES},
}
KIND = table_kind("energy", "Closure of the energy", COLUMNS)


def compute(settings, progress=None):
    """Spin one grain up, and keep its energies up to the first loss of mass.

    Parameters
    ----------
    settings : dict
        material, type, a_eff [m], seed, epsilon, timestep_factor.
    progress : callable, optional
        Called with a sentence.

    Returns
    -------
    list of dict
        Rows of `COLUMNS`, one a record. Afterwards a fragment takes its energy with it, and there is no balance.
    """
    grain = grow(settings["type"], settings["a_eff"], settings["material"], settings["seed"])
    run = spin_up(grain, epsilon=settings["epsilon"], timestep_factor=settings["timestep_factor"])
    mass = run["mass"].values
    whole = int(np.argmax(mass < mass[0] * (1.0 - 1e-9)))
    values = {name: run[name].values - run[name].values[0] for name in ("potential_energy", "torque_work")}
    rows = []
    for k in range(1, whole):
        rows.append(
            dict(
                **grain_values(grain),
                epsilon=settings["epsilon"],
                timestep_factor=settings["timestep_factor"],
                omega=run["omega"].values[k],
                first_loss=run["omega"].values[whole],
                work=values["torque_work"][k],
                kinetic=run["kinetic_energy"].values[k],
                potential=values["potential_energy"][k],
                **{f"dissipated_{m}": run[f"dissipated_{m}"].values[k] for m in MODES},
            )
        )
    if progress is not None:
        progress(f"{len(rows)} records before the first loss")
    return rows
