"""The arrays of all grains on the device; from `State` and back.

Each array holds one grain after the other; `at` says where each begins. The host keeps arrays of the same layout: the
`State` of a grain is made of views into them, so that the functions of the CPU engine work on it.
"""

from typing import NamedTuple

import numpy as np

from ratd.cuda.device import fetch, send, upload
from ratd.engine.layout import BLOCK, FORCE_ROW, LANES, ROW
from ratd.engine.state import State

RESULTS = 9
"""Numbers that a contact leaves for its monomers: force on i, torque on i, torque on j."""
FAR_PER_SLOT = 4
"""Room for pairs that may come into contact, per slot of a contact."""

# --- where a grain begins in each kind of array ----------------------------------------------------------------------
MONOMER_AT, NUMBER_AT, BLOCK_AT, N_AT = range(4)
"""In rows of 16 (two more than monomers, as in State), in monomers, in blocks of contacts."""

# --- what a grain is to do, and what it says -------------------------------------------------------------------------
TASK = "relaxing steps_goal segment_end fewest goals code rows".split()
RELAXING, STEPS_GOAL, SEGMENT_END, FEWEST, GOALS, CODE, ROWS = range(len(TASK))
"""`segment_end`: number of steps at which to return. `goals`: records that may be made. `code`: why it returned.
`rows`: records that were made."""

DRIVE = "law epsilon omega_1 acceleration torque explicit_coriolis spin_terms residual kinetic".split()
LAW, EPSILON, OMEGA_1, ACCELERATION, TORQUE, EXPLICIT_CORIOLIS, SPIN_TERMS, RESIDUAL, KINETIC = range(len(DRIVE))
"""A `Drive`; for the relaxation the net force [N] to reach and the kinetic energy [J] after the last round."""

ROW_COLUMNS = (
    "omega time mass n_monomers n_contacts total_stress xx yy zz xy yz zx "
    "dissipated_sliding dissipated_rolling dissipated_twisting dissipated_damping dissipated_contact torque_work "
    "kinetic_energy potential_energy n_fragments_lost dt"
).split()
"""What a record is made of; xx ... zx is the inertia tensor of the largest fragment."""


class Arena(NamedTuple):
    """Arrays of all grains.

    Attributes
    ----------
    monomer, contact, pair_i, pair_j, identity, fragment, lost, scalar, counter, material : arrays
        As in `State`, of all grains.
    result : float64
        What the contacts leave for their monomers, blocks of RESULTS * LANES.
    reference : (monomers, 6) float64
        Where the monomers were when the near and the far list of pairs were made.
    piece : float64
        A number for each monomer or fragment.
    begin : int64
    link : uint64
        Contacts of each monomer, link[begin[k] : begin[k + 1]]: twice the place where the results of the contact
        begin, and 1 more where the monomer is its j.
    far, near : (pairs, 2) int32
        Pairs that may come into contact.
    label, order : int64
        Working space of a number for each monomer.
    at, task : int64
    drive, goal, row : float64
        See above; `goal` is the omega of each record to come.
    """

    monomer: np.ndarray
    contact: np.ndarray
    pair_i: np.ndarray
    pair_j: np.ndarray
    identity: np.ndarray
    fragment: np.ndarray
    lost: np.ndarray
    scalar: np.ndarray
    counter: np.ndarray
    material: np.ndarray
    result: np.ndarray
    reference: np.ndarray
    piece: np.ndarray
    begin: np.ndarray
    link: np.ndarray
    far: np.ndarray
    near: np.ndarray
    label: np.ndarray
    order: np.ndarray
    at: np.ndarray
    task: np.ndarray
    drive: np.ndarray
    goal: np.ndarray
    row: np.ndarray


def write_drive(row, motion):
    """Write a `ratd.drives.Drive` into its row of numbers."""
    row[[LAW, EPSILON, OMEGA_1, ACCELERATION]] = motion.law, motion.epsilon, motion.omega_1, motion.acceleration
    row[[TORQUE, EXPLICIT_CORIOLIS, SPIN_TERMS]] = motion.torque, motion.explicit_coriolis, motion.spin_terms


def _parts(at, grain):
    """Part of each array of the state that belongs to a grain, by name of the array."""
    rows = slice(at[grain, MONOMER_AT] * ROW, at[grain + 1, MONOMER_AT] * ROW)
    numbers = slice(at[grain, NUMBER_AT], at[grain + 1, NUMBER_AT])
    blocks = slice(at[grain, BLOCK_AT] * BLOCK, at[grain + 1, BLOCK_AT] * BLOCK)
    slots = slice(at[grain, BLOCK_AT] * LANES, at[grain + 1, BLOCK_AT] * LANES)
    one = slice(grain, grain + 1)
    return {
        "monomer": rows, "contact": blocks, "pair_i": slots, "pair_j": slots, "identity": numbers,
        "fragment": numbers, "lost": numbers, "scalar": one, "counter": one, "material": one,
    }  # fmt: skip


class Batch:
    """Some grains on the device.

    Parameters
    ----------
    states : list of State
    rows : int
        Records that a grain may make in one launch.

    Attributes
    ----------
    host, device : Arena
        The same arrays on both sides; the methods say what is copied when.
    """

    def __init__(self, states, rows):
        n = np.array([len(state.identity) for state in states])
        blocks = np.array([len(state.pair_i) // LANES for state in states])
        at = np.zeros((len(states) + 1, N_AT), dtype=np.int64)
        at[1:, MONOMER_AT] = np.cumsum(n + 2)
        at[1:, NUMBER_AT] = np.cumsum(n)
        at[1:, BLOCK_AT] = np.cumsum(blocks)
        monomers, slots = int(at[-1, MONOMER_AT]), int(blocks.sum()) * LANES
        grains = len(states)
        self.host = Arena(
            monomer=np.concatenate([state.monomer for state in states]),
            contact=np.concatenate([state.contact for state in states]),
            pair_i=np.concatenate([state.pair_i for state in states]),
            pair_j=np.concatenate([state.pair_j for state in states]),
            identity=np.concatenate([state.identity for state in states]),
            fragment=np.concatenate([state.fragment for state in states]),
            lost=np.concatenate([state.lost for state in states]),
            scalar=np.stack([state.scalar for state in states]),
            counter=np.stack([state.counter for state in states]),
            material=np.stack([state.material for state in states]),
            result=np.zeros(slots * RESULTS),
            reference=np.zeros((monomers, 6)),
            piece=np.zeros(monomers),
            begin=np.zeros(monomers, dtype=np.int64),
            link=np.zeros(2 * slots, dtype=np.uint64),
            far=np.zeros((FAR_PER_SLOT * slots, 2), dtype=np.int32),
            near=np.zeros((FAR_PER_SLOT * slots, 2), dtype=np.int32),
            label=np.zeros(monomers, dtype=np.int64),
            order=np.zeros(monomers, dtype=np.int64),
            at=at,
            task=np.zeros((grains, len(TASK)), dtype=np.int64),
            drive=np.zeros((grains, len(DRIVE))),
            goal=np.zeros((grains, rows)),
            row=np.zeros((grains, rows, len(ROW_COLUMNS))),
        )
        self.device = Arena(*(upload(array) for array in self.host))

    def send_tasks(self):
        """Tell the device what to do."""
        for name in ("task", "drive", "goal"):
            send(getattr(self.device, name), getattr(self.host, name))

    def fetch_tasks(self):
        """What the device says: tasks, drives, scalars, counters, records."""
        for name in ("task", "drive", "scalar", "counter", "row"):
            fetch(getattr(self.host, name), getattr(self.device, name))

    def view(self, grain):
        """State of a grain as the host last saw it: views into the arrays of the host."""
        parts = _parts(self.host.at, grain)
        arrays = {name: getattr(self.host, name)[part] for name, part in parts.items()}
        for name in ("scalar", "counter", "material"):
            arrays[name] = arrays[name][0]
        return State(force=np.zeros(len(arrays["monomer"]) // ROW * FORCE_ROW), **arrays)

    def state(self, grain):
        """State of a grain as the device holds it now, as `view` gives it."""
        for name, part in _parts(self.host.at, grain).items():
            fetch(getattr(self.host, name), getattr(self.device, name), part)
        return self.view(grain)

    def set_state(self, grain):
        """Send the state of a grain, changed by the host, to the device."""
        for name, part in _parts(self.host.at, grain).items():
            send(getattr(self.device, name), getattr(self.host, name), part)
