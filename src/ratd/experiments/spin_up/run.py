"""Spin-up of one grain until it is disrupted: relaxation at rest, then records at fixed omega, with checkpoints."""

import numpy as np

from ratd.aggregates.grain import Grain
from ratd.base.checks import whole_number
from ratd.base.errors import InputError
from ratd.drives.largest import OMEGA, TORQUE_WORK
from ratd.drives.rotating import OMEGA_RAT
from ratd.engine import checkpoint as checkpoints
from ratd.engine.contacts import update_contact_rates
from ratd.engine.layout import DT, STEPS
from ratd.engine.semi_implicit import SemiImplicit
from ratd.engine.state import copied
from ratd.engine.step import CALL, FEW_CONTACTS, STEPS_DONE, until
from ratd.engine.step import run as go_on
from ratd.experiments import intervals
from ratd.experiments.made_with import made_with
from ratd.experiments.relax import relax
from ratd.experiments.spin_up.cut_bound import cut_bound
from ratd.experiments.spin_up.how import DRAG, PACE, TIMESTEP_FACTOR, UNREST, how_to_turn
from ratd.experiments.spin_up.records import (
    RECORDS,
    Watch,
    dataset,
    edge_of_record,
    let_go,
    next_record,
    record,
    snapshot,
    sum_of_energies,
)
from ratd.experiments.unfinished import attached
from ratd.geometry.box import open_space
from ratd.laws.chosen import check_stiffness, law_of
from ratd.laws.jkr_with_springs import jkr

__all__ = ["spin_up"]

BALANCE = 0.05
"""What the balance of energy may lack more after a part of a run, over the work so far, or over the rotation of a solid
sphere at the cut bound where that is more. A piece that swings back may land in a long step with an overlap that no
force has worked for, which gives the grain a push out of nothing."""
SMALLER = 0.25
"""A part of a run that fails is made again with steps so much smaller, `TRIES` times at most."""
TRIES = 3


def spin_up(
    grain,
    *,
    drive="prescribed",
    stretch=None,
    pace=PACE,
    unrest=UNREST,
    drag=DRAG,
    epsilon=None,
    angular_acceleration=None,
    coriolis=None,
    timestep_factor=TIMESTEP_FACTOR,
    damping="implicit",
    integrator=None,
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
    drive : {"prescribed", "torque", "literal"}
        What rises: omega, or the angular momentum, from which omega follows (`ratd.drives.quasi_static`); or the
        equations as printed (`ratd.drives.rotating`).
    stretch : float, optional
        The spin-up slows down as a contact is stretched or pressed in a semi-implicit step, and waits at so much [m].
        The smaller, the nearer to the limit of hours; `STRETCH` of `ratd.experiments.spin_up.how` when not given.
    pace, unrest, drag : float
        (d omega/dt)/omega^2 of a grain at rest; q_0, the part of its rotation that the motion of the grain exceeds
        while the spin-up waits; decay of motion in the turning frame over omega.
    epsilon : float, optional
        Do not wait: spin up with this constant (d omega/dt)/omega^2 above omega_1, `FIRST_LOSS` times the cut bound,
        and with an even rise of omega^2 below it. For `literal` that of its type when nothing is given.
    angular_acceleration : float, optional
        Do not wait: spin up after Eq. 24, with this initial d omega/dt [rad/s2].
    coriolis : {"exact", "explicit"}, optional
        Treatment of the Coriolis force where the spin-up does not wait; by default exact for `prescribed`, explicit for
        `literal`. One that waits adds it as it is.
    timestep_factor : float
        f of dt = f min(t_dis, t_vel), Eq. 31, of the relaxation and of spin-ups that do not wait.
    damping : {"implicit", "explicit"}
        Treatment of the viscoelastic damping in the latter; in the relaxation it is implicit. Explicit is stable for
        small f only.
    integrator : part, optional
        `ratd.engine.semi_implicit.semi_implicit` with `STEP` for spin-ups that wait, leapfrog for the others.
    law : str or part, optional
        Contact law, `ratd.laws.jkr` with its defaults when not given. A spin-up that waits needs one that tells its
        stiffness; "dmt" takes an epsilon.
    max_steps : int, optional
        End after so many steps.
    records : int
        Records of each octave of omega above the cut bound. They are evenly spaced in omega, by bound/(2 records) up to
        the bound; for each octave above the spacing doubles, so that a small remnant, which holds to hundreds of times
        the bound, costs few records. A step makes one record at most: more than some 1000 make no more.
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
        Dimensions ``record``, ``fragment`` (those that left, in their order, then those cut off but still near when one
        contact is left), ``snapshot`` and ``monomer``; the attributes tell the settings, law and material, ``steps``,
        ``timestep`` [s], ``end_reason``, ``cut_bound`` [rad/s] and the state after relaxation (``initial_...``).

    Raises
    ------
    InputError
        If an argument is not usable.
    RuntimeError
        If the integration fails, or leaves the balance of energy; its attribute ``run`` holds the Dataset up to there.
        Without it if the grain does not come to rest before.
    """
    _check(grain, max_steps)
    records, snapshot_every = whole_number(records, "records", 1), whole_number(snapshot_every, "snapshot_every", 0)
    bound = cut_bound(grain)
    how = how_to_turn(
        grain.type, bound, drive=drive, stretch=stretch, pace=pace, unrest=unrest, drag=drag,
        epsilon=epsilon, angular_acceleration=angular_acceleration, coriolis=coriolis,
        timestep_factor=timestep_factor, damping=damping, integrator=integrator,
    )  # fmt: skip
    run = Run(grain, how, bound, law, max_steps, records, snapshot_every)
    if not run.load(checkpoint):
        run.begin(relax(grain, law=run.law, timestep_factor=timestep_factor))
    watch = Watch(run, progress)
    to_save = intervals.Interval(intervals.CHECKPOINT)
    with attached("run", lambda error: run.dataset()):
        while run.reason is None:
            run.advance()
            if run.reason is None and checkpoint is not None and to_save.passed():
                run.save(checkpoint)
            watch.look(run)
    return run.dataset()


class Run:
    """The spin-up of one grain: what was asked for, where it stands, what was recorded. An engine moves it on.

    Parameters
    ----------
    grain : ratd.Grain
    how : ratd.experiments.spin_up.how.How
    bound : float
        The cut bound [rad/s].
    law, max_steps, records, snapshot_every
        As for `spin_up`.

    Attributes
    ----------
    steps_goal : int
        Number of steps after which the run ends.
    state : ratd.engine.state.State
    rows : list of list of float
        The records (see `record`).
    snapshots : list of array
        See `snapshot`.
    smaller_steps : int
        How often a part of the run had to be made again with smaller steps.
    reason : str or None
        Why the run has ended, None while it goes on.
    """

    def __init__(self, grain, how, bound, law=None, max_steps=None, records=300, snapshot_every=0):
        self.grain, self.how, self.bound = grain, how, bound
        self.law = law_of(law, jkr)
        self.motion, self.integrator = how.motion, how.integrator
        if isinstance(self.integrator, SemiImplicit):
            check_stiffness(self.law, "give epsilon for a spin-up that does not wait, in explicit steps")
        self.records, self.snapshot_every = records, snapshot_every
        self.smaller_steps = 0
        self.steps_goal = np.iinfo(np.int64).max if max_steps is None else int(max_steps)
        self.reason = None

    @property
    def key(self):
        """What a checkpoint must have been made with to be of use."""
        grain = self.grain
        settings = (grain.material, self.law, self.motion, self.integrator, self.records, self.snapshot_every)
        # how the grain came to rest goes with it too
        settings += (self.how.attributes["timestep_factor"],)
        return checkpoints.fingerprint(__name__, [grain.position, grain.radius], *settings)

    def begin(self, state):
        """Start from a relaxed state."""
        self.state = state
        self._choose_step(self.integrator)
        self._start(state, [record(state, self.law, self.grain.material.density)], [])
        if self.snapshot_every:
            self.snapshots.append(snapshot(state, self.law))

    def advance(self):
        """Go on to the next record, for `CALL` steps at most; what fails is made again with smaller steps."""
        before = copied(self.state)
        energy = sum_of_energies(before, self.law)
        integrator, tries = self.integrator, 0
        pause = min(self.steps_goal, self.state.counter[STEPS] + CALL)
        while True:
            goal = until(steps=pause, clock=self.edge, fewest_contacts=self.fewest)
            try:
                self.state, code = go_on(self.state, self.law, self.motion, open_space(), integrator, goal)
                self._check_balance(energy)
                break
            except RuntimeError:
                if tries == TRIES:
                    raise
            tries += 1
            integrator = integrator.with_smaller_steps(SMALLER)
            self.state = copied(before)
            self.smaller_steps += 1
            self._choose_step(integrator)
        if integrator != self.integrator:
            self._choose_step(self.integrator)
        if code != STEPS_DONE or pause == self.steps_goal:
            self.note(code)

    def _start(self, state, rows, snapshots):
        self.state, self.rows, self.snapshots = state, rows, snapshots

    def _choose_step(self, integrator):
        """Let an integrator choose the next step as if it were the first."""
        self.state.scalar[DT] = 0.0
        update_contact_rates(self.state, self.law, integrator)

    @property
    def fewest(self):
        """The run ends when the largest fragment has no more contacts than this."""
        return 1 if self.rows[0][4] > 1 else 0

    @property
    def has_torque(self):
        """Whether an outer torque turns the grain; without one there is no balance of energy."""
        return self.how.attributes["drive"] != "literal"

    @property
    def edge(self):
        """Angular velocity [rad/s] of the next record: what a step has passed over has none."""
        number = next_record(len(self.rows), self.rows[-1][0], self.bound, self.records)
        return min(edge_of_record(number, self.bound, self.records), OMEGA_RAT)

    @property
    def wants_snapshot(self):
        """Whether the next record has a snapshot."""
        return bool(self.snapshot_every) and len(self.rows) % self.snapshot_every == 0

    def note(self, code):
        """Record the state, for which the time loop gave a code, and see whether the run has ended."""
        wanted = self.wants_snapshot
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

    def _check_balance(self, before):
        if not self.has_torque:
            return
        solid = 0.2 * self.grain.mass.sum() * (self.grain.effective_radius * self.bound) ** 2
        scale = max(self.state.drive[TORQUE_WORK], solid)
        gap = sum_of_energies(self.state, self.law) - before
        if not abs(gap) <= BALANCE * scale:
            raise RuntimeError(
                f"at omega = {self.state.drive[OMEGA]:.4g} rad/s the balance of energy is off by {gap:.3g} J, "
                f"{abs(gap) / scale:.0%} of the work; at most {BALANCE:.0%} is allowed: take a smaller step"
            )

    def save(self, path):
        """Keep the run in a file, from which `load` goes on."""
        tables = {"rows": self.rows, "snapshots": self.snapshots, "smaller_steps": [self.smaller_steps]}
        checkpoints.save(path, self.key, self.state, **tables)

    def load(self, path):
        """Go on from a file; False when there is none, or it is damaged or of another run."""
        loaded = None if path is None else checkpoints.load(path, self.key)
        if loaded is not None:
            state, tables = loaded
            self._start(state, tables["rows"].tolist(), list(tables["snapshots"]))
            self.smaller_steps = int(tables["smaller_steps"][0])
        return loaded is not None

    def dataset(self):
        """The finished run, see `spin_up`."""
        first, grain = self.rows[0], self.grain
        initial = dict(zip(RECORDS, first[:-1], strict=True))
        run = dataset(self.state, self.rows, self.snapshots, grain)
        if not self.has_torque:
            run["energy_residual"][:] = np.nan
        run.attrs = (
            self.how.attributes
            | made_with(self.law, [grain.material])
            | {
                "steps": int(self.state.counter[STEPS]),
                "timestep": first[-1],
                "smaller_steps": self.smaller_steps,
                "end_reason": self.reason or "failed",
                "type": grain.type or "",
                "a_eff": grain.effective_radius,
                "seed": -1 if grain.seed is None else int(grain.seed),
                "cut_bound": self.bound,
            }
            | {f"initial_{name}": initial[name] for name in ("mass", "axis_a", "axis_b", "axis_c", "porosity")}
        )
        run.attrs |= {f"initial_{name}": int(initial[name]) for name in ("n_monomers", "n_contacts")}
        return run


def _check(grain, max_steps):
    if not isinstance(grain, Grain):
        raise InputError(f"grain is a {type(grain).__name__}; it must be a ratd.Grain.")
    if max_steps is not None:
        whole_number(max_steps, "max_steps", 1)
