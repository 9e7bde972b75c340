"""Each set beside the one that it is compared with: pressures of the same clusters, and of clusters of other sizes."""

import itertools
import math

import numpy as np

from ratd.base.measured import Measured, quotient
from ratd.experiments.compression.strength import (
    NEAR,
    compared,
    fit_power_law,
    measured,
    of_same_clusters,
    ratio_at,
    scatter_at,
    several,
)

__all__ = ["BY_SIZE", "HIGH", "LOW_RANGE", "SLOW_RATES", "SMALL", "beside", "of_pairs"]

LOW_RANGE = (0.01, 0.05)
"""Filling factors between which the power law is fitted anew, where a cluster is large enough to reach them."""
BY_SIZE = ("n_1024", "base", "n_16384")
"""Sets that differ in the number of monomers, the fewest first."""
SMALL = "n_1024"
"""The set of small clusters that go to high filling factors; damping and rolling displacements are varied there."""
HIGH = "high_16384"
"""The set that high filling factors are told of."""
LOOSE = {
    "loose_16384": ("n_16384", 0.0055, 0.009),
    "slow_16384": ("n_16384", 0.0055, 0.009),
    "short_16384": ("slow_16384", 0.0055, 0.009),
    "explicit_16384": ("n_16384", 0.008, 0.019),
}
"""Sets of loose clusters -> the set of the same clusters beside which they stand, and between which filling factors."""
SLOWEST = ("slow_16384", "loose_16384")
"""The slowest squeeze of loose clusters, and the next one."""
SLOW_RATES = ("1e-7", "1e-6", "3e-6")
"""Rates of Fig. 5 beside the usual one that are slow enough, as the names of their sets have them."""
BESIDE = {"k_n": SMALL, "xi": SMALL, "steps": "explicit", "explicit_k_n": "explicit"}
"""What a set is compared with, by the beginning of its name; all others with the base set."""
DENSE = ("equal", "k_n_10", "k_n_0")
"""Sets of the clusters of `SMALL` up to high filling factors, at another rate or with another damping."""
COPIES = {"copies_16384": "loose_16384", "copies_4096": "rate_1e-6"}
"""Sets of clusters that met copies of themselves as they grew -> those that met others, at the same rate."""
FEW = ("silicate_16384", "n_16384")
"""A set of few clusters, and one of many of the same size."""


def of_pairs(sets):
    """Each set over the one that it is compared with, of the clusters that both have; and each size over the next."""
    found = {}
    for name, table in sets.items():
        other = beside(name)
        if name == other or not name.startswith(("k_n", "xi", "rate", "explicit_k_n")) or other not in sets:
            continue
        ratio, steeper = several(compared(table, sets[other]))
        found |= {f"{name}.paired": ratio, f"{name}.paired_exponent": steeper}
        found[f"{name}.over_all"] = quotient(*(several(fit_power_law(each))[2] for each in (table, sets[other])))
        if name.startswith("xi"):
            times = table["rolling_pressure"].values[0] / sets[other]["rolling_pressure"].values[0]
            for phi in (0.01, 0.02, 0.03):
                over = _of_same(table, sets[other], phi)
                found[f"{name}.pressure_over_{phi:g}"] = Measured(times * over.value, times * over.error)
        if name.startswith("rate"):
            for phi in (0.03, 0.05):
                found[f"{name}.over_{phi:g}"] = _of_same(table, sets[other], phi)
                found[f"{name}.over_all_{phi:g}"] = _of_all(table, sets[other], phi)
    for name, (other, low, high) in LOOSE.items():
        if {name, other} <= set(sets):
            found[f"{name}.paired"] = measured(compared(sets[name], sets[other], low, high))
            same = of_same_clusters([sets[name], sets[other]])[1]
            for phi in (0.002, 0.003, 0.005, 0.01, 0.02, 0.03):
                own = _reaching(sets[name], phi * NEAR)
                if own.sizes["seed_number"]:
                    found[f"{name}.beside_{phi:g}"] = measured(ratio_at(same, phi))
                    # looser ones have bins without pressure
                    if phi < 0.005:
                        continue
                    found[f"{name}.over_{phi:g}"] = _of_same(own, sets[other], phi)
                    found[f"{name}.over_all_{phi:g}"] = _of_all(sets[name], sets[other], phi)
            if sets[name]["phi"].values[-1] > LOW_RANGE[1]:
                found[f"{name}.steeper_low"] = several(compared(sets[name], sets[other], *LOW_RANGE))[1]
    if set(SLOWEST) <= set(sets):
        for phi in (0.005, 0.01, 0.02, 0.03):
            found[f"{SLOWEST[0]}.over_next_{phi:g}"] = _of_same(*(sets[name] for name in SLOWEST), phi)
    for name, larger in itertools.pairwise(BY_SIZE):
        if {name, larger} <= set(sets):
            found |= _by_size(sets, name, larger, (0.01, 0.02, 0.03, 0.05))
    if {SMALL, HIGH} <= set(sets):
        found |= _by_size(sets, SMALL, HIGH, (0.2, 0.3, 0.48), "paper_size")
    for name in ("base", SMALL):
        if {name, SLOWEST[0]} <= set(sets):
            found |= _by_size(sets, name, SLOWEST[0], (0.01, 0.02), SLOWEST[0])
    return found | _dense(sets) | _of_few(sets) | _of_copies(sets)


def _reaching(table, phi):
    """The clusters of a set that go up to a filling factor."""
    last = np.where(np.isfinite(table["pressure"].values), table["phi"].values, 0.0)
    return table.isel(seed_number=last.max(axis=1) > phi)


def _dense(sets):
    """Pressures of dense clusters squeezed otherwise, over those of the usual set: what rate and damping do there."""
    found = {}
    for name in DENSE:
        if {name, SMALL} <= set(sets):
            found[f"{name}.dense"] = measured(compared(sets[name], sets[SMALL], 0.25, 0.36))
            found[f"{name}.dense_0.48"] = _of_same(sets[name], sets[SMALL], 0.48)
    return found


def _of_copies(sets):
    """Pressures of clusters that met copies of themselves, over those of clusters that met others."""
    found = {}
    for name, other in COPIES.items():
        if {name, other} <= set(sets):
            last = min(sets[each]["phi"].values[-1] for each in (name, other))
            for phi in (phi for phi in (0.005, 0.01, 0.02, 0.03, 0.05, 0.1) if phi * NEAR < last):
                found[f"{name}.over_others_{phi:g}"] = _of_all(sets[name], sets[other], phi)
                # what the mean of as many as the paper has is known to
                found[f"{name}.of_ten_{phi:g}"] = measured(scatter_at(sets[name], phi)).value / math.sqrt(10.0)
    return found


def _of_few(sets):
    """Ratios of two clusters of silicate with the error that as many of the ten of ice of this size would have."""
    few, many = (sets.get(name) for name in FEW)
    found = {}
    if few is not None and many is not None:
        for phi in (0.05, 0.1):
            own, scatter = (measured(at(table, phi)) for at, table in ((ratio_at, few), (scatter_at, many)))
            error = own.value * scatter.value / math.sqrt(few.sizes["seed_number"])
            found[f"{FEW[0]}.ratio_{phi:g}_of_few"] = Measured(own.value, error)
    return found


def _of_same(table, other, phi):
    """P/(P_0 phi^3) of a set over that of another at a filling factor, of the clusters that both have, `Measured`."""
    return measured(compared(table, other, phi / NEAR, phi * NEAR))


def _of_all(table, other, phi):
    """The same of all clusters of each, as if those of one were others than those of the other."""
    return quotient(*(measured(ratio_at(each, phi)) for each in (table, other)))


def _by_size(sets, name, larger, every, word="larger"):
    """Pressures of a set over those of one of larger clusters."""
    return {f"{name}.over_{word}_{phi:g}": _of_all(sets[name], sets[larger], phi) for phi in every}


def beside(name):
    """The set that one is compared with."""
    return next((other for start, other in BESIDE.items() if name.startswith(start)), "base")
