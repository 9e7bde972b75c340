"""What to use where no grain is at hand: omega over size, how well that predicts, and an example."""

import math

import numpy as np

from ratd.base.materials import get_material
from ratd.base.measured import Measured, geometric_mean, median
from ratd.base.units import NM
from ratd.experiments.spin_up.cross_validation import cross_validation
from ratd.experiments.spin_up.eq33 import eq33
from ratd.experiments.spin_up.findings.ensemble import MARKS
from ratd.experiments.spin_up.marks import MARK
from ratd.experiments.spin_up.printed import PAPER_MEAN_RADIUS, TABLE_3
from ratd.experiments.spin_up.size_law import SPLIT, curved_law, curved_law_value, size_law, size_law_unit, unit_of

__all__ = ["of_curve", "of_exponents_apart", "of_law", "of_prediction"]

EXAMPLE = ("q-S", "BAM1", 400 * NM)
"""The grain of which the document works out omega; its first page has that of the other types as well."""
LARGER = 150 * NM
"""Sizes from which on grains have monomers enough for a curve to meet the mean of every size."""
FROM = (100 * NM, 150 * NM)
"""Least sizes for which q is told besides: whether it hangs on the smallest ones."""
CURVED = 2.0
"""So many standard errors of q from 0 reject a straight power of size."""


def of_law(table):
    """What to use: C and p of a power of size for each mark, and the medians of all cells."""
    values = {}
    for mark, word in MARKS.items():
        for row in size_law(table, mark).to_dict("records"):
            start = f"law.{row['type']} {word}"
            values |= {
                f"{start} C": Measured(row["C"], row["C_error"]),
                f"{start} p": Measured(row["p"], row["p_error"]),
                f"{start} scatter": math.exp(row["scatter"]),
                f"{start} n": row["n_grains"],
            }
    return values


def of_curve(table, grown):
    """The curved law, and the example: what the law says, and the median of its cell.

    Parameters
    ----------
    table : pandas.DataFrame
        Driven grains.
    grown : pandas.DataFrame
        All grains as grown, for the printed omega of the example.
    """
    law = curved_law(table, MARK).set_index("type")
    values, bent, straight = {}, [], {}
    for kind, row in law.iterrows():
        values |= {f"curve.{kind} {name}": Measured(row[name], row[f"{name}_error"]) for name in ("C", "p", "q")}
        values |= {f"curve.{kind} scatter": math.exp(row["scatter"]), f"curve.{kind} n": int(row["n_grains"])}
        values |= _farthest(table[table["type"] == kind], kind, row)
        left_out = table.loc[table["type"] == kind, MARK].isna().groupby(np.round(table["a_eff"] / NM)).mean()
        values[f"curve.{kind} left out"] = float(left_out.max())
        large = table[(table["type"] == kind) & (table["a_eff"] > 0.99 * SPLIT)]
        straight[kind] = own = size_law(large, MARK).iloc[0]
        values[f"curve.{kind} C from a_0"] = Measured(own["C"], own["C_error"])
        for least in FROM:
            part = curved_law(table[(table["type"] == kind) & (table["a_eff"] > 0.99 * least)], MARK).iloc[0]
            values[f"curve.{kind} q from {least / NM:.0f}"] = Measured(part["q"], part["q_error"])
        bent += [kind] if abs(row["q"]) > CURVED * row["q_error"] else []
    values["curve.rejected"] = " and ".join(bent) or "no type"
    for name in {name for name, _ in TABLE_3}:
        values[f"{name} gamma"] = 1e3 * get_material(name).surface_energy
        values[f"{name} rho"] = get_material(name).density
    material, kind, size = EXAMPLE
    row, own = law.loc[kind], get_material(material)
    values["example.omega"] = unit_of(own) * curved_law_value(size, *row[["C", "p", "q"]])
    values["example.omega straight"] = unit_of(own) * curved_law_value(size, *straight[kind][["C", "p"]])
    measured = _of_cell(table, *EXAMPLE)
    values["example.mean 1e7"], values["example.n"] = geometric_mean(measured[MARK].dropna() / 1e7), len(measured)
    for other in law.index:
        cell, measured = (_of_cell(each, material, other, size) for each in (grown, table))
        printed = eq33(
            size, own.surface_energy, own.density, PAPER_MEAN_RADIUS, cell["n_contacts"].mean(),
            cell["filling_factor"].mean(), *TABLE_3[material, other],
        )  # fmt: skip
        values[f"example.{other} median 1e7"] = median(measured[MARK] / 1e7)
        values[f"example.{other} printed 1e7"] = printed / 1e7
    return values


def _of_cell(table, material, kind, size):
    alike = (table["material"] == material) & (table["type"] == kind)
    return table[alike & np.isclose(table["a_eff"], size, atol=1e-12)]


def _farthest(table, kind, row):
    """The size whose mean is farthest from the curve, by what factor, and the same of the sizes from `LARGER` on.

    ``chi2`` is the sum over the sizes of the squared distance of the mean from the curve, in its standard errors.
    """
    table = table[table[MARK].astype(float) > 0.0]
    off = np.log(
        table[MARK].astype(float) / size_law_unit(table) / curved_law_value(table["a_eff"], *row[["C", "p", "q"]])
    )
    by_size = off.groupby(np.round(table["a_eff"] / NM))
    means = by_size.mean()
    larger = means[means.index >= LARGER / NM]
    return {
        f"curve.{kind} chi2": float(((means / by_size.sem()) ** 2).sum()),
        f"curve.{kind} farthest": math.exp(means.abs().max()),
        f"curve.{kind} farthest nm": int(means.abs().idxmax()),
        f"curve.{kind} farthest above": math.exp(larger.abs().max()),
    }


def of_exponents_apart(table):
    """Scatter of ln omega_disr about Eq. 33, fitted to each material and type, and with three exponents for its one.

    ``predict.one TYPE``, of N_con phi, and ``predict.three TYPE``, of N_con/N_mon, N_mon and phi, with the grains that
    were fitted; the paper's Sect. 7.4 finds them alike.
    """
    values = {}
    for kind, grains in table[table["omega_disr"] > 0].groupby("type"):
        squares = {"one": [], "three": []}
        for _, own in grains.groupby("material"):
            contacts, monomers, filling = (np.log(own[name]) for name in ("n_contacts", "n_monomers", "filling_factor"))
            known = np.log(own["omega_disr"] * own["a_eff"])
            columns = {"one": [contacts + filling], "three": [contacts - monomers, monomers, filling]}
            for name, parts in columns.items():
                design = np.column_stack([np.ones(len(own)), *parts])
                best, *_ = np.linalg.lstsq(design, known.to_numpy(), rcond=None)
                squares[name].append((known.to_numpy() - design @ best) ** 2)
        values |= {f"predict.{name} {kind}": math.sqrt(np.concatenate(own).mean()) for name, own in squares.items()}
    return values


def of_prediction(table):
    """How well laws predict grains of sizes that they were not fitted to."""
    table = table[table[MARK] > 0]
    found = cross_validation(table, MARK)
    return {
        f"predict.{row['predictor']} {row['type']}": Measured(row["scatter"], row["error"])
        for row in found.to_dict("records")
    }
