"""How monomers are spread in space."""

import numpy as np

from ratd.base.jit import jit

__all__ = ["cumulative_number", "radius_of_gyration"]


def radius_of_gyration(position, mass):
    """r_g = (sum m |x - x_cm|^2/sum m)^(1/2) [m] of points (n, 3) [m] with masses (n,)."""
    centre = mass @ position / mass.sum()
    return float(np.sqrt(mass @ ((position - centre) ** 2).sum(axis=1) / mass.sum()))


@jit
def cumulative_number(position, edges, distance):
    """N(<r): mean number of centres within r of a centre, itself included, with all images of a periodic box.

    Parameters
    ----------
    position : (n, 3) float64 array
        Centres [m].
    edges : tuple of float
        Edges of the box along x, y, z [m]; 0 in open space.
    distance : (m,) float64 array
        r [m], ascending.

    Returns
    -------
    (m,) float64 array

    Notes
    -----
    Sect. 3.6 of Kataoka et al. (2013). Cost n^2 times the images within reach.
    """
    n = position.shape[0]
    count = np.zeros(distance.shape[0] + 1)
    reach = distance[-1]
    images = np.zeros(3, dtype=np.int64)
    if edges[0] > 0.0:
        for axis in range(3):
            images[axis] = np.int64(np.ceil(reach / edges[axis])) + 1
    for i in range(n):
        for j in range(i, n):
            d = np.empty(3)
            for axis in range(3):
                d[axis] = position[i, axis] - position[j, axis]
                if edges[0] > 0.0:
                    d[axis] -= edges[axis] * np.round(d[axis] / edges[axis])
            weight = 1.0 if i == j else 2.0
            for nx in range(-images[0], images[0] + 1):
                dx = d[0] + nx * edges[0]
                for ny in range(-images[1], images[1] + 1):
                    dy = d[1] + ny * edges[1]
                    for nz in range(-images[2], images[2] + 1):
                        dz = d[2] + nz * edges[2]
                        r = np.sqrt(dx * dx + dy * dy + dz * dz)
                        if r <= reach:
                            count[np.searchsorted(distance, r)] += weight
    return np.cumsum(count)[:-1] / n
