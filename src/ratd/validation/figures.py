"""The figures of docs/validation.md, but for that of LAMMPS; each is drawn from the table of a check."""

import numpy as np

from ratd.base.statistics import median_of
from ratd.experiments.spin_up.cells import TYPES
from ratd.experiments.spin_up.figures.figure10 import LOOK
from ratd.experiments.spin_up.figures.style import TYPE_MARKER
from ratd.experiments.spin_up.printed import VISCOUS_EFFECT
from ratd.pictures.style import GREY, HIGHLIGHT, ONE_COLUMN, TWO_COLUMNS, TYPE_COLOUR, logarithmic, new_figure, styled
from ratd.validation.damping import RATE, WAITING
from ratd.validation.findings import off_the_answer, ratios, runs_of_solid_grains

__all__ = ["apart", "bounds", "late_coriolis", "steps", "viscous_time"]

STARTS = {
    "damped": ("not waiting, damped", LOOK["damped"]),
    "undamped": ("not waiting, undamped", LOOK["undamped"]),
    "waiting": ("waiting (the default)", {"color": "black", "marker": "x"}),
}
"""How a pair is spun up -> its name, and how it looks: as in figure 10 of the reproduction where that has it."""


def _spread(count, width):
    """Shifts that keep signs of one column apart."""
    return width * np.sin(2.4 * np.arange(count))


@styled
def apart(table):
    """Figure: pairs of monomers that part, how far from the exact answer."""
    pairs = off_the_answer(table)
    figure = new_figure(TWO_COLUMNS, 0.42 * TWO_COLUMNS, "Two monomers that are spun up until they part")
    panels = figure.subplots(1, 2, sharey=True)
    for start, (label, look) in STARTS.items():
        part = pairs[pairs["start"] == start]
        same = part[part["radius_1"] == part["radius_2"]]
        other = part.drop(same.index)
        style = look | {"linestyle": "none", "ms": 3.0, "mew": 0.7}
        panels[0].plot(same["radius_1"] * 1e9, 100 * same["off"], label=label, **style)
        panels[1].plot(other["radius_2"] / other["radius_1"], 100 * other["off"], **style)
    panels[0].set_ylabel("$\\omega$ over the exact answer, less 1 [%]")
    panels[0].set_xlabel("radius of both [nm]")
    panels[1].set_xlabel("ratio of the radii")
    for axes, title in zip(panels, ("equal", "unequal"), strict=True):
        axes.axhline(0.0, color=GREY, linewidth=0.6, zorder=0)
        axes.set_title(title)
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure


@styled
def steps(energy, frames):
    """Figure: error of the energy and distance between two frames against the step, medians and all grains."""
    figure = new_figure(TWO_COLUMNS, 0.42 * TWO_COLUMNS, "Free grains of 100 nm, by the length of the step")
    panels = figure.subplots(1, 2)
    shown = (
        (energy, "error", "error of the energy over kinetic energy"),
        (frames, "distance", "distance over mean radius"),
    )
    for axes, (table, column, label) in zip(panels, shown, strict=True):
        worst = table[column].abs().groupby([table["type"], table["seed"], table["timestep_factor"]]).max()
        every = worst.groupby("timestep_factor")
        f = every.min().index.to_numpy(float)
        axes.fill_between(f, every.min(), every.max(), color="0.88", linewidth=0, label="all grains")
        for kind in TYPES:
            grains = worst[kind].groupby("timestep_factor").median()
            axes.plot(f, grains, TYPE_MARKER[kind] + "-", color=TYPE_COLOUR[kind], label=kind)
        axes.plot(f, 0.4 * every.min().iloc[0] * (f / f[0]) ** 2, ":", color="black", label="goes with $f^2$")
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_xlabel("step factor $f$")
        axes.set_ylabel(label)
    logarithmic(panels[0].xaxis)
    logarithmic(panels[1].xaxis)
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=5)
    return figure


@styled
def bounds(table):
    """Figure: omega of the first loss of whole grains over bounds that need no simulation."""
    figure = new_figure(
        TWO_COLUMNS, 0.4 * TWO_COLUMNS, "First loss of mass (q-S, 75 to 200 nm) over bounds without a simulation"
    )
    axes = figure.subplots()
    shown = {
        "cut_bound": "cut bound,\nas grown",
        "firm_bound": "firm bound,\nas grown",
        "firm_bound_at_loss": "firm bound, shape\njust before the loss",
        "static_limit_at_loss": "static limit, shape\njust before the loss",
    }
    for place, column in enumerate(shown):
        for shift, kind in zip((-0.25, 0.0, 0.25), TYPES, strict=True):
            part = np.sort((table["omega_first_loss"] / table[column])[table["type"] == kind])
            x = place + shift + _spread(len(part), 0.07)
            axes.plot(
                x, part, TYPE_MARKER[kind], color=TYPE_COLOUR[kind], linestyle="none", alpha=0.7,
                label=kind if place == 0 else None,
            )  # fmt: skip
            axes.plot(place + shift + np.array([-0.1, 0.1]), 2 * [np.median(part)], color="black", linewidth=1.2)
    axes.axhline(1.0, color=GREY, linewidth=0.6, zorder=0)
    axes.set_xticks(range(len(shown)), list(shown.values()))
    axes.tick_params(axis="x", length=0)
    axes.set_ylim(0.0, None)
    axes.set_ylabel("$\\omega$ of the first loss over the bound")
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure


@styled
def viscous_time(table):
    """Figure: what a longer viscous time does, by the rate of the spin-up."""
    figure = new_figure(ONE_COLUMN, 0.95 * ONE_COLUMN, "Viscous time of 9 ps in place of 5 ps (a-C, 100 nm)")
    waiting, axes = figure.subplots(1, 2, sharey=True, width_ratios=(1, 4))
    shown = {
        ("BAM2", "omega_disr"): ("BAM2, peak of the stress", "#0072B2", "^"),
        ("BAM2", "omega_mass_75"): ("BAM2, a quarter lost", "#56B4E9", "v"),
        ("BA", "omega_mass_75"): ("BA, a quarter lost", "#D55E00", "o"),
    }
    for shift, ((kind, mark), (label, colour, marker)) in zip((-0.2, 0.0, 0.2), shown.items(), strict=True):
        own = table[table["type"] == kind]
        rate = ratios(own[own["study"] == RATE], mark, (9, 5), ["epsilon"])
        quiet = ratios(own[own["study"] == WAITING], mark, (9, 5), [])
        style = dict(color=colour, marker=marker, capsize=1.5, elinewidth=0.8, linewidth=0.8)
        found = [(epsilon, median_of(part["ratio"])) for epsilon, part in rate.groupby("epsilon")]
        x, y, error = np.array([(epsilon, m["median"], m["error"]) for epsilon, m in found]).T
        axes.errorbar(x * (1 + shift / 4), 100 * (y - 1), 100 * error, label=label, **style)
        m = median_of(quiet["ratio"])
        waiting.errorbar([shift], [100 * (m["median"] - 1)], [100 * m["error"]], **style)
    for panel in (waiting, axes):
        panel.axhline(100 * (VISCOUS_EFFECT[1] - 1), color=HIGHLIGHT, linewidth=1.2, label="printed: BAM2, peak")
        panel.axhline(0.0, color=GREY, linewidth=0.6, zorder=0)
    axes.set_xscale("log")
    logarithmic(axes.xaxis)
    waiting.set_xlim(-0.5, 0.5)
    waiting.set_xticks([0.0], ["waiting"])
    axes.set_xlabel(r"rate $\varepsilon$, not waiting")
    waiting.set_ylabel("rise of $\\omega$ [%]")
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


@styled
def late_coriolis(table):
    """Figure: the drive literal beside what a solid grain gives."""
    runs = runs_of_solid_grains(table)
    title = "Printed terms of the frame,\nCoriolis force half a step late"
    figure = new_figure(ONE_COLUMN, 0.85 * ONE_COLUMN, title)
    axes = figure.subplots()
    for kind in TYPES:
        part = runs[runs["type"] == kind]
        axes.plot(
            part["omega_first_loss"] / part["known"], 100 * (part["omega_first_loss"] / part["solid"] - 1.0),
            TYPE_MARKER[kind], color=TYPE_COLOUR[kind], linestyle="none", alpha=0.7, label=kind,
        )  # fmt: skip
    axes.axhline(0.0, color=GREY, linewidth=0.6, zorder=0)
    axes.set_xscale("log")
    logarithmic(axes.xaxis)
    axes.set_xlabel("$\\omega$ of the first loss over that of the driven model")
    axes.set_ylabel("over that of a solid\ngrain, less 1 [%]")
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure
