"""The aggregate that everything else works on."""

import math
from functools import cached_property

import numpy as np

from ratd.base.checks import check_radii, check_seed, far_apart, is_number, number_array
from ratd.base.errors import InputError
from ratd.base.jit import jit
from ratd.base.materials import get_material, sphere_mass
from ratd.base.words import plural
from ratd.geometry.neighbours import close_pairs, connected_components
from ratd.geometry.shape import Shape
from ratd.laws.contact_constants import equilibrium_compression, reduced_radius

__all__ = ["GAP_TOLERANCE", "OVERLAP_TOLERANCE", "Grain", "gaps", "pressed", "seated"]

GAP_TOLERANCE = 0.1
"""Two monomers touch where the gap between them is less than this many equilibrium compressions."""

SEATED = 0.5
"""Part of its compression in equilibrium from which on a contact counts as pressed."""

OVERLAP_TOLERANCE = 3.0
"""Two monomers may overlap by no more than this many equilibrium compressions."""


@jit
def gaps(position, radius, pairs, surface_energy, reduced_modulus):
    """Gaps between the surfaces of pairs of monomers in units of their equilibrium compression.

    Parameters
    ----------
    position : (n, 3) float64 array
        Centres [m].
    radius : (n,) float64 array
        Radii [m].
    pairs : (k, 2) int64 array
        Pairs.
    surface_energy, reduced_modulus : float
        gamma [J m-2] and E* [Pa].

    Returns
    -------
    (k,) float64 array
        -delta/delta_0 [1]: -1 in equilibrium, 0 at first touch, above 0 where they are apart.
    """
    gap = np.empty(pairs.shape[0])
    for p in range(pairs.shape[0]):
        i = pairs[p, 0]
        j = pairs[p, 1]
        dx = position[i, 0] - position[j, 0]
        dy = position[i, 1] - position[j, 1]
        dz = position[i, 2] - position[j, 2]
        delta_0 = equilibrium_compression(reduced_radius(radius[i], radius[j]), surface_energy, reduced_modulus)
        gap[p] = (math.sqrt(dx * dx + dy * dy + dz * dz) - radius[i] - radius[j]) / delta_0
    return gap


class Grain:
    """An aggregate of spherical monomers at rest.

    Parameters
    ----------
    position : (n, 3) array_like
        Centres of the monomers [m].
    radius : (n,) array_like
        Radii [m].
    material : str or Material
        What the monomers are made of.
    type : str, optional
        "BA", "BAM1", "BAM2" or a name of your own.
    a_eff : float, optional
        Effective radius that was asked for [m]; must agree with the radii to 1e-9.
    seed : int, optional
        Seed that the grain was grown from.

    Attributes
    ----------
    position : (n, 3) float64 array
        Centres [m], C-contiguous, a copy.
    radius : (n,) float64 array
        Radii [m], a copy. A grain is not meant to change: make a new one instead of writing into its arrays.
    material : Material
    type, seed
        As given.
    contacts : (k, 2) int64 array
        Pairs of monomers that touch, i < j, sorted.
    a_eff : float
        Effective radius as given, else `effective_radius` [m].

    Raises
    ------
    InputError
        If the arrays do not fit together, hold fewer than two monomers, NaN or infinite values or radii that are not
        positive; if two monomers overlap by more than three equilibrium compressions; if the aggregate is in more
        than one piece (a gap of less than 0.1 equilibrium compressions counts as touching).

    Examples
    --------
    >>> grain = Grain([[0, 0, 0], [0, 0, 39.95e-9]], [20e-9, 20e-9], "q-S")
    >>> grain.n_contacts
    1
    """

    def __init__(self, position, radius, material, *, type=None, a_eff=None, seed=None):
        self.position = number_array(position, "position")
        self.radius = number_array(radius, "radius")
        self.material = get_material(material)
        self.type = type
        self.seed = None if seed is None else check_seed(seed)
        _check_arrays(self.position, self.radius)
        self.contacts, gap = _contacts(self.position, self.radius, self.material)
        _check_overlap(self.radius, self.material, self.contacts, gap)
        _check_one_piece(self.position, self.radius, self.material, self.contacts)
        if not (a_eff is None or is_number(a_eff)):
            raise InputError(f"a_eff is {a_eff!r}; it must be a number in m, or None.")
        self.a_eff = self.effective_radius if a_eff is None else float(a_eff)
        if not abs(self.a_eff / self.effective_radius - 1.0) <= 1e-9:
            raise InputError(
                f"a_eff is {self.a_eff:g} m, but the radii give {self.effective_radius:g} m; leave a_eff out, or give "
                "the cube root of the sum of the cubed radii."
            )

    def replace(self, *, position=None, material=None):
        """The same aggregate with its spheres elsewhere, or of another material.

        Parameters
        ----------
        position : (n, 3) array_like, optional
            Centres [m].
        material : Material or str, optional

        Returns
        -------
        Grain
            Radii, type and seed are those of this one, which does not grow anew.
        """
        position = self.position if position is None else position
        material = self.material if material is None else material
        return Grain(position, self.radius, material, type=self.type, a_eff=self.a_eff, seed=self.seed)

    @property
    def n_monomers(self):
        """Number of monomers."""
        return len(self.radius)

    @cached_property
    def mass(self):
        """Masses of the monomers [kg], (n,): 4/3 pi rho a^3."""
        return sphere_mass(self.radius, self.material.density)

    @cached_property
    def effective_radius(self):
        """Radius of the sphere of the same volume, (sum a^3)^(1/3) [m] (Eq. 2)."""
        return math.fsum(self.radius**3) ** (1.0 / 3.0)

    @property
    def n_contacts(self):
        """Number of contacts N_con."""
        return len(self.contacts)

    @property
    def enclosing_radius(self):
        """Radius of the smallest sphere around the aggregate [m], a_out of Fig. 1."""
        return self.shape.enclosing_radius

    @cached_property
    def shape(self):
        """Moments of inertia, axes, porosity, fractal dimension (`ratd.geometry.shape.Shape`)."""
        return Shape.measure(self.position, self.radius, self.material.density, self.n_contacts)

    def __repr__(self):
        return (
            f"Grain(type={self.type!r}, material={self.material.name!r}, a_eff={self.a_eff:.4g} m, seed={self.seed!r}, "
            f"n_monomers={self.n_monomers}, n_contacts={self.n_contacts})"
        )


def _check_arrays(position, radius):
    if radius.ndim != 1 or position.shape != (len(radius), 3):
        raise InputError(
            f"position has shape {position.shape} and radius {radius.shape}; they must be (n, 3) and (n,)."
        )
    if len(radius) < 2:
        raise InputError(f"The aggregate has {plural(len(radius), 'monomer')}; it needs at least 2.")
    for name, array in (("position", position), ("radius", radius)):
        wrong = np.flatnonzero(~np.isfinite(array.reshape(len(radius), -1)).all(axis=1))
        if len(wrong):
            raise InputError(f"{name}[{wrong[0]}] is {array[wrong[0]]}; every {name} must be a finite number in m.")
    wrong = np.flatnonzero(radius <= 0.0)
    if len(wrong):
        raise InputError(f"radius[{wrong[0]}] is {radius[wrong[0]]:g}; every radius must be above 0 (in m).")
    check_radii(radius)


def _contacts(position, radius, material):
    """Pairs of monomers that touch, (k, 2) int64, i < j, sorted, and their gaps in equilibrium compressions, (k,)."""
    near = close_pairs(position, radius, GAP_TOLERANCE * _widest(radius, material))
    gap = gaps(position, radius, near, material.surface_energy, material.reduced_modulus)
    touch = gap < GAP_TOLERANCE
    return near[touch], gap[touch]


def _widest(radius, material):
    """Equilibrium compression of two of the largest monomers [m]."""
    largest = float(np.max(radius))
    return _compression(largest, largest, material)


def _compression(a, b, material):
    """Equilibrium compression of two monomers of radii `a` and `b` [m]."""
    return equilibrium_compression(reduced_radius(a, b), material.surface_energy, material.reduced_modulus)


def _check_overlap(radius, material, contacts, gap):
    if np.any(gap < -OVERLAP_TOLERANCE):
        worst = int(np.argmin(gap))
        i, j = contacts[worst]
        unit = _compression(radius[i], radius[j], material)
        raise InputError(
            f"Monomers {i} and {j} overlap by {-gap[worst]:.3g} equilibrium compressions, {-gap[worst] * unit:.3g} m; "
            f"at most {OVERLAP_TOLERANCE:g} are allowed, {OVERLAP_TOLERANCE * unit:.3g} m. "
            "Is the unit of the lengths right? Monomers are counted from 0."
        )


def _check_one_piece(position, radius, material, contacts):
    label = connected_components(len(radius), contacts)
    pieces = int(label.max()) + 1
    if pieces > 1:
        hint = far_apart(position, radius)
        raise InputError(
            f"The aggregate is in {pieces} pieces; it must be in one, where monomers touch if the gap between them "
            f"is less than {GAP_TOLERANCE:g} equilibrium compressions."
            f"{hint or _nearest_of_two_pieces(position, radius, material, label)}"
        )


def _nearest_of_two_pieces(position, radius, material, label):
    """Sentence with the two monomers of different pieces that are nearest, for a message."""
    reach = GAP_TOLERANCE * _widest(radius, material)
    i = np.empty(0, np.int64)
    while not i.size:
        # all pairs of large pieces that are far apart would fill the memory
        if reach > radius.max():
            return f" No two monomers of different pieces are nearer to each other than {reach:.3g} m."
        reach *= 4.0
        i, j = close_pairs(position, radius, reach).T
        apart = label[i] != label[j]
        i, j = i[apart], j[apart]
    distance = np.linalg.norm(position[i] - position[j], axis=1) - radius[i] - radius[j]
    nearest = np.argmin(distance)
    i, j = i[nearest], j[nearest]
    allowed = GAP_TOLERANCE * _compression(radius[i], radius[j], material)
    return (
        f" Monomers {i} and {j}, counted from 0, are the nearest of different pieces: the gap between them is "
        f"{distance[nearest]:.3g} m and would have to be less than {allowed:.3g} m."
    )


def pressed(grain, by):
    """The aggregate, smaller by one factor, so that each contact is pressed by a part of its rest or more.

    Parameters
    ----------
    grain : Grain
    by : float
        Part of the equilibrium compression.

    Returns
    -------
    Grain
    """
    return _smaller(grain, max(0.0, np.max(_nearer(grain, by), initial=0.0)))


def seated(grain):
    """The aggregate with most of its contacts at rest, also where its spheres only touch.

    Spheres that only touch, as programs of others write them, are pulled together by adhesion all at once, and what
    that sets free may part them.

    Parameters
    ----------
    grain : Grain

    Returns
    -------
    Grain
        The same one; where more than half of the contacts are pressed by less than `SEATED` of their rest, one that is
        smaller by one factor, so that half of them are pressed to it. Spheres that are near may touch then, too. Where
        radii differ so much that some contact would be pressed by more than `OVERLAP_TOLERANCE`, one in which each
        sphere is brought to rest against the one before it, along a tree of contacts (`_seated_along_tree`).
    """
    if np.median(_nearer(grain, SEATED)) <= 0.0:
        return grain
    nearer = _nearer(grain, 1.0)
    part = np.median(nearer)
    i, j = grain.contacts.T
    distance = np.linalg.norm(grain.position[i] - grain.position[j], axis=1)
    # pressed by 1 with its own part, by more with a greater one
    deepest = np.max(1.0 + (part - nearer) * distance / _compression(grain.radius[i], grain.radius[j], grain.material))
    return _smaller(grain, part) if deepest <= OVERLAP_TOLERANCE else _seated_along_tree(grain)


def _seated_along_tree(grain):
    """The aggregate in which each contact of a tree that holds all spheres together is at rest.

    Every sphere moves, with all that follow it, along the line to the one before it. In an aggregate that is a tree all
    contacts are at rest then; others, which close a ring, are off by about as much as the first ones moved.
    """
    # few aggregates need this, and scipy takes longer to load than all else that they need
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import breadth_first_order

    i, j = grain.contacts.T
    n = len(grain.radius)
    joined = coo_array((np.ones(len(i)), (i, j)), shape=(n, n)).tocsr()
    order, before = breadth_first_order(joined, np.argmax(grain.radius), directed=False)
    moved = np.zeros_like(grain.position)
    for sphere in order[1:]:
        other = before[sphere]
        way = grain.position[other] - grain.position[sphere]
        length = np.linalg.norm(way)
        pair = grain.radius[sphere], grain.radius[other]
        wanted = sum(pair) - _compression(*pair, grain.material)
        moved[sphere] = moved[other] + (length - wanted) / length * way
    return grain.replace(position=grain.position + moved)


def _nearer(grain, by):
    """Part of its distance by which each contact must shorten to be pressed by a part of its rest."""
    i, j = grain.contacts.T
    constants = grain.material.surface_energy, grain.material.reduced_modulus
    delta_0 = equilibrium_compression(reduced_radius(grain.radius[i], grain.radius[j]), *constants)
    gap = gaps(grain.position, grain.radius, grain.contacts, *constants)
    return (gap + by) * delta_0 / (grain.radius[i] + grain.radius[j] + gap * delta_0)


def _smaller(grain, part):
    """The aggregate with all positions nearer to each other by a part."""
    return grain.replace(position=(1.0 - part) * grain.position)
