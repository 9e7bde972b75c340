"""Which fragments leave a grain until it is disrupted, and how the mass is spread over them.

A run notes each fragment when it has left for good (`records.FRAGMENTS`). Two pieces of that list say how a grain
falls apart: what left up to omega_disr, the peak of the stress, and what left while the first half of the mass went,
which takes in the collapse itself (it follows the peak of the stress, and a piece that was cut off leaves a little
later). Only these fragments are kept: what becomes of the largest one after that is a matter of the spin-up going on.
"""

import math

import numpy as np
import pandas as pd
import xarray as xr

from ratd.base.errors import InputError
from ratd.base.measured import Measured
from ratd.base.statistics import drawn_counts, equal_weights, mean_of
from ratd.experiments.spin_up.cells import cell_of

HALF = 0.5
"""Part of the mass that leaves in the second piece of the list."""
FRAGMENT_COLUMNS = {
    "fragment_mass": ("kg", "mass of a fragment that left"),
    "fragment_n_monomers": ("1", "number of monomers of a fragment that left"),
    "fragment_omega": ("rad s-1", "angular velocity at which a fragment left"),
}
"""Units and meaning of what is known of each fragment."""
STAGES = {
    "disruption": "up to omega_disr",
    "half": "while the first half of the mass leaves",
}


SIZE_CLASSES = {
    "50 to 150 nm": (0.0, 175e-9),
    "200 to 350 nm": (175e-9, 375e-9),
    "400 to 550 nm": (375e-9, math.inf),
}
"""Name of a class of grains -> a_eff [m] from and below which; the names are those of the sizes of the paper."""
LARGE = 0.1
"""Part of the mass of a grain above which a fragment is a large piece."""


def fragmentation(run, mark):
    """Fragments that leave one grain up to omega_disr, or until half of its mass has left, whichever is later.

    Parameters
    ----------
    run : xarray.Dataset
        A spin-up run, see `ratd.spin_up`.
    mark : xarray.Dataset
        What `ratd.disruption` returns for it.

    Returns
    -------
    xarray.Dataset
        The variables of `FRAGMENT_COLUMNS` over `fragment`, in the order of leaving.
    """
    order = np.argsort(run["fragment_omega"].values, kind="stable")
    omega = run["fragment_omega"].values[order]
    mass = run["fragment_mass"].values[order]
    grain_mass = float(run.attrs["initial_mass"])
    kept = 0
    if len(mass):
        gone = np.cumsum(mass)
        kept = min(int(np.searchsorted(gone, HALF * grain_mass)) + 1, len(mass))
        omega_disr = float(mark["omega_disr"])
        if np.isfinite(omega_disr):
            kept = max(kept, int(np.sum(omega <= omega_disr)))
    return xr.Dataset({name: ("fragment", run[name].values[order][:kept]) for name in FRAGMENT_COLUMNS})


def spun_up_fragments(files):
    """Fragments of the grains that the queue of spin-ups has finished, one row a fragment.

    Parameters
    ----------
    files : list of xarray.Dataset
        From `ratd.experiments.spin_up.grain_table.spun_up_files`.

    Returns
    -------
    pandas.DataFrame
        `FRAGMENT_COLUMNS`; material, type, a_eff, seed, n_monomers, grain_mass and omega_disr of the grain; `grain`,
        its number; `mass_fraction`, the mass of the fragment over that of the grain; `disruption` and `half`, whether
        it belongs to these `STAGES`; `weight` of the grain, with which all cells (material, type, size) count alike.
    """
    grains = pd.concat([_grains_of(file) for file in files], ignore_index=True)
    grains["grain"] = np.arange(len(grains))
    grains["weight"] = equal_weights(cell_of(grains))
    size = np.concatenate([file["row_size_fragment"].values for file in files])
    table = grains.loc[grains.index.repeat(size)].reset_index(drop=True)
    for name in FRAGMENT_COLUMNS:
        table[name] = np.concatenate([file[name].values for file in files])
    table["mass_fraction"] = table["fragment_mass"] / table["grain_mass"]
    before = table.groupby("grain")["mass_fraction"].cumsum() - table["mass_fraction"]
    table["half"] = before < HALF
    table["disruption"] = table["fragment_omega"] <= table["omega_disr"]
    return table


def _grains_of(file):
    """What `spun_up_fragments` tells of the grains of a file."""
    own = {name: file[name].values for name in ("a_eff", "seed", "omega_disr")}
    own |= {"grain_mass": file["initial_mass"].values, "n_monomers": file["initial_n_monomers"].values}
    return pd.DataFrame({"material": file.attrs["material"], "type": file.attrs["type"], **own})


def size_class(a_eff):
    """Name of `SIZE_CLASSES` of each a_eff [m], pandas.Series, in the order of the classes."""
    low = [start for start, _ in SIZE_CLASSES.values()]
    return pd.cut(a_eff, [*low, math.inf], right=False, labels=list(SIZE_CLASSES))


MONOMER_CLASSES = {"1 monomer": 1, "2–3": 3, "4–10": 10, "more than 10": np.inf}
"""Name of a class of fragments -> greatest number of monomers, ascending."""


def mass_shares(fragments, classes=MONOMER_CLASSES):
    """Shares of fragments of so many monomers in the mass of some fragments, those of a grain with its weight.

    Parameters
    ----------
    fragments : pandas.DataFrame
        Of one type, from `spun_up_fragments`.
    classes : dict of str to float
        As `MONOMER_CLASSES`.

    Returns
    -------
    dict of str to ratd.base.measured.Measured
        With the standard error of a ratio of sums over grains, NaN for one grain.
    """
    which = np.searchsorted(list(classes.values()), fragments["fragment_n_monomers"])
    grain = pd.factorize(fragments["grain"])[0]
    n = grain.max() + 1
    mass = np.zeros((n, len(classes)))
    np.add.at(mass, (grain, which), fragments["weight"] * fragments["mass_fraction"])
    share = mass.sum(axis=0) / mass.sum()
    off = mass - share * mass.sum(axis=1, keepdims=True)  # of each grain, in the mass of a class
    error = np.sqrt((off**2).sum(axis=0) * n / (n - 1)) / mass.sum() if n > 1 else np.full(len(share), np.nan)
    return {name: Measured(*each) for name, *each in zip(classes, share.tolist(), error.tolist(), strict=True)}


def exponents(fragments, stage="half", confidence=0.95, replicates=400, seed=0):
    """Exponents of the sizes of fragments by type and class of size, and the number of large pieces.

    Parameters
    ----------
    fragments : pandas.DataFrame
        From `spun_up_fragments`.
    stage : str
        One of `STAGES`.
    confidence : float
        Probability inside the intervals.
    replicates : int
        Of the bootstrap over grains.
    seed : int

    Returns
    -------
    pandas.DataFrame
        A row a type and class: type, size_class; exponent s of p(n) ~ n^-s over the monomers n of a fragment, from 1 to
        one less than its grain has, by greatest likelihood (`power_law`), with low and high, percentiles of a bootstrap
        over grains, because the fragments of one grain are not independent; probability, low where no power law is
        justified; large_pieces, the mean number of fragments of a grain above `LARGE` of its mass, with `_error`;
        n_fragments, n_grains (that lost any). Fragments of radii a with a^-3.5 have s = 11/6.
    """
    rng = np.random.Generator(np.random.PCG64(seed))
    chosen = fragments[fragments[stage]]
    ends = [(1 - confidence) / 2, (1 + confidence) / 2]
    rows = []
    for (kind, name), part in chosen.groupby(["type", size_class(chosen["a_eff"])], observed=True, sort=False):
        sizes, grain = part["fragment_n_monomers"].to_numpy(int), pd.factorize(part["grain"])[0]
        largest = part["n_monomers"].to_numpy(int) - 1
        fit = power_law(sizes, largest, seed)
        drawn = [often[grain] for often in drawn_counts(rng, replicates, grain.max() + 1)]
        made = [_fit_power_law(*_counted(sizes, largest, often))[0] for often in drawn if np.count_nonzero(often) > 1]
        known = np.isfinite(fit["exponent"]) and grain.max() > 0
        low, high = np.quantile(made, ends) if known else (np.nan, np.nan)
        large = part.assign(large=part["mass_fraction"] > LARGE).groupby("grain")["large"].sum()
        pieces, error = mean_of(large)
        own = {"exponent": fit["exponent"], "low": low, "high": high, "probability": fit["probability"]}
        own |= {"large_pieces": pieces, "large_pieces_error": error}
        rows.append({"type": kind, "size_class": name, **own, "n_fragments": len(part), "n_grains": len(large)})
    return pd.DataFrame(rows)


def power_law(sizes, largest, seed=0, replicates=200):
    """Power law p(n) ~ n^-s of the monomers of fragments, n from 1 to the largest possible, and whether it fits.

    Parameters
    ----------
    sizes : array_like of int
        Monomers of each fragment.
    largest : int or array_like of int
        Greatest possible number, of each fragment or of all.
    seed : int
    replicates : int
        Made-up samples of the fitted law, for the probability.

    Returns
    -------
    dict
        exponent (greatest likelihood) and its error; distance (Kolmogorov and Smirnov) of all sizes from the sum of the
        laws, which end at different sizes; probability that a sample of the laws lies as far from its own fit, low
        where they are not justified; n. NaN for fewer than 10 fragments.

    Raises
    ------
    InputError
        If a fragment is larger than possible.

    References
    ----------
    Clauset, Shalizi & Newman (2009), SIAM Review 51, 661.
    """
    sizes = np.asarray(sizes, dtype=np.int64)
    largest = np.broadcast_to(np.asarray(largest, dtype=np.int64), sizes.shape)
    if (sizes > largest).any():
        k = int(np.argmax(sizes > largest))
        raise InputError(f"power_law: a fragment has {sizes[k]} monomers, but {largest[k]} is the largest possible")
    if len(sizes) < 10 or len(np.unique(sizes)) < 2:
        return {"exponent": np.nan, "error": np.nan, "distance": np.nan, "probability": np.nan, "n": len(sizes)}
    exponent, distance, spread = _fit_power_law(*_counted(sizes, largest))
    rng = np.random.Generator(np.random.PCG64(seed))
    # up to a size where each law ends, they differ by a factor alone
    below = np.cumsum(np.arange(1, largest.max() + 1) ** -exponent)
    made = [
        _fit_power_law(*_counted(np.searchsorted(below, rng.random(len(sizes)) * below[largest - 1]) + 1, largest))[1]
        for _ in range(replicates)
    ]
    return {
        "exponent": exponent,
        "error": 1.0 / math.sqrt(spread * len(sizes)),
        "distance": distance,
        "probability": float(np.mean(np.array(made) >= distance)),
        "n": len(sizes),
    }


def _counted(sizes, largest, often=None):
    """How many fragments have n monomers, and how many could have n at most, n from 1 on."""
    last = largest.max() + 1
    return tuple(np.bincount(each, weights=often, minlength=last)[1:].astype(float) for each in (sizes, largest))


def _fit_power_law(counts, ends):
    """Exponent of greatest likelihood, distance, and variance of ln n, from what `_counted` returns.

    The condition is that the mean of ln n be that of the sample. It falls with the exponent, its derivative is the
    variance: Newton's steps, with bisection where one leaves the bracket.
    """
    log_n = np.log(np.arange(1, len(counts) + 1))
    share, ends = counts / counts.sum(), ends / ends.sum()
    wanted = share @ log_n
    low, high = -5.0, 15.0
    exponent, step = 1.5, np.inf
    while abs(step) > 1e-12 and high - low > 1e-12:
        weight = np.exp(-exponent * log_n)
        total = np.cumsum(weight)
        means = np.cumsum(weight * log_n) / total
        mean = ends @ means
        low, high = (exponent, high) if mean > wanted else (low, exponent)
        spread = ends @ (np.cumsum(weight * log_n**2) / total - means**2)
        step = (mean - wanted) / spread
        # an end of the bracket is allowed: that is where the last step of all, of 0, leads
        exponent = exponent + step if low <= exponent + step <= high else 0.5 * (low + high)
    law = weight * np.cumsum((ends / total)[::-1])[::-1]
    return exponent, float(np.max(np.abs(np.cumsum(share) - np.cumsum(law)))), spread
