"""Show how far free grains are from themselves in another frame."""

import numpy as np

from ratd.figures.style import TWO_COLUMNS, TYPE_COLOUR, TYPE_MARKER, logarithmic, new_figure, styled
from ratd.markdown import markdown_table, measured, plural
from ratd.statistics import median_of

FIRST_ORDER = (
    "It is near 1 here: the engine turns the spin with the frame after the whole kick by the torques, instead of "
    "between two halves of it as it does with the velocity, which leaves an error of first order in the spins."
)
SHADES = ("-", "--", "-.", ":")


def greatest(table):
    """Greatest distance of each run, indexed by type, seed and f."""
    return table.groupby(["type", "seed", "timestep_factor"])["distance"].max()


def exponents(table):
    """Exponent of f in the greatest distance of each grain, indexed by type and seed."""
    return (
        greatest(table)
        .reset_index()
        .groupby(["type", "seed"])
        .apply(
            lambda part: np.polyfit(np.log(part["timestep_factor"]), np.log(part["distance"]), 1)[0],
            include_groups=False,
        )
    )


@styled
def draw(table):
    """Distance over time for the first grain of each type, and the greatest one of all grains against f.

    Parameters
    ----------
    table : pandas.DataFrame
        Columns of `ratd.validation.frames.COLUMNS`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = new_figure(TWO_COLUMNS, 0.45 * TWO_COLUMNS, "free grains in the inertial and in a turning frame")
    left, right = figure.subplots(1, 2, sharey=True)
    factors = sorted(set(table["timestep_factor"]), reverse=True)
    for kind, own in table.groupby("type"):
        own = own[own["seed"] == own["seed"].min()]
        for factor, style in zip(factors, SHADES * len(factors), strict=False):
            part = own[own["timestep_factor"] == factor]
            left.plot(part["turned"], part["distance"], color=TYPE_COLOUR.get(kind, "black"), ls=style)
    for factor, style in zip(factors, SHADES * len(factors), strict=False):
        left.plot([], [], color="black", ls=style, label=f"f = {factor:g}")
    for (kind, seed), part in greatest(table).groupby(level=["type", "seed"]):
        look = dict(color=TYPE_COLOUR.get(kind, "black"), marker=TYPE_MARKER.get(kind, "o"), lw=0.6)
        label = kind if seed == table["seed"].min() else None
        right.plot(part.index.get_level_values("timestep_factor"), part, label=label, **look)
    f = np.array(sorted(factors))
    scale = np.exp(np.mean(np.log(greatest(table) / greatest(table).index.get_level_values(2) ** 2)))
    right.plot(f, scale * f**2, color="black", lw=0.8, label=r"$\propto f^2$")
    left.set_yscale("log")
    logarithmic(left.yaxis)
    right.set_xscale("log")
    logarithmic(right.xaxis)
    left.set_xlabel("angle by which the frame has turned [rad]")
    left.set_ylabel("distance between the trajectories\nover the mean radius")
    right.set_xlabel("step factor f")
    handles, labels = (
        a + b for a, b in zip(*(axes.get_legend_handles_labels() for axes in (left, right)), strict=True)
    )
    figure.legend(handles, labels, loc="outside lower center", ncols=4)
    return figure


def tell(table):
    """The section of the report, Markdown."""
    found, slopes = greatest(table), exponents(table)
    factors = sorted(set(table["timestep_factor"]))
    rows, apart = [], []
    for kind, part in found.groupby(level="type"):
        cells = [kind, str(len(slopes[kind])), f"{table['moved'][table['type'] == kind].max():.2g}"]
        for f in factors:
            values = part.xs(f, level="timestep_factor")
            cells.append(f"{values.min():.1e}–{values.max():.1e}" if len(values) > 1 else f"{values.max():.1e}")
        s = median_of(slopes[kind])
        rows.append([*cells, measured(s["median"], s["error"])])
        if abs(s["median"] - 2.0) > 2.0 * s["error"]:
            apart.append(kind)
    sections = [
        "## Frames",
        f"{plural(len(slopes), 'grain')} of {table['a_eff'].iloc[0] * 1e9:.0f} nm, free, turning, vibrating, with "
        "spinning monomers, damping and all limits, integrated in the inertial frame and, without the outer torque, "
        "in a frame that turns ever faster, until it has turned by "
        f"{table['turned'].max():.2g} rad. Given is the greatest distance between the places of any monomer in both "
        "runs, over the mean radius; where there are several grains, the range over them. Median of the exponents "
        "of f with standard error; frames that mean the same give 2, the order of the scheme.",
        markdown_table(["type", "grains", "moved by", *(f"f = {f:g}" for f in factors), "exponent of f"], rows),
    ]
    if slopes.median() < 1.5:
        sections.append(FIRST_ORDER)
    elif apart:
        way = table.groupby("type")["moved"].max().min()
        sections.append(
            f"{', '.join(apart)}: more than two standard errors from 2. The distances themselves are at most "
            f"{found.max():.1e} mean radii, while the monomers move by {way:.2g} mean radii and more."
        )
    return "\n\n".join(sections)
