"""Two monomers that keep vibrating while they are spun up: when they part, without the engine.

In the frame that turns with omega the distance r of an undamped pair that is held at angular momentum zero obeys
m_red (r'' - omega^2 r) = F(delta), delta = a_1 + a_2 - r (Eqs. 12 and 20 of the paper). Two answers: the adiabatic one,
for an omega that grows infinitely slowly, and the integration of this equation for a given epsilon.
"""

import math
from dataclasses import dataclass

from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq

from ratd.base.materials import sphere_mass
from ratd.drives.rotating import angular_velocity, rotating
from ratd.experiments.spin_up.pairs import holding_omega
from ratd.laws.contact_constants import equilibrium_compression, pull_off_force, reduced_radius
from ratd.laws.johnson_kendall_roberts import (
    COMPRESSION_END,
    S_END,
    S_PULL_OFF,
    S_TOUCH,
    compression_of,
    equilibrium_stiffness,
    normal_force,
    normal_potential,
)

S_GREATEST = 5.0
"""Above any s = sqrt(r/r0) that a pair from first touch reaches."""


@dataclass(frozen=True)
class Pair:
    """Constants of the relative motion of two monomers.

    Attributes
    ----------
    contact_distance : float
        a_1 + a_2 [m].
    reduced_mass : float
        [kg].
    pull_off_force : float
        F_C [N].
    equilibrium_compression : float
        delta_0 [m].
    """

    contact_distance: float
    reduced_mass: float
    pull_off_force: float
    equilibrium_compression: float

    @classmethod
    def of(cls, a_1, a_2, material):
        """Pair of radii [m] and a `ratd.Material`."""
        m_1, m_2 = (sphere_mass(a, material.density) for a in (a_1, a_2))
        r = reduced_radius(a_1, a_2)
        return cls(
            a_1 + a_2,
            m_1 * m_2 / (m_1 + m_2),
            pull_off_force(r, material.surface_energy),
            equilibrium_compression(r, material.surface_energy, material.reduced_modulus),
        )

    @property
    def force_controlled_omega(self):
        """omega [rad/s] at which the centrifugal force at r = a_1 + a_2 is F_C: m_red omega^2 (a_1 + a_2) = F_C."""
        return holding_omega(self.pull_off_force, self.reduced_mass, self.contact_distance)

    def distance(self, s):
        """r [m] at s = sqrt(contact radius/r0)."""
        return self.contact_distance - self.equilibrium_compression * compression_of(s)

    def force(self, s, omega):
        """Contact force and centrifugal force along r [N]."""
        return normal_force(s, self.pull_off_force) + self.reduced_mass * omega**2 * self.distance(s)

    def potential(self, s, omega):
        """Potential [J] of `force`; the centrifugal part is zero at r = a_1 + a_2."""
        square = self.distance(s) ** 2 - self.contact_distance**2
        contact = normal_potential(s, self.pull_off_force, self.equilibrium_compression)
        return contact - 0.5 * self.reduced_mass * omega**2 * square

    def action(self, s_out, omega):
        """Action [J s] of the vibration whose outer turning point is at `s_out`: the integral of m_red |r'| dr."""
        energy = self.potential(s_out, omega)
        rest = brentq(self.force, S_PULL_OFF, S_GREATEST, args=(omega,))
        s_in = brentq(lambda s: self.potential(s, omega) - energy, rest, S_GREATEST, xtol=1e-15)
        middle, half = 0.5 * (s_in + s_out), 0.5 * (s_in - s_out)

        def integrand(angle):  # s = middle + half sin(angle) takes the roots at both ends out of the integral
            s = middle + half * math.sin(angle)
            momentum = math.sqrt(max(0.0, 2.0 * self.reduced_mass * (energy - self.potential(s, omega))))
            slope = self.equilibrium_compression * (12.0 * s**3 - 2.0)
            return momentum * slope * half * math.cos(angle)

        # Of the order of F_C delta_0 over a frequency: in units of that for the quadrature's sake.
        unit = self.pull_off_force * self.equilibrium_compression / self.frequency
        value, _ = quad(lambda angle: integrand(angle) / unit, -0.5 * math.pi, 0.5 * math.pi, epsrel=1e-10, limit=200)
        return 2.0 * unit * value

    @property
    def frequency(self):
        """Angular frequency [rad/s] of small vibrations of a pair at rest."""
        return math.sqrt(equilibrium_stiffness(self.pull_off_force, self.equilibrium_compression) / self.reduced_mass)


def adiabatic_omega(a_1, a_2, material):
    """omega [rad/s] at which an undamped pair that started at rest at delta = 0 parts, for epsilon -> 0.

    Parameters
    ----------
    a_1, a_2 : float
        Radii [m].
    material : ratd.Material

    Returns
    -------
    float

    Notes
    -----
    While omega grows slowly the action of the vibration is kept (Landau & Lifshitz, Mechanics, Sect. 49). The pair
    parts when the vibration with that action just reaches the top of the barrier: where contact and centrifugal force
    balance beyond the greatest pull, or the end of the branch if they do not balance before.
    """
    pair = Pair.of(a_1, a_2, material)
    start = pair.action(S_TOUCH, 0.0)

    def excess(omega):
        top = S_END
        if pair.force(S_END, omega) > 0.0:
            top = brentq(pair.force, S_END, S_PULL_OFF, args=(omega,), xtol=1e-15)
        return pair.action(top, omega) / start - 1.0

    # From nearly no rotation to where the contact just holds a pair at rest. The latter is a little below
    # `force_controlled_omega`, since the pair is longer there.
    most = holding_omega(pair.pull_off_force, pair.reduced_mass, pair.distance(S_PULL_OFF))
    return brentq(excess, 0.01 * most, 0.999 * most, rtol=1e-12)


def vibrating_omega(a_1, a_2, material, epsilon):
    """omega [rad/s] at which an undamped pair parts that starts at rest at delta = 0 and is spun up at `epsilon`.

    The equation of motion integrated with error control (relative 1e-9), the contact radius found from scratch each
    time: slow and obvious.

    Parameters
    ----------
    a_1, a_2 : float
        Radii [m].
    material : ratd.Material
    epsilon : float
        (d omega/dt)/omega^2; omega grows linearly up to half of `Pair.force_controlled_omega`.

    Returns
    -------
    float
    """
    pair = Pair.of(a_1, a_2, material)
    half = 0.5 * pair.force_controlled_omega
    drive = rotating("prescribed", omega_1=half, epsilon=epsilon)
    delta_0 = pair.equilibrium_compression

    def motion(phase, y):  # y: stretch (r - a_1 - a_2)/delta_0 and its rate, over the phase frequency * t
        compression = max(-y[0], COMPRESSION_END)
        s = brentq(lambda s: compression_of(s) - compression, S_END, S_GREATEST, xtol=1e-15)
        omega, _ = angular_velocity(drive, phase / pair.frequency)
        acceleration = pair.force(s, omega) / pair.reduced_mass
        return y[1], acceleration / (delta_0 * pair.frequency**2)

    def ended(phase, y):
        return y[0] + COMPRESSION_END

    ended.terminal = True
    last = pair.frequency / (epsilon * half) * 1.6  # omega is 2.5 times `half` then
    found = solve_ivp(motion, (0.0, last), (0.0, 0.0), method="DOP853", rtol=1e-9, atol=1e-9, events=ended)
    if not len(found.t_events[0]):
        return math.nan
    return angular_velocity(drive, found.t_events[0][0] / pair.frequency)[0]
