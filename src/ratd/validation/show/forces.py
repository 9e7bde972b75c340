"""Show how far forces are from the derivatives of their potentials, and how well momenta are kept."""

import numpy as np

from ratd.figures.style import GREY, TWO_COLUMNS, TYPE_COLOUR, logarithmic, new_figure, styled
from ratd.markdown import markdown_table
from ratd.validation.forces import DISSIPATION, MODES

COLOURS = {"normal": "#000000", "sliding": "#D55E00", "rolling": "#009E73", "twisting": "#CC79A7"}
FORCE_GOAL, MOMENTUM_GOAL = 1e-6, 1e-10
LEAST = 1e-17
"""Deviations of exactly zero are drawn here."""


def modes_of(table):
    """Rows of the derivatives, with the ratio of the radii."""
    part = table[table["study"] == "derivative"]
    radii = part[["radius_i", "radius_j"]]
    return part.assign(ratio=radii.max(axis=1) / radii.min(axis=1))


@styled
def draw(table):
    """Deviations of forces and torques against the ratio of radii, and drift of the momenta over the steps.

    Parameters
    ----------
    table : pandas.DataFrame
        Columns of `ratd.validation.forces.COLUMNS`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = new_figure(TWO_COLUMNS, 0.46 * TWO_COLUMNS, "forces of the contacts, and free grains (no drive)")
    left, right = figure.subplots(1, 2)
    for mode, part in modes_of(table).groupby("mode", sort=False):
        for column, marker in (("force", "."), ("torque", "x")):
            if part[column].notna().any():
                left.plot(
                    part["ratio"], np.maximum(part[column], LEAST), marker, ms=3, mew=0.7, color=COLOURS[mode],
                    label=f"{column}, {mode}",
                )  # fmt: skip
    left.axhline(FORCE_GOAL, color=GREY, lw=0.8, ls="--")
    left.set_xscale("log")
    logarithmic(left.xaxis)
    left.set_xlabel("ratio of the radii")
    left.set_ylabel("deviation from the derivative, relative")
    for (_, kind), part in table[table["study"] == "momenta"].groupby(["material", "type"], sort=False):
        for column, style in (("linear", ":"), ("angular", "-")):
            right.plot(part["step"], np.maximum(part[column], LEAST), ls=style, color=TYPE_COLOUR.get(kind, "black"))
    for kind in dict.fromkeys(table["type"][table["study"] == "momenta"]):
        right.plot([], [], color=TYPE_COLOUR.get(kind, "black"), label=f"{kind}, angular momentum")
    right.plot([], [], color="black", ls=":", label="momentum")
    right.axhline(MOMENTUM_GOAL, color=GREY, lw=0.8, ls="--", label="asked for")
    right.set_xscale("log")
    logarithmic(right.xaxis)
    right.set_xlabel("step")
    right.set_ylabel("relative change")
    for axes in (left, right):
        axes.set_yscale("log")
        logarithmic(axes.yaxis)
    handles, labels = (
        a + b for a, b in zip(*(axes.get_legend_handles_labels() for axes in (left, right)), strict=True)
    )
    figure.legend(handles, labels, loc="outside lower center", ncols=4)
    return figure


def tell(table):
    """The section of the report, Markdown."""
    own = modes_of(table)
    rows = []
    for (material, mode), part in own.groupby(["material", "mode"], sort=False):
        cells = [f"{part[c].max():.1e}" if part[c].notna().any() else "none" for c in ("force", "torque")]
        rows.append([material, mode, str(len(part)), *cells, f"{part['reaction'].max():.1e}"])
    worst = np.nanmax(own[["force", "torque"]])
    drift = []
    for (material, kind), part in table[table["study"] == "momenta"].groupby(["material", "type"], sort=False):
        last = part.iloc[-1]
        shares = ", ".join(f"{last[f'dissipated_{mode}']:.1e}" for mode in DISSIPATION)
        drift.append(
            [
                material,
                kind,
                f"{last['step']:.0f}",
                f"{part['linear'].max():.1e}",
                f"{part['angular'].max():.1e}",
                shares,
            ]
        )
    return "\n\n".join(
        [
            "## Forces and momenta",
            f"Random contacts: ratio of radii 1–{own['ratio'].max():.0f}, compression "
            f"{own['compression'].min():.1f}–{own['compression'].max():.1f} delta_0, pointers tilted and twisted at "
            "random, one mode acting at a time. Forces and torques on both monomers, as the engine's step gives them, "
            "against the numerical derivative (error of fourth order) of the potential of that mode in all twelve "
            "coordinates, each over the greatest component. `reaction` is what is left of the sum of both forces, and "
            "of both torques and the moment of the forces. Given is the worst of all contacts.",
            markdown_table(["material", "mode", "contacts", "force", "torque", "reaction"], rows),
            f"The worst is {worst:.1e} ({FORCE_GOAL:g} is asked for; modes are {', '.join(MODES)}).",
            "Momenta of free grains, shaken so that damping and all inelastic limits dissipate: greatest change at any "
            "time, of the momentum over the sum of the magnitudes of its parts, of the angular momentum over its "
            f"magnitude ({MOMENTUM_GOAL:g} is asked for).",
            markdown_table(
                [
                    "material",
                    "type",
                    "steps",
                    "momentum",
                    "angular momentum",
                    f"dissipated by {', '.join(DISSIPATION)} [J]",
                ],
                drift,
            ),
        ]
    )
