"""Studies beside the ensemble: what another normal force, other radii of monomers and the printed equations change.

Their rows come from `ratd.experiments.spin_up.study`. Where a study has grains of the ensemble, each is compared with
itself. Where its monomers are others, so are its grains, and the geometric means of the cells are compared.
"""

import json
from pathlib import Path

import numpy as np
import pandas as pd

from ratd.aggregates.growth import grain_radii
from ratd.aggregates.radii import RadiusDistribution
from ratd.base.errors import FileError
from ratd.base.statistics import mean_of, median_of
from ratd.base.units import NM
from ratd.experiments.spin_up.cells import cell_of, size_key
from ratd.experiments.spin_up.eq33 import eq33_omega
from ratd.experiments.spin_up.grain_table import read_spun_up
from ratd.experiments.spin_up.printed import PAPER_MEAN_RADIUS, TABLE_3
from ratd.experiments.spin_up.run_files import read_table
from ratd.pipeline import io
from ratd.pipeline.documents import Measured

__all__ = ["DATA", "MARKS", "cell_ratio", "findings", "paired", "read_study", "same_omega", "studies"]

DATA = Path("docs/reproduction/data")
ENSEMBLE, DMT, PRINTED = "spun_up", "dmt", "printed"
EQUAL = ("equal_30nm", "equal_41nm")
OTHER_MONOMERS = (*EQUAL, "second_reading")
MARKS = ("omega_first_loss", "omega_mass_75", "omega_disr")
TYPES = ("BA", "BAM1", "BAM2")
POWERS = {1: "<a>", 2: "<a²>^(1/2)", 3: "<a³>^(1/3)"}
"""Means of the radii of a grain's monomers that may stand for <a_mon> in Eq. 33."""


def read_study(folder):
    """Table of the grains of a study, with means of the radii of their monomers.

    Parameters
    ----------
    folder : path-like
        Of one drive, as of `read_spun_up`.

    Returns
    -------
    pandas.DataFrame
        As `read_spun_up` makes it, and for each power k of `POWERS` ``radius_k`` [m], <a^k>^(1/k) of the grain.
    """
    table = read_spun_up(folder)
    growth = {}
    for path in sorted(Path(folder).glob("*.nc")):
        own = json.loads(io.read(path, "spun_up").attrs["settings"])["growth"]
        growth[own["material"]["name"], own["type"]] = RadiusDistribution(**own["radii"])
    radii = [
        grain_radii(row.type, row.a_eff, row.material, int(row.seed), growth[row.material, row.type])
        for row in table.itertuples()
    ]
    for k in POWERS:
        table[f"radius_{k}"] = [np.mean(own**k) ** (1 / k) for own in radii]
    return table


def studies(data=DATA):
    """Tables of the studies, the ensemble among them.

    Parameters
    ----------
    data : path-like
        Folder of all rows.

    Returns
    -------
    dict of str to pandas.DataFrame
        Name of a study -> its table; ``literal``, the grains of the ensemble with the drive literal.

    Raises
    ------
    FileError
        If a study has no rows.
    """
    data = Path(data)
    found = {}
    for name in (ENSEMBLE, DMT, *OTHER_MONOMERS, PRINTED):
        folder = data / name / ("literal" if name == PRINTED else "prescribed")
        if not any(folder.glob("*.nc")):
            raise FileError(
                f"{folder}: holds no rows; `python -m ratd.experiments.spin_up.study --study {name}` makes them"
            )
        found[name] = read_study(folder)
    found["literal"] = read_table(data / "literal.nc")
    return found


def paired(table, beside):
    """Marks of grains over those of the same grains in another table.

    Parameters
    ----------
    table, beside : pandas.DataFrame
        As `ratd.experiments.spin_up.grain_table.grain_table` makes them.

    Returns
    -------
    pandas.DataFrame
        The rows of `table` that have such a grain, with ``NAME_ratio`` for each of `MARKS`.
    """
    key = ["material", "type", "size", "seed"]
    first, second = (own.assign(size=size_key(own["a_eff"])) for own in (table, beside))
    pairs = first.merge(second[[*key, *MARKS]], on=key, suffixes=("", "_beside"))
    return pairs.assign(**{f"{mark}_ratio": pairs[mark] / pairs[f"{mark}_beside"] for mark in MARKS})


def cell_ratio(table, beside, column):
    """Geometric mean of a column over that of other grains: mean over the cells (material, type, size) that both have.

    Parameters
    ----------
    table, beside : pandas.DataFrame
        One row a grain, with material, type, a_eff [m] and the column; NaN are left out.
    column : str
        Of numbers above 0.

    Returns
    -------
    Measured
        NaN without common cells. All cells count alike. The error comes from the scatter of the grains in the cells
        of both; a bootstrap of the few grains of a cell would give sqrt(1 - 1/n) of it.
    """
    both = pd.concat([table, beside], ignore_index=True)
    mine = np.arange(len(both)) < len(table)
    values = both[column].to_numpy(float)
    there = np.isfinite(values)
    cell = cell_of(both)
    common = there & np.isin(cell, np.intersect1d(cell[there & mine], cell[there & ~mine]))
    (first, error), (second, other) = (
        mean_of(np.log(values[common & part]), cell[common & part]) for part in (mine, ~mine)
    )
    ratio = float(np.exp(first - second))
    return Measured(ratio, ratio * float(np.hypot(error, other)))


def same_omega(radii, ratios):
    """Radius of equal monomers of which grains come apart as those of the ensemble do.

    Parameters
    ----------
    radii : (2,) array_like
        Of the equal monomers of two studies [m].
    ratios : (2,) sequence of Measured
        omega of their grains over that of the ensemble.

    Returns
    -------
    radius : Measured
        [m], on the power law through both.
    exponent : Measured
        p in omega ~ radius^p at a given size and type.
    """
    (low, high), (near, far) = np.log(radii), ratios
    span = high - low
    first, second = np.log(near.value), np.log(far.value)
    spread = [ratio.error / ratio.value for ratio in ratios]
    rise = second - first
    exponent = rise / span
    radius = np.exp(low - first / exponent)
    # both ratios are taken for independent; the scatter of the ensemble, which they share, is less than their own
    error = radius * span * np.hypot(second * spread[0], first * spread[1]) / rise**2
    return Measured(float(radius), float(error)), Measured(float(exponent), float(np.hypot(*spread) / abs(span)))


def findings(tables):
    """Values of the slots of a document on the studies.

    Parameters
    ----------
    tables : dict of str to pandas.DataFrame
        As `studies` makes them.

    Returns
    -------
    dict
        ``STUDY.TYPE MARK``, ``all`` for all types together; ``dmt`` also by material, as in ``dmt.q-S BAM1
        omega_mass_75``. For other monomers also ``scaled k`` behind the mark, the same for omega sqrt(<a^k>^(1/k)),
        which Eq. 33 has at the same N_con and phi, and ratios of ``n_monomers``, ``n_contacts``, ``filling_factor``
        and ``radius k``. ``equal.TYPE MARK radius`` and ``exponent`` are those of `same_omega` (nm), ``equal.MARK
        mean`` the mean radius with which Eq. 33 brings equal monomers nearest to the ensemble. ``printed.TYPE MARK
        table 3`` is over Eq. 33 with the printed Table 3.
    """
    ensemble = tables[ENSEMBLE]
    values = _same(DMT, tables[DMT], ensemble)
    for material in tables[DMT]["material"].unique():
        part = tables[DMT][tables[DMT]["material"] == material]
        values |= _same(f"{DMT}.{material}", part, ensemble, sign=" ")
    values |= _same(PRINTED, tables[PRINTED], tables["literal"])
    values |= _over_table_3(tables[PRINTED])
    for name in OTHER_MONOMERS:
        values |= _other(name, tables[name], ensemble)
    return values | _equal(tables, values)


def _parts(table):
    """Grains of each type, and of all."""
    yield "all", table
    for kind in TYPES:
        yield kind, table[table["type"] == kind]


def _same(name, table, beside, sign="."):
    """Slots of a study with grains of the ensemble."""
    pairs = paired(table, beside)
    values = {f"{name}{sign}grains": len(pairs)}
    for kind, part in _parts(pairs):
        for mark in MARKS:
            found = median_of(part[f"{mark}_ratio"])
            values[f"{name}{sign}{kind} {mark}"] = Measured(found["median"], found["error"])
    return values


def _over_table_3(table):
    """Slots of the printed equations over the printed law."""
    law = eq33_omega(table, TABLE_3, PAPER_MEAN_RADIUS)
    values = {}
    for kind, part in _parts(table):
        for mark in MARKS:
            found = median_of(part[mark] / law[part.index])
            values[f"{PRINTED}.{kind} {mark} table 3"] = Measured(found["median"], found["error"])
    return values


def _scaled(table):
    """A table with marks times the root of each mean radius."""
    return table.assign(
        **{f"{mark} scaled {k}": table[mark] * np.sqrt(table[f"radius_{k}"]) for mark in MARKS for k in POWERS}
    )


def _other(name, table, ensemble):
    """Slots of a study with other monomers."""
    table, ensemble = _scaled(table), _scaled(ensemble)
    columns = {mark: mark for mark in ("n_monomers", "n_contacts", "filling_factor", *MARKS)}
    columns |= {f"radius {k}": f"radius_{k}" for k in POWERS}
    columns |= {f"{mark} scaled {k}": f"{mark} scaled {k}" for mark in MARKS for k in POWERS}
    values = {f"{name}.grains": len(table)}
    for kind, part in _parts(table):
        for slot, column in columns.items():
            values[f"{name}.{kind} {slot}"] = cell_ratio(part, ensemble, column)
    return values


def _equal(tables, values):
    """Slots of both studies of equal monomers together."""
    found = {}
    radii = [tables[name]["radius_1"].mean() for name in EQUAL]
    for mark in MARKS:
        for kind in ("all", *TYPES):
            radius, exponent = same_omega(radii, [values[f"{name}.{kind} {mark}"] for name in EQUAL])
            found[f"equal.{kind} {mark} radius"] = Measured(radius.value / NM, radius.error / NM)
            found[f"equal.{kind} {mark} exponent"] = exponent
        off = {
            k: sum(np.log(values[f"{name}.{kind} {mark} scaled {k}"].value) ** 2 for name in EQUAL for kind in TYPES)
            for k in POWERS
        }
        found[f"equal.{mark} mean"] = POWERS[min(off, key=off.get)]
    return found
