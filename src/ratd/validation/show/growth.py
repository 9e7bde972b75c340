"""Show the form of aggregates, and that monomers arrive evenly."""

import numpy as np
from scipy.stats import kstest

from ratd.figures.style import GREY, TWO_COLUMNS, TYPE_COLOUR, TYPE_MARKER, empty, logarithmic, new_figure, styled
from ratd.markdown import markdown_table, measured
from ratd.reproduction.bounds import whole_nm
from ratd.reproduction.paper import GRAINS, MOST, PRINTED
from ratd.statistics import mean_of
from ratd.units import NM
from ratd.validation.growth import EXPECTED_CONTACTS, EXPECTED_POROSITY, NOT

LIMIT = 1.36
"""Greatest deviation of a cumulative distribution times sqrt(n) that 95 % of all samples of size n stay below."""
UNIFORM = {
    "squared impact parameter": ("#000000", "-"),
    "direction, z": ("#0072B2", "-"),
    "direction, azimuth": ("#0072B2", "--"),
    "place, z": ("#D55E00", "-"),
    "place, azimuth": ("#D55E00", "--"),
}
"""What should be uniform between 0 and 1, with its look."""


def uniform_values(table):
    """Of the arrivals: name of `UNIFORM` -> values, which should be uniform between 0 and 1."""
    part = table[table["study"] == "arrivals"]
    values = {"squared impact parameter": part["impact"]}
    for name in ("direction", "place"):
        x, y, z = (part[f"{name}_{axis}"] for axis in "xyz")
        values |= {f"{name}, z": 0.5 + 0.5 * z, f"{name}, azimuth": 0.5 + np.arctan2(y, x) / (2.0 * np.pi)}
    return {name: np.sort(column.to_numpy(float)) for name, column in values.items()}


@styled
def draw(table):
    """Porosity against the number of monomers, and cumulative distributions of arrivals less the uniform one.

    Parameters
    ----------
    table : pandas.DataFrame
        Columns of `ratd.validation.growth.COLUMNS`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = new_figure(TWO_COLUMNS, 0.45 * TWO_COLUMNS, "aggregates of equal monomers (as grown, no drive)")
    axes, right = figure.subplots(1, 2)
    for (kind, migration), part in table[table["study"] == "aggregates"].groupby(["type", "migration"]):
        colour = TYPE_COLOUR.get(kind, "black")
        points = {n: mean_of(own) for n, own in part.groupby("n_monomers")["porosity"]}
        face = {"mfc": "white", "mew": 0.7} if migration == "random" else {}
        axes.errorbar(
            list(points), *zip(*points.values(), strict=True), color=colour, marker=TYPE_MARKER.get(kind, "o"),
            ls="none", label=kind if migration == NOT else f"{kind} {migration}", elinewidth=0.8, **face,
        )  # fmt: skip
        if migration == "random":
            continue
        expected = [(n, value) for (name, n), value in EXPECTED_POROSITY.items() if name == kind]
        x, y = np.array(expected).T
        axes.fill_between(x, y - 0.01, y + 0.01, color=colour, alpha=0.25, lw=0)
    axes.set_xscale("log")
    logarithmic(axes.xaxis)
    axes.set_xlabel("number of monomers")
    axes.set_ylabel("porosity")
    _draw_arrivals(right, uniform_values(table))
    handles, labels = (a + b for a, b in zip(*(x.get_legend_handles_labels() for x in (axes, right)), strict=True))
    figure.legend(handles, labels, loc="outside lower center", ncols=5)
    return figure


def _draw_arrivals(axes, values):
    """Empirical cumulative distributions less the uniform one."""
    n = len(values["squared impact parameter"])
    if not n:
        empty(axes, "no arrivals")
        return
    for name, (colour, style) in UNIFORM.items():
        axes.plot(values[name], (np.arange(n) + 0.5) / n - values[name], color=colour, ls=style, label=name)
    for sign in (-1, 1):
        axes.axhline(sign * LIMIT / np.sqrt(n), color=GREY, lw=0.8, ls=":", label="95 %" if sign > 0 else None)
    axes.set_xlabel("value, 0 to 1")
    axes.set_ylabel("cumulative share less the uniform one")


def _tell_arrivals(values):
    """Kolmogorov-Smirnov tests of the arrivals."""
    rows = []
    for name, own in values.items():
        found = kstest(own, "uniform")
        rows.append([name, f"{len(own)}", measured(*mean_of(own)), f"{found.statistic:.4f}", f"{found.pvalue:.2g}"])
    return "\n\n".join(
        [
            "Single arrivals of a monomer on another: squared impact parameter over the greatest that hits, directions "
            "of flight and places of touch as z (brought to 0–1) and azimuth (over one turn). Each should be uniform "
            f"between 0 and 1, with mean 0.5. The greatest deviation of the cumulative distribution stays below "
            f"{LIMIT:g}/sqrt(n) = {LIMIT / np.sqrt(len(own)):.4f} in 95 % of such samples; p is that of the "
            "Kolmogorov-Smirnov test.",
            markdown_table(["arrivals", "n", "mean", "greatest deviation", "p"], rows),
        ]
    )


def _tell_migrations(table):
    """Paragraphs on both ways to migrate, beside the enclosing radii of Fig. 1 and the porosities of Fig. 2."""
    rows, held = [], {}
    for (kind, nm, migration), part in table.groupby(["type", whole_nm(table), "migration"]):
        if (kind, nm) not in GRAINS or migration == NOT:
            continue
        printed, most = GRAINS[kind, nm][2], PRINTED[f"porosity_{kind}"].value[1]
        low, median, high = part["enclosing_radius"].quantile([MOST[0], 0.5, MOST[1]]) / NM
        porosity = mean_of(part["porosity"])
        held.setdefault((kind, migration), []).append((low <= printed <= high, porosity[0] <= most))
        rows.append(
            [kind, f"{nm} nm", migration, len(part), f"{printed:g}", f"{median:.0f} ({low:.0f}–{high:.0f})",
             int((part["enclosing_radius"] >= printed * NM).sum()), f"{most:g}", measured(*porosity)]
        )  # fmt: skip
    if not rows:
        return []
    header = [
        "type", "size", "migration", "grains", "a_out printed [nm]", "a_out [nm]", "as large or larger",
        "porosity printed, up to", "porosity",
    ]  # fmt: skip
    counts = [
        "{} {}, {} and {} of {}".format(kind, migration, *np.sum(own, axis=0), len(own))
        for (kind, migration), own in held.items()
    ]
    return [
        "Grains of Fig. 1 with the radii of the ensemble and with both ways to migrate: in a random direction, as the "
        "paper says and as everywhere outside this section, and to the nearest place. a_out is the radius of the "
        "smallest sphere around all monomers, median and range of 95 % of the grains; behind it the number of grains "
        "that are at least as large as the printed one. The porosity is a mean, beside the greatest one of Fig. 2.",
        markdown_table(header, rows),
        f"In how many sizes the printed a_out lies in the range, and the mean porosity within Fig. 2: "
        f"{'; '.join(counts)}.",
    ]


def tell(table):
    """The section of the report, Markdown."""
    rows, values = [], uniform_values(table)
    aggregates = table[(table["study"] == "aggregates") & (table["migration"] != "random")]
    for (kind, n), part in aggregates.groupby(["type", "n_monomers"]):
        if (kind, int(n)) not in EXPECTED_POROSITY:
            continue
        p, q = EXPECTED_CONTACTS[kind]
        value, error = mean_of(part["porosity"])
        expected = EXPECTED_POROSITY[kind, int(n)]
        off = (value - expected) / np.hypot(error, 0.01)
        square = [measured(*mean_of(part[f"square_{axis}"])) for axis in "xyz"]
        rows.append(
            [kind, f"{n:.0f}", len(part), measured(value, error), f"{expected:g} ± 0.01", f"{off:+.1f}",
             measured(*mean_of(part["n_contacts"])), f"{p * n - q:.0f}",
             measured(*mean_of(part["enclosing_radius"] / part["a_eff"])),
             measured(*mean_of(part["fractal_dimension"])), ", ".join(square)]
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
            "errors. For isotropic growth the mean squares of the components of the contacts' directions are 1/3 each.",
            markdown_table(header, rows),
            "In the figure bands are the independent porosities, filled markers those of aggregates that grow like "
            "these, and open ones those of aggregates that migrate in a random direction, as everywhere outside this "
            "section.",
            *_tell_migrations(table[table["study"] == "grains"]),
            *([_tell_arrivals(values)] if len(values["place, z"]) else []),
        ]
    )
