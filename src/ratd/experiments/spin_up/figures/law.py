"""What to use where no grain is at hand: omega over size, the material only setting the unit."""

import numpy as np
import pandas as pd

from ratd.base.errors import InputError
from ratd.base.statistics import mean_of
from ratd.base.units import NM
from ratd.base.words import plural
from ratd.experiments.spin_up.cells import cell_of, size_key
from ratd.experiments.spin_up.marks import MARK
from ratd.experiments.spin_up.size_law import SPLIT, curved_law, curved_law_value, size_law, size_law_unit
from ratd.experiments.spin_up.figures.style import sizes_label, type_style
from ratd.pictures.snapshots import drive_of, drive_text
from ratd.pictures.style import ONE_COLUMN, label_ends, logarithmic, nanometres, new_figure, styled

MARK_TEXT = "where a quarter of the mass is lost"
"""What `MARK` is."""


@styled
def law(table):
    """omega of each type over size, in the unit of its material, with a curved law, and what a straight one leaves.

    Parameters
    ----------
    table : pandas.DataFrame
        One row a grain, of one drive.

    Returns
    -------
    matplotlib.figure.Figure
        Above, geometric means over the grains of a size with their standard errors, and `curved_law`. Below, a strip a
        type, the same over `size_law`, the straight power law: where that holds all stand at 1. The names tell q with
        its error.

    Raises
    ------
    InputError
        If no type has grains of three sizes.
    """
    curved, straight = (fit(table, MARK) for fit in (curved_law, size_law))
    if not len(curved):
        raise InputError("law: give grains of at least three sizes of a type")
    curved, straight = curved.set_index("type"), straight.set_index("type")
    kinds = [kind for kind in type_style(table["type"]) if kind in curved.index]
    table = table[table[MARK].astype(float) > 0]
    title = f"{plural(len(table), 'grain')}, {drive_text(drive_of(table))}\n$\\omega$ {MARK_TEXT}"
    figure = new_figure(ONE_COLUMN, (0.95 + 0.2 * len(kinds)) * ONE_COLUMN, title)
    top, *strips = figure.subplots(1 + len(kinds), 1, sharex=True, height_ratios=[4, *[1.1] * len(kinds)])
    size = np.geomspace(table["a_eff"].min(), table["a_eff"].max(), 60)
    ends = []
    for strip, (kind, look) in zip(strips, type_style(kinds).items(), strict=True):
        own = curved.loc[kind]
        line = curved_law_value(size, own["C"], own["p"], own["q"])
        found = means(table[table["type"] == kind])
        power = straight.loc[kind, ["C", "p"]].astype(float)
        parts = (
            (top, np.ones(len(found)), line),
            (
                strip,
                curved_law_value(found["a_eff"], *power),
                line / curved_law_value(size, *power),
            ),
        )
        for axes, below, curve in parts:
            middle = np.exp(found["mean"].to_numpy()) / below
            bars = middle * np.array([-np.expm1(-found["error"]), np.expm1(found["error"])])
            bars = np.nan_to_num(bars)
            axes.errorbar(nanometres(found["a_eff"]), middle, bars, ls="none", elinewidth=0.8, capsize=1.5, **look)
            axes.plot(nanometres(size), curve, color=look["color"], lw=1.0, zorder=1)
        strip.axhline(1.0, color="black", lw=0.6)
        ends.append((f"{kind}\n$q$ = {_signed(own['q'])} ± {own['q_error']:.2f}", line[-1], look["color"]))
    _axes(top, strips, size, kinds)
    label_ends(top, ends, apart=0.08)
    return figure


def _axes(top, strips, size, kinds):
    """Scales and labels; all strips have one height."""
    top.set(xscale="log", yscale="log")
    top.set_xlim(0.85 * nanometres(size[0]), 1.15 * nanometres(size[-1]))
    logarithmic(top.xaxis, labelled=(2, 5))
    logarithmic(top.yaxis, labelled=(2, 5))
    top.set_ylabel(rf"$\omega\,\sqrt{{\rho a_0^3/\gamma}}$, $a_0$ = {SPLIT / NM:.0f} nm")
    limits = [strip.get_ylim() for strip in strips]
    for strip, (kind, look) in zip(strips, type_style(kinds).items(), strict=True):
        strip.set_ylim(min(low for low, _ in limits), max(high for _, high in limits))
        strip.text(1.02, 0.5, kind, transform=strip.transAxes, va="center", color=look["color"])
    strips[len(strips) // 2].set_ylabel("over the straight power law")
    strips[-1].set_xlabel(sizes_label())


def _signed(value):
    """A number with two decimals, a true minus and no negative zero."""
    return f"{round(value, 2) + 0.0:.2f}".replace("-", "\N{MINUS SIGN}")


def means(table):
    """Mean ln omega, in units of `size_law_unit`, of each size of a table of one type, with its standard error.

    Parameters
    ----------
    table : pandas.DataFrame
        As of `law`.

    Returns
    -------
    pandas.DataFrame
        Columns a_eff, mean, error, n, a row a size; the materials count alike (`ratd.base.statistics.mean_of`).
    """
    table = table[table[MARK].astype(float) > 0]
    table = table.assign(log=np.log(table[MARK].astype(float) / size_law_unit(table)))
    rows = []
    for _, part in table.groupby(size_key(table["a_eff"])):
        mean, error = mean_of(part["log"], cell_of(part))
        rows.append({"a_eff": part["a_eff"].iloc[0], "mean": mean, "error": error, "n": len(part)})
    return pd.DataFrame(rows)
