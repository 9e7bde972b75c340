"""Theory: the angular velocity of disruption against estimates that need no simulation.

The bounds are those of a grain in some shape with some contacts. A grain that stretches or makes new contacts while it
is spun up has others. So the firm bound is taken as grown, and again in the last record before the first loss of mass,
which no spin-up may exceed; nor may it exceed the static limit of that shape, which the balance of all monomers sets.
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
from ratd.experiments.spin_up.static_limit import static_limit
from ratd.validation.tables import GRAIN_COLUMNS, grain_values, table_kind

AXIS = (0.0, 0.0, 1.0)
"""That a spun-up grain turns about. One that has stretched need not have its a_1 there."""
MARKS = ("omega_disr", "omega_first_loss", "omega_mass_75")
COLUMNS = {
    **GRAIN_COLUMNS,
    "n_contacts": ("1", "contacts"),
    "porosity": ("1", "porosity"),
    "cut_bound": ("rad s-1", "bound on omega of the grain as it stands"),
    "firm_bound": ("rad s-1", "bound on omega of the grain as it stands whose contacts hold sideways and push as well"),
    "firm_bound_at_loss": ("rad s-1", "the same of the grain in the last record before its first loss of mass"),
    "static_limit_at_loss": ("rad s-1", "greatest omega at which its monomers could all be in balance there"),
    **{name: ("rad s-1", f"mark {name} of ratd.experiments.spin_up.marks") for name in MARKS},
}
KIND = table_kind("theory", "Disruption against its bounds", COLUMNS)


def followed(grain, **how):
    """The spin-up of a grain as `ratd.spin_up` makes it by default, and how it stood just before the first loss.

    Parameters
    ----------
    grain : ratd.Grain
    **how
        Other numbers of the spin-up, see `ratd.experiments.spin_up.how.how_to_turn`.

    Returns
    -------
    run : xarray.Dataset
    last : types.SimpleNamespace
        `shape` of the grain in the last record in which it has all of its mass.
    """
    bound = cut_bound(grain)
    run = Run(grain, how_to_turn(grain.type, bound, **how), bound)
    run.begin(relax(grain, law=run.law, timestep_factor=TIMESTEP_FACTOR))
    mass = run.rows[0][2]
    while run.reason is None:
        if run.rows[-1][2] > mass * (1.0 - ROUNDING):
            last = shape(run.state, grain.material)
        run.advance()
    return run.dataset(), last


def shape(state, material):
    """What a bound needs of a grain in some state: position, radius, mass, contacts and material."""
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
        run, last = followed(grain)
        marks = disruption(run)
        rows.append(
            dict(
                **grain_values(grain),
                n_contacts=grain.n_contacts,
                porosity=grain.shape.porosity,
                cut_bound=cut_bound(grain),
                firm_bound=firm_bound(grain),
                firm_bound_at_loss=firm_bound(last, axis=AXIS),
                static_limit_at_loss=static_limit(last, axis=AXIS),
                **{name: float(marks[name]) for name in MARKS},
            )
        )
        if progress is not None:
            progress(f"seed {seed}: done")
    return rows
