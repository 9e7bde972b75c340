"""How fast an aggregate can turn at most if its contacts hold sideways too.

`cut_bound` lets each contact of a cut pull with its pull-off force F_C and no more. A contact also holds up
to F_S = k_s zeta_c sideways before it slides, whatever its normal force, and pushes without limit. A cut whose
contacts cannot bear the load with all of that cannot hold, so that the least omega of all cuts is a bound for the
aggregate as it stands. Only torques are left out, which could make it less. Where F_S is above F_C, as for all monomers
from 10 nm on of the materials of the paper, it lies above the cut bound.
"""

import math

import numpy as np
import pandas as pd

from ratd.aggregates.files import read_grains
from ratd.base.jit import jit
from ratd.experiments.spin_up.cut_bound import contact_strengths, plane_normals, plane_of_rotation
from ratd.experiments.spin_up.printed import PAPER
from ratd.geometry.shape import centre_of_mass
from ratd.laws.contact_constants import equilibrium_contact_radius, reduced_radius
from ratd.laws.tangential import sliding_limit, sliding_stiffness
from ratd.pipeline.kinds import Kind, as_dataset, entries, register

__all__ = [
    "FIRM_BOUND_COLUMNS",
    "QUARTER",
    "bridge_pulls",
    "firm_bound",
    "least_firm_bridge",
    "least_firm_plane",
    "slide_forces",
    "table",
]

QUARTER = 0.25
"""Part of the mass whose loss is the mark "a quarter"."""
FIRM_BOUND_COLUMNS = {
    "material": ("", "material"),
    "type": ("", "BA, BAM1 or BAM2"),
    "a_eff": ("m", "radius of the sphere of the same volume of matter"),
    "seed": ("1", "seed of the grain"),
    "firm_bound": (
        "rad s-1",
        "angular velocity above which the weakest cut gives way though its contacts hold sideways and push as well",
    ),
    "firm_bound_quarter": (
        "rad s-1",
        "the same of the cuts that leave a quarter of the mass or more on either side; inf where there is none",
    ),
}
"""Units and meaning of the columns of the table of firm bounds."""


def firm_bound(grain, axis=None, *, least_part=0.0, directions=500):
    """Bound on the angular velocity that an aggregate as it stands can hold, whatever its contacts do.

    Parameters
    ----------
    grain : Grain
        Or anything with its attributes position, radius, mass, contacts and material.
    axis : (3,) array_like, optional
        As for `cut_bound`.
    least_part : float, optional
        Only cuts that leave this part of the mass or more on either side. With `QUARTER` the bound is that of the mark
        "a quarter" of a grain that is whole: above it the weakest of these cuts gives way, and no piece has 3/4 of it.
    directions : int, optional
        Number of directions of cutting planes.

    Returns
    -------
    float
        omega [rad s-1]; inf where no contact is alone in a cut and every plane has one that pushes.

    Notes
    -----
    The part cut off needs the force -Q, with Q = M omega^2 r its pull. Let theta be the angle at a contact between Q
    and the line of centres, pointing out of the rest. Along Q the contact holds at most F_C cos(theta) + F_S
    sin(theta), and any force where theta is above a right angle, because it pushes then. A single contact bears Q by
    itself, its normal part with F_C and the other with F_S, which is stricter. The cuts are those of
    `cut_bound`: every contact that alone holds two parts together, and planes.

    What is needed is balance of forces. Balance of torques, which rolling contacts hardly help, asks for more.
    """
    across = np.stack(plane_of_rotation(grain, axis), axis=1)
    position = grain.position - centre_of_mass(grain.position, grain.mass)
    load = np.ascontiguousarray(grain.mass[:, None] * (position @ across))
    share = grain.mass / grain.mass.sum()
    first, second = grain.contacts.T
    apart = position[second] - position[first]
    normal = np.ascontiguousarray((apart / np.linalg.norm(apart, axis=1)[:, None]) @ across)
    pull = contact_strengths(grain.radius, grain.contacts, grain.material.surface_energy)
    slide = slide_forces(reduced_radius(grain.radius[first], grain.radius[second]), grain.material)
    cut = (load, share, grain.contacts, normal, pull, slide)
    bridge = least_firm_bridge(*cut, least_part)
    return math.sqrt(min(bridge, least_firm_plane(position, *cut, plane_normals(directions), least_part)))


def slide_forces(R, material):
    """F_S = k_s zeta_c [N], the force sideways at which a contact slides.

    Parameters
    ----------
    R : float or ndarray
        Reduced radius [m].
    material : Material

    Returns
    -------
    float or ndarray
        Eq. 13 at the limit zeta_c of sliding; with both in the form of `ratd.laws.tangential` G r_0^2/(4 pi).
    """
    r0 = equilibrium_contact_radius(R, material.surface_energy, material.reduced_modulus)
    nu = material.poisson_number
    stiffness = sliding_stiffness(r0, material.shear_modulus / (2.0 * (2.0 - nu)))
    return stiffness * sliding_limit(r0, nu)


def bridge_pulls(load, contacts):
    """Contacts that alone hold two parts together, and the pull of the part beyond.

    Parameters
    ----------
    load : (n, d) float64 array
        What is summed, such as the load of `cut_bound.least_bridge_cut`.
    contacts
        As there.

    Returns
    -------
    bridges : (b,) int64 array
        Which contacts they are.
    beyond : (b,) int64 array
        0 or 1: which end of the contact is in the part beyond.
    pulls : (b, d) float64 array
        Sum of the loads of the part beyond.

    Notes
    -----
    Over a tree that reaches all monomers the loads are summed from its ends on. Each contact outside of the tree has a
    power of two of its own, counted with opposite signs at its two ends: the sum beyond a contact of the tree is 0 only
    where no other contact leads back.
    """
    # not at the head: the registry of all files reads this module, and every job would wait for scipy
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import breadth_first_order

    n = len(load)
    graph = coo_array((np.ones(len(contacts)), contacts.T), shape=(n, n)).tocsr()
    order, above = breadth_first_order(graph, 0, directed=False)
    pull, other, up = load.copy(), [0] * n, [-1] * n
    for c, (i, j) in enumerate(contacts.tolist()):
        if above[i] == j:
            up[i] = c
        elif above[j] == i:
            up[j] = c
        else:
            other[i] += 1 << c
            other[j] -= 1 << c
    found = []
    for i in order[:0:-1].tolist():
        if other[i] == 0:
            found.append((up[i], int(contacts[up[i], 1] == i), i))
        pull[above[i]] += pull[i]
        other[above[i]] += other[i]
    bridges, beyond, end = np.array(found, dtype=np.int64).reshape(-1, 3).T
    return bridges, beyond, pull[end]


def least_firm_bridge(load, share, contacts, normal, pull, slide, least_part):
    """Least omega^2 [rad2 s-2] at which a contact that alone holds two parts together gives way; inf without one.

    Parameters
    ----------
    load : (n, 2) float64 array
        Of `cut_bound.least_bridge_cut` [kg m].
    share : (n,) float64 array
        Mass of each monomer over that of the grain.
    contacts : (k, 2) int array
    normal : (k, 2) float64 array
        Part of the unit vector from the first to the second monomer of a contact in the plane normal to the axis.
    pull, slide : (k,) float64 array
        F_C and F_S of each contact [N].
    least_part : float
        See `firm_bound`.
    """
    bridges, beyond, sums = bridge_pulls(np.column_stack([load, share]), contacts)
    pulls, part = sums[:, :2], sums[:, 2]
    size = np.linalg.norm(pulls, axis=1)
    known = (size > 0) & (np.minimum(part, 1.0 - part) >= least_part)
    bridges, beyond, pulls, size = bridges[known], beyond[known], pulls[known], size[known]
    if not len(bridges):
        return math.inf
    out = normal[bridges] * np.where(beyond == 1, 1.0, -1.0)[:, None]
    cosine = np.sum(out * pulls, axis=1) / size
    sine = np.sqrt(np.maximum(0.0, 1.0 - cosine**2))
    with np.errstate(divide="ignore"):
        along = np.where(cosine > 0, pull[bridges] / cosine, np.inf)
        sideways = slide[bridges] / sine
    return float(np.min(np.minimum(along, sideways) / size))


@jit
def least_firm_plane(position, load, share, contacts, normal, pull, slide, planes, least_part):
    """Least omega^2 at which all contacts across a plane together give way.

    Parameters
    ----------
    position : (n, 3) float64 array
        Centres [m].
    load, share, contacts, normal, pull, slide
        As in `least_firm_bridge`.
    planes : (d, 3) float64 array
        Normals of the planes; of each, every plane that divides the centres differently is tried.
    least_part : float
        See `firm_bound`.

    Returns
    -------
    float
        [rad2 s-2]; inf where no plane leaves a pull or all have a contact that pushes.
    """
    n = position.shape[0]
    least = math.inf
    rank = np.empty(n, dtype=np.int64)
    for d in range(planes.shape[0]):
        height = position[:, 0] * planes[d, 0] + position[:, 1] * planes[d, 1] + position[:, 2] * planes[d, 2]
        order = np.argsort(height, kind="mergesort")
        for s in range(n):
            rank[order[s]] = s
        # A contact holds no less than the smaller one of its two forces: most planes need no closer look.
        held = np.zeros(n + 1)
        for c in range(contacts.shape[0]):
            i, j = rank[contacts[c, 0]], rank[contacts[c, 1]]
            held[min(i, j)] += min(pull[c], slide[c])
            held[max(i, j)] -= min(pull[c], slide[c])
        x, y, at_least, part = 0.0, 0.0, 0.0, 0.0
        for s in range(n - 1):
            x += load[order[s], 0]
            y += load[order[s], 1]
            at_least += held[s]
            part += share[order[s]]
            if min(part, 1.0 - part) < least_part:
                continue
            size = math.hypot(x, y)
            if not at_least < least * size:
                continue
            capacity = 0.0
            for c in range(contacts.shape[0]):
                below = rank[contacts[c, 0]] <= s
                if below == (rank[contacts[c, 1]] <= s):
                    continue
                # The part below pulls with (x, y); its contacts point out of the rest towards it.
                cosine = (normal[c, 0] * x + normal[c, 1] * y) / size * (-1.0 if below else 1.0)
                if cosine < 0.0:
                    capacity = math.inf
                    break
                capacity += pull[c] * cosine + slide[c] * math.sqrt(max(0.0, 1.0 - cosine * cosine))
            if capacity < least * size:
                least = capacity / size
    return least


def table(files, settings, say):
    """The table of the firm bounds of all grains of some files.

    Parameters
    ----------
    files : sequence of path-like
        Grains as grown.
    settings : dict
        Empty.
    say : callable
        Called with a sentence.

    Returns
    -------
    dict
        Name of an output -> what it holds.
    """
    rows = []
    for path in files:
        for grain in read_grains(path):
            bounds = firm_bound(grain), firm_bound(grain, least_part=QUARTER)
            own = (grain.material.name, grain.type, grain.a_eff, float(grain.seed), *bounds)
            rows.append(dict(zip(FIRM_BOUND_COLUMNS, own, strict=True)))
        say(f"{len(rows)} grains, the last ones from {path}")
    return {"firm_bounds": as_dataset(pd.DataFrame(rows))}


register(
    "firm_bounds",
    Kind(
        "Bounds from cuts whose contacts hold sideways and push",
        entries(FIRM_BOUND_COLUMNS),
        references=PAPER,
        places=("firm_bounds/{material}/{type}.nc",),
    ),
)
