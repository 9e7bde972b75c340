"""Numbers that docs/reproduction.md tells of the studies beside the ensemble, from their tables."""

import math

import numpy as np
import pandas as pd

from ratd.base.materials import get_material
from ratd.base.statistics import median_of
from ratd.base.units import NM
from ratd.experiments.spin_up.cells import size_key
from ratd.experiments.spin_up.claims import all_of, is_within
from ratd.experiments.spin_up.composition import PROPERTIES, table1, table2
from ratd.experiments.spin_up.cross_validation import cross_validation
from ratd.experiments.spin_up.eq33 import eq33
from ratd.experiments.spin_up.findings import MARK, median
from ratd.experiments.spin_up.formulae import DAMPING, formula_effects
from ratd.experiments.spin_up.parameters import effect
from ratd.experiments.spin_up.printed import PAIR_ERROR, PAPER_MEAN_RADIUS, TABLE_3, VISCOUS_EFFECT
from ratd.experiments.spin_up.size_law import SPLIT, curved_law
from ratd.laws import thermal
from ratd.pipeline.documents import Measured

__all__ = [
    "composition_tables", "of_curve", "of_formulae", "of_heat", "of_pairs", "of_prediction", "of_ways", "recomputed",
]  # fmt: skip

EXAMPLE = ("q-S", "BAM1", 400 * NM)
"""The grain of which the document works out omega."""
CURVED = 2.0
"""So many standard errors of q from 0 reject a straight power of size."""


def of_ways(table):
    """What the rolling limit and the viscous time do, from the table of Fig. 9 of driven grains."""
    rolled = {row["type"]: row for row in effect(table, "xi_c", MARK).to_dict("records") if row["value"] > 6e-9}
    values = {f"ways.{kind} xi": Measured(row["median"], row["error"]) for kind, row in rolled.items()}
    values["ways.holds xi"] = all_of(is_within(value, 0.95, 1.05) for value in values.copy().values())
    time, printed = VISCOUS_EFFECT
    slow = effect(table, "T_vis", MARK)
    (row,) = slow[(slow["type"] == "BAM2") & np.isclose(slow["value"], time)].to_dict("records")
    values["ways.BAM2 viscous"] = Measured(row["median"] - 1.0, row["error"])
    half = 0.5 * (printed - 1.0)
    values["ways.holds viscous"] = is_within(values["ways.BAM2 viscous"], half, 3.0 * half)
    return values


def of_pairs(tables):
    """How near pairs of monomers come to what they should."""
    table = pd.concat(tables)
    off = 1.0 - table["parting_omega"] / table["eq35_omega"]
    own = 1.0 - table["parting_omega"] / table["force_controlled_omega"]
    damped = table["start"] == "damped"
    worst = {"undamped": float(off[~damped].abs().max()), "damped": float(off[damped].abs().max())}
    held = {error <= PAIR_ERROR for error in worst.values()}
    return {
        "pairs.n": len(table),
        "pairs.undamped worst": worst["undamped"],
        "pairs.damped worst": worst["damped"],
        "pairs.damped error": float(own[damped].abs().max()),
        # it depends on a damping of which the paper says nothing
        "pairs.holds": "open" if len(held) == 2 else "yes" if held == {True} else "no",
    }


def of_formulae(table):
    """What each printed formula does alone: medians over all grains of a size, least and most."""
    every = formula_effects(table, MARK)
    every = every[every["type"] == "all"]
    contacts = every[every["formula"] != DAMPING]
    ratios = table.loc[table["formula"] == DAMPING, f"{MARK}_ratio"]
    return {
        "formulae.contacts least": float(contacts["median"].min()),
        "formulae.contacts most": float(contacts["median"].max()),
        "formulae.damping": median(ratios),
    }


def of_curve(table, grown):
    """The curved law, and the example.

    Parameters
    ----------
    table : pandas.DataFrame
        Driven grains.
    grown : pandas.DataFrame
        All grains as grown, for the printed omega of the example.
    """
    law = curved_law(table, MARK).set_index("type")
    values, bent = {}, []
    for kind, row in law.iterrows():
        values |= {f"curve.{kind} {name}": Measured(row[name], row[f"{name}_error"]) for name in ("C", "p", "q")}
        values |= {f"curve.{kind} scatter": math.exp(row["scatter"]), f"curve.{kind} n": int(row["n_grains"])}
        bent += [kind] if abs(row["q"]) > CURVED * row["q_error"] else []
    values["curve.rejected"] = " and ".join(bent) or "no type"
    material, kind, size = EXAMPLE
    row, own = law.loc[kind], get_material(material)
    x = math.log(size / SPLIT)
    unit = math.sqrt(own.surface_energy / (own.density * SPLIT**3))
    values["example.omega"] = row["C"] * unit * math.exp(-row["p"] * x - row["q"] * x * x)
    cell = grown[(grown["material"] == material) & (grown["type"] == kind) & np.isclose(grown["a_eff"], size)]
    values["example.printed"] = eq33(
        size, own.surface_energy, own.density, PAPER_MEAN_RADIUS, cell["n_contacts"].mean(),
        cell["filling_factor"].mean(), *TABLE_3[material, kind],
    )  # fmt: skip
    return values


def of_prediction(table):
    """How well laws predict grains of sizes that they were not fitted to."""
    table = table[table[MARK] > 0]
    found = cross_validation(table, MARK, by="size")
    return {
        f"predict.{row['predictor']} {row['type']}": Measured(row["scatter"], row["error"])
        for row in found.to_dict("records")
    }


def recomputed(older, newer):
    """Grains of two tables, the newer over the older: how many, and the median with its error."""
    keys = ["material", "type", "size", "seed"]
    older, newer = (table.assign(size=size_key(table["a_eff"])) for table in (older, newer))
    pairs = newer.merge(older, on=keys, suffixes=("", "_older"))
    found = median_of(pairs[MARK] / pairs[f"{MARK}_older"])
    return {"check.n": len(pairs), "check.ratio": Measured(found["median"], found["error"])}


def of_heat():
    """What heat does to the contact of two equal q-S spheres: barriers, and what is left of the pull over an hour."""
    values = {}
    for row in thermal.table(materials=("q-S",)).to_dict("records"):
        start = f"thermal.{row['law']} {row['radius'] / NM:.0f} nm"
        values[f"{start} eV"] = row["barrier_eV"]
        values[f"{start} life"] = row["life_temperature"]
        values[f"{start} kT {row['temperature']:.0f} K"] = row["barrier_kT"]
        values[f"{start} pull {row['temperature']:.0f} K"] = row["pull_off"]
    return values


def composition_tables():
    """Tables 1 and 2 in Markdown."""
    one = [
        f"| {row['ratio']} | {row['abundance']:.3f} | {row['abundance_printed']:g} | {row['abundance_over_printed']:.3f} |"
        for row in table1().to_dict("records")
    ]
    head = ["gamma [mJ/m²]", "E [GPa]", "nu", "rho [kg/m³]"]
    two = []
    for row in table2().to_dict("records"):
        cells = (f"{row[name] / unit:.4g} ({row[f'{name}_printed'] / unit:.4g})" for name, (*_, unit) in PROPERTIES.items())
        two.append(f"| {row['material']} | " + " | ".join(cells) + " |")
    return {
        "table1": "\n".join(["| ratio | computed | printed | computed/printed |", "|---|---|---|---|", *one]),
        "table2": "\n".join(["| material, used (printed) | " + " | ".join(head) + " |", "|---|" + "---|" * len(head), *two]),
    }
