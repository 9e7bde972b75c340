"""The springs of `ratd.laws.jkr_with_springs` with the limits of LAMMPS (`pair_style granular`), to compare the two.

Two things differ from the law of ratd. The limits of sliding, rolling and twisting go with |F_N + 2 F_C|/(2 F_C), so
that they grow with the load and fall where a contact is pulled. And where the twisting torque exceeds its limit, LAMMPS
gives it the limit with the sign of the *rate* of twisting (`twisting sds`). The limit changes with each vibration of
the contact. When it falls below a torque that is held while the two monomers happen to twist back, the torque jumps to
the opposite limit: a contact at its limit does not keep the load that it carries. Sliding and rolling are only
shortened to their limits, here as there.
"""

from typing import NamedTuple

import numpy as np

from ratd.base.jit import jit
from ratd.base.parts import part
from ratd.laws.contact_fields import (
    COMMON, E_TWIST, NCX, NCY, NCZ, NORMAL, TIX, TIY, TIZ, TJX, TJY, TJZ, WIX, WIY, WIZ, WJX, WJY, WJZ, law_fields,
)  # fmt: skip
from ratd.laws.jkr_with_springs import INV_XI2, INV_ZETA2, JKR, K_TWIST, N_OWN, PULL_OFF, jkr
from ratd.laws.tangential import TWISTING_LIMIT

__all__ = ["jkr_as_in_lammps"]

N_MORE = 4
# squares of the limits at equilibrium, inverted; twisting angle and stiffness, which the springs are not shown
UNLOADED_ZETA2, UNLOADED_XI2, ANGLE, STIFFNESS = law_fields(N_OWN + N_MORE)[N_OWN:]


@jit(forceinline=True)
def _load(contact, k, follows_load):
    """|F_N + 2 F_C|/(2 F_C) of one contact, 1 where the limits do not follow it, or the contact does nothing."""
    f_c = contact[PULL_OFF + k]
    return abs(1.0 + 0.5 * contact[NORMAL + k] / f_c) if follows_load and f_c > 0.0 else 1.0


@jit(forceinline=True)
def _twist(contact, scratch, k, q, dt_drift, follows_load, sign_of_rate):
    """Angle of one contact after the last move, cut to its limit, and its torque, added to those in `scratch`."""
    ncx, ncy, ncz = contact[NCX + k], contact[NCY + k], contact[NCZ + k]
    rate = (
        (scratch[WIX + q] - scratch[WJX + q]) * ncx
        + (scratch[WIY + q] - scratch[WJY + q]) * ncy
        + (scratch[WIZ + q] - scratch[WJZ + q]) * ncz
    )
    stiffness = contact[STIFFNESS + k]
    angle = contact[ANGLE + k] + dt_drift * rate
    limit = TWISTING_LIMIT * _load(contact, k, follows_load)
    if abs(angle) > limit:
        # a spring that jumps to its opposite limit holds as much as before
        contact[E_TWIST + k] += 0.5 * stiffness * (angle * angle - limit * limit)
        angle = np.copysign(limit, rate if sign_of_rate else angle)
    contact[ANGLE + k] = angle
    torque = stiffness * angle
    scratch[TIX + q] -= torque * ncx
    scratch[TIY + q] -= torque * ncy
    scratch[TIZ + q] -= torque * ncz
    scratch[TJX + q] += torque * ncx
    scratch[TJY + q] += torque * ncy
    scratch[TJZ + q] += torque * ncz


@part
class JKRAsInLammps(NamedTuple):
    """The law of this module; made by `jkr_as_in_lammps`.

    Attributes
    ----------
    springs : JKR
        Does all but twisting.
    follows_load : bool
        Whether the limits go with the load.
    sign_of_rate : bool
        Whether a twisting torque beyond its limit takes the sign of the rate, else it keeps its own.
    """

    springs: JKR
    follows_load: bool
    sign_of_rate: bool

    def n_fields(self):
        return COMMON + N_OWN + N_MORE

    def vectors(self):
        return self.springs.vectors()

    def idle(self, contact, at):
        self.springs.idle(contact, at)

    def begin(self, contact, at, pair, mass_i, mass_j, normal, distance, spin_i, spin_j, back, at_rest):
        radiated = self.springs.begin(
            contact, at, pair, mass_i, mass_j, normal, distance, spin_i, spin_j, back, at_rest
        )
        contact[at + UNLOADED_ZETA2] = contact[at + INV_ZETA2]
        contact[at + UNLOADED_XI2] = contact[at + INV_XI2]
        contact[at + STIFFNESS] = contact[at + K_TWIST]
        contact[at + K_TWIST] = 0.0
        contact[at + ANGLE] = 0.0
        return radiated

    def forces(self, contact, scratch, start, count, dt_drift, dt):
        for lane in range(count):
            k = start + np.uint64(lane)
            wider = max(_load(contact, k, self.follows_load), 1e-6) ** -2
            contact[INV_ZETA2 + k] = wider * contact[UNLOADED_ZETA2 + k]
            contact[INV_XI2 + k] = wider * contact[UNLOADED_XI2 + k]
        ended = self.springs.forces(contact, scratch, start, count, dt_drift, dt)
        for lane in range(count):
            k, q = start + np.uint64(lane), np.uint64(lane)
            _twist(contact, scratch, k, q, dt_drift, self.follows_load, self.sign_of_rate)
        return ended

    def ended(self, contact, at):
        return self.springs.ended(contact, at)

    def energies(self, contact, at):
        normal, sliding, rolling, _ = self.springs.energies(contact, at)
        return normal, sliding, rolling, 0.5 * contact[at + STIFFNESS] * contact[at + ANGLE] ** 2

    def damping_coefficient(self, contact, at):
        return self.springs.damping_coefficient(contact, at)

    def damping_now(self, contact, at):
        return self.springs.damping_now(contact, at)

    def contact_radius(self, contact, at):
        return self.springs.contact_radius(contact, at)

    def pointers(self, contact, at):
        return self.springs.pointers(contact, at)

    def stiffness(self, contact, at):
        k_n, k_s, k_r, _ = self.springs.stiffness(contact, at)
        return k_n, k_s, k_r, contact[at + STIFFNESS]


def jkr_as_in_lammps(*, follows_load=True, sign_of_rate=True, **options):
    """The law of `ratd.laws.jkr` with the limits of LAMMPS.

    Parameters
    ----------
    follows_load : bool
        Whether the limits of sliding, rolling and twisting go with |F_N + 2 F_C|.
    sign_of_rate : bool
        Whether a twisting torque beyond its limit takes the sign of the rate of twisting. With neither this is the law
        of ratd.
    **options
        Those of `ratd.laws.jkr`.

    Returns
    -------
    JKRAsInLammps
    """
    return JKRAsInLammps(jkr(**options), bool(follows_load), bool(sign_of_rate))
