"""Theory: the angular velocity of disruption against estimates that need no simulation.

The bounds are those of a grain in some shape with some contacts. A grain that stretches or makes new contacts while it
is spun up has others. So the firm bound is taken as grown, and again in the last record before the first loss of mass,
which no spin-up may exceed.
"""

from types import SimpleNamespace

from ratd.aggregates.growth import grow
from ratd.engine.fragments import contact_pairs
from ratd.engine.layout import MASS, RADIUS, X
from ratd.engine.state import monomer_rows
from ratd.experiments.relax import relax
from ratd.experiments.spin_up.cut_bound import cut_bound
from ratd.experiments.spin_up.firm_bound import firm_bound
from ratd.experiments.spin_up.how import TIMESTEP_FACTOR, how_to_turn
from ratd.experiments.spin_up.marks import ROUNDING, disruption
from ratd.experiments.spin_up.run import Run
from ratd.validation.tables import GRAIN_COLUMNS, grain_values, table_kind

MARKS = ("omega_disr", "omega_first_loss", "omega_mass_75")
COLUMNS = {
    **GRAIN_COLUMNS,
    "n_contacts": ("1", "contacts"),
    "porosity": ("1", "porosity"),
    "cut_bound": ("rad s-1", "bound on omega of the grain as it stands"),
    "firm_bound": ("rad s-1", "bound on omega of the grain as it stands whose contacts hold sideways and push as well"),
    "firm_bound_at_loss": ("rad s-1", "the same of the grain in the last record before its first loss of mass"),
    **{name: ("rad s-1", f"mark {name} of ratd.experiments.spin_up.marks") for name in MARKS},
}
KIND = table_kind("theory", "Disruption against its bounds", COLUMNS)


def followed(grain):
    """The spin-up of a grain as `ratd.spin_up` makes it by default, and the firm bound just before the first loss.

    Parameters
    ----------
    grain : ratd.Grain

    Returns
    -------
    run : xarray.Dataset
    bound : float
        Firm bound [rad/s] of the grain in the last record in which it has all of its mass.
    """
    bound = cut_bound(grain)
    run = Run(grain, how_to_turn(grain.type, bound), bound)
    run.begin(relax(grain, law=run.law, timestep_factor=TIMESTEP_FACTOR))
    mass = run.rows[0][2]
    while run.reason is None:
        if run.rows[-1][2] > mass * (1.0 - ROUNDING):
            last = shape(run.state, grain.material)
        run.advance()
    return run.dataset(), firm_bound(last)


def shape(state, material):
    """What `firm_bound` needs of a grain in some state: position, radius, mass, contacts and material."""
    rows = monomer_rows(state)
    position, radius, mass = (rows[:, columns].copy() for columns in (slice(X, X + 3), RADIUS, MASS))
    contacts = contact_pairs(state).copy()
    return SimpleNamespace(position=position, radius=radius, mass=mass, contacts=contacts, material=material)


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
        run, at_loss = followed(grain)
        marks = disruption(run)
        rows.append(
            dict(
                **grain_values(grain),
                n_contacts=grain.n_contacts,
                porosity=grain.shape.porosity,
                cut_bound=cut_bound(grain),
                firm_bound=firm_bound(grain),
                firm_bound_at_loss=at_loss,
                **{name: float(marks[name]) for name in MARKS},
            )
        )
        if progress is not None:
            progress(f"seed {seed}: done")
    return rows
