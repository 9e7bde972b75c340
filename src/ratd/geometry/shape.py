"""Shape of an aggregate: moments of inertia, axes, porosity, fractal dimension, enclosing sphere (Eqs. 3-8)."""

import itertools
import math
from dataclasses import dataclass

import numpy as np

from ratd.base.jit import jit
from ratd.base.materials import sphere_mass

__all__ = [
    "INNER_PART",
    "Shape",
    "centre_of_mass",
    "enclosing_radius",
    "enclosing_sphere",
    "fractal_dimension",
    "greatest_extent",
    "inertia_tensor",
    "mean_coordination",
    "porosity",
    "principal_axes",
    "semi_axes",
    "shape_of",
    "spin_share",
]

INNER_PART = 0.6
"""Part of the monomers, those nearest to the centre of mass, from which the fractal dimension is measured."""


@jit
def centre_of_mass(position, mass):
    """Centre of mass [m], (3,), of monomers at `position` (n, 3) [m] with masses `mass` (n,) [kg]."""
    centre = np.zeros(3)
    total = 0.0
    for i in range(mass.shape[0]):
        total += mass[i]
        for axis in range(3):
            centre[axis] += mass[i] * position[i, axis]
    for axis in range(3):
        centre[axis] /= total
    return centre


@jit
def inertia_tensor(position, mass, radius):
    """Inertia tensor of solid spheres about their common centre of mass.

    Parameters
    ----------
    position : (n, 3) float64 array
        Centres [m].
    mass : (n,) float64 array
        Masses [kg].
    radius : (n,) float64 array
        Radii [m]; each sphere adds its own 2/5 m a^2.

    Returns
    -------
    (3, 3) float64 array
        [kg m2].
    """
    centre = centre_of_mass(position, mass)
    tensor = np.zeros((3, 3))
    for i in range(mass.shape[0]):
        x = position[i, 0] - centre[0]
        y = position[i, 1] - centre[1]
        z = position[i, 2] - centre[2]
        own = 0.4 * radius[i] * radius[i]
        tensor[0, 0] += mass[i] * (y * y + z * z + own)
        tensor[1, 1] += mass[i] * (z * z + x * x + own)
        tensor[2, 2] += mass[i] * (x * x + y * y + own)
        tensor[0, 1] -= mass[i] * x * y
        tensor[1, 2] -= mass[i] * y * z
        tensor[2, 0] -= mass[i] * z * x
    tensor[1, 0] = tensor[0, 1]
    tensor[2, 1] = tensor[1, 2]
    tensor[0, 2] = tensor[2, 0]
    return tensor


@jit
def _diagonalise(tensor):
    """Eigenvalues (3,), greatest first, and eigenvectors (rows of a (3, 3) array) of a symmetric tensor.

    Jacobi's rotations: a 3x3 tensor needs no more than a few sweeps, and the result is exact to rounding also where
    two eigenvalues agree.
    """
    a = tensor.copy()
    vectors = np.eye(3)
    size = 0.0
    for i in range(3):
        for j in range(3):
            size = max(size, abs(a[i, j]))
    for _ in range(50):
        if max(abs(a[0, 1]), abs(a[0, 2]), abs(a[1, 2])) <= 1e-17 * size:
            break
        for p in range(2):
            for q in range(p + 1, 3):
                if a[p, q] == 0.0:
                    continue
                half = (a[q, q] - a[p, p]) / (2.0 * a[p, q])
                t = 1.0 / (abs(half) + math.sqrt(half * half + 1.0))
                if half < 0.0:
                    t = -t
                c = 1.0 / math.sqrt(t * t + 1.0)
                s = t * c
                r = 3 - p - q
                a[p, p] -= t * a[p, q]
                a[q, q] += t * a[p, q]
                a[p, q] = 0.0
                a[q, p] = 0.0
                rp = c * a[r, p] - s * a[r, q]
                rq = s * a[r, p] + c * a[r, q]
                a[r, p] = rp
                a[p, r] = rp
                a[r, q] = rq
                a[q, r] = rq
                for axis in range(3):
                    vp = c * vectors[p, axis] - s * vectors[q, axis]
                    vectors[q, axis] = s * vectors[p, axis] + c * vectors[q, axis]
                    vectors[p, axis] = vp
    values = np.array([a[0, 0], a[1, 1], a[2, 2]])
    for last in (2, 1):
        for k in range(last):
            if values[k] < values[k + 1]:
                values[k], values[k + 1] = values[k + 1], values[k]
                for axis in range(3):
                    keep = vectors[k, axis]
                    vectors[k, axis] = vectors[k + 1, axis]
                    vectors[k + 1, axis] = keep
    return values, vectors


@jit
def principal_axes(position, mass, radius):
    """Principal moments of inertia and axes.

    Parameters
    ----------
    position : (n, 3) float64 array
        Centres [m].
    mass, radius : (n,) float64 array
        Masses [kg] and radii [m].

    Returns
    -------
    moments : (3,) float64 array
        I_1 >= I_2 >= I_3 [kg m2].
    axes : (3, 3) float64 array
        Unit vectors a_1, a_2, a_3 as rows, right-handed. Of the two senses of a_1 and of a_2 the one is taken in
        which the component of greatest magnitude is positive.
    """
    moments, axes = _diagonalise(inertia_tensor(position, mass, radius))
    for k in range(2):
        largest = 0
        for axis in range(1, 3):
            # The margin keeps the choice from hanging on the last bit where two components are alike.
            if abs(axes[k, axis]) > abs(axes[k, largest]) * (1.0 + 1e-9):
                largest = axis
        if axes[k, largest] < 0.0:
            for axis in range(3):
                axes[k, axis] = -axes[k, axis]
    axes[2, 0] = axes[0, 1] * axes[1, 2] - axes[0, 2] * axes[1, 1]
    axes[2, 1] = axes[0, 2] * axes[1, 0] - axes[0, 0] * axes[1, 2]
    axes[2, 2] = axes[0, 0] * axes[1, 1] - axes[0, 1] * axes[1, 0]
    return moments, axes


@jit
def semi_axes(moments, density, a_eff):
    """Semi-axes of the homogeneous ellipsoid of the aggregate's mass and moments of inertia (Eqs. 3-6).

    Parameters
    ----------
    moments : (3,) float64 array
        I_1 >= I_2 >= I_3 [kg m2].
    density : float
        rho [kg m-3] of the solid.
    a_eff : float
        Effective radius [m].

    Returns
    -------
    (3,) float64 array
        a <= b <= c [m]; NaN where the moments are not those of a body.

    Notes
    -----
    alpha_k = 15/(8 pi) I_k/(rho a_eff^5) is the ratio to the moment of inertia of a solid sphere of radius a_eff. The
    paper prints 5/(4 pi), which gives a solid sphere a porosity of -0.84.
    """
    per_moment = 15.0 / (8.0 * math.pi * density * a_eff**5)
    axis = np.empty(3)
    for k in range(3):
        # Each moment counts positive but that about the axis itself.
        axis[k] = a_eff * math.sqrt(per_moment * (moments[(k + 1) % 3] + moments[(k + 2) % 3] - moments[k]))
    return axis


@jit
def porosity(a, b, c, a_eff):
    """P = 1 - a_eff^3/(a b c) (Eq. 7) from semi-axes and effective radius [m]; the filling factor is 1 - P."""
    return 1.0 - a_eff**3 / (a * b * c)


@jit
def shape_of(position, mass, radius, density):
    """Semi-axes and porosity in one call, cheap enough for every record of a run.

    Parameters
    ----------
    position : (n, 3) float64 array
        Centres [m].
    mass, radius : (n,) float64 array
        Masses [kg] and radii [m].
    density : float
        rho [kg m-3] of the solid.

    Returns
    -------
    a, b, c : float
        Semi-axes a <= b <= c [m] (Eqs. 4-6).
    porosity : float
        P [1] (Eq. 7). All four are NaN for no monomers at all.
    """
    if mass.shape[0] == 0:
        return math.nan, math.nan, math.nan, math.nan
    volume = 0.0
    for i in range(radius.shape[0]):
        volume += radius[i] ** 3
    a_eff = volume ** (1.0 / 3.0)
    moments, _ = _diagonalise(inertia_tensor(position, mass, radius))
    axis = semi_axes(moments, density, a_eff)
    return axis[0], axis[1], axis[2], porosity(axis[0], axis[1], axis[2], a_eff)


def enclosing_sphere(position, radius):
    """Smallest sphere that encloses spheres.

    Parameters
    ----------
    position : (n, 3) array
        Centres [m].
    radius : (n,) array
        Radii [m].

    Returns
    -------
    centre : (3,) float64 array
        [m].
    radius : float
        [m].

    Notes
    -----
    Exact but for rounding (1e-10). At most four spheres touch the smallest sphere from inside; as in the simplex
    method, the sphere that sticks out farthest joins those that now hold it, and the smallest sphere around these
    few is found by trying all subsets of them (the sphere that touches a given subset follows from linear equations
    and one quadratic, as in Fischer & Gaertner 2003, The smallest enclosing ball of balls). The radius grows with
    every exchange, so that this ends.
    """
    position = np.asarray(position, dtype=np.float64)
    radius = np.asarray(radius, dtype=np.float64)
    # Everything in units of the size of the whole, from its middle, so that rounding is judged alike everywhere.
    middle = 0.5 * (position.max(axis=0) + position.min(axis=0))
    unit = np.max(np.linalg.norm(position - middle, axis=1) + radius)
    x = (position - middle) / unit
    a = radius / unit
    support = [int(np.argmax(np.linalg.norm(x, axis=1) + a))]
    centre, size = x[support[0]], a[support[0]]
    while True:
        reach = np.linalg.norm(x - centre, axis=1) + a
        farthest = int(np.argmax(reach))
        if reach[farthest] <= size + 1e-10 or farthest in support:
            break
        found = _smallest_around(x, a, [*support, farthest])
        if found is None or found[1] <= size:
            break
        centre, size, support = found
    # What rounding has left over is added, so that the sphere does enclose everything.
    size = np.max(np.linalg.norm(x - centre, axis=1) + a)
    return middle + unit * centre, float(unit * size)


def _smallest_around(x, a, members):
    """(centre, radius, support) of the smallest sphere around up to five spheres; None where rounding finds none."""
    best = None
    for count in range(1, min(len(members), 4) + 1):
        for subset in itertools.combinations(members, count):
            touching = _touching_sphere(x[list(subset)], a[list(subset)])
            if touching is None or (best is not None and touching[1] >= best[1]):
                continue
            centre, size = touching
            if np.all(np.linalg.norm(x[members] - centre, axis=1) + a[members] <= size + 1e-12):
                best = centre, size, list(subset)
    return best


def _touching_sphere(x, a):
    """Smallest sphere that all of up to four spheres touch from inside, its centre in their affine hull, or None."""
    if len(a) == 1:
        return x[0], a[0]
    # |c|^2 = (r - a_0)^2 and |c - q_k|^2 = (r - a_k)^2 with q_k = x_k - x_0; their differences are linear in c and r.
    q = x[1:] - x[0]
    constant = 0.5 * (np.sum(q * q, axis=1) + a[0] ** 2 - a[1:] ** 2)
    slope = a[1:] - a[0]
    try:
        u, v = (q.T @ np.linalg.solve(q @ q.T, np.stack([constant, slope], axis=1))).T
    except np.linalg.LinAlgError:
        return None
    # c = u + v r, so that (v.v - 1) r^2 + 2 (u.v + a_0) r + u.u - a_0^2 = 0.
    roots = np.roots([v @ v - 1.0, 2.0 * (u @ v + a[0]), u @ u - a[0] ** 2])
    usable = [root.real for root in roots if abs(root.imag) < 1e-9 and root.real >= a.max() * (1.0 - 1e-12)]
    if not usable:
        return None
    size = min(usable)
    return x[0] + u + v * size, size


def enclosing_radius(position, radius):
    """Radius [m] of the smallest sphere around an aggregate, a_out of Fig. 1 (see `enclosing_sphere`)."""
    return enclosing_sphere(position, radius)[1]


def greatest_extent(position, radius):
    """Greatest width [m] of an aggregate along x, y or z: the edge of the box in which copies of it touch."""
    return float(((position + radius[:, None]).max(axis=0) - (position - radius[:, None]).min(axis=0)).max())


def fractal_dimension(position, mass):
    """Fractal dimension from the slope of the monomer density against distance from the centre of mass (Eq. 8).

    Parameters
    ----------
    position : (n, 3) array
        Centres [m].
    mass : (n,) array
        Masses [kg], for the centre of mass.

    Returns
    -------
    value : float
        D_f [1]; NaN for fewer than nine monomers.
    error : float
        Its standard error [1] from the scatter about the fit.

    Notes
    -----
    C chi^(D_f - 3) = n(chi)/(4 pi chi^2 l N_mon) is fitted as a straight line in logarithms, without weights. Two
    things are decided here that the paper leaves open.

    Shells of one thickness l << a_eff are empty or hold one monomer in most grains. Instead, the M monomers that
    count are shared out over about sqrt(M) shells of about sqrt(M) monomers, at least two: no shell is empty, all
    have the same relative error of counting (hence no weights), and ten monomers still give three points. Shells
    meet half-way between the monomers on both sides; chi is such that 4 pi chi^2 l is exactly the shell's volume.

    Shells farther out than the nearest surface are only partly inside the aggregate, and the density falls there for
    a reason that is not the fractal structure: a fit of all shells gives 1.2 to 1.4 for every grain of this paper,
    also for the compact ones. Only the innermost 60 % of the monomers count; in a homogeneous ball they lie within
    0.84 of its radius. The value of grains with fewer than about 100 monomers is uncertain by 0.4 or more.
    """
    position = np.ascontiguousarray(position, dtype=np.float64)
    mass = np.ascontiguousarray(mass, dtype=np.float64)
    n = len(mass)
    inside = math.ceil(INNER_PART * n)
    shells = inside // max(2, math.isqrt(inside))
    if shells < 3:
        return math.nan, math.nan
    distance = np.sort(np.linalg.norm(position - centre_of_mass(position, mass), axis=1))
    counts = np.full(shells, inside // shells)
    counts[: inside % shells] += 1
    last = np.cumsum(counts)
    edge = np.concatenate([[0.0], 0.5 * (distance[last - 1] + distance[last])])
    inner, outer = edge[:-1], edge[1:]
    if np.any(outer <= inner):
        return math.nan, math.nan
    chi = np.sqrt((inner**2 + inner * outer + outer**2) / 3.0)
    density = counts / (4.0 * math.pi * chi**2 * (outer - inner) * n)
    x = np.log(chi) - np.mean(np.log(chi))
    y = np.log(density) - np.mean(np.log(density))
    slope = (x @ y) / (x @ x)
    residual = y - slope * x
    return float(3.0 + slope), math.sqrt((residual @ residual) / ((shells - 2) * (x @ x)))


def spin_share(radius, density, moment_1):
    """Share of the monomers' own moments of inertia in that of the whole, I_spin/(I_orbit + I_spin).

    Parameters
    ----------
    radius : array_like, shape (n,)
        Radii of the monomers [m].
    density : float
        [kg m-3].
    moment_1 : float
        Greatest moment of inertia I_1 of the grain, that of the monomers included [kg m2].

    Returns
    -------
    float
        sum(2/5 m_i a_i^2)/I_1 (docs/model/drives.md, literal).
    """
    return float(np.sum(8.0 / 15.0 * np.pi * density * np.asarray(radius) ** 5) / moment_1)


def mean_coordination(n_monomers, n_contacts):
    """Contacts per monomer, 2 N_con/N_mon [1]."""
    return 2.0 * n_contacts / n_monomers


@dataclass(frozen=True, eq=False)
class Shape:
    """Shape of an aggregate, as `Grain.shape` gives it.

    Attributes
    ----------
    moments : (3,) float64 array
        Principal moments of inertia I_1 >= I_2 >= I_3 [kg m2].
    axes : (3, 3) float64 array
        Principal axes a_1, a_2, a_3 as rows [1].
    a, b, c : float
        Semi-axes a <= b <= c [m] (Eqs. 4-6).
    porosity : float
        P [1] (Eq. 7).
    fractal_dimension, fractal_dimension_error : float
        D_f and its standard error [1] (Eq. 8); NaN for fewer than nine monomers.
    enclosing_radius : float
        Radius of the smallest enclosing sphere [m].
    mean_coordination : float
        Contacts per monomer [1].
    spin_share : float
        Share of the monomers' own moments of inertia in I_1 [1].
    """

    moments: np.ndarray
    axes: np.ndarray
    a: float
    b: float
    c: float
    porosity: float
    fractal_dimension: float
    fractal_dimension_error: float
    enclosing_radius: float
    mean_coordination: float
    spin_share: float

    @property
    def filling_factor(self):
        """phi = 1 - P [1]."""
        return 1.0 - self.porosity

    @classmethod
    def measure(cls, position, radius, density, n_contacts):
        """Shape of an aggregate.

        Parameters
        ----------
        position : (n, 3) float64 array
            Centres [m].
        radius : (n,) float64 array
            Radii [m].
        density : float
            rho [kg m-3] of the solid.
        n_contacts : int
            Number of contacts.

        Returns
        -------
        Shape
        """
        mass = sphere_mass(radius, density)
        moments, axes = principal_axes(position, mass, radius)
        a, b, c, p = shape_of(position, mass, radius, density)
        value, error = fractal_dimension(position, mass)
        return cls(
            moments=moments,
            axes=axes,
            a=a,
            b=b,
            c=c,
            porosity=p,
            fractal_dimension=value,
            fractal_dimension_error=error,
            enclosing_radius=enclosing_radius(position, radius),
            mean_coordination=mean_coordination(len(radius), n_contacts),
            spin_share=spin_share(radius, density, moments[0]),
        )
