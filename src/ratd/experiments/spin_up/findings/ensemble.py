"""Every number that docs/reproduction.md tells of the ensemble, from its tables.

The names of the values are those of the slots in docs/templates/reproduction.md; what belongs to a drive begins with
its letter: ``d`` for the consistent model (`prescribed`), ``p`` for the printed terms of the frame (`literal`).
"""

import math

import numpy as np
import pandas as pd

from ratd.aggregates.strength import midplane_tension, tensile_strength_tatsuuma2019
from ratd.base.materials import get_material
from ratd.base.statistics import median_of
from ratd.base.units import NM
from ratd.experiments.spin_up.cells import MATERIALS, TYPES, cell_of, joined, size_key
from ratd.experiments.spin_up.eq33 import eq33_omega, fit_ensemble
from ratd.experiments.spin_up.marks import MARK
from ratd.experiments.spin_up.printed import PAPER_MEAN_RADIUS, TABLE_3
from ratd.experiments.spin_up.size_law import slopes
from ratd.base.measured import Measured, geometric_mean, median

__all__ = [
    "CLASSES", "MARKS", "beside_print", "marks_compared", "of_drive", "of_table_3",
    "strength_omega", "table_3_by_mark", "what_contacts_hold",
]  # fmt: skip

MARKS = {"omega_first_loss": "first loss", "omega_mass_75": "a quarter", "omega_disr": "omega_disr"}
CLASSES = {"small": (40, 275), "large": (275, 600)}
"""Classes of a_eff [nm]: 50 to 250, and 300 to 550 nm."""
AT = (50, 300, 550)
"""Sizes [nm] of which numbers are told."""


def beside_print(table):
    """The table with ``printed``, Eq. 33 with A and alpha as printed in Table 3 [rad/s], for each grain."""
    return table.assign(printed=eq33_omega(table, TABLE_3, PAPER_MEAN_RADIUS), nm=table["a_eff"] / NM)


def of_class(table, name):
    """The rows of a class of size."""
    return table[table["nm"].between(*CLASSES[name])]


def middle(values):
    """Where the middle two thirds of some values lie, as a text."""
    found = median_of(values)
    return f"{found['low']:.3g}–{found['high']:.3g}"


def of_drive(letter, table):
    """How many grains a drive has, where they part, and how that goes with size.

    Parameters
    ----------
    letter : str
        The first letter of the names.
    table : pandas.DataFrame
        As `beside_print` returns it.

    Returns
    -------
    dict
        Name of a slot -> value.
    """
    seeds = np.unique(table.groupby(cell_of(table)).size())
    values = {f"{letter}.n": len(table), f"{letter}.seeds": " to ".join(map(str, dict.fromkeys(seeds[[0, -1]])))}
    values[f"{letter}.unfinished"] = int((~table["omega_disr"].notna()).sum())
    values[f"{letter}.no quarter"] = int(table[MARK].isna().sum())
    ratio = table[MARK] / table["printed"]
    values[f"{letter}.ratio"] = median(ratio, cell_of(table))
    values[f"{letter}.ratio middle"] = middle(ratio)
    values[f"{letter}.least"], values[f"{letter}.most"] = table["omega_disr"].min(), table["omega_disr"].max()
    for kind in TYPES:
        part = table[table["type"] == kind]
        for size in AT:
            here = part[np.isclose(part["nm"], size)]
            values[f"{letter}.{kind} {size}"] = geometric_mean(here[MARK] / here["printed"], cell_of(here))
            # one that never loses a quarter holds to more than its first loss
            least = here[MARK].fillna(here["omega_first_loss"])
            values[f"{letter}.{kind} {size} at least"] = geometric_mean(least / here["printed"], cell_of(here))
    for mark, word in MARKS.items():
        for row in slopes(table, mark).to_dict("records"):
            for side in ("below", "above", "change"):
                values[f"{letter}.slope {row['type']} {word} {side}"] = Measured(row[side], row[f"{side}_error"])
    for other in ("BAM1", "BAM2"):
        cells = table.assign(log=np.log(table["omega_disr"])).groupby(["material", "type", size_key(table["a_eff"])])
        mean = cells["log"].mean().unstack("type")
        lower = mean["BA"] < mean[other]
        values[f"{letter}.BA over {other}"] = math.exp((mean["BA"] - mean[other]).mean())
        values[f"{letter}.BA below {other}"] = int(lower.sum())
    return values


def cell_medians(table, mark=MARK):
    """Medians of the cells [1e6 rad/s], a row a material and type, a column a size [nm]: a table of Markdown."""
    grouped = table.groupby(["material", "type", "nm"])[mark].median() / 1e6
    sizes = sorted(table["nm"].round().unique())
    lines = ["| material | type | " + " | ".join(f"{size:.0f} nm" for size in sizes) + " |"]
    lines += ["|---|---|" + "---|" * len(sizes)]
    for material in MATERIALS:
        for kind in TYPES:
            row = grouped[material, kind]
            cells = (row[np.isclose(row.index, size)] for size in sizes)
            lines.append(f"| {material} | {kind} | " + " | ".join(_short(cell) for cell in cells) + " |")
    return "\n".join(lines)


def _short(cell):
    return f"{cell.iloc[0]:.3g}" if len(cell) and np.isfinite(cell.iloc[0]) else "–"


def marks_compared(table):
    """The answer by each mark, of the drive of a table: over print, and the slopes are in `of_drive`."""
    values = {}
    for mark, word in MARKS.items():
        for kind in TYPES:
            for name in CLASSES:
                part = of_class(table[table["type"] == kind], name)
                known = part[part[mark] > 0]
                values[f"marks.{kind} {name} {word}"] = geometric_mean(known[mark] / known["printed"], cell_of(known))
    return values


def of_table_3(letter, fit):
    """A and alpha of Eq. 33, fitted to the grains of a drive (`eq33.fit_ensemble`), beside Table 3."""
    fit = fit.isel(mean_radius=0)
    values, held = {}, 0
    for (material, kind), (A, alpha) in TABLE_3.items():
        own = fit.sel(material=material, type=kind)
        low, high = own["alpha_low"].item(), own["alpha_high"].item()
        held += low <= alpha <= high
        start = f"{letter}.table3 {material} {kind}"
        values[f"{start} A"] = f"{own['A'].item():.2f} ({own['A_low'].item():.2f}–{own['A_high'].item():.2f})"
        values[f"{start} alpha"] = f"{own['alpha'].item():.2f} ({low:.2f} to {high:.2f})".replace("-", "−")
        values[f"{start} printed"] = f"{A:.2f}, {alpha:.2f}"
    values[f"{letter}.table3 held"] = held
    values[f"{letter}.holds alpha"] = {len(TABLE_3): "yes", 0: "no"}.get(held, "open")
    alphas = fit["alpha"].values
    values[f"{letter}.alpha least"], values[f"{letter}.alpha most"] = float(alphas.min()), float(alphas.max())
    return values


def table_3_by_mark(table):
    """A and alpha of Eq. 33, fitted to each mark of the driven grains but the paper's own, as texts, and their sign.

    Parameters
    ----------
    table : pandas.DataFrame
        As `beside_print` returns it.
    """
    values, most, held = {}, [], []
    for mark, short in MARKS.items():
        if mark != "omega_disr":
            found = of_table_3("d", fit_ensemble(table, PAPER_MEAN_RADIUS, mark=mark))
            for material, kind in TABLE_3:
                start = f"d.table3 {material} {kind}"
                values |= {f"{start} {number} {short}": found[f"{start} {number}"] for number in ("A", "alpha")}
            most.append(found["d.alpha most"])
            held.append(found["d.table3 held"])
    sign = "negative" if max(most) < 0.0 else "not always negative"
    return values | {"d.alpha by mark": sign, "d.held by mark": "none" if not any(held) else "some"}


def strength_omega(table):
    """omega [rad/s] at which the mean tension in the mid-plane of each grain is the tensile strength of its material.

    The grain counts as a sphere of its own mass and filling factor phi, its strength is 0.6 gamma/a phi^1.8 with the
    mean radius a of its monomers (Tatsuuma et al. 2019).
    """
    found = np.empty(len(table))
    for name in table["material"].unique():
        here = (table["material"] == name).to_numpy()
        material, rows = get_material(name), table[here]
        phi, radius = rows["filling_factor"].to_numpy(), rows["mean_monomer_radius"].to_numpy()
        strength = tensile_strength_tatsuuma2019(material.surface_energy, radius, phi)
        outer = rows["a_eff"].to_numpy() * phi ** (-1.0 / 3.0)
        found[here] = np.sqrt(strength / midplane_tension(1.0, material.density, phi, outer))
    return pd.Series(found, index=table.index)


def _what_is_left(grown, table):
    """Marks above the firm bound of the grain as grown: what is left of a grain may turn faster than the whole.

    ``bound.large above most`` is how many large grains could not reach the printed omega even if they held as many
    times their bound as any large one of their type that was spun up, at the paper's mark; ``bound.all above most`` the
    same of all sizes. ``bound.most left`` is the most that any holds.
    """
    values = {f"bound.over {mark}": int((table[mark] > table["firm_bound"]).sum()) for mark in (MARK, "omega_disr")}
    above = total = above_of_all = 0
    every = table["omega_disr"] / table["firm_bound"]
    for kind in TYPES:
        own = grown[grown["type"] == kind]
        above_of_all += int((own["printed"] > float(every[table["type"] == kind].max()) * own["firm_bound"]).sum())
        rows = of_class(table[table["type"] == kind], "large")
        over = rows["omega_disr"] / rows["firm_bound"]
        most = float(over.max())
        own = of_class(grown[grown["type"] == kind], "large")
        above += int((own["printed"] > most * own["firm_bound"]).sum())
        total += len(own)
        values |= {f"bound.{kind} large most": most, f"bound.{kind} large over": float((over > 1.0).mean())}
    values |= {"bound.large above most": above, "bound.large": total}
    return values | {"bound.all above most": above_of_all, "bound.most left": float(every.max())}


def what_contacts_hold(grown, firm, table):
    """Table 3 beside the firm bound of all grown grains, and the spun-up ones beside both bounds.

    Parameters
    ----------
    grown : pandas.DataFrame
        All grains as grown, as `beside_print` returns it.
    firm : pandas.DataFrame
        Their firm bounds.
    table : pandas.DataFrame
        The grains that were spun up, as `beside_print` returns it.
    """
    grown, table = (joined(own, firm, ["firm_bound", "firm_bound_quarter"]) for own in (grown, table))
    above = grown["printed"] > grown["firm_bound"]
    # cuts that leave less than a quarter on one side do not count here
    above_quarter = grown["printed"] > grown["firm_bound_quarter"]
    load = (grown["printed"] / grown["firm_bound"]) ** 2
    # what would bring the two nearer: stronger contacts, and the mean radius of the grains in the printed formula
    stronger = math.sqrt(4.0 / 3.0) * grown["firm_bound"]
    lower = grown["printed"] * np.sqrt(PAPER_MEAN_RADIUS / grown["mean_monomer_radius"])
    values = {
        "bound.grown": len(grown),
        "bound.above both": int((lower > stronger).sum()),
        "bound.over": float((grown["printed"] / grown["firm_bound"]).median()),
        "bound.above": int(above.sum()),
        "bound.above quarter": int(above_quarter.sum()),
        "bound.over quarter": float((grown["printed"] / grown["firm_bound_quarter"]).median()),
        "bound.largest below quarter": float(grown.loc[~above_quarter, "nm"].max()),
        "bound.largest below": float(grown.loc[~above, "nm"].max()),
        "bound.load": float(load.median()),
        "bound.small omega": float((grown["printed"] < 5e8).mean()),
        "bound.in abstract": float(grown["printed"].between(1e8, 1e9).mean()),
        "bound.least printed": float(grown["printed"].min()),
        "bound.most printed": float(grown["printed"].max()),
        "bound.spun": len(table),
    }
    held = table["omega_first_loss"] / table["firm_bound"]
    beyond = table[held > 1.0]
    gained = beyond["n_contacts_max"] > beyond["n_contacts"]
    # what is left reaches the bound, but for the steps in which omega is recorded
    reached = beyond[~gained]
    values["bound.over firm"] = len(beyond)
    values["bound.over firm gained"] = int(gained.sum())
    values["bound.at firm"] = len(reached)
    values["bound.at firm most"] = float(max(held[reached.index], default=1.0)) - 1.0
    values["bound.at firm monomers"] = int(max(reached["n_monomers"], default=0))
    farthest = float(held.max())
    values["bound.over firm most"] = farthest
    # the printed omega above what even the grain that holds longest would bear
    values["bound.above farthest"] = int((grown["printed"] > farthest * grown["firm_bound"]).sum())
    values["bound.over firm types"] = " and ".join(kind for kind in TYPES if (beyond["type"] == kind).any())
    values |= _what_is_left(grown, table)
    strength = strength_omega(table)
    for kind in TYPES:
        for name in CLASSES:
            rows = of_class(table[table["type"] == kind], name)
            start = f"bound.{kind} {name}"
            values[f"{start} load"] = median(
                load[(grown["type"] == kind) & grown["nm"].between(*CLASSES[name])].to_numpy()
            )
            for mark in ("omega_first_loss", MARK):
                values[f"{start} {mark}"] = median(rows[mark] / rows["firm_bound"], cell_of(rows))
            values[f"{start} strength"] = median(strength[rows.index] / rows[MARK], cell_of(rows))
            # Eq. 27 has a_eff and no filling factor: 2/a_eff sqrt(S/rho)
            plain = strength[rows.index] * rows["filling_factor"] ** (1.0 / 6.0)
            values[f"{start} strength by Eq. 27"] = median(plain / rows[MARK], cell_of(rows))
            values[f"{start} strength over print"] = median(strength[rows.index] / rows["printed"], cell_of(rows))
    return values
