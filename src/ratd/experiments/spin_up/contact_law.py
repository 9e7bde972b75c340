"""The contact law of a spin-up in words, and the printed formulae of contacts.

The printed formulae stand here and nowhere else: nothing computes with them that does not say so.
"""

from ratd.laws.jkr_with_springs import jkr

__all__ = ["CONTACT_FORMULAE", "PRINTED", "contact_law", "printed_factors"]

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
