"""Radii of the monomers: a cut lognormal distribution that fills an effective radius exactly, and the MRN law."""

import math
from dataclasses import dataclass
from statistics import NormalDist

import numpy as np

from ratd.base.checks import check_radii, is_number, number_array
from ratd.base.errors import InputError
from ratd.base.jit import jit

__all__ = ["RadiusDistribution", "draw_radii", "lognormal_radii", "mrn_moment", "mrn_radii", "radii_array"]

_MOST_PATHS = 1_000_000
"""Sequences of radii that are tried before a_eff is said to be out of reach."""


def radii_array(radii, n=None):
    """Radii of the monomers of an aggregate [m], checked.

    Parameters
    ----------
    radii : array_like
    n : int, optional
        How many they must be; at least two when not given.

    Returns
    -------
    (n,) float64 array
        A copy.

    Raises
    ------
    InputError
        If they are no list of so many finite numbers above 0, or not of dust.
    """
    each = number_array(radii, "radii")
    if each.ndim != 1 or (len(each) < 2 if n is None else len(each) != n):
        wanted, each_one = ("at least two", "") if n is None else (n, ", one for each monomer")
        raise InputError(
            f"radii must be {wanted} finite numbers above 0, in m{each_one}; they are of the shape {each.shape}."
        )
    wrong = np.flatnonzero(~(np.isfinite(each) & (each > 0.0)))
    if len(wrong):
        raise InputError(f"radii[{wrong[0]}] is {each[wrong[0]]:g}; radii must be finite numbers above 0, in m.")
    check_radii(each)
    return each


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
            if not (is_number(value) and value > 0.0):
                raise InputError(f"{name} of the monomer radii is {value!r}; it must be a number above 0.")
        if not self.smallest < self.largest:
            raise InputError(
                f"smallest and largest of the monomer radii are {self.smallest:g} m and {self.largest:g} m; "
                "smallest must be below largest."
            )
        check_radii(np.array([self.smallest, self.largest]))
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


def lognormal_radii(u, distribution):
    """Radii of a cut lognormal distribution from uniform random numbers.

    Parameters
    ----------
    u : array_like, shape (n,)
        Between 0 and 1.
    distribution : RadiusDistribution

    Returns
    -------
    (n,) float64 array
        The quantiles u [m].
    """
    normal = NormalDist()
    ends = distribution.smallest, distribution.largest
    low, high = (normal.cdf(math.log(end / distribution.median) / distribution.sigma_ln) for end in ends)
    t = [normal.inv_cdf(low + float(each) * (high - low)) for each in u]
    return np.clip(distribution.median * np.exp(distribution.sigma_ln * np.array(t)), *ends)


def mrn_radii(u, smallest, largest):
    """Radii of the law of Mathis, Rumpl & Nordsieck, n(r) ~ r^-3.5, from uniform random numbers.

    Parameters
    ----------
    u : array_like, shape (n,)
        Between 0 and 1.
    smallest, largest : float
        Ends of the distribution [m].

    Returns
    -------
    (n,) float64 array
        r = (r_min^-2.5 - u (r_min^-2.5 - r_max^-2.5))^-0.4 [m].

    References
    ----------
    Mathis, Rumpl & Nordsieck (1977), ApJ 217, 425; Umstaetter & Urbassek (2020), A&A 633, A24, Eq. 4.
    """
    # in units of the smallest radius: its power -2.5 in metres is some 1e18
    end = (largest / smallest) ** -2.5
    return smallest * (1.0 - np.asarray(u, dtype=np.float64) * (1.0 - end)) ** -0.4


def mrn_moment(k, smallest, largest):
    """<r^k> [m^k] of the law of `mrn_radii`; the mean lengths L_q of Umstaetter & Urbassek are <r^q>^(1/q)."""
    ratio = largest / smallest
    power = k - 2.5
    integral = math.log(ratio) if power == 0.0 else (ratio**power - 1.0) / power
    return smallest**k * 2.5 * integral / (1.0 - ratio**-2.5)
