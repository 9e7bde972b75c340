"""Forces and torques of the engine against numerical derivatives of the potentials, and the momenta of free grains."""

from dataclasses import replace

import numpy as np

from ratd.aggregates.growth import grow
from ratd.base.materials import get_material
from ratd.engine.contacts import contact_start
from ratd.engine.forces import contact_forces, working_space
from ratd.engine.layout import FORCE_ROW
from ratd.engine.leapfrog import leapfrog
from ratd.engine.state import contact_blocks, new_state
from ratd.experiments.evolve import evolve
from ratd.experiments.spin_up.same_grains import first_step
from ratd.geometry.box import open_space
from ratd.laws.contact_constants import equilibrium_compression, reduced_radius
from ratd.laws.contact_fields import LANES
from ratd.laws.jkr_with_springs import K_ROLL, K_SLIDE, K_TWIST, NIX, NJX, PHI, PULL_OFF
from ratd.laws.tangential import TWISTING_LIMIT
from ratd.validation.energy_step import ELASTIC, NO_ROLLING_LIMIT
from ratd.validation.free_grain import random_motion
from ratd.validation.tables import empty_row, table_kind

MODES = {"normal": PULL_OFF, "sliding": K_SLIDE, "rolling": K_ROLL, "twisting": K_TWIST}
"""Mode -> the constant of a contact that switches it off when zero, in the order of a law's `energies`."""
DISSIPATION = ("sliding", "rolling", "twisting", "damping")
COLUMNS = {
    "study": ("", "derivative: one random contact and mode; momenta: a free grain after some steps"),
    "material": ("", "material"),
    "mode": ("", "normal, sliding, rolling or twisting"),
    "type": ("", "growth: BA, BAM1 or BAM2"),
    "radius_i": ("m", "radius of the first monomer"),
    "radius_j": ("m", "radius of the second monomer"),
    "compression": ("1", "delta/delta_0"),
    "force": ("1", "greatest deviation of a component of the forces from the derivative, over the greatest component"),
    "torque": ("1", "the same of the torques"),
    "reaction": (
        "1",
        "sum of both forces, and of both torques and the forces' moment, over the greatest of them",
    ),
    "time": ("s", "time since the start"),
    "linear": ("1", "change of the momentum over the sum of the magnitudes of its parts at the start"),
    "angular": ("1", "change of the angular momentum over its magnitude at the start"),
    **{f"dissipated_{mode}": ("J", f"energy dissipated so far: {mode}") for mode in DISSIPATION},
}
table_kind("forces", "Forces against potentials, and momenta", COLUMNS)
LARGEST, SMALLEST = 100e-9, 10e-9
TILT = 1e-2
"""Standard deviation of each component of what is added to the contact pointers."""
MOVE, TURN = 1e-3, 1e-3
"""Steps of the numerical derivatives, in delta_0 and in rad."""
STENCIL = ((1, 8.0 / 12.0), (-1, -8.0 / 12.0), (2, -1.0 / 12.0), (-2, 1.0 / 12.0))
"""f' = sum of weight f(k h)/h, wrong by the order of h^4."""


def random_contact(material, rng, ratio):
    """Two monomers in a random state of contact.

    Parameters
    ----------
    material : ratd.Material
    rng : numpy.random.Generator
    ratio : float
        Of the greater to the smaller radius, at most 10.

    Returns
    -------
    dict
        position (2, 3) [m], radius (2,) [m], pointers (2, 3), angle [rad], compression.
    """
    small = rng.uniform(SMALLEST, LARGEST / ratio)
    radius = rng.permutation([small, ratio * small])
    n_c = rng.normal(size=3)
    n_c /= np.linalg.norm(n_c)
    compression = rng.uniform(-0.3, 1.8)
    r = reduced_radius(*radius)
    delta_0 = equilibrium_compression(r, material.surface_energy, material.reduced_modulus)
    pointers = np.array([-n_c, n_c]) + TILT * rng.normal(size=(2, 3))
    return dict(
        position=np.array([n_c * (radius.sum() - compression * delta_0), np.zeros(3)]),
        radius=radius,
        pointers=pointers / np.linalg.norm(pointers, axis=1)[:, None],
        angle=rng.uniform(-0.9, 0.9) * TWISTING_LIMIT,
        compression=compression,
    )


def state_of_contact(contact, material, only=None):
    """State of two monomers at rest, without damping and limits.

    Parameters
    ----------
    contact : dict
        From `random_contact`.
    material : ratd.Material
    only : str, optional
        The one of `MODES` that acts; all when not given.

    Returns
    -------
    State
    """
    free = replace(material, critical_rolling_displacement=NO_ROLLING_LIMIT)
    parts = ELASTIC, open_space(), leapfrog()
    state = new_state(contact["position"], contact["radius"], free, np.array([[0, 1]]), *parts)
    fields = contact_blocks(state)[0, :, 0]
    for mode, field in MODES.items():
        if only not in (None, mode):
            fields[field // LANES] = 0.0
    # the contact is one of the monomers in their order in the state
    first, second = contact["pointers"][state.identity]
    for field, pointer in ((NIX, first), (NJX, second)):
        fields[field // LANES : field // LANES + 3] = pointer
    fields[PHI // LANES] = contact["angle"]
    return state


def engine_forces(contact, material, mode):
    """Forces (2, 3) [N] and torques (2, 3) [N m] of one mode on both monomers."""
    state = state_of_contact(contact, material, mode)
    contact_forces(state, ELASTIC, open_space(), working_space(), 0.0)
    rows = state.force.reshape(-1, FORCE_ROW)[np.argsort(state.identity)]
    return rows[:, :3], rows[:, 4:7]


def rotated(vector, axis, angle):
    """A vector turned by an angle [rad] about a unit axis (Rodrigues)."""
    c, s = np.cos(angle), np.sin(angle)
    return vector * c + np.cross(axis, vector) * s + axis * (axis @ vector) * (1.0 - c)


def numerical_forces(contact, material):
    """Minus the derivatives of the four potentials, each by moving and turning one monomer.

    Parameters
    ----------
    contact : dict
        From `random_contact`.
    material : ratd.Material

    Returns
    -------
    forces, torques : (4, 2, 3) arrays
        Of the modes in the order of `MODES` [N], [N m].
    """
    n_c = contact["position"][0] - contact["position"][1]
    n_c /= np.linalg.norm(n_c)
    r = reduced_radius(*contact["radius"])
    move = MOVE * equilibrium_compression(r, material.surface_energy, material.reduced_modulus)

    def energies(**changed):
        state = state_of_contact(contact | changed, material)
        return np.array(ELASTIC.energies(state.contact, contact_start(ELASTIC, 0)))

    forces, torques = np.zeros((2, len(MODES), 2, 3))
    for monomer in range(2):
        for axis in range(3):
            unit = np.eye(3)[axis]
            for k, weight in STENCIL:
                position = contact["position"].copy()
                position[monomer, axis] += k * move
                forces[:, monomer, axis] -= weight / move * energies(position=position)
                pointers = contact["pointers"].copy()
                pointers[monomer] = rotated(pointers[monomer], unit, k * TURN)
                angle = contact["angle"] + (1, -1)[monomer] * k * TURN * n_c[axis]
                torques[:, monomer, axis] -= weight / TURN * energies(pointers=pointers, angle=angle)
    return forces, torques


def deviations(contact, material):
    """How far the engine's forces are from the derivatives, as rows of `COLUMNS`, one a mode."""
    forces, torques = numerical_forces(contact, material)
    apart = contact["position"][0] - contact["position"][1]
    rows = []
    for k, mode in enumerate(MODES):
        force, torque = engine_forces(contact, material, mode)
        greatest_force, greatest_torque = np.abs(force).max(), np.abs(torque).max()
        moment, size = np.cross(apart, force[0]), max(greatest_torque, np.linalg.norm(apart) * greatest_force)
        unbalanced = [np.abs(torque.sum(0) + moment).max() / size]
        row = empty_row(COLUMNS) | dict(
            study="derivative",
            material=material.name,
            mode=mode,
            radius_i=contact["radius"][0],
            radius_j=contact["radius"][1],
            compression=contact["compression"],
        )
        # Rolling and twisting have no force, the normal mode no torque: what is zero must be so in both.
        if greatest_force > 0.0:
            row["force"] = np.abs(force - forces[k]).max() / greatest_force
            unbalanced.append(np.abs(force.sum(0)).max() / greatest_force)
        elif np.abs(forces[k]).max() > 0.0:
            row["force"] = np.inf
        if greatest_torque > 0.0:
            row["torque"] = np.abs(torque - torques[k]).max() / greatest_torque
        elif np.abs(torques[k]).max() > 0.0:
            row["torque"] = np.inf
        row["reaction"] = max(unbalanced)
        rows.append(row)
    return rows


def momenta_of(grain, speed, timestep_factor, steps, samples):
    """Drift of the momenta of a free grain with damping and all inelastic limits at work.

    Parameters
    ----------
    grain : ratd.Grain
    speed : float
        Standard deviation of each component of the velocities [m/s]; the spins have that over the least radius.
    timestep_factor : float
        f of Eq. 31.
    steps, samples : int
        Length of the run in steps as long as the first, and how often the momenta are taken.

    Returns
    -------
    list of dict
        Rows of `COLUMNS`.

    Raises
    ------
    RuntimeError
        If the grain comes apart.
    """
    velocity, spin = random_motion(grain, speed, speed / grain.radius.min())
    run = evolve(
        grain.position,
        grain.radius,
        velocity,
        spin,
        grain.material,
        contacts=grain.contacts,
        duration=steps * first_step(grain, timestep_factor),
        timestep_factor=timestep_factor,
        records=samples,
        balance=None,
    )
    if (run["n_pieces"] > 1).any():
        raise RuntimeError(f"the free grain {grain.type} {grain.seed} lost a part; shake it less")
    size = grain.mass @ np.linalg.norm(velocity, axis=1)
    linear, angular = (np.linalg.norm(run[name] - run[name][0], axis=1) for name in ("momentum", "angular_momentum"))
    angular /= np.linalg.norm(run["angular_momentum"][0])
    return [
        empty_row(COLUMNS)
        | dict(
            study="momenta",
            material=grain.material.name,
            type=grain.type,
            time=float(run["time"][k]),
            linear=linear[k] / size,
            angular=angular[k],
            **{f"dissipated_{mode}": float(run["dissipated"].sel(way=mode)[k]) for mode in DISSIPATION},
        )
        for k in range(1, samples + 1)
    ]


def compute(settings, progress=None):
    """Random contacts of one material, then one free grain of each type.

    Parameters
    ----------
    settings : dict
        material, contacts (number), seed, types (list), a_eff [m], speed [m/s], timestep_factor, steps, samples.
    progress : callable, optional
        Called with a sentence.

    Returns
    -------
    list of dict
        Rows of `COLUMNS`.
    """
    material = get_material(settings["material"])
    rng = np.random.Generator(np.random.PCG64(settings["seed"]))
    rows = []
    for ratio in 10.0 ** rng.uniform(0.0, 1.0, settings["contacts"]):
        rows += deviations(random_contact(material, rng, ratio), material)
    if progress is not None:
        progress(f"{settings['contacts']} contacts")
    for kind in settings["types"]:
        grain = grow(kind, settings["a_eff"], material, settings["seed"])
        rows += momenta_of(
            grain, settings["speed"], settings["timestep_factor"], settings["steps"], settings["samples"]
        )
        if progress is not None:
            progress(f"{kind}: {rows[-1]['angular']:.1e} of the angular momentum gone")
    return rows
