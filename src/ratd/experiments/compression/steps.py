"""The steps of a compression: long ones while the aggregate is loose, explicit ones where monomers crowd."""

import math
from typing import NamedTuple

from ratd.aggregates.clusters import MONOMER_RADIUS
from ratd.base.checks import is_number
from ratd.base.errors import InputError
from ratd.base.materials import get_material
from ratd.engine.leapfrog import leapfrog
from ratd.engine.semi_implicit import semi_implicit
from ratd.laws.contact_constants import equilibrium_compression

__all__ = ["STRAIN", "LongSteps", "integrators", "longest_strain"]

STRAIN = 6e-6
"""By which part an edge of the box may change in a step where the monomers are of ice and of 0.1 um: 10 t_0 at
C_v = 3e-7. In longer steps the pressure of a loose cluster is too low (docs/compression_appendix.md, "Fewer steps")."""

ROLLED = 2 / 3
"""Part of the critical rolling displacement by which a contact may roll in a long step at most, so that none rolls past
its limit from rest."""
CALMED = 0.3
"""Length of a step over the longest above which it calms less (`calmed` of `semi_implicit`)."""
OF_TIME_UNIT = 0.708
"""f of an explicit step of t_0, of equal monomers."""
LARGEST_FACTOR = 0.5
"""Greatest f of the explicit step: with longer ones a crowded cluster gains energy until it bursts."""
TRAVEL = 0.01
"""Part of r_0 by which a monomer may move against the box in a long step at most."""


class LongSteps(NamedTuple):
    """Long steps with the semi-implicit integrator, up to some filling factor.

    Attributes
    ----------
    strain : float or None
        By which part an edge of the box changes in the longest step; None for `longest_strain`. Steps of t_0, shorter
        in proportion where this is below `STRAIN`, are allowed however fast the box is; where long steps would be no
        longer than explicit ones, the steps are explicit.
    displacement : float
        How far a monomer may move in a step against one in contact, over the equilibrium compression delta_0 of two.
        Where the critical rolling displacement is small it allows less, see `ROLLED`.
    calming : float
        See `ratd.engine.semi_implicit.semi_implicit`.
    landing : float
        The longest step over t_0 where two monomers meet, see there. The default is about that of an explicit step, and
        keeps the balance of energy to less than 0.1 % of the work from a filling factor of 0.1 on.
    until_phi : float
        Filling factor from which on the explicit step takes over. There each monomer touches several others, and the
        matrix of a long step costs more than it saves.
    """

    strain: float | None = None
    displacement: float = 0.5
    calming: float = 0.1
    landing: float = 0.2
    until_phi: float = 0.2


def longest_strain(material, radius):
    """By which part an edge of the box may change in a long step, `STRAIN` for ice and less for stiffer monomers.

    Parameters
    ----------
    material : Material
    radius : float
        r_0 [m].

    Returns
    -------
    float
        `STRAIN` times the root of delta_0/r_0 over that of ice of 0.1 um, and `STRAIN` at most: 1e-6 for silicate of
        0.6 um.

    Notes
    -----
    A body that turns by Omega dt in a step bears a tension of theta k (Omega dt)^2 d (docs/model/engine.md), with the
    stiffness k of a contact and its length d = 2 r_0. Over the pull-off force, which is about k delta_0, this is
    theta (Omega dt)^2 d/delta_0. What turns it is the box, so that Omega dt goes with the strain of a step.
    """
    r_ice = MONOMER_RADIUS["ice"]
    ice, own = _natural(get_material("ice"), r_ice) / r_ice, _natural(material, radius) / radius
    # six digits, so that the rounding of a radius does not show
    return STRAIN * min(1.0, round(math.sqrt(own / ice), 6))


def _natural(material, radius):
    """Compression delta_0 [m] of two equal monomers at rest."""
    return equilibrium_compression(0.5 * radius, material.surface_energy, material.reduced_modulus)


def integrators(material, radius, time_unit, timestep_factor, long_steps, strain_rate):
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
    strain_rate : float
        C_v.

    Returns
    -------
    first, explicit : parts
        The one to begin with and the one to end with; the same object where there are no long steps.

    Raises
    ------
    InputError
    """
    if not (is_number(timestep_factor) and 0.0 < timestep_factor <= LARGEST_FACTOR):
        raise InputError(f"timestep_factor is {timestep_factor!r}; it must be above 0 and at most {LARGEST_FACTOR:g}.")
    explicit = leapfrog(timestep_factor=timestep_factor)
    if long_steps is None:
        return explicit, explicit
    if not isinstance(long_steps, LongSteps):
        raise InputError(f"long_steps is {long_steps!r}; it must be a ratd.LongSteps, or None for explicit steps.")
    if long_steps.strain is None:
        long_steps = long_steps._replace(strain=longest_strain(material, radius))
    for name in ("strain", "displacement", "landing", "until_phi"):
        value = getattr(long_steps, name)
        if not (is_number(value) and value > 0.0):
            raise InputError(f"long_steps.{name} is {value!r}; it must be a number above 0.")
    displacement = min(
        long_steps.displacement * _natural(material, radius), ROLLED * material.critical_rolling_displacement
    )
    how = {"displacement": displacement, "travel": TRAVEL * radius, "calming": long_steps.calming}
    longest = max(long_steps.strain / (2.0 * strain_rate), min(1.0, long_steps.strain / STRAIN))
    if longest <= timestep_factor / OF_TIME_UNIT:
        return explicit, explicit
    times = {"longest": longest, "calmed": CALMED * longest, "landing": long_steps.landing}
    return semi_implicit(**how, **{name: value * time_unit for name, value in times.items()}), explicit
