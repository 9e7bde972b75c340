"""A grain that is set in motion and left to itself."""

import numpy as np

__all__ = ["random_motion"]


def random_motion(grain, speed, spin, omega=0.0):
    """Velocities and spins of the monomers of a grain that vibrates and turns, its centre of mass at rest.

    Parameters
    ----------
    grain : ratd.Grain
        Its seed is that of the random numbers.
    speed, spin : float
        Standard deviation of each component of the velocities [m/s] and spins [rad/s].
    omega : float
        Angular velocity [rad/s] of the whole about z.

    Returns
    -------
    velocity, spin : (n, 3) float64 arrays
        [m/s], [rad/s]
    """
    noise = np.random.default_rng(grain.seed).normal(size=(2, grain.n_monomers, 3))
    axis = np.array([0.0, 0.0, omega])
    velocity = speed * noise[0] + np.cross(axis, grain.position)
    velocity -= grain.mass @ velocity / grain.mass.sum()
    return velocity, spin * noise[1] + axis
