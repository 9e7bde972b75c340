"""What docs/validation.md tells of growth: slots and tables, from the table of that check and the reference."""

import numpy as np
from scipy.stats import chi2, kstest, norm

from ratd.validation.findings import CHANCE, verdict
from ratd.validation.growth import NOT

__all__ = ["arrival_values", "grown", "migrations", "of_growth"]


def grown(table, reference):
    """Aggregates of equal monomers beside those of the reference, a row a type and number.

    Parameters
    ----------
    table, reference : pandas.DataFrame
        Of the check ``growth``; of `tests/reference/growth.py`.

    Returns
    -------
    list of dict
        type, n_monomers, porosity and its standard error, that of the reference, and their difference over both errors.
    """
    own = table[(table["study"] == "aggregates") & table["migration"].isin([NOT, "nearest"])]
    rows = []
    for other in reference.itertuples():
        part = own.loc[(own["type"] == other.type) & (own["n_monomers"] == other.n_monomers), "porosity"]
        error = part.std() / np.sqrt(len(part))
        rows.append(
            dict(
                type=other.type, n_monomers=other.n_monomers, aggregates=len(part), porosity=part.mean(), error=error,
                reference=other.porosity, reference_error=other.error,
                sigmas=(part.mean() - other.porosity) / np.hypot(error, other.error),
            )
        )  # fmt: skip
    return rows


def arrival_values(table):
    """Of single arrivals: name -> values, which should be uniform between 0 and 1."""
    own = table[table["study"] == "arrivals"]
    values = {"squared impact parameter": own["impact"]}
    for name in ("direction", "place"):
        x, y, z = (own[f"{name}_{axis}"] for axis in "xyz")
        values |= {f"{name}, z": 0.5 + 0.5 * z, f"{name}, azimuth": 0.5 + np.arctan2(y, x) / (2.0 * np.pi)}
    return values


def migrations(table):
    """Grains with the radii of the ensemble under both ways to migrate, a row a type, size and way.

    Returns
    -------
    list of dict
        The enclosing radius [nm], its median and where 95 % of the grains lie, and the mean porosity with its error.
    """
    own = table[(table["study"] == "grains") & (table["type"] != "BA")]
    size = (own["a_eff"] * 1e9).round().astype(int)
    rows = []
    for (kind, a_eff, way), part in own.groupby([own["type"], size, own["migration"]]):
        low, middle, high = part["enclosing_radius"].quantile([0.025, 0.5, 0.975]) * 1e9
        porosity = part["porosity"]
        rows.append(
            dict(
                type=kind, a_eff_nm=a_eff, migration=way, grains=len(part), a_out_nm=middle, a_out_low_nm=low,
                a_out_high_nm=high, porosity=porosity.mean(), error=porosity.std() / np.sqrt(len(part)),
            )
        )  # fmt: skip
    return rows


def of_growth(table, reference):
    """Aggregates as grown, and the directions of arrivals."""
    rows = grown(table, reference)
    sigmas = np.array([row["sigmas"] for row in rows])
    one_way = np.array([row["sigmas"] for row in rows if row["type"] == "BAM2"])
    alike = float(chi2.sf(np.sum(sigmas**2), len(sigmas)))
    chances = [kstest(values, "uniform").pvalue for values in arrival_values(table).values()]
    found = {(row["type"], row["a_eff_nm"], row["migration"]): row["porosity"] for row in migrations(table)}
    more = [found[kind, size, "nearest"] - found[kind, size, "random"] for kind, size, way in found if way == "nearest"]
    return {
        "growth.aggregates": sum(row["aggregates"] for row in rows),
        "growth.cases": len(rows),
        "growth.worst": np.abs(sigmas).max(),
        "growth.apart": max(abs(row["porosity"] - row["reference"]) for row in rows),
        "growth.lower": float(np.mean([row["reference"] - row["porosity"] for row in rows])),
        "growth.alike": alike,
        "growth.BAM2 alike": float(2.0 * norm.sf(abs(one_way.sum()) / np.sqrt(len(one_way)))),
        "growth.verdict": verdict(alike > CHANCE),
        "growth.arrivals": int((table["study"] == "arrivals").sum()),
        "growth.chance": min(chances),
        "growth.tests": len(chances),
        "growth.arrivals verdict": verdict(min(chances) > CHANCE),
        "growth.nearest least": min(more),
        "growth.nearest most": max(more),
    }
