"""The contact law, slow and obvious: one contact at a time, vectors as arrays, as in docs/model/laws.md."""

import math

import numpy as np
from scipy.optimize import brentq

from ratd.engine import layout
from ratd.engine.state import contact_field

END = (1.0 / 6.0) ** (1.0 / 3.0)


def turned(vector, spin, dt):
    """A vector turned by |spin| dt about `spin`, to second order, and made a unit vector."""
    half = 0.5 * dt * spin
    vector = vector + 2.0 * np.cross(half, vector) + 2.0 * np.cross(half, np.cross(half, vector))
    return vector / np.linalg.norm(vector)


def contact(material, a, x, v, w, n_i, n_j, n_c_old, phi, dt, damping_rate=0.0):
    """Forces and torques of one contact after a move of length dt.

    Parameters hold the two monomers as rows: radii a, positions x, velocities v, spins w.

    Returns a dict: force on i, torques on i and j, the new pointers and angle, the normal force, the energies.
    """
    a_i, a_j = a
    r = a_i * a_j / (a_i + a_j)
    e_star = material.youngs_modulus / (2 * (1 - material.poisson_number**2))
    shear = material.youngs_modulus / (2 * (1 + material.poisson_number))
    nu, gamma = material.poisson_number, material.surface_energy
    r0 = (9 * math.pi * gamma * r**2 / e_star) ** (1 / 3)
    delta_0 = r0**2 / (3 * r)
    f_c = 3 * math.pi * gamma * r
    k_s = 8 * r0 * shear / (2 * (2 - nu))
    zeta_c = r0 * (2 - nu) / (16 * math.pi)
    k_t = 16 / 3 * (shear / 2) * r0**3
    phi_c = 1 / (16 * math.pi)
    xi_c = material.critical_rolling_displacement

    d = x[0] - x[1]
    distance = np.linalg.norm(d)
    n_c = d / distance
    delta = a_i + a_j - distance
    s = brentq(lambda s: 3 * s**4 - 2 * s - delta / delta_0, END, 3.0, xtol=1e-15, rtol=1e-15)
    normal = 4 * f_c * (s**6 - s**3)
    c = 2 * e_star / nu**2 * r0 * s**2 * material.viscous_time
    c /= 1 + dt * s**2 * damping_rate
    approach = -(v[0] - v[1]) @ (n_c + n_c_old) / 2

    n_i, n_j = turned(n_i, w[0], dt), turned(n_j, w[1], dt)
    phi = phi + dt * (w[0] - w[1]) @ (n_c + n_c_old) / 2

    def sliding(n_i, n_j):
        u = a_i * n_i - a_j * n_j
        return u @ n_c, u - (u @ n_c) * n_c

    _, zeta = sliding(n_i, n_j)
    lost_slide = lost_roll = lost_twist = 0.0
    if np.linalg.norm(zeta) > zeta_c:
        lost_slide = 0.5 * k_s * (zeta @ zeta - zeta_c**2)
        excess = zeta * (1 - zeta_c / np.linalg.norm(zeta))
        n_i, n_j = n_i - excess / (a_i + a_j), n_j + excess / (a_i + a_j)
    xi = r * (n_i + n_j)
    if np.linalg.norm(xi) > xi_c:
        lost_roll = 0.5 * 4 * f_c / r * (xi @ xi - xi_c**2)
        excess = xi * (1 - xi_c / np.linalg.norm(xi))
        n_i, n_j = n_i - excess / a_i, n_j - excess / a_j
    if abs(phi) > phi_c:
        kept = math.copysign(phi_c, phi)
        lost_twist = 0.5 * k_t * (phi**2 - kept**2)
        phi = kept

    along, zeta = sliding(n_i, n_j)
    xi = r * (n_i + n_j)
    force = (normal + c * approach) * n_c + k_s * along * zeta / distance
    torque_i = -k_s * a_i * np.cross(n_i, zeta) - 4 * f_c * np.cross(n_i, xi) - k_t * phi * n_c
    torque_j = k_s * a_j * np.cross(n_j, zeta) + 4 * f_c * np.cross(n_i, xi) + k_t * phi * n_c
    return {
        "force": force,
        "torques": (torque_i, torque_j),
        "pointers": (n_i, n_j),
        "phi": phi,
        "normal": normal,
        "lost": (lost_slide, lost_roll, lost_twist, dt * c * approach**2),
    }


def all_contacts(state, material, dt):
    """Forces (n, 3) and torques (n, 3) of a state by the function above, and what it says of each contact."""
    rows = state.monomer.reshape(-1, layout.ROW)
    n, k = state.counter[layout.MONOMERS], state.counter[layout.CONTACTS]

    def vectors(first):
        return np.array([contact_field(state, first + axis * layout.LANES) for axis in range(3)]).T

    n_i, n_j, n_c = vectors(int(layout.NIX)), vectors(int(layout.NJX)), vectors(int(layout.NCX))
    phi, rate = contact_field(state, layout.PHI), contact_field(state, layout.DAMPING_RATE)
    force, torque, details = np.zeros((n, 3)), np.zeros((n, 3)), []
    for q in range(k):
        pair = [int(state.pair_i[q]), int(state.pair_j[q])]
        result = contact(
            material, rows[pair, 3], rows[pair, 0:3], rows[pair, 4:7], rows[pair, 8:11],
            n_i[q], n_j[q], n_c[q], phi[q], dt, rate[q],
        )  # fmt: skip
        force[pair[0]] += result["force"]
        force[pair[1]] -= result["force"]
        torque[pair[0]] += result["torques"][0]
        torque[pair[1]] += result["torques"][1]
        details.append(result)
    return force, torque, details
