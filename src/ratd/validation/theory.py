"""Theory: the angular velocity of disruption against three estimates that need no simulation."""

import math

from ratd.aggregates.growth import grow
from ratd.experiments.spin_up.cut_bound import cut_bound
from ratd.experiments.spin_up.firm_bound import firm_bound
from ratd.experiments.spin_up.marks import disruption
from ratd.experiments.spin_up.run import spin_up
from ratd.experiments.spin_up.tensile import midplane_bound
from ratd.validation.tables import GRAIN_COLUMNS, grain_values, table_kind

MARKS = ("omega_disr", "omega_first_loss", "omega_mass_75")
COLUMNS = {
    **GRAIN_COLUMNS,
    "n_contacts": ("1", "contacts"),
    "porosity": ("1", "porosity"),
    "cut_bound": ("rad s-1", "bound on omega of the grain as it stands"),
    "firm_bound": ("rad s-1", "bound on omega of the grain as it stands whose contacts hold sideways and push as well"),
    "midplane": ("rad s-1", "omega at which the mean tension at the mid-plane is the strength of Tatsuuma 2019"),
    **{name: ("rad s-1", f"mark {name} of ratd.experiments.spin_up.marks") for name in MARKS},
}
KIND = table_kind("theory", "Disruption against bound and tensile strength", COLUMNS)


def compute(settings, progress=None):
    """Spin up all grains of one type and size.

    Parameters
    ----------
    settings : dict
        material, type, a_eff [m], seeds (number).
    progress : callable, optional
        Called with a sentence after each grain.

    Returns
    -------
    list of dict
        Rows of `COLUMNS`.
    """
    rows = []
    for seed in range(settings["seeds"]):
        grain = grow(settings["type"], settings["a_eff"], settings["material"], seed)
        run = spin_up(grain)
        marks = disruption(run)
        solid = not math.isfinite(grain.shape.porosity) or grain.shape.porosity <= 0.0
        rows.append(
            dict(
                **grain_values(grain),
                n_contacts=grain.n_contacts,
                porosity=grain.shape.porosity,
                cut_bound=cut_bound(grain),
                firm_bound=firm_bound(grain),
                midplane=math.nan if solid else midplane_bound(grain),
                **{name: float(marks[name]) for name in MARKS},
            )
        )
        if progress is not None:
            progress(f"seed {seed}: done")
    return rows
