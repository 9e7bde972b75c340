"""Figures of the document that the paper does not have."""

import numpy as np
from matplotlib.lines import Line2D

from ratd.ensemble import size_key
from ratd.figures.style import (
    GREY,
    TWO_COLUMNS,
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
from ratd.reproduction.bounds import ratios

DRIVE_LOOK = {
    "prescribed": {"color": "#0072B2", "marker": "o"},
    "literal": {"color": "#D55E00", "marker": "s"},
}
PRINTED_LOOK = {"color": "black", "marker": "D"}
STRENGTH_LOOK = {"color": GREY, "marker": "v"}


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
        Medians over all materials with the range of the middle two thirds: Eq. 33 with Table 3, the tensile strength,
        and omega_disr of each drive.
    """
    tables = {drive: ratios(table, materials) for drive, table in tables.items()}
    first = ratios(grown, materials)
    types = list(dict.fromkeys(first["type"]))
    figure = new_figure(TWO_COLUMNS, 0.5 * TWO_COLUMNS, "angular velocities over the cut bound of the same grain")
    panels = figure.subplots(1, len(types), sharex=True, sharey=True, squeeze=False)[0]
    series = [(first, "printed_over_bound", PRINTED_LOOK, "Eq. 33 with Table 3 as printed")]
    series.append((first, "strength_over_bound", STRENGTH_LOOK, "tensile strength, Tatsuuma et al. 2019"))
    series += [
        (table, "found_over_bound", DRIVE_LOOK.get(drive, {}), rf"$\omega_\mathrm{{disr}}$, drive: {drive}")
        for drive, table in tables.items()
    ]
    for axes, kind in zip(panels, types, strict=True):
        axes.set_title(kind)
        axes.set_yscale("log")
        axes.set_xlabel(sizes_label())
        axes.axhline(1.0, color="black", lw=0.6, ls="--")
        for table, column, look, _ in series:
            _medians(axes, table[table["type"] == kind], column, look)
    panels[0].set_xlim(*nanometres(size_limits(first["a_eff"])))
    logarithmic(panels[0].yaxis)
    panels[0].set_ylabel(r"$\omega$ over the cut bound")
    handles = [Line2D([], [], label=text, lw=0.8, ms=3.5, **look) for *_, look, text in series]
    handles.append(Line2D([], [], color="black", lw=0.6, ls="--", label="cut bound"))
    figure.legend(handles=handles, loc="outside lower center", ncols=3)
    return figure


def _medians(axes, table, column, look):
    """Medians of the sizes as a line, 16 % to 84 % as bars."""
    table = table[np.isfinite(table[column])]
    if not len(table):
        return
    groups = table.groupby(size_key(table["a_eff"]))[column]
    x = groups.median().index.to_numpy() * 1e-3
    low, middle, high = (groups.quantile(q).to_numpy() for q in (0.16, 0.5, 0.84))
    axes.errorbar(x, middle, [middle - low, high - middle], lw=0.8, elinewidth=0.6, capsize=1.2, ms=3.0, **look)


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
        A solid line a type for the mass share, a dashed one for the share of the number of fragments.
    """
    figure = new_figure(TWO_COLUMNS, 0.75 * TWO_COLUMNS, "fragments that leave the largest one")
    panels = figure.subplots(len(STAGES), len(tables), sharex=True, sharey=True, squeeze=False)
    style = type_style([kind for table in tables.values() for kind in table["type"]])
    for row, (stage, text) in zip(panels, STAGES.items(), strict=True):
        for axes, (drive, table) in zip(row, tables.items(), strict=True):
            axes.set_title(f"drive: {drive}, {text}")
            chosen = table[table[stage]]
            if not len(chosen):
                empty(axes, "no fragments")
            for kind, look in style.items():
                part = chosen[chosen["type"] == kind].sort_values("mass_fraction")
                x, of_grain = part["mass_fraction"].to_numpy(), part["weight"].to_numpy()
                for weight, line in ((x * of_grain, "-"), (of_grain, "--")):
                    share = np.cumsum(weight) / weight.sum() if len(x) else x
                    axes.step(x, share, where="post", color=look["color"], ls=line, lw=1.0)
            axes.set_xscale("log")
            axes.set_ylim(0, 1.02)
    logarithmic(panels[0, 0].xaxis)
    for axes in panels[-1]:
        axes.set_xlabel("mass of the fragment over that of the grain")
    for axes in panels[:, 0]:
        axes.set_ylabel("share in smaller fragments")
    handles = [Line2D([], [], color=look["color"], label=kind) for kind, look in style.items()]
    handles += [Line2D([], [], color="black", label="of the lost mass")]
    handles += [Line2D([], [], color="black", ls="--", label="of the number")]
    figure.legend(handles=handles, loc="outside lower center", ncols=5)
    return figure
