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
from ratd.base.statistics import drawn_counts, equal_weights, mean_of
from ratd.experiments.spin_up.cells import N_BOOTSTRAP, cell_of

HALF = 0.5
"""Part of the mass that leaves in the second piece of the list."""
COLUMNS = {
    "material": ("", "material of the monomers"),
    "type": ("", "growth: BA, BAM1 or BAM2"),
    "a_eff": ("m", "effective radius of the grain"),
    "seed": ("1", "seed of the grain"),
    "grain_mass": ("kg", "mass of the grain"),
    "omega_disr": ("rad s-1", "angular velocity of disruption"),
    "mass_fraction_disr": ("1", "mass of the largest fragment at omega_disr over that of the grain"),
}
"""Units and meaning of what is known of each grain."""
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
        Scalars of `COLUMNS` and, over `fragment`, the variables of `FRAGMENT_COLUMNS`, in the order of leaving.
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
    row = xr.Dataset(
        {
            **{name: run.attrs[name] for name in ("material", "type", "a_eff", "seed")},
            "grain_mass": grain_mass,
            "omega_disr": float(mark["omega_disr"]),
            "mass_fraction_disr": float(mark["mass_fraction_disr"]),
        }
    )
    for name in FRAGMENT_COLUMNS:
        row[name] = ("fragment", run[name].values[order][:kept])
    return row


def join(rows):
    """Fragmentation of many grains as one dataset, the fragments one grain after the other.

    Parameters
    ----------
    rows : list of xarray.Dataset
        What `fragmentation` returned for them.

    Returns
    -------
    xarray.Dataset
        `COLUMNS` and row_size_fragment over `row`, `FRAGMENT_COLUMNS` over `fragment`: a file of kind "fragments".

    Raises
    ------
    InputError
        If there is no grain.
    """
    if not rows:
        raise InputError("fragmentation: at least one grain is needed")
    result = xr.Dataset({name: ("row", np.array([row[name].item() for row in rows])) for name in COLUMNS})
    result["row_size_fragment"] = ("row", np.array([row.sizes["fragment"] for row in rows], dtype="i8"))
    for name in FRAGMENT_COLUMNS:
        result[name] = ("fragment", np.concatenate([row[name].values for row in rows]))
    return result


def fragment_table(dataset):
    """One row a fragment, with its grain.

    Parameters
    ----------
    dataset : xarray.Dataset
        Of kind "fragments"; may have more over `row`.

    Returns
    -------
    pandas.DataFrame
        Columns over `row`, those of `COLUMNS` at least, and `FRAGMENT_COLUMNS`; `grain`, the number of the grain;
        `mass_fraction`, the mass of the fragment over that of the grain; `disruption` and `half`, whether it belongs to
        these `STAGES`; `weight` of the grain, with which all cells (material, type, size) count alike.
    """
    size = dataset["row_size_fragment"].values
    of_grains = [name for name in dataset if dataset[name].dims == ("row",) and name != "row_size_fragment"]
    grains = pd.DataFrame({name: dataset[name].values for name in of_grains})
    grains["grain"] = np.arange(len(grains))
    grains["weight"] = equal_weights(cell_of(grains))
    table = grains.loc[grains.index.repeat(size)].reset_index(drop=True)
    for name in FRAGMENT_COLUMNS:
        table[name] = dataset[name].values
    table["mass_fraction"] = table["fragment_mass"] / table["grain_mass"]
    before = table.groupby("grain")["mass_fraction"].cumsum() - table["mass_fraction"]
    table["half"] = before < HALF
    table["disruption"] = table["fragment_omega"] <= table["omega_disr"]
    return table


def spun_up_fragments(files):
    """Fragments of the grains that the queue of spin-ups has finished.

    Parameters
    ----------
    files : list of xarray.Dataset
        From `ratd.experiments.spin_up.grain_table.spun_up_files`.

    Returns
    -------
    pandas.DataFrame
        As `fragment_table` makes it, with n_monomers of the grain.
    """
    grains = pd.concat(
        [
            pd.DataFrame(
                {
                    "material": file.attrs["material"],
                    "type": file.attrs["type"],
                    "grain_mass": file["initial_mass"].values,
                    "n_monomers": file["initial_n_monomers"].values,
                    **{name: file[name].values for name in ("a_eff", "seed", "omega_disr", "mass_fraction_disr")},
                    "row_size_fragment": file["row_size_fragment"].values,
                }
            )
            for file in files
        ]
    )
    joined = xr.Dataset({name: ("row", grains[name].to_numpy()) for name in grains})
    for name in FRAGMENT_COLUMNS:
        joined[name] = ("fragment", np.concatenate([file[name].values for file in files]))
    return fragment_table(joined)


def size_class(a_eff):
    """Name of `SIZE_CLASSES` of each a_eff [m], pandas.Series, in the order of the classes."""
    low = [start for start, _ in SIZE_CLASSES.values()]
    return pd.cut(a_eff, [*low, math.inf], right=False, labels=list(SIZE_CLASSES))


MONOMER_BINS = (1, 2, 4, 11, np.inf)
"""Edges of classes of fragments by number of monomers: 1, 2-3, 4-10, 11 and more."""

MONOMER_CLASSES = ("1 monomer", "2–3", "4–10", "more than 10")


def fragment_shares(fragments, stage, seed=0):
    """Shares of fragments of different size in the mass and the number of those that left.

    Parameters
    ----------
    fragments : pandas.DataFrame
        From `fragmentation.fragment_table`.
    stage : str
        One of `fragmentation.STAGES`.
    seed : int
        Of the bootstrap over grains.

    Returns
    -------
    pandas.DataFrame
        A row a type and class: mass_share and number_share with `_error`, NaN for one grain; n_fragments, n_grains
        (that lost any). Each fragment has the weight of its grain.
    """
    rng = np.random.Generator(np.random.PCG64(seed))
    rows = []
    chosen = fragments[fragments[stage]]
    for kind, part in chosen.groupby("type"):
        which = np.digitize(part["fragment_n_monomers"], MONOMER_BINS) - 1
        grain = pd.factorize(part["grain"])[0]
        n = grain.max() + 1
        mass, number = np.zeros((n, len(MONOMER_CLASSES))), np.zeros((n, len(MONOMER_CLASSES)))
        np.add.at(mass, (grain, which), part["weight"] * part["mass_fraction"])
        np.add.at(number, (grain, which), part["weight"])
        drawn = rng.integers(n, size=(N_BOOTSTRAP, n))
        shares = {}
        for name, values in (("mass_share", mass), ("number_share", number)):
            total = values[drawn].sum(axis=1)
            error = np.std(total / total.sum(axis=1, keepdims=True), axis=0, ddof=1)
            shares[name] = values.sum(axis=0) / values.sum()
            shares[f"{name}_error"] = error if n > 1 else np.full_like(error, np.nan)
        for k, label in enumerate(MONOMER_CLASSES):
            own = {name: float(values[k]) for name, values in shares.items()}
            rows.append({"type": kind, "class": label, **own, "n_fragments": len(part), "n_grains": int(n)})
    return pd.DataFrame(rows)


def exponents(fragments, stage="half", confidence=0.95, replicates=400, seed=0):
    """Exponents of the sizes of fragments by type and class of size, and the number of large pieces.

    Parameters
    ----------
    fragments : pandas.DataFrame
        From `spun_up_fragments`.
    stage : str
        One of `fragmentation.STAGES`.
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
