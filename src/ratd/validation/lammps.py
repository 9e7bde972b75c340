"""Against LAMMPS: the normal force of two spheres, and whole grains set into rotation in the inertial frame.

Grains: the same relaxed grain is given to both codes, in two ways. *Sudden*: rigid rotation about its axis a_1 at
once, for some rotations and free from then on; again for other omega until the threshold is bracketed. In ratd that
happens in the inertial frame, in LAMMPS there and in a frame that turns with the grain, which is the same motion in
other coordinates. *Driven*: omega grows in small steps, and in between an outer torque keeps the largest fragment
turning with omega: `PARTS` times a step a rigid rotation gives it the angular momentum I omega. That is the drive
`prescribed` in a form that both codes can do, ratd in the inertial frame and LAMMPS in one that turns. *Elastic
rolling*: driven, with no limit to the elastic rolling in either code, which tells how much of what is left between
them comes from that limit (see `ratd.validation.peer_lammps`).
"""

from dataclasses import replace

import numpy as np

from ratd.aggregates.growth import grow
from ratd.base.materials import get_material
from ratd.drives.free import free
from ratd.drives.largest import centre
from ratd.engine.fragments import contact_pairs, label_fragments
from ratd.engine.layout import DT, INERTIA, MASS, RADIUS, TIME, VX, VY, WZ, X, Y
from ratd.engine.leapfrog import leapfrog
from ratd.engine.state import copied, monomer_rows
from ratd.engine.step import run, until
from ratd.experiments.relax import relax
from ratd.experiments.spin_up.cut_bound import cut_bound
from ratd.geometry.box import open_space
from ratd.geometry.neighbours import connected_components
from ratd.laws.contact_constants import equilibrium_compression, pull_off_force, reduced_radius
from ratd.laws.jkr_with_springs import jkr
from ratd.laws.johnson_kendall_roberts import (
    COMPRESSION_END,
    S_PULL_OFF,
    S_TOUCH,
    compression_of,
    contact_state,
    normal_force,
)
from ratd.observables.pieces import heaviest_pieces
from ratd.validation import peer_lammps
from ratd.validation.energy_step import NO_ROLLING_LIMIT
from ratd.validation.lammps_checkpoint import Drive, Holds, forget, keep, last_hold
from ratd.validation.peer_lammps import Spheres, stable_step
from ratd.validation.tables import GRAIN_COLUMNS, empty_row, grain_values, table_kind

CODES = ("ratd", "LAMMPS")
TURNING = "LAMMPS, turning frame"
ELASTIC_ROLLING = "elastic rolling"
COMPARISONS = (("sudden", "LAMMPS"), ("sudden", TURNING), ("driven", TURNING))
"""Start, and what stands beside ratd."""
COLUMNS = {
    "study": ("", "force (of two spheres), rotation (of a grain) or elastic rolling (the same, with no limit to it)"),
    "code": ("", f"ratd, LAMMPS or {TURNING}"),
    "version": ("", "version of LAMMPS"),
    "path": ("", "force: approach or withdrawal; rotation: sudden or driven"),
    "radius_1": ("m", "radius of the smaller sphere"),
    "radius_2": ("m", "radius of the larger sphere"),
    "overlap": ("m", "delta, sum of the radii less the distance"),
    "normal_force": ("N", "normal force, positive when it pushes the spheres apart; none without contact"),
    "equilibrium_overlap": ("m", "delta_0"),
    "pull_off_force": ("N", "F_C = 3 pi gamma R"),
    **GRAIN_COLUMNS,
    "n_contacts": ("1", "contacts at the start"),
    "cut_bound": ("rad s-1", "bound on omega of the grain as it stands"),
    "timestep": ("s", "time step at the start"),
    "omega": ("rad s-1", "angular velocity that the grain was given"),
    "rotations": ("1", "for how long: time over 2 pi/omega"),
    "mass_half_way": ("1", "mass of the largest fragment over that of the grain after half of this time"),
    "mass_left": ("1", "mass of the largest fragment over that of the grain at the end"),
}
KIND = table_kind("lammps", "ratd beside LAMMPS", COLUMNS)
MARKS = {"first loss": 1.0 - 1e-9, "25 % of the mass": 0.75}
"""A grain has come apart when its largest fragment holds less than this part of the mass."""
PARTS = 8
"""A grain is looked at so many times in a run, which ends where it has lost 25 % of its mass."""
FIRST_OMEGA = 0.4
RISE = 10
"""Driven grains are looked at from this part of the cut bound on."""
GREATEST_RATIO = 2.0
"""No omega above this part of the cut bound is tried."""


class InRatd:
    """A grain in the engine of ratd, free in the inertial frame.

    Parameters
    ----------
    state : State
        At rest, such as `ratd.experiments.relax.relax` leaves it; it is copied.
    timestep_factor : float
        f of Eq. 31.
    law : part, optional
        That of the state; `ratd.laws.jkr` when not given.
    """

    def __init__(self, state, timestep_factor, law=None):
        self._state = copied(state)
        self._law = jkr() if law is None else law
        self._integrator = leapfrog(timestep_factor=timestep_factor)
        self._omega = 0.0
        self._mass = monomer_rows(self._state)[:, MASS].sum()
        self.timestep = float(self._state.scalar[DT])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def turn(self, omega):
        """Add a rigid rotation about z with `omega` [rad/s] to the velocities and spins."""
        self._omega += omega
        rows = monomer_rows(self._state)
        rows[:, VX] -= omega * rows[:, Y]
        rows[:, VY] += omega * rows[:, X]
        rows[:, WZ] += omega

    def advance(self, duration):
        """Integrate for `duration` [s]."""
        end = until(time=self._state.scalar[TIME] + duration)
        self._state, _ = run(self._state, self._law, free(), open_space(), self._integrator, end)

    def unwind(self):
        """Make the largest fragment turn with the sum of all `turn` again, as the outer torque of `prescribed` does."""
        label_fragments(self._state)
        centre(self._state)  # the origin is at rest in its centre of mass
        rows = monomer_rows(self._state)
        members = rows[self._state.fragment[: len(rows)] == 0]
        x, y, mass, own = (members[:, field] for field in (X, Y, MASS, INERTIA))
        momentum = mass @ (x * members[:, VY] - y * members[:, VX]) + own @ members[:, WZ]
        missing = self._omega - momentum / (mass @ (x**2 + y**2) + own.sum())
        members[:, VX] -= missing * y
        members[:, VY] += missing * x
        members[:, WZ] += missing
        rows[self._state.fragment[: len(rows)] == 0] = members

    def mass_left(self):
        """Mass of the largest fragment over that of the grain."""
        return float(heaviest_pieces(self._state, 1)[0] / self._mass)


class InLammps:
    """The same grain in LAMMPS.

    Parameters
    ----------
    state : State
        Of `ratd.experiments.relax.relax`.
    material : ratd.Material
    turning : bool
        Whether it is described in a frame that turns, where `turn` acts on the frame.
    classes : int, optional
        See `ratd.validation.peer_lammps.sort_by_radius`.
    saved : path-like, optional
        File of `save`, in a frame that turns: go on from there.
    """

    def __init__(self, state, material, turning=False, classes=None, saved=None):
        rows = monomer_rows(state)
        radius, self._mass = rows[:, RADIUS].copy(), rows[:, MASS].copy()
        self._turning, self._omega = turning, 0.0
        self.timestep = stable_step(radius, material, contact_pairs(state), float(state.scalar[DT]))
        sorts = f"{classes} classes of radius" if classes else "radii of their own"
        self.code = f"LAMMPS {peer_lammps.version()}, {sorts}, steps of {self.timestep:.4g} s"
        self._spheres = Spheres(rows[:, X : X + 3], radius, material, self.timestep, classes=classes, saved=saved)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._spheres.close()

    def turn(self, omega):
        """Add a rigid rotation about z with `omega` [rad/s] to the velocities and spins, or to the frame."""
        if self._turning:
            self._omega += omega
            self._spheres.turn_frame(self._omega)
        else:
            self._spheres.turn(omega)

    def save(self, path):
        """Write what `saved` needs to go on, all but the angular velocity of the frame."""
        self._spheres.save(path)

    def advance(self, duration):
        """Integrate for `duration` [s]."""
        self._spheres.advance(np.ceil(duration / self.timestep))

    def mass_left(self):
        """Mass of the largest fragment over that of the grain."""
        return float(self._mass[self._largest()].sum() / self._mass.sum())

    def unwind(self):
        """Make the largest fragment turn with the frame again, as the outer torque of `prescribed` does."""
        self._spheres.unwind(self._largest())

    def _largest(self):
        label = connected_components(len(self._mass), self._spheres.contacts())
        return label == np.bincount(label, self._mass).argmax()


def hold(grain, omega, rotations, torque=False):
    """Let a grain that has been set into rotation go on for some rotations.

    Parameters
    ----------
    grain : InRatd or InLammps
    omega : float
        [rad/s]
    rotations : float
        For how long, in units of 2 pi/omega.
    torque : bool
        Whether an outer torque keeps it turning with omega; else it is free.

    Returns
    -------
    half_way, end : float
        Mass of the largest fragment over that of the grain after half of the time and at the end, or where 25 % were
        lost before.
    """
    half_way = left = 1.0
    for part in range(1, PARTS + 1):
        grain.advance(rotations * 2.0 * np.pi / omega / PARTS)
        if torque:
            grain.unwind()
        left = grain.mass_left()
        if part <= PARTS // 2:
            half_way = left
        if left < MARKS["25 % of the mass"]:
            break
    return half_way, left


def sudden(make, unit, step, rotations):
    """Rigid rotation at once, with omega = unit step^k for those k that a bisection for both marks asks for.

    Parameters
    ----------
    make : callable
        Makes an `InRatd` or `InLammps` at rest.
    unit : float
        [rad/s]
    step : float
        Ratio of two neighbouring omega, e.g. 1.04.
    rotations : float
        Time of each run.

    Returns
    -------
    list of tuple of float
        omega, rotations, mass half way, mass at the end; in the order of omega.
    """
    runs = {}

    def run(k):
        if k not in runs:
            omega = unit * step**k
            with make() as grain:
                grain.turn(omega)
                runs[k] = (omega, rotations, *hold(grain, omega, rotations))
        return runs[k][-1]

    highest = int(np.floor(np.log(GREATEST_RATIO) / np.log(step)))
    lowest = -2 * highest
    for limit in reversed(MARKS.values()):
        low, high = lowest, highest  # as if whole and apart
        while high - low > 1:
            middle = (low + high) // 2
            low, high = (low, middle) if run(middle) < limit else (middle, high)
    return [runs[k] for k in sorted(runs)]


def driven(make, unit, step, rotations, first=FIRST_OMEGA, checkpoint=None):
    """Rotation that grows in steps, omega -> step omega, each held for a time, until 25 % of the mass are lost.

    Parameters and result as for `sudden`. From rest to `first` unit it goes in `RISE` equal steps. With `checkpoint`, a
    path, a run that was killed goes on after its last hold (`ratd.validation.lammps_checkpoint`): `make` then takes the
    file of the spheres as ``saved``. The checkpoint goes when the run ends.
    """
    start, risen, rows = Holds(first * unit, 0, [])
    drive = before = None
    if checkpoint is not None:
        with make() as grain:
            drive = Drive(grain.code, step, rotations)
        before = last_hold(checkpoint, drive)
    if before is not None:
        # where the grain loses its first mass may have moved a little with the code
        (start, risen, rows), saved = before
    with make() if before is None else make(saved=saved) as grain:
        for _ in range(risen):
            grain.turn(start / RISE)
        for omega in [start, *(row[0] for row in rows)][: len(rows)]:
            grain.turn((step - 1.0) * omega)
        while risen < RISE:
            grain.turn(start / RISE)
            hold(grain, start, rotations, torque=True)
            risen += 1
            keep(checkpoint, grain, drive, Holds(start, risen, rows))
        omega = rows[-1][0] if rows else start
        while omega < GREATEST_RATIO * unit:
            grain.turn((step - 1.0) * omega)
            omega *= step
            rows.append((omega, rotations, *hold(grain, omega, rotations, torque=True)))
            if rows[-1][-1] < MARKS["25 % of the mass"]:
                break
            keep(checkpoint, grain, drive, Holds(start, risen, rows))
    forget(checkpoint)
    return rows


def threshold(omega, mass, limit):
    """Bracket of the angular velocity at which a grain comes apart.

    Parameters
    ----------
    omega, mass : (n,) array_like
        What was tried [rad/s], and the part of the mass that the largest fragment then held.
    limit : float
        From `MARKS`.

    Returns
    -------
    low, high : float
        The greatest omega at which the grain held, below the least at which it did not, and that. NaN where there is
        none.
    """
    omega, mass = np.asarray(omega, dtype=float), np.asarray(mass, dtype=float)
    high = omega[mass < limit].min(initial=np.inf)
    low = omega[(mass >= limit) & (omega < high)].max(initial=-np.inf)
    return (low, high) if np.isfinite([low, high]).all() else (np.nan, np.nan)


def rotate(settings, progress):
    """Rows of `COLUMNS` for one grain: both codes, sudden and driven, or driven with elastic rolling."""
    study, material = settings["study"], get_material(settings["material"])
    if study == ELASTIC_ROLLING:
        material = replace(material, critical_rolling_displacement=NO_ROLLING_LIMIT)
    grain = grow(settings["type"], settings["a_eff"], material, settings["seed"])
    state = relax(grain, timestep_factor=settings["timestep_factor"])
    unit = cut_bound(grain)
    f, step, rotations = (settings[key] for key in ("timestep_factor", "step", "rotations"))
    makers = {
        "ratd": lambda: InRatd(state, f),
        "LAMMPS": lambda: InLammps(state, material),
        TURNING: lambda: InLammps(state, material, turning=True),
    }
    runs = [("sudden", sudden, code) for code in makers if study == "rotation"]
    runs += [("driven", driven, code) for code in ("ratd", TURNING)]
    rows = []
    for path, how, code in runs:
        make = makers[code]
        with make() as example:
            timestep = example.timestep
        found = how(make, unit, step, rotations[path])
        rows += [
            _row(
                study=study,
                **grain_values(grain),
                code=code,
                path=path,
                n_contacts=grain.n_contacts,
                cut_bound=unit,
                timestep=timestep,
                omega=omega,
                rotations=turns,
                mass_half_way=half_way,
                mass_left=left,
            )
            for omega, turns, half_way, left in found
        ]
        if progress is not None:
            progress(f"{path}, {code}: {len(found)} omega")
    return rows


def force_curve(a_1, a_2, material, compressions):
    """Normal force of two spheres at rest that approach each other and are drawn apart again.

    Parameters
    ----------
    a_1, a_2 : float
        Radii [m].
    material : ratd.Material
    compressions : (n,) array_like
        delta/delta_0 one after the other; the first is apart, below 0.

    Returns
    -------
    (n, 2) array
        Force [N] of ratd and of LAMMPS, NaN where there is no contact.
    """
    r = reduced_radius(a_1, a_2)
    delta_0 = equilibrium_compression(r, material.surface_energy, material.reduced_modulus)
    pull = pull_off_force(r, material.surface_energy)
    forces = np.full((len(compressions), 2), np.nan)
    touching, s = False, S_TOUCH
    with Spheres([[0.0, 0.0, 0.0], [2.0 * (a_1 + a_2), 0.0, 0.0]], [a_1, a_2], material, 1e-13) as spheres:
        for k, compression in enumerate(compressions):
            touching = compression >= (COMPRESSION_END if touching else 0.0)
            if touching:
                for _ in range(40):
                    s = contact_state(compression, s)
                forces[k, 0] = normal_force(s, pull)
            else:
                s = S_TOUCH
            spheres.place([[0.0, 0.0, 0.0], [a_1 + a_2 - compression * delta_0, 0.0, 0.0]])
            if len(spheres.contacts()):
                forces[k, 1] = spheres.force()[1, 0]
    return forces


def curve_points(points):
    """Compressions delta/delta_0 of a curve: from apart to 2, and back beyond the end of the branch.

    Parameters
    ----------
    points : int
        On each way; the greatest pull and the end of the branch, from both sides, are added to the way back.

    Returns
    -------
    compressions : (n,) array
    path : list of str
        approach or withdrawal
    """
    ends = np.outer([compression_of(S_PULL_OFF), COMPRESSION_END], [1 - 1e-6, 1 + 1e-6]).ravel()
    there = np.linspace(-1.0, 2.0, points)
    back = np.sort(np.concatenate([there, ends]))[::-1]
    return np.concatenate([there, back]), ["approach"] * len(there) + ["withdrawal"] * len(back)


def curves(settings, progress):
    """Rows of `COLUMNS` for pairs of spheres of one material."""
    material = get_material(settings["material"])
    compressions, paths = curve_points(settings["points"])
    rows = []
    for a_1, a_2 in settings["pairs"]:
        r = reduced_radius(a_1, a_2)
        delta_0 = equilibrium_compression(r, material.surface_energy, material.reduced_modulus)
        forces = force_curve(a_1, a_2, material, compressions)
        rows += [
            _row(
                study="force",
                material=material.name,
                code=code,
                path=path,
                radius_1=a_1,
                radius_2=a_2,
                overlap=compression * delta_0,
                normal_force=force,
                equilibrium_overlap=delta_0,
                pull_off_force=pull_off_force(r, material.surface_energy),
            )
            for column, code in enumerate(CODES)
            for compression, path, force in zip(compressions, paths, forces[:, column], strict=True)
        ]
    if progress is not None:
        progress(f"{len(settings['pairs'])} pairs of spheres")
    return rows


def compute(settings, progress=None):
    """One piece of the check.

    Parameters
    ----------
    settings : dict
        study. For force: material, pairs (list of two radii [m]), points. For rotation and elastic rolling: material,
        type, a_eff [m], seed, timestep_factor, step (ratio of two omega), rotations {sudden, driven}; only that of
        driven is needed for elastic rolling.
    progress : callable, optional
        Called with a sentence.

    Returns
    -------
    list of dict
        Rows of `COLUMNS`; what does not belong to the study is empty or NaN.
    """
    return {"force": curves, "rotation": rotate, ELASTIC_ROLLING: rotate}[settings["study"]](settings, progress)


def _row(**values):
    return empty_row(COLUMNS) | {"version": peer_lammps.version()} | values
