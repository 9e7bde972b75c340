"""Tables 1 and 2: what the monomers are made of, computed from the minerals, beside what the paper prints."""

import numpy as np
import pandas as pd

from ratd.base.markdown import markdown_table
from ratd.base.materials import CO_S_FRACTIONS, MATERIALS, element_ratios
from ratd.base.units import GPA, MJ_PER_M2

__all__ = ["OBSERVED", "PRINTED_1", "PRINTED_2", "TABLE_1_COLUMNS", "TABLE_2_COLUMNS", "table1", "table2", "tell"]

PRINTED_1 = {"Mg/O": "0.23", "Si/O": "0.27", "Fe/O": "0.21", "Mg/Fe": "1.08", "(Mg+Fe)/Si": "1.60"}
"""Ratios of element abundances in co-S as printed in Table 1 ("this work"), with their printed digits."""

OBSERVED = {
    "min_2007": ("Min et al. (2007)", (0.31, 0.26, 0.15, 2.03, 1.82)),
    "voshchinnikov_2010": ("Voshchinnikov & Henning (2010)", (np.nan, np.nan, np.nan, 1.09, 2.25)),
    "compiegne_2011": ("Compiègne et al. (2011)", (0.23, 0.19, 0.19, 1.25, 2.25)),
    "hensley_2021": ("Hensley & Draine (2021)", (0.19, 0.15, 0.17, 1.07, 2.34)),
}
"""Ratios in the interstellar medium as Table 1 quotes them, in the order of `PRINTED_1`."""

PROPERTIES = {
    "surface_energy": ("J m-2", "surface energy gamma", MJ_PER_M2, "gamma [mJ/m²]"),
    "youngs_modulus": ("Pa", "Young's modulus E", GPA, "E [GPa]"),
    "poisson_number": ("1", "Poisson number nu", 1.0, "nu"),
    "density": ("kg m-3", "density rho of the bulk material", 1.0, "rho [kg/m³]"),
}
"""Property of a material -> units, meaning, unit in which it is printed [SI], head of its column in print."""

PRINTED_2 = {
    "a-C": ("50", "168", "0.16", "2368"),
    "q-S": ("20", "54", "0.17", "2650"),
    "co-S": ("70", "169", "0.27", "3707"),
    "forsterite": ("70", "204", "0.24", "3213"),
    "fayalite": ("70", "140", "0.32", "4393"),
    "enstatite": ("70", "180", "0.21", "3209"),
    "ferrosilite": ("70", "142", "0.31", "4014"),
}
"""Table 2 as printed, with its digits, in the order and units of `PROPERTIES`."""

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
        for name, (units, meaning, _, _) in PROPERTIES.items()
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
        for (quantity, (_, _, unit, _)), text in zip(PROPERTIES.items(), texts, strict=True):
            used = getattr(MATERIALS[name], quantity)
            row[quantity] = used
            row[f"{quantity}_printed"] = float(text) * unit
            row[f"{quantity}_rounding"] = rounding(text) * unit
            row[f"{quantity}_over_printed"] = used / (float(text) * unit)
        rows.append(row)
    return pd.DataFrame(rows)[list(TABLE_2_COLUMNS)]


def tell():
    """Both tables in Markdown.

    Returns
    -------
    tuple of str
        Table 1 and Table 2. A printed value stands with half of its last digit; the ratio is used over printed.
    """
    head = ["co-S", *PRINTED_1]
    first = table1().set_index("ratio")
    rows = [
        ["computed", *(f"{value:.4f}" for value in first["abundance"])],
        ["printed", *(f"{text} ± {rounding(text):g}" for text in PRINTED_1.values())],
        ["computed/printed", *(f"{value:.3f}" for value in first["abundance_over_printed"])],
    ]
    for name, (source, _) in OBSERVED.items():
        rows.append([source, *("–" if np.isnan(value) else f"{value:g}" for value in first[name])])
    one = markdown_table(head, rows)

    head = ["material", "mole fraction", *(f"{heading}: {kind}" for *_, heading in PROPERTIES.values()
                                           for kind in ("used", "printed", "ratio"))]  # fmt: skip
    rows = []
    for _, row in table2().iterrows():
        cells = [row["material"], "–" if np.isnan(row["mole_fraction"]) else f"{row['mole_fraction']:g}"]
        for (quantity, (_, _, unit, _)), text in zip(PROPERTIES.items(), PRINTED_2[row["material"]], strict=True):
            cells.append(f"{row[quantity] / unit:.5g}")
            cells += [f"{text} ± {rounding(text):g}", f"{row[f'{quantity}_over_printed']:.4f}"]
        rows.append(cells)
    return one, markdown_table(head, rows)
