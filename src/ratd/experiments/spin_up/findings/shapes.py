"""What the document tells of the shape of grains on their way to the break, see `ratd.experiments.spin_up.shapes`."""

import math

import numpy as np
import pandas as pd

from ratd.base.measured import Measured, median
from ratd.base.statistics import jackknife_error, mean_of
from ratd.base.units import NM
from ratd.experiments.spin_up.cells import TYPES, cell_of
from ratd.experiments.spin_up.findings.claims import BAM, all_of, is_above, is_below, is_within
from ratd.experiments.spin_up.findings.ensemble import of_class
from ratd.experiments.spin_up.shapes import LOOKS

__all__ = ["of_shapes", "of_stretch", "scatter_ratio"]

SAME = 0.1
"""A fractal dimension is steady where its mean changes by less."""
STRETCHED = 1.1
"""Axes over those at rest beyond which monomers have moved outward."""
WORDS = {
    "falls": {"yes": "falls", "no": "does not fall", "open": "may fall"},
    "keep": {"yes": "keep", "no": "do not keep", "open": "may keep"},
    "grows": {"yes": "grows", "no": "does not grow", "open": "may grow"},
    "rises": {"yes": "rises", "no": "does not rise", "open": "may rise"},
}
"""Last word of a slot -> verdict -> how the document says it."""
NUMBERS = {"dimension": ("fractal_dimension", 1.0), "porosity": ("porosity", 100.0)}
"""Word of a slot -> column, and what it is multiplied by: porosities are told in per cent."""


def of_shapes(table):
    """What a document says of it.

    Parameters
    ----------
    table : pandas.DataFrame
        Of `ratd.experiments.spin_up.shapes.read_shapes`.

    Returns
    -------
    dict
        ``shapes.grains``, ``shapes.fewest`` (grains of a type), ``shapes.size`` [nm]; for each type
        ``shapes.TYPE dimension LOOK`` and ``shapes.TYPE porosity LOOK`` (in per cent), means of those grains that have
        a value at all `LOOKS`, ``... scatter LOOK``, the standard deviations of single ones, ``... change LOOK``, means
        of the difference to the same grains at rest, and ``... scatter ratio``, the scatter at omega_disr over that at
        rest; ``shapes.TYPE left`` is the mean mass of what is left at omega_disr, over that of the grain;
        ``shapes.scatter ratio`` is the geometric mean of that of the dimension over the types. Verdicts, by two
        standard errors and in the words of `WORDS`: ``shapes.BA falls``, of the dimension of BA before the first loss;
        ``shapes.BAM keep``, whether those of BAM1 and BAM2 are within `SAME` then; ``shapes.scatter grows``;
        ``shapes.TYPE rises``, of the porosity before the first loss.
    """
    grains = table.drop_duplicates(["type", "a_eff", "seed"])
    values = {
        "shapes.grains": len(grains),
        "shapes.fewest": int(grains["type"].value_counts().min()),
        "shapes.size": round(float(grains["a_eff"].median() * 1e9)),
    }
    for kind in TYPES:
        part = table[table["type"] == kind]
        values[f"shapes.{kind} left"] = float(part.loc[part["when"] == LOOKS[-1], "mass_fraction"].mean())
        for word, (column, factor) in NUMBERS.items():
            own = part.pivot(index=["a_eff", "seed"], columns="when", values=column).reindex(columns=list(LOOKS))
            own = factor * own.dropna().to_numpy()
            name = f"shapes.{kind} {word}"
            for at, look in enumerate(LOOKS):
                values[f"{name} {look}"] = Measured(*mean_of(own[:, at]))
                values[f"{name} scatter {look}"] = float(np.std(own[:, at], ddof=1))
                values[f"{name} change {look}"] = Measured(*mean_of(own[:, at] - own[:, 0]))
            values[f"{name} scatter ratio"] = scatter_ratio(own[:, -1], own[:, 0])
    rise = {kind: values[f"shapes.{kind} porosity change {LOOKS[1]}"] for kind in TYPES}
    change = {kind: values[f"shapes.{kind} dimension change {LOOKS[1]}"] for kind in TYPES}
    values["shapes.scatter ratio"] = _together([values[f"shapes.{kind} dimension scatter ratio"] for kind in TYPES])
    verdicts = {
        "BA falls": is_below(change["BA"], 0.0),
        "BAM keep": all_of(is_within(change[kind], -SAME, SAME) for kind in BAM),
        "scatter grows": is_above(values["shapes.scatter ratio"], 1.0),
        **{f"{kind} rises": is_above(rise[kind], 0.0) for kind in TYPES},
    }
    return values | {f"shapes.{name}": WORDS[name.split()[-1]][verdict] for name, verdict in verdicts.items()}


def of_stretch(letter, files):
    """How far large grains have stretched before anything leaves: longest over shortest axis, over the same at rest.

    Parameters
    ----------
    letter : str
        The first letter of the names.
    files : list of xarray.Dataset
        Of the queue of spin-ups, one drive.

    Returns
    -------
    dict
        ``d.stretch TYPE``, medians of the grains of class ``large``, and ``d.holds stretch TYPE``, whether they are
        beyond `STRETCHED`.
    """
    tables = [
        pd.DataFrame({
            "nm": file["a_eff"].values / NM,
            "stretch": file["axis_ratio_first_loss"] * file["axis_a_start"] / file["axis_c_start"],
            "a_eff": file["a_eff"].values,
        }).assign(type=file.attrs["type"], material=file.attrs["material"])
        for file in files
    ]  # fmt: skip
    table = of_class(pd.concat(tables, ignore_index=True), "large")
    values = {}
    for kind, rows in table.groupby("type"):
        found = values[f"{letter}.stretch {kind}"] = median(rows["stretch"], cell_of(rows))
        values[f"{letter}.holds stretch {kind}"] = is_above(found, STRETCHED)
    return values


def _together(ratios):
    """Geometric mean of independent ratios, `Measured` each."""
    mean = math.exp(sum(math.log(ratio.value) for ratio in ratios) / len(ratios))
    return Measured(mean, mean * math.hypot(*(ratio.error / ratio.value for ratio in ratios)) / len(ratios))


def scatter_ratio(one, other):
    """Standard deviation of some values over that of others of the same grains, `Measured`, (n,) each."""

    def ratio(kept):
        return np.std(one[kept], ddof=1) / np.std(other[kept], ddof=1)

    everyone = np.arange(len(one))
    left_out = [ratio(everyone != k) for k in everyone]
    return Measured(float(ratio(everyone >= 0)), jackknife_error(left_out))
