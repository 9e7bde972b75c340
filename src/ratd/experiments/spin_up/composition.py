"""Tables 1 and 2: what the monomers are made of, computed from the minerals, beside what the paper prints."""

import numpy as np
import pandas as pd

from ratd.base.materials import CO_S_FRACTIONS, MATERIALS, element_ratios
from ratd.base.units import GPA, MJ_PER_M2
from ratd.experiments.spin_up.printed import OBSERVED, PAPER, PRINTED_1, PRINTED_2
from ratd.pipeline.kinds import Kind, as_dataset, entries, register

__all__ = ["TABLE_1_COLUMNS", "TABLE_2_COLUMNS", "table1", "table2", "tables"]

PROPERTIES = {
    "surface_energy": ("J m-2", "surface energy gamma", MJ_PER_M2),
    "youngs_modulus": ("Pa", "Young's modulus E", GPA),
    "poisson_number": ("1", "Poisson number nu", 1.0),
    "density": ("kg m-3", "density rho of the bulk material", 1.0),
}
"""Property of a material -> units, meaning, unit in which it is printed [SI]."""

TABLE_1_COLUMNS = {
    "ratio": ("", "elements, by number of atoms"),
    "abundance": ("1", "ratio in co-S, from the formulas and mole fractions of its minerals"),
    "abundance_printed": ("1", "ratio in co-S as printed in Table 1 of the paper"),
    "abundance_rounding": ("1", "half of the last printed digit"),
    "abundance_over_printed": ("1", "computed over printed"),
    **{name: ("1", f"ratio observed in the interstellar medium: {source}") for name, (source, _) in OBSERVED.items()},
}
"""Units and meaning of the columns of `table1`."""

TABLE_2_COLUMNS = {
    "material": ("", "material of the monomers, or mineral of co-S"),
    "mole_fraction": ("1", "mole fraction in co-S"),
    **{
        f"{name}{suffix}": ("1" if suffix == "_over_printed" else units, what.format(meaning))
        for name, (units, meaning, _) in PROPERTIES.items()
        for suffix, what in (
            ("", "{}"),
            ("_printed", "{} as printed in Table 2 of the paper"),
            ("_rounding", "{}: half of the last printed digit"),
            ("_over_printed", "{}: used over printed"),
        )
    },
}
"""Units and meaning of the columns of `table2`."""


def rounding(text):
    """Half of the last digit of a printed number, e.g. 0.005 for "0.27" and 0.5 for "169"."""
    return 0.5 * 10.0 ** -len(text.partition(".")[2])


def table1():
    """Ratios of element abundances in co-S, from its minerals and as printed, and in the interstellar medium.

    Returns
    -------
    pandas.DataFrame
        Columns of `TABLE_1_COLUMNS`, one row a ratio; NaN where the paper quotes none.

    References
    ----------
    Reissl et al. (2024), A&A 692, A60, Table 1.
    """
    computed = element_ratios(CO_S_FRACTIONS)
    rows = []
    for k, (name, text) in enumerate(PRINTED_1.items()):
        row = {
            "ratio": name,
            "abundance": computed[name],
            "abundance_printed": float(text),
            "abundance_rounding": rounding(text),
            "abundance_over_printed": computed[name] / float(text),
        }
        rows.append(row | {source: values[k] for source, (_, values) in OBSERVED.items()})
    return pd.DataFrame(rows)[list(TABLE_1_COLUMNS)]


def table2():
    """Properties of the materials as they are used, those of co-S averaged over its minerals, and as printed.

    Returns
    -------
    pandas.DataFrame
        Columns of `TABLE_2_COLUMNS` in SI units, one row a material; the mole fraction is NaN but for the minerals.

    References
    ----------
    Reissl et al. (2024), A&A 692, A60, Table 2.
    """
    rows = []
    for name, texts in PRINTED_2.items():
        row = {"material": name, "mole_fraction": CO_S_FRACTIONS.get(name, np.nan)}
        for (quantity, (_, _, unit)), text in zip(PROPERTIES.items(), texts, strict=True):
            used = getattr(MATERIALS[name], quantity)
            row[quantity] = used
            row[f"{quantity}_printed"] = float(text) * unit
            row[f"{quantity}_rounding"] = rounding(text) * unit
            row[f"{quantity}_over_printed"] = used / (float(text) * unit)
        rows.append(row)
    return pd.DataFrame(rows)[list(TABLE_2_COLUMNS)]


def tables(files, settings, say):
    """Both tables, the outputs of a job of the pipeline that nothing in the config decides."""
    found = {}
    for name, table in (("table1", table1()), ("table2", table2())):
        found |= {name: as_dataset(table), f"{name}_csv": table}
    return found


register("table1", Kind("Table 1: ratios of elements in co-S", entries(TABLE_1_COLUMNS), references=PAPER))
register("table2", Kind("Table 2: properties of the materials", entries(TABLE_2_COLUMNS), references=PAPER))
