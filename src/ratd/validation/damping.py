"""What the viscous time does to the marks of disruption: by how finely the damping is resolved, and by the rate.

The implicit damping is weaker than Eq. 22 for light monomers, the more the longer the step (docs/model/engine.md,
Damping); the explicit one is not, but lets long steps break down. A grain is spun up with several T_vis by both, with
shorter and shorter steps; and, as what T_vis does goes with the rate too, at several epsilon. The spin-up that waits,
the default of `ratd.spin_up`, is the limit of all that; a grain is spun up in that way with every T_vis as well.
"""

import math
from itertools import product

from ratd.aggregates.growth import grow
from ratd.base.materials import get_material
from ratd.base.units import PS
from ratd.drives.rotating import CONSTANT_EPSILON, SPIN_UP_LAWS
from ratd.experiments.spin_up.how import QUASI_STATIC
from ratd.validation.convergence import COLUMNS, spin_each, spin_one
from ratd.validation.tables import table_kind

KIND = table_kind("damping", "Marks of disruption against the viscous time and how finely it is resolved", COLUMNS)
RESOLUTION, RATE, WAITING = "T_vis", "epsilon", "waiting"
"""Studies, in the column of that name: one epsilon and several steps, several epsilon, or the spin-up that waits, which
has neither (NaN)."""


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
        Rows of `COLUMNS`, see `ratd.validation.convergence.compute`.
    """
    grain = grow(settings["type"], settings["a_eff"], get_material(settings["material"]), settings["seed"])
    if "epsilon" not in settings:
        found = [
            dict(study=WAITING, epsilon=math.nan, timestep_factor=math.nan, damping="implicit", law=QUASI_STATIC,
                 xi_c=None, viscous_time=time * PS)
            for time in settings["viscous_time_ps"]
        ]  # fmt: skip
        return [spin_one(grain, case) for case in found]
    several = isinstance(settings["epsilon"], list)
    found = [
        dict(
            study=RATE if several else RESOLUTION,
            epsilon=epsilon,
            timestep_factor=f,
            damping=damping,
            law=SPIN_UP_LAWS[CONSTANT_EPSILON],
            xi_c=None,
            viscous_time=time * PS,
        )
        for damping, factors in settings["timestep_factor"].items()
        for f, time, epsilon in product(
            factors, settings["viscous_time_ps"], settings["epsilon"] if several else [settings["epsilon"]]
        )
    ]
    return spin_each(grain, found, progress)
