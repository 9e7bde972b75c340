"""Spin-up of one grain until it is disrupted: relaxation at rest, then records at fixed omega, with checkpoints."""

import hashlib
import os
import time
import zipfile
from pathlib import Path

import numpy as np
import xarray as xr

from ratd.aggregates.grain import Grain
from ratd.base.errors import InputError
from ratd.base.jit import jit
from ratd.drives.rotating import AT_REST, OMEGA_RAT, SPIN_UP_LAWS, make_drive
from ratd.engine.advance import FEW_CONTACTS, FULL, NOT_FINITE, STEPS_DONE, advance, residual_force
from ratd.engine.contacts import update_contact_rates
from ratd.engine.fragments import find_fragments, note_lost
from ratd.engine.layout import (
    DT,
    DT_DRIFT,
    E_DAMP,
    E_ROLL,
    E_SLIDE,
    E_TWIST,
    FRAGMENTS_LOST,
    LANES,
    LARGEST_CONTACTS,
    LARGEST_MONOMERS,
    MASS,
    MONOMERS,
    OMEGA,
    PULL_OFF,
    STEPS,
    STRESS_SAMPLES,
    STRESS_SUM,
    TIME,
    TORQUE_WORK,
    X,
)  # fmt: skip
from ratd.engine.measure import (
    dissipated,
    extreme_normal_force,
    fragment_shape,
    largest_fragment,
    stored_energy,
    total_stress,
)
from ratd.engine.state import (
    State,
    come_to_rest,
    contact_blocks,
    contact_field,
    monomer_rows,
    new_state,
    place,
    with_room,
)
from ratd.experiments.spin_up.bound import cut_bound
from ratd.geometry.shape import principal_axes

__all__ = ["relax", "spin_up"]

DAMPINGS = ("implicit", "explicit")
RESIDUAL = 1e-3
"""A grain is relaxed when no net force exceeds this part of the least pull-off force in it."""
RELAXATION_STEPS = 50
"""Of a round of the relaxation, after which the kinetic energy is looked at."""
PATIENCE = 1000
"""Rounds after which they take a step more each: a contact that rings in time with the rounds is caught at its turning
points only, where there is no velocity to take from it."""
RELAXATION_LIMIT = 1_000_000
"""Steps after which a grain that is not yet relaxed is given up."""
EPSILON = {"BA": 0.02, "BAM1": 0.005, "BAM2": 0.005}
TIMESTEP_FACTOR = 0.125
"""What a spin-up takes when it is not told otherwise. Grains up to 300 nm are then within about 3 % of the limit of a
slow spin-up and a short step, larger BAM1 grains farther above it (docs/validation.md). A grain of no known type takes
the least epsilon."""
FIRST_LOSS = 0.7
"""Part of the cut bound from which on epsilon is constant. BA grains mostly lose their first monomers above it, BAM
grains often below, where the spin-up is faster than epsilon (docs/model.md, The scheme)."""
CHECKPOINT_INTERVAL = 60.0
PROGRESS_INTERVAL = 2.0
"""Wall time [s] between two checkpoints, and two calls of `progress`."""

# name -> units, meaning, type; in the order of the columns of the records
RECORDS = {
    "omega": ("rad s-1", "angular velocity", "f8"),
    "time": ("s", "time since the start of the spin-up", "f8"),
    "mass": ("kg", "mass of the largest fragment", "f8"),
    "n_monomers": ("1", "number of monomers of the largest fragment", "i4"),
    "n_contacts": ("1", "number of contacts of the largest fragment", "i4"),
    "total_stress": ("Pa", "sum of |F_N|/(pi r^2) over the contacts of the largest fragment, interval mean", "f8"),
    "axis_a": ("m", "shortest semi-axis of the ellipsoid with the same moments of inertia", "f8"),
    "axis_b": ("m", "middle semi-axis of the ellipsoid with the same moments of inertia", "f8"),
    "axis_c": ("m", "longest semi-axis of the ellipsoid with the same moments of inertia", "f8"),
    "porosity": ("1", "porosity P = 1 - a_eff^3/(a b c)", "f8"),
    "dissipated_sliding": ("J", "energy dissipated by sliding so far", "f8"),
    "dissipated_rolling": ("J", "energy dissipated by rolling so far", "f8"),
    "dissipated_twisting": ("J", "energy dissipated by twisting so far", "f8"),
    "dissipated_damping": ("J", "energy dissipated by viscoelastic damping so far", "f8"),
    "dissipated_contact": ("J", "energy dissipated by making and breaking contacts so far", "f8"),
    "torque_work": ("J", "work done by the outer torque so far", "f8"),
    "kinetic_energy": ("J", "kinetic energy of the largest fragment in the inertial frame", "f8"),
    "potential_energy": ("J", "potential energy of the contacts of the largest fragment", "f8"),
    "n_fragments_lost": ("1", "number of fragments lost so far", "i4"),
}  # fmt: skip
FRAGMENTS = {
    "fragment_mass": ("kg", "mass of a fragment that left"),
    "fragment_n_monomers": ("1", "number of monomers of a fragment that left"),
    "fragment_omega": ("rad s-1", "angular velocity at which a fragment left"),
    "fragment_time": ("s", "time at which a fragment left"),
}


def relax(grain, *, timestep_factor=TIMESTEP_FACTOR):
    """State of a grain that has come to rest: contacts of the growth carry the forces that their compression gives.

    Parameters
    ----------
    grain : ratd.Grain
    timestep_factor : float
        f of Eq. 31.

    Returns
    -------
    State
        Origin at the centre of mass, z along a_1, the axis of the greatest moment of inertia; no velocities, no
        dissipated energy, time 0. Net forces are below `RESIDUAL` times the least pull-off force.

    Raises
    ------
    RuntimeError
        If the grain does not come to rest.

    Notes
    -----
    Integrated at rest with damping; whenever the kinetic energy has fallen in a round (`round_of`), all velocities are
    set to zero, so that the slow swaying of long arms, which contacts hardly damp, does not go on for ever.
    """
    state = new_state(grain.position, grain.radius, grain.material, grain.contacts, timestep_factor=timestep_factor)
    goal = residual_goal(state)
    kinetic = 0.0
    while state.counter[STEPS] < RELAXATION_LIMIT:
        residual = residual_force(state)
        if residual <= goal:
            break
        until = state.counter[STEPS] + round_of(state.counter[STEPS])[0]
        state = _advance(state, AT_REST, np.inf, until, -1, timestep_factor, True)[0]
        before, kinetic = kinetic, stored_energy(state)[0]
        if kinetic <= before:
            come_to_rest(state)
            kinetic = 0.0
    else:
        raise RuntimeError(f"{not_at_rest(goal)}; it is {residual:.2e} N")
    settle(state, timestep_factor)
    return state


@jit
def round_of(steps):
    """The round of the relaxation in which a grain is.

    Parameters
    ----------
    steps : int
        Of the relaxation that are done.

    Returns
    -------
    length, done : int
        Steps of the round, and how many of them are done, 0 where the round before has just ended.
    """
    length = RELAXATION_STEPS
    while steps >= PATIENCE * length:
        steps -= PATIENCE * length
        length += 1
    return length, steps % length


def not_at_rest(goal):
    """What to say of a grain whose relaxation does not end."""
    return f"the grain does not come to rest: the net force is not to exceed {goal:.2e} N on any monomer"


def not_finite(state):
    """What to say of a run with a velocity that is no number."""
    return (
        f"the integration failed at step {state.counter[STEPS]}, omega = {state.scalar[OMEGA]:.3e} rad/s: "
        "a velocity is no finite number; try a smaller timestep_factor or a slower spin-up"
    )


def residual_goal(state):
    """Net force [N] on any monomer below which a grain counts as relaxed."""
    return RESIDUAL * contact_field(state, PULL_OFF).min()


def settle(state, timestep_factor):
    """Make a relaxed state the start of a run: at rest, centred, z along a_1, nothing dissipated, time 0."""
    come_to_rest(state)
    find_fragments(state)
    position, mass, radius = largest_fragment(state)
    _, axes = principal_axes(position, mass, radius)
    place(state, mass @ position / mass.sum(), axes[[1, 2, 0]])
    state.scalar[:] = 0.0
    state.counter[STEPS] = 0
    for field in (E_SLIDE, E_ROLL, E_TWIST, E_DAMP):
        contact_blocks(state)[:, int(field) // LANES, :] = 0.0
    update_contact_rates(state, timestep_factor, True)


def spin_up(
    grain,
    *,
    drive="prescribed",
    epsilon=None,
    angular_acceleration=None,
    coriolis=None,
    timestep_factor=TIMESTEP_FACTOR,
    damping="implicit",
    max_steps=None,
    records=300,
    snapshot_every=0,
    checkpoint=None,
    progress=None,
):
    """Spin a grain up until one contact is left.

    Parameters
    ----------
    grain : ratd.Grain
    drive : {"prescribed", "literal"}
        The consistent model with the outer torque, or the equations as printed (see `ratd.drives.rotating`).
    epsilon : float, optional
        Spin up with this constant (d omega/dt)/omega^2 above omega_1, `FIRST_LOSS` times the cut bound, and with an
        even rise of omega^2 below it. `EPSILON` of its type when neither this nor `angular_acceleration` is given.
    angular_acceleration : float, optional
        Spin up after Eq. 24 instead, with this initial d omega/dt [rad/s2].
    coriolis : {"exact", "explicit"}, optional
        Treatment of the Coriolis force; by default exact for `prescribed`, explicit for `literal`.
    timestep_factor : float
        f of dt = f min(t_dis, t_vel), Eq. 31.
    damping : {"implicit", "explicit"}
        Treatment of the viscoelastic damping. Explicit is stable for small f only.
    max_steps : int, optional
        End after so many steps.
    records : int
        Records of each octave of omega above the cut bound. They are evenly spaced in omega, by bound/(2 records) up to
        the bound; for each octave above the spacing doubles, so that a small remnant, which holds to hundreds of times
        the bound, costs few records.
    snapshot_every : int
        Keep positions, fragments and forces of all monomers at every so many records; 0 for never.
    checkpoint : path-like, optional
        Where to keep what is needed to go on after a kill. A file made with other input is ignored. Results are the
        same bits with and without interruption.
    progress : callable, optional
        Called every few seconds as ``progress(omega, mass_fraction, seconds_to_go, steps)``.

    Returns
    -------
    xarray.Dataset
        Dimensions ``record``, ``fragment`` (those that left, in their order, then those cut off but still near at the
        end), ``snapshot`` and ``monomer``; the
        attributes tell the settings, ``steps``, ``timestep`` [s], ``end_reason``, ``cut_bound`` [rad/s] and the
        state after relaxation (``initial_...``).

    Raises
    ------
    InputError
        If an argument is not usable.
    """
    run = Run(
        grain, drive, epsilon, angular_acceleration, coriolis, timestep_factor, damping, max_steps, records,
        snapshot_every,
    )  # fmt: skip
    if not run.load(checkpoint):
        run.begin(relax(grain, timestep_factor=timestep_factor))
    watch = Watch(run, progress)
    saved = time.monotonic()
    while run.reason is None:
        run.state, code = _advance(
            run.state, run.motion, run.edge(), run.steps_goal, run.fewest, run.timestep_factor, run.implicit
        )
        run.note(code)
        if run.reason is None and checkpoint is not None and time.monotonic() - saved > CHECKPOINT_INTERVAL:
            run.save(checkpoint)
            saved = time.monotonic()
        watch.look(run)
    return run.dataset()


class Run:
    """The spin-up of one grain: what was asked for, where it stands, what was recorded. An engine moves it on.

    Parameters
    ----------
    grain, drive, epsilon, angular_acceleration, coriolis, timestep_factor, damping, max_steps, records, snapshot_every
        As for `spin_up`.

    Attributes
    ----------
    motion : ratd.drives.rotating.Drive
    bound : float
        The cut bound [rad/s].
    implicit : bool
        Whether the damping is treated implicitly.
    steps_goal : int
        Number of steps after which the run ends.
    fewest : int
        The run ends when the largest fragment has no more contacts than this.
    state : ratd.engine.state.State
    rows : list of list of float
        The records (see `_record`).
    snapshots : list of array
        See `_snapshot`.
    reason : str or None
        Why the run has ended, None while it goes on.
    """

    def __init__(
        self, grain, drive="prescribed", epsilon=None, angular_acceleration=None, coriolis=None,
        timestep_factor=TIMESTEP_FACTOR, damping="implicit", max_steps=None, records=300, snapshot_every=0,
    ):  # fmt: skip
        _check(grain, timestep_factor, damping, max_steps, records, snapshot_every)
        if epsilon is None and angular_acceleration is None:
            epsilon = EPSILON.get(grain.type, min(EPSILON.values()))
        self.grain, self.drive, self.epsilon, self.damping = grain, drive, epsilon, damping
        self.timestep_factor, self.records, self.snapshot_every = timestep_factor, records, snapshot_every
        self.bound = cut_bound(grain)
        self.motion = make_drive(
            drive,
            omega_1=FIRST_LOSS * self.bound,
            epsilon=epsilon,
            angular_acceleration=angular_acceleration,
            coriolis=coriolis,
        )
        self.implicit = damping == "implicit"
        self.steps_goal = np.iinfo(np.int64).max if max_steps is None else int(max_steps)
        self.reason = None

    @property
    def key(self):
        """What a checkpoint must have been made with to be of use."""
        return _fingerprint(
            self.grain, self.motion, self.timestep_factor, self.implicit, self.records, self.snapshot_every
        )

    def begin(self, state):
        """Start from a relaxed state."""
        update_contact_rates(state, self.timestep_factor, self.implicit)
        state.scalar[DT_DRIFT] = state.scalar[DT]
        find_fragments(state)
        self._start(state, [_record(state, self.grain.material.density)], [])
        if self.snapshot_every:
            self.snapshots.append(_snapshot(state))

    def _start(self, state, rows, snapshots):
        self.state, self.rows, self.snapshots = state, rows, snapshots
        self.fewest = 1 if rows[0][4] > 1 else 0

    def edge(self, ahead=0):
        """Angular velocity [rad/s] of the next record, or of the one that comes `ahead` records after it."""
        return min(_edge(len(self.rows) + ahead, self.bound, self.records), OMEGA_RAT)

    def wants_snapshot(self, ahead=0):
        """Whether the next record, or the one that comes `ahead` records after it, has a snapshot."""
        return bool(self.snapshot_every) and (len(self.rows) + ahead) % self.snapshot_every == 0

    def note(self, code):
        """Record the state, for which `advance` gave a code, and see whether the run has ended."""
        snapshot = self.wants_snapshot()
        if code == FEW_CONTACTS:
            _let_go(self.state)
        self.rows.append(_record(self.state, self.grain.material.density))
        if snapshot or (self.snapshot_every and code == FEW_CONTACTS):
            self.snapshots.append(_snapshot(self.state))
        if code == FEW_CONTACTS:
            self.reason = "one contact left"
        elif code == STEPS_DONE:
            self.reason = "max_steps reached"
        elif self.rows[-1][0] >= OMEGA_RAT * (1.0 - 1e-9):
            self.reason = "omega_RAT reached"

    def save(self, path):
        """Keep the run in a file, from which `load` goes on."""
        _save(path, self.key, self.state, self.rows, self.snapshots)

    def load(self, path):
        """Go on from a file; False when there is none, or it is damaged or of another run."""
        loaded = _load(path, self.key)
        if loaded is not None:
            self._start(*loaded)
        return loaded is not None

    def dataset(self):
        """The finished run, see `spin_up`."""
        first, motion, grain = self.rows[0], self.motion, self.grain
        initial = dict(zip(RECORDS, first[:-1], strict=True))
        run = _dataset(self.state, self.rows, self.snapshots, grain)
        run.attrs = {
            "drive": self.drive,
            "spin_up_law": SPIN_UP_LAWS[motion.law],
            "epsilon": np.nan if self.epsilon is None else float(self.epsilon),
            "angular_acceleration": motion.acceleration or motion.epsilon * motion.omega_1**2,
            "coriolis": "explicit" if motion.explicit_coriolis else "exact",
            "damping": self.damping,
            "timestep_factor": float(self.timestep_factor),
            "steps": int(self.state.counter[STEPS]),
            "timestep": first[-1],
            "end_reason": self.reason,
            "material": grain.material.name,
            "type": grain.type or "",
            "a_eff": grain.effective_radius,
            "seed": -1 if grain.seed is None else int(grain.seed),
            "cut_bound": self.bound,
        } | {f"initial_{name}": initial[name] for name in ("mass", "axis_a", "axis_b", "axis_c", "porosity")}
        run.attrs |= {f"initial_{name}": int(initial[name]) for name in ("n_monomers", "n_contacts")}
        return run


def _check(grain, timestep_factor, damping, max_steps, records, snapshot_every):
    if not isinstance(grain, Grain):
        raise InputError(f"grain is a {type(grain).__name__}; it must be a ratd.Grain.")
    if not (np.isfinite(timestep_factor) and 0.0 < timestep_factor <= 1.0):
        raise InputError(f"timestep_factor is {timestep_factor!r}; it must be above 0 and at most 1.")
    if damping not in DAMPINGS:
        raise InputError(f"damping is {damping!r}; allowed are {', '.join(DAMPINGS)}.")
    if max_steps is not None and not max_steps >= 1:
        raise InputError(f"max_steps is {max_steps!r}; it must be at least 1, or None for no limit.")
    if not (records == int(records) and records >= 1):
        raise InputError(f"records is {records!r}; it must be a whole number of at least 1.")
    if not (snapshot_every == int(snapshot_every) and snapshot_every >= 0):
        raise InputError(f"snapshot_every is {snapshot_every!r}; it must be a whole number of at least 0.")


def _advance(state, *arguments):
    """`advance`, with more room for contacts when they need it."""
    while True:
        code = advance(state, *arguments)
        if code == NOT_FINITE:
            raise RuntimeError(not_finite(state))
        if code != FULL:
            return state, code
        state = with_room(state, 2 * len(state.pair_i))


def _let_go(state):
    """Note the fragments that are still near at the end as lost: the masses of all fragments add up to the grain's."""
    rows = monomer_rows(state)
    fragment = state.fragment[: len(rows)]
    for label in range(1, fragment.max() + 1):
        members = fragment == label
        note_lost(state, rows[members, MASS].sum(), members.sum())


def _edge(number, bound, records):
    """Angular velocity [rad/s] of a record: evenly spaced up to the bound by bound/(2 records), then in each octave."""
    octave = max(0, (number - records - 1) // records)
    return 2.0**octave * bound * (number - octave * records) / (2 * records)


def _record(state, density):
    """One row of the records, in the order of `RECORDS`, and the step at the end; starts a new recording interval."""
    scalar = state.scalar
    if scalar[STRESS_SAMPLES] > 0:
        stress = scalar[STRESS_SUM] / scalar[STRESS_SAMPLES]
    else:
        stress = total_stress(state)
    scalar[STRESS_SUM] = scalar[STRESS_SAMPLES] = 0.0
    mass, a, b, c, porosity = fragment_shape(state, density)
    counter = state.counter
    return [
        float(scalar[OMEGA]), float(scalar[TIME]), mass, float(counter[LARGEST_MONOMERS]),
        float(counter[LARGEST_CONTACTS]), stress, a, b, c, porosity, *dissipated(state).tolist(),
        float(scalar[TORQUE_WORK]), *stored_energy(state), float(counter[FRAGMENTS_LOST]), float(scalar[DT]),
    ]  # fmt: skip


def _snapshot(state):
    """omega and, for every monomer of the original grain: x, y, z, fragment (-1 if dropped), normal force."""
    n = len(state.identity)
    kept = state.identity[: state.counter[MONOMERS]]
    table = np.full((n, 5), np.nan)
    table[:, 3] = -1.0
    table[kept, :3] = monomer_rows(state)[:, X : X + 3]
    table[kept, 3] = state.fragment[: state.counter[MONOMERS]]
    table[kept, 4] = extreme_normal_force(state)
    return np.concatenate([[state.scalar[OMEGA]], table.ravel()])


def _dataset(state, rows, snapshots, grain):
    table = np.array(rows)
    variables = {
        name: ("record", table[:, column].astype(dtype), {"units": units, "long_name": meaning})
        for column, (name, (units, meaning, dtype)) in enumerate(RECORDS.items())
    }
    lost = state.lost[: state.counter[FRAGMENTS_LOST]]
    for column, (name, (units, meaning)) in enumerate(FRAGMENTS.items()):
        dtype = "i4" if name == "fragment_n_monomers" else "f8"
        variables[name] = ("fragment", lost[:, column].astype(dtype), {"units": units, "long_name": meaning})
    if snapshots:
        table = np.array(snapshots)
        frames = table[:, 1:].reshape(len(table), -1, 5)
        variables["snapshot_omega"] = ("snapshot", table[:, 0], {"units": "rad s-1", "long_name": "angular velocity"})
        for axis, name in enumerate("xyz"):
            about = {"units": "m", "long_name": f"position along {name} in the turning frame"}
            variables[f"snapshot_{name}"] = (("snapshot", "monomer"), frames[..., axis], about)
        about = {"units": "1", "long_name": "fragment: 0 the largest, 1, 2, ... others, -1 dropped"}
        variables["snapshot_fragment"] = (("snapshot", "monomer"), frames[..., 3].astype("i4"), about)
        about = {"units": "N", "long_name": "normal force of greatest magnitude on the monomer, > 0 pushing"}
        variables["snapshot_normal_force"] = (("snapshot", "monomer"), frames[..., 4], about)
        variables["monomer_radius"] = ("monomer", grain.radius.copy(), {"units": "m", "long_name": "radius"})
    return xr.Dataset(variables)


class Watch:
    """Tells how far a run is, every few seconds, with a guess of the time to go from the pace so far."""

    def __init__(self, run, progress):
        self.omega_1, self.mass, self.progress = run.motion.omega_1, run.rows[0][2], progress
        self.start = self.last = time.monotonic()
        self.begun = self._done(run.state.scalar[OMEGA])

    def _done(self, omega):
        """A number that grows evenly with the steps under the constant-epsilon law: 1 at omega_1, 3 at the end."""
        ratio = omega / self.omega_1
        return ratio**2 if ratio < 1.0 else 3.0 - 2.0 / ratio

    def look(self, run):
        """Tell, if it is time to."""
        row = run.rows[-1]
        now = time.monotonic()
        if self.progress is None or now - self.last < PROGRESS_INTERVAL:
            return
        self.last = now
        done = self._done(row[0])
        # Most of the mass gone: each further step costs little.
        to_go = (now - self.start) * max(0.0, 3.0 - done) / max(done - self.begun, 1e-9) * row[2] / self.mass
        self.progress(row[0], row[2] / self.mass, to_go, int(run.state.counter[STEPS]))


def _fingerprint(grain, *settings):
    """What a checkpoint must have been made with to be of use."""
    digest = hashlib.sha256()
    for array in (grain.position, grain.radius):
        digest.update(np.ascontiguousarray(array).tobytes())
    digest.update(repr((grain.material, *settings)).encode())
    return digest.hexdigest()


def _save(path, key, state, rows, snapshots):
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f"{path.name}.{os.getpid()}.tmp")
    with open(temporary, "wb") as file:
        np.savez(file, key=key, rows=np.array(rows), snapshots=np.array(snapshots), **state._asdict())
        file.flush()
        os.fsync(file.fileno())
    os.replace(temporary, path)


def _load(path, key):
    """State, records and snapshots of a checkpoint; None when there is none, or it is damaged or of another run."""
    if path is None or not Path(path).exists():
        return None
    try:
        with np.load(path, allow_pickle=False) as file:
            if str(file["key"]) != key:
                return None
            state = State(**{name: file[name] for name in State._fields})
            return state, file["rows"].tolist(), list(file["snapshots"])
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
        return None
