"""Show where the work of the outer torque goes."""

import numpy as np

from ratd.figures.style import TWO_COLUMNS, logarithmic, new_figure, styled
from ratd.markdown import markdown_table
from ratd.validation.energy import MODES

COLOURS = ("#D55E00", "#009E73", "#CC79A7", "#0072B2", "#E69F00")


def gap(table):
    """Work that is neither stored nor dissipated [J], a value a record."""
    dissipated = sum(table[f"dissipated_{mode}"] for mode in MODES)
    return table["work"] - table["kinetic"] - table["potential"] - dissipated


@styled
def draw(table):
    """Energies over the work of the torque against omega up to the first loss, a panel per growth.

    Parameters
    ----------
    table : pandas.DataFrame
        Columns of `ratd.validation.energy.COLUMNS`; of each growth the first grain is drawn.

    Returns
    -------
    matplotlib.figure.Figure
    """
    kinds = list(dict.fromkeys(table["type"]))
    figure = new_figure(TWO_COLUMNS, 0.42 * TWO_COLUMNS, "where the work of the torque goes (drive: prescribed)")
    panels = np.atleast_1d(figure.subplots(1, len(kinds), sharey=True))
    for axes, kind in zip(panels, kinds, strict=True):
        part = table[table["type"] == kind]
        part = part[(part["seed"] == part["seed"].min()) & (part["omega"] > 0.03 * part["first_loss"])]
        x = part["omega"] / part["first_loss"]
        axes.plot(x, part["kinetic"] / part["work"], color="black", label="kinetic")
        axes.plot(x, np.abs(part["potential"]) / part["work"], color="black", ls=":", label="|potential|")
        for mode, colour in zip(MODES, COLOURS, strict=True):
            axes.plot(x, part[f"dissipated_{mode}"] / part["work"], color=colour, label=mode)
        axes.plot(x, np.abs(gap(part)) / part["work"], color="black", ls="--", lw=0.7, label="|not accounted for|")
        axes.set_yscale("log")
        axes.set_ylim(1e-8, 2.0)
        logarithmic(axes.yaxis)
        axes.set_title(f"{kind} {part['a_eff'].iloc[0] * 1e9:.0f} nm")
        axes.set_xlabel(r"$\omega$ over that of the first loss")
    panels[0].set_ylabel("share of the work of the torque")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
    return figure


def tell(table):
    """The section of the report, Markdown."""
    rows = []
    for (kind, a_eff, seed), part in table.groupby(["type", "a_eff", "seed"]):
        last = part.iloc[-1]
        work, left = last["work"], gap(part).abs()
        dissipated = sum(last[f"dissipated_{mode}"] for mode in MODES)
        shares = [f"{last[f'dissipated_{mode}'] / work:.1e}" for mode in MODES]
        rows.append(
            [kind, f"{a_eff * 1e9:.0f}", f"{seed:.0f}", f"{last['kinetic'] / work:.4f}", *shares,
             f"{100 * left.iloc[-1] / work:.2g} %", f"{100 * left.iloc[-1] / dissipated:.2g} %"]
        )  # fmt: skip
    header = [
        "type",
        "size [nm]",
        "seed",
        "kinetic/work",
        *(f"{mode}/work" for mode in MODES),
        "gap/work",
        "gap/dissipated",
    ]
    return "\n\n".join(
        [
            "## Energy",
            "Work of the outer torque = kinetic + potential + dissipated energy, up to the first loss of mass, at the "
            f"epsilon of production and f = {table['timestep_factor'].iloc[0]:g}. The gap is what is left over in the "
            "last record before the loss. Kinetic energies are those of velocities half a step old, which is part of "
            "the gap; another part is that a spring which slips or rolls on by D in a step is counted to lose k D²/2 "
            "more than the force does that acted, of first order in the step.",
            markdown_table(header, rows),
        ]
    )
