"""What the viscous time does to the marks of disruption: by how finely the damping is resolved, and by the rate.

The implicit damping is weaker than Eq. 22 for light monomers, the more the longer the step (docs/model/engine.md,
Damping); the explicit one is not, but lets long steps break down. A grain is spun up with several T_vis by both, with
shorter and shorter steps; and, as what T_vis does goes with the rate too, at several epsilon. The spin-up that waits,
the default of `ratd.spin_up`, is the limit of all that; a grain is spun up in that way with every T_vis as well.
"""

import math
from dataclasses import replace
from itertools import product

from ratd.aggregates.growth import grow
from ratd.base.errors import GrainError, is_of_one_grain
from ratd.base.materials import get_material
from ratd.base.units import PS
from ratd.drives.rotating import CONSTANT_EPSILON, SPIN_UP_LAWS
from ratd.experiments.spin_up.how import QUASI_STATIC
from ratd.experiments.spin_up.marks import disruption
from ratd.experiments.spin_up.run import spin_up
from ratd.validation.tables import GRAIN_COLUMNS, empty_row, grain_values, table_kind

MARKS = ("omega_disr", "omega_first_loss", "omega_mass_75", "omega_contacts_75")
# words and columns are those of the files that are kept, of a time when more than T_vis was varied
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
table_kind("damping", "Marks of disruption against the viscous time and how finely it is resolved", COLUMNS)
RESOLUTION, RATE, WAITING = "T_vis", "epsilon", "waiting"
"""Studies, in the column of that name: one epsilon and several steps, several epsilon, or the spin-up that waits, which
has neither (NaN)."""
UNSTABLE_STEPS = 5
"""A run is given up after so many times the steps that it should take: something has come loose and flies."""


def compute(settings, progress=None):
    """Spin one grain up with every T_vis, epsilon, treatment of the damping and step.

    Parameters
    ----------
    settings : dict
        material, type, a_eff [m], seed, ``viscous_time_ps`` (list); ``epsilon`` (a number for the study `RESOLUTION`,
        a list for `RATE`) and ``timestep_factor`` {implicit: list, explicit: list}, neither for the study `WAITING`.
    progress : callable, optional
        Called with a sentence after each run.

    Returns
    -------
    list of dict
        Rows of `COLUMNS`. A run that fails has NaN marks and says so in ``outcome``.
    """
    grain = grow(settings["type"], settings["a_eff"], get_material(settings["material"]), settings["seed"])
    times = [time * PS for time in settings["viscous_time_ps"]]
    if "epsilon" not in settings:
        case = dict(study=WAITING, epsilon=math.nan, timestep_factor=math.nan, damping="implicit", law=QUASI_STATIC)
        return [_spin(grain, case | {"viscous_time": time}) for time in times]
    several = isinstance(settings["epsilon"], list)
    found = [
        dict(
            study=RATE if several else RESOLUTION,
            epsilon=epsilon,
            timestep_factor=f,
            damping=damping,
            law=SPIN_UP_LAWS[CONSTANT_EPSILON],
            viscous_time=time,
        )
        for damping, factors in settings["timestep_factor"].items()
        for f, time, epsilon in product(factors, times, settings["epsilon"] if several else [settings["epsilon"]])
    ]
    return _spin_each(grain, found, progress)


def _spin_each(grain, found, progress):
    """Rows of a grain spun up in several ways, the fastest first, which says when to give up the others."""
    work = None  # steps times epsilon times f, the same for all runs that are stable
    rows = []
    for case in sorted(found, key=lambda case: -case["epsilon"] * case["timestep_factor"]):
        rate = case["epsilon"] * case["timestep_factor"]
        row = _spin(grain, case, None if work is None else int(UNSTABLE_STEPS * work / rate))
        if row["outcome"] == "one contact left" and case["damping"] == "implicit" and work is None:
            work = row["steps"] * rate
        rows.append(row)
        if progress is not None:
            progress(f"{case['study']} {case['epsilon']:g} {case['timestep_factor']:g}: {row['outcome']}")
    return rows


def _spin(grain, case, max_steps=None):
    """One run of a grain as a row of `COLUMNS`, of which `case` has those that say how it is spun up."""
    row = empty_row(COLUMNS) | case | grain_values(grain)
    row |= {"xi_c": grain.material.critical_rolling_displacement, "n_contacts": grain.n_contacts}
    waits = case["law"] == QUASI_STATIC
    how = {} if waits else {name: case[name] for name in ("epsilon", "timestep_factor", "damping")}
    changed = grain.replace(material=replace(grain.material, viscous_time=case["viscous_time"]))
    try:
        run = spin_up(changed, **how, max_steps=max_steps)
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
