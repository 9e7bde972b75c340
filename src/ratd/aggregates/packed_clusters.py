"""Round clusters of spheres of given radii (Umstaetter & Urbassek 2020, A&A 633, A24, Sect. 2.3).

The spheres come in the order of their radii, the largest first. Each is attached to a random one that is there, in a
random direction, such that the contact is at rest by the law of Derjaguin, Muller & Toporov. A place is given up where
the sphere would overlap another or stick out of the cluster. A part of the spheres then rolls over the partner until it
touches a second one: without that every cluster is a tree, of one contact less than it has spheres.
"""

import math

import numpy as np

from ratd.aggregates.ballistic import _turn
from ratd.aggregates.grain import Grain
from ratd.aggregates.radii import radii_array
from ratd.base.checks import check_seed, is_number
from ratd.base.errors import InputError
from ratd.base.jit import jit
from ratd.base.materials import get_material
from ratd.geometry.directions import random_direction, random_normal
from ratd.laws.contact_constants import reduced_radius
from ratd.laws.derjaguin_muller_toporov import adhesion_force, equilibrium_overlap, hertz_stiffness

__all__ = ["build_cluster", "filling_factor", "number_of_equal_mass"]

MOST_TRIES = 20_000
"""Places that are tried for one sphere before the cluster is begun anew."""
MOST_STARTS = 20
"""Clusters that are begun before the radii are said not to fit."""
TRIES_TO_ROLL = 2_000
"""Places that are tried for one sphere that is to have two contacts before it makes do with one."""


def filling_factor(radii, cluster_radius):
    """phi = sum r^3/R^3 [1] of spheres of some radii in a cluster of the radius R [m]."""
    return math.fsum(np.asarray(radii, dtype=float) ** 3) / cluster_radius**3


def number_of_equal_mass(radius, total_cube):
    """Number of spheres of one radius [m] whose radii cubed add up to `total_cube` [m3], as near as it gets."""
    return max(2, round(total_cube / radius**3))


def build_cluster(radii, radius, material="silica", *, second_contact=0.0, seed=0):
    """Build a round cluster of given spheres.

    Parameters
    ----------
    radii : (n,) array_like
        Radii of the spheres [m], n at least 2, in any order.
    radius : float
        Radius of the cluster [m]: no sphere sticks out of it.
    material : str or Material
    second_contact : float
        p, the part of the spheres, 0 to 1, that roll over their partner to a second contact.
    seed : int
        At least 0.

    Returns
    -------
    ratd.Grain
        Of the type "cluster"; spheres in the order in which they were placed, the largest first, and the centre of
        mass in the origin. All contacts are at rest by the law of DMT, so that the cluster is.

    Raises
    ------
    InputError
        If an argument is wrong, or if the spheres do not fit. The number of tries is bounded, and the sentence says
        which filling factor was reached.

    Notes
    -----
    The first sphere is at the centre where the second one then fits beside it, and anywhere else where not: with an
    MRN sample the largest one at the centre leaves too little room in about half of all cases.
    """
    material = get_material(material)
    radii = _checked(radii, radius, second_contact, seed)
    order = np.sort(radii)[::-1].copy()
    rng = np.random.Generator(np.random.PCG64(np.random.SeedSequence([int(seed), len(radii)])))
    rolls = rng.random(len(radii)) < second_contact
    best = 0.0
    for _ in range(MOST_STARTS):
        position, placed = _place(order, float(radius), material.surface_energy, material.reduced_modulus, rolls, rng)
        if placed == len(order):
            mass = order**3
            return Grain(position - mass @ position / mass.sum(), order, material, type="cluster", seed=int(seed))
        best = max(best, filling_factor(order[:placed], radius))
    raise InputError(
        f"radius is {radius:g} m; the spheres do not fit: they need a filling factor phi of "
        f"{filling_factor(order, radius):.3g}, and in {MOST_STARTS} clusters none got beyond {best:.3g}. Take "
        f"{radius * (filling_factor(order, radius) / max(best, 1e-3)) ** (1 / 3):.3g} m or more, or fewer spheres."
    )


def _checked(radii, radius, second_contact, seed):
    """Radii as an array; one sentence for the first argument that is wrong."""
    radii = radii_array(radii)
    if not (is_number(radius) and radius > 0.0):
        raise InputError(f"radius is {radius!r}; it must be a number above 0, in m.")
    if not (is_number(second_contact) and 0.0 <= second_contact <= 1.0):
        raise InputError(f"second_contact is {second_contact!r}; it must be a number from 0 to 1.")
    check_seed(seed)
    largest, second = np.sort(radii)[::-1][:2]
    if largest + second > radius:
        raise InputError(
            f"radius is {radius:g} m; the two largest spheres, of {largest:g} m and {second:g} m, do not fit in: "
            f"it must be at least {largest + second:g} m."
        )
    return radii


@jit
def resting_distance(a_i, a_j, surface_energy, reduced_modulus):
    """Distance [m] of the centres of two spheres at rest by the law of DMT, a_i + a_j - delta_eq."""
    r = reduced_radius(a_i, a_j)
    return a_i + a_j - equilibrium_overlap(hertz_stiffness(r, reduced_modulus), adhesion_force(r, surface_energy))


@jit
def _place(radius, outer, surface_energy, reduced_modulus, rolls, rng):
    """Places of spheres of descending radii in a sphere of the radius `outer`, and how many found one.

    Parameters
    ----------
    radius : (n,) float64 array
        [m]
    outer : float
        [m]
    surface_energy, reduced_modulus : float
        gamma [J m-2] and E* [Pa].
    rolls : (n,) array of bool
        Which of them roll to a second contact.
    rng : numpy.random.Generator

    Returns
    -------
    position : (n, 3) float64 array
    placed : int
    """
    n = radius.shape[0]
    position = np.zeros((n, 3))
    place = np.zeros(3)
    if radius[0] + 2.0 * radius[1] > outer:
        x, y, z = random_direction(rng)
        # far enough from the centre for the second, which may reach to the other side
        least = min(max(radius[0] + 2.0 * radius[1] - outer, 0.0), outer - radius[0])
        shift = (least**3 + rng.random() * ((outer - radius[0]) ** 3 - least**3)) ** (1.0 / 3.0)
        position[0, 0], position[0, 1], position[0, 2] = shift * x, shift * y, shift * z
    for k in range(1, n):
        a = radius[k]
        found = False
        for attempt in range(MOST_TRIES):
            j = np.int64(rng.random() * k)
            s = resting_distance(a, radius[j], surface_energy, reduced_modulus)
            second = -1
            x, y, z = random_direction(rng)
            if rolls[k] and k > 1 and attempt < TRIES_TO_ROLL:
                ux, uy, uz = random_normal(x, y, z, rng)
                angle, second = _second_touch(
                    (x, y, z), (ux, uy, uz), s, a, j, k, position, radius, surface_energy, reduced_modulus
                )
                if second < 0:
                    continue
                c, t = math.cos(angle), math.sin(angle)
                x, y, z = c * x + t * ux, c * y + t * uy, c * z + t * uz
            place[0] = position[j, 0] + s * x
            place[1] = position[j, 1] + s * y
            place[2] = position[j, 2] + s * z
            inside = math.sqrt(place[0] ** 2 + place[1] ** 2 + place[2] ** 2) + a <= outer
            if inside and _is_free(place, a, (j, second), k, position, radius):
                found = True
                break
        if not found:
            return position, k
        for axis in range(3):
            position[k, axis] = place[axis]
    return position, n


@jit
def _second_touch(e, f, s, a, j, count, position, radius, surface_energy, reduced_modulus):
    """How far a sphere rolls over sphere j, from e towards f, until it touches another.

    Parameters
    ----------
    e, f : tuple of float
        Unit vectors from j to the sphere, and of its way.
    s : float
        Distance of the two [m].
    a : float
        Radius of the sphere [m].
    j, count : int
        The partner, and how many spheres there are.

    Returns
    -------
    angle : float
        [rad]; inf where it touches none.
    second : int
        The one that it touches; -1 for none.
    """
    least = math.inf
    second = -1
    for k in range(count):
        if k == j:
            continue
        x = position[k, 0] - position[j, 0]
        y = position[k, 1] - position[j, 1]
        z = position[k, 2] - position[j, 2]
        square = x * x + y * y + z * z
        # beyond that they never meet
        if square > (s + a + radius[k]) ** 2:
            continue
        reach = resting_distance(a, radius[k], surface_energy, reduced_modulus)
        level = (s * s + square - reach * reach) / (2.0 * s)
        angle = _turn(x * e[0] + y * e[1] + z * e[2], x * f[0] + y * f[1] + z * f[2], level)
        if angle < least:
            least, second = angle, k
    return least, second


@jit
def _is_free(place, a, partners, count, position, radius):
    """Whether a sphere at a place overlaps none but its partners, two of which may be the same or -1."""
    for k in range(count):
        if k == partners[0] or k == partners[1]:
            continue
        x = position[k, 0] - place[0]
        y = position[k, 1] - place[1]
        z = position[k, 2] - place[2]
        if x * x + y * y + z * z < (a + radius[k]) ** 2:
            return False
    return True
