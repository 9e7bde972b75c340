"""Ballistic aggregation: monomers come in on straight lines and stay, or roll on to a second or third contact.

All here is compiled; `ratd.aggregates.growth` is the way in.
"""

import math

import numpy as np

from ratd.base.jit import jit
from ratd.geometry.directions import random_direction, random_normal
from ratd.laws.contact_constants import touching_distance

__all__ = ["place_monomers"]

_MOST_HITS = 20_000
"""Hits on the aggregate after which a monomer that finds no place with all its contacts makes do with one fewer."""


@jit
def _bucket(cx, cy, cz, mask):
    """Place of a cell in the table of cells."""
    h = cx * np.int64(73856093) ^ cy * np.int64(19349663) ^ cz * np.int64(83492791)
    return (h ^ (h >> 17)) & mask


@jit
def _cell(x, size):
    return np.int64(math.floor(x / size))


@jit
def _insert(i, position, size, head, follower):
    """Enter monomer i into the table of cells."""
    b = _bucket(
        _cell(position[i, 0], size), _cell(position[i, 1], size), _cell(position[i, 2], size), head.shape[0] - 1
    )
    follower[i] = head[b]
    head[b] = i


@jit
def _first_touch(start, d, a, position, radius, widest, box, size, head, follower, surface_energy, reduced_modulus):
    """First monomer that a monomer touches on a straight way.

    Parameters
    ----------
    start : (3,) float64 array
        Where its centre starts [m], outside the aggregate.
    d : (3,) float64 array
        Unit vector of its way.
    a : float
        Its radius [m].
    position, radius : arrays
        Monomers; those entered in the table of cells count.
    widest : float
        Greatest radius among them [m].
    box : (2, 3) float64 array
        Least and greatest coordinates of their centres [m].
    size, head, follower
        Edge of the cells [m]; first monomer of each place of the table, next one of each monomer (-1: none).
    surface_energy, reduced_modulus : float
        gamma [J m-2] and E* [Pa].

    Returns
    -------
    t : float
        Way to the touch [m]; inf for a miss.
    hit : int
        Monomer touched; -1 for a miss.

    Notes
    -----
    The cells are visited in layers normal to the coordinate axis k nearest to the way, in the order of the way. Of a
    layer, only cells count that hold a centre within a + widest of the line: at the same coordinate along k such a
    centre is no farther from the line than (a + widest)/|d_k|. A touch lies at most a + widest before the layer of
    the centre, so that the search ends where no later layer can do better.
    """
    k = 0
    if abs(d[1]) > abs(d[k]):
        k = 1
    if abs(d[2]) > abs(d[k]):
        k = 2
    p = (k + 1) % 3
    q = (k + 2) % 3
    mask = head.shape[0] - 1
    margin = (a + widest) / abs(d[k])
    low_layer = _cell(box[0, k], size)
    high_layer = _cell(box[1, k], size)
    step = 1 if d[k] > 0.0 else -1
    layer = low_layer if step > 0 else high_layer
    cell = np.zeros(3, dtype=np.int64)
    best = math.inf
    hit = -1
    while low_layer <= layer <= high_layer:
        t_in = ((layer if step > 0 else layer + 1) * size - start[k]) / d[k]
        if t_in - margin > best:
            break
        t_out = t_in + size / abs(d[k])
        p_in, p_out = start[p] + t_in * d[p], start[p] + t_out * d[p]
        q_in, q_out = start[q] + t_in * d[q], start[q] + t_out * d[q]
        p_low = _cell(max(min(p_in, p_out) - margin, box[0, p]), size)
        p_high = _cell(min(max(p_in, p_out) + margin, box[1, p]), size)
        q_low = _cell(max(min(q_in, q_out) - margin, box[0, q]), size)
        q_high = _cell(min(max(q_in, q_out) + margin, box[1, q]), size)
        cell[k] = layer
        for cp in range(p_low, p_high + 1):
            cell[p] = cp
            for cq in range(q_low, q_high + 1):
                cell[q] = cq
                j = head[_bucket(cell[0], cell[1], cell[2], mask)]
                while j >= 0:
                    # Monomers of other cells in the same place of the table do no harm here.
                    x = position[j, 0] - start[0]
                    y = position[j, 1] - start[1]
                    z = position[j, 2] - start[2]
                    along = x * d[0] + y * d[1] + z * d[2]
                    aside2 = x * x + y * y + z * z - along * along
                    if aside2 < (a + radius[j]) ** 2 and along - a - radius[j] < best:
                        s = touching_distance(a, radius[j], surface_energy, reduced_modulus)
                        if aside2 < s * s:
                            t = along - math.sqrt(s * s - aside2)
                            if t < best:
                                best = t
                                hit = j
                    j = follower[j]
        layer += step
    return best, hit


@jit
def _near(x, y, z, reach, position, radius, widest, size, head, follower, near):
    """Write the monomers with |X_k - (x, y, z)| < reach + a_k into `near`; returns how many."""
    mask = head.shape[0] - 1
    margin = reach + widest
    count = 0
    for cx in range(_cell(x - margin, size), _cell(x + margin, size) + 1):
        for cy in range(_cell(y - margin, size), _cell(y + margin, size) + 1):
            for cz in range(_cell(z - margin, size), _cell(z + margin, size) + 1):
                k = head[_bucket(cx, cy, cz, mask)]
                while k >= 0:
                    dx = position[k, 0] - x
                    dy = position[k, 1] - y
                    dz = position[k, 2] - z
                    if (
                        dx * dx + dy * dy + dz * dz < (reach + radius[k]) ** 2
                        and _cell(position[k, 0], size) == cx
                        and _cell(position[k, 1], size) == cy
                        and _cell(position[k, 2], size) == cz
                    ):
                        near[count] = k
                        count += 1
                    k = follower[k]
    return count


@jit
def _turn(along, across, level):
    """Least angle in [0, 2 pi) at which along cos t + across sin t rises through level; inf where it never does."""
    height2 = along * along + across * across
    if level * level >= height2:
        return math.inf
    t = math.atan2(across, along) - math.acos(level / math.sqrt(height2))
    if t < 0.0:
        t += 2.0 * math.pi
    return t


@jit
def _roll(centre, e, f, s, a, skip, near, count, position, radius, surface_energy, reduced_modulus):
    """Roll a monomer on a circle until it touches another.

    Parameters
    ----------
    centre : (3,) float64 array
        Middle of the circle [m].
    e, f : (3,) float64 array
        Unit vectors from the middle to where the monomer is, and of its way there.
    s : float
        Radius of the circle [m].
    a : float
        Radius of the monomer [m].
    skip : tuple of two int
        Monomers that it rolls over.
    near, count
        Monomers that it may touch.

    Returns
    -------
    angle : float
        How far it rolls [rad]; inf where it touches nothing.
    hit : int
        Monomer touched.
    """
    angle = math.inf
    hit = -1
    for c in range(count):
        k = near[c]
        if k == skip[0] or k == skip[1]:
            continue
        x = position[k, 0] - centre[0]
        y = position[k, 1] - centre[1]
        z = position[k, 2] - centre[2]
        reach = touching_distance(a, radius[k], surface_energy, reduced_modulus)
        # |s (e cos t + f sin t) - D|^2 = reach^2
        t = _turn(
            x * e[0] + y * e[1] + z * e[2],
            x * f[0] + y * f[1] + z * f[2],
            (s * s + x * x + y * y + z * z - reach * reach) / (2.0 * s),
        )
        if t < angle:
            angle = t
            hit = k
    return angle, hit


@jit
def _go_to(place, centre, e, f, s, angle):
    """Move `place` to an angle on the circle of radius s around `centre`, from e towards f."""
    for axis in range(3):
        place[axis] = centre[axis] + s * (math.cos(angle) * e[axis] + math.sin(angle) * f[axis])


@jit
def _way_to_nearest(e, s, a, j, near, count, position, radius, surface_energy, reduced_modulus, f):
    """Direction f in which a monomer rolls over monomer j the shortest way to a second contact; False if none exists.

    A place of contact with j and k lies on a circle around the line from j to k, and the nearest one in the plane of
    that line and the monomer.
    """
    best = math.inf
    for c in range(count):
        k = near[c]
        if k == j:
            continue
        x = position[k, 0] - position[j, 0]
        y = position[k, 1] - position[j, 1]
        z = position[k, 2] - position[j, 2]
        along = x * e[0] + y * e[1] + z * e[2]
        reach = touching_distance(a, radius[k], surface_energy, reduced_modulus)
        across2 = x * x + y * y + z * z - along * along
        level = (s * s + x * x + y * y + z * z - reach * reach) / (2.0 * s)
        if across2 <= 0.0:
            continue
        across = math.sqrt(across2)
        t = _turn(along, across, level)
        if t < best:
            best = t
            f[0] = (x - along * e[0]) / across
            f[1] = (y - along * e[1]) / across
            f[2] = (z - along * e[2]) / across
    return best < math.inf


@jit
def place_monomers(radius, surface_energy, reduced_modulus, migrations, nearest, rng):
    """Places of monomers that arrive one after the other.

    Parameters
    ----------
    radius : (n,) float64 array
        Radii [m] in the order of arrival, n >= 1.
    surface_energy, reduced_modulus : float
        gamma [J m-2] and E* [Pa].
    migrations : int
        0 (BA), 1 (BAM1) or 2 (BAM2).
    nearest : bool
        Migrate the shortest way rather than in a random direction.
    rng : numpy.random.Generator
        Source of random numbers.

    Returns
    -------
    (n, 3) float64 array
        Centres [m]; the first monomer is in the origin.

    Notes
    -----
    The monomers placed so far stand in a table of cubic cells as wide as the largest monomer, found by a hash of the
    cell's numbers, so that the aggregate may grow anywhere. Both the search along a line and that around a monomer
    look only at cells on the way.
    """
    n = radius.shape[0]
    widest = np.max(radius)
    size = 2.0 * widest
    places = 16
    while places < 2 * n:
        places *= 2
    head = np.full(places, -1)
    follower = np.full(n, -1)
    near = np.empty(n, dtype=np.int64)
    position = np.zeros((n, 3))
    box = np.zeros((2, 3))
    # A sphere that holds all monomers. It is widened just enough for each that sticks out, which makes it a little
    # larger than the smallest one; that costs misses only.
    ball = np.zeros(3)
    ball_radius = radius[0]
    start = np.empty(3)
    place = np.empty(3)
    centre = np.empty(3)
    d = np.empty(3)
    e = np.empty(3)
    f = np.empty(3)
    _insert(0, position, size, head, follower)

    for i in range(1, n):
        a = radius[i]
        wanted = min(migrations, i - 1)
        hits = 0
        while True:
            d[0], d[1], d[2] = random_direction(rng)
            f[0], f[1], f[2] = random_normal(d[0], d[1], d[2], rng)
            aside = (ball_radius + a) * math.sqrt(rng.random())
            for axis in range(3):
                start[axis] = ball[axis] - (ball_radius + a) * d[axis] + aside * f[axis]
            t, j = _first_touch(
                start, d, a, position, radius, widest, box, size, head, follower, surface_energy, reduced_modulus
            )
            if j < 0:
                continue
            for axis in range(3):
                place[axis] = start[axis] + t * d[axis]
            hits += 1
            if hits == _MOST_HITS:
                hits = 0
                wanted -= 1

            # All that follows happens in touch with monomer j.
            s = touching_distance(a, radius[j], surface_energy, reduced_modulus)
            x, y, z = position[j, 0], position[j, 1], position[j, 2]
            count = _near(x, y, z, s + a, position, radius, widest, size, head, follower, near)
            if wanted >= 1:
                for axis in range(3):
                    e[axis] = (place[axis] - position[j, axis]) / s
                if not nearest:
                    f[0], f[1], f[2] = random_normal(e[0], e[1], e[2], rng)
                elif not _way_to_nearest(e, s, a, j, near, count, position, radius, surface_energy, reduced_modulus, f):
                    continue
                angle, k = _roll(
                    position[j], e, f, s, a, (j, j), near, count, position, radius, surface_energy, reduced_modulus
                )
                if k < 0:
                    continue
                _go_to(place, position[j], e, f, s, angle)
            if wanted >= 2:
                angle = _roll_over_two(
                    place, s, a, j, k, nearest, near, count, position, radius, surface_energy, reduced_modulus, rng,
                    centre, e, f,
                )  # fmt: skip
                if angle == math.inf:
                    continue
            if _is_free(place, a, near, count, position, radius, surface_energy, reduced_modulus):
                break

        for axis in range(3):
            position[i, axis] = place[axis]
        _insert(i, position, size, head, follower)
        reach = 0.0
        for axis in range(3):
            box[0, axis] = min(box[0, axis], place[axis])
            box[1, axis] = max(box[1, axis], place[axis])
            reach += (place[axis] - ball[axis]) ** 2
        reach = math.sqrt(reach)
        if reach + a > ball_radius:
            wider = 0.5 * (ball_radius + reach + a) * (1.0 + 1e-12)
            for axis in range(3):
                ball[axis] += (place[axis] - ball[axis]) * ((wider - ball_radius) / reach)
            ball_radius = wider
    return position


@jit
def _roll_over_two(
    place, s, a, j, k, nearest, near, count, position, radius, surface_energy, reduced_modulus, rng, centre, e, f
):
    """Roll a monomer that touches j and k until it touches a third: moves `place`, returns the angle (inf: none)."""
    distance2 = 0.0
    for axis in range(3):
        f[axis] = position[k, axis] - position[j, axis]
        distance2 += f[axis] * f[axis]
    reach = touching_distance(a, radius[k], surface_energy, reduced_modulus)
    along = (s * s + distance2 - reach * reach) / (2.0 * distance2)
    s = math.sqrt(max(s * s - along * along * distance2, 0.0))
    for axis in range(3):
        centre[axis] = position[j, axis] + along * f[axis]
        e[axis] = (place[axis] - centre[axis]) / s
    # The third direction, normal to both the axis from j to k and e.
    length = math.sqrt(distance2)
    fx, fy, fz = f[0] / length, f[1] / length, f[2] / length
    f[0], f[1], f[2] = fy * e[2] - fz * e[1], fz * e[0] - fx * e[2], fx * e[1] - fy * e[0]
    if not nearest and rng.random() < 0.5:
        f[0], f[1], f[2] = -f[0], -f[1], -f[2]
    angle, hit = _roll(centre, e, f, s, a, (j, k), near, count, position, radius, surface_energy, reduced_modulus)
    if nearest:
        f[0], f[1], f[2] = -f[0], -f[1], -f[2]
        back, hit = _roll(centre, e, f, s, a, (j, k), near, count, position, radius, surface_energy, reduced_modulus)
        if back < angle:
            angle = back
        else:
            f[0], f[1], f[2] = -f[0], -f[1], -f[2]
    if angle < math.inf:
        _go_to(place, centre, e, f, s, angle)
    return angle


@jit
def _is_free(place, a, near, count, position, radius, surface_energy, reduced_modulus):
    """Whether a monomer there is no closer to any other than in equilibrium, but for rounding."""
    for c in range(count):
        k = near[c]
        x = position[k, 0] - place[0]
        y = position[k, 1] - place[1]
        z = position[k, 2] - place[2]
        least = touching_distance(a, radius[k], surface_energy, reduced_modulus) * (1.0 - 1e-10)
        if x * x + y * y + z * z < least * least:
            return False
    return True
