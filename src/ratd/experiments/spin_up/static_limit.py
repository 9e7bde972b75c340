"""How fast an aggregate can turn at most, as it stands, if each of its monomers is to be in balance.

`firm_bound` asks for the balance of the forces on two parts. Here the forces and the torques on each monomer must
balance, in the frame that turns with the aggregate. A contact takes what its limits allow: the pull-off force along the
line of centres, any push, and what slides, rolls or twists it. Limit analysis, as of plastic structures: the greatest
load that any forces within the limits balance is that of a linear programme, and no aggregate at rest is above it,
whatever its past. Nothing is integrated in time, and nothing is elastic.
"""

import math
from pathlib import Path

import numpy as np
import pandas as pd

from ratd.base.errors import InputError
from ratd.experiments.spin_up.cells import sort_cells
from ratd.experiments.spin_up.cut_bound import contact_strengths, plane_of_rotation
from ratd.experiments.spin_up.firm_bound import slide_forces
from ratd.geometry.shape import centre_of_mass
from ratd.laws.contact_constants import equilibrium_contact_radius, reduced_radius
from ratd.laws.tangential import TWISTING_LIMIT, rolling_stiffness, twisting_stiffness
from ratd.pipeline import io
from ratd.pipeline.blocks import material_of, rows
from ratd.pipeline.kinds import MATERIAL, ROW, Kind, Variable, over, register

__all__ = ["KIND", "contact_limits", "read_limits", "static_limit"]

UNKNOWNS = 6
"""Of a contact: pull along the line of centres, two forces across it, two torques that roll, one that twists."""
REACTIONS = 6
"""Of the grain as a rigid body: accelerations along and about three axes. About a principal axis there are none."""

KIND = register(
    "static_limits",
    Kind(
        "Static limits of grains as grown",
        {
            **MATERIAL,
            **over(
                (ROW,),
                {
                    "a_eff": ("m", "effective radius"),
                    "firm_bound": ("rad s-1", "bound on omega of the grain as grown, from the forces on two parts"),
                    "static_limit": ("rad s-1", "the same from the forces and torques on each monomer"),
                },
            ),
            **over(
                (ROW,),
                {"seed": ("1", "seed"), "n_monomers": ("1", "monomers"), "n_contacts": ("1", "contacts")},
                dtype="i8",
            ),
            "source": Variable((ROW,), "str", "", "hash of the source"),
        },
        attributes=("material", "type"),
    ),
)


def static_limit(grain, axis=None):
    """Greatest angular velocity at which all monomers of an aggregate as it stands can be in balance.

    Parameters
    ----------
    grain : Grain
        Or anything with its attributes position, radius, mass, contacts and material.
    axis : (3,) array_like, optional
        As for `cut_bound`. About an axis that is not a principal one the grain is taken to tip over as a rigid body.

    Returns
    -------
    float
        omega [rad s-1].

    Raises
    ------
    InputError
        If the grain is none, or has no contacts.
    RuntimeError
        If the linear programme is not solved.

    Notes
    -----
    Sideways forces and rolling torques are held in a regular octagon around the circle of their limit, so that the
    limit is above the exact one by 1/cos(pi/8) = 1.08 at most, in omega squared. The force of a contact acts on the
    line of centres, which it divides as the radii are. The law of `ratd.laws.jkr` holds a little more: sideways by the
    overlap over the distance, below 1 %, and where it has rolled by xi the sliding force twists with that lever. Where
    that was granted to all contacts the limit rose by 5 % at most. An aggregate that rolls or stretches comes to stand
    in another way, and then has another limit: loose trees turn beyond theirs by far.
    """
    # not at the head: scipy is slow to import, and pages and jobs that need no limit would wait for it
    from scipy.optimize import linprog
    from scipy.sparse import vstack

    plane = np.stack(plane_of_rotation(grain, axis))
    if not len(grain.contacts):
        raise InputError("the grain has no contacts, and nothing that could give way.")
    force, length = contact_limits(grain)[0].mean(), grain.radius.mean()
    units = force, force, force * length, force * length
    pull, slide, roll, twist = (limit / unit for limit, unit in zip(contact_limits(grain), units, strict=True))
    balance, load = _balance(grain, length, plane)
    top = np.column_stack([pull, slide, slide, roll, roll, twist])
    bottom = np.column_stack([np.full(len(pull), -np.inf), -top[:, 1:]])
    free = [(None, None)] * REACTIONS
    corners = [_corners(len(pull), first, limit) for first, limit in ((1, slide), (3, roll))]
    scale = np.abs(load).sum()
    answer = linprog(
        np.append(np.zeros(balance.shape[1]), -1.0),
        A_ub=vstack([sides for sides, _ in corners]).tocsr(),
        b_ub=np.concatenate([limit for _, limit in corners]),
        A_eq=vstack([balance.T, load[None] / scale]).T.tocsr(),
        b_eq=np.zeros(len(load)),
        bounds=[*zip(bottom.ravel(), top.ravel(), strict=True), *free, (0.0, None)],
        method="highs-ipm",
    )
    if answer.status != 0:
        raise RuntimeError(f"the static limit of {len(grain.radius)} monomers was not found: {answer.message}")
    return math.sqrt(answer.x[-1] * force / scale)


def contact_limits(grain):
    """What each contact takes before it opens, slides, rolls or twists.

    Parameters
    ----------
    grain : Grain
        As for `static_limit`.

    Returns
    -------
    pull, slide : (k,) float64 array
        F_C and F_S [N], see `ratd.experiments.spin_up.firm_bound.slide_forces`.
    roll, twist : (k,) float64 array
        Torques k_r xi_c/R and k_t phi_c [N m].
    """
    material = grain.material
    gamma = material.surface_energy
    pull = contact_strengths(grain.radius, grain.contacts, gamma)
    R = reduced_radius(*grain.radius[grain.contacts].T)
    roll = rolling_stiffness(pull, R) * material.critical_rolling_displacement / R
    r0 = equilibrium_contact_radius(R, gamma, material.reduced_modulus)
    return pull, slide_forces(R, material), roll, twisting_stiffness(r0, 0.5 * material.shear_modulus) * TWISTING_LIMIT


def _balance(grain, length, plane):
    """Forces and torques [in units of force and force times `length`] on monomers.

    Returns the sparse matrix that makes them from the unknowns of the contacts and the reactions of the grain, (6 n,
    `UNKNOWNS` k + `REACTIONS`), and those of the centrifugal force at 1 rad/s, (6 n,) [kg m].
    """
    from scipy.sparse import coo_array, hstack

    n, k = len(grain.radius), len(grain.contacts)
    position = grain.position - centre_of_mass(grain.position, grain.mass)
    load = np.zeros((n, 6))
    load[:, :3] = grain.mass[:, None] * (position @ plane.T @ plane)
    normal = np.diff(position[grain.contacts], axis=1)[:, 0]
    distance = np.linalg.norm(normal, axis=1)
    normal /= distance[:, None]
    aside = np.eye(3)[np.abs(normal).argmin(axis=1)]
    across = np.cross(normal, aside)
    across /= np.linalg.norm(across, axis=1)[:, None]
    frame = normal, across, np.cross(normal, across)
    radii = grain.radius[grain.contacts]
    places, columns, values = [], [], []
    # what the first monomer of a contact feels; the second feels the opposite, but for the sign of its lever
    for end, sign in ((0, 1.0), (1, -1.0)):
        lever = (radii[:, end] * distance / (radii.sum(axis=1) * length))[:, None]
        felt = np.zeros((k, UNKNOWNS, 6))
        for kind in range(3):
            felt[:, kind, :3] = sign * frame[kind]
            felt[:, kind, 3:] = lever * np.cross(normal, frame[kind])
        for kind, direction in ((3, frame[1]), (4, frame[2]), (5, normal)):
            felt[:, kind, 3:] = sign * direction
        places.append(np.broadcast_to(6 * grain.contacts[:, end, None, None] + np.arange(6), felt.shape).ravel())
        columns.append(np.broadcast_to(np.arange(UNKNOWNS * k).reshape(k, UNKNOWNS, 1), felt.shape).ravel())
        values.append(felt.ravel())
    entries = np.concatenate(values), (np.concatenate(places), np.concatenate(columns))
    return hstack([coo_array(entries, shape=(6 * n, UNKNOWNS * k)), _reactions(grain, position, length)]), load.ravel()


def _reactions(grain, position, length):
    """Forces and torques on monomers at unit accelerations of the grain along and about each axis, (6 n, 6)."""
    felt = np.zeros((len(grain.radius), 6, REACTIONS))
    share = grain.mass / grain.mass.mean()
    for axis, along in enumerate(np.eye(3)):
        felt[:, axis, axis] = share
        felt[:, :3, 3 + axis] = share[:, None] * np.cross(along, position / length)
        felt[:, 3 + axis, 3 + axis] = share * 0.4 * (grain.radius / length) ** 2
    return felt.reshape(-1, REACTIONS)


def _corners(k, first, limit):
    """The four sides of an octagon that cut the corners of a square of `limit`: rows and what they may reach."""
    from scipy.sparse import coo_array

    contact = np.arange(4 * k) % k
    signs = np.repeat([(1, 1), (1, -1), (-1, 1), (-1, -1)], k, axis=0) / math.sqrt(2.0)
    columns = UNKNOWNS * contact[:, None] + first + np.arange(2)
    entries = signs.ravel(), (np.repeat(np.arange(4 * k), 2), columns.ravel())
    return coo_array(entries, shape=(4 * k, UNKNOWNS * k + REACTIONS + 1)), np.tile(limit, 4)


def read_limits(folder):
    """All rows of a folder of tables.

    Parameters
    ----------
    folder : path-like

    Returns
    -------
    pandas.DataFrame
        material, type, a_eff, seed, n_monomers, n_contacts, firm_bound and static_limit.

    Raises
    ------
    InputError
        If there is none.
    """
    names = ("a_eff", "seed", "n_monomers", "n_contacts", "firm_bound", "static_limit")
    found = [
        {"material": material_of(file).name, "type": row.attrs["type"], **{name: row[name].item() for name in names}}
        for file in (io.read(path, KIND) for path in sorted(Path(folder).glob("*.nc")))
        for row in rows(file, KIND)
    ]
    if not found:
        raise InputError(f"{folder}: holds no grains.")
    return sort_cells(pd.DataFrame(found))
