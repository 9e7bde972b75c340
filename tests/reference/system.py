"""Many spheres: all pairs, kick-drift-kick, free space or a periodic cube that changes its size.

Velocity is u = dx/dt - H x. One step, with F of x and of the velocity in phase with it (predicted by F/m dt/2):
    u -> (u + F/m dt/2) e^(-H dt/2), x -> (x e^(H dt/2) + u dt) e^(H dt/2), u -> u e^(-H dt/2) + F/m dt/2.
Spins the same without H. Second order in dt; momentum (and angular momentum in free space) exact.
Contacts: key (i, j, n_x, n_y, n_z), i <= j, with d = x_i - x_j + n L; n is for life, x is never wrapped.
"""

from itertools import product
from math import exp, pi
from typing import NamedTuple

import numpy as np

from .contact import MODES, Pair


class Cube(NamedTuple):
    """Periodic cube of side length exp(rate t). 'as_printed' adds -H^2 x with x in [-L/2, L/2) to du/dt."""

    length: float
    rate: float = 0.0
    scheme: str = "homogeneous"


class System:
    def __init__(self, position, radius, velocity, spin, material, law, box=None, contacts=None):
        self.x, self.u, self.w = (np.array(a, float).reshape(-1, 3) for a in (position, velocity, spin))
        self.r = np.broadcast_to(np.asarray(radius, float), len(self.x)).copy()
        self.m = 4 / 3 * pi * material.density * self.r**3
        self.I = 0.4 * self.m * self.r**2
        self.material, self.law, self.box = material, law, box
        self.L, self.H = (box.length, box.rate) if box else (np.inf, 0.0)
        self.pairs, self.state = {}, {}
        for key in contacts or ():  # without strain; not counted as made
            key = tuple(key) if len(key) == 5 else (*sorted(key[:2]), 0, 0, 0)
            self.state[key] = law.start(self.pair(key), self.pose(key)[1])

    def pair(self, key):
        radii = self.r[key[0]], self.r[key[1]]
        if radii not in self.pairs:
            self.pairs[radii] = Pair(self.material, *radii)
        return self.pairs[radii]

    def separation(self, key):
        return self.x[key[0]] - self.x[key[1]] + (self.L * np.array(key[2:]) if self.box else 0.0)

    def pose(self, key):
        """delta, n of a contact."""
        d = self.separation(key)
        size = np.linalg.norm(d)
        return self.r[key[0]] + self.r[key[1]] - size, d / size

    def find(self):
        """Make the contacts that begin; energy 'made'."""
        made, cells = 0.0, list(product((-1, 0, 1), repeat=3)) if self.box else [(0, 0, 0)]
        for i in range(len(self.x)):
            for j in range(i, len(self.x)):
                base = -np.round((self.x[i] - self.x[j]) / self.L)  # nearest image
                for cell in cells:
                    key = (i, j, *(int(k) for k in base + cell))
                    if key in self.state or (i == j and cell <= (0, 0, 0)):  # an own image counts once
                        continue
                    delta, normal = self.pose(key)
                    if delta >= 0:
                        self.state[key] = self.law.start(self.pair(key), normal)
                        made -= sum(self.energy_of(key).values())
        return made

    def forces(self):
        """F, torques, power lost by mode, virial tensor sum d F; the body force of 'as_printed' and its power."""
        F, T, virial, power = np.zeros_like(self.x), np.zeros_like(self.x), np.zeros((3, 3)), {}
        for key, state in self.state.items():
            i, j = key[:2]
            v = self.u[i] - self.u[j] + self.H * self.separation(key)
            f, T_i, T_j, lost = self.law.force(self.pair(key), state, *self.pose(key), v, self.w[i], self.w[j])
            for k, sign, torque in ((i, 1, T_i), (j, -1, T_j)):  # i = j: an own image
                F[k] += sign * f
                T[k] += torque
            virial += np.outer(self.separation(key), f)
            power = {k: power.get(k, 0.0) + lost.get(k, 0.0) for k in power.keys() | lost.keys()}
        body = np.zeros_like(self.x)
        if self.box and self.box.scheme == "as_printed":
            body = -self.m[:, None] * self.H**2 * ((self.x + self.L / 2) % self.L - self.L / 2)
        return F + body, T, power, virial, float(np.sum(body * self.u))

    def energy_of(self, key):
        return self.law.potential(self.pair(key), self.state[key], *self.pose(key))

    def potential(self):
        energies = [self.energy_of(key) for key in self.state]
        return {mode: sum(energy[mode] for energy in energies) for mode in MODES}

    def kinetic(self):
        return 0.5 * float(self.m @ np.sum(self.u**2, 1)), 0.5 * float(self.I @ np.sum(self.w**2, 1))

    def step(self, dt, now):
        """One step from `now`, what forces() gave; returns what it gives at the end, and the energy lost."""
        F, T, *_ = now
        half, m, moment, lost = exp(self.H * dt / 2), self.m[:, None], self.I[:, None], {}
        old = {key: (*self.pose(key), sum(self.energy_of(key).values())) for key in self.state}
        self.u, self.w = (self.u + F / m * dt / 2) / half, self.w + T / moment * dt / 2
        self.x, self.L = (self.x * half + self.u * dt) * half, self.L * half**2
        for key, (delta_0, n_0, held) in old.items():
            (i, j), pair, (delta, n) = key[:2], self.pair(key), self.pose(key)
            if self.law.ends(pair, delta):
                del self.state[key]
                change = {"broken": held}
            else:  # mean velocity: the way from pose to pose over dt
                v = (self.separation(key) - (pair.r_i + pair.r_j - delta_0) * n_0) / dt
                motion = delta_0, delta, n_0, n, v, self.w[i], self.w[j], dt
                change = self.law.advance(pair, self.state[key], *motion)
            lost = {k: lost.get(k, 0.0) + change.get(k, 0.0) for k in lost.keys() | change.keys()}
        lost["made"] = self.find()
        u, w = self.u / half, self.w
        self.u, self.w = u + F / m * dt / 2, w + T / moment * dt / 2  # predicted
        now = self.forces()
        self.u, self.w = u + now[0] / m * dt / 2, w + now[1] / moment * dt / 2
        return now, lost


LOST = ("damping", "sliding", "rolling", "twisting", "made", "broken", "stiffness")


def run(position, radius, velocity, spin, material, *, law, box=None, dt, steps, contacts=None, every=1):
    """Time series as a dict of arrays, "system" the state at the end.

    `contacts`: (i, j) or keys that exist at the start, without strain; others that begin at t = 0 count as made.
    - kinetic: translation, spin; potential by mode; dissipated by mode, with 'stiffness' (see DMT.advance);
    - momentum, angular_momentum; length; contacts (number); pressure [P_ab] with peculiar velocities;
    - work: 'box', -int P dV, and 'body', of the force of 'as_printed';
    - residual: (energy + dissipated - work) - start [J]; residual_pages leaves 'stiffness' out. 'made' is -U at the
      first position with delta >= 0, so the half kick of the new force, F v dt/2 for each new contact, stays in it.
    """
    s = System(position, radius, velocity, spin, material, law, box, contacts)
    lost, work, out = dict.fromkeys(LOST, 0.0), {"box": 0.0, "body": 0.0}, []
    start = sum(s.kinetic()) + sum(s.potential().values())
    lost["made"] = s.find()
    now = s.forces()

    def pressure():
        volume = s.L**3 if s.box else np.inf
        return ((s.m[:, None] * s.u).T @ s.u + (now[3] + now[3].T) / 2) / volume

    for k in range(steps + 1):
        if k % every == 0:
            potential, (translation, turning) = s.potential(), s.kinetic()
            residual = translation + turning + sum(potential.values()) + sum(lost.values()) - sum(work.values()) - start
            out.append({
                "time": k * dt, "kinetic": {"translation": translation, "spin": turning}, "potential": potential,
                "dissipated": dict(lost), "work": dict(work), "residual": residual,
                "residual_pages": residual - lost["stiffness"], "contacts": len(s.state), "length": s.L,
                "momentum": s.m @ s.u, "pressure": pressure(),
                "angular_momentum": np.sum(s.m[:, None] * np.cross(s.x, s.u) + s.I[:, None] * s.w, 0),
            })  # fmt: skip
        if k == steps:
            break
        before, P, V = now, np.trace(pressure()) / 3, s.L**3
        now, change = s.step(dt, now)
        for mode in set(before[2]) | set(now[2]):
            lost[mode] += (before[2].get(mode, 0.0) + now[2].get(mode, 0.0)) * dt / 2
        for mode, energy in change.items():
            lost[mode] += energy
        if s.box:
            work["box"] -= (P + np.trace(pressure()) / 3) / 2 * (s.L**3 - V)
        work["body"] += (before[4] + now[4]) * dt / 2
    series = {key: [row[key] for row in out] for key in out[0]}
    for key, rows in series.items():
        modes = rows[0] if isinstance(rows[0], dict) else None
        series[key] = {mode: np.array([row[mode] for row in rows]) for mode in modes} if modes else np.array(rows)
    return series | {"system": s}
