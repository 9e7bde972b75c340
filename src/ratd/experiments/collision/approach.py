"""Two clusters on their way to each other: how they are turned, placed and set in motion."""

import numpy as np

from ratd.base.jit import jit

__all__ = ["approach", "first_touch", "random_turn"]


def random_turn(rng):
    """Rotation matrix (3, 3), uniformly distributed, from the unit quaternion of four normal numbers (Muller 1959)."""
    w, x, y, z = (q := rng.normal(size=4)) / np.linalg.norm(q)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


@jit
def first_touch(position_a, radius_a, position_b, radius_b, gap):
    """How far b is to be moved along x for the least gap between a and b to be `gap` [m], b coming from +x.

    Parameters
    ----------
    position_a, position_b : (n, 3), (m, 3) float64 array
        Centres [m].
    radius_a, radius_b : (n,), (m,) float64 array
        Radii [m].
    gap : float
        [m]

    Returns
    -------
    float
        Shift [m]; -inf where b passes a by.
    """
    shift = -np.inf
    for i in range(radius_a.shape[0]):
        for j in range(radius_b.shape[0]):
            y = position_a[i, 1] - position_b[j, 1]
            z = position_a[i, 2] - position_b[j, 2]
            reach = radius_a[i] + radius_b[j] + gap
            left = reach * reach - y * y - z * z
            if left > 0.0:
                shift = max(shift, position_a[i, 0] - position_b[j, 0] + np.sqrt(left))
    return shift


def approach(a, b, velocity, impact_parameter, gap, seed):
    """Two clusters, turned at random each on its own, `gap` apart and flying at each other along x.

    Parameters
    ----------
    a, b : ratd.Grain
    velocity : float
        Of one against the other [m/s]; the centre of mass of both rests.
    impact_parameter : float
        Distance of the two lines on which their centres of mass fly, in the sum of the radii of the two clusters, from
        the centre of mass to the farthest surface.
    gap : float
        Least distance of two surfaces [m].
    seed : int
        Of the rotations.

    Returns
    -------
    position, velocities : (n + m, 3) float64 array
        [m] and [m/s], first those of a; the centre of mass of both is in the origin.
    meet : bool
        False where they pass each other on straight lines, if only by less than `gap`.
    """
    rng = np.random.Generator(np.random.PCG64(np.random.SeedSequence(int(seed))))
    places = []
    for cluster in (a, b):
        centred = cluster.position - cluster.mass @ cluster.position / cluster.mass.sum()
        places.append(centred @ random_turn(rng).T)
    reach = sum(
        np.max(np.linalg.norm(place, axis=1) + cluster.radius) for place, cluster in zip(places, (a, b), strict=True)
    )
    places[1][:, 1] += impact_parameter * reach
    shift = first_touch(places[0], a.radius, places[1], b.radius, gap)
    meet = bool(np.isfinite(first_touch(places[0], a.radius, places[1], b.radius, 0.0)))
    if not np.isfinite(shift):
        # those that pass by more than the gap begin with it along x between them
        shift = (places[0][:, 0] + a.radius).max() - (places[1][:, 0] - b.radius).min() + gap
    places[1][:, 0] += shift
    masses = a.mass.sum(), b.mass.sum()
    position = np.concatenate(places)
    mass = np.concatenate([a.mass, b.mass])
    position -= mass @ position / mass.sum()
    velocities = np.zeros_like(position)
    velocities[: len(a.radius), 0] = velocity * masses[1] / sum(masses)
    velocities[len(a.radius) :, 0] = -velocity * masses[0] / sum(masses)
    return position, velocities, meet
