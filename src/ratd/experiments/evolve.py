"""Any set of spheres, moved by any law in open space or in a box; energies, momenta and pieces against time."""

import warnings

import numpy as np
import xarray as xr

from ratd.base.checks import check_radii, far_apart, is_number, number_array, whole_number
from ratd.base.errors import InputError
from ratd.base.materials import Material, get_material
from ratd.drives.free import rest
from ratd.drives.squeezing import WORK, mean_pressure_tensor, squeezing
from ratd.engine import checkpoint as checkpoints
from ratd.engine.layout import CONTACTS, DT, FASTEST, RADIUS, STEPS, TIME, VX, WX, X
from ratd.engine.leapfrog import limit_step
from ratd.engine.state import has_images, monomer_rows, new_state
from ratd.engine.step import CALL, STEPS_DONE, run, until
from ratd.experiments import intervals
from ratd.experiments.leapfrog_for import leapfrog_for
from ratd.experiments.made_with import made_with
from ratd.experiments.unfinished import attached
from ratd.geometry.box import open_space, touching_pairs
from ratd.laws.chosen import law_of
from ratd.laws.jkr_with_springs import jkr
from ratd.observables.energy import DISSIPATED, STORED, dissipated, in_step, kinetic, momenta, stored
from ratd.observables.pieces import heaviest_pieces, pieces, ranked_pieces
from ratd.observables.pressure import COMPONENTS

__all__ = ["checked_lengths", "depth", "evolve", "touching_at_start"]

AT_REST = 1e-4
"""Part of what the contacts store by which a balance may be off where nothing moves."""
VIBRATION = 16
"""Steps after a record within which a vibration that had just begun moves all that it will: then its balance tells."""
SLOWEST = 1e-3
"""Part of the first step below which a later one tells that a run has blown up."""
DEEPEST = 0.5
"""Two spheres may overlap at the start by at most this part of the smaller radius."""
FARTHEST = 0.1
"""Spheres whose contact is given may be apart by at most this part of the smaller radius: no contact reaches so far."""

DRIVE_METHODS = ("turning", "follow", "leave", "sample", "load", "longest_step", "move")
"""What a drive has to offer, see `ratd.drives`."""

# name -> dimensions after `record`, units, meaning
RECORDS = {
    "time": ((), "s", "time"),
    "kinetic_translation": ((), "J", "kinetic energy of the centres"),
    "kinetic_spin": ((), "J", "kinetic energy of the spins"),
    "stored": (("storage",), "J", "potential energy of the contacts"),
    "dissipated": (("way",), "J", "energy dissipated so far"),
    "box_work": ((), "J", "work of the box so far, -int P dV"),
    "residual": ((), "J", "kinetic + stored + dissipated - work of the box, less the same at the start"),
    "momentum": (("axis",), "kg m s-1", "momentum"),
    "angular_momentum": (("axis",), "kg m2 s-1", "angular momentum about the origin"),
    "n_contacts": ((), "1", "number of contacts"),
    "n_pieces": ((), "1", "number of pieces, single monomers included"),
    "piece_mass": (("rank",), "kg", "masses of the two heaviest pieces"),
    "box_length": (("axis",), "m", "edges of the periodic box, 0 in open space"),
    "pressure_tensor": (("component",), "Pa", "pressure of the periodic box, mean since the last record"),
}  # fmt: skip
SIZES = {"storage": 4, "way": 6, "axis": 3, "rank": 2, "component": 6}


def evolve(
    position,
    radius,
    velocity=None,
    spin=None,
    material="q-S",
    *,
    law=None,
    box=None,
    drive=None,
    duration,
    timestep=None,
    timestep_factor=None,
    damping=None,
    drag=0.0,
    contacts=None,
    records=100,
    snapshot_every=0,
    balance=0.05,
    checkpoint=None,
    progress=None,
):
    """Move spheres by the forces of their contacts.

    Parameters
    ----------
    position : (n, 3) array_like
        Centres [m].
    radius : (n,) array_like
        Radii [m].
    velocity, spin : (n, 3) array_like, optional
        Velocities [m/s] and spins [rad/s] at the start, 0 when not given. In a periodic box velocities are peculiar:
        against the box that shrinks or grows.
    material : str or ratd.Material, or a list of them
        One for all, or one for each sphere.
    law : str or part, optional
        "jkr" or "dmt", `ratd.laws.jkr` (the default) or `ratd.laws.dmt` with their options, or a law of your own.
    box : part, optional
        `ratd.geometry.box.open_space` (the default) or `periodic`.
    drive : part, optional
        A drive of your own (`ratd.drives`), in open space. Its work is then the ``residual`` of the run, and `balance`
        is not looked at.
    duration : float
        How long [s].
    timestep : float, optional
        A fixed step [s].
    timestep_factor : float, optional
        The step over the shortest time of any contact, when `timestep` is not given. By default 0.125, for DMT 0.03, or
        less, so that impacts of spheres at the velocities given take a hundred steps at the least.
    damping : {"implicit", "explicit"}, optional
        How the normal damping is integrated (`ratd.engine.leapfrog`); implicit, for DMT explicit. Implicit is stable
        at any step, and damps too little where the damping is strong, as it is with DMT: spheres that hit each other
        rebound too fast.
    drag : float
        Rate [1/s] at which velocities and spins decay, to bring an aggregate to rest in open space.
    contacts : (k, 2) or (k, 5) array_like, optional
        Pairs in contact at the start, which then hold the force that belongs to their overlap; all that overlap when
        not given: of a ``grain`` whose spheres only touch, give ``grain.contacts``. In a periodic box with their
        images, three integers n: X_i - X_j + n L is the difference.
    records : int
        Number of records after the start, evenly spaced in time. One that no step parts from the last one repeats it.
    snapshot_every : int
        At every so many records, and at the last one, positions and pieces are kept; 0 for none.
    balance : float or None
        The run ends with an error when the balance of energy is off by more than this part of the greatest of the
        kinetic energy so far, what the contacts have let go or taken up, what was dissipated, and the work of the box,
        and by more than 1e-4 of what the contacts store. A number above 0, or None for no check; with a drag there is
        none.
    checkpoint : path-like, optional
        Where to keep what is needed to go on after a kill, with the same bits.
    progress : callable, optional
        Called every few seconds as ``progress(part_done, seconds_to_go, record)``, the last record as a dict.

    Returns
    -------
    xarray.Dataset
        Along ``record`` the time, energies, momenta, pieces (see `RECORDS`); along ``monomer``, in the order given, the
        last positions (unwrapped), velocities, spins and pieces; along ``snapshot`` positions and pieces. The
        attributes tell law, material and box.

    Raises
    ------
    InputError
        If an argument is not usable, or two spheres overlap at the start by more than half of the smaller radius, or
        a contact is given of two that are apart.
    RuntimeError
        If the integration fails, or leaves the balance of energy; its attribute ``run`` holds the Dataset up to there.
    """
    position, radius, velocity, spin = _arrays(position, radius, velocity, spin)
    materials, kind = _materials(material, len(radius))
    law = law_of(law, jkr)
    box = open_space() if box is None else box
    if not hasattr(box, "edges"):
        raise InputError(f"box is {box!r}; it must be ratd.periodic(edge), or None for open space.")
    in_box = has_images(box)
    if in_box and drag:
        raise InputError("drag is for open space; in a periodic box leave it out.")
    if drive is not None:
        _check_drive(drive, in_box, drag)
        balance = None
    records, snapshot_every = checked_lengths(duration, records, snapshot_every)
    if not (is_number(drag) and drag >= 0):
        raise InputError(f"drag is {drag!r}; it must be a number of at least 0, in 1/s.")
    if not (balance is None or (is_number(balance) and balance > 0)):
        raise InputError(f"balance is {balance!r}; it must be a number above 0, or None for no check.")
    touching = touching_at_start(position, radius, box)
    if contacts is not None:
        contacts = _contacts(contacts, len(radius))
        _check_reach(contacts, position, radius, box)
    if drive is None:
        drive = squeezing() if in_box else rest(drag)
    given_step = {"timestep": timestep, "timestep_factor": timestep_factor, "damping": damping}
    integrator = leapfrog_for(law, radius, materials, velocity, **given_step)

    settings = (materials, law, box, drive, integrator, float(duration), records, snapshot_every)
    inputs = (position, radius, velocity, spin, kind, contacts)
    given = [array is not None for array in inputs]
    arrays = [array for array in inputs if array is not None]
    key = None if checkpoint is None else checkpoints.fingerprint(__name__, arrays, *settings, given)
    loaded = checkpoints.load(checkpoint, key)
    if loaded is not None:
        state, tables = loaded
        rows, pictures, first_step = list(tables["rows"]), list(tables["pictures"]), float(tables["first_step"])
    else:
        contacts = touching if contacts is None else contacts
        how = {"velocity": velocity, "spin": spin, "kind": kind}
        state = new_state(position, radius, materials, contacts, law, box, integrator, **how)
        if timestep is None and velocity is not None:
            # as the integrator does after each step
            state.scalar[FASTEST] = np.linalg.norm(velocity, axis=1).max()
            limit_step(state, integrator.timestep_factor * radius.min())
        rows = [_row(state, law, box, None)]
        pictures, first_step = [_picture(state)] if snapshot_every else [], state.scalar[DT]
    to_save, to_tell = intervals.Interval(intervals.CHECKPOINT), intervals.Interval(intervals.PROGRESS)
    foresee, pace = intervals.Interval(intervals.FORECAST), intervals.Pace(state.scalar[TIME])
    moved, checked = _moved(rows, rows[0]), 1
    parts = law, box, materials
    with attached("run", lambda error: _dataset(getattr(error, "state", state), rows, pictures, *parts)):
        while len(rows) <= records:
            goal = until(time=duration * len(rows) / records, steps=state.counter[STEPS] + CALL)
            state, code = run(state, law, drive, box, integrator, goal)
            if code == STEPS_DONE and timestep is None:
                _check_pace(state, first_step)
            if code != STEPS_DONE:
                no_step = state.scalar[TIME] == rows[-1][0]
                rows.append(rows[-1] if no_step else _row(state, law, box, rows[0]))
                if snapshot_every and ((len(rows) - 1) % snapshot_every == 0 or len(rows) > records):
                    pictures.append(_picture(state))
                moved = max(moved, _moved(rows[-1:], rows[0]))
                # a vibration that has just begun has not moved all that it will: one record more tells
                told_until = np.inf if len(rows) > records else rows[-1][0] - VIBRATION * state.scalar[DT]
                while checked < len(rows) and rows[checked][0] <= told_until:
                    if balance is not None and not drag:
                        _check_balance(rows[checked], moved, balance)
                    checked += 1
            if checkpoint is not None and to_save.passed():
                checkpoints.save(checkpoint, key, state, rows=rows, pictures=pictures, first_step=first_step)
            if foresee is not None and foresee.passed():
                now = state.scalar[TIME]
                foresee = _warn_of_long(pace.to_go(duration - now, now), duration, state.scalar[DT])
            if progress is not None and to_tell.passed():
                now = state.scalar[TIME]
                progress(now / duration, pace.to_go(duration - now, now), record_of(rows[-1]))
    _warn_of_passing(velocity, radius, max(first_step, state.scalar[DT]))
    return _dataset(state, rows, pictures, *parts)


def checked_lengths(duration, records, snapshot_every):
    """Number of records and of those from one snapshot to the next as int, checked as the duration is."""
    if not (is_number(duration) and duration > 0):
        raise InputError(f"duration is {duration!r}; it must be a number above 0, in s.")
    return whole_number(records, "records", 1), whole_number(snapshot_every, "snapshot_every", 0)


def _check_drive(drive, in_box, drag):
    """Refuse a drive of one's own that is none, or that is given with what is a drive itself."""
    lacking = [name for name in DRIVE_METHODS if not hasattr(drive, name)]
    if lacking:
        raise InputError(f"drive is {drive!r}, without {lacking[0]}(); it must have the methods of ratd.drives.")
    if isinstance(drive, type):
        raise InputError(f"drive is the class {drive.__name__}; it must be one of its objects, {drive.__name__}(...).")
    if in_box or drag:
        raise InputError("drive is for open space without a drag; leave out the box and the drag.")


def _warn_of_passing(velocity, radius, timestep):
    """Warn of spheres so fast that they may pass through each other between two steps."""
    fastest = 0.0 if velocity is None else float(np.linalg.norm(np.ptp(velocity, axis=0)))
    if fastest * timestep > radius.min():
        warnings.warn(
            f"two spheres that meet at {fastest:.3g} m/s come nearer by {fastest * timestep:.2g} m in a step of "
            f"{timestep:.2g} s, more than the smallest radius: they may have passed through each other; take a smaller "
            "timestep",
            stacklevel=3,
        )


def _check_pace(state, first_step):
    """End a run whose spheres have become so fast that steps which none of them leaps in hardly get on."""
    if state.scalar[DT] < SLOWEST * first_step:
        raise RuntimeError(
            f"at {state.scalar[TIME]:.3g} s a sphere moves at {state.scalar[FASTEST]:.3g} m/s, and the time step, "
            f"{first_step:.2g} s at the start, is down to {state.scalar[DT]:.2g} s: the run has blown up; take a "
            "smaller time step, by timestep_factor or timestep"
        )


def _warn_of_long(to_go, duration, timestep):
    """Warn of a run that will take days, which a duration in another unit than s makes of it."""
    if to_go > intervals.LONG:
        warnings.warn(
            f"duration is {duration:g} s, {duration / timestep:.2g} steps of {timestep:.2g} s: this takes some "
            f"{to_go / intervals.LONG:.1g} days",
            stacklevel=3,
        )


def _arrays(position, radius, velocity, spin):
    """All as float64 arrays, checked."""
    radius = number_array(radius, "radius")
    given = {"position": (position, "m"), "velocity": (velocity, "m/s"), "spin": (spin, "rad/s")}
    vectors = [None if array is None else number_array(array, name, unit) for name, (array, unit) in given.items()]
    if radius.ndim != 1 or len(radius) == 0:
        raise InputError(f"radius has the shape {radius.shape}; it must be (n,) numbers above 0, in m, n at least 1.")
    wrong = np.flatnonzero(~(np.isfinite(radius) & (radius > 0.0)))
    if len(wrong):
        raise InputError(f"radius of sphere {wrong[0]} is {radius[wrong[0]]:g}; it must be a number above 0, in m.")
    check_radii(radius)
    for name, array in zip(given, vectors, strict=True):
        if array is not None and array.shape != (len(radius), 3):
            raise InputError(f"{name} has the shape {array.shape}; it must be ({len(radius)}, 3) finite numbers.")
        wrong = [] if array is None else np.flatnonzero(~np.isfinite(array).all(axis=1))
        if len(wrong):
            raise InputError(f"{name} of sphere {wrong[0]} is {array[wrong[0]].tolist()}; it must be finite numbers.")
    if vectors[0] is None:
        raise InputError("position is None; it must be (n, 3) finite numbers in m.")
    if hint := far_apart(vectors[0], radius):
        raise InputError(f"position is in another unit than radius, it seems.{hint}")
    return vectors[0], radius, vectors[1], vectors[2]


def _contacts(contacts, n):
    """Pairs in contact as an int array, checked: (k, 2), or (k, 5) with images."""
    try:
        pairs = np.array(contacts)
        pairs = pairs.reshape(0, 2).astype(int) if pairs.size == 0 else pairs
    except ValueError:
        pairs = np.zeros(0)
    good = pairs.ndim == 2 and pairs.shape[1] in (2, 5) and np.issubdtype(pairs.dtype, np.integer)
    if good and len(pairs):
        low, high = pairs[:, :2].min(), pairs[:, :2].max()
        itself = pairs[:, 0] == pairs[:, 1]
        good = low >= 0 and high < n and (pairs[itself, 2:] != 0).any(axis=1).all()
    if not good:
        raise InputError(f"contacts must be pairs (k, 2) of different numbers of spheres from 0 to {n - 1}.")
    turned = pairs[:, 0] > pairs[:, 1]
    if pairs.shape[1] == 5:
        # a contact with the own image is also that with the image on the other side
        x, y, z = pairs[:, 2:].T
        turned |= (pairs[:, 0] == pairs[:, 1]) & ((x < 0) | ((x == 0) & ((y < 0) | ((y == 0) & (z < 0)))))
    ordered = np.where(turned[:, None], np.hstack([pairs[:, 1::-1], -pairs[:, 2:]]), pairs)
    pair, count = np.unique(ordered, axis=0, return_counts=True)
    if (count > 1).any():
        i, j = pair[count.argmax(), :2]
        raise InputError(f"contacts names the pair {i}, {j} more than once; name each contact once.")
    return pairs.astype(np.int64)


def _check_reach(contacts, position, radius, box):
    """Refuse contacts of spheres that are too far apart to hold each other."""
    gap = -depth(contacts, position, radius, box)
    if len(contacts) and gap.max() > FARTHEST:
        i, j = contacts[gap.argmax(), :2]
        image = " A contact through the wall of the box needs its image too, (k, 5)." if has_images(box) else ""
        raise InputError(
            f"contacts names the pair {i}, {j}, but they are apart by {gap.max():.2g} of the smaller radius; a contact "
            f"is of two that touch, numbered from 0 in the order of position.{image}"
        )


def depth(pairs, position, radius, box):
    """By how much the spheres of pairs overlap, over the smaller radius of each, (k,); below 0 where they are apart."""
    i, j = pairs[:, :2].T
    image = pairs[:, 2:] if pairs.shape[1] == 5 else np.zeros((len(pairs), 3))
    apart = np.linalg.norm(position[i] - position[j] + image * np.array(box.edges(np.zeros(1))), axis=1)
    return (radius[i] + radius[j] - apart) / np.minimum(radius[i], radius[j])


def touching_at_start(position, radius, box):
    """Pairs that overlap at the start, with images, (k, 5), of which none may do so too deeply."""
    edges = np.array(box.edges(np.zeros(1)))
    least = (2.0 - DEEPEST) * radius.max()
    if edges[0] > 0.0 and edges.min() < least:
        raise InputError(
            f"The box has an edge of {edges.min():.3g} m; with spheres of up to {radius.max():.3g} m it must be at "
            f"least {least:.3g} m."
        )
    pairs = touching_pairs(position, radius, box)
    deep = depth(pairs, position, radius, box)
    if len(pairs) and deep.max() > DEEPEST:
        worst = deep.argmax()
        i, j = pairs[worst, :2]
        a_copy = " of a neighbouring box" if pairs[worst, 2:].any() else ""
        raise InputError(
            f"The spheres {i} and {j}{a_copy} overlap by {deep[worst]:.2g} of the smaller radius; "
            f"at most {DEEPEST:g} is allowed."
        )
    return pairs


def _materials(material, n):
    """List of the materials, and the number of each sphere's, (n,)."""
    if not isinstance(material, str | Material) and np.ndim(material) == 1:  # a column of a table too
        material = list(np.asarray(material, dtype=object))
    if not isinstance(material, list | tuple):
        return [get_material(material)], np.zeros(n, dtype=np.int64)
    if len(material) != n:
        raise InputError(
            f"material is a list of {len(material)}; it must be one for all, or one for each of {n} spheres."
        )
    each = [get_material(one) for one in material]
    materials = list(dict.fromkeys(each))
    return materials, np.array([materials.index(one) for one in each], dtype=np.int64)


def _row(state, law, box, first):
    """One record, in the order of `RECORDS`; starts a new mean of the pressure."""
    now = in_step(state, law, box)
    moving, spinning = kinetic(now, 0.0, False)
    held = stored(now, law, False)
    gone = dissipated(now, law)
    # half a step of damping, by which what is in step is ahead: where it is steep, a record is not better known
    ahead = abs(gone[0] - dissipated(state, law)[0])
    in_box = has_images(box)
    work = state.drive[WORK] if in_box else 0.0
    total = moving + spinning + held.sum() + gone.sum() - work
    residual = 0.0 if first is None else total - first[-1]
    row = [state.scalar[TIME], moving, spinning, *held, *gone, work, residual, *momenta(now).ravel()]
    row += [state.counter[CONTACTS], len(pieces(state)[0]), *heaviest_pieces(state), *box.edges(state.scalar)]
    row += list(mean_pressure_tensor(state)) if in_box else [0.0] * 6
    return [*map(float, row), float(ahead), float(total)]


def _picture(state):
    """Time, positions and pieces of all spheres in the order of the input, (n, 5)."""
    back = np.argsort(state.identity)
    table = np.empty((len(back), 5))
    table[:, 0] = state.scalar[TIME]
    table[:, 1:4] = monomer_rows(state)[back, X : X + 3]
    table[:, 4] = ranked_pieces(state)[back]
    return table


def columns(table):
    """Name -> numbers of the rows, (rows, ...), as they stand in `RECORDS`."""
    values, column = {}, 0
    for name, (dims, _, _) in RECORDS.items():
        shape = tuple(SIZES[dim] for dim in dims)
        width = int(np.prod(shape))
        values[name] = table[:, column : column + width].reshape(len(table), *shape)
        column += width
    return values


def record_of(row):
    """Name -> number or array of one row; see `columns`."""
    return {name: values[0] for name, values in columns(np.array([row])).items()}


def _moved(rows, start):
    """The greatest of the kinetic energy and of what the contacts have let go or taken up since the start [J]."""
    values = columns(np.array([start, *rows]))
    moving = values["kinetic_translation"] + values["kinetic_spin"]
    held = values["stored"].sum(axis=1)
    return float(max(moving.max(), np.abs(held - held[0]).max()))


def _check_balance(row, moved, share):
    """Raise RuntimeError where a record is off by more than a share of what has moved by now; see `_moved`."""
    values = record_of(row)
    scale = max(moved, values["dissipated"].sum(), abs(values["box_work"]))
    # Near rest nothing moves that the step could miss by a part. Its error is one of what the contacts store.
    floor = AT_REST * np.abs(values["stored"]).sum()
    time, residual, ahead = float(values["time"]), float(values["residual"]), row[-2]
    if not abs(residual) - ahead <= max(share * scale, floor):
        raise RuntimeError(
            f"at {time:.3g} s the balance of energy is off by {residual:.3g} J; allowed are {share:.1%} of the "
            f"{scale:.3g} J that moved: take a smaller time step, by timestep_factor or timestep"
        )


def _dataset(state, rows, pictures, law, box, materials):
    variables = {}
    for name, values in columns(np.array(rows)).items():
        dims, units, meaning = RECORDS[name]
        if name.startswith("n_"):
            values = values.astype("i8")
        variables[name] = (("record", *dims), values, {"units": units, "long_name": meaning})
    back = np.argsort(state.identity)
    rows = monomer_rows(in_step(state, law, box))[back]
    for name, at, units in (("position", X, "m"), ("velocity", VX, "m s-1"), ("spin", WX, "rad s-1")):
        about = {"units": units, "long_name": f"{name} at the end"}
        variables[name] = (("monomer", "axis"), rows[:, at : at + 3].copy(), about)
    variables["radius"] = ("monomer", rows[:, RADIUS].copy(), {"units": "m", "long_name": "radius"})
    piece = ranked_pieces(state)[back]
    variables["piece"] = (
        "monomer",
        piece,
        {"units": "1", "long_name": "number of the piece at the end, 0 the heaviest"},
    )
    if pictures:
        table = np.array(pictures)
        about = {"units": "s", "long_name": "time of the snapshot"}
        variables["snapshot_time"] = ("snapshot", table[:, 0, 0].copy(), about)
        about = {"units": "m", "long_name": "position at the snapshot"}
        variables["snapshot_position"] = (("snapshot", "monomer", "axis"), table[:, :, 1:4].copy(), about)
        about = {"units": "1", "long_name": "number of the piece at the snapshot, 0 the heaviest"}
        variables["snapshot_piece"] = (("snapshot", "monomer"), table[:, :, 4].astype("i8"), about)
    coordinates = {
        "storage": list(STORED),
        "way": list(DISSIPATED),
        "axis": ["x", "y", "z"],
        "component": list(COMPONENTS),
    }
    about = made_with(law, materials) | {
        "steps": int(state.counter[STEPS]),
        "timestep": float(state.scalar[DT]),
        "box": repr(box),
    }
    return xr.Dataset(variables, coords=coordinates, attrs=about)
