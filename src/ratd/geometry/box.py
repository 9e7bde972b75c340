"""Boxes: open space, and a periodic box whose edges may grow or shrink.

Positions are kept unwrapped. Each contact and each pair of near monomers stores its image, three integers n for life:
n L is added to X_i - X_j. In a box that changes, velocities are peculiar, u = v - H x, so that crossing a face changes
nothing.
"""

import math
from typing import NamedTuple

import numpy as np

from ratd.base.errors import InputError
from ratd.base.jit import jit
from ratd.base.parts import part
from ratd.geometry.neighbours import close_images, close_pairs
from ratd.laws.contact_fields import (
    DVX, DVY, DVZ, DX, DY, DZ, FX, FY, FZ, LANES, VXX, VXY, VXZ, VYY, VYZ, VZZ,
)  # fmt: skip

__all__ = ["SCHEMES", "Open", "Periodic", "open_space", "periodic", "touching_pairs"]

SCHEMES = ("homogeneous", "as_printed")


@part
class Open(NamedTuple):
    """Open space; made by `open_space`.

    Attributes
    ----------
    open : bool
        Always true; numba passes no tuple without fields.
    """

    open: bool

    def edges(self, scalar):
        return 0.0, 0.0, 0.0

    def rates(self):
        return 0.0, 0.0, 0.0

    def place_images(self, image, scratch, begin, count, edges):
        pass

    def add_virial(self, scratch, count):
        pass

    def sum_virial(self, scratch, scalar, at):
        pass


@part
class Periodic(NamedTuple):
    """A periodic box with edges L(t) = L_0 exp(H t) along x, y and z; made by `periodic`.

    Attributes
    ----------
    length_x, length_y, length_z : float
        Edges [m] at time 0.
    rate_x, rate_y, rate_z : float
        H [1/s], (dL/dt)/L; negative where it shrinks.
    as_printed : bool
        Whether free monomers fly straight (Kataoka et al. 2013, Eqs. 8-12, with the right sign), which leaves copies
        accelerated against each other; else they are at rest against the box.
    """

    length_x: float
    length_y: float
    length_z: float
    rate_x: float
    rate_y: float
    rate_z: float
    as_printed: bool

    def edges(self, scalar):
        time = scalar[0]
        return (
            self.length_x * math.exp(self.rate_x * time),
            self.length_y * math.exp(self.rate_y * time),
            self.length_z * math.exp(self.rate_z * time),
        )

    def rates(self):
        return self.rate_x, self.rate_y, self.rate_z

    def place_images(self, image, scratch, begin, count, edges):
        _place_images(image, scratch, begin, count, edges, (self.rate_x, self.rate_y, self.rate_z))

    def add_virial(self, scratch, count):
        _add_virial(scratch, count)

    def sum_virial(self, scratch, scalar, at):
        # A lane at a time, in a fixed order.
        for component, field in enumerate((VXX, VYY, VZZ, VXY, VXZ, VYZ)):
            total = 0.0
            for lane in range(LANES):
                total += scratch[field + np.uint64(lane)]
                scratch[field + np.uint64(lane)] = 0.0
            scalar[at + component] = total


@jit(forceinline=True)
def _place_images(image, scratch, begin, count, edges, rates):
    """Add n L to the differences of positions, and H times that to those of the velocities."""
    lx, ly, lz = edges
    hx, hy, hz = rates
    at = (begin // np.uint64(LANES)) * np.uint64(3 * LANES)
    for lane in range(count):
        q = np.uint64(lane)
        dx = scratch[DX + q] + image[at + q] * lx
        dy = scratch[DY + q] + image[at + np.uint64(LANES) + q] * ly
        dz = scratch[DZ + q] + image[at + np.uint64(2 * LANES) + q] * lz
        scratch[DX + q] = dx
        scratch[DY + q] = dy
        scratch[DZ + q] = dz
        scratch[DVX + q] += hx * dx
        scratch[DVY + q] += hy * dy
        scratch[DVZ + q] += hz * dz


@jit(forceinline=True)
def _add_virial(scratch, count):
    for lane in range(count):
        q = np.uint64(lane)
        dx = scratch[DX + q]
        dy = scratch[DY + q]
        dz = scratch[DZ + q]
        fx = scratch[FX + q]
        fy = scratch[FY + q]
        fz = scratch[FZ + q]
        scratch[VXX + q] += dx * fx
        scratch[VYY + q] += dy * fy
        scratch[VZZ + q] += dz * fz
        scratch[VXY + q] += 0.5 * (dx * fy + dy * fx)
        scratch[VXZ + q] += 0.5 * (dx * fz + dz * fx)
        scratch[VYZ + q] += 0.5 * (dy * fz + dz * fy)


def open_space():
    """Open space."""
    return Open(True)


def periodic(length, rate=0.0, *, scheme="homogeneous"):
    """A periodic box.

    Parameters
    ----------
    length : float or (3,) array_like
        Edge, or edges along x, y and z [m].
    rate : float or (3,) array_like
        H = (dL/dt)/L [1/s] of all edges or of each: negative where the box shrinks. For the strain rate C_v of Kataoka
        et al. (2013) it is -2 C_v/t0 (Eqs. 6, 7).
    scheme : {"homogeneous", "as_printed"}
        "homogeneous": du/dt = F/m - H u with the peculiar velocity u = v - H x, the same everywhere. "as_printed": free
        monomers fly straight, which is -H^2 x in addition and depends on where the faces lie (their Eqs. 8-12).

    Returns
    -------
    Periodic

    Raises
    ------
    InputError
    """
    if scheme not in SCHEMES:
        raise InputError(f"scheme is {scheme!r}; allowed are {', '.join(SCHEMES)}.")
    values = []
    for name, value in (("length", length), ("rate", rate)):
        try:
            three = np.asarray(value, dtype=float)
        except (TypeError, ValueError):
            three = np.full(3, np.nan)
        if three.shape not in ((), (3,)) or not np.isfinite(three).all() or (name == "length" and (three <= 0).any()):
            allowed = "a finite number" + (" above 0" if name == "length" else "") + ", or three of them"
            raise InputError(f"The {name} of a periodic box is {value!r}; it must be {allowed}.")
        values += np.broadcast_to(three, 3).tolist()
    return Periodic(*values, as_printed=scheme == "as_printed")


@jit
def touching_pairs(position, radius, box):
    """Pairs of spheres that overlap, with images, (k, 5) int64 (see `close_images`).

    Parameters
    ----------
    position : (n, 3) float64 array
        Centres [m].
    radius : (n,) float64 array
        Radii [m].
    box : part
        At its start.
    """
    return pairs_within(position, radius, 0.0, box.edges(np.zeros(1)))


@jit
def pairs_within(position, radius, reach, edges):
    """Pairs with images, (k, 5) int64, whose surfaces are closer than `reach`; `edges` are 0 in open space."""
    if edges[0] > 0.0:
        return close_images(position, radius, reach, edges)
    found = close_pairs(position, radius, reach)
    pairs = np.zeros((found.shape[0], 5), dtype=np.int64)
    # not array to array, which alone takes seconds to compile
    for p in range(found.shape[0]):
        pairs[p, 0] = found[p, 0]
        pairs[p, 1] = found[p, 1]
    return pairs
