"""Slow, obvious forms of what the compiled geometry does, to test it against."""

import itertools

import numpy as np


def close_pairs(position, radius, reach):
    """Every pair, one after the other."""
    pairs = []
    for i, j in itertools.combinations(range(len(radius)), 2):
        if np.sqrt(np.sum((position[i] - position[j]) ** 2)) < radius[i] + radius[j] + reach:
            pairs.append((i, j))
    return np.array(pairs, dtype=np.int64).reshape(-1, 2)


def connected_components(n, pairs):
    """Spread a label from each monomer that has none yet."""
    label = np.full(n, -1)
    for first in range(n):
        if label[first] >= 0:
            continue
        piece = {first}
        while True:
            wider = piece | {int(b) for a, b in pairs if a in piece} | {int(a) for a, b in pairs if b in piece}
            if wider == piece:
                break
            piece = wider
        label[sorted(piece)] = label.max() + 1
    return label


def inertia_tensor(position, mass, radius):
    """Sum over monomers of their own moment and that of a point (Steiner), in matrix form."""
    centre = np.average(position, axis=0, weights=mass)
    tensor = np.zeros((3, 3))
    for x, m, a in zip(position - centre, mass, radius, strict=True):
        tensor += m * (x @ x * np.eye(3) - np.outer(x, x)) + 0.4 * m * a**2 * np.eye(3)
    return tensor


def first_touch(start, d, distance, position):
    """Way to the first touch and the monomer touched, where touching j means the centres are distance[j] apart."""
    best, hit = np.inf, -1
    for j, x in enumerate(position - start):
        along = x @ d
        aside2 = x @ x - along**2
        if aside2 < distance[j] ** 2 and along - np.sqrt(distance[j] ** 2 - aside2) < best:
            best, hit = along - np.sqrt(distance[j] ** 2 - aside2), j
    return best, hit


def roll(centre, e, f, s, distance, position, steps):
    """First of many small steps on a circle after which the monomer is closer to another than distance[j]."""
    for angle in np.linspace(0.0, 2.0 * np.pi, steps, endpoint=False):
        place = centre + s * (np.cos(angle) * e + np.sin(angle) * f)
        close = np.linalg.norm(position - place, axis=1) < distance
        if np.any(close):
            return angle, int(np.argmax(close))
    return np.inf, -1


def cut(load, contacts, strength, part):
    """omega^2 at which the contacts between a part (bool per monomer) and the rest break together."""
    held = sum(f for (i, j), f in zip(contacts, strength, strict=True) if part[i] != part[j])
    pull = np.linalg.norm(load[part].sum(axis=0))
    return held / pull if pull > 0.0 else np.inf


def least_cut(load, contacts, strength):
    """Least of `cut` over all 2^(n-1) - 1 ways to divide the monomers in two."""
    n = len(load)
    parts = (np.array([*bits, False]) for bits in itertools.product([False, True], repeat=n - 1) if any(bits))
    return min(cut(load, contacts, strength, part) for part in parts)


def least_bridge_cut(load, contacts, strength):
    """Least of `cut` over the contacts without which the aggregate is in two pieces."""
    n = len(load)
    least = np.inf
    for c in range(len(contacts)):
        label = connected_components(n, np.delete(contacts, c, axis=0))
        if label.max() == 1:
            least = min(least, cut(load, contacts, strength, label == 0))
    return least


def close_images(position, radius, reach, edges):
    """Every pair and every image that may be near: (i, j, n_x, n_y, n_z) with |x_i - x_j + n L| small.

    Of a sphere and its own copies those whose first number that is not 0 is positive.
    """
    found = set()
    for i, j in itertools.combinations_with_replacement(range(len(radius)), 2):
        d = position[i] - position[j]
        home = -np.round(d / edges)
        limit = radius[i] + radius[j] + reach
        spans = [np.arange(-m, m + 1) for m in np.ceil(limit / edges).astype(int) + 1]
        shifts = home + np.array(np.meshgrid(*spans)).reshape(3, -1).T
        for n in shifts[np.linalg.norm(d + shifts * edges, axis=1) < limit].astype(int):
            if i < j or tuple(n) > (0, 0, 0):
                found.add((i, j, *map(int, n)))
    return found
