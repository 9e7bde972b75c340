"""Show how well free elastic grains keep their energy."""

import numpy as np

from ratd.figures.style import GREY, TWO_COLUMNS, TYPE_COLOUR, TYPE_MARKER, logarithmic, new_figure, styled
from ratd.markdown import markdown_table, measured, plural
from ratd.spinup import TIMESTEP_FACTOR
from ratd.statistics import median_of

GOAL = 1e-3
"""Greatest error of the energy that is asked for at the production step."""
SMALL_STEP = 0.125
"""Exponents are fitted up to this f."""
PRODUCTION, COURSES = TIMESTEP_FACTOR, (0.5 * TIMESTEP_FACTOR, TIMESTEP_FACTOR)


def greatest_errors(table):
    """Greatest error of each run, indexed by type, seed and f."""
    return table.groupby(["type", "seed", "timestep_factor"])["greatest"].max()


def exponents(table):
    """Exponent of f in the greatest error of each grain up to `SMALL_STEP`, indexed by type and seed."""
    errors = greatest_errors(table).reset_index()
    errors = errors[errors["timestep_factor"] <= SMALL_STEP]
    return errors.groupby(["type", "seed"]).apply(
        lambda part: np.polyfit(np.log(part["timestep_factor"]), np.log(part["greatest"]), 1)[0], include_groups=False
    )


@styled
def draw(table):
    """Greatest error against f, and its course at half of the production step and at that.

    Parameters
    ----------
    table : pandas.DataFrame
        Columns of `ratd.validation.energy_step.COLUMNS`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = new_figure(TWO_COLUMNS, 0.45 * TWO_COLUMNS, "energy of free grains without dissipation (no drive)")
    left, right = figure.subplots(1, 2)
    for (kind, seed), errors in greatest_errors(table).groupby(level=["type", "seed"]):
        first = seed == table["seed"].min()
        f = errors.index.get_level_values("timestep_factor")
        look = dict(color=TYPE_COLOUR.get(kind, "black"), marker=TYPE_MARKER.get(kind, "o"))
        left.plot(f, errors, lw=0.6, label=kind if first else None, **look)
    f = np.sort(table["timestep_factor"].unique())
    scale = np.exp(np.mean(np.log(greatest_errors(table) / greatest_errors(table).index.get_level_values(2) ** 2)))
    left.plot(f, scale * f**2, color="black", lw=0.8, label=r"$\propto f^2$")
    left.axhline(GOAL, color=GREY, lw=0.8, ls="--")
    left.set_xscale("log")
    left.set_yscale("log")
    logarithmic(left.xaxis)
    logarithmic(left.yaxis)
    left.set_xlabel("step factor f")
    left.set_ylabel("greatest error of the energy\nover the kinetic energy at the start")
    for kind, own in table.groupby("type"):
        own = own[own["seed"] == own["seed"].min()]
        for factor, style in zip(COURSES, ("-", ":"), strict=True):
            part = own[np.isclose(own["timestep_factor"], factor)]
            label = f"{kind}, f = {factor:g}" if len(part) else None
            right.plot(
                part["step"] / 1000, part["greatest"], color=TYPE_COLOUR.get(kind, "black"), ls=style, label=label
            )
    right.axhline(GOAL, color=GREY, lw=0.8, ls="--")
    right.set_yscale("log")
    logarithmic(right.yaxis)
    right.set_xlabel("thousand steps")
    right.set_ylabel("error of the energy")
    handles, labels = (
        a + b for a, b in zip(*(axes.get_legend_handles_labels() for axes in (left, right)), strict=True)
    )
    figure.legend(handles, labels, loc="outside lower center", ncols=5)
    return figure


def tell(table):
    """The section of the report, Markdown."""
    errors = greatest_errors(table)
    factors = sorted(set(table["timestep_factor"]))
    slopes = exponents(table)
    rows = []
    for kind, part in errors.groupby(level="type"):
        cells = [kind, str(len(slopes[kind]))]
        for f in factors:
            values = part.xs(f, level="timestep_factor")
            cells.append(f"{values.min():.1e}–{values.max():.1e}" if len(values) > 1 else f"{values.max():.1e}")
        s = median_of(slopes[kind])
        rows.append([*cells, measured(s["median"], s["error"])])
    good = [f for f in factors if errors.xs(f, level="timestep_factor").max() < GOAL]
    runs = table.groupby(["type", "seed", "timestep_factor"])
    elastic = bool((table["dissipated"] == 0.0).all() and (table["contacts_made"] == 0).all())
    steps = runs["step"].max().groupby(level="timestep_factor").max()
    long_enough = ", ".join(f"{steps[f]:.2g} at f = {f:g}" for f in factors)
    return "\n\n".join(
        [
            "## Energy against the step",
            f"{plural(len(slopes), 'grain')} of {table['a_eff'].iloc[0] * 1e9:.0f} nm, free, vibrating and turning, "
            "without damping and without limits of sliding and rolling, integrated for the same time with every step "
            f"({long_enough} steps). "
            + (
                "No run dissipated anything or made a contact. "
                if elastic
                else "Some runs dissipated energy or made a contact, which is in their error. "
            )
            + "Given is the greatest error of the energy over the kinetic energy at the start; where there are several "
            "grains, the range over them. The kinetic energy is that of the mean of the velocities half a step before "
            f"and after. The exponent of f is fitted up to f = {SMALL_STEP:g}; median over the grains with standard "
            "error; a scheme of second order gives 2.",
            markdown_table(["type", "grains", *(f"f = {f:g}" for f in factors), "exponent of f"], rows),
            f"The error stays below {GOAL:g} "
            + (f"up to f = {max(good):g}." if good else "at no f.")
            + (
                f" At the production step f = {PRODUCTION:g} it is at most "
                f"{errors.xs(PRODUCTION, level='timestep_factor').max():.1e}."
                if PRODUCTION in factors
                else ""
            ),
        ]
    )
