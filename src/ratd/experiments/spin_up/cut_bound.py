"""How fast an aggregate can turn if its contacts pull, without any simulation.

Cut the contact graph anywhere. The part cut off, of mass M and with its centre of mass at a distance r from the axis
of rotation, needs M omega^2 r to stay on its circle, and each contact cut pulls with at most its pull-off force F_C.
So every cut gives an omega above which the pulls of its contacts are not enough, and the least of them is the cut
bound. It is not strict: contacts also hold sideways and push, which `firm_bound` counts.
"""

import math

import numpy as np

from ratd.base.checks import number_array, whole_number
from ratd.base.errors import InputError
from ratd.base.jit import jit
from ratd.geometry.shape import centre_of_mass, principal_axes
from ratd.laws.contact_constants import pull_off_force, reduced_radius

__all__ = [
    "contact_strengths",
    "cut_bound",
    "least_bridge_cut",
    "least_plane_cut",
    "plane_normals",
    "plane_of_rotation",
]


def cut_bound(grain, axis=None, *, directions=500):
    """Angular velocity up to which the pulls of its contacts hold an aggregate as it stands.

    Parameters
    ----------
    grain : Grain
        Or anything with its attributes position, radius, mass, contacts and material.
    axis : (3,) array_like, optional
        Direction of the axis of rotation, of any length; it passes through the centre of mass. The axis a_1 of the
        greatest moment of inertia when not given.
    directions : int, optional
        Number of directions of cutting planes.

    Returns
    -------
    float
        omega [rad s-1].

    Raises
    ------
    InputError
        If the axis is not a direction or the number of directions is less than 1.

    Notes
    -----
    omega^2 = min over cuts of (sum of F_C over the contacts cut)/(M r). Two families of cuts are searched: every
    contact that alone holds two parts together (`least_bridge_cut`), and planes (`least_plane_cut`). For a tree, i.e.
    a BA grain without accidental contacts, the first is the exact minimum over all cuts: the pull on a set of
    monomers is a sum of pulls on branches, no greater than the sum of their magnitudes, so that no set that takes
    several contacts is weaker than the weakest of its branches. With more contacts than a tree has, a cut of another
    form may be weaker than both families.

    It is meant for the aggregate as it stands; contacts made while it deforms can raise it. A contact that is loaded at
    a slant holds more than F_C along the load: see `firm_bound`.
    """
    directions = whole_number(directions, "directions", 1)
    u, v = plane_of_rotation(grain, axis)
    position = grain.position - centre_of_mass(grain.position, grain.mass)
    # Pull on each monomer at omega = 1 rad/s, in the plane normal to the axis.
    load = np.ascontiguousarray(grain.mass[:, None] * (position @ np.stack([u, v], axis=1)))
    strength = contact_strengths(grain.radius, grain.contacts, grain.material.surface_energy)
    square = min(
        least_bridge_cut(load, grain.contacts, strength),
        least_plane_cut(position, load, grain.contacts, strength, plane_normals(directions)),
    )
    return math.sqrt(square)


def plane_of_rotation(grain, axis):
    """Two unit vectors, (3,), that span the plane normal to the axis of `cut_bound`; refuses what is no grain."""
    if not all(hasattr(grain, name) for name in ("position", "radius", "mass", "contacts", "material")):
        raise InputError(f"grain is a {type(grain).__name__}; it must be a ratd.Grain.")
    if axis is None:
        _, axes = principal_axes(grain.position, grain.mass, grain.radius)
        return axes[1], axes[2]
    axis = number_array(axis, "axis", "any unit")
    if axis.shape != (3,) or not np.all(np.isfinite(axis)) or not np.any(axis):
        raise InputError(f"axis is {axis}; it must be three finite numbers that are not all 0.")
    axis = axis / np.max(np.abs(axis))
    u = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    v = np.cross(axis, u)
    return u / np.linalg.norm(u), v / np.linalg.norm(v)


@jit
def contact_strengths(radius, contacts, surface_energy):
    """Pull-off forces F_C [N], (k,), of contacts (k, 2) between monomers of radii (n,) [m]; gamma [J m-2]."""
    strength = np.empty(contacts.shape[0])
    for c in range(contacts.shape[0]):
        strength[c] = pull_off_force(reduced_radius(radius[contacts[c, 0]], radius[contacts[c, 1]]), surface_energy)
    return strength


def plane_normals(directions):
    """Unit vectors spread evenly over a half sphere (a Fibonacci spiral), the same for every grain.

    Parameters
    ----------
    directions : int
        How many.

    Returns
    -------
    (directions, 3) float64 array
    """
    k = np.arange(directions)
    z = (k + 0.5) / directions
    angle = k * math.pi * (3.0 - math.sqrt(5.0))
    s = np.sqrt(1.0 - z * z)
    return np.stack([s * np.cos(angle), s * np.sin(angle), z], axis=1)


@jit
def _contact_lists(n, contacts):
    """Contacts of every monomer: those of monomer i are member[begin[i]:begin[i + 1]]."""
    begin = np.zeros(n + 1, dtype=np.int64)
    for c in range(contacts.shape[0]):
        begin[contacts[c, 0] + 1] += 1
        begin[contacts[c, 1] + 1] += 1
    for i in range(n):
        begin[i + 1] += begin[i]
    filled = begin[:n].copy()
    member = np.empty(2 * contacts.shape[0], dtype=np.int64)
    for c in range(contacts.shape[0]):
        for side in range(2):
            i = contacts[c, side]
            member[filled[i]] = c
            filled[i] += 1
    return begin, member


@jit
def least_bridge_cut(load, contacts, strength):
    """Least omega^2 at which a contact that alone holds two parts together breaks.

    Parameters
    ----------
    load : (n, 2) float64 array
        Pull on each monomer at omega = 1 rad/s, m_i times its place in the plane normal to the axis, from the common
        centre of mass [kg m].
    contacts : (k, 2) int64 array
        Contacts of an aggregate in one piece.
    strength : (k,) float64 array
        Greatest pull that each holds [N].

    Returns
    -------
    float
        [rad2 s-2]; inf where there is no such contact.

    Notes
    -----
    One pass in depth (Tarjan 1974, A note on finding the bridges of a graph): a contact is a bridge if nothing on its
    far side has another contact to where the pass has been before. The far side's pull is summed on the way back.
    """
    n = load.shape[0]
    begin, member = _contact_lists(n, contacts)
    seen = np.full(n, -1)
    lowest = np.empty(n, dtype=np.int64)
    entered_by = np.full(n, -1)
    upcoming = begin[:n].copy()
    pull = load.copy()
    path = np.empty(n, dtype=np.int64)
    path[0] = 0
    depth = 1
    seen[0] = 0
    lowest[0] = 0
    count = 1
    least = math.inf
    while depth > 0:
        i = path[depth - 1]
        if upcoming[i] < begin[i + 1]:
            c = member[upcoming[i]]
            upcoming[i] += 1
            if c == entered_by[i]:
                continue
            j = contacts[c, 0] + contacts[c, 1] - i
            if seen[j] >= 0:
                lowest[i] = min(lowest[i], seen[j])
            else:
                seen[j] = count
                lowest[j] = count
                count += 1
                entered_by[j] = c
                path[depth] = j
                depth += 1
            continue
        depth -= 1
        if depth == 0:
            break
        above = path[depth - 1]
        if lowest[i] > seen[above]:
            magnitude = math.hypot(pull[i, 0], pull[i, 1])
            if magnitude > 0.0:
                least = min(least, strength[entered_by[i]] / magnitude)
        lowest[above] = min(lowest[above], lowest[i])
        pull[above, 0] += pull[i, 0]
        pull[above, 1] += pull[i, 1]
    return least


@jit
def least_plane_cut(position, load, contacts, strength, normals):
    """Least omega^2 at which all contacts across a plane together break.

    Parameters
    ----------
    position : (n, 3) float64 array
        Centres [m].
    load : (n, 2) float64 array
        As in `least_bridge_cut` [kg m].
    contacts : (k, 2) int64 array
        Contacts.
    strength : (k,) float64 array
        Greatest pull that each holds [N].
    normals : (d, 3) float64 array
        Normals of the planes; of each, every plane that divides the centres differently is tried.

    Returns
    -------
    float
        [rad2 s-2]; inf where no plane leaves a pull.
    """
    n = load.shape[0]
    begin, member = _contact_lists(n, contacts)
    height = np.empty(n)
    least = math.inf
    for d in range(normals.shape[0]):
        for i in range(n):
            height[i] = position[i, 0] * normals[d, 0] + position[i, 1] * normals[d, 1] + position[i, 2] * normals[d, 2]
        order = np.argsort(height, kind="mergesort")
        below = np.zeros(n, dtype=np.bool_)
        held = 0.0
        x = 0.0
        y = 0.0
        for s in range(n - 1):
            i = order[s]
            below[i] = True
            x += load[i, 0]
            y += load[i, 1]
            for m in range(begin[i], begin[i + 1]):
                c = member[m]
                if below[contacts[c, 0] + contacts[c, 1] - i]:
                    held -= strength[c]
                else:
                    held += strength[c]
            magnitude = math.hypot(x, y)
            if held < least * magnitude:
                least = held / magnitude
    return least
