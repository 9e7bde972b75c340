"""The contact law of a spin-up in words, and the printed formulae of contacts.

The printed formulae stand here and nowhere else: nothing computes with them that does not say so.
"""

from ratd.base.materials import sphere_mass
from ratd.laws.contact_constants import equilibrium_contact_radius
from ratd.laws.jkr_with_springs import jkr
from ratd.laws.tangential import TWISTING_LIMIT, twisting_stiffness

__all__ = ["CONTACT_FORMULAE", "PRINTED", "contact_law", "printed_factors", "printed_twist"]

CONTACT_FORMULAE = ("sliding_stiffness", "sliding_limit", "twisting_stiffness")
"""Formulae of a contact that are not used as printed; options of `ratd.laws.jkr`."""
PRINTED = "printed"
"""For all of them as in the paper."""


def contact_law(words, poisson_number):
    """The law that a config names, see `run.law` in config/README.md.

    Parameters
    ----------
    words : dict or None
        ``normal_force``, an option of `ratd.laws.jkr`; ``formulae``: `PRINTED` for all of `CONTACT_FORMULAE` as
        printed, and no damping, as in Eq. 29.
    poisson_number : float
        nu of the material of the grains.

    Returns
    -------
    ratd.laws.jkr_with_springs.JKR or None
        None, the law of the model, where nothing is said.
    """
    if words is None:
        return None
    options = {name: value for name, value in words.items() if name != "formulae"}
    if words.get("formulae") == PRINTED:
        options["damping"] = "none"
        for formula in CONTACT_FORMULAE:
            options |= printed_factors(formula, poisson_number)
    return jkr(**options)


def printed_factors(formula, poisson_number):
    """Factors with which one formula of a contact is as printed.

    Parameters
    ----------
    formula : str
        One of `CONTACT_FORMULAE`, or any other word.
    poisson_number : float
        nu of the material of the grains.

    Returns
    -------
    dict of str to float
        Options of `ratd.laws.jkr`; none where the formula is not one of contacts.

    Notes
    -----
    Printed over ours: G/(2 - 2 nu^2) over G/(2 (2 - nu)) (Eq. 13); 1 - nu over 2 - nu; G/(2 - 2 nu^2) over G/2
    (Eq. 17).
    """
    nu = poisson_number
    values = (2.0 - nu) / (1.0 - nu**2), (1.0 - nu) / (2.0 - nu), 1.0 / (1.0 - nu**2)
    factors = dict(zip(CONTACT_FORMULAE, values, strict=True))
    return {formula: factors[formula]} if formula in factors else {}


def printed_twist(radius, material):
    """Angular acceleration with which two equal monomers that touch turn against each other by Eq. 17 as printed.

    Parameters
    ----------
    radius : float
        Of both [m].
    material : ratd.Material

    Returns
    -------
    float
        d(omega_i - omega_j)/dt along n_c, once the twist has grown to its limit [rad/s2].

    Notes
    -----
    The plus sign of Eq. 17 lets the torque act with the twist, so that the smallest twist grows to the limit phi_c =
    1/(16 pi), where the torque k_t phi_c stays. Of each of the two monomers the moment of inertia is I = 2/5 m a^2,
    hence 2 k_t phi_c/I, with the printed k_t = 16/3 G* r0^3, G* = G/(2 - 2 nu^2).
    """
    r0 = equilibrium_contact_radius(0.5 * radius, material.surface_energy, material.reduced_modulus)
    stiffness = twisting_stiffness(r0, material.shear_modulus / (2.0 - 2.0 * material.poisson_number**2))
    inertia = 0.4 * sphere_mass(radius, material.density) * radius**2
    return 2.0 * stiffness * TWISTING_LIMIT / inertia
