"""What two materials are to each other: the elastic constants of a contact between them."""

import math
from typing import NamedTuple

from ratd.base.jit import jit

SURFACE_ENERGY, YOUNGS_MODULUS, POISSON, ROLLING_LIMIT, VISCOUS_TIME = range(5)
"""Where the constants of a material stand in its row, see `material_row`."""


class MaterialPair(NamedTuple):
    """Constants of a contact between two materials.

    Attributes
    ----------
    surface_energy : float
        gamma [J m-2]: half the work of adhesion; sqrt(gamma_i gamma_j) for two materials.
    reduced_modulus : float
        E* [Pa], 1/E* = (1 - nu_i^2)/E_i + (1 - nu_j^2)/E_j (Eq. 9 of Reissl et al. 2024).
    sliding_modulus : float
        G* [Pa], 1/G* = (2 - nu_i)/G_i + (2 - nu_j)/G_j (Mindlin 1949).
    twisting_modulus : float
        G' [Pa], 1/G' = 1/G_i + 1/G_j.
    poisson_number : float
        nu [1], the mean.
    rolling_limit : float
        xi_c [m], the mean.
    viscosity : float
        T_vis/nu^2 [s], the mean (Eq. 22).
    """

    surface_energy: float
    reduced_modulus: float
    sliding_modulus: float
    twisting_modulus: float
    poisson_number: float
    rolling_limit: float
    viscosity: float


def material_row(material):
    """The constants of a material that a law needs, in the order of the numbers above.

    Parameters
    ----------
    material : ratd.Material

    Returns
    -------
    list of float
    """
    return [
        material.surface_energy,
        material.youngs_modulus,
        material.poisson_number,
        material.critical_rolling_displacement,
        material.viscous_time,
    ]


@jit
def material_pair(first, second):
    """`MaterialPair` of two rows of constants, each (5,), see `material_row`."""
    nu_i, nu_j = first[POISSON], second[POISSON]
    soft_i = 1.0 / first[YOUNGS_MODULUS]
    soft_j = 1.0 / second[YOUNGS_MODULUS]
    shear_i = 2.0 * (1.0 + nu_i) * soft_i
    shear_j = 2.0 * (1.0 + nu_j) * soft_j
    return MaterialPair(
        math.sqrt(first[SURFACE_ENERGY] * second[SURFACE_ENERGY]),
        1.0 / ((1.0 - nu_i * nu_i) * soft_i + (1.0 - nu_j * nu_j) * soft_j),
        1.0 / ((2.0 - nu_i) * shear_i + (2.0 - nu_j) * shear_j),
        1.0 / (shear_i + shear_j),
        0.5 * (nu_i + nu_j),
        0.5 * (first[ROLLING_LIMIT] + second[ROLLING_LIMIT]),
        0.5 * (first[VISCOUS_TIME] / (nu_i * nu_i) + second[VISCOUS_TIME] / (nu_j * nu_j)),
    )
