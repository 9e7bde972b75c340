"""Pull a compressed cluster until it comes apart, in a periodic box that grows."""

import warnings

import numpy as np
import xarray as xr

from ratd.aggregates.grain import GAP_TOLERANCE, Grain
from ratd.base.errors import InputError
from ratd.base.materials import Material
from ratd.drives.squeezing import squeezing
from ratd.engine import checkpoint as checkpoints
from ratd.engine.contacts import update_contact_rates
from ratd.engine.layout import DT, TIME
from ratd.engine.state import come_to_rest, new_state
from ratd.engine.step import run, until
from ratd.experiments.compression.run import (
    TIMESTEP_FACTOR,
    Cluster,
    attributes,
    balance_check,
    check_rate,
    compression_law,
)
from ratd.experiments.compression.static import box_rate, inertial_tension
from ratd.experiments.compression.steps import integrators
from ratd.experiments.compression.strain import COLUMNS, Parts, state_of, strain, strain_dataset
from ratd.experiments.evolve import depth, touching_at_start
from ratd.experiments.relax import find_rest, start_anew
from ratd.experiments.unfinished import attached
from ratd.geometry.box import pairs_within, periodic
from ratd.geometry.shape import greatest_extent
from ratd.laws.chosen import check_stiffness, law_of
from ratd.laws.contact_constants import equilibrium_compression, reduced_radius
from ratd.laws.jkr_with_springs import JKR
from ratd.pipeline.kinds import MATERIAL

__all__ = ["AXES", "doubts", "stretch", "tension"]

AXES = {"x": (1.0, 0.0, 0.0), "xyz": (1.0, 1.0, 1.0)}
"""Axes along which the box may grow."""
RECORD_STRAIN = 0.005
"""ln L along a pulled axis between two records."""
LONGEST = 2.0
"""ln L along a pulled axis at which the pulling ends at the latest."""
FALLEN = 0.3
"""The pulling ends where the tension has fallen to this part of its greatest value."""
WINDOW = 4
"""Records over which the tension is averaged where its greatest value is looked for: 2 % in L."""
BALANCE, LONG_BALANCE = 0.005, 0.05
"""Parts of what moved that the balance of energy may be off by, with explicit and with long steps."""
REMEDY = "take another strain_rate, in Python also a smaller timestep_factor"
"""What to do where the balance of energy is off: where all contacts part at once, a higher rate may do."""
INERTIAL_SHARE = 0.1
"""Part of the strength that may be the inertia of what the growing box carries along."""
NARROW = 1.5
"""Tension in a single record over the strength from which on its peak is said to be narrow."""
UNLOADING_STRAIN = 2e-4
"""ln L between two records while a box lets go of what presses on it."""
REST_STEPS = 200
"""Steps over which the pressure of the aggregate at rest is averaged."""


def stretch(
    compressed,
    strain_rate=3e-6,
    *,
    axes="x",
    unload=False,
    box_length=None,
    law=None,
    timestep_factor=TIMESTEP_FACTOR,
    long_steps=None,
    checkpoint=None,
    progress=None,
):
    """Let a compressed aggregate come to rest in its box, and pull it apart.

    Parameters
    ----------
    compressed : xarray.Dataset or Grain
        What `ratd.compress` returned; or an aggregate that fills a periodic box.
    strain_rate : float
        The box grows with dL/dt = 2 C_v L/t_0.
    axes : {"x", "xyz"}
        Axes along which it grows; the others stay.
    unload : bool
        Whether the box first grows along all axes, at the same rate, until the aggregate does not press on it any more,
        and the aggregate comes to rest there. Else what it presses with at rest is still there when the pull begins.
    box_length : float or (3,) array_like, optional
        Edge, or edges along x, y and z, of the box [m] that a `Grain` fills, by whose copies it is held. Where spheres
        that only touch are pressed together first (`ratd.aggregates.grain.seated`), the box shrinks with them.
    law, timestep_factor, long_steps, checkpoint
        As of `ratd.compress`; after a compression the law has to be that of it.
    progress : callable, optional
        Called every few seconds as ``progress(phi, tension, seconds_to_go)``.

    Returns
    -------
    xarray.Dataset
        As of `ratd.compress`, without snapshots. ``tension`` is -P_xx, or -P where all axes are pulled. The attributes
        hold ``tensile_strength`` [Pa], its greatest value in a mean over 2 % in L, or that at rest where it is
        greater, 0 where there is no tension, ``phi_strength``, where that is, ``phi_start``, and ``residual_pressure``
        [Pa], what it presses with at rest on the faces that are pulled; below 0 where they pull already.

    Raises
    ------
    InputError
        If an argument is not usable.
    RuntimeError
        If the aggregate does not come to rest, the integration fails, or leaves the balance of energy by more than
        `BALANCE`, with long steps `LONG_BALANCE`. Of a pull that has begun its attribute ``run`` then holds the
        records, without a strength.

    References
    ----------
    Tatsuuma, Kataoka & Tanaka (2019), ApJ 874, 159, as recalled. Whether they pull one axis or three is not known here.
    """
    if axes not in tuple(AXES):
        raise InputError(f"axes is {axes!r}; allowed are {', '.join(AXES)}.")
    filled = isinstance(compressed, Grain)
    if not (filled or _has_state(compressed)):
        raise InputError("compressed must be a ratd.Grain, or what ratd.compress returned, with the state at its end.")
    if filled and box_length is None:
        raise InputError("box_length is missing; a ratd.Grain needs that of the periodic box which it fills.")
    if not filled and box_length is not None:
        raise InputError("box_length belongs to a ratd.Grain; what ratd.compress returned has its own.")
    if not isinstance(unload, bool):
        raise InputError(f"unload is {unload!r}; it must be True or False.")
    strain_rate = check_rate(strain_rate)
    law = law_of(law, compression_law)
    if long_steps is not None:
        check_stiffness(law, "give long_steps=None")
    cluster = Cluster(compressed) if filled else None
    attrs = attributes(cluster) if filled else compressed.attrs
    if not filled and repr(law) != attrs["law"]:
        raise InputError(
            f"law is {law!r}; it must be that of the compression, {attrs['law']}, whose contacts the aggregate has."
        )
    material = Material(attrs["material"], **{name: attrs[name] for name in MATERIAL})
    integrator, _ = integrators(
        material, attrs["monomer_radius"], attrs["time_unit"], timestep_factor, long_steps, strain_rate
    )
    edges = _edges(compressed, cluster, box_length) if filled else compressed["box_length"].values[-1]
    rate = -box_rate(strain_rate, attrs["time_unit"])
    marks = np.arange(1, round(LONGEST / RECORD_STRAIN) + 1) * RECORD_STRAIN / rate

    still = Parts(law, periodic(edges), integrator)
    state = _in_box(cluster, still) if filled else state_of(compressed)
    key = checkpoints.fingerprint(__name__, list(state), still, axes, rate, unload)
    loaded = checkpoints.load(checkpoint, key)
    if loaded is not None:
        at, width = COLUMNS["box_length"]
        edges = loaded[1]["rows"][0][at : at + width]
    else:
        state = _at_rest(state, still)
        if unload:
            state, edges = _unloaded(state, edges, rate, still)
    parts = Parts(law, periodic(edges, np.array(AXES[axes]) * rate), integrator)

    def tell(row, seconds_to_go):
        progress(row["phi"], -(row["pressure_tensor"][0] if axes == "x" else row["pressure"]), seconds_to_go)

    def done(rows):
        pull = tension(rows[1:], axes)
        if len(pull) <= 5 * WINDOW:
            return False
        greatest = _smooth(pull).max()
        # at first the box may still press on it
        return greatest > 0.0 and pull[-WINDOW:].mean() < FALLEN * greatest

    check = balance_check({0.0: BALANCE}, {0.0: LONG_BALANCE}, REMEDY)
    how = {"check": check, "stop": done, "tell": tell if progress else None}
    with attached("run", lambda error: strain_dataset(*error.reached[:2], parts)):
        state, rows, _ = strain(state, parts, marks, key=key, checkpoint=checkpoint, **how)
    found = strain_dataset(state, rows, parts)
    about = {"units": "Pa", "long_name": "tension along the pulled axes"}
    found["tension"] = ("record", tension(rows[1:], axes), about)
    about = {"axes": axes, **_strength(rows, found["phi_mean"].values, axes)}
    density = about["phi_start"] * material.density
    about["inertial_tension"] = inertial_tension(rate, edges[0], density, WINDOW * RECORD_STRAIN)
    for told in doubts(about):
        warnings.warn(told, stacklevel=2)
    names = ("material", *MATERIAL, "time_unit", "monomer_radius", "seed", "n_monomers")
    kept = {name: attrs[name] for name in names}
    return found.assign_attrs(
        {name: _plain(value) for name, value in {**kept, **about}.items()}, strain_rate=strain_rate
    )


def _strength(rows, phi_mean, axes):
    """Attributes of a pull that its records (m, columns) tell, of which the first is that at rest."""
    single = tension(rows[1:], axes)
    pull = _smooth(single)
    best = int(np.argmax(pull))
    at_rest = tension(rows[:1], axes)[0]
    phi_start = rows[0, COLUMNS["phi"][0]]
    # what falls apart as soon as nothing presses on it has no strength
    strength = max(pull[best], at_rest, 0.0)
    about = {"tensile_strength": strength, "phi_strength": np.nan, "phi_start": phi_start}
    if strength > 0.0:
        about["phi_strength"] = phi_start if strength == at_rest else _smooth(phi_mean)[best]
    return about | {"residual_pressure": -at_rest, "greatest_record": max(single.max(), at_rest, 0.0)}


def doubts(about):
    """Sentences on a tensile strength that may not be one, from the attributes of a pull; an empty list for others."""
    strength, inertia = about["tensile_strength"], about.get("inertial_tension", 0.0)
    greatest = about.get("greatest_record", strength)
    said = []
    if strength > 0.0 and inertia > INERTIAL_SHARE * strength:
        said.append(
            f"the tensile strength, {strength:.3g} Pa, is not well above the {inertia:.2g} Pa by which the inertia of "
            "the aggregate resists a box that grows so fast: take a lower strain_rate; if it falls with the rate, the "
            "aggregate does not hold to its copies"
        )
    elif greatest > NARROW * strength:
        said.append(
            f"the tension peaks in less than 2 % of the length, over which the tensile strength, {strength:.3g} Pa, is "
            f"a mean: in a single record it is {greatest:.3g} Pa. So does an aggregate that breaks all at once"
        )
    return said


def _edges(given, cluster, box_length):
    """Edges [m] of the box that an aggregate fills, which shrinks as the aggregate was pressed to rest."""
    edges = np.array(periodic(box_length)[:3])
    wide, now = (np.ptp(grain.position, axis=0).max() for grain in (given, cluster.grain))
    return edges if now == wide else edges * (now / wide)


def _has_state(run):
    """Whether a run is one of `ratd.compress`, or of `stretch`, with records and the state at its end."""
    return isinstance(run, xr.Dataset) and "state_monomer" in run and "law" in run.attrs and run.sizes["record"] > 0


def _in_box(cluster, parts):
    """An aggregate in its box, in contact with its copies where they touch as monomers of a `Grain` do."""
    grain = cluster.grain
    pairs = touching_at_start(grain.position, grain.radius, parts.box)
    if isinstance(parts.law, JKR):
        # which holds a little beyond touch
        pairs = np.concatenate([pairs, _just_apart(grain, parts.box)])
    if not pairs[:, 2:].any():
        edges = " x ".join(f"{edge:.4g}" for edge in parts.box[:3])
        extent = greatest_extent(grain.position, grain.radius)
        raise InputError(
            f"box_length is {edges} m, in which compressed, {extent:.4g} m long, does not touch its copies: there is "
            "nothing to pull."
        )
    return new_state(grain.position, grain.radius, grain.material, pairs, *parts)


def _just_apart(grain, box):
    """Pairs that do not overlap, but less apart than `GAP_TOLERANCE`, with images, (k, 5)."""
    own = grain.material.surface_energy, grain.material.reduced_modulus
    widest = equilibrium_compression(grain.radius.max() / 2.0, *own)
    edges = np.array(box.edges(np.zeros(1)))
    near = pairs_within(grain.position, grain.radius, GAP_TOLERANCE * widest, edges)
    a_i, a_j = grain.radius[near[:, :2]].T
    gap = -depth(near, grain.position, grain.radius, box) * np.minimum(a_i, a_j)
    return near[(gap > 0.0) & (gap < GAP_TOLERANCE * equilibrium_compression(reduced_radius(a_i, a_j), *own))]


def tension(rows, axes):
    """-P_xx [Pa], or -P where all axes are pulled, of records (m, columns), (m,)."""
    at = COLUMNS["pressure_tensor" if axes == "x" else "pressure"][0]
    return -rows[:, at]


def _smooth(values):
    """Means of `WINDOW` neighbours, fewer where there are fewer."""
    width = min(WINDOW, len(values))
    return np.convolve(values, np.full(width, 1.0 / width), mode="valid")


def _plain(value):
    return value.item() if isinstance(value, np.generic) else value


def _unloaded(state, edges, rate, still):
    """The state at rest in a box so large that it does not press on it any more, and the edges of this box [m]."""
    parts = still._replace(box=periodic(edges, np.full(3, rate)))
    marks = np.arange(1, round(LONGEST / UNLOADING_STRAIN) + 1) * UNLOADING_STRAIN / rate
    at = COLUMNS["pressure"][0]
    state, _, _ = strain(state, parts, marks, stop=lambda rows: rows[-1, at] <= 0.0)
    edges = np.array(parts.box.edges(state.scalar))
    return _at_rest(state, parts._replace(box=periodic(edges))), edges


def _at_rest(state, parts):
    """The state come to rest in a box that does not change, as the start of a run.

    The first record of the run then has the mean pressure of the last `REST_STEPS`.
    """
    state.scalar[TIME] = 0.0
    # the compression may have taken other steps
    come_to_rest(state)
    state.scalar[DT] = 0.0
    update_contact_rates(state, parts.law, parts.integrator)
    state = find_rest(state, parts.law, squeezing(), parts.box, parts.integrator)
    start_anew(state, parts.law, parts.integrator)
    state, _ = run(state, parts.law, squeezing(), parts.box, parts.integrator, until(steps=REST_STEPS))
    state.scalar[TIME] = 0.0
    return state
