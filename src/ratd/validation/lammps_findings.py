"""What docs/validation.md tells of LAMMPS: slots, table and figure, from the table of that check alone."""

import numpy as np
import pandas as pd

from ratd.base.measured import median
from ratd.experiments.spin_up.cells import GRAIN
from ratd.experiments.spin_up.figures.style import TYPE_MARKER
from ratd.experiments.spin_up.findings.beside import NEAR_LAMMPS
from ratd.pictures.style import GREY, TWO_COLUMNS, TYPE_COLOUR, new_figure, styled
from ratd.validation.lammps import COMPARISONS, ELASTIC_ROLLING, MARKS, TURNING, threshold

__all__ = ["SHORT", "beside", "of_each", "of_lammps", "thresholds"]

FORCE = 1e-9
"""Difference of the normal forces over F_C."""
SHORT = {"first loss": "first", "25 % of the mass": "quarter"}
"""Mark of `MARKS` -> as it stands in a slot."""
WAYS = {
    ("rotation", "sudden", "LAMMPS"): "sudden",
    ("rotation", "sudden", TURNING): "sudden turning",
    ("rotation", "driven", TURNING): "driven",
    (ELASTIC_ROLLING, "driven", TURNING): "elastic",
}
"""Study, start and code -> the word of its slots."""
SHOWN = {
    "sudden": "at once",
    "sudden turning": "at once,\nturning\nframe",
    "driven": "driven",
    "elastic": "driven,\nrolling\nunlimited",
    "default": "driven\nover\ndefault",
}
"""Way, or "default" for driven in LAMMPS over the spin-up of production in ratd -> its label."""
assert set(COMPARISONS) == {way[1:] for way in WAYS}


def thresholds(table):
    """omega at which each grain comes apart in ratd and in LAMMPS, a row a grain, way and mark.

    Parameters
    ----------
    table : pandas.DataFrame
        Of `ratd.validation.lammps`.

    Returns
    -------
    pandas.DataFrame
        way, the columns of a grain, mark, cut_bound, ratd and lammps, the geometric means of the omega between which
        the grain comes apart [rad/s], NaN where there is no such pair, and ``ratio``, LAMMPS over ratd.
    """
    rows = []
    grains = table[table["study"] != "force"]
    for key, part in grains.groupby(["study", "path", *GRAIN]):
        study, path, *grain = key
        own = part[part["code"] == "ratd"]
        for code, other in part[part["code"] != "ratd"].groupby("code"):
            for mark, limit in MARKS.items():
                ours, theirs = (
                    float(np.sqrt(np.prod(threshold(each["omega"], each["mass_left"], limit)))) for each in (own, other)
                )
                rows.append(
                    {"way": WAYS[study, path, code], **dict(zip(GRAIN, grain, strict=True)), "mark": mark}
                    | {"cut_bound": part["cut_bound"].iloc[0], "ratd": ours, "lammps": theirs, "ratio": theirs / ours}
                )
    return pd.DataFrame(rows)


def of_lammps(table):
    """Slots of the check against LAMMPS: ``lammps.WAY MARK ...`` for the ways of `WAYS`, and forces.

    ``lammps.farthest``: by how many times the two codes differ in single grains at most, of all ways and marks.

    Parameters
    ----------
    table : pandas.DataFrame

    Returns
    -------
    dict
    """
    force = table[table["study"] == "force"]
    key = ["material", "radius_1", "radius_2"]
    ours, theirs = (force[force["code"] == code].reset_index(drop=True) for code in ("ratd", "LAMMPS"))
    both = np.isfinite(ours["normal_force"]) & np.isfinite(theirs["normal_force"])
    difference = ((ours["normal_force"] - theirs["normal_force"]).abs() / ours["pull_off_force"])[both].max()
    values = {
        "lammps.version": force["version"].iloc[0],
        "lammps.pairs": len(ours.groupby(key)),
        "lammps.force": difference,
        "lammps.force verdict": "met" if difference < FORCE else "missed",
    }
    found = thresholds(table)
    values["lammps.grains"] = len(found.groupby(GRAIN))
    values["lammps.farthest"] = np.exp(np.abs(np.log(found["ratio"])).max())
    monomers = table.loc[table["study"] != "force", "n_monomers"]
    values["lammps.fewest"], values["lammps.most"] = int(monomers.min()), int(monomers.max())
    for (way, mark), part in found.groupby(["way", "mark"]):
        name = f"lammps.{way} {SHORT[mark]}"
        ratio = part["ratio"].dropna()
        values |= {name: median(ratio)} | of_each(name, ratio)
    return values


def of_each(name, ratio):
    """Slots on the single grains of a way and mark: ``NAME least``, ``most``, ``known``, ``within`` and ``verdict``."""
    within = int((np.abs(ratio - 1.0) <= NEAR_LAMMPS).sum())
    return {
        f"{name} least": ratio.min(),
        f"{name} most": ratio.max(),
        f"{name} known": len(ratio),
        f"{name} within": within,
        f"{name} verdict": "met" if within == len(ratio) else "missed",
    }


@styled
def beside(table, default):
    """Figure: LAMMPS over ratd, a sign a grain, for each way and both marks.

    Parameters
    ----------
    table : pandas.DataFrame
        Of `ratd.validation.lammps`.
    default : pandas.DataFrame
        The grains beside the spin-up of production, of `ratd.validation.lammps_spin_up.one_each`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    found = pd.concat([thresholds(table), default])
    figure = new_figure(
        TWO_COLUMNS, 0.4 * TWO_COLUMNS, "Angular velocity at which a grain comes apart: LAMMPS over ratd"
    )
    panels = figure.subplots(1, 2, sharey=True)
    for axes, (mark, title) in zip(
        panels, zip(MARKS, ("first loss of mass", "a quarter lost"), strict=True), strict=True
    ):
        axes.axhspan(1 - NEAR_LAMMPS, 1 + NEAR_LAMMPS, color="0.92", zorder=0)
        axes.axhline(1.0, color=GREY, linewidth=0.6, zorder=1)
        for place, way in enumerate(SHOWN):
            own = found[(found["way"] == way) & (found["mark"] == mark)]
            for shift, kind in zip((-0.22, 0.0, 0.22), TYPE_COLOUR, strict=True):
                part = np.sort(own.loc[own["type"] == kind, "ratio"].dropna())
                x = place + shift + 0.05 * np.sin(2.4 * np.arange(len(part)))
                axes.plot(
                    x, part, TYPE_MARKER[kind], color=TYPE_COLOUR[kind], linestyle="none", alpha=0.8,
                    label=kind if place == 0 else None,
                )  # fmt: skip
        axes.set_xticks(range(len(SHOWN)), list(SHOWN.values()))
        axes.tick_params(axis="x", length=0)
        axes.set_title(title)
    panels[0].set_ylabel("$\\omega$ in LAMMPS over $\\omega$ in ratd")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure
