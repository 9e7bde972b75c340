"""Show the form of aggregates of equal monomers."""

import numpy as np

from ratd.figures.style import ONE_COLUMN, TYPE_COLOUR, TYPE_MARKER, logarithmic, new_figure, styled
from ratd.validation.growth import EXPECTED_CONTACTS, EXPECTED_POROSITY
from ratd.validation.show.text import markdown_table, measured


def mean(values):
    """Mean and its standard error."""
    values = np.asarray(values, dtype=float)
    values = values[np.isfinite(values)]
    error = values.std(ddof=1) / np.sqrt(len(values)) if len(values) > 1 else np.nan
    return (values.mean() if len(values) else np.nan), error


@styled
def draw(table):
    """Mean porosity against the number of monomers, with the numbers of an independent generator.

    Parameters
    ----------
    table : pandas.DataFrame
        Columns of `ratd.validation.growth.COLUMNS`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = new_figure(ONE_COLUMN, 0.85 * ONE_COLUMN, "aggregates of equal monomers (as grown, no drive)")
    axes = figure.subplots()
    for kind, part in table.groupby("type"):
        colour = TYPE_COLOUR.get(kind, "black")
        numbers = sorted(set(part["n_monomers"]))
        points = [mean(part["porosity"][part["n_monomers"] == n]) for n in numbers]
        axes.errorbar(
            numbers, [p[0] for p in points], [p[1] for p in points],
            color=colour, marker=TYPE_MARKER.get(kind, "o"), ls="none", label=kind, elinewidth=0.8,
        )  # fmt: skip
        expected = [(n, value) for (name, n), value in EXPECTED_POROSITY.items() if name == kind]
        x, y = np.array(expected).T
        axes.fill_between(x, y - 0.01, y + 0.01, color=colour, alpha=0.25, lw=0)
    axes.set_xscale("log")
    logarithmic(axes.xaxis)
    axes.set_xlabel("number of monomers")
    axes.set_ylabel("porosity")
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3)
    return figure


def tell(table):
    """The section of the report, Markdown."""
    rows = []
    for (kind, n), part in table.groupby(["type", "n_monomers"]):
        p, q = EXPECTED_CONTACTS[kind]
        value, error = mean(part["porosity"])
        expected = EXPECTED_POROSITY.get((kind, int(n)), np.nan)
        off = (value - expected) / np.hypot(error, 0.01)
        square = [measured(*mean(part[f"square_{axis}"])) for axis in "xyz"]
        rows.append(
            [kind, f"{n:.0f}", len(part), measured(value, error), f"{expected:g} ± 0.01", f"{off:+.1f}",
             measured(*mean(part["n_contacts"])), f"{p * n - q:.0f}",
             measured(*mean(part["enclosing_radius"] / part["a_eff"])),
             measured(*mean(part["fractal_dimension"])), ", ".join(square)]
        )  # fmt: skip
    header = [
        "type", "N", "aggregates", "porosity", "independent", "off [sigma]", "N_con", "without accidental ones",
        "enclosing radius/a_eff", "D_f", "mean squares of the contacts' directions",
    ]  # fmt: skip
    return "\n\n".join(
        [
            "## Growth",
            "Aggregates of equal monomers that migrate to the nearest place, as those of the independent generator. "
            "Means with standard errors over the aggregates. `off` is the difference of the porosities over both "
            "errors. For isotropic growth the mean squares of the components of the contacts' directions are 1/3 each. "
            "Directions and impact parameters of single arrivals are tested in `tests/test_growth.py`.",
            markdown_table(header, rows),
        ]
    )
