"""Contact laws of one pair of spheres of one material: i at x_i, j at x_j, n from j to i, delta > 0 compressed.

A law has
- start(pair, n): state of a new contact (a dict of vectors and scalars);
- ends(pair, delta): is the contact gone? (Both begin at delta >= 0.)
- force(pair, state, delta, n, v, w_i, w_j): force on i (that on j is opposite), torques on i and j, power lost by
  mode; v = v_i - v_j, in a shrinking box u_i - u_j + H d;
- potential(pair, state, delta, n): energy by mode, 0 for two spheres apart;
- advance(pair, state, delta_0, delta, n_0, n, v, w_i, w_j, dt): brings the state from the pose (delta_0, n_0) to
  (delta, n), with the velocities in between, cuts it back at the limits; energy lost by mode: limit x excess.
"""

from math import pi, sqrt
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

MODES = ("normal", "sliding", "rolling", "twisting")


class Material(NamedTuple):
    surface_energy: float
    youngs_modulus: float
    poisson_number: float
    density: float
    critical_rolling_displacement: float
    viscous_time: float


ICE = Material(0.100, 7e9, 0.25, 1000.0, 0.8e-9, 5e-12)
SILICA = Material(0.025, 54e9, 0.17, 2000.0, 0.1e-9, 0.5e-9)


class Pair:
    """Constants of a pair."""

    def __init__(self, material, r_i, r_j):
        self.r_i, self.r_j = r_i, r_j
        self.gamma, Y, self.nu, self.rho, self.xi_c, self.T_vis = (getattr(material, k) for k in Material._fields)
        self.R = r_i * r_j / (r_i + r_j)
        self.E_star = Y / (2 * (1 - self.nu**2))
        self.G = Y / (2 * (1 + self.nu))
        m_i, m_j = (4 / 3 * pi * self.rho * r**3 for r in (r_i, r_j))
        I_i, I_j = 0.4 * m_i * r_i**2, 0.4 * m_j * r_j**2
        self.m_red, self.I_red = m_i * m_j / (m_i + m_j), I_i * I_j / (I_i + I_j)
        self.r0 = (9 * pi * self.gamma * self.R**2 / self.E_star) ** (1 / 3)
        self.F_C = 3 * pi * self.gamma * self.R
        self.delta_0 = self.r0**2 / (3 * self.R)
        self.t0 = 0.95 * sqrt(self.rho) * (2 * self.R) ** (7 / 6) / (self.E_star ** (1 / 3) * self.gamma ** (1 / 6))
        self.K = 2 / 3 * Y / (1 - self.nu**2) * sqrt(self.R)
        self.f_adh = 4 * pi * self.gamma * self.R
        self.delta_eq = (self.f_adh / self.K) ** (2 / 3)
        self.E_break = 3 / 5 * self.f_adh * self.delta_eq
        self.k_eq = 3 / 2 * self.K * sqrt(self.delta_eq)
        self.period = 2 * pi * sqrt(self.m_red / self.k_eq)  # small, undamped, about delta_eq


def turn(v, angle):
    """v turned by the vector `angle` (Rodrigues)."""
    size = np.linalg.norm(angle)
    e = angle / (size or 1.0)
    return v * np.cos(size) + np.cross(e, v) * np.sin(size) + e * (e @ v) * (1 - np.cos(size))


def carry(v, n_0, n):
    """v taken along by the shortest rotation from n_0 to n."""
    axis = np.cross(n_0, n)
    return v * (n_0 @ n) + np.cross(axis, v) + axis * (axis @ v) / (1 + n_0 @ n)


def across(v, n):
    return v - (v @ n) * n


class JKR:
    """damping: 'viscoelastic', c = (2E*/nu^2) r T_vis at the current r; 'constant', c = k_n m0/t0; 'none'.

    For unequal radii 'constant' takes m0 = 2 m_red and t0 of Eq. 2 (Kataoka) with r0 = 2R, E* for E.
    friction=False drops sliding, rolling and twisting.
    """

    x_end = (1 / 6) ** (2 / 3)

    def __init__(self, damping="viscoelastic", k_n=0.01, friction=True):
        self.damping, self.k_n, self.friction = damping, k_n, friction

    def start(self, pair, n):
        return {"n_i": -np.array(n), "n_j": np.array(n), "phi": 0.0}

    def ends(self, pair, delta):
        return delta < -1.5 * (1 / 6) ** (1 / 3) * pair.delta_0  # 0.82548

    def x(self, pair, delta):
        """r/r0 on the stable branch of delta/delta_0 = 3x^2 - 2 sqrt(x)."""
        y = delta / pair.delta_0
        if y <= 3 * self.x_end**2 - 2 * sqrt(self.x_end):
            return self.x_end
        return brentq(lambda x: 3 * x * x - 2 * sqrt(x) - y, self.x_end, 2 + sqrt(abs(y)), xtol=1e-15, rtol=1e-14)

    def normal(self, pair, delta):
        x = self.x(pair, delta)
        return 4 * pair.F_C * (x**3 - x**1.5)

    def normal_potential(self, pair, delta):
        """int F d(delta) = int F (d delta/dx) dx from x = 0, no contact area, no energy."""
        x = self.x(pair, delta)
        return 4 * pair.F_C * pair.delta_0 * (6 / 5 * x**5 - 2 * x**3.5 + x**2 / 2)

    def c(self, pair, delta):
        return {
            "viscoelastic": 2 * pair.E_star / pair.nu**2 * pair.r0 * self.x(pair, delta) * pair.T_vis,
            "constant": self.k_n * 2 * pair.m_red / pair.t0,
            "none": 0.0,
        }[self.damping]

    def constants(self, pair):
        """(spring, greatest displacement) of sliding [N/m, m], rolling [N/m, m], twisting [N m, 1]."""
        p = pair
        k_s, k_r, k_t = 8 * p.r0 * p.G / (2 * (2 - p.nu)), 4 * p.F_C / p.R, 16 / 3 * p.G / 2 * p.r0**3
        zeta_c, phi_c = p.r0 * (2 - p.nu) / (16 * pi), 1 / (16 * pi)
        return {"sliding": (k_s, zeta_c), "rolling": (k_r, p.xi_c), "twisting": (k_t, phi_c)}

    def displacements(self, pair, state, n):
        w = pair.r_i * state["n_i"] - pair.r_j * state["n_j"]
        return {"sliding": across(w, n), "rolling": pair.R * (state["n_i"] + state["n_j"]), "twisting": state["phi"]}

    def potential(self, pair, state, delta, n):
        z, k = self.displacements(pair, state, n), self.constants(pair)
        energy = {mode: 0.5 * k[mode][0] * float(np.dot(z[mode], z[mode])) * bool(self.friction) for mode in k}
        return energy | {"normal": self.normal_potential(pair, delta)}

    def force(self, pair, state, delta, n, v, w_i, w_j):
        c, rate = self.c(pair, delta), -(v @ n)
        F = (self.normal(pair, delta) + c * rate) * n
        T_i, T_j = np.zeros(3), np.zeros(3)
        if self.friction:
            z, k = self.displacements(pair, state, n), {mode: k for mode, (k, _) in self.constants(pair).items()}
            n_i, n_j, d = state["n_i"], state["n_j"], pair.r_i + pair.r_j - delta
            F = F + k["sliding"] * ((pair.r_i * n_i - pair.r_j * n_j) @ n) * z["sliding"] / d
            T_i = T_i - k["sliding"] * pair.r_i * np.cross(n_i, z["sliding"])
            T_j = T_j + k["sliding"] * pair.r_j * np.cross(n_j, z["sliding"])
            M = -k["rolling"] * pair.R * np.cross(n_i, z["rolling"]) - k["twisting"] * z["twisting"] * n
            T_i, T_j = T_i + M, T_j - M
        return F, T_i, T_j, {"damping": c * rate**2}

    def advance(self, pair, state, delta_0, delta, n_0, n, v, w_i, w_j, dt):
        lost = {}
        state["n_i"], state["n_j"] = turn(state["n_i"], w_i * dt), turn(state["n_j"], w_j * dt)
        middle = (n_0 + n) / np.linalg.norm(n_0 + n)
        state["phi"] += (w_i - w_j) @ middle * dt
        for mode in MODES[1:] if self.friction else ():
            z, (k, limit) = self.displacements(pair, state, n)[mode], self.constants(pair)[mode]
            size = np.linalg.norm(z)
            if size <= limit:
                continue
            excess = (1 - limit / size) * z
            lost[mode] = k * limit * (size - limit)
            if mode == "twisting":
                state["phi"] -= excess
            elif mode == "sliding":
                state["n_i"] = state["n_i"] - excess / (pair.r_i + pair.r_j)
                state["n_j"] = state["n_j"] + excess / (pair.r_i + pair.r_j)
            else:
                state["n_i"], state["n_j"] = state["n_i"] - excess / pair.r_i, state["n_j"] - excess / pair.r_j
            for key in ("n_i", "n_j"):
                state[key] = state[key] / np.linalg.norm(state[key])
        return lost


class JKRWithDMT(JKR):
    """The same with the normal force of DMT, in SI units: K delta^1.5 - 4 pi gamma R, where r^2 = R delta."""

    def ends(self, pair, delta):
        return delta < 0.0

    def x(self, pair, delta):
        return sqrt(pair.R * max(delta, 0.0)) / pair.r0

    def normal(self, pair, delta):
        return pair.K * max(delta, 0.0) ** 1.5 - pair.f_adh

    def normal_potential(self, pair, delta):
        delta = max(delta, 0.0)
        return 2 / 5 * pair.K * delta**2.5 - pair.f_adh * delta


class DMT:
    """viscous_time: A of collision.md, by default the material's. friction: 'none', 'velocity', 'spring'.

    'velocity' uses eta = (2/7) m_red/tau (sliding), I_red/tau (rolling, twisting) with tau = period/20.
    'spring' keeps two vectors normal to n and a scalar:
    - sliding [m], integral of the tangential velocity of the contact points;
    - rolling [m], an axial vector, integral of R times the part of w_i - w_j normal to n, so torque_i = -M_lim xi/xi_c
      with M_lim = 2 (4 pi gamma R) xi_c, k_r = M_lim/(R xi_c) = 8 pi gamma, U = k_r xi^2/2;
    - twisting [1], integral of the part along n.
    The vectors go with the pair: shortest rotation from the old n to the new one, and a turn about n with the mean
    spin of both along n (this keeps the law the same for an observer that turns; it does no work).
    """

    def __init__(self, viscous_time=None, friction="spring"):
        self.A, self.friction = viscous_time, friction

    def start(self, pair, n):
        return {"sliding": np.zeros(3), "rolling": np.zeros(3), "twisting": 0.0}

    def ends(self, pair, delta):
        return delta < 0

    def normal(self, pair, delta):
        return pair.K * delta**1.5 - pair.f_adh

    def normal_potential(self, pair, delta):
        return 2 / 5 * pair.K * delta**2.5 - pair.f_adh * delta

    def c(self, pair, delta):
        return pair.K * (pair.T_vis if self.A is None else self.A) * sqrt(delta)

    def constants(self, pair, delta):
        """(spring, greatest displacement, greatest force or torque), a^2 = delta R; the torque of rolling is R k xi."""
        a, p = sqrt(delta * pair.R), pair
        k_s, k_r, k_t = 8 * a * p.G / (2 * (2 - p.nu)), 8 * pi * p.gamma, 8 / 3 * p.G * a**3
        return {
            "sliding": (k_s, a * (2 - p.nu) / (8 * pi), p.G * a**2 / (2 * pi)),
            "rolling": (k_r, p.xi_c, 2 * p.f_adh * p.xi_c),
            "twisting": (k_t, 1 / (8 * pi), p.G * a**3 / (3 * pi)),
        }

    def potential(self, pair, state, delta, n):
        k = self.constants(pair, delta)  # the state stays 0 unless friction is 'spring'
        energy = {mode: 0.5 * k[mode][0] * float(np.dot(state[mode], state[mode])) for mode in k}
        return energy | {"normal": self.normal_potential(pair, delta)}

    def rates(self, pair, d, n, v, w_i, w_j):
        l_i, l_j = pair.r_i * d / (pair.r_i + pair.r_j), pair.r_j * d / (pair.r_i + pair.r_j)
        slide = across(v - np.cross(l_i * w_i + l_j * w_j, n), n)
        return {"sliding": slide, "rolling": across(w_i - w_j, n), "twisting": (w_i - w_j) @ n}

    def force(self, pair, state, delta, n, v, w_i, w_j):
        d = pair.r_i + pair.r_j - delta
        c, approach = self.c(pair, delta), -(v @ n)
        F, T_i, T_j = (self.normal(pair, delta) + c * approach) * n, np.zeros(3), np.zeros(3)
        lost = {"damping": c * approach**2}
        if self.friction != "none":
            constants, pull = self.constants(pair, delta), {}
            for mode, rate in self.rates(pair, d, n, v, w_i, w_j).items():
                k, _, limit = constants[mode]
                if self.friction == "velocity":
                    eta = (2 / 7 * pair.m_red if mode == "sliding" else pair.I_red) / (pair.period / 20)
                    size = np.linalg.norm(rate)
                    strength = min(limit, eta * size)
                    pull[mode] = -strength * rate / size if size > 0 else 0.0 * rate
                    lost[mode] = strength * size
                else:
                    pull[mode] = -k * state[mode] * (pair.R if mode == "rolling" else 1)
            F = F + pull["sliding"]
            M = pull["rolling"] + pull["twisting"] * n
            lever = np.cross(n, pull["sliding"]) * d / (pair.r_i + pair.r_j)
            T_i, T_j = M - pair.r_i * lever, -M - pair.r_j * lever
        return F, T_i, T_j, lost

    def advance(self, pair, state, delta_0, delta, n_0, n, v, w_i, w_j, dt):
        """The springs follow delta without a force that pays for it; 'stiffness' is what they lose by that."""
        lost = {"stiffness": 0.0}
        if self.friction != "spring":
            return lost
        old, new = self.constants(pair, delta_0), self.constants(pair, delta)
        n_m = (n_0 + n) / np.linalg.norm(n_0 + n)
        d_m = pair.r_i + pair.r_j - (delta_0 + delta) / 2
        for mode, rate in self.rates(pair, d_m, n_m, v, w_i, w_j).items():
            before, (k, limit, _) = np.dot(state[mode], state[mode]), new[mode]
            if mode == "twisting":
                z = state[mode] + rate * dt
            else:
                z = turn(carry(state[mode], n_0, n_m), n_m * ((w_i + w_j) @ n_m * dt / 2))
                z = across(carry(z + rate * dt * (pair.R if mode == "rolling" else 1), n_m, n), n)
            size = np.linalg.norm(z)
            lost["stiffness"] -= (k - old[mode][0]) * (before + size**2) / 4
            if size > limit:
                lost[mode] = k * limit * (size - limit)
                z = z * (limit / size)
            state[mode] = z
        return lost
