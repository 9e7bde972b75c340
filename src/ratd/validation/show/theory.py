"""Show the angular velocity of disruption beside the cut bound and the tensile strength."""

import numpy as np

from ratd.figures.style import TWO_COLUMNS, TYPE_COLOUR, TYPE_MARKER, logarithmic, new_figure, styled
from ratd.markdown import markdown_table, measured_range, plural
from ratd.statistics import median_of
from ratd.validation.theory import MARKS

ESTIMATES = {"cut_bound": "cut bound [rad s$^{-1}$]", "midplane": "mean tension = Tatsuuma 2019 [rad s$^{-1}$]"}


@styled
def draw(table):
    """omega_disr of each grain against both estimates, with the line of equality and its halves and doubles.

    Parameters
    ----------
    table : pandas.DataFrame
        Columns of `ratd.validation.theory.COLUMNS`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = new_figure(
        TWO_COLUMNS, 0.5 * TWO_COLUMNS, f"{plural(len(table), 'grain')}, thresholds against theory (drive: prescribed)"
    )
    for axes, (name, label) in zip(figure.subplots(1, 2, sharey=True), ESTIMATES.items(), strict=True):
        for kind, part in table.groupby("type"):
            look = dict(color=TYPE_COLOUR.get(kind, "black"), marker=TYPE_MARKER.get(kind, "o"), ls="none")
            axes.plot(part[name], part["omega_disr"], label=f"{kind}, stress peak", **look)
            axes.plot(part[name], part["omega_first_loss"], label=f"{kind}, first loss", mfc="white", mew=0.6, **look)
        ends = np.array([np.nanmin(table[name]), np.nanmax(table[name])]) * [0.7, 1.4]
        axes.plot(ends, ends, color="black", lw=0.8)
        for factor in (0.5, 2.0):
            axes.plot(ends, factor * ends, color="black", lw=0.5, ls=":")
        axes.set_xscale("log")
        axes.set_yscale("log")
        logarithmic(axes.xaxis)
        logarithmic(axes.yaxis)
        axes.set_xlabel(label)
    figure.axes[0].set_ylabel(r"$\omega$ of the mark [rad s$^{-1}$]")
    figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure


def tell(table):
    """The section of the report, Markdown."""
    rows = []
    for kind, part in table.groupby("type"):
        cells = [kind, len(part)]
        for name in ESTIMATES:
            for mark in MARKS:
                s = median_of(part[mark] / part[name])
                cells.append(measured_range(s))
        rows.append(cells)
    header = ["type", "grains"] + [f"{mark}/{name}" for name in ESTIMATES for mark in MARKS]
    both = np.log(table[["omega_disr", "cut_bound", "midplane"]]).dropna()
    correlation = both.corr()["omega_disr"]
    return "\n\n".join(
        [
            "## Theory",
            f"{plural(len(table), 'grain')} of "
            + ", ".join(f"{a * 1e9:.0f}" for a in sorted(set(np.round(table["a_eff"], 12))))
            + " nm at the epsilon of production, against two estimates that need no simulation: the bound from the "
            "weakest cut through the contacts (exact for the trees of BA as they stand if contacts only pull; a grain "
            "that stretches is farther from the axis and parts below it, one that makes new contacts may part above "
            "it), and the angular velocity at which the mean tension at the mid-plane of a sphere equals the tensile "
            "strength of Tatsuuma (2019). Given are medians over the grains with their standard error and, in "
            "brackets, the range of 68 % of the grains. The bound is that of the whole grain: the first loss of mass "
            "is to be set beside it, while omega_disr and the loss of a quarter belong to what is left, which may hold "
            "more.",
            markdown_table(header, rows),
            f"Correlation of ln omega_disr with ln of the cut bound {correlation['cut_bound']:.2f}, of the tensile "
            f"strength {correlation['midplane']:.2f}.",
        ]
    )
