"""What a grain can hold without any simulation, beside Eq. 33 with the printed Table 3."""

import numpy as np
import pandas as pd

from ratd.beyond import SPLIT, eq33_omega, slopes
from ratd.bound import midplane_tension, tensile_strength_tatsuuma2019
from ratd.ensemble import PAPER_MEAN_RADIUS, TABLE_3, cell_of, size_key
from ratd.materials import get_material
from ratd.reproduction.text import NOTHING, number
from ratd.statistics import median_of
from ratd.units import NM

PM = 1e-12
"""Picometre [m], the unit of `ratd.ensemble.size_key`."""


def split_sizes(table):
    """Grains below `ratd.beyond.SPLIT` and those from it on, as far as there are any, list of DataFrame."""
    large = table["a_eff"] >= SPLIT * (1 - 1e-9)
    return [part for part in (table[~large], table[large]) if len(part)]


def sizes_of(table):
    """Sizes of a table of grains, such as "50–200 nm", or "350 nm"."""
    ends = dict.fromkeys(f"{end / NM:g}" for end in (table["a_eff"].min(), table["a_eff"].max()))
    return f"{'–'.join(ends)} nm"


def shown_sizes(table):
    """The smallest size, the one nearest to `ratd.beyond.SPLIT`, and the greatest, as `ratd.ensemble.size_key` [pm]."""
    known = np.unique(size_key(table["a_eff"]))
    return list(dict.fromkeys([known[0], known[np.argmin(np.abs(known - SPLIT / PM))], known[-1]]))


def by_type_and_size(table):
    """(type, sizes as text, grains) of each type and part of `split_sizes`, list."""
    return [
        (kind, sizes_of(part), part) for kind, own in table.groupby("type", sort=False) for part in split_sizes(own)
    ]


def table3_omega(table, materials=None):
    """omega [rad/s] of Eq. 33 with the printed A and alpha (<a_mon> = 20 nm) for each grain; NaN where none is printed.

    Parameters
    ----------
    table : pandas.DataFrame
        One row a grain.
    materials : optional
        Table of materials, handed to `ratd.materials.get_material`.

    Returns
    -------
    pandas.Series
    """
    return eq33_omega(table, TABLE_3, PAPER_MEAN_RADIUS, materials)


def printed_slopes(table, materials=None):
    """How Eq. 33 with the printed Table 3 goes with size, for the grains of a table: see `ratd.beyond.slopes`."""
    return slopes(table.assign(omega_disr=table3_omega(table, materials)))


def strength_omega(table, materials=None):
    """omega [rad/s] at which the mean tension at the mid-plane is the tensile strength of Tatsuuma et al. (2019).

    Parameters
    ----------
    table : pandas.DataFrame
        One row a grain; as in `ratd.bound.midplane_bound` the grain is a sphere of its own mass and filling factor.
    materials : optional
        Table of materials, handed to `ratd.materials.get_material`.

    Returns
    -------
    pandas.Series
    """
    result = pd.Series(np.nan, index=table.index)
    for name, rows in table.groupby("material"):
        material = get_material(name, materials)
        phi = rows["filling_factor"].to_numpy(float)
        outer = rows["a_eff"].to_numpy(float) * phi ** (-1.0 / 3.0)
        radius = rows["mean_monomer_radius"].to_numpy(float)
        strength = tensile_strength_tatsuuma2019(material.surface_energy, radius, phi)
        tension = midplane_tension(1.0, material.density, phi, outer)
        result[rows.index] = np.sqrt(strength / tension)
    return result


def ratios(table, materials=None):
    """The table of grains with columns of ratios.

    Parameters
    ----------
    table : pandas.DataFrame
        One row a grain, of one drive.
    materials : optional
        Table of materials, handed to `ratd.materials.get_material`.

    Returns
    -------
    pandas.DataFrame
        `printed_over_bound`, `strength_over_bound`, `found_over_bound`: omega of `table3_omega`, of `strength_omega`
        and omega_disr, each over the cut bound of the same grain. `found_over_printed`: omega_disr over the first of
        these. `printed_over_firm`, where the table has a firm bound: the first of these over it.
    """
    printed = table3_omega(table, materials)
    firm = {"printed_over_firm": printed / table["firm_bound"]} if "firm_bound" in table else {}
    return table.assign(
        **firm,
        printed_over_bound=printed / table["cut_bound"],
        strength_over_bound=strength_omega(table, materials) / table["cut_bound"],
        found_over_bound=table["omega_disr"] / table["cut_bound"],
        found_over_printed=table["omega_disr"] / printed,
    )


def median_and_range(table, values):
    """Median of values of the grains of a table, and range of the middle two thirds, text; all cells count alike."""
    found = median_of(values, cell=cell_of(table))
    return f"{number(found['median'])} ({number(found['low'])}–{number(found['high'])})" if found["n"] else NOTHING


def whole_nm(table):
    """Sizes of the grains of a table in whole nm, array of int."""
    return np.rint(table["a_eff"] / NM).astype(int)


def in_cell(table, cell):
    """Grains of one cell of a table; `cell` has material, type and size_nm, as in the config."""
    here = (table["material"] == cell["material"]) & (table["type"] == cell["type"])
    return table[here & np.isclose(table["a_eff"], cell["size_nm"] * NM, rtol=1e-6, atol=0)]


def same_grains(table, other, suffixes):
    """Grains that two tables have, with the columns of both; those of one name get a suffix each."""
    key = ["material", "type", "seed", "nm"]
    return table.assign(nm=whole_nm).merge(other.assign(nm=whole_nm), on=key, suffixes=suffixes)
