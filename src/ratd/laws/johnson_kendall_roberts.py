"""Normal contact of two adhesive elastic spheres (Johnson, Kendall & Roberts 1971) and its damping, as formulae.

Everything is a function of the contact radius r through x = r/r0, r0 being the radius at equilibrium. The state of a
contact is kept as s = sqrt(x), in which the compression is a polynomial: delta/delta_0 = 3 s^4 - 2 s.
"""

import math

from ratd.base.fastmath import rough_reciprocal
from ratd.base.jit import jit

S_TOUCH = (2.0 / 3.0) ** (1.0 / 3.0)
"""s where delta = 0: two spheres that just touch jump to this contact radius (x = 0.763, force -8/9 F_C)."""
S_PULL_OFF = 0.25 ** (1.0 / 6.0)
"""s of the greatest pull F_C (x = 0.630)."""
S_END = (1.0 / 6.0) ** (1.0 / 3.0)
"""s at the end of the branch (x = 0.303), where the contact is lost even if the distance is held."""
COMPRESSION_END = 3.0 * S_END**4 - 2.0 * S_END
"""delta/delta_0 at the end of the branch: -0.8255."""

# Where a contact springs back by a good part of delta_0 in one step, Newton's rule would begin where the slope is small
# and lead far off: it begins at least on this line, which is below the root everywhere and ends where spheres touch.
_LINE_END = 0.85
_LINE_SLOPE = (_LINE_END - S_END) / -COMPRESSION_END

# Newton's slope 12 s^3 - 2 vanishes at the end of the branch; this floor keeps its step finite there. It is active
# only for s < 0.568, within 0.2 % of delta_0 of the end, where the iteration goes on over the following steps.
_SLOPE_FLOOR = 0.2


@jit(forceinline=True)
def contact_state(compression, s):
    """s = sqrt(r/r0) of a contact from its compression, by two Newton steps from the previous s.

    Parameters
    ----------
    compression : float
        delta/delta_0, not below `COMPRESSION_END`.
    s : float
        Value at the previous time step (`S_TOUCH` for a new contact).

    Returns
    -------
    float
        Root of 3 s^4 - 2 s = delta/delta_0 on the stable branch. For a change of delta/delta_0 by 1e-3 since the
        last step it fits the compression to 1e-9 where s > 0.63 (the greatest pull is at 0.794), and to 1e-3 up to
        the end of the branch. However much a contact springs back in one step, the force is right to 0.15 F_C up to
        equilibrium, and to 0.8 F_C up to delta = 2 delta_0.

    Notes
    -----
    docs/model/laws.md; Eqs. 9, 12 and 23 of the paper.
    """
    s = max(s, min(S_END + _LINE_SLOPE * (compression - COMPRESSION_END), _LINE_END))
    s2 = s * s
    s = s - (3.0 * s2 * s2 - 2.0 * s - compression) * rough_reciprocal(max(12.0 * s2 * s - 2.0, _SLOPE_FLOOR))
    s2 = s * s
    return s - (3.0 * s2 * s2 - 2.0 * s - compression) * rough_reciprocal(max(12.0 * s2 * s - 2.0, _SLOPE_FLOOR))


@jit(forceinline=True)
def normal_force(s, pull_off_force):
    """Normal force [N] along n_c, positive when it pushes the spheres apart: 4 F_C (x^3 - x^(3/2)), Eq. 12.

    Parameters
    ----------
    s : float
        sqrt(r/r0).
    pull_off_force : float
        F_C = 3 pi gamma R [N].
    """
    s3 = s * s * s
    return 4.0 * pull_off_force * (s3 * s3 - s3)


@jit(forceinline=True)
def normal_potential(s, pull_off_force, equilibrium_compression):
    """Potential energy [J] of the normal force, zero for separated spheres, i.e. at x = 0.

    Parameters
    ----------
    s : float
        sqrt(r/r0).
    pull_off_force : float
        F_C [N].
    equilibrium_compression : float
        delta_0 [m].

    Notes
    -----
    Integral of F d(delta) along the branch from r = 0: 4 F_C delta_0 (6/5 x^5 - 2 x^(7/2) + x^2/2), the same as in
    Wada et al. (2007), whose delta_C is 0.8255 delta_0.
    """
    x = s * s
    return 4.0 * pull_off_force * equilibrium_compression * x * x * (1.2 * x * x * x - 2.0 * s * s * s + 0.5)


@jit
def viscoelastic_damping(equilibrium_contact_radius, reduced_modulus, viscosity):
    """Viscoelastic damping coefficient [kg s-1] at equilibrium: c = 2 E*/nu^2 r0 T_vis, Eq. 22.

    The damping force is c x d(delta)/dt along n_c: it pushes while the spheres approach. Eq. 29 as printed leaves
    it out; it belongs there (docs/model/laws.md).

    Parameters
    ----------
    equilibrium_contact_radius : float
        r0 [m].
    reduced_modulus : float
        E* [Pa].
    viscosity : float
        T_vis/nu^2 [s].
    """
    return 2.0 * reduced_modulus * equilibrium_contact_radius * viscosity


@jit
def contact_time(reduced_mass, reduced_radius, reduced_modulus, surface_energy):
    """Characteristic time [s] of a contact of Kataoka et al. (2013), Eq. 2, for two spheres of any radii.

    t0 = 0.95 r^(7/6) rho^(1/2)/(E*^(1/3) gamma^(1/6)) for two spheres of radius r; here r = 2 R, and rho such that a
    sphere of this radius has the mass 2 m_red. The paper prints E for E*.

    Parameters
    ----------
    reduced_mass : float
        m_i m_j/(m_i + m_j) [kg].
    reduced_radius : float
        R [m].
    reduced_modulus : float
        E* [Pa].
    surface_energy : float
        gamma [J m-2].
    """
    radius = 2.0 * reduced_radius
    density = 2.0 * reduced_mass / (4.0 / 3.0 * math.pi * radius**3)
    return (
        0.95
        * radius ** (7.0 / 6.0)
        * math.sqrt(density)
        / (reduced_modulus ** (1.0 / 3.0) * surface_energy ** (1.0 / 6.0))
    )


def compression_of(s):
    """delta/delta_0 = 3 s^4 - 2 s (docs/model/laws.md)."""
    return 3.0 * s**4 - 2.0 * s


def equilibrium_stiffness(pull_off_force, equilibrium_compression):
    """-dF/d(delta) [N m-1] at equilibrium: 1.2 F_C/delta_0, which equals 1.2 E* r0 (docs/model/laws.md)."""
    return 1.2 * pull_off_force / equilibrium_compression


@jit
def dissipation_time(light_mass, reduced_radius, equilibrium_contact_radius, surface_energy):
    """Characteristic time [s] of a contact that limits the time step, Eq. 31: 6^(-2/3) sqrt(m r0^2/(pi gamma R^2)).

    Parameters
    ----------
    light_mass : float
        Mass of the lighter monomer of the pair [kg].
    reduced_radius : float
        R [m].
    equilibrium_contact_radius : float
        r0 [m].
    surface_energy : float
        gamma [J m-2].
    """
    r0 = equilibrium_contact_radius
    return 6.0 ** (-2.0 / 3.0) * math.sqrt(light_mass * r0 * r0 / (math.pi * surface_energy)) / reduced_radius
