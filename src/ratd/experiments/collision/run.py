"""One collision of two clusters: energies, contacts and pieces against time."""

import warnings

import numpy as np

from ratd.aggregates.grain import Grain
from ratd.base.checks import check_seed, is_number
from ratd.base.errors import InputError
from ratd.experiments.collision.approach import approach
from ratd.experiments.collision.laws import FARTHEST, balance_of, contacts_of, longest_step, step_of
from ratd.experiments.evolve import checked_lengths, evolve
from ratd.experiments.relax import relax
from ratd.engine.state import positions_as_given
from ratd.laws.chosen import law_of
from ratd.laws.dmt_with_friction import dmt

__all__ = ["DURATION", "GAP", "at_rest", "collide", "impact_energy"]

GAP = 20e-9
"""Least distance of the two clusters at the start [m]."""
RELAXATION_STEP = 1 / 32
"""Step of the relaxation over the shortest time of a contact. With 1/8 the friction that grows with the rate, which is
explicit, feeds spheres of several contacts."""
DURATION = 3e-6
"""How long a collision lasts [s] (Umstaetter & Urbassek 2020, Sect. 2.3)."""
STILL = 0.2
"""Part of the velocity at which two clusters that still near each other at the end are said to have barely met."""
WIDEST = 100.0
"""Greatest gap at the start over the width of the clusters."""


def impact_energy(mass_a, mass_b, velocity):
    """E_0 = m_red v^2/2 [J], kinetic energy in the frame of the centre of mass; M v^2/4 for two equal masses M [kg]."""
    return 0.5 * mass_a * mass_b / (mass_a + mass_b) * velocity**2


def at_rest(grain, law="dmt"):
    """An aggregate after it has come to rest under a law.

    Parameters
    ----------
    grain : ratd.Grain
    law : str or part
        As for `collide`.

    Returns
    -------
    ratd.Grain
        Spheres in the same order, see `ratd.experiments.relax.relax`.

    Raises
    ------
    InputError
        If it comes apart meanwhile.
    """
    state = relax(grain, law=law_of(law, dmt), timestep_factor=RELAXATION_STEP)
    return grain.replace(position=positions_as_given(state))


def too_short(velocity, duration, gap=GAP):
    """The sentence on a collision that ends before the two have met."""
    return (
        f"duration is {duration:g} s, in which the two do not meet: they begin {gap:g} m apart with {velocity:g} m/s; "
        f"take at least {2.0 * gap / velocity:.2g} s."
    )


def approach_speed(run, mass, owner):
    """Speed [m/s] at which the centres of mass of what was one cluster and the other still near each other at the end.

    Parameters
    ----------
    run : xarray.Dataset
        With ``position`` and ``velocity`` of all spheres.
    mass : (n,) float64 array
        [kg]
    owner : (n,) int array
        0 for the spheres of the first cluster, else 1.
    """
    centre, speed = (
        [mass[own] @ run[name].values[own] / mass[own].sum() for own in (owner == 0, owner == 1)]
        for name in ("position", "velocity")
    )
    way = centre[1] - centre[0]
    return float(way @ (speed[0] - speed[1]) / np.linalg.norm(way))


def collide(
    a,
    b,
    velocity,
    impact_parameter=0.0,
    seed=0,
    law="dmt",
    *,
    duration=DURATION,
    timestep=None,
    gap=GAP,
    records=150,
    snapshot_every=5,
    relaxed=False,
    checkpoint=None,
    progress=None,
):
    """Shoot two clusters at each other.

    Parameters
    ----------
    a, b : ratd.Grain
        The clusters, of one material; the same one may be given twice. Each is turned at random.
    velocity : float
        Of one against the other [m/s].
    impact_parameter : float
        0 for a central collision; in the sum of the radii of the two clusters, from the centre of mass to the farthest
        surface, so that 1 would be a grazing one.
    seed : int
        Of the rotations, at least 0.
    law : {"dmt", "jkr"} or part
        Contact law, with its defaults or as `ratd.laws` makes it.
    duration : float
        [s]
    timestep : float, optional
        [s]; from the contacts of the smallest sphere and the velocity when not given. The damping is explicit: it
        decides what becomes of the clusters, and the implicit one is biased (`docs/model/engine.md`).
    gap : float
        Least distance of the two at the start [m].
    records : int
        Number of records after the start, evenly spaced in time.
    snapshot_every : int
        Records between two snapshots; 0 for none.
    relaxed : bool
        Whether the clusters are at rest under the law already. Otherwise they are brought to rest first.
    checkpoint : path-like, optional
        Where to keep what is needed to go on after a kill, with the same bits.
    progress : callable, optional
        Called every few seconds as ``progress(time, pieces, energy_left, seconds_to_go)``, the energy over that of the
        impact.

    Returns
    -------
    xarray.Dataset
        As from `ratd.evolve`; `cluster` says whose each sphere was. Attributes: velocity, impact_parameter, seed, law,
        timestep, steps, material, density [kg m-3], mass_a, mass_b [kg], impact_energy [J], and balance, the greatest
        residual of the balance of energy over the impact energy.

    Raises
    ------
    InputError
        If an argument is wrong.
    RuntimeError
        If the balance of energy is off by more than the part `ratd.experiments.collision.laws.balance_of` of what
        `ratd.evolve` sets it beside: of a slow collision that is the energy of its contacts, not that of the impact.

    Warns
    -----
    UserWarning
        If the two do not meet within the duration, still fly at each other at its end, or pass each other.
    """
    law = law_of(law, dmt)
    _check(a, b, velocity, impact_parameter, seed, gap)
    checked_lengths(duration, records, snapshot_every)
    if velocity * duration < 2.0 * gap:
        warnings.warn(too_short(velocity, duration, gap), UserWarning, stacklevel=2)
    material = a.material
    radius = np.concatenate([a.radius, b.radius])
    if timestep is None:
        timestep = step_of(radius, material, law, velocity)
    else:
        _check_timestep(timestep, radius, material, law, velocity)
    if not isinstance(relaxed, bool):
        raise InputError(f"relaxed is {relaxed!r}; it must be True or False.")
    if not relaxed:
        a, b = (at_rest(a, law), at_rest(b, law)) if b is not a else (at_rest(a, law),) * 2
    position, velocities, meet = approach(a, b, velocity, impact_parameter, gap, seed)
    if not meet:
        warnings.warn(
            f"impact_parameter is {impact_parameter:g}: with the rotations of seed {seed} the two pass each other.",
            UserWarning,
            stacklevel=2,
        )
    contacts = np.concatenate([contacts_of(a, law), contacts_of(b, law) + len(a.radius)])
    energy = impact_energy(a.mass.sum(), b.mass.sum(), velocity)

    def tell(part, to_go, now):
        moving = float(now["kinetic_translation"] + now["kinetic_spin"])
        progress(float(now["time"]), int(now["n_pieces"]), moving / energy, to_go)

    run = evolve(
        position, radius, velocities, material=material, law=law, duration=duration, timestep=float(timestep),
        damping="explicit", contacts=contacts, records=records, snapshot_every=snapshot_every,
        balance=balance_of(law), checkpoint=checkpoint, progress=None if progress is None else tell,
    )  # fmt: skip
    owner = np.repeat([0, 1], [len(a.radius), len(b.radius)])
    nearing = approach_speed(run, np.concatenate([a.mass, b.mass]), owner)
    if meet and velocity * duration >= 2.0 * gap and nearing > STILL * velocity:
        warnings.warn(
            f"after {duration:g} s the two still fly at each other with {nearing:.2g} of {velocity:g} m/s: what is "
            "told is an early state of the collision.",
            UserWarning,
            stacklevel=2,
        )
    run["cluster"] = ("monomer", owner, {"units": "1", "long_name": "cluster that the sphere came with"})
    run.attrs |= {
        "velocity": float(velocity),
        "impact_parameter": float(impact_parameter),
        "seed": int(seed),
        "mass_a": float(a.mass.sum()),
        "mass_b": float(b.mass.sum()),
        "impact_energy": float(energy),
        "balance": float(np.abs(run["residual"].values).max() / energy),
    }
    return run


def _check_timestep(timestep, radius, material, law, velocity):
    """One sentence for a step that a user gives and that is too long."""
    if not is_number(timestep) or not timestep > 0.0:
        raise InputError(f"timestep is {timestep!r}; it must be a number above 0, in s.")
    longest, nearer = longest_step(radius, material, law), FARTHEST * radius.min()
    if not timestep <= longest:
        raise InputError(
            f"timestep is {timestep:.3g} s; the smallest sphere, {radius.min():.3g} m, allows at most {longest:.3g} s."
        )
    if velocity * timestep > nearer:
        raise InputError(
            f"velocity is {velocity:g} m/s: in a timestep of {timestep:.3g} s the clusters come nearer by more than "
            f"{FARTHEST:.0%} of the smallest radius; take a timestep of at most {nearer / velocity:.2g} s."
        )


def _check(a, b, velocity, impact_parameter, seed, gap):
    """One sentence for the first argument that is wrong."""
    for name, grain in (("a", a), ("b", b)):
        if not isinstance(grain, Grain):
            raise InputError(f"{name} is of type {type(grain).__name__}; it must be a ratd.Grain.")
    if a.material != b.material:
        raise InputError(
            f"The clusters are of {a.material.name!r} and of {b.material.name!r}; they must be of one material."
        )
    if not is_number(velocity) or not velocity > 0.0:
        raise InputError(f"velocity is {velocity!r}; it must be a number above 0, in m/s.")
    if not is_number(impact_parameter) or not 0.0 <= impact_parameter < 1.0:
        raise InputError(f"impact_parameter is {impact_parameter!r}; it must be a number from 0 to below 1.")
    check_seed(seed)
    if not is_number(gap) or not gap > 0.0:
        raise InputError(
            f"gap is {gap!r}; it must be a number above 0, in m: the clusters may not overlap at the start."
        )
    size = max(np.ptp(grain.position, axis=0).max() + 2.0 * grain.radius.max() for grain in (a, b))
    if gap > WIDEST * size:
        raise InputError(
            f"gap is {gap:g} m; the clusters are {size:.2g} m wide, and it must be at most {WIDEST:g} times as much."
        )
