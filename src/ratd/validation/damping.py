"""What the viscous time does to the marks of disruption: by how finely the damping is resolved, and by the rate.

The implicit damping is weaker than Eq. 22 for light monomers, the more the longer the step (docs/model/engine.md,
Damping); the explicit one is not, but lets long steps break down. A grain is spun up with several T_vis by both, with
shorter and shorter steps; and, as what T_vis does goes with the rate too, at several epsilon.
"""

from itertools import product

from ratd.aggregates.growth import grow
from ratd.base.materials import get_material
from ratd.base.units import PS
from ratd.drives.rotating import CONSTANT_EPSILON, SPIN_UP_LAWS
from ratd.validation.convergence import COLUMNS, spin_each
from ratd.validation.tables import table_kind

KIND = table_kind("damping", "Marks of disruption against the viscous time and how finely it is resolved", COLUMNS)
RESOLUTION, RATE = "T_vis", "epsilon"
"""Studies, in the column of that name: one epsilon and several steps, or several epsilon."""


def compute(settings, progress=None):
    """Spin one grain up with every T_vis, epsilon, treatment of the damping and step.

    Parameters
    ----------
    settings : dict
        material, type, a_eff [m], seed, ``epsilon`` (a number for the study `RESOLUTION`, a list for `RATE`),
        ``viscous_time_ps`` (list), ``timestep_factor`` {implicit: list, explicit: list}.
    progress : callable, optional
        Called with a sentence after each run.

    Returns
    -------
    list of dict
        Rows of `COLUMNS`, see `ratd.validation.convergence.compute`.
    """
    grain = grow(settings["type"], settings["a_eff"], get_material(settings["material"]), settings["seed"])
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
