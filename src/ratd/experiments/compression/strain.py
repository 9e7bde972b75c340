"""The loop that compression and tension share: a box that changes at a given rate, and records of what is in it."""

import math
from typing import NamedTuple

import numpy as np
import xarray as xr

from ratd.drives.squeezing import WORK, mean_pressure_tensor, squeezing
from ratd.engine import checkpoint as checkpoints
from ratd.engine.hand_over import hand_over
from ratd.engine.layout import CONTACTS, DT, MASS, MONOMERS, RADIUS, STEPS, TIME
from ratd.engine.semi_implicit import SemiImplicit
from ratd.engine.state import FIELD_TYPES, State, monomer_rows, positions_as_given
from ratd.engine.step import CALL, STEPS_DONE, run, until
from ratd.experiments import intervals
from ratd.experiments.made_with import SOURCE
from ratd.experiments.unfinished import attached
from ratd.observables.energy import DISSIPATED, STORED, dissipated, in_step, kinetic, stored
from ratd.observables.pressure import COMPONENTS, volume

__all__ = ["Parts", "state_of", "strain", "strain_dataset"]

# name -> dimension after `record`, units, meaning
RECORDS = {
    "time": ("", "s", "time since the start"),
    "phi": ("", "1", "filling factor, volume of the monomers over that of the box"),
    "phi_mean": ("", "1", "filling factor in the middle of the time since the last record"),
    "box_length": ("axis", "m", "edges of the box"),
    "pressure": ("", "Pa", "pressure, mean since the last record, at phi_mean"),
    "pressure_tensor": ("component", "Pa", "pressure, mean since the last record, at phi_mean"),
    "n_contacts": ("", "1", "number of contacts"),
    "kinetic_translation": ("", "J", "kinetic energy of the centres, relative to the box"),
    "kinetic_spin": ("", "J", "kinetic energy of the spins"),
    **{f"stored_{mode}": ("", "J", f"potential energy of the contacts, {mode}") for mode in STORED},
    **{f"dissipated_{way}": ("", "J", f"energy dissipated so far, {way}") for way in DISSIPATED},
    "work": ("", "J", "work of the box so far, -int P dV"),
    "energy_residual": ("", "J", "what the balance lacks: kinetic + stored + dissipated - work, since the start"),
}  # fmt: skip
SIZES = {"": 1, "axis": 3, "component": 6}
LABELS = {"axis": ["x", "y", "z"], "component": list(COMPONENTS)}


def columns():
    """Place of each quantity of `RECORDS` in a row: name -> (first, width)."""
    place, at = {}, 0
    for name, (dimension, _, _) in RECORDS.items():
        place[name] = at, SIZES[dimension]
        at += SIZES[dimension]
    return place


COLUMNS = columns()


class Parts(NamedTuple):
    """What a run is put together from.

    Attributes
    ----------
    law, box, integrator : parts
    """

    law: object
    box: object
    integrator: object


def strain(state, parts, marks, *, later=None, key=(), checkpoint=None, snapshots=(), check=None, stop=None, tell=None):
    """Move a state on in a box that changes, and make records.

    Parameters
    ----------
    state : State
        At rest against the box, time 0.
    parts : Parts
    marks : sequence of float
        Times of the records [s], ascending.
    later : (int, part), optional
        Number of a record, and the explicit integrator that takes the place of the semi-implicit one from it on.
    key : str
        See `ratd.engine.checkpoint.fingerprint`.
    checkpoint : path-like, optional
        Where to keep what is needed to go on after a kill, with the same bits.
    snapshots : sequence of int
        Numbers of the records at which positions are kept.
    check : callable, optional
        ``check(row, before, long)``, dicts of a record and of that which its balance of energy begins with, the start
        or the last one of long steps where explicit ones have followed, and whether its steps are long ones; raises
        where something is wrong.
    stop : callable, optional
        ``stop(rows)``: whether to end before the last mark, of the table of records, (m, columns).
    tell : callable, optional
        ``tell(row, seconds_to_go)`` every few seconds.

    Returns
    -------
    state : State
    rows : (m, columns) float64 array
        Records, see `COLUMNS`; the first is that of the start, without a pressure. One that no step parts from the last
        one repeats it.
    kept : (s, n, 3) float64 array
        Positions at the snapshots [m], unwrapped, in the order of the input.

    Raises
    ------
    RuntimeError
        If the integration fails, or `check` raises; its attribute ``reached`` has what would have been returned.
    """
    law, box, integrator = parts
    change, explicit = (math.inf, None) if later is None else later
    drive = squeezing()
    loaded = checkpoints.load(checkpoint, key)
    if loaded is None:
        rows = [_row(state, parts, None)]
        kept = []
    else:
        state, tables = loaded
        rows, kept = list(tables["rows"]), list(tables["kept"])
    to_save, to_tell = intervals.Interval(intervals.CHECKPOINT), intervals.Interval(intervals.PROGRESS)
    pace = intervals.Pace(rows[-1][0])

    def reached(state):
        return state, np.array(rows), np.array(kept) if kept else np.zeros((0, state.counter[MONOMERS], 3))

    with attached("reached", lambda error: reached(getattr(error, "state", state))):
        for number in range(len(rows), len(marks) + 1):
            if stop is not None and stop(np.array(rows)):
                break
            parts = parts._replace(integrator=integrator if number <= change else explicit)
            long = isinstance(parts.integrator, SemiImplicit)
            code = STEPS_DONE
            while code == STEPS_DONE:  # so that Ctrl-C need not wait for a record
                goal = until(time=marks[number - 1], steps=state.counter[STEPS] + CALL)
                state, code = run(state, law, drive, box, parts.integrator, goal)
            if number == change:
                state = hand_over(state, law, drive, box, integrator, explicit)
                parts = parts._replace(integrator=explicit)
            no_step = state.scalar[TIME] == rows[-1][0]
            rows.append(rows[-1].copy() if no_step else _row(state, parts, rows))
            if number in snapshots:
                kept.append(positions_as_given(state))
            if check is not None:
                # the first record has the energy at the start in place of a residual
                before = as_dict(rows[change]) if number > change else as_dict(rows[0]) | {"energy_residual": 0.0}
                check(as_dict(rows[-1]), before, long)
            if checkpoint is not None and to_save.passed():
                checkpoints.save(checkpoint, key, state, rows=rows, kept=kept)
            if tell is not None and to_tell.passed():
                now = rows[-1][0]
                tell(as_dict(rows[-1]), pace.to_go(marks[-1] - now, now))
    return reached(state)


def as_dict(row):
    """A row as a dict, arrays where a quantity has several numbers."""
    return {name: row[at] if width == 1 else row[at : at + width] for name, (at, width) in COLUMNS.items()}


def _row(state, parts, rows):
    """One record; starts a new mean of the pressure."""
    law, box, integrator = parts
    now = in_step(state, law, box, kick=not isinstance(integrator, SemiImplicit))
    moving, spinning = kinetic(now, 0.0, False)
    held, gone = stored(now, law, False), dissipated(now, law)
    size = volume(state, box)
    monomers = monomer_rows(state)
    phi = 4.0 / 3.0 * math.pi * float(np.sum(monomers[:, RADIUS] ** 3)) / size
    tensor = mean_pressure_tensor(state)
    # of the time since the last record
    middle = phi if rows is None else math.sqrt(phi * rows[-1][COLUMNS["phi"][0]])
    total = moving + spinning + held.sum() + gone.sum() - state.drive[WORK]
    row = [state.scalar[TIME], phi, middle, *box.edges(state.scalar), tensor[:3].mean(), *tensor]
    row += [state.counter[CONTACTS], moving, spinning, *held, *gone, state.drive[WORK]]
    # The first row keeps what the balance begins with.
    return np.array([*row, total if rows is None else total - rows[0][-1]])


def strain_dataset(state, rows, parts):
    """Records, last positions and the state of a run, as a dataset.

    Parameters
    ----------
    state : State
    rows : (m, columns) array
        From `strain`; the first row is left out.
    parts : Parts

    Returns
    -------
    xarray.Dataset
        `RECORDS` along ``record``, ``position`` and ``radius`` along ``monomer`` in the order of the input, and the
        arrays of the state, ``state_...``, from which `state_of` goes on.
    """
    variables = {}
    for name, (dimension, units, meaning) in RECORDS.items():
        at, width = COLUMNS[name]
        values = rows[1:, at : at + width]
        values = values if dimension else values[:, 0]
        if name == "n_contacts":
            values = values.astype("i8")
        dims = ("record", dimension) if dimension else ("record",)
        variables[name] = (dims, values.copy(), {"units": units, "long_name": meaning})
    about = {"units": "m", "long_name": "centres at the end, not wrapped into the box"}
    variables["position"] = (("monomer", "axis"), positions_as_given(state), about)
    radius = monomer_rows(state)[np.argsort(state.identity), RADIUS]
    variables["radius"] = ("monomer", radius.copy(), {"units": "m", "long_name": "radii"})
    for name, array in state._asdict().items():
        dims = tuple(f"{name}_{axis}" for axis in range(array.ndim))
        about = {"units": "1", "long_name": f"{name} of the state of the engine at the end, SI units"}
        variables[f"state_{name}"] = (dims, array.copy(), about)
    attributes = {
        "steps": int(state.counter[STEPS]),
        "timestep": float(state.scalar[DT]),
        "mass": float(monomer_rows(state)[:, MASS].sum()),
        "source": SOURCE,
        "law": repr(parts.law),
        "integrator": repr(parts.integrator),
    }
    return xr.Dataset(variables, coords=LABELS, attrs=attributes)


def state_of(run):
    """The state at the end of a run, from the dataset of `strain_dataset`, also from a file that kept other types."""
    return State(**{name: run[f"state_{name}"].values.astype(FIELD_TYPES[name]) for name in State._fields})
