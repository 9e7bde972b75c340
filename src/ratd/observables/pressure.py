"""Pressure of a periodic box: kinetic part and virial."""

import numpy as np

from ratd.engine.layout import MASS, VIRIAL, VX
from ratd.engine.state import monomer_rows

COMPONENTS = ("xx", "yy", "zz", "xy", "xz", "yz")


def volume(state, box):
    """Volume of the box [m3]."""
    return float(np.prod(box.edges(state.scalar)))


def pressure_tensor(state, box):
    """P_ab = (1/V)(sum m u_a u_b + sum over contacts of d_(a F_b)) [Pa] of the last step.

    F is the full force with damping, d = X_i - X_j, u the peculiar velocity (Kataoka et al. 2013, Eq. 21, as a tensor).

    Returns
    -------
    (6,) float64 array
        In the order of `COMPONENTS`.
    """
    rows = monomer_rows(state)
    u = rows[:, VX : VX + 3]
    moving = np.einsum("k,ka,kb->ab", rows[:, MASS], u, u)
    kinetic = moving[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
    return (kinetic + state.scalar[VIRIAL : VIRIAL + 6]) / volume(state, box)


def pressure(tensor):
    """P = (P_xx + P_yy + P_zz)/3 [Pa]."""
    return float(np.sum(tensor[:3]) / 3.0)
