"""How monomers are spread in space."""

import numpy as np
from scipy.spatial import cKDTree

__all__ = ["cumulative_number", "radius_of_gyration"]


def radius_of_gyration(position, mass):
    """r_g = (sum m |x - x_cm|^2/sum m)^(1/2) [m] of points (n, 3) [m] with masses (n,)."""
    centre = mass @ position / mass.sum()
    return float(np.sqrt(mass @ ((position - centre) ** 2).sum(axis=1) / mass.sum()))


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
    Sect. 3.6 of Kataoka et al. (2013). Trees of the centres and of all images within reach are counted against each
    other.
    """
    edges = np.asarray(edges, dtype=float)
    reach = distance[-1]
    images = position
    if edges[0] > 0.0:
        position = position - edges * np.round(position / edges)
        numbers = [np.arange(-n, n + 1) * edge for n, edge in zip(np.ceil(reach / edges + 0.5), edges, strict=True)]
        shifts = np.stack(np.meshgrid(*numbers, indexing="ij"), axis=-1).reshape(-1, 3)
        # one shift after the other, so that what is out of reach takes no room
        near = (position + shift for shift in shifts)
        images = np.concatenate([each[(np.abs(each) <= 0.5 * edges + reach).all(axis=1)] for each in near])
    return cKDTree(position).count_neighbors(cKDTree(images), distance) / len(position)
