"""Places of the monomers of a cluster that grows by ballistic cluster-cluster aggregation: the compiled part."""

import math

import numpy as np

from ratd.base.jit import jit
from ratd.geometry.directions import normal_to, random_direction, random_normal
from ratd.laws.contact_constants import touching_distance

__all__ = ["first_touch", "join_clusters"]

_FINEST = 1024
"""Greatest number of cells along an edge of the table of shadows."""


@jit
def first_touch(moving, moving_radius, still, still_radius, direction, surface_energy, reduced_modulus):
    """How far a cluster flies along a direction until it touches another.

    Parameters
    ----------
    moving, still : (n, 3), (m, 3) float64 array
        Centres [m].
    moving_radius, still_radius : (n,), (m,) float64 array
        Radii [m].
    direction : (3,) float64 array
        Unit vector of the flight.
    surface_energy, reduced_modulus : float
        gamma [J m-2] and E* [Pa]; two monomers touch at a_i + a_j - delta_0.

    Returns
    -------
    float
        The way [m], also below 0; inf where the clusters miss each other.

    Notes
    -----
    Two monomers can only meet where their shadows along the direction overlap. The shadows of the cluster at rest stand
    in a table of square cells as wide as the two largest monomers side by side.
    """
    x, y, z = direction
    ex, ey, ez = normal_to(x, y, z)
    fx, fy, fz = y * ez - z * ey, z * ex - x * ez, x * ey - y * ex
    m = still.shape[0]
    shadow = np.empty((m, 3))
    low_e, high_e, low_f, high_f = math.inf, -math.inf, math.inf, -math.inf
    for k in range(m):
        e = still[k, 0] * ex + still[k, 1] * ey + still[k, 2] * ez
        f = still[k, 0] * fx + still[k, 1] * fy + still[k, 2] * fz
        shadow[k, 0] = e
        shadow[k, 1] = f
        shadow[k, 2] = still[k, 0] * x + still[k, 1] * y + still[k, 2] * z
        low_e, high_e = min(low_e, e), max(high_e, e)
        low_f, high_f = min(low_f, f), max(high_f, f)
    reach = np.max(moving_radius) + np.max(still_radius)
    size = max(reach, (high_e - low_e) / _FINEST, (high_f - low_f) / _FINEST)
    wide = int((high_e - low_e) / size) + 1
    high = int((high_f - low_f) / size) + 1
    head = np.full((wide, high), -1)
    follower = np.empty(m, dtype=np.int64)
    for k in range(m):
        c = int((shadow[k, 0] - low_e) / size)
        d = int((shadow[k, 1] - low_f) / size)
        follower[k] = head[c, d]
        head[c, d] = k

    way = math.inf
    for i in range(moving.shape[0]):
        e = moving[i, 0] * ex + moving[i, 1] * ey + moving[i, 2] * ez
        f = moving[i, 0] * fx + moving[i, 1] * fy + moving[i, 2] * fz
        along = moving[i, 0] * x + moving[i, 1] * y + moving[i, 2] * z
        c = math.floor((e - low_e) / size)
        d = math.floor((f - low_f) / size)
        for cc in range(max(c - 1, 0), min(c + 2, wide)):
            for dd in range(max(d - 1, 0), min(d + 2, high)):
                k = head[cc, dd]
                while k >= 0:
                    beside = (shadow[k, 0] - e) ** 2 + (shadow[k, 1] - f) ** 2
                    if beside < (moving_radius[i] + still_radius[k]) ** 2:
                        touch = touching_distance(moving_radius[i], still_radius[k], surface_energy, reduced_modulus)
                        if beside < touch * touch:
                            way = min(way, shadow[k, 2] - along - math.sqrt(touch * touch - beside))
                    k = follower[k]
    return way


@jit
def _turn_at_random(position, rng):
    """Turn points (n, 3) about the origin, in place, uniformly over all turns."""
    x, y, z = random_direction(rng)
    ux, uy, uz = random_normal(x, y, z, rng)
    vx, vy, vz = y * uz - z * uy, z * ux - x * uz, x * uy - y * ux
    for k in range(position.shape[0]):
        a, b, c = position[k, 0], position[k, 1], position[k, 2]
        position[k, 0] = a * x + b * ux + c * vx
        position[k, 1] = a * y + b * uy + c * vy
        position[k, 2] = a * z + b * uz + c * vz


@jit
def _centre(position, radius):
    """Put the centre of mass of spheres into the origin, in place; the radius of a sphere around it that holds all."""
    mass = 0.0
    centre = np.zeros(3)
    for k in range(position.shape[0]):
        m = radius[k] ** 3
        mass += m
        for axis in range(3):
            centre[axis] += m * position[k, axis]
    out = 0.0
    for k in range(position.shape[0]):
        square = 0.0
        for axis in range(3):
            position[k, axis] -= centre[axis] / mass
            square += position[k, axis] ** 2
        out = max(out, math.sqrt(square) + radius[k])
    return out


@jit
def _collide(moving, moving_radius, still, still_radius, out, surface_energy, reduced_modulus, rng):
    """Shoot a cluster at another until it hits, and leave it where it touches; `out` is the sum of their radii."""
    start = np.empty(moving.shape)
    direction = np.empty(3)
    while True:
        x, y, z = random_direction(rng)
        nx, ny, nz = random_normal(x, y, z, rng)
        aside = out * math.sqrt(rng.random())
        direction[0], direction[1], direction[2] = x, y, z
        for k in range(moving.shape[0]):
            start[k, 0] = moving[k, 0] + aside * nx
            start[k, 1] = moving[k, 1] + aside * ny
            start[k, 2] = moving[k, 2] + aside * nz
        way = first_touch(start, moving_radius, still, still_radius, direction, surface_energy, reduced_modulus)
        if way < math.inf:
            for k in range(moving.shape[0]):
                for axis in range(3):
                    moving[k, axis] = start[k, axis] + way * direction[axis]
            return


@jit
def join_clusters(radius, surface_energy, reduced_modulus, copies, rng):
    """Places of monomers that join by twos, their pairs by twos, and so on.

    Parameters
    ----------
    radius : (n,) float64 array
        Radii [m], n a power of 2; neighbours in the list join first.
    surface_energy, reduced_modulus : float
        gamma [J m-2] and E* [Pa].
    copies : bool
        Whether a cluster meets a copy of itself, turned at random, in place of another one.
    rng : numpy.random.Generator

    Returns
    -------
    (n, 3) float64 array
        Centres [m], the centre of mass in the origin.
    """
    n = radius.shape[0]
    position = np.zeros((n, 3))
    half = 1
    while half < n:
        for begin in range(0, n, 2 * half):
            still, still_radius = position[begin : begin + half], radius[begin : begin + half]
            moving, moving_radius = position[begin + half : begin + 2 * half], radius[begin + half : begin + 2 * half]
            if copies:
                for k in range(half):
                    for axis in range(3):
                        moving[k, axis] = still[k, axis]
            _turn_at_random(moving, rng)
            out = _centre(still, still_radius) + _centre(moving, moving_radius)
            _collide(moving, moving_radius, still, still_radius, out, surface_energy, reduced_modulus, rng)
            if copies:
                break
        half *= 2
    _centre(position, radius)
    return position
