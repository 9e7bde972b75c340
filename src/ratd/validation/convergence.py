"""Convergence: marks of disruption against spin-up rate, time step, treatment of damping, and two constants.

Every grain is spun up once with each setting, one setting at a time being changed. A grain compared with itself has no
scatter from its form; what is left is the shift that is looked for and the chaos of the breaks.
"""

from dataclasses import replace

import numpy as np

from ratd.aggregates.growth import grow
from ratd.base.errors import GrainError, is_of_one_grain
from ratd.base.materials import get_material
from ratd.drives.rotating import CONSTANT_EPSILON, SPIN_UP_LAWS
from ratd.experiments.spin_up.cut_bound import cut_bound
from ratd.experiments.spin_up.how import FIRST_LOSS, QUASI_STATIC
from ratd.experiments.spin_up.marks import disruption
from ratd.experiments.spin_up.run import spin_up
from ratd.validation.tables import GRAIN_COLUMNS, grain_values, table_kind

MARKS = ("omega_disr", "omega_first_loss", "omega_mass_75", "omega_contacts_75")
COLUMNS = {
    "study": ("", "what is varied: epsilon, epsilon_fine, epsilon_large, timestep_factor, law, xi_c or T_vis"),
    "damping": ("", "treatment of the damping"),
    "law": ("", "spin-up law"),
    "outcome": ("", "how the run ended"),
    **GRAIN_COLUMNS,
    "epsilon": ("1", "(d omega/dt)/omega^2"),
    "timestep_factor": ("1", "f in the time step f min(t_dis, t_vel)"),
    "xi_c": ("m", "critical rolling displacement"),
    "viscous_time": ("s", "viscous time T_vis"),
    "n_contacts": ("1", "contacts at the start"),
    "cut_bound": ("rad s-1", "bound on omega of the grain as it stands"),
    "steps": ("1", "number of time steps"),
    **{name: ("rad s-1", f"mark {name} of ratd.experiments.spin_up.marks") for name in MARKS},
}
KIND = table_kind("convergence", "Convergence of the marks of disruption", COLUMNS)
EPSILON_ALONE = ("epsilon_fine", "epsilon_large")
"""Studies of grains for which nothing but epsilon is varied."""
UNSTABLE_STEPS = 5
"""A run is given up after so many times the steps that it should take: something has come loose and flies."""


def cases(settings):
    """The runs of one grain.

    Parameters
    ----------
    settings : dict
        ``production_timestep_factor`` (where no step is varied), ``epsilon`` (list), ``step_epsilon`` (the epsilon at
        which steps and constants are compared), ``timestep_factor`` {implicit: list, explicit: list}, ``xi_c_nm`` and
        ``viscous_time_ps`` (lists). For a grain that is to tell of a slow spin-up alone:
        ``production_timestep_factor`` and one of `EPSILON_ALONE` (list of epsilon), nothing else.

    Returns
    -------
    list of dict
        study, epsilon, timestep_factor, damping, law, xi_c [m or None for the material's own], viscous_time
        [s or None].
    """
    plain = dict(
        epsilon=settings.get("step_epsilon"),
        timestep_factor=settings["production_timestep_factor"],
        damping="implicit",
        law=SPIN_UP_LAWS[CONSTANT_EPSILON],
        xi_c=None,
        viscous_time=None,
    )
    for study in EPSILON_ALONE:
        if study in settings:
            return [plain | dict(study=study, epsilon=epsilon) for epsilon in settings[study]]
    found = [plain | dict(study="epsilon", epsilon=epsilon) for epsilon in settings["epsilon"]]
    for damping, factors in settings["timestep_factor"].items():
        found += [plain | dict(study="timestep_factor", timestep_factor=f, damping=damping) for f in factors]
    found += [plain | dict(study="law", law=law) for law in SPIN_UP_LAWS]
    found += [plain | dict(study="xi_c", xi_c=value * 1e-9) for value in settings["xi_c_nm"]]
    found += [plain | dict(study="T_vis", viscous_time=value * 1e-12) for value in settings["viscous_time_ps"]]
    return found


def compute(settings, progress=None):
    """Spin one grain up with every setting.

    Parameters
    ----------
    settings : dict
        As for `cases`, and material, type, a_eff [m], seed.
    progress : callable, optional
        Called with a sentence after each run.

    Returns
    -------
    list of dict
        Rows of `COLUMNS`. A run that fails has NaN marks and says so in ``outcome``.
    """
    grain = grow(settings["type"], settings["a_eff"], get_material(settings["material"]), settings["seed"])
    return spin_each(grain, cases(settings), progress)


def spin_each(grain, found, progress=None):
    """Spin one grain up in several ways, the fastest first, which says when to give up the others.

    Parameters
    ----------
    grain : ratd.Grain
    found : list of dict
        As from `cases`.
    progress : callable, optional
        Called with a sentence after each run.

    Returns
    -------
    list of dict
        As from `compute`.
    """
    work = None  # steps times epsilon times f, the same for all runs that are stable
    rows = []
    for case in sorted(found, key=lambda case: -case["epsilon"] * case["timestep_factor"]):
        rate = case["epsilon"] * case["timestep_factor"]
        max_steps = None if work is None else int(UNSTABLE_STEPS * work / rate)
        row = spin_one(grain, case, max_steps)
        if row["outcome"] == "one contact left" and case["damping"] == "implicit" and work is None:
            work = row["steps"] * rate
        rows.append(row)
        if progress is not None:
            progress(f"{case['study']} {case['epsilon']:g} {case['timestep_factor']:g}: {row['outcome']}")
    return rows


def _pace(grain, case):
    """How `spin_up` is to turn the grain; Eq. 24 has the epsilon of the case where the other law reaches it."""
    if case["law"] == QUASI_STATIC:
        return {}
    step = {"timestep_factor": case["timestep_factor"], "damping": case["damping"]}
    if case["law"] == SPIN_UP_LAWS[CONSTANT_EPSILON]:
        return step | {"epsilon": case["epsilon"]}
    return step | {"angular_acceleration": case["epsilon"] * (FIRST_LOSS * cut_bound(grain)) ** 2}


def spin_one(grain, case, max_steps=None):
    """One run of one grain as a row of `COLUMNS`.

    Parameters
    ----------
    grain : ratd.Grain
    case : dict
        From `cases`.
    max_steps : int, optional
        Where to give up.

    Returns
    -------
    dict
    """
    own = grain.material
    xi_c = own.critical_rolling_displacement if case["xi_c"] is None else case["xi_c"]
    viscous_time = own.viscous_time if case["viscous_time"] is None else case["viscous_time"]
    changed = grain.replace(material=replace(own, critical_rolling_displacement=xi_c, viscous_time=viscous_time))
    row = {name: "" if not units else np.nan for name, (units, _) in COLUMNS.items()}
    row |= dict(
        study=case["study"],
        **grain_values(grain),
        damping=case["damping"],
        law=case["law"],
        epsilon=case["epsilon"],
        timestep_factor=case["timestep_factor"],
        xi_c=xi_c,
        viscous_time=viscous_time,
        n_contacts=grain.n_contacts,
    )
    try:
        run = spin_up(
            changed,
            **_pace(grain, case),
            max_steps=max_steps,
        )
    except (RuntimeError, GrainError) as error:
        if not is_of_one_grain(error):
            raise
        return row | {"outcome": "failed: " + str(error).split(":")[0]}
    marks = disruption(run)
    return row | {
        "outcome": run.attrs["end_reason"],
        "cut_bound": run.attrs["cut_bound"],
        "steps": run.attrs["steps"],
        **{name: float(marks[name]) for name in MARKS},
    }
