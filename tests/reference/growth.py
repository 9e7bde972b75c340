"""Slow, plain growth of aggregates of equal hard spheres, and their porosity; nothing is imported from ratd.

Written from a description of ballistic aggregation with migration (Shen, Draine & Johnson 2008) by someone who did not
know the code of ratd. Spheres have the radius 1. A sphere comes in on a straight line and stays where it touches (BA),
rolls the shortest way to a second touch (BAM1), and from there over both the shorter way to a third (BAM2); where there
is none it is thrown away.

    PYTHONPATH=tests python -m reference.growth    # all of docs/validation/data/growth_reference.csv, twenty minutes
"""

import sys

import numpy as np

NUMBERS = (32, 128, 256, 512)
TYPES = ("BA", "BAM1", "BAM2")
AGGREGATES = 200


def grow(kind, n, rng):
    """Centres of n spheres, (n, 3) array."""
    centres, count = np.zeros((n, 3)), 1
    while count < n:
        there = centres[:count]
        middle = there.mean(axis=0)
        # every line on which something can be touched passes through this disc
        widest = np.sqrt(((there - middle) ** 2).sum(axis=1).max()) + 2.0
        way = _unit(rng)
        one, other = _normals(way)
        aside, angle = widest * np.sqrt(rng.random()), 2 * np.pi * rng.random()
        hit = first_touch(there, middle + aside * (np.cos(angle) * one + np.sin(angle) * other), way)
        if hit is None:
            continue
        place, j = hit
        if kind != "BA" and count >= 2:
            place, k = roll_over(there, place, j)
            if kind == "BAM2" and count >= 3:
                place = roll_over_both(there, place, j, k)
        if place is None:
            continue
        centres[count] = place
        count += 1
    return centres


def _unit(rng):
    vector = rng.normal(size=3)
    return vector / np.sqrt(vector @ vector)


def _normals(vector):
    """Two unit vectors normal to one."""
    one = np.cross(vector, np.eye(3)[np.argmin(abs(vector))])
    one /= np.sqrt(one @ one)
    return one, np.cross(vector, one)


def first_touch(centres, start, way):
    """Where a sphere on a line first touches another, and which; None where it meets none."""
    apart = centres - start
    along = apart @ way
    below = 4.0 - ((apart * apart).sum(axis=1) - along * along)
    if not (below > 0).any():
        return None
    t = np.where(below > 0, along - np.sqrt(np.where(below > 0, below, 0)), np.inf)
    j = int(np.argmin(t))
    return start + t[j] * way, j


def roll_over(centres, place, j):
    """Where a sphere on sphere j first touches a second one on the shortest way, and which that is."""
    up = (place - centres[j]) / 2.0
    best, least = None, np.inf
    for k in np.flatnonzero(((centres - centres[j]) ** 2).sum(axis=1) <= 16.0):
        if k == j:
            continue
        axis = centres[k] - centres[j]
        distance = np.sqrt(axis @ axis)
        axis = axis / distance
        # seen from j, the places that touch k too lie on a circle of this angle around the axis
        opening = np.arccos(min(distance / 4, 1.0))
        side = up - (up @ axis) * axis
        height = np.sqrt(side @ side)
        angle = abs(np.arctan2(height, up @ axis) - opening)
        if angle < least:
            least = angle
            best = centres[j] + 2 * (np.cos(opening) * axis + np.sin(opening) * side / height), int(k)
    return best


def roll_over_both(centres, place, j, k):
    """Where a sphere on the spheres j and k first touches a third, on the shorter way; None where it never does."""
    middle = (centres[j] + centres[k]) / 2
    one = place - middle
    radius = np.sqrt(one @ one)
    one = one / radius
    axis = centres[k] - centres[j]
    other = np.cross(axis / np.sqrt(axis @ axis), one)
    angles = []
    for third in np.flatnonzero(((centres - middle) ** 2).sum(axis=1) <= (2 + radius + 1e-9) ** 2):
        if third in (j, k):
            continue
        apart = centres[third] - middle
        along, across = apart @ one, apart @ other
        level, height = (radius * radius + apart @ apart - 4) / (2 * radius), np.hypot(along, across)
        if abs(level) <= height:
            towards, half = np.arctan2(across, along), np.arccos(level / height)
            angles += [towards - half, towards + half]
    if not angles:
        return None
    onward, back = min(np.mod(angles, 2 * np.pi)), min(np.mod(np.negative(angles), 2 * np.pi))
    angle = onward if onward <= back else -back
    return middle + radius * (np.cos(angle) * one + np.sin(angle) * other)


def porosity(centres):
    """1 - a_eff^3/(abc), from the moments of inertia with those of the spheres themselves; 0 for a single sphere."""
    n, mass = len(centres), 4 * np.pi / 3
    apart = centres - centres.mean(axis=0)
    inertia = mass * ((apart * apart).sum() * np.eye(3) - apart.T @ apart) + n * 0.4 * mass * np.eye(3)
    size = n ** (1 / 3)
    third, second, first = 15 / (8 * np.pi) * np.linalg.eigvalsh(inertia)[::-1][[0, 1, 2]] / size**5
    return 1 - 1 / np.sqrt((second + first - third) * (first + third - second) * (third + second - first))


def row(kind, n, aggregates, seed):
    """Mean porosity and its standard error, a line of the table."""
    rng = np.random.default_rng(seed)
    found = [porosity(grow(kind, n, rng)) for _ in range(aggregates)]
    return f"{kind},{n},{aggregates},{seed},{np.mean(found):.5f},{np.std(found, ddof=1) / np.sqrt(aggregates):.5f}"


def main():
    """Write the whole table."""
    print("type,n_monomers,aggregates,seed,porosity,error")
    for place, (kind, n) in enumerate((kind, n) for kind in TYPES for n in NUMBERS):
        print(row(kind, n, AGGREGATES, place), flush=True)


if __name__ == "__main__":
    sys.exit(main())
