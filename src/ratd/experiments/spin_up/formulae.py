"""What single formulae of the paper change, where the consistent model does not use them as printed.

`use` puts one printed formula in the place of that of the model, in this process only, before any code that needs it is
compiled. Code compiled with it is kept in a cache of its own, so that no other process meets it. The printed formulae
stand here and nowhere else: nothing but this study computes with them.
"""

import hashlib
import math
import sys
from pathlib import Path

import numba

from ratd.base import jit as _accelerate
from ratd.laws import tangential

__all__ = ["use"]


def use(formula, poisson_number):
    """Compute with one formula as printed for the rest of this process.

    Parameters
    ----------
    formula : str
        A name of `ratd.experiments.spin_up.formula_table.FORMULAE`.
    poisson_number : float
        nu of the material of all grains that follow, since Eq. 17 of the model does not need it and that of the
        paper does.

    Raises
    ------
    RuntimeError
        If the engine was loaded before, with the formulae of the model.
    """
    if "ratd.engine.contacts" in sys.modules:
        raise RuntimeError("the engine is loaded already: choose the formula before anything imports it")
    printed = _printed(poisson_number)
    if formula in printed:
        text = hashlib.sha256(Path(__file__).read_bytes()).hexdigest()[:16]
        numba.config.CACHE_DIR += f"-{formula}-{poisson_number!r}-{text}"
        setattr(tangential, formula, _accelerate.jit(printed[formula]))


def _printed(nu):
    """The printed formulae, with the arguments of those in `ratd.laws.tangential`; G* = G/(2 - 2 nu^2)."""
    softening = 2.0 - 2.0 * nu * nu

    def sliding_stiffness(equilibrium_contact_radius, shear_modulus, poisson_number):
        return 8.0 * equilibrium_contact_radius * shear_modulus / softening

    def sliding_limit(equilibrium_contact_radius, poisson_number):
        return equilibrium_contact_radius * (1.0 - nu) / (16.0 * math.pi)

    def twisting_stiffness(equilibrium_contact_radius, shear_modulus):
        return 16.0 / 3.0 * shear_modulus / softening * equilibrium_contact_radius**3

    return {function.__name__: function for function in (sliding_stiffness, sliding_limit, twisting_stiffness)}
