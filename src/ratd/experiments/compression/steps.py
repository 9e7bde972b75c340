"""The steps of a compression: long ones while the aggregate is loose, explicit ones where monomers crowd."""

from typing import NamedTuple

from ratd.base.checks import is_number
from ratd.base.errors import InputError
from ratd.engine.leapfrog import leapfrog
from ratd.engine.semi_implicit import semi_implicit
from ratd.laws.contact_constants import equilibrium_compression

__all__ = ["LongSteps", "integrators"]

ROLLED = 2 / 3
"""Part of the critical rolling displacement by which a contact may roll in a long step at most, so that none rolls past
its limit from rest."""


class LongSteps(NamedTuple):
    """Long steps with the semi-implicit integrator, up to some filling factor.

    Attributes
    ----------
    longest : float
        The longest step over t_0.
    displacement : float
        How far a monomer may move in a step against the box, and against one in contact, over the equilibrium
        compression delta_0 of two. Monomers that move farther meet with an overlap that costs work. Where the critical
        rolling displacement is small it allows less, see `ROLLED`.
    calming : float
        See `ratd.engine.semi_implicit.semi_implicit`.
    landing : float
        The longest step over t_0 where two monomers meet, see there. The default is about that of an explicit step, and
        keeps the balance of energy to some 0.05 % of the work at a filling factor of 0.1.
    until_phi : float
        Filling factor from which on the explicit step takes over. There each monomer touches several others, and the
        matrix of a long step costs more than it saves.
    """

    longest: float = 30.0
    displacement: float = 0.5
    calming: float = 0.1
    landing: float = 0.2
    until_phi: float = 0.2


def integrators(material, radius, time_unit, timestep_factor, long_steps):
    """The integrators of a compression.

    Parameters
    ----------
    material : Material
    radius : float
        r_0 [m].
    time_unit : float
        t_0 [s].
    timestep_factor : float
        f of the explicit step.
    long_steps : LongSteps or None

    Returns
    -------
    first, explicit : parts
        The one to begin with and the one to end with; the same where there are no long steps.

    Raises
    ------
    InputError
    """
    explicit = leapfrog(timestep_factor=timestep_factor)
    if long_steps is None:
        return explicit, explicit
    if not isinstance(long_steps, LongSteps):
        raise InputError(f"long_steps is {long_steps!r}; it must be a ratd.LongSteps, or None for explicit steps.")
    for name in ("longest", "displacement", "landing", "until_phi"):
        value = getattr(long_steps, name)
        if not (is_number(value) and value > 0.0):
            raise InputError(f"long_steps.{name} is {value!r}; it must be a number above 0.")
    natural = equilibrium_compression(0.5 * radius, material.surface_energy, material.reduced_modulus)
    displacement = min(long_steps.displacement * natural, ROLLED * material.critical_rolling_displacement)
    longest = long_steps.longest * time_unit
    how = {"displacement": displacement, "travel": displacement, "calming": long_steps.calming}
    return semi_implicit(longest=longest, landing=long_steps.landing * time_unit, **how), explicit
