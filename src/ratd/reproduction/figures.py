"""Figures of the document that the paper does not have."""

import numpy as np
import pandas as pd
from matplotlib.lines import Line2D

from ratd.ensemble import cell_of, size_key
from ratd.figures.style import (
    GREY,
    TWO_COLUMNS,
    bar_lengths,
    empty,
    logarithmic,
    nanometres,
    new_figure,
    size_limits,
    sizes_label,
    styled,
    type_style,
)
from ratd.fragmentation import STAGES
from ratd.reproduction.bounds import ratios, table3_omega
from ratd.statistics import median_of, quantiles

# not the colours of the types
DRIVE_LOOK = {
    "prescribed": {"color": "#CC79A7", "marker": "o"},
    "literal": {"color": "#56B4E9", "marker": "s"},
}
PRINTED_LOOK = {"color": "black", "marker": "D"}
FIRM_LOOK = {"color": "black", "marker": "^", "mfc": "white", "mew": 0.7}
STRENGTH_LOOK = {"color": GREY, "marker": "v"}
SHARES = {
    "the lost mass": {"lw": 1.3, "ms": 3.5},
    "the number": {"lw": 0.7, "ls": (0, (4, 2)), "ms": 3.5, "mfc": "white", "mew": 0.7},
}
"""What a share is of, and its line."""
LEAST = 0.02
"""Part of all fragments that are smaller than what the axis begins with."""
OMEGA_DISR = r"$\omega_\mathrm{disr}$"


@styled
def overview(grown, tables, materials=None):
    """Angular velocities over those of the paper for the same grain against size, a panel a type.

    Parameters
    ----------
    grown : pandas.DataFrame
        The grown grains, for what needs no spin-up.
    tables : dict of str to pandas.DataFrame
        Drive -> its grains.
    materials : optional
        Table of materials, handed to `ratd.materials.get_material`.

    Returns
    -------
    matplotlib.figure.Figure
        Medians as in `bound`, over Eq. 33 with Table 3: omega_disr of each drive, and the firm bound where it is known.
    """
    series = _of_drives(tables, materials, "found_over_printed")
    firm = grown.get("firm_bound", np.nan) / table3_omega(grown, materials)
    series += _where_known(grown.assign(firm_over_printed=firm), "firm_over_printed", FIRM_LOOK, "firm bound")
    title = "angular velocities over those of the paper, for the same grain"
    return _against_size(
        series, title, r"$\omega$ over Eq. 33 with Table 3", "the paper: Eq. 33 with Table 3 as printed"
    )


@styled
def bound(grown, tables, materials=None):
    """Angular velocities over the cut bound of the same grain against size, a panel a type.

    Parameters
    ----------
    grown : pandas.DataFrame
        The grown grains, for what needs no spin-up.
    tables : dict of str to pandas.DataFrame
        Drive -> its grains.
    materials : optional
        Table of materials, handed to `ratd.materials.get_material`.

    Returns
    -------
    matplotlib.figure.Figure
        Medians over all materials, each with the same weight, with the range of 68 %: Eq. 33 with Table 3, the tensile
        strength, the firm bound where it is known, and omega_disr of each drive.
    """
    first = ratios(grown, materials).assign(firm_over_bound=grown.get("firm_bound", np.nan) / grown["cut_bound"])
    series = [(first, "printed_over_bound", PRINTED_LOOK, "Eq. 33 with Table 3 as printed")]
    series.append((first, "strength_over_bound", STRENGTH_LOOK, "tensile strength, Tatsuuma et al. 2019"))
    series += _where_known(first, "firm_over_bound", FIRM_LOOK, "firm bound")
    series += _of_drives(tables, materials, "found_over_bound")
    title = "angular velocities over the cut bound of the same grain"
    return _against_size(series, title, r"$\omega$ over the cut bound", "cut bound")


def _of_drives(tables, materials, column):
    """A series a drive, of a column of `ratd.reproduction.bounds.ratios`; see `_against_size`."""
    return [
        (ratios(table, materials), column, DRIVE_LOOK.get(drive, {}), rf"$\omega_\mathrm{{disr}}$, drive: {drive}")
        for drive, table in tables.items()
    ]


def _where_known(table, column, look, text):
    """The series, in a list, or none where no grain has a value."""
    return [(table, column, look, text)] if table[column].notna().any() else []


def _against_size(series, title, label, one):
    """Ratios against size, a panel a type.

    Parameters
    ----------
    series : list of (pandas.DataFrame, str, dict, str)
        Grains, the column that is drawn, its look and its name.
    title, label : str
        Of the figure and of the ratios.
    one : str
        Name of the line at 1, what the ratios are over.

    Returns
    -------
    matplotlib.figure.Figure
    """
    every = pd.concat([table[["type", "a_eff"]] for table, *_ in series])
    types = list(dict.fromkeys(every["type"]))
    figure = new_figure(TWO_COLUMNS, 0.5 * TWO_COLUMNS, title)
    panels = figure.subplots(1, len(types), sharex=True, sharey=True, squeeze=False)[0]
    for axes, kind in zip(panels, types, strict=True):
        axes.set_title(kind)
        axes.set_yscale("log")
        axes.set_xlabel(sizes_label())
        axes.axhline(1.0, color="black", lw=0.6, ls="--")
        for table, column, look, _ in series:
            _medians(axes, table[table["type"] == kind], column, look)
    panels[0].set_xlim(*nanometres(size_limits(every["a_eff"])))
    logarithmic(panels[0].yaxis)
    panels[0].set_ylabel(label)
    handles = [Line2D([], [], label=text, lw=0.8, ms=3.5, **look) for *_, look, text in series]
    handles.append(Line2D([], [], color="black", lw=0.6, ls="--", label=one))
    figure.legend(handles=handles, loc="outside lower center", ncols=3)
    return figure


def _medians(axes, table, column, look):
    """Medians of the sizes as a line, 16 % to 84 % as bars; the materials of a size have the same weight."""
    table = table[np.isfinite(table[column])]
    if not len(table):
        return
    found = {
        size * 1e-3: median_of(part[column], cell=cell_of(part))
        for size, part in table.groupby(size_key(table["a_eff"]))
    }
    middle, low, high = np.array([[one[name] for name in ("median", "low", "high")] for one in found.values()]).T
    bars = bar_lengths(middle, low, high)
    axes.errorbar(list(found), middle, bars, lw=0.8, elinewidth=0.6, capsize=1.2, ms=3.0, **look)


@styled
def fragments(tables):
    """Share of the lost mass in fragments up to a size, against that size, a row a stage and a column a drive.

    Parameters
    ----------
    tables : dict of str to pandas.DataFrame
        Drive -> what `ratd.fragmentation.fragment_table` returns.

    Returns
    -------
    matplotlib.figure.Figure
        A thick line with filled markers a type for the mass share, a thin dashed one with open markers for the share of
        the number of fragments. The axis leaves out the smallest fragments, see `LEAST`.
    """
    figure = new_figure(TWO_COLUMNS, 0.75 * TWO_COLUMNS, "fragments that leave the largest one")
    panels = figure.subplots(len(STAGES), len(tables), sharex=True, sharey=True, squeeze=False)
    style = type_style([kind for table in tables.values() for kind in table["type"]])
    for row, (stage, text) in zip(panels, STAGES.items(), strict=True):
        for axes, (drive, table) in zip(row, tables.items(), strict=True):
            axes.set_title(f"drive: {drive}, {text.replace('omega_disr', OMEGA_DISR)}")
            _shares(axes, table[table[stage]], style)
    every = pd.concat(list(tables.values()))
    mass = every["mass_fraction"]
    panels[0, 0].set(xscale="log", ylim=(0, 1.02))
    if len(every):
        panels[0, 0].set_xlim(quantiles(mass, LEAST, every["weight"]) / 1.3, 1.3 * mass.max())
    logarithmic(panels[0, 0].xaxis)
    for axes in panels[-1]:
        axes.set_xlabel("mass of the fragment over that of the grain")
    for axes in panels[:, 0]:
        axes.set_ylabel("share in smaller fragments")
    handles = [Line2D([], [], ls="none", label=kind, **look) for kind, look in style.items()]
    handles += [
        Line2D([], [], color="black", marker="D", label=f"share of {what}", **look) for what, look in SHARES.items()
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=5)
    return figure


def _shares(axes, table, style):
    """Mass and number of the fragments up to a size over those of all, a line a type and share."""
    if not len(table):
        empty(axes, "no fragments")
    for kind, look in style.items():
        part = table[table["type"] == kind].sort_values("mass_fraction")
        x, of_grain = part["mass_fraction"].to_numpy(), part["weight"].to_numpy()
        for weight, share in zip((x * of_grain, of_grain), SHARES.values(), strict=True):
            y = np.cumsum(weight) / weight.sum() if len(x) else x
            axes.step(x, y, where="post", markevery=0.12, **look | share)
