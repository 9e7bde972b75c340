"""What is recorded of a spin-up: rows, snapshots, fragments that left, and the Dataset that they make."""

from bisect import bisect_right
from functools import partial

import numpy as np
import xarray as xr

from ratd.drives.largest import (
    ANGULAR_MOMENTUM, CARRIED, DRAGGED, GREATEST, OMEGA, STRESS_SAMPLES, STRESS_SUM, TORQUE_WORK, energy_of_motion,
)  # fmt: skip
from ratd.engine.fragments import note_lost
from ratd.engine.layout import (
    DT, FRAGMENTS_LOST, LARGEST_CONTACTS, LARGEST_MONOMERS, MASS, MONOMERS, STEPS, TIME, X,
)  # fmt: skip
from ratd.engine.state import monomer_rows
from ratd.experiments import intervals
from ratd.observables.energy import dissipated, kinetic, stored
from ratd.observables.pieces import fragment_shape
from ratd.observables.stress import extreme_normal_force, total_stress

# name -> units, meaning, type; in the order of the columns of the records
RECORDS = {
    "omega": ("rad s-1", "greatest angular velocity so far", "f8"),
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
    "dissipated_drag": ("J", "energy taken by the drag in the turning frame so far", "f8"),
    "torque_work": ("J", "work done by the outer torque so far", "f8"),
    "kinetic_energy": ("J", "kinetic energy of the largest fragment in the inertial frame", "f8"),
    "potential_energy": ("J", "potential energy of the contacts of the largest fragment", "f8"),
    "energy_residual": (
        "J", "kinetic, stored and dissipated energy and what fragments carry off, less the work of the torque and the "
        "same at the start; NaN without a torque", "f8",
    ),
    "n_fragments_lost": ("1", "number of fragments lost so far", "i4"),
    "frame_omega": ("rad s-1", "angular velocity, which falls where a torque turns a grain that stretches", "f8"),
    "angular_momentum": ("kg m2 s-1", "angular momentum of the largest fragment about the axis", "f8"),
    "steps_so_far": ("1", "time steps so far", "i8"),
}  # fmt: skip
FRAGMENTS = {
    "fragment_mass": ("kg", "mass of a fragment that left"),
    "fragment_n_monomers": ("1", "number of monomers of a fragment that left"),
    "fragment_omega": ("rad s-1", "angular velocity at which a fragment left"),
    "fragment_time": ("s", "time at which a fragment left"),
}


def let_go(state):
    """Note the fragments that are still near at the end as lost: the masses of all fragments add up to the grain's."""
    rows = monomer_rows(state)
    fragment = state.fragment[: len(rows)]
    for label in range(1, fragment.max() + 1):
        members = fragment == label
        note_lost(state, rows[members, MASS].sum(), members.sum())


OCTAVES = 64
"""No remnant holds so many octaves above the bound."""


def edge_of_record(number, bound, records):
    """Angular velocity [rad/s] of a record: evenly spaced up to the bound by bound/(2 records), then in each octave."""
    octave = max(0, (number - records - 1) // records)
    return 2.0**octave * bound * (number - octave * records) / (2 * records)


def next_record(number, omega, bound, records):
    """The first record from `number` on that lies above an angular velocity [rad/s], see `edge_of_record`."""
    edge = partial(edge_of_record, bound=bound, records=records)
    return bisect_right(range(number + OCTAVES * records), omega, lo=number, key=edge)


def sum_of_energies(state, law):
    """What a spin-up keeps [J]: kinetic, stored and dissipated energy, with what the drag has taken and what fragments
    have carried off, less the work of the torque."""
    drive = state.drive
    held = energy_of_motion(state) + stored(state, law, False).sum() + dissipated(state, law).sum()
    return float(held + drive[DRAGGED] + drive[CARRIED] - drive[TORQUE_WORK])


def record(state, law, density):
    """One row of the records, in the order of `RECORDS`, and the step at the end; starts a new recording interval.

    In the place of ``energy_residual`` stands `sum_of_energies`, from which `dataset` takes that at the start.
    """
    scalar, drive = state.scalar, state.drive
    if drive[STRESS_SAMPLES] > 0:
        stress = drive[STRESS_SUM] / drive[STRESS_SAMPLES]
    else:
        stress = total_stress(state, law)
    drive[STRESS_SUM] = drive[STRESS_SAMPLES] = 0.0
    mass, a, b, c, porosity = fragment_shape(state, density)
    damping, sliding, rolling, twisting, made, broken = dissipated(state, law).tolist()
    counter = state.counter
    return [
        float(drive[GREATEST]), float(scalar[TIME]), mass, float(counter[LARGEST_MONOMERS]),
        float(counter[LARGEST_CONTACTS]), stress, a, b, c, porosity,
        sliding, rolling, twisting, damping, made + broken, float(drive[DRAGGED]),
        float(drive[TORQUE_WORK]), sum(kinetic(state, drive[OMEGA], True)), stored(state, law, True).sum(),
        sum_of_energies(state, law), float(counter[FRAGMENTS_LOST]), float(drive[OMEGA]),
        float(drive[ANGULAR_MOMENTUM]), float(counter[STEPS]), float(scalar[DT]),
    ]  # fmt: skip


def snapshot(state, law):
    """omega and, for every monomer of the original grain: x, y, z, fragment (-1 if dropped), normal force."""
    n = len(state.identity)
    kept = state.identity[: state.counter[MONOMERS]]
    table = np.full((n, 5), np.nan)
    table[:, 3] = -1.0
    table[kept, :3] = monomer_rows(state)[:, X : X + 3]
    table[kept, 3] = state.fragment[: state.counter[MONOMERS]]
    table[kept, 4] = extreme_normal_force(state, law)
    return np.concatenate([[state.drive[GREATEST]], table.ravel()])


def dataset(state, rows, snapshots, grain):
    table = np.array(rows)
    total = table[:, list(RECORDS).index("energy_residual")]
    total -= total[0].copy()
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
        self.to_tell = intervals.Interval(intervals.PROGRESS)
        self.pace = intervals.Pace(self._done(run.state.drive[GREATEST]))

    def _done(self, omega):
        """A number that grows evenly with the steps under the constant-epsilon law: 1 at omega_1, 3 at the end."""
        ratio = omega / self.omega_1
        return ratio**2 if ratio < 1.0 else 3.0 - 2.0 / ratio

    def look(self, run):
        """Tell, if it is time to."""
        row = run.rows[-1]
        if self.progress is None or not self.to_tell.passed():
            return
        done = self._done(row[0])
        # Most of the mass gone: each further step costs little.
        to_go = self.pace.to_go((3.0 - done) * row[2] / self.mass, done)
        self.progress(row[0], row[2] / self.mass, to_go, int(run.state.counter[STEPS]))
