"""Show what the viscous time does to the marks of disruption, by how finely the damping is resolved and by the rate."""

from itertools import product

import numpy as np

from ratd.figures.style import TWO_COLUMNS, TYPE_COLOUR, TYPE_MARKER, logarithmic, new_figure, styled
from ratd.markdown import markdown_table, measured, plural
from ratd.reproduction.paper import PRINTED
from ratd.statistics import median_of
from ratd.units import NM, PS
from ratd.validation.damping import RATE, RESOLUTION

SHOWN = {"omega_disr": r"$\omega_\mathrm{disr}$", "omega_mass_75": "25 % of the mass lost"}
DAMPING_LOOK = {"implicit": dict(color="#CC79A7", marker="v"), "explicit": dict(color="#000000", marker="D")}
PAPER = PRINTED["viscous"]
"""The rise of omega_disr that the paper states, of BAM2, from its T_vis to the longest one."""
PAPER_TIME = 5 * PS
"""T_vis of the paper where it is not varied."""
SMALL = 1e-5
"""A smaller standard error of a ratio is not written."""
GRAIN = ["material", "type", "a_eff", "seed"]
WAY = ["study", "epsilon", "damping", "timestep_factor"]


def over_shorter(table, shorter):
    """Marks of each run with the longest T_vis over those of the same grain with a shorter one.

    Parameters
    ----------
    table : pandas.DataFrame
        Columns of `ratd.validation.convergence.COLUMNS`.
    shorter : float
        T_vis [s].

    Returns
    -------
    pandas.DataFrame
        Columns `GRAIN`, `WAY`, and the ratios in those of `SHOWN`, NaN where a run has not come to its end.
    """
    return _over(_with_time(table, table["viscous_time"].max()), _with_time(table, shorter), [*GRAIN, *WAY])


def over_finest(table):
    """Marks of each run with the paper's T_vis over those of the same grain with the damping best resolved.

    Parameters
    ----------
    table : pandas.DataFrame
        As for `over_shorter`.

    Returns
    -------
    pandas.DataFrame
        As from `over_shorter`.
    """
    table = _with_time(of(RESOLUTION, table), PAPER_TIME)
    return _over(table, finest(table), GRAIN)


def of(study, table):
    """Rows of a study, `RESOLUTION` or `RATE`."""
    return table[table["study"] == study]


def finest(table):
    """Rows of `RESOLUTION` where the damping is resolved best: explicit, at its least f."""
    table = of(RESOLUTION, table)
    table = table[table["damping"] == "explicit"]
    return table[table["timestep_factor"] == table["timestep_factor"].min()]


def _with_time(table, time):
    return table[np.isclose(table["viscous_time"], time, rtol=1e-6, atol=0.0)]


def _over(runs, base, key):
    marks = list(SHOWN)
    ended = [own[own["outcome"] == "one contact left"] for own in (runs, base)]
    both = runs[[*GRAIN, *WAY]].merge(ended[0][[*GRAIN, *WAY, *marks]], how="left")
    both = both.merge(ended[1][[*key, *marks]], on=key, how="left", suffixes=("", "_base"))
    for mark in marks:
        both[mark] /= both.pop(f"{mark}_base")
    return both


@styled
def draw(table):
    """The rise from the paper's T_vis to the longest one, a panel a type against f, and one against epsilon.

    Parameters
    ----------
    table : pandas.DataFrame
        As for `over_shorter`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    longest = table["viscous_time"].max()
    rows = over_shorter(table, PAPER_TIME)
    kinds = sorted(set(table["type"]))
    title = f"{', '.join(table['material'].unique())} grains of {sizes(table)}, drive: prescribed"
    figure = new_figure(TWO_COLUMNS, 0.45 * TWO_COLUMNS, title)
    resolution, by_rate = of(RESOLUTION, rows), of(RATE, rows)
    panels = figure.subplots(1, len(kinds) + (len(by_rate) > 0), squeeze=False)[0]
    for axes, kind in zip(panels, kinds, strict=False):
        own = resolution[resolution["type"] == kind]
        for k, (damping, mark) in enumerate(product(DAMPING_LOOK, SHOWN)):
            label = f"{damping}, {SHOWN[mark]}"
            part = own[own["damping"] == damping]
            _line(axes, part, "timestep_factor", mark, k, label, **DAMPING_LOOK[damping])
        axes.set_title(f"{kind}, ε = {own['epsilon'].iloc[0]:g}")
        axes.set_xlabel("step factor f")
        axes.sharey(panels[0])
    if len(by_rate):
        for k, (kind, mark) in enumerate(product(kinds, SHOWN)):
            look = dict(color=TYPE_COLOUR.get(kind, "black"), marker=TYPE_MARKER.get(kind, "D"))
            part = by_rate[by_rate["type"] == kind]
            _line(panels[-1], part, "epsilon", mark, k, f"{kind}, {SHOWN[mark]}", **look)
        panels[-1].set_title(_ways(by_rate))
        panels[-1].set_xlabel(r"$\epsilon = \dot\omega/\omega^2$")
    for axes in panels:
        axes.axhline(1.0, color="black", lw=0.8)
        if axes is panels[-1] or axes.get_title().startswith("BAM2"):
            axes.axhline(PAPER.value, color="black", lw=0.8, ls=":", label="BAM2, stated in the paper")
        axes.set_xscale("log")
        logarithmic(axes.xaxis)
    panels[0].set_ylabel(f"$\\omega$ at $T_\\mathrm{{vis}}$ = {longest / PS:g} ps\nover that at {PAPER_TIME / PS:g} ps")
    entries = {}
    for axes in panels:
        handles, labels = axes.get_legend_handles_labels()
        entries |= dict(zip(labels, handles, strict=True))
    figure.legend(entries.values(), entries, loc="outside lower center", ncols=3)
    return figure


def _line(axes, rows, by, mark, k, label, **look):
    """Medians of a ratio with their errors against a column, omega_disr filled; lines stand side by side by k."""
    found = {x: median_of(part[mark]) for x, part in rows.groupby(by)}
    found = {x: s for x, s in found.items() if s["n"]}
    is_first = mark == next(iter(SHOWN))
    axes.errorbar(
        np.array(list(found)) * 1.06 ** (k - 1.5),
        [s["median"] for s in found.values()],
        np.nan_to_num([s["error"] for s in found.values()]),
        mfc=None if is_first else "white",
        ls="-" if is_first else "--",
        lw=0.8,
        elinewidth=0.7,
        label=label,
        **look,
    )


def sizes(table):
    """Sizes of the grains of a table, such as "100 nm"."""
    return ", ".join(f"{size:.0f}" for size in np.unique(np.round(table["a_eff"] / NM))) + " nm"


def _ways(rows):
    """The treatments of the damping and the steps of some rows, in words."""
    ways = rows[["damping", "timestep_factor"]].drop_duplicates()
    return "; ".join(f"{damping}, f = {f:g}" for damping, f in ways.itertuples(index=False))


def _cell(values):
    s = median_of(values)
    if not s["n"]:
        return "–"
    return f"{s['median']:.5g}" if s["error"] < SMALL else measured(s["median"], s["error"])


def tell(table):
    """The section of the report, Markdown."""
    shortest, longest = (of(RESOLUTION, table)["viscous_time"].agg(end) for end in ("min", "max"))
    columns = {
        f"{longest / PS:g} over {PAPER_TIME / PS:g} ps": over_shorter(of(RESOLUTION, table), PAPER_TIME),
        f"{longest / PS:g} over {shortest / PS:g} ps": over_shorter(of(RESOLUTION, table), shortest),
        f"{PAPER_TIME / PS:g} ps over resolved": over_finest(table),
    }
    ways = of(RESOLUTION, table).groupby(["type", "damping", "timestep_factor"], sort=False)
    lines = []
    for (kind, damping, f), part in sorted(ways, key=lambda way: (way[0][0], way[0][1] == "explicit", -way[0][2])):
        cells = [kind, damping, f"{f:g}", part["seed"].nunique(), int((part["outcome"] != "one contact left").sum())]
        for mark in SHOWN:
            for rows in columns.values():
                here = (rows["type"] == kind) & (rows["damping"] == damping) & (rows["timestep_factor"] == f)
                cells.append(_cell(rows.loc[here, mark]))
        lines.append(cells)
    header = ["type", "damping", "f", "grains", "runs that broke down"]
    header += [f"{mark}, {name}" for mark in SHOWN for name in columns]
    grains = table.drop_duplicates(GRAIN)
    least = finest(table)["timestep_factor"].iloc[0]
    return "\n\n".join(
        [
            "## Damping",
            f"{plural(len(grains), 'grain')} of {sizes(table)}, {', '.join(table['material'].unique())}, at epsilon = "
            f"{finest(table)['epsilon'].iloc[0]:g}, each with several viscous times T_vis. The implicit damping is "
            "weaker than Eq. 22 for light monomers, the more the longer the step and T_vis (docs/model.md, The "
            "scheme), so that it hides a part of what T_vis does; the explicit one is not. Medians over the grains "
            "with standard errors of a mark over that of the same grain with a shorter T_vis, and, for the paper's "
            f"T_vis of {PAPER_TIME / PS:g} ps, over that with the damping best resolved: explicit at f = {least:g}. "
            f"Errors below {SMALL:g} are left out.",
            markdown_table(header, lines),
            _rise(table),
            *_by_rate(table),
        ]
    )


def resolved_rise(table):
    """The rise from the paper's T_vis to the longest one where the damping is resolved best.

    Parameters
    ----------
    table : pandas.DataFrame
        As for `over_shorter`, of one type.

    Returns
    -------
    dict of str to dict
        Mark of `SHOWN` -> what `ratd.statistics.median_of` gives.
    """
    own = over_shorter(finest(table), PAPER_TIME)
    return {mark: median_of(own[mark]) for mark in SHOWN}


def _rise(table):
    """Sentences: the rise that T_vis makes where it is resolved best, type by type, beside the paper's."""
    longest = f"{table['viscous_time'].max() / PS:g}"
    parts = []
    for kind, own in table.groupby("type"):
        found = resolved_rise(own)
        parts.append(
            f"{kind} " + ", ".join(f"{mark} {measured(s['median'], s['error'])}" for mark, s in found.items() if s["n"])
        )
    return (
        f"From {PAPER_TIME / PS:g} to {longest} ps, so resolved: {'; '.join(parts)}. The paper states "
        f"{PAPER.value:g} for omega_disr of BAM2 ({PAPER.place})."
    )


def rise_by_rate(table):
    """The rise from the paper's T_vis to the longest one at each epsilon.

    Parameters
    ----------
    table : pandas.DataFrame
        As for `over_shorter`, of one type.

    Returns
    -------
    dict of float to dict
        epsilon -> mark of `SHOWN` -> what `ratd.statistics.median_of` gives.
    """
    rows = over_shorter(of(RATE, table), PAPER_TIME)
    return {epsilon: {mark: median_of(part[mark]) for mark in SHOWN} for epsilon, part in rows.groupby("epsilon")}


def _by_rate(table):
    """Paragraphs: the rise at each epsilon, where there are such runs."""
    part = of(RATE, table)
    if part.empty:
        return []
    lines, reached = [], []
    for kind, own in part.groupby("type"):
        for epsilon, found in rise_by_rate(own).items():
            broken = int((own.loc[own["epsilon"] == epsilon, "outcome"] != "one contact left").sum())
            cells = [measured(s["median"], s["error"]) if s["n"] else "–" for s in found.values()]
            lines.append([kind, f"{epsilon:g}", own["seed"].nunique(), broken, *cells])
            if kind == "BAM2" and found["omega_disr"]["median"] < PAPER.value:
                reached.append(epsilon)
    words = (
        f"By the rate, with the damping resolved ({_ways(part)}), from {PAPER_TIME / PS:g} to "
        f"{table['viscous_time'].max() / PS:g} ps. T_vis delays how contacts open; a slow spin-up leaves them the time:"
    )
    header = ["type", "epsilon", "grains", "runs that broke down", *SHOWN]
    below = f"omega_disr of BAM2 rises by less than the paper says up to epsilon = {max(reached):g}." if reached else ""
    return [words, markdown_table(header, lines), *([below] if below else [])]
