"""Small systems for the tests of the engine: clusters, states with chosen motion, forces and energies of a state."""

import numpy as np

from ratd.base.materials import get_material
from ratd.engine.forces import contact_forces, working_space
from ratd.engine.layout import CONTACTS, DT_DRIFT, FORCE_ROW, MONOMERS, VX, WX, X
from ratd.engine.leapfrog import leapfrog
from ratd.engine.state import contact_blocks, copied, monomer_rows, new_state
from ratd.laws.contact_fields import LANES

EXPLICIT = leapfrog(damping="explicit")


def unit(*vector):
    """A vector of length 1."""
    return np.array(vector) / np.linalg.norm(vector)


def turned(vector, angle):
    """A vector turned by the vector `angle` (Rodrigues)."""
    size = np.linalg.norm(angle)
    e = angle / (size or 1.0)
    return vector * np.cos(size) + np.cross(e, vector) * np.sin(size) + e * (e @ vector) * (1 - np.cos(size))


def rest_distance(a_i, a_j, material):
    """Distance of the centres of two spheres that stick by the law of JKR."""
    material = get_material(material)
    r = a_i * a_j / (a_i + a_j)
    r0 = (9 * np.pi * material.surface_energy * r**2 / material.reduced_modulus) ** (1 / 3)
    return a_i + a_j - r0**2 / (3 * r)


def tree(radius, material, seed=0):
    """A cluster in which each sphere sticks to a random one before it, in a random direction.

    Parameters
    ----------
    radius : (n,) array_like
        Radii [m].
    material : str
    seed : int

    Returns
    -------
    (n, 3) array
        Positions [m]. No two spheres are closer than at rest.
    """
    rng = np.random.default_rng(seed)
    position = np.zeros((len(radius), 3))
    for k in range(1, len(radius)):
        while True:
            partner = rng.integers(k)
            position[k] = position[partner] + rest_distance(radius[partner], radius[k], material) * unit(
                *rng.normal(size=3)
            )
            near = np.linalg.norm(position[:k] - position[k], axis=1) - radius[:k] - radius[k]
            near[partner] = 0.0
            if near.min() >= 0.0:
                break
    return position


def clusters(speed, material="q-S", n=8, size=40e-9):
    """Two clusters of unequal spheres that are about to meet off centre: positions, radii, velocities."""
    radius = size * np.random.default_rng(1).uniform(0.5, 1.5, n)
    position = tree(radius, material, 2)
    shift = np.array([np.ptp(position[:, 0]) + 3.2 * size, 0.4 * size, 0.0])
    velocity = np.zeros((2 * n, 3))
    velocity[:n, 0], velocity[n:, 0] = speed, -speed
    return np.concatenate([position, position + shift]), np.concatenate([radius, radius]), velocity


def lattice(side, distance):
    """A simple cubic lattice of side^3 points around the origin, (side^3, 3)."""
    line = distance * (np.arange(side) - (side - 1) / 2)
    return np.stack(np.meshgrid(line, line, line, indexing="ij"), axis=-1).reshape(-1, 3)


def pair_state(law, box, radii, materials, distance, normal, *, velocity=None, spin=None, kind=None):
    """State of two spheres in contact, at this distance along the unit vector `normal` from the second to the first."""
    position = np.array([distance * normal, np.zeros(3)])
    state = new_state(
        position, np.array(radii), materials, np.array([[0, 1]]), law, box, EXPLICIT,
        velocity=velocity, spin=spin, kind=kind,
    )  # fmt: skip
    # the Z-curve may have changed the order
    assert state.pair_i[0] == 0 and state.pair_j[0] == 1
    return state


def forces(state, law, box, dt_drift=0.0, dt=0.0):
    """Forces and torques on the monomers, (n, 3) each, contacts being advanced by `dt_drift`."""
    state.scalar[DT_DRIFT] = dt_drift
    state.force[:] = 0.0
    contact_forces(state, law, box, working_space(), dt)
    rows = state.force.reshape(-1, FORCE_ROW)[: state.counter[MONOMERS]].copy()
    state.force[:] = 0.0
    return rows[:, :3], rows[:, 4:7]


def field(state, *offsets):
    """One or more fields of all contacts, (k,) or (k, fields)."""
    rows = contact_blocks(state)[:, [int(offset) // LANES for offset in offsets], :]
    rows = rows.transpose(0, 2, 1).reshape(-1, len(offsets))[: state.counter[CONTACTS]]
    return rows[:, 0] if len(offsets) == 1 else rows


def set_fields(state, offsets, values):
    """Set fields of all contacts to values (k, fields)."""
    blocks = contact_blocks(state)
    for k, row in enumerate(np.atleast_2d(values)):
        for offset, value in zip(offsets, row, strict=True):
            blocks[k // LANES, int(offset) // LANES, k % LANES] = value


def used(state):
    """All arrays of a state as a dict, of lists with room only what is in use."""
    arrays = copied(state)._asdict()
    contacts, monomers = state.counter[CONTACTS], state.counter[MONOMERS]
    blocks = contact_blocks(state)
    arrays["contact"] = blocks.transpose(0, 2, 1).reshape(-1, blocks.shape[1])[:contacts]
    if len(state.image):
        arrays["image"] = state.image.reshape(-1, 3, LANES).transpose(0, 2, 1).reshape(-1, 3)[:contacts]
    arrays["monomer"] = monomer_rows(state)
    for name in ("pair_i", "pair_j"):
        arrays[name] = arrays[name][:contacts]
    for name in ("identity", "fragment", "kind"):
        arrays[name] = arrays[name][:monomers]
    return arrays


def moved(state, shift, angle, size):
    """A copy in which each sphere has velocity `shift` and spin `angle` and has moved by `size` of them."""
    state = copied(state)
    rows = monomer_rows(state)
    rows[:, VX : VX + 3], rows[:, WX : WX + 3] = shift, angle
    rows[:, X : X + 3] += size * np.asarray(shift)
    return state
