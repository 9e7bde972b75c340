"""Numbers of the comparison with LAMMPS: compressions of the same clusters, and clusters in a box at rest."""

import itertools

import numpy as np
import pandas as pd

from ratd.base.measured import Measured
from ratd.base.statistics import mean_of
from ratd.experiments.compression.strength import measured, of_means

__all__ = ["DENSE_EDGES", "EDGES", "of_box", "of_dense", "of_lammps"]

PAIRS = {
    "plain": ("LAMMPS", "ratd"),
    "untwisted": ("LAMMPS without twisting", "ratd without twisting"),
    "limits": ("LAMMPS", "ratd with the limits of LAMMPS"),
}
"""Codes of which one is compared with the other, see `ratd.validation.dense`."""
DENSE_EDGES = (0.05, 0.1, 0.15, 0.2)
EDGES = (0.01, 0.02, 0.03, 0.05, 0.1, 0.15)
"""Filling factors between which the pressures are compared."""


def of_lammps(table):
    """What LAMMPS finds over what is found here, of the same clusters, means over bins of phi and seeds.

    Parameters
    ----------
    table : pandas.DataFrame
        Of the kind ``validation_compression``.

    Returns
    -------
    dict
        ``lammps.pressure_LOW``, ``lammps.kinetic_LOW`` and ``lammps.n_contacts_LOW`` for the bins between
        `EDGES`, and ``lammps.apart_LOW``, the root mean square of the differences of the pressures of single
        bins over that of the pressures; ``lammps.n``, ``lammps.N`` and ``lammps.rate``.
    """
    found = _clusters("lammps", table)
    for low, high in itertools.pairwise(EDGES):
        for name, value in _over(table, "LAMMPS", "ratd", low, high).items():
            found[f"lammps.{name}_{low:g}"] = value
    return found


def _clusters(name, table):
    """How many clusters, of how many monomers, and how fast, as slots."""
    first = table.iloc[0]
    return {
        f"{name}.n": table["seed"].nunique(),
        f"{name}.N": int(first["n_monomers"]),
        f"{name}.rate": float(first["strain_rate"]),
    }


def _over(table, one, other, low, high):
    """What one code finds over what another one does between two filling factors, dict of Measured."""
    part = table[(table["phi"] > low) & (table["phi"] < high)]
    over = part.assign(pressure=part["pressure"] / part["line"])
    mean = over.groupby(["seed", "code"])[["pressure", "kinetic", "n_contacts"]].mean().unstack("code")
    found = {}
    for name in ("pressure", "kinetic"):
        both = mean[name][[one, other]].to_numpy()
        found[name] = measured(of_means(both, lambda mean: mean[0] / mean[1]))
    bins = over.pivot_table(index=["seed", "phi"], columns="code", values="pressure")
    squares = pd.DataFrame({"difference": (bins[one] - bins[other]) ** 2, "other": bins[other] ** 2})
    squares = squares.groupby("seed").sum().to_numpy()
    found["apart"] = measured(of_means(squares, lambda mean: np.sqrt(mean[0] / mean[1])))
    ratio = mean["n_contacts"][one] / mean["n_contacts"][other]
    return found | {"n_contacts": Measured(*mean_of(ratio.to_numpy()))}


def of_dense(table):
    """The same of dense clusters, and why LAMMPS finds less.

    Parameters
    ----------
    table : pandas.DataFrame
        Of the kind ``validation_dense``.

    Returns
    -------
    dict
        ``dense.WHAT_PAIR_LOW`` as of `of_lammps`, for the bins between `DENSE_EDGES` and the pairs of `PAIRS`;
        ``dense.twisting`` and ``dense.twisting_limits``, the part of the work that twisting takes in ratd up to the
        end, with its own limits and with those of LAMMPS; ``dense.twisting_matters_LOW``, the mean pressure over that
        without twisting, in ratd; ``dense.line_LOW`` and ``dense.line_untwisted_LOW``, both over P_0 phi^3;
        ``dense.n``, ``dense.N`` and ``dense.rate``.
    """
    found = _clusters("dense", table)
    for (low, high), (pair, codes) in itertools.product(itertools.pairwise(DENSE_EDGES), PAIRS.items()):
        for name, value in _over(table, *codes, low, high).items():
            found[f"dense.{name}_{pair}_{low:g}"] = value
    last = table[table["phi"] == table.groupby("seed")["phi"].transform("max")]
    for name, code in (("twisting", "ratd"), ("twisting_limits", "ratd with the limits of LAMMPS")):
        found[f"dense.{name}"] = Measured(*mean_of(last.loc[last["code"] == code, "twisting"].to_numpy()))
    for low, high in itertools.pairwise(DENSE_EDGES):
        over = _over(table, "ratd", "ratd without twisting", low, high)
        found[f"dense.twisting_matters_{low:g}"] = over["pressure"]
        part = table[(table["phi"] > low) & (table["phi"] < high)]
        for word, code in (("line", "ratd"), ("line_untwisted", "ratd without twisting")):
            own = part[part["code"] == code]
            means = (own["pressure"] / own["line"]).groupby(own["seed"]).mean()
            found[f"dense.{word}_{low:g}"] = Measured(*mean_of(means.to_numpy()))
    return found


def of_box(table):
    """Motion in a box that stays, over all the energy that there is when it comes to rest.

    Parameters
    ----------
    table : pandas.DataFrame
        Of the kind ``validation_box_at_rest``.

    Returns
    -------
    dict
        ``box.CODE least`` and ``most`` over the seeds: the greatest kinetic energy of each over kinetic + springs of
        ratd. ``box.gap``: how far ratd is from closing the balance, over the same. ``box.apart``: the greatest
        difference of the kinetic energies of ratd and of LAMMPS with kept lists, over the same. ``box.n``, ``box.N``.
    """
    ours = table[table["code"] == "ratd"]
    all_there_is = (ours["kinetic"] + ours["springs"]).groupby(ours["seed"]).first()
    found = {"box.n": table["seed"].nunique(), "box.N": int(table["n_monomers"].iloc[0])}
    for code, part in table.groupby("code"):
        ratio = part.groupby("seed")["kinetic"].max() / all_there_is
        found |= {f"box.{code} least": float(ratio.min()), f"box.{code} most": float(ratio.max())}
    found["box.gap"] = float((ours["gap"].abs().groupby(ours["seed"]).max() / all_there_is).max())
    # by number: a record of ratd ends with the step that passes its time
    record = table.groupby(["seed", "code"]).cumcount()
    wide = table.assign(record=record).pivot_table(index=["seed", "record"], columns="code", values="kinetic")
    apart = (wide["LAMMPS"] - wide["ratd"]).abs().groupby("seed").max() / all_there_is
    return found | {"box.apart": float(apart.max())}
