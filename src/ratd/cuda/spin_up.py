"""Relaxation and spin-up of many grains on a GPU; for one grain on a processor see `ratd.spinup`."""

import time

import numpy as np

from ratd.cuda.advance import PAUSED, RESTED, advance_grains
from ratd.cuda.arena import (
    CODE, FEWEST, GOALS, KINETIC, RELAXING, RESIDUAL, ROW_COLUMNS, ROWS, SEGMENT_END, STEPS_GOAL, Batch, write_drive,
)  # fmt: skip
from ratd.cuda.device import MAX_THREADS, MIN_THREADS, SIMULATED, cuda, failure_in_words, require, upload
from ratd.drives import AT_REST, OMEGA_RAT
from ratd.engine.advance import FULL, NOT_FINITE
from ratd.engine.layout import STEPS
from ratd.engine.state import new_state, with_room
from ratd.shape import _diagonalise, porosity, semi_axes
from ratd.spinup import (
    RECORDS,
    RELAXATION_LIMIT,
    RELAXATION_STEPS,
    Run,
    Watch,
    not_at_rest,
    not_finite,
    residual_goal,
    settle,
)

__all__ = ["spin_up_many"]

CHECKPOINT_INTERVAL = 120.0
"""Wall time [s] between two checkpoints."""
MOST_SAVING = 20.0
"""They are made no more often than after so many times what they take."""
SEGMENT = 2**27
"""Length of a segment in contacts times steps; the host looks, and a run can be stopped, only in between."""
STEP_OVERHEAD = 1500
"""What a step costs beside its contacts, in contacts: barriers, and what all threads do alike."""
ROWS_PER_LAUNCH = 64
"""Records that a grain may make between two looks of the host."""
CONTACTS_PER_THREAD = 4


def threads_for(contacts):
    """Threads of the block of a grain with so many contacts at the start."""
    threads = MIN_THREADS
    while threads * CONTACTS_PER_THREAD < contacts and threads < MAX_THREADS:
        threads *= 2
    return threads


def segment_for(contacts):
    """Steps of a segment of a grain with so many contacts at the start, a multiple of `RELAXATION_STEPS`."""
    return max(1, SEGMENT // ((contacts + STEP_OVERHEAD) * RELAXATION_STEPS)) * RELAXATION_STEPS


def record_of(row, density):
    """One row of the records of `ratd.spinup`, and the step at the end, from one of the device (`ROW_COLUMNS`)."""
    of = dict(zip(ROW_COLUMNS, row.tolist(), strict=True))
    tensor = np.array([[of[a] for a in line] for line in (("xx", "xy", "zx"), ("xy", "yy", "yz"), ("zx", "yz", "zz"))])
    a_eff = (of["mass"] / (4.0 / 3.0 * np.pi * density)) ** (1.0 / 3.0)
    of["axis_a"], of["axis_b"], of["axis_c"] = semi_axes(_diagonalise(tensor)[0], density, a_eff)
    of["porosity"] = porosity(of["axis_a"], of["axis_b"], of["axis_c"], a_eff)
    return [float(of[name]) for name in (*RECORDS, "dt")]


class Spinning:
    """A grain on its way: first it relaxes, then its run goes on.

    Parameters
    ----------
    number : int
        Place of the grain in what the user gave.
    run : ratd.spinup.Run
    checkpoint : path-like or None
    progress : callable or None

    Attributes
    ----------
    relaxing : bool
    failure : str or None
        Why it cannot go on.
    """

    def __init__(self, number, run, checkpoint, progress):
        self.number, self.run, self.checkpoint, self.progress = number, run, checkpoint, progress
        self.contacts = len(run.grain.contacts)
        self.threads = threads_for(self.contacts)
        self.segment = segment_for(self.contacts)
        self.failure = self.watch = self.residual = None
        self.kinetic = 0.0  # after the last round of the relaxation, [J]: a new batch does not know it
        self.relaxing = not run.load(checkpoint)
        if self.relaxing:
            grain = run.grain
            run.state = new_state(
                grain.position, grain.radius, grain.material, grain.contacts, timestep_factor=run.timestep_factor
            )
            self.residual = residual_goal(run.state)

    @property
    def over(self):
        """Whether the grain is finished or has failed."""
        return self.failure is not None or (not self.relaxing and self.run.reason is not None)

    def tell(self, batch, place):
        """Write down what the grain is to do in the next launch."""
        task, drive, run = batch.host.task[place], batch.host.drive[place], self.run
        write_drive(drive, AT_REST if self.relaxing else run.motion)
        task[RELAXING] = self.relaxing
        task[SEGMENT_END] = (run.state.counter[STEPS] // self.segment + 1) * self.segment
        if self.relaxing:
            drive[RESIDUAL], drive[KINETIC] = self.residual, self.kinetic
            task[STEPS_GOAL], task[FEWEST], task[GOALS] = RELAXATION_LIMIT, -1, 0
            return
        task[STEPS_GOAL], task[FEWEST] = run.steps_goal, run.fewest
        # The last of these records is made by the host, which alone takes snapshots and ends runs.
        count = 0
        for goal in range(ROWS_PER_LAUNCH):
            batch.host.goal[place, goal] = run.edge(goal)
            count += 1
            if run.wants_snapshot(goal) or run.edge(goal) >= OMEGA_RAT:
                break
        task[GOALS] = count

    def take(self, batch, place):
        """Take up what a launch has left.

        Returns
        -------
        bool
            Whether the grain needs more room before the next launch.
        """
        run, task = self.run, batch.host.task[place]
        self.kinetic = float(batch.host.drive[place, KINETIC])
        for row in batch.host.row[place, : task[ROWS]]:
            run.rows.append(record_of(row, run.grain.material.density))
        code = task[CODE]
        if code == PAUSED:
            pass
        elif code == NOT_FINITE:
            self.failure = not_finite(run.state)
        elif code == FULL:
            return True
        elif code == RESTED:
            run.state = batch.state(place)
            settle(run.state, run.timestep_factor)
            run.begin(run.state)
            self.relaxing = False
            batch.set_state(place)
        elif self.relaxing:
            self.failure = not_at_rest(self.residual)
        else:
            run.state = batch.state(place)
            run.note(code)
            batch.set_state(place)
        if not self.relaxing:
            if self.watch is None:
                self.watch = Watch(run, self.progress)
            self.watch.look(run)
        return False


def spin_up_many(
    grains, *, checkpoints=None, progress=None, done=None, failed=None, snapshots=(), snapshot_every=0, **settings
):
    """Spin many grains up at once on a GPU, each until one contact is left.

    Parameters
    ----------
    grains : sequence of ratd.Grain
    checkpoints : sequence of path-like, optional
        Where to keep what is needed to go on after a kill, one for each grain.
    progress : sequence of callable, optional
        One for each grain, see `ratd.spinup.spin_up`.
    done : callable, optional
        Called as ``done(number, run)`` as soon as the run of a grain is finished.
    failed : callable, optional
        Called as ``failed(number, reason)`` as soon as a grain fails.
    snapshots : collection of int
        Numbers of the grains that get snapshots.
    snapshot_every : int
        Records between two of them, see `ratd.spinup.spin_up`.
    **settings
        ``drive``, ``epsilon``, ``angular_acceleration``, ``coriolis``, ``timestep_factor``, ``damping``,
        ``max_steps``, ``records`` of `ratd.spinup.spin_up`.

    Returns
    -------
    list of xarray.Dataset
        The runs in the order of the grains, each as `ratd.spinup.spin_up` gives it. A grain gives the same bits on one
        kind of device, with and without interruption and in whatever company. None for one that failed.

    Raises
    ------
    InputError
        If there is no GPU, it fails, or an argument is not usable.
    RuntimeError
        If a grain fails and `failed` is not given; the others are finished before.
    """
    require()
    grains = list(grains)
    runs = [
        Run(grain, snapshot_every=snapshot_every if number in snapshots else 0, **settings)
        for number, grain in enumerate(grains)
    ]
    at_work = [
        Spinning(number, run, checkpoints and checkpoints[number], progress and progress[number])
        for number, run in enumerate(runs)
    ]
    # Largest first, so that those that are still at work at the end are small.
    at_work.sort(key=lambda one: -one.contacts)
    finished = [None] * len(runs)
    failures = []

    def note(one):
        if one.failure is not None and failed is not None:
            failed(one.number, one.failure)
        elif one.failure is not None:
            failures.append(f"grain {one.number}: {one.failure}")
        else:
            finished[one.number] = one.run.dataset()
            one.run.state = None  # with which all arrays of its batch would be kept
            if done is not None:
                done(one.number, finished[one.number])

    saving = Saving()
    with failure_in_words():
        while at_work:
            _work(at_work, note, saving)
            at_work = [one for one in at_work if not one.over]
    if failures:
        raise RuntimeError("; ".join(failures))
    return finished


class Saving:
    """When checkpoints are due: every `CHECKPOINT_INTERVAL`, or less often where they take long; the device waits."""

    def __init__(self):
        self.last, self.interval = time.monotonic(), CHECKPOINT_INTERVAL

    @property
    def due(self):
        """Whether it is time."""
        return time.monotonic() - self.last > self.interval

    def done(self, begun):
        """Checkpoints were made since `begun`."""
        self.last = time.monotonic()
        self.interval = max(CHECKPOINT_INTERVAL, MOST_SAVING * (self.last - begun))


def _work(at_work, note, saving):
    """Run grains on the device until all are over, one needs more room, or most of the memory is that of finished ones.

    Parameters
    ----------
    at_work : list of Spinning
        Largest first.
    note : callable
        Told of each grain that is over.
    saving : Saving
    """
    batch = Batch([one.run.state for one in at_work], ROWS_PER_LAUNCH)
    for place, one in enumerate(at_work):
        one.run.state = batch.view(place)
    active = list(range(len(at_work)))
    while active and 2 * len(active) >= len(at_work):
        for place in active:
            at_work[place].tell(batch, place)
        batch.send_tasks()
        _launch(batch, at_work, active)
        batch.fetch_tasks()
        full = [place for place in active if at_work[place].take(batch, place)]
        for place in active:
            if at_work[place].over:
                note(at_work[place])
        active = [place for place in active if not at_work[place].over]
        if saving.due:
            begun = time.monotonic()
            for place in active:
                one = at_work[place]
                if one.checkpoint is not None and not one.relaxing and place not in full:
                    one.run.state = batch.state(place)
                    one.run.save(one.checkpoint)
            saving.done(begun)
        if full:
            break
    for place in active:
        one = at_work[place]
        one.run.state = batch.state(place)
        if place in full:
            one.run.state = with_room(one.run.state, 2 * len(one.run.state.pair_i))


def _launch(batch, at_work, active):
    """Run one segment of each active grain: one launch for each number of threads, all at the same time."""
    run = at_work[active[0]].run
    groups = {}
    for place in active:
        groups.setdefault(at_work[place].threads, []).append(place)
    # A copy waits for all kernels that were launched before it, hence all copies first.
    groups = [(threads, upload(np.array(groups[threads]))) for threads in sorted(groups, reverse=True)]
    streams = [0 if SIMULATED else cuda.stream() for _ in groups]  # kept until the kernels are done
    for (threads, numbers), stream in zip(groups, streams, strict=True):
        advance_grains[numbers.size, threads, stream](batch.device, numbers, run.timestep_factor, run.implicit)
    cuda.synchronize()
