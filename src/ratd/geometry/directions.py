"""Random directions, for compiled code and the generators of numpy."""

import math

from ratd.base.jit import jit

__all__ = ["normal_to", "random_direction", "random_normal"]


@jit
def random_direction(rng):
    """Unit vector (x, y, z) uniformly distributed over the sphere."""
    z = 2.0 * rng.random() - 1.0
    angle = 2.0 * math.pi * rng.random()
    s = math.sqrt(1.0 - z * z)
    return s * math.cos(angle), s * math.sin(angle), z


@jit
def normal_to(x, y, z):
    """A unit vector normal to the unit vector (x, y, z): to the axis farthest from it as well."""
    if abs(x) <= abs(y) and abs(x) <= abs(z):
        ux, uy, uz = 0.0, z, -y
    elif abs(y) <= abs(z):
        ux, uy, uz = -z, 0.0, x
    else:
        ux, uy, uz = y, -x, 0.0
    length = math.sqrt(ux * ux + uy * uy + uz * uz)
    return ux / length, uy / length, uz / length


@jit
def random_normal(x, y, z, rng):
    """Unit vector uniformly distributed over the circle normal to the unit vector (x, y, z)."""
    ux, uy, uz = normal_to(x, y, z)
    vx, vy, vz = y * uz - z * uy, z * ux - x * uz, x * uy - y * ux
    angle = 2.0 * math.pi * rng.random()
    c, s = math.cos(angle), math.sin(angle)
    return c * ux + s * vx, c * uy + s * vy, c * uz + s * vz
