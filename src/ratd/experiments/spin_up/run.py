"""Spin-up of one grain until it is disrupted: relaxation at rest, then records at fixed omega, with checkpoints."""

import time

import numpy as np

from ratd.aggregates.grain import Grain
from ratd.base.errors import InputError
from ratd.drives.rotating import OMEGA_RAT, SPIN_UP_LAWS, rotating
from ratd.engine import checkpoint as checkpoints
from ratd.engine.contacts import update_contact_rates
from ratd.engine.layout import STEPS
from ratd.engine.leapfrog import leapfrog
from ratd.engine.step import FEW_CONTACTS, STEPS_DONE, until
from ratd.engine.step import run as go_on
from ratd.experiments.relax import relax
from ratd.experiments.spin_up.cut_bound import cut_bound
from ratd.experiments.spin_up.records import RECORDS, Watch, dataset, edge_of_record, let_go, record, snapshot
from ratd.geometry.box import open_space
from ratd.laws.jkr_with_springs import jkr

__all__ = ["spin_up"]

EPSILON = {"BA": 0.02, "BAM1": 0.005, "BAM2": 0.005}
TIMESTEP_FACTOR = 0.125
"""What a spin-up takes when it is not told otherwise. Grains up to 300 nm are then within about 3 % of the limit of a
slow spin-up and a short step, larger BAM1 grains farther above it (docs/validation.md). A grain of no known type takes
the least epsilon."""
FIRST_LOSS = 0.7
"""Part of the cut bound from which on epsilon is constant. BA grains mostly lose their first monomers above it, BAM
grains often below, where the spin-up is faster than epsilon (docs/model/drives.md, The law omega(t))."""
CHECKPOINT_INTERVAL = 60.0
"""Wall time [s] between two checkpoints."""


def spin_up(
    grain,
    *,
    drive="prescribed",
    epsilon=None,
    angular_acceleration=None,
    coriolis=None,
    timestep_factor=TIMESTEP_FACTOR,
    damping="implicit",
    law=None,
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
    law : part, optional
        Contact law, `ratd.laws.jkr` with its defaults when not given.
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
        grain, drive, epsilon, angular_acceleration, coriolis, timestep_factor, damping, law, max_steps, records,
        snapshot_every,
    )  # fmt: skip
    if not run.load(checkpoint):
        run.begin(relax(grain, law=run.law, timestep_factor=timestep_factor))
    watch = Watch(run, progress)
    saved = time.monotonic()
    while run.reason is None:
        run.advance()
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
        timestep_factor=TIMESTEP_FACTOR, damping="implicit", law=None, max_steps=None, records=300, snapshot_every=0,
    ):  # fmt: skip
        _check(grain, max_steps, records, snapshot_every)
        self.law = jkr() if law is None else law
        self.integrator = leapfrog(timestep_factor=timestep_factor, damping=damping)
        if epsilon is None and angular_acceleration is None:
            epsilon = EPSILON.get(grain.type, min(EPSILON.values()))
        self.grain, self.drive, self.epsilon, self.damping = grain, drive, epsilon, damping
        self.timestep_factor, self.records, self.snapshot_every = timestep_factor, records, snapshot_every
        self.bound = cut_bound(grain)
        self.motion = rotating(
            drive,
            omega_1=FIRST_LOSS * self.bound,
            epsilon=epsilon,
            angular_acceleration=angular_acceleration,
            coriolis=coriolis,
        )
        self.steps_goal = np.iinfo(np.int64).max if max_steps is None else int(max_steps)
        self.reason = None

    @property
    def key(self):
        """What a checkpoint must have been made with to be of use."""
        grain = self.grain
        settings = (grain.material, self.law, self.motion, self.integrator, self.records, self.snapshot_every)
        return checkpoints.fingerprint([grain.position, grain.radius], *settings)

    def begin(self, state):
        """Start from a relaxed state."""
        update_contact_rates(state, self.law, self.integrator)
        self._start(state, [record(state, self.law, self.grain.material.density)], [])
        if self.snapshot_every:
            self.snapshots.append(snapshot(state, self.law))

    def advance(self):
        """Go on to the next record."""
        goal = until(steps=self.steps_goal, clock=self.edge(), fewest_contacts=self.fewest)
        self.state, code = go_on(self.state, self.law, self.motion, open_space(), self.integrator, goal)
        self.note(code)

    def _start(self, state, rows, snapshots):
        self.state, self.rows, self.snapshots = state, rows, snapshots
        self.fewest = 1 if rows[0][4] > 1 else 0

    def edge(self, ahead=0):
        """Angular velocity [rad/s] of the next record, or of the one that comes `ahead` records after it."""
        return min(edge_of_record(len(self.rows) + ahead, self.bound, self.records), OMEGA_RAT)

    def wants_snapshot(self, ahead=0):
        """Whether the next record, or the one that comes `ahead` records after it, has a snapshot."""
        return bool(self.snapshot_every) and (len(self.rows) + ahead) % self.snapshot_every == 0

    def note(self, code):
        """Record the state, for which the time loop gave a code, and see whether the run has ended."""
        wanted = self.wants_snapshot()
        if code == FEW_CONTACTS:
            let_go(self.state)
        self.rows.append(record(self.state, self.law, self.grain.material.density))
        if wanted or (self.snapshot_every and code == FEW_CONTACTS):
            self.snapshots.append(snapshot(self.state, self.law))
        if code == FEW_CONTACTS:
            self.reason = "one contact left"
        elif code == STEPS_DONE:
            self.reason = "max_steps reached"
        elif self.rows[-1][0] >= OMEGA_RAT * (1.0 - 1e-9):
            self.reason = "omega_RAT reached"

    def save(self, path):
        """Keep the run in a file, from which `load` goes on."""
        checkpoints.save(path, self.key, self.state, rows=self.rows, snapshots=self.snapshots)

    def load(self, path):
        """Go on from a file; False when there is none, or it is damaged or of another run."""
        loaded = checkpoints.load(path, self.key)
        if loaded is not None:
            state, tables = loaded
            self._start(state, tables["rows"].tolist(), list(tables["snapshots"]))
        return loaded is not None

    def dataset(self):
        """The finished run, see `spin_up`."""
        first, motion, grain = self.rows[0], self.motion, self.grain
        initial = dict(zip(RECORDS, first[:-1], strict=True))
        run = dataset(self.state, self.rows, self.snapshots, grain)
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


def _check(grain, max_steps, records, snapshot_every):
    if not isinstance(grain, Grain):
        raise InputError(f"grain is a {type(grain).__name__}; it must be a ratd.Grain.")
    if max_steps is not None and not max_steps >= 1:
        raise InputError(f"max_steps is {max_steps!r}; it must be at least 1, or None for no limit.")
    if not (records == int(records) and records >= 1):
        raise InputError(f"records is {records!r}; it must be a whole number of at least 1.")
    if not (snapshot_every == int(snapshot_every) and snapshot_every >= 0):
        raise InputError(f"snapshot_every is {snapshot_every!r}; it must be a whole number of at least 0.")
