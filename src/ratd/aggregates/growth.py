"""Growth of aggregates monomer by monomer: ballistic, with none, one or two migrations (Sect. 3)."""

import hashlib
import math
from dataclasses import dataclass

import numpy as np

from ratd.aggregates.grain import Grain
from ratd.base.errors import InputError
from ratd.base.jit import jit
from ratd.base.materials import equilibrium_compression, get_material, reduced_radius
from ratd.geometry.shape import centre_of_mass

__all__ = ["MIGRATIONS", "TYPES", "RadiusDistribution", "draw_radii", "grow", "grow_with_radii", "smallest_a_eff"]

TYPES = {"BA": 0, "BAM1": 1, "BAM2": 2}
"""Aggregation models by name, with the number of times that a monomer migrates after its first touch."""

MIGRATIONS = ("random", "nearest")
"""How a monomer rolls on: in a random direction, or the shortest way to a place of more contacts."""

MOST_MONOMERS = 1_000_000
"""Greatest expected number of monomers that `grow` accepts."""

_MOST_PATHS = 1_000_000
"""Sequences of radii that are tried before a_eff is said to be out of reach."""

_MOST_HITS = 20_000
"""Hits on the aggregate after which a monomer that finds no place with all its contacts makes do with one fewer."""


@dataclass(frozen=True)
class RadiusDistribution:
    """Lognormal distribution of the monomer radii, cut at both ends by rejection.

    Parameters
    ----------
    median : float
        Median before the cut [m].
    sigma_ln : float
        Standard deviation of ln a before the cut [1].
    smallest, largest : float
        Ends of the range that is kept [m].

    Raises
    ------
    InputError
        If a value is not a positive finite number, if smallest is not below largest, or if the range holds less than
        a thousandth of the uncut distribution.

    Notes
    -----
    The paper's "average 20 nm, standard deviation 1.65 nm" cannot give its own numbers of monomers, which need
    <a^3>^(1/3) = 40.9 nm. The default gives that. `RadiusDistribution(8.77e-9, 1.2845)`, i.e. a mean of 20 nm before
    the cut with a variance of ln a of 1.65, is the other reading and gives 40.3 nm.
    """

    median: float = 20e-9
    sigma_ln: float = 0.844
    smallest: float = 10e-9
    largest: float = 100e-9

    def __post_init__(self):
        for name in ("median", "sigma_ln", "smallest", "largest"):
            value = getattr(self, name)
            number = isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)
            if not (number and value > 0.0):
                raise InputError(f"{name} of the monomer radii is {value!r}; it must be a number above 0.")
        if not self.smallest < self.largest:
            raise InputError(
                f"smallest and largest of the monomer radii are {self.smallest:g} m and {self.largest:g} m; "
                "smallest must be below largest."
            )
        if not self.kept >= 1e-3:
            raise InputError(
                f"Only {self.kept:.2g} of the monomer radii with median {self.median:g} m and sigma_ln "
                f"{self.sigma_ln:g} lie between {self.smallest:g} m and {self.largest:g} m; it must be at least 0.001."
            )

    def _part(self, k, largest=None):
        """Part of the uncut distribution, weighted with a^k, from the smallest radius to `largest`."""
        low, high = (
            (math.log(end / self.median) - k * self.sigma_ln**2) / (self.sigma_ln * math.sqrt(2.0))
            for end in (self.smallest, self.largest if largest is None else largest)
        )
        return 0.5 * (math.erf(high) - math.erf(low))

    @property
    def kept(self):
        """Part of the uncut distribution that lies in the range [1]."""
        return self._part(0)

    def moment(self, k):
        """<a^k> of the cut distribution [m^k]."""
        return self.median**k * math.exp(0.5 * (k * self.sigma_ln) ** 2) * self._part(k) / self._part(0)


def smallest_a_eff(type, distribution=None):
    """Effective radius of the fewest monomers that a type needs, all of the smallest radius [m].

    BA needs two monomers, BAM1 three, BAM2 four: with fewer, no monomer makes the contacts that name the type.
    """
    distribution = RadiusDistribution() if distribution is None else distribution
    return (TYPES[_check_type(type)] + 2) ** (1.0 / 3.0) * distribution.smallest


def grow(type, a_eff, material, seed, *, distribution=None, migration="random"):
    """Grow an aggregate of an exact effective radius.

    Parameters
    ----------
    type : str
        "BA", "BAM1" or "BAM2".
    a_eff : float
        Effective radius [m]: sum a_i^3 = a_eff^3 to 1e-12.
    material : str or Material
        What the monomers are made of.
    seed : int
        Number of the grain, at least 0. The random numbers depend on material name, type, a_eff and seed, so that
        another grain of the ensemble changes nothing in this one.
    distribution : RadiusDistribution, optional
        Distribution of the monomer radii.
    migration : str, optional
        "random" (as in the paper) or "nearest", see `grow_with_radii`.

    Returns
    -------
    Grain
        With its centre of mass in the origin; monomers in the order in which they arrived.

    Raises
    ------
    InputError
        If an argument is not one of those allowed, or if no radii of the distribution add up to a_eff in a number
        that the type needs.

    Notes
    -----
    Sect. 3 of Reissl et al. 2024. The radii are those of `draw_radii`: small grains hold few monomers, and the radii
    are drawn again until their number allows the type (BA at least 2, BAM1 at least 3, BAM2 at least 4).
    """
    material = get_material(material)
    distribution = RadiusDistribution() if distribution is None else distribution
    migrations = TYPES[_check_type(type)]
    a_eff = _check_a_eff(a_eff, type, distribution)
    seed = _check_seed(seed)
    radii_seed, place_seed = _seed_sequence(material.name, type, round(a_eff / 1e-12), seed).spawn(2)
    radius = draw_radii(a_eff, migrations + 2, distribution, np.random.Generator(np.random.PCG64(radii_seed)))
    position = _place(radius, material, migrations, migration, place_seed)
    return Grain(position, radius, material, type=type, a_eff=a_eff, seed=seed)


def grow_with_radii(type, radii, material, seed, *, migration="random"):
    """Grow an aggregate of given monomers.

    Parameters
    ----------
    type : str
        "BA", "BAM1" or "BAM2".
    radii : (n,) array_like
        Radii of the monomers in the order in which they arrive [m], n >= 2.
    material : str or Material
        What the monomers are made of.
    seed : int
        At least 0.
    migration : str, optional
        "random": BAM1 rolls off in a uniformly random direction, BAM2 then in a random one of the two senses.
        "nearest": both go the shortest way to a place of one contact more, as in Shen et al. 2008.

    Returns
    -------
    Grain
        With its centre of mass in the origin.

    Raises
    ------
    InputError
        If an argument is not one of those allowed.

    Notes
    -----
    Each monomer comes in on a straight line of uniformly random direction and of a uniformly random impact parameter
    over the disc that a sphere around the aggregate, widened by the monomer's radius, presents. It stops at first
    touch, then rolls (BAM1, BAM2) over the monomer hit until it touches a second, then (BAM2) over those two until it
    touches a third. A monomer that misses, or that can roll all the way round without touching another, comes in
    again. The third monomer is the first that needs a second contact, the fourth the first that needs a third.

    Touching means a distance of a_i + a_j - delta_0, so that every contact made here is at rest; no two monomers are
    closer than that. In a few aggregates of three to five monomers of very different size no place with three
    contacts exists (a small one hides in the gap between two large ones): a monomer that has found none in 20 000
    hits stays at one with two contacts.
    """
    material = get_material(material)
    migrations = TYPES[_check_type(type)]
    seed = _check_seed(seed)
    radius = np.array(radii, dtype=np.float64)
    if radius.ndim != 1 or len(radius) < 2 or not np.all(np.isfinite(radius) & (radius > 0.0)):
        raise InputError("radii must be a list of at least two finite numbers above 0 (in m).")
    position = _place(radius, material, migrations, migration, _seed_sequence(material.name, type, "radii", seed))
    return Grain(position, radius, material, type=type, seed=seed)


def _place(radius, material, migrations, migration, seed):
    if migration not in MIGRATIONS:
        raise InputError(f"migration is {migration!r}; allowed are {', '.join(MIGRATIONS)}.")
    rng = np.random.Generator(np.random.PCG64(seed))
    position = _aggregate(
        radius, material.surface_energy, material.reduced_modulus, migrations, migration == "nearest", rng
    )
    return position - centre_of_mass(position, radius**3)


def _seed_sequence(*key):
    """SeedSequence of any key, the same on every machine."""
    digest = hashlib.sha256("|".join(str(part) for part in key).encode()).digest()
    return np.random.SeedSequence(np.frombuffer(digest, dtype="<u4").tolist())


def _check_type(type):
    if not isinstance(type, str) or type not in TYPES:
        raise InputError(f"The type of aggregate is {type!r}; allowed are {', '.join(TYPES)}.")
    return type


def _check_seed(seed):
    if isinstance(seed, bool) or not isinstance(seed, (int, np.integer)) or seed < 0:
        raise InputError(f"seed is {seed!r}; it must be a whole number of at least 0.")
    return int(seed)


def _check_a_eff(a_eff, type, distribution):
    try:
        value = float(a_eff)
    except (TypeError, ValueError):
        value = math.nan
    low = smallest_a_eff(type, distribution)
    high = (MOST_MONOMERS * distribution.moment(3)) ** (1.0 / 3.0)
    if not low < value <= high:
        raise InputError(
            f"a_eff is {a_eff!r} m; for {type} it must be above {low:.4g} m ({TYPES[type] + 2} monomers of the "
            f"smallest radius) and at most {high:.3g} m."
        )
    # A narrow distribution leaves gaps between what n and n + 1 monomers can fill.
    most = math.floor(value**3 / distribution.smallest**3 * (1.0 + 1e-12))
    if most * distribution.largest**3 < value**3:
        raise InputError(
            f"a_eff is {a_eff!r} m, which no number of monomers of {distribution.smallest:g} m to "
            f"{distribution.largest:g} m can give; choose another size or a wider range of radii."
        )
    return value


# ---------------------------------------------------------------------------------------------------------------------
# Radii
# ---------------------------------------------------------------------------------------------------------------------


def draw_radii(a_eff, fewest, distribution, rng):
    """Draw monomer radii that fill an effective radius exactly.

    Parameters
    ----------
    a_eff : float
        Effective radius [m].
    fewest : int
        Smallest number of monomers allowed.
    distribution : RadiusDistribution
        Distribution of the radii.
    rng : numpy.random.Generator
        Source of random numbers.

    Returns
    -------
    (n,) float64 array
        Radii [m] in random order, n >= fewest, each within the range of the distribution, with
        sum a^3 = a_eff^3 to 1e-12.

    Raises
    ------
    InputError
        If no radii are found because a_eff is at the very edge of what the distribution can give.

    Notes
    -----
    The paper says only that the last three radii are "biased". Closing an otherwise free sequence by any fixed rule
    shows in the sizes of the last monomers, and small grains are all last monomers. Here the radii are distributed
    exactly as free draws are *given* that their volumes add up to a_eff^3: a sequence of free draws is closed at one
    of its places by the radius that fills the rest, and is kept with a probability proportional to the probability
    density of that radius (as a density of volume). For the last three this means that they are free draws given the
    volume left for them. By symmetry no place in the order is special: the closing radius is distributed as all
    others are. The number of monomers comes out as it does for a free sequence that happens to end at a_eff^3.
    """
    volume = (a_eff / distribution.smallest) ** 3
    largest = distribution.largest / distribution.smallest
    # No radius can be greater than what the fewest others leave, which matters where only few sets are possible.
    largest = min(largest, (volume - (fewest - 1)) ** (1.0 / 3.0))
    possible = distribution._part(0, largest * distribution.smallest) / distribution.kept
    mu = math.log(distribution.median / distribution.smallest)
    scaled = _closed_sequence(volume, fewest, mu, distribution.sigma_ln, largest, possible, _MOST_PATHS, rng)
    if not len(scaled):
        raise InputError(
            f"No radii between {distribution.smallest:g} m and {distribution.largest:g} m were found that add up to "
            f"a_eff = {a_eff:g} m in at least {fewest} monomers; choose another size or a wider range of radii."
        )
    # What the sum inside the kernel has lost to rounding goes into the largest radius, where it is smallest.
    k = int(np.argmax(scaled))
    others = np.delete(scaled, k)
    scaled[k] = (volume - math.fsum(others**3)) ** (1.0 / 3.0)
    return np.clip(scaled * distribution.smallest, distribution.smallest, distribution.largest)


@jit
def _closed_sequence(volume, fewest, mu, sigma, largest, possible, most_paths, rng):
    """Free draws given that their cubes add up to a volume.

    Parameters
    ----------
    volume : float
        Sum of the cubes; all radii in units of the smallest.
    fewest : int
        Smallest number of radii.
    mu, sigma : float
        Mean and standard deviation of the logarithm of the radius before any cut.
    largest : float
        Greatest radius that can occur in the given volume.
    possible : float
        Probability that a radius of the distribution is no greater than that.
    most_paths : int
        Number of sequences to try.
    rng : numpy.random.Generator
        Source of random numbers.

    Returns
    -------
    (n,) float64 array
        Empty if none of the sequences was kept.
    """
    # Sum over a sequence of the density of the closing volume, at its greatest: the volumes left differ by at least 1.
    bound = 0.0
    envelope = 0.0
    for left in range(int(largest**3), 0, -1):
        # The density has one maximum, so that between two whole numbers it stays below the greater of both ends, or
        # below that maximum.
        envelope = max(envelope, _volume_density(float(left), mu, sigma), _volume_density(left + 1.0, mu, sigma))
        peak = math.exp(3.0 * (mu - 3.0 * sigma * sigma))
        if left <= peak < left + 1.0:
            envelope = max(envelope, _volume_density(peak, mu, sigma))
        bound += envelope

    draws = np.empty(1024)
    weight = np.empty(1024)
    for _ in range(most_paths):
        left = volume
        count = 0
        total = 0.0
        while left >= 1.0:
            if count + 1 >= draws.shape[0]:
                draws = np.concatenate((draws, np.empty(draws.shape[0])))
                weight = np.concatenate((weight, np.empty(weight.shape[0])))
            weight[count] = 0.0
            if left <= largest**3 and count + 1 >= fewest:
                # A free sequence ends at a radius that is too great; only the possible ones are drawn here, and the
                # probability of so many of them in a row (but for a constant) makes up for it.
                weight[count] = _volume_density(left, mu, sigma) * possible ** (count + 1 - fewest)
                total += weight[count]
            draws[count] = _cut_lognormal(mu, sigma, largest, rng)
            left -= draws[count] ** 3
            count += 1
        chosen = rng.random() * bound
        if chosen < total:
            last = 0
            chosen -= weight[0]
            while chosen >= 0.0 and last + 1 < count:
                last += 1
                chosen -= weight[last]
            left = volume
            for i in range(last):
                left -= draws[i] ** 3
            draws[last] = left ** (1.0 / 3.0)
            return draws[: last + 1].copy()
    return np.empty(0)


@jit
def _volume_density(v, mu, sigma):
    """Density of the volume a^3 = v of a lognormal radius, but for a constant factor."""
    return math.exp(-0.5 * ((math.log(v) / 3.0 - mu) / sigma) ** 2) / v


@jit
def _cut_lognormal(mu, sigma, largest, rng):
    """Lognormal radius between 1 and `largest`, by rejection."""
    high = math.log(largest)
    if high < 0.2 * sigma:
        # A narrow range would reject nearly all normal draws; its uniform ones are nearly all kept.
        nearest = min(max(mu, 0.0), high)
        while True:
            t = rng.random() * high
            if rng.random() < math.exp(0.5 * ((nearest - mu) ** 2 - (t - mu) ** 2) / (sigma * sigma)):
                return math.exp(t)
    while True:
        # Box and Muller 1958; one of the two normal numbers is enough.
        t = mu + sigma * math.sqrt(-2.0 * math.log(1.0 - rng.random())) * math.cos(2.0 * math.pi * rng.random())
        if 0.0 <= t <= high:
            return math.exp(t)


# ---------------------------------------------------------------------------------------------------------------------
# Places
# ---------------------------------------------------------------------------------------------------------------------


@jit
def _touching_distance(a_i, a_j, surface_energy, reduced_modulus):
    """Distance of the centres of two monomers in equilibrium, a_i + a_j - delta_0 [m]."""
    return a_i + a_j - equilibrium_compression(reduced_radius(a_i, a_j), surface_energy, reduced_modulus)


@jit
def _random_direction(rng):
    """Unit vector (x, y, z) uniformly distributed over the sphere."""
    z = 2.0 * rng.random() - 1.0
    angle = 2.0 * math.pi * rng.random()
    s = math.sqrt(1.0 - z * z)
    return s * math.cos(angle), s * math.sin(angle), z


@jit
def _random_normal(x, y, z, rng):
    """Unit vector uniformly distributed over the circle normal to the unit vector (x, y, z)."""
    # The axis farthest from (x, y, z) makes a first normal, their cross product a second.
    if abs(x) <= abs(y) and abs(x) <= abs(z):
        ux, uy, uz = 0.0, z, -y
    elif abs(y) <= abs(z):
        ux, uy, uz = -z, 0.0, x
    else:
        ux, uy, uz = y, -x, 0.0
    length = math.sqrt(ux * ux + uy * uy + uz * uz)
    ux, uy, uz = ux / length, uy / length, uz / length
    vx, vy, vz = y * uz - z * uy, z * ux - x * uz, x * uy - y * ux
    angle = 2.0 * math.pi * rng.random()
    c, s = math.cos(angle), math.sin(angle)
    return c * ux + s * vx, c * uy + s * vy, c * uz + s * vz


@jit
def _bucket(cx, cy, cz, mask):
    """Place of a cell in the table of cells."""
    h = cx * np.int64(73856093) ^ cy * np.int64(19349663) ^ cz * np.int64(83492791)
    return (h ^ (h >> 17)) & mask


@jit
def _cell(x, size):
    return np.int64(math.floor(x / size))


@jit
def _insert(i, position, size, head, follower):
    """Enter monomer i into the table of cells."""
    b = _bucket(
        _cell(position[i, 0], size), _cell(position[i, 1], size), _cell(position[i, 2], size), head.shape[0] - 1
    )
    follower[i] = head[b]
    head[b] = i


@jit
def _first_touch(start, d, a, position, radius, widest, box, size, head, follower, surface_energy, reduced_modulus):
    """First monomer that a monomer touches on a straight way.

    Parameters
    ----------
    start : (3,) float64 array
        Where its centre starts [m], outside the aggregate.
    d : (3,) float64 array
        Unit vector of its way.
    a : float
        Its radius [m].
    position, radius : arrays
        Monomers; those entered in the table of cells count.
    widest : float
        Greatest radius among them [m].
    box : (2, 3) float64 array
        Least and greatest coordinates of their centres [m].
    size, head, follower
        Edge of the cells [m]; first monomer of each place of the table, next one of each monomer (-1: none).
    surface_energy, reduced_modulus : float
        gamma [J m-2] and E* [Pa].

    Returns
    -------
    t : float
        Way to the touch [m]; inf for a miss.
    hit : int
        Monomer touched; -1 for a miss.

    Notes
    -----
    The cells are visited in layers normal to the coordinate axis k nearest to the way, in the order of the way. Of a
    layer, only cells count that hold a centre within a + widest of the line: at the same coordinate along k such a
    centre is no farther from the line than (a + widest)/|d_k|. A touch lies at most a + widest before the layer of
    the centre, so that the search ends where no later layer can do better.
    """
    k = 0
    if abs(d[1]) > abs(d[k]):
        k = 1
    if abs(d[2]) > abs(d[k]):
        k = 2
    p = (k + 1) % 3
    q = (k + 2) % 3
    mask = head.shape[0] - 1
    margin = (a + widest) / abs(d[k])
    low_layer = _cell(box[0, k], size)
    high_layer = _cell(box[1, k], size)
    step = 1 if d[k] > 0.0 else -1
    layer = low_layer if step > 0 else high_layer
    cell = np.zeros(3, dtype=np.int64)
    best = math.inf
    hit = -1
    while low_layer <= layer <= high_layer:
        t_in = ((layer if step > 0 else layer + 1) * size - start[k]) / d[k]
        if t_in - margin > best:
            break
        t_out = t_in + size / abs(d[k])
        p_in, p_out = start[p] + t_in * d[p], start[p] + t_out * d[p]
        q_in, q_out = start[q] + t_in * d[q], start[q] + t_out * d[q]
        p_low = _cell(max(min(p_in, p_out) - margin, box[0, p]), size)
        p_high = _cell(min(max(p_in, p_out) + margin, box[1, p]), size)
        q_low = _cell(max(min(q_in, q_out) - margin, box[0, q]), size)
        q_high = _cell(min(max(q_in, q_out) + margin, box[1, q]), size)
        cell[k] = layer
        for cp in range(p_low, p_high + 1):
            cell[p] = cp
            for cq in range(q_low, q_high + 1):
                cell[q] = cq
                j = head[_bucket(cell[0], cell[1], cell[2], mask)]
                while j >= 0:
                    # Monomers of other cells in the same place of the table do no harm here.
                    x = position[j, 0] - start[0]
                    y = position[j, 1] - start[1]
                    z = position[j, 2] - start[2]
                    along = x * d[0] + y * d[1] + z * d[2]
                    aside2 = x * x + y * y + z * z - along * along
                    if aside2 < (a + radius[j]) ** 2 and along - a - radius[j] < best:
                        s = _touching_distance(a, radius[j], surface_energy, reduced_modulus)
                        if aside2 < s * s:
                            t = along - math.sqrt(s * s - aside2)
                            if t < best:
                                best = t
                                hit = j
                    j = follower[j]
        layer += step
    return best, hit


@jit
def _near(x, y, z, reach, position, radius, widest, size, head, follower, near):
    """Write the monomers with |X_k - (x, y, z)| < reach + a_k into `near`; returns how many."""
    mask = head.shape[0] - 1
    margin = reach + widest
    count = 0
    for cx in range(_cell(x - margin, size), _cell(x + margin, size) + 1):
        for cy in range(_cell(y - margin, size), _cell(y + margin, size) + 1):
            for cz in range(_cell(z - margin, size), _cell(z + margin, size) + 1):
                k = head[_bucket(cx, cy, cz, mask)]
                while k >= 0:
                    dx = position[k, 0] - x
                    dy = position[k, 1] - y
                    dz = position[k, 2] - z
                    if (
                        dx * dx + dy * dy + dz * dz < (reach + radius[k]) ** 2
                        and _cell(position[k, 0], size) == cx
                        and _cell(position[k, 1], size) == cy
                        and _cell(position[k, 2], size) == cz
                    ):
                        near[count] = k
                        count += 1
                    k = follower[k]
    return count


@jit
def _turn(along, across, level):
    """Least angle in [0, 2 pi) at which along cos t + across sin t rises through level; inf where it never does."""
    height2 = along * along + across * across
    if level * level >= height2:
        return math.inf
    t = math.atan2(across, along) - math.acos(level / math.sqrt(height2))
    if t < 0.0:
        t += 2.0 * math.pi
    return t


@jit
def _roll(centre, e, f, s, a, skip, near, count, position, radius, surface_energy, reduced_modulus):
    """Roll a monomer on a circle until it touches another.

    Parameters
    ----------
    centre : (3,) float64 array
        Middle of the circle [m].
    e, f : (3,) float64 array
        Unit vectors from the middle to where the monomer is, and of its way there.
    s : float
        Radius of the circle [m].
    a : float
        Radius of the monomer [m].
    skip : tuple of two int
        Monomers that it rolls over.
    near, count
        Monomers that it may touch.

    Returns
    -------
    angle : float
        How far it rolls [rad]; inf where it touches nothing.
    hit : int
        Monomer touched.
    """
    angle = math.inf
    hit = -1
    for c in range(count):
        k = near[c]
        if k == skip[0] or k == skip[1]:
            continue
        x = position[k, 0] - centre[0]
        y = position[k, 1] - centre[1]
        z = position[k, 2] - centre[2]
        reach = _touching_distance(a, radius[k], surface_energy, reduced_modulus)
        # |s (e cos t + f sin t) - D|^2 = reach^2
        t = _turn(
            x * e[0] + y * e[1] + z * e[2],
            x * f[0] + y * f[1] + z * f[2],
            (s * s + x * x + y * y + z * z - reach * reach) / (2.0 * s),
        )
        if t < angle:
            angle = t
            hit = k
    return angle, hit


@jit
def _go_to(place, centre, e, f, s, angle):
    """Move `place` to an angle on the circle of radius s around `centre`, from e towards f."""
    for axis in range(3):
        place[axis] = centre[axis] + s * (math.cos(angle) * e[axis] + math.sin(angle) * f[axis])


@jit
def _way_to_nearest(e, s, a, j, near, count, position, radius, surface_energy, reduced_modulus, f):
    """Direction f in which a monomer rolls over monomer j the shortest way to a second contact; False if none exists.

    A place of contact with j and k lies on a circle around the line from j to k, and the nearest one in the plane of
    that line and the monomer.
    """
    best = math.inf
    for c in range(count):
        k = near[c]
        if k == j:
            continue
        x = position[k, 0] - position[j, 0]
        y = position[k, 1] - position[j, 1]
        z = position[k, 2] - position[j, 2]
        along = x * e[0] + y * e[1] + z * e[2]
        reach = _touching_distance(a, radius[k], surface_energy, reduced_modulus)
        across2 = x * x + y * y + z * z - along * along
        level = (s * s + x * x + y * y + z * z - reach * reach) / (2.0 * s)
        if across2 <= 0.0:
            continue
        across = math.sqrt(across2)
        t = _turn(along, across, level)
        if t < best:
            best = t
            f[0] = (x - along * e[0]) / across
            f[1] = (y - along * e[1]) / across
            f[2] = (z - along * e[2]) / across
    return best < math.inf


@jit
def _aggregate(radius, surface_energy, reduced_modulus, migrations, nearest, rng):
    """Places of monomers that arrive one after the other.

    Parameters
    ----------
    radius : (n,) float64 array
        Radii [m] in the order of arrival, n >= 1.
    surface_energy, reduced_modulus : float
        gamma [J m-2] and E* [Pa].
    migrations : int
        0 (BA), 1 (BAM1) or 2 (BAM2).
    nearest : bool
        Migrate the shortest way rather than in a random direction.
    rng : numpy.random.Generator
        Source of random numbers.

    Returns
    -------
    (n, 3) float64 array
        Centres [m]; the first monomer is in the origin.

    Notes
    -----
    The monomers placed so far stand in a table of cubic cells as wide as the largest monomer, found by a hash of the
    cell's numbers, so that the aggregate may grow anywhere. Both the search along a line and that around a monomer
    look only at cells on the way.
    """
    n = radius.shape[0]
    widest = np.max(radius)
    size = 2.0 * widest
    places = 16
    while places < 2 * n:
        places *= 2
    head = np.full(places, -1)
    follower = np.full(n, -1)
    near = np.empty(n, dtype=np.int64)
    position = np.zeros((n, 3))
    box = np.zeros((2, 3))
    # A sphere that holds all monomers. It is widened just enough for each that sticks out, which makes it a little
    # larger than the smallest one; that costs misses only.
    ball = np.zeros(3)
    ball_radius = radius[0]
    start = np.empty(3)
    place = np.empty(3)
    centre = np.empty(3)
    d = np.empty(3)
    e = np.empty(3)
    f = np.empty(3)
    _insert(0, position, size, head, follower)

    for i in range(1, n):
        a = radius[i]
        wanted = min(migrations, i - 1)
        hits = 0
        while True:
            d[0], d[1], d[2] = _random_direction(rng)
            f[0], f[1], f[2] = _random_normal(d[0], d[1], d[2], rng)
            aside = (ball_radius + a) * math.sqrt(rng.random())
            for axis in range(3):
                start[axis] = ball[axis] - (ball_radius + a) * d[axis] + aside * f[axis]
            t, j = _first_touch(
                start, d, a, position, radius, widest, box, size, head, follower, surface_energy, reduced_modulus
            )
            if j < 0:
                continue
            for axis in range(3):
                place[axis] = start[axis] + t * d[axis]
            hits += 1
            if hits == _MOST_HITS:
                hits = 0
                wanted -= 1

            # All that follows happens in touch with monomer j.
            s = _touching_distance(a, radius[j], surface_energy, reduced_modulus)
            x, y, z = position[j, 0], position[j, 1], position[j, 2]
            count = _near(x, y, z, s + a, position, radius, widest, size, head, follower, near)
            if wanted >= 1:
                for axis in range(3):
                    e[axis] = (place[axis] - position[j, axis]) / s
                if not nearest:
                    f[0], f[1], f[2] = _random_normal(e[0], e[1], e[2], rng)
                elif not _way_to_nearest(e, s, a, j, near, count, position, radius, surface_energy, reduced_modulus, f):
                    continue
                angle, k = _roll(
                    position[j], e, f, s, a, (j, j), near, count, position, radius, surface_energy, reduced_modulus
                )
                if k < 0:
                    continue
                _go_to(place, position[j], e, f, s, angle)
            if wanted >= 2:
                angle = _roll_over_two(
                    place, s, a, j, k, nearest, near, count, position, radius, surface_energy, reduced_modulus, rng,
                    centre, e, f,
                )  # fmt: skip
                if angle == math.inf:
                    continue
            if _is_free(place, a, near, count, position, radius, surface_energy, reduced_modulus):
                break

        for axis in range(3):
            position[i, axis] = place[axis]
        _insert(i, position, size, head, follower)
        reach = 0.0
        for axis in range(3):
            box[0, axis] = min(box[0, axis], place[axis])
            box[1, axis] = max(box[1, axis], place[axis])
            reach += (place[axis] - ball[axis]) ** 2
        reach = math.sqrt(reach)
        if reach + a > ball_radius:
            wider = 0.5 * (ball_radius + reach + a) * (1.0 + 1e-12)
            for axis in range(3):
                ball[axis] += (place[axis] - ball[axis]) * ((wider - ball_radius) / reach)
            ball_radius = wider
    return position


@jit
def _roll_over_two(
    place, s, a, j, k, nearest, near, count, position, radius, surface_energy, reduced_modulus, rng, centre, e, f
):
    """Roll a monomer that touches j and k until it touches a third: moves `place`, returns the angle (inf: none)."""
    distance2 = 0.0
    for axis in range(3):
        f[axis] = position[k, axis] - position[j, axis]
        distance2 += f[axis] * f[axis]
    reach = _touching_distance(a, radius[k], surface_energy, reduced_modulus)
    along = (s * s + distance2 - reach * reach) / (2.0 * distance2)
    s = math.sqrt(max(s * s - along * along * distance2, 0.0))
    for axis in range(3):
        centre[axis] = position[j, axis] + along * f[axis]
        e[axis] = (place[axis] - centre[axis]) / s
    # The third direction, normal to both the axis from j to k and e.
    length = math.sqrt(distance2)
    fx, fy, fz = f[0] / length, f[1] / length, f[2] / length
    f[0], f[1], f[2] = fy * e[2] - fz * e[1], fz * e[0] - fx * e[2], fx * e[1] - fy * e[0]
    if not nearest and rng.random() < 0.5:
        f[0], f[1], f[2] = -f[0], -f[1], -f[2]
    angle, hit = _roll(centre, e, f, s, a, (j, k), near, count, position, radius, surface_energy, reduced_modulus)
    if nearest:
        f[0], f[1], f[2] = -f[0], -f[1], -f[2]
        back, hit = _roll(centre, e, f, s, a, (j, k), near, count, position, radius, surface_energy, reduced_modulus)
        if back < angle:
            angle = back
        else:
            f[0], f[1], f[2] = -f[0], -f[1], -f[2]
    if angle < math.inf:
        _go_to(place, centre, e, f, s, angle)
    return angle


@jit
def _is_free(place, a, near, count, position, radius, surface_energy, reduced_modulus):
    """Whether a monomer there is no closer to any other than in equilibrium, but for rounding."""
    for c in range(count):
        k = near[c]
        x = position[k, 0] - place[0]
        y = position[k, 1] - place[1]
        z = position[k, 2] - place[2]
        least = _touching_distance(a, radius[k], surface_energy, reduced_modulus) * (1.0 - 1e-10)
        if x * x + y * y + z * z < least * least:
            return False
    return True
