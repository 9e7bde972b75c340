"""Studies: what another normal force, other radii of monomers and the printed equations change.

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
from ratd.base.statistics import equal_weights, mean_of, slope_error, slope_of
from ratd.experiments.spin_up.cells import TYPES, cell_of, joined, size_key
from ratd.experiments.spin_up.eq33 import eq33_omega
from ratd.experiments.spin_up.findings.claims import all_of, is_below
from ratd.experiments.spin_up.grain_table import spun_up_files, spun_up_table
from ratd.experiments.spin_up.printed import PAPER_MEAN_RADIUS, TABLE_3
from ratd.base.measured import Measured, geometric_mean, median
from ratd.base.units import NM

__all__ = ["MARKS", "cell_ratio", "carried_over", "of_studies", "paired", "studies", "with_radii"]

ENSEMBLE, DMT, PRINTED = "spun_up", "dmt", "printed"
EQUAL = ("equal_30nm", "equal_41nm")
OTHER_MONOMERS = (*EQUAL, "second_reading")
MARKS = ("omega_first_loss", "omega_mass_75", "omega_disr")
POWERS = {1: "⟨a⟩", 2: "⟨a²⟩^(1/2)", 3: "⟨a³⟩^(1/3)"}
"""Means of the radii of a grain's monomers that may stand for <a_mon> in Eq. 33."""


def with_radii(table, files, wanted=None):
    """A table of grains with means of the radii of their monomers, which are drawn anew.

    Parameters
    ----------
    table : pandas.DataFrame
        From `spun_up_table`.
    files : list of xarray.Dataset
        Those that it is of, which say how their grains were grown.
    wanted : (n,) array_like of bool, optional
        The grains that are to have them, all when not given.

    Returns
    -------
    pandas.DataFrame
        With ``radius_k`` [m], <a^k>^(1/k) of the grain, for each power k of `POWERS`.
    """
    growth = {}
    for file in files:
        own = json.loads(file.attrs["settings"])["growth"]
        growth[own["material"]["name"], own["type"]] = RadiusDistribution(**own["radii"])
    wanted = np.ones(len(table), dtype=bool) if wanted is None else np.asarray(wanted)
    means = np.full((len(table), len(POWERS)), np.nan)
    for k in np.flatnonzero(wanted):
        row = table.iloc[k]
        distribution = growth[row["material"], row["type"]]
        radii = grain_radii(row["type"], row["a_eff"], row["material"], int(row["seed"]), distribution)
        means[k] = [np.mean(radii**power) ** (1 / power) for power in POWERS]
    return table.assign(**{f"radius_{power}": means[:, k] for k, power in enumerate(POWERS)})


def studies(data, ensemble, literal):
    """Tables of the studies, the ensemble among them.

    Parameters
    ----------
    data : path-like
        Folder of all rows.
    ensemble : list of xarray.Dataset
        Files of the ensemble, from `spun_up_files`.
    literal : pandas.DataFrame
        Grains with the printed terms of the frame.

    Returns
    -------
    dict of str to pandas.DataFrame
        Name of a study -> its table; those with other monomers, and grains of the ensemble of the same materials and
        sizes, `with_radii`. ``literal``: as given.

    Raises
    ------
    FileError
        If a study has no rows.
    """
    found = {}
    for name in (DMT, *OTHER_MONOMERS, PRINTED):
        folder = Path(data, name, "literal" if name == PRINTED else "prescribed")
        files = spun_up_files(folder)
        if not files:
            raise FileError(
                f"{folder}: holds no rows; `python -m ratd.experiments.spin_up.study --study {name}` makes them"
            )
        found[name] = spun_up_table(files)
        if name in OTHER_MONOMERS:
            found[name] = with_radii(found[name], files)
    table = spun_up_table(ensemble)
    wanted = _in_cells_of(table, pd.concat([found[name] for name in OTHER_MONOMERS]))
    return found | {ENSEMBLE: with_radii(table, ensemble, wanted), "literal": literal}


def _in_cells_of(table, other):
    """Whether grains are of a material, type and size of another table, (n,) of bool."""
    cell = cell_of(pd.concat([table, other], ignore_index=True))
    return np.isin(cell[: len(table)], cell[len(table) :])


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
    pairs = joined(table, beside, MARKS, suffix="_beside")
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


def exponent(table, beside, mark, k):
    """alpha of Eq. 33 as grains of the same cells as others have it.

    Parameters
    ----------
    table, beside : pandas.DataFrame
        The others, and those that it is fitted to: of one type, with n_contacts, filling_factor, radius_k [m] and the
        mark.
    mark : str
    k : int
        Of `POWERS`: <a_mon> in Eq. 33 is <a^k>^(1/k).

    Returns
    -------
    Measured
    """
    beside = beside[_in_cells_of(beside, table)]
    x, y = _law(beside, mark, k)
    there = np.isfinite(x + y)
    size = size_key(beside["a_eff"]).to_numpy()[there]
    alpha, influence = slope_of(x[there], y[there], beside["material"].to_numpy()[there], equal_weights(size))
    return Measured(alpha, slope_error(influence))


def carried_over(table, beside, mark, k, alpha):
    """A mark over what Eq. 33, with its exponent fitted to other grains, says of it.

    Parameters
    ----------
    table, beside, mark, k
        As for `exponent`.
    alpha : Measured
        From `exponent`.

    Returns
    -------
    Measured
        As `cell_ratio` of omega a_eff sqrt(<a_mon>)/(N_con phi)^alpha; 1 where the law holds for both.
    """
    first, second = (_levelled(own, mark, k, alpha.value) for own in (table, beside))
    ratio, lever = cell_ratio(first, second, "level"), np.log(cell_ratio(first, second, "lever").value)
    return Measured(ratio.value, float(np.hypot(ratio.error, ratio.value * lever * alpha.error)))


def _law(table, mark, k):
    """ln(N_con phi) and ln(omega a_eff sqrt(<a_mon>)) of grains, (n,) each."""
    x = np.log(table["n_contacts"] * table["filling_factor"])
    y = np.log(table[mark] * table["a_eff"] * np.sqrt(table[f"radius_{k}"]))
    return x.to_numpy(float), y.to_numpy(float)


def _levelled(table, mark, k, alpha):
    """A table with what is left of a mark beyond Eq. 33, ``level``, and N_con phi, ``lever``."""
    x, y = _law(table, mark, k)
    return table.assign(level=np.exp(y - alpha * x), lever=np.exp(x))


def of_studies(tables):
    """Values of the slots of a document on the studies.

    Parameters
    ----------
    tables : dict of str to pandas.DataFrame
        As `studies` makes them.

    Returns
    -------
    dict
        ``STUDY.TYPE MARK``, ``all`` for all types together; where grains are compared with themselves a median, with
        ``mean`` behind it the geometric mean, and with ``grains`` how many have the mark in both; ``dmt`` also by
        material, as in ``dmt.q-S BAM1 omega_mass_75``. ``printed.TYPE MARK table 3`` is over Eq. 33 with the printed
        Table 3.

        For other monomers also ``law k`` behind the mark, see `carried_over`, with the exponent ``law.TYPE MARK alpha
        k``; and ratios of ``n_monomers``, ``n_contacts``, ``filling_factor`` and ``radius k``.

        ``equal.TYPE MARK exponent`` is p in omega ~ radius^p of equal monomers at a given size, ``equal.MARK chi2 k``
        how far off `carried_over` is for them in all (six ratios), ``equal.MARK mean`` and ``worst`` the mean radii
        with the least and the most of these, ``equal.holds compact`` whether they are more porous than ours at every
        size, ``equal_30nm.holds compact`` the same of one radius. For other monomers also ``TYPE flatter MARK``, by how
        much the power of size is greater than ours between the least and the greatest size, of all marks and equal
        radii ``equal.TYPE flatter least`` and ``most``, and ``TYPE SIZE nm`` for the filling factor, a quarter, and
        ``law k``, with ``equal.sizes`` and ``equal.sizes chi2 k``, the number of these ratios and how far off they are.
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
            ratio = part[f"{mark}_ratio"].dropna()
            values[f"{name}{sign}{kind} {mark}"] = median(ratio)
            values[f"{name}{sign}{kind} {mark} mean"] = geometric_mean(ratio)
            values[f"{name}{sign}{kind} {mark} grains"] = len(ratio)
    return values


def _over_table_3(table):
    """Slots of the printed equations over the printed law."""
    law = eq33_omega(table, TABLE_3, PAPER_MEAN_RADIUS)
    values = {}
    for kind, part in _parts(table):
        for mark in MARKS:
            values[f"{PRINTED}.{kind} {mark} table 3"] = median(part[mark] / law[part.index])
    return values


def _other(name, table, ensemble):
    """Slots of a study with other monomers."""
    columns = {mark: mark for mark in ("n_monomers", "n_contacts", "filling_factor", *MARKS)}
    columns |= {f"radius {k}": f"radius_{k}" for k in POWERS}
    values = {f"{name}.grains": len(table)}
    for kind, part in _parts(table):
        for slot, column in columns.items():
            values[f"{name}.{kind} {slot}"] = cell_ratio(part, ensemble, column)
        sizes = dict(list(part.groupby(np.round(part["a_eff"] / NM))))
        for size, own in sizes.items():
            for column in ("n_monomers", "filling_factor", "omega_mass_75"):
                values[f"{name}.{kind} {size:.0f} nm {column}"] = cell_ratio(own, ensemble, column)
        for mark in MARKS:
            values[f"{name}.{kind} flatter {mark}"] = _flatter(
                *(cell_ratio(sizes[size], ensemble, mark) for size in (min(sizes), max(sizes))),
                max(sizes) / min(sizes),
            )
    for mark in MARKS:
        for k in POWERS:
            for kind in TYPES:
                own, beside = (each[each["type"] == kind] for each in (table, ensemble))
                alpha = exponent(own, beside, mark, k)
                values[f"law.{kind} {mark} alpha {k}"] = alpha
                values[f"{name}.{kind} {mark} law {k}"] = carried_over(own, beside, mark, k, alpha)
                if mark != "omega_mass_75":
                    continue
                for size, part in own.groupby(np.round(own["a_eff"] / NM)):
                    found = carried_over(part, beside, mark, k, alpha)
                    values[f"{name}.{kind} {size:.0f} nm {mark} law {k}"] = found
    return values


def _power(ratio, span):
    """The power of a quantity of which a ratio is known, between two that are `span` times apart."""
    return Measured(float(np.log(ratio.value) / np.log(span)), float(ratio.error / ratio.value / np.log(span)))


def _flatter(below, above, span):
    """By how much a power of size is greater, from two ratios at sizes that are `span` times apart."""
    ratio = above.value / below.value
    return _power(Measured(ratio, ratio * np.hypot(below.error / below.value, above.error / above.value)), span)


def _equal(tables, values):
    """Slots of both studies of equal monomers together."""
    sizes = np.unique(np.round(tables[EQUAL[0]]["a_eff"] / NM))
    keys = [f"{name}.{kind} {size:.0f} nm" for name in EQUAL for kind in TYPES for size in sizes]
    found = {}
    for name in ("equal", *EQUAL):
        compact = [values[f"{key} filling_factor"] for key in keys if key.startswith(name)]
        found[f"{name}.holds compact"] = all_of(is_below(ratio, 1.0) for ratio in compact)
    for kind in TYPES:
        flatter = [values[f"{name}.{kind} flatter {mark}"] for name in EQUAL for mark in MARKS]
        found |= {f"equal.{kind} flatter least": min(flatter), f"equal.{kind} flatter most": max(flatter)}
    small, large = (tables[name] for name in EQUAL)
    for kind, part in _parts(large):
        span = cell_ratio(part, small, "radius_1").value
        for mark in MARKS:
            found[f"equal.{kind} {mark} exponent"] = _power(cell_ratio(part, small, mark), span)
    for mark in MARKS:
        off = {}
        for k in POWERS:
            off[k] = _off([values[f"{name}.{kind} {mark} law {k}"] for name in EQUAL for kind in TYPES])
            found[f"equal.{mark} chi2 {k}"] = off[k]
        found[f"equal.{mark} mean"] = POWERS[min(off, key=off.get)]
        found[f"equal.{mark} worst"] = POWERS[max(off, key=off.get)]
    found["equal.sizes"] = len(keys)
    for k in POWERS:
        found[f"equal.sizes chi2 {k}"] = _off([values[f"{key} omega_mass_75 law {k}"] for key in keys])
    return found


def _off(ratios):
    """Sum of the squared distances of the logarithms of ratios from 0, in squared errors."""
    return float(sum((np.log(ratio.value) * ratio.value / ratio.error) ** 2 for ratio in ratios))
