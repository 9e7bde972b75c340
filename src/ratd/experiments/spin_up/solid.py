"""A grain under the printed equations, the drive literal: how it turns, and where a solid one parts."""

from functools import cache

import numpy as np
from scipy.integrate import solve_ivp

SOLID_END = 2.5
"""omega/q (1 - share)^(2/3) by which Omega of `solid_omega` has grown without end, which it does at 1.515."""


def turned_by_spins(omega, share, axis_b, axis_c):
    """Angular velocity in the inertial frame of a grain that nothing but its spins turns (exact Coriolis term).

    Parameters
    ----------
    omega : array_like, shape (n,)
        Of the frame [rad/s].
    share : float
        `ratd.geometry.shape.spin_share` of the grain at rest.
    axis_b, axis_c : array_like, shape (n,)
        Middle and longest semi-axis [m]; the first is that at rest.

    Returns
    -------
    numpy.ndarray, shape (n,)
        [rad/s], I_spin omega/I_1.

    Notes
    -----
    The spins' missing Euler term gives the grain the angular momentum I_spin omega, whatever its shape. The moment of
    inertia I_1 = M/5 (b^2 + c^2) grows where the grain stretches, and it then turns slower, as long as it keeps its
    mass.
    """
    moment = np.square(axis_b) + np.square(axis_c)
    return share * np.asarray(omega) * moment[0] / moment


@cache  # the document asks for the same grains in several places
def solid_omega(threshold, share, acceleration, timestep):
    """Angular velocity of the frame at which a solid grain parts under the printed equations, explicit Coriolis term.

    Parameters
    ----------
    threshold : float
        Angular velocity in the inertial frame at which it parts [rad/s].
    share : float
        `ratd.geometry.shape.spin_share`.
    acceleration : float
        d omega/dt [rad/s2].
    timestep : float
        dt [s].

    Returns
    -------
    omega : float
        [rad/s]; NaN for a threshold that is NaN.
    backwards : bool
        Whether the grain then turns against the frame.

    Notes
    -----
    In the frame a solid grain that turns with Omega in the inertial one has the velocity (Omega - omega) x X and the
    acceleration -(omega - Omega)^2 X. The velocity half a step before lags by dt/2 times that, and the Coriolis term
    makes of the lag the force m omega (omega - Omega)^2 dt along the circle, backwards. With the spins' missing Euler
    term, and s the share,

        d Omega/dt = s d omega/dt - (1 - s) omega (omega - Omega)^2 dt.

    In units of q = (d omega/dt / dt)^(1/3) neither d omega/dt nor dt is left: omega/q where |Omega| is the threshold
    depends on s and threshold/q alone. So omega ~ q for grains in which threshold/q is the same. For threshold << q,
    omega^4 = 4 threshold q^3/(1 - s), a fourth root; for threshold >> q it is q times a number, at which Omega grows
    without end.
    """
    if not np.isfinite(threshold):
        return np.nan, False
    unit = (acceleration / timestep) ** (1 / 3)

    def slope(omega, turning):
        return share - (1.0 - share) * omega * (omega - turning) ** 2

    def parts(_, turning):
        return abs(turning[0]) - threshold / unit

    parts.terminal = True
    found = solve_ivp(slope, (0.0, SOLID_END * (1.0 - share) ** (-2 / 3)), [0.0], events=parts, rtol=1e-9, atol=1e-12)
    return float(found.t[-1] * unit), bool(found.y[0, -1] < 0.0)
