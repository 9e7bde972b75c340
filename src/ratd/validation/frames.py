"""Frames: the same free grain integrated in the inertial frame and in one that turns ever faster.

The grain turns, vibrates, and its monomers spin; damping and all inelastic limits are at work. Without the outer torque
the terms of the turning frame (Eqs. 19-21, 29, 30 of the paper, with those for the spins) change nothing but the
errors of the scheme: the two trajectories differ by O(dt^2), until chaos has made more of that.
"""

import math

import numpy as np

from ratd.aggregates.growth import grow
from ratd.drives.free import free
from ratd.drives.rotating import OMEGA_RAT, angular_velocity, rotating
from ratd.engine.layout import DT, MASS, RADIUS, TIME, VX, WX, X
from ratd.engine.leapfrog import leapfrog
from ratd.engine.state import copied, monomer_rows
from ratd.engine.step import run, until
from ratd.experiments.relax import relax
from ratd.experiments.spin_up.cut_bound import cut_bound
from ratd.geometry.box import open_space
from ratd.laws.jkr_with_springs import jkr
from ratd.observables.energy import dissipated
from ratd.validation.tables import GRAIN_COLUMNS, grain_values, table_kind

COLUMNS = {
    **GRAIN_COLUMNS,
    "timestep_factor": ("1", "f in the time step f min(t_dis, t_vel)"),
    "time": ("s", "time since the start"),
    "turned": ("rad", "angle by which the frame has turned"),
    "distance": ("1", "greatest distance between the places of a monomer in both runs, over the mean radius"),
    "moved": ("1", "greatest distance of a monomer from its place at the start, inertial frame, over the mean radius"),
    "dissipated_energy": ("J", "energy dissipated so far, inertial frame"),
}
table_kind("frames", "Free grains in two frames", COLUMNS)
POSITION, VELOCITY, SPIN = (slice(int(first), int(first) + 3) for first in (X, VX, WX))
"""Columns of `ratd.engine.state.monomer_rows`."""
LAW = jkr()


def turned_angle(drive, start, end):
    """Angle [rad] by which a frame turns between two times [s]: integral of Eq. 24."""
    tau = OMEGA_RAT / drive.acceleration

    def angle(time):
        return OMEGA_RAT * (time + tau * math.expm1(-time / tau))

    return angle(end) - angle(start)


def about_z(vectors, angle):
    """Vectors (n, 3) turned by an angle [rad] about z."""
    c, s = math.cos(angle), math.sin(angle)
    return vectors @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])


def pair_of_states(start, speed, drive, time, seed):
    """The same motion of a relaxed grain in both frames.

    Parameters
    ----------
    start : State
        From `ratd.experiments.relax.relax`.
    speed : float
        Standard deviation of each component of the velocities, and of the spins times the greatest radius [m/s].
    drive : Rotating
        Of the turning frame.
    time : float
        At which the run begins [s]. The axes of both frames then agree.
    seed : int
        Of the random velocities.

    Returns
    -------
    fixed, turning : State
    """
    axis = np.array([0.0, 0.0, angular_velocity(drive, time)[0]])
    turning = copied(start)
    turning.scalar[TIME] = time
    rows = monomer_rows(turning)
    noise = np.random.default_rng(seed).normal(size=(len(rows), 6))
    rows[:, VELOCITY] = speed * noise[:, :3]
    # the turning frame follows the centre of mass
    rows[:, VELOCITY] -= rows[:, MASS] @ rows[:, VELOCITY] / rows[:, MASS].sum()
    rows[:, SPIN] = speed / rows[:, RADIUS].max() * noise[:, 3:]
    fixed = copied(turning)
    rows = monomer_rows(fixed)
    rows[:, VELOCITY] += np.cross(axis, rows[:, POSITION])
    rows[:, SPIN] += axis
    return fixed, turning


def distances(grain, speed, omega, timestep_factor, samples):
    """How far one grain is from itself in the other frame, over time.

    Parameters
    ----------
    grain : ratd.Grain
    speed : float
        See `pair_of_states`.
    omega : float
        Angular velocity [rad/s] of grain and frame at the start. The frame has twice that at the end, after the grain
        has turned by about 1 rad.
    timestep_factor : float
        f of Eq. 31.
    samples : int
        Times at which to compare.

    Returns
    -------
    list of dict
        Rows of `COLUMNS`.
    """
    duration = 1.0 / omega
    drive = rotating("prescribed", omega_1=1.0, angular_acceleration=omega / duration)._replace(torque=False)
    time = omega / drive.acceleration
    integrator = leapfrog(timestep_factor=timestep_factor)
    start = relax(grain, law=LAW, timestep_factor=timestep_factor)
    fixed, turning = pair_of_states(start, speed, drive, time, grain.seed)
    first = monomer_rows(fixed)[:, POSITION].copy()
    mean = grain.radius.mean()
    rows = []
    steps = math.ceil(duration / fixed.scalar[DT])
    for sample in range(1, samples + 1):
        goal = round(steps * sample / samples)
        fixed, _ = run(fixed, LAW, free(), open_space(), integrator, until(steps=goal))
        turning, _ = run(turning, LAW, drive, open_space(), integrator, until(steps=goal))
        angle = turned_angle(drive, time, turning.scalar[TIME])
        place = monomer_rows(fixed)[:, POSITION]
        other = about_z(monomer_rows(turning)[:, POSITION], angle)
        if len(place) != len(first) or len(other) != len(first):
            raise RuntimeError(f"the free grain {grain.type} {grain.seed} lost a part; let it turn more slowly")
        rows.append(
            dict(
                **grain_values(grain),
                timestep_factor=timestep_factor,
                time=fixed.scalar[TIME] - time,
                turned=angle,
                distance=np.linalg.norm(other - place, axis=1).max() / mean,
                moved=np.linalg.norm(place - first, axis=1).max() / mean,
                dissipated_energy=dissipated(fixed, LAW).sum(),
            )
        )
    return rows


def compute(settings, progress=None):
    """One grain in both frames with all steps.

    Parameters
    ----------
    settings : dict
        material, type, a_eff [m], seed, speed [m/s], omega (over the cut bound), timestep_factor (list), samples.
    progress : callable, optional
        Called with a sentence after each step factor.

    Returns
    -------
    list of dict
        Rows of `COLUMNS`.
    """
    grain = grow(settings["type"], settings["a_eff"], settings["material"], settings["seed"])
    omega = settings["omega"] * cut_bound(grain)
    rows = []
    for f in settings["timestep_factor"]:
        rows += distances(grain, settings["speed"], omega, f, settings["samples"])
        if progress is not None:
            progress(f"f = {f:g}: {rows[-1]['distance']:.1e} mean radii apart at the end")
    return rows
