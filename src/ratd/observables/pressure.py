"""Pressure of a periodic box: kinetic part and virial."""

import numpy as np

from ratd.drives.squeezing import KINETIC, SUM_STEPS, SUM_TENSOR
from ratd.engine.layout import VIRIAL

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
    kinetic = state.drive[KINETIC : KINETIC + 6]
    return (kinetic + state.scalar[VIRIAL : VIRIAL + 6]) / volume(state, box)


def mean_pressure_tensor(state, box):
    """Mean of V P_ab over the steps since the last call, over the volume now [Pa], (6,); starts a new mean."""
    steps = state.drive[SUM_STEPS]
    mean = state.drive[SUM_TENSOR : SUM_TENSOR + 6] / max(steps, 1.0) / volume(state, box)
    state.drive[SUM_STEPS : SUM_TENSOR + 6] = 0.0
    return mean


def pressure(tensor):
    """P = (P_xx + P_yy + P_zz)/3 [Pa]."""
    return float(np.sum(tensor[:3]) / 3.0)
