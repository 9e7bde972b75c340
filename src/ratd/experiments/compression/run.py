"""Compress a cluster: the experiment of Kataoka et al. (2013)."""

import math
import warnings

import numpy as np
import xarray as xr

from ratd.aggregates.grain import Grain, seated
from ratd.aggregates.strength import rolling_pressure
from ratd.base.checks import is_number
from ratd.base.errors import InputError
from ratd.base.materials import get_material
from ratd.engine import checkpoint as checkpoints
from ratd.engine.layout import RADIUS, X
from ratd.engine.state import monomer_rows, new_state
from ratd.experiments.compression.static import box_rate, static_from, time_unit
from ratd.experiments.compression.steps import LongSteps, integrators
from ratd.experiments.compression.strain import Parts, strain, strain_dataset
from ratd.experiments.evolve import depth
from ratd.experiments.made_with import constants_of
from ratd.experiments.unfinished import attached
from ratd.geometry.box import periodic, touching_pairs
from ratd.geometry.shape import greatest_extent
from ratd.laws.chosen import check_stiffness, law_of
from ratd.laws.jkr_with_springs import jkr
from ratd.observables.structure import radius_of_gyration

__all__ = ["BALANCE", "LONG_STEPS", "TIMESTEP_FACTOR", "Cluster", "compress", "prepared"]

RECORD_STEP = 1.01
"""Ratio of the filling factors of two records."""
FASTEST = 1e-2
"""Greatest `strain_rate`: a box of BCCA clusters that shrinks faster outruns its monomers."""
LOOSEST = 1e-6
"""Least filling factor to begin with: clusters of a million monomers start at 5e-4."""
DENSEST = 0.64
"""Greatest `until_phi`: random close packing of equal spheres."""
DEEP = 0.15
"""Overlap over the smaller radius beyond which a compression is doubted; at phi = 0.5 it is some 0.05 as a rule."""
TIMESTEP_FACTOR = 0.14
"""f of the explicit step: 0.2 t_0 for equal monomers, at which P lies within 1 % of that at half the step up to
phi = 0.1."""
K_N = 0.01
"""k_n of the constant damping."""
SNAPSHOTS = (0.003, 0.01, 0.03, 0.1, 0.3)
LONG_STEPS = LongSteps()
BALANCE = {0.0: 0.2, 0.1: 0.005, 0.3: 0.002}
"""From this filling factor on, the balance of energy is to hold to this part of the work of the box, or of what was
dissipated, with explicit steps; where long ones were taken, the part of these may be `LONG_BALANCE` of theirs."""
LONG_BALANCE = {0.0: 0.2, 0.05: 0.02, 0.1: 0.005, 0.3: 0.002}
EVENTS = 100
"""Contacts whose energy is taken in place of both where they are less."""
REMEDY = "take a lower strain_rate, in Python also a smaller timestep_factor; there balance=False lets it run on"
"""What to do where the balance of energy is off."""
NOT_STATIC = 0.1
"""A run is warned of when it is static only from this filling factor on, or not at all."""


class Cluster:
    """A checked aggregate, and the constants that its compression is told in.

    Attributes
    ----------
    grain : Grain
    radius : float
        r_0 [m]: radius of the equal monomers, or that of the monomer of mean volume.
    time_unit : float
        t_0 [s] of two monomers of this radius.
    rolling_pressure : float
        P_0 = E_roll/r_0^3 [Pa].
    """

    def __init__(self, cluster, material=None):
        if isinstance(cluster, xr.Dataset):
            raise InputError(
                "the cluster is a Dataset, such as ratd.compress returns; a run that ended cannot be squeezed further: "
                "compress the ratd.Grain again with a higher until_phi."
            )
        if not isinstance(cluster, Grain):
            raise InputError(
                f"the cluster is of type {type(cluster).__name__}; it must be a ratd.Grain, from ratd.grow_bcca, "
                "ratd.grow or ratd.Grain(position, radius, material)."
            )
        if material is not None:
            cluster = _of(cluster, get_material(material))
        self.grain = cluster = seated(cluster)
        self.radius = float(np.mean(cluster.radius**3)) ** (1.0 / 3.0)
        self.time_unit = time_unit(cluster.material, self.radius)
        own = cluster.material.surface_energy, cluster.material.critical_rolling_displacement
        self.rolling_pressure = rolling_pressure(*own, self.radius)

    @property
    def volume(self):
        """Volume of the monomers [m3]."""
        return 4.0 / 3.0 * math.pi * float(np.sum(self.grain.radius**3))


def _of(cluster, material):
    """The same cluster of another material."""
    try:
        return cluster.replace(material=material)
    except InputError as error:
        raise InputError(
            f"material is {material.name!r}, in which contacts as deep as those of this cluster of "
            f"{cluster.material.name!r} cannot be: grow it of that material. {error}"
        ) from None


def compress(
    cluster,
    strain_rate=1e-6,
    until_phi=0.5,
    *,
    material=None,
    law=None,
    timestep_factor=TIMESTEP_FACTOR,
    long_steps=LONG_STEPS,
    box_length=None,
    scheme="homogeneous",
    snapshots=SNAPSHOTS,
    balance=True,
    checkpoint=None,
    progress=None,
):
    """Compress an aggregate by its own copies, in a periodic box that shrinks.

    Parameters
    ----------
    cluster : Grain
        From `ratd.grow_bcca`, or any other aggregate in one piece.
    strain_rate : float
        C_v: the box shrinks with dL/dt = -2 C_v L/t_0, at most `FASTEST`.
    until_phi : float
        Filling factor at which to end.
    material : str or Material, optional
        In place of that of the cluster; its contacts have to suit it, so that it is best grown of it.
    law : str or part, optional
        Contact law; by default `ratd.laws.jkr` with the constant damping k_n = 0.01. Long steps need one that tells its
        stiffness, which "dmt" does not.
    timestep_factor : float
        f of the explicit step.
    long_steps : LongSteps or None
        The long steps that a loose aggregate is compressed with; None for explicit steps throughout, which take about
        ten times as long.
    box_length : float, optional
        Edge of the box at the start [m]; by default the greatest extent of the cluster along x, y or z, in which copies
        do not overlap.
    scheme : {"homogeneous", "as_printed"}
        See `ratd.periodic`.
    snapshots : sequence of float
        Filling factors at which positions are kept; those that the run does not pass are left out, and of those less
        than 1 % apart, between the same two records, one is kept.
    balance : bool
        Whether the run ends with an error when the balance of energy is off by more than `BALANCE` allows.
    checkpoint : path-like, optional
        Where to keep what is needed to go on after a kill, with the same bits.
    progress : callable, optional
        Called every few seconds as ``progress(phi, pressure, seconds_to_go)``.

    Returns
    -------
    xarray.Dataset
        Along ``record``, which are 1 % in phi apart: ``phi``, ``pressure`` (mean since the last record, at
        ``phi_mean``), ``pressure_tensor``, ``n_contacts``, ``box_length``, ``stored_MODE``, ``dissipated_WAY``,
        ``work``, ``energy_residual``. Along ``snapshot``: ``snapshot_phi``, ``snapshot_box_length``,
        ``snapshot_position``. The attributes say what was done, and from which filling factor on the compression is
        static (``static_from``). `ratd.stretch` goes on from it.

    Raises
    ------
    InputError
        If an argument is not usable.
    RuntimeError
        If the integration fails, or leaves the balance of energy; its attribute ``run`` holds the Dataset up to there.

    Warns
    -----
    UserWarning
        If inertia dominates up to phi = 0.1, or to `until_phi` where this is less; if two monomers overlap at the end
        by more than `DEEP` of the smaller radius, for which no law of contact is meant.

    References
    ----------
    Kataoka et al. (2013), A&A 554, A4; docs/model/drives.md says what is not as printed.
    """
    cluster = Cluster(cluster, material)
    strain_rate = check_rate(strain_rate)
    if not isinstance(balance, bool):
        raise InputError(f"balance is {balance!r}; it must be True or False.")
    snapshots = _filling_factors(snapshots)
    box, first, until_phi = _box(cluster, strain_rate, until_phi, box_length, scheme)
    law = law_of(law, compression_law)
    if long_steps is not None:
        check_stiffness(law, "give long_steps=None")
    first_integrator, explicit = integrators(
        cluster.grain.material, cluster.radius, cluster.time_unit, timestep_factor, long_steps, strain_rate
    )
    parts = Parts(law, box, first_integrator)
    static = _static_from(cluster, box, until_phi)

    number = math.ceil(math.log(until_phi / first) / math.log(RECORD_STEP))
    phi = first * np.exp(np.log(until_phi / first) * np.arange(1, number + 1) / number)
    marks = np.log(first / phi) / (3.0 * box.rate_x)
    reached = [value for value in snapshots if first <= value <= until_phi]
    wanted = sorted({int(np.searchsorted(phi, value * (1.0 - 1e-9))) + 1 for value in reached})
    later = None if first_integrator is explicit else (int(np.searchsorted(phi, long_steps.until_phi)) + 1, explicit)
    state, key = prepared(cluster, parts, (until_phi, tuple(wanted), later))

    def tell(row, seconds_to_go):
        progress(row["phi_mean"], row["pressure"], seconds_to_go)

    check = balance_check(BALANCE, LONG_BALANCE, REMEDY) if balance else None
    how = {"snapshots": wanted, "check": check, "tell": tell if progress else None, "later": later}
    about = {
        **attributes(cluster),
        "strain_rate": strain_rate,
        "scheme": scheme,
        "static_from": static,
        "phi_start": first,
        "radius_of_gyration": radius_of_gyration(cluster.grain.position, cluster.grain.mass),
    }

    def dataset(state, rows, kept):
        run = strain_dataset(state, rows, parts)
        if later is not None:
            run.attrs["integrator"] += f", from phi = {long_steps.until_phi:g} on {explicit!r}"
        _add_snapshots(run, kept, wanted[: len(kept)])
        return run.assign_attrs(about)

    with attached("run", lambda error: dataset(*error.reached)):
        reached = strain(state, parts, marks, key=key, checkpoint=checkpoint, **how)
    _warn_of_overlap(reached[0], parts)
    return dataset(*reached)


def _warn_of_overlap(state, parts):
    """Warn where monomers are pressed into each other, as those of a perfectly straight chain or of a crystal are."""
    rows = monomer_rows(state)
    position, radius = np.ascontiguousarray(rows[:, X : X + 3]), np.ascontiguousarray(rows[:, RADIUS])
    box = periodic(np.array(parts.box.edges(state.scalar)))
    deepest = depth(touching_pairs(position, radius, box), position, radius, box).max(initial=0.0)
    if deepest > DEEP:
        warnings.warn(
            f"at the end monomers overlap by up to {deepest:.2g} of the smaller radius, for which no law of contact is "
            "meant; a perfectly straight or regular aggregate cannot give way: move its monomers a little",
            UserWarning,
            stacklevel=3,
        )


def compression_law(k_n=K_N):
    """The law of the paper: JKR with a constant damping, `k_n` in m_0/t_0."""
    return jkr(damping="constant", constant_damping=k_n)


def prepared(cluster, parts, settings):
    """State of a cluster in its box at the start, and the key of its checkpoints."""
    grain = cluster.grain
    pairs = touching_pairs(grain.position, grain.radius, parts.box)
    state = new_state(grain.position, grain.radius, grain.material, pairs, *parts)
    return state, checkpoints.fingerprint(__name__, [grain.position, grain.radius], grain.material, parts, settings)


def attributes(cluster):
    """What the file of a run says of the aggregate, dict."""
    material = cluster.grain.material
    return {
        **constants_of(material),
        "n_monomers": cluster.grain.n_monomers,
        "seed": -1 if cluster.grain.seed is None else cluster.grain.seed,
        "monomer_radius": cluster.radius,
        "time_unit": cluster.time_unit,
        "rolling_pressure": cluster.rolling_pressure,
    }


def check_rate(strain_rate):
    """The rate of a box as a float; an error for one that is none."""
    strain_rate = _positive("strain_rate", strain_rate)
    if strain_rate > FASTEST:
        raise InputError(f"strain_rate is {strain_rate:g}; it must be above 0 and at most {FASTEST:g}.")
    return strain_rate


def _positive(name, value):
    if not (is_number(value) and value > 0.0):
        raise InputError(f"{name} is {value!r}; it must be a number above 0.")
    return float(value)


def _box(cluster, strain_rate, until_phi, length, scheme):
    """The box at the start, the filling factor in it, and that at the end."""
    position, radius = cluster.grain.position, cluster.grain.radius
    extent = greatest_extent(position, radius)
    length = _positive("box_length", extent if length is None else length)
    if length < 2.0 * radius.max():
        raise InputError(f"box_length is {length:g} m; it must be at least {2.0 * radius.max():g} m, a monomer.")
    if length < (1.0 - 1e-12) * extent:
        raise InputError(
            f"box_length is {length:g} m; it must be at least {extent:g} m, the greatest extent of the cluster, "
            "so that its copies do not overlap."
        )
    first = cluster.volume / length**3
    if first < LOOSEST:
        most = (cluster.volume / LOOSEST) ** (1.0 / 3.0)
        raise InputError(
            f"box_length is {length:g} m; it must be at most {most:.3g} m, of which the cluster fills {LOOSEST:g}."
        )
    until_phi = _positive("until_phi", until_phi)
    if not first < until_phi <= DENSEST:
        raise InputError(
            f"until_phi is {until_phi:g}; it must be above {first:.3g}, the filling factor at the start, and at most "
            f"{DENSEST}, that of random close packing, beyond which spheres only deform."
        )
    return periodic(length, box_rate(strain_rate, cluster.time_unit), scheme=scheme), first, until_phi


def _filling_factors(snapshots):
    if np.ndim(snapshots) != 1 or not all(is_number(phi) and phi > 0.0 for phi in snapshots):
        raise InputError(f"snapshots is {snapshots!r}; it must be a sequence of numbers above 0.")
    return [float(phi) for phi in snapshots]


def _static_from(cluster, box, until_phi):
    """Filling factor from which on the compression is static; a warning where it is not for most of the way."""
    grain = cluster.grain
    about = grain.n_monomers, cluster.radius, grain.material.density, cluster.rolling_pressure
    static = static_from(box.rate_x, *about)
    if static > min(NOT_STATIC, until_phi):
        warnings.warn(
            f"the box shrinks so fast that inertia dominates: the compression is static from phi = {static:.2g} on; "
            "take a lower strain_rate",
            UserWarning,
            stacklevel=3,
        )
    return static


def balance_check(explicit, long, remedy):
    """A function of a record that raises RuntimeError where the balance of energy is off by too much.

    Parameters
    ----------
    explicit, long : dict of float to float
        Filling factor -> part of what moved that is allowed from there on, with explicit steps and with long ones.
    remedy : str
        What the user can do.

    Returns
    -------
    callable
        ``(row, before, long)``: the record, that from which on it counts, and whether its steps are long.
    """

    def check(row, before, in_long_steps):
        shares = long if in_long_steps else explicit
        allowed = [share for phi, share in shares.items() if row["phi"] >= phi]
        if not allowed:
            return
        lost = [name for name in row if name.startswith("dissipated_")]
        work, off, gone = (
            sum(row[name] - before[name] for name in names) for names in (["work"], ["energy_residual"], lost)
        )
        # Few monomers attract each other as much as the box presses: its work is near 0, what they dissipate is not.
        # At first nothing moves but single contacts, whose energy is that which the step can miss by a part.
        held = sum(abs(row[name]) for name in row if name.startswith("stored_"))
        moved = max(abs(work), gone, EVENTS * held / max(row["n_contacts"], 1.0))
        if not abs(off) <= allowed[-1] * moved:
            raise RuntimeError(
                f"at phi = {row['phi']:.3g} the balance of energy is off by {off:.3g} J; allowed are "
                f"{allowed[-1]:.1%} of the {moved:.3g} J that the box worked or friction took: {remedy}"
            )

    return check


def _add_snapshots(run, kept, wanted):
    """Positions at some filling factors."""
    at = np.array(wanted, dtype=int) - 1
    about = {"units": "1", "long_name": "filling factor of the snapshot"}
    run["snapshot_phi"] = ("snapshot", run["phi"].values[at], about)
    about = {"units": "m", "long_name": "edge of the box at the snapshot"}
    run["snapshot_box_length"] = ("snapshot", run["box_length"].values[at, 0], about)
    about = {"units": "m", "long_name": "centres at the snapshot, not wrapped into the box"}
    run["snapshot_position"] = (("snapshot", "monomer", "axis"), kept, about)
