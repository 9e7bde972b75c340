"""Show how the marks of disruption converge with the rate of the spin-up and the time step."""

import numpy as np

from ratd.drives import SPIN_UP_LAWS
from ratd.figures.style import TWO_COLUMNS, TYPE_COLOUR, TYPE_MARKER, logarithmic, new_figure, styled
from ratd.markdown import markdown_table, measured, measured_range, plural
from ratd.spinup import EPSILON, FIRST_LOSS
from ratd.statistics import median_of
from ratd.validation.convergence import EPSILON_ALONE, MARKS, UNSTABLE_STEPS

GOAL = 0.03
"""Shift of a mark that is allowed."""
LAG_POWER = 2 / 3
"""Power of epsilon with which a mark of a grain that yields shifts (docs/model.md, The scheme)."""
EARLY = 0.5
"""A run that loses mass below this part of the omega of the finest run was torn apart by its integration."""
MARK_TEXT = {
    "omega_disr": r"$\omega_\mathrm{disr}$ (stress peak)",
    "omega_first_loss": "first loss",
    "omega_mass_75": "25 % of mass lost",
    "omega_contacts_75": "25 % of contacts lost",
}
SHOWN = MARKS[:3]
IN_CELLS = ("omega_disr", "omega_first_loss", "omega_mass_75")
"""Marks that are given by type and size too."""
STUDIES = {
    "epsilon": r"$\epsilon = \dot\omega/\omega^2$",
    "timestep_factor": r"step factor $f$",
}


def ratios(table, study, finest=None):
    """Marks of every run over those of the finest run of the same grain.

    Parameters
    ----------
    table : pandas.DataFrame
        Columns of `ratd.validation.convergence.COLUMNS`.
    study : str
        epsilon, epsilon_fine, epsilon_large, timestep_factor, xi_c or T_vis.
    finest : float, optional
        Value that the others are compared with; default: the least one that the grain has.

    Returns
    -------
    pandas.DataFrame
        The rows of the study, with a column ``grain``, a column ``x`` (what was varied), ratios in the columns of the
        marks, and ``broken``: the integration failed, never ended, or lost mass below `EARLY` times the finest run's
        first loss. Broken runs have NaN for ratios.
    """
    columns = {"T_vis": "viscous_time"} | dict.fromkeys(EPSILON_ALONE, "epsilon")
    rows = table[table["study"] == study].copy()
    rows["x"] = rows[columns.get(study, study)]
    rows["grain"] = [
        f"{m} {t} {a * 1e9:.0f} {s:.0f}" for m, t, a, s in rows[["material", "type", "a_eff", "seed"]].values
    ]
    base = rows[rows["damping"] == "implicit"]
    least = base.groupby("grain")["x"].transform("min") if finest is None else finest
    base = base[np.isclose(base["x"], least, rtol=1e-6, atol=0.0)].set_index("grain")
    ratio = {mark: rows[mark].to_numpy() / base[mark].reindex(rows["grain"]).to_numpy() for mark in MARKS}
    rows["broken"] = (rows["outcome"] != "one contact left") | (ratio["omega_first_loss"] < EARLY)
    for mark in MARKS:
        rows[mark] = np.where(rows["broken"], np.nan, ratio[mark])
    return rows


def summary(rows, mark):
    """Median ratio against what was varied, list of dict: x, broken (runs that failed), and what `median_of` gives."""
    result = []
    for x, group in rows.groupby("x"):
        statistic = median_of(group[mark], group["grain"])
        result.append({"x": x, "broken": int(group["broken"].sum()), **statistic})
    return result


def coarsest(statistics, goal=GOAL):
    """Greatest x up to which every median differs from 1 by no more than `goal`, NaN if there is none."""
    best = np.nan
    for entry in statistics:
        if not (abs(entry["median"] - 1.0) <= goal and entry["broken"] == 0):
            break
        best = entry["x"]
    return best


@styled
def draw(table):
    """Ratios of three marks to the finest run, against epsilon (above) and f (below).

    Parameters
    ----------
    table : pandas.DataFrame
        Columns of `ratd.validation.convergence.COLUMNS`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = new_figure(TWO_COLUMNS, 0.62 * TWO_COLUMNS, "convergence of the marks of disruption (drive: prescribed)")
    panels = figure.subplots(2, len(SHOWN), sharey="row", sharex="row")
    kinds = list(dict.fromkeys(table["type"]))
    for line, (study, label) in enumerate(STUDIES.items()):
        rows = ratios(table, study)
        for axes, mark in zip(panels[line], SHOWN, strict=True):
            axes.axhspan(1 - GOAL, 1 + GOAL, color="0.88", lw=0)
            for k, kind in enumerate(kinds):
                for damping, face in (("implicit", None), ("explicit", "white")):
                    part = rows[(rows["type"] == kind) & (rows["damping"] == damping)]
                    if not len(part):
                        continue
                    points = [entry for entry in summary(part, mark) if entry["n"]]
                    x = np.array([p["x"] for p in points]) * 1.05 ** (k - 1)
                    y = np.array([p["median"] for p in points])
                    error = np.nan_to_num([p["error"] for p in points])
                    look = dict(color=TYPE_COLOUR.get(kind, "black"), marker=TYPE_MARKER.get(kind, "o"), mfc=face)
                    text = kind if damping == "implicit" else f"{kind}, explicit damping"
                    axes.errorbar(
                        x, y, error, lw=0.8, ls="-" if face is None else ":", elinewidth=0.7, label=text, **look
                    )
            axes.set_xscale("log")
            axes.set_xlabel(label)
            if line == 0:
                axes.set_title(MARK_TEXT[mark])
            logarithmic(axes.xaxis)
        panels[line][0].set_ylabel("over the finest run\nof the same grain")
    panels[0][0].set_ylim(0.8, 2.3)
    panels[1][0].set_ylim(0.92, 1.08)
    handles, labels = panels[1][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3)
    return figure


def _table(statistics, name, scale=1.0):
    """Rows of a Markdown table: what was varied, then each mark as median with error (spread)."""
    first = statistics[MARKS[0]]
    rows = []
    for k, entry in enumerate(first):
        cells = []
        for mark in MARKS:
            s = statistics[mark][k]
            cells.append(measured_range(s))
        rows.append([f"{entry['x'] * scale:g}", *cells, entry["broken"]])
    return markdown_table([name, *MARKS, "runs that broke down"], rows)


def tell(table):
    """The section of the report.

    Parameters
    ----------
    table : pandas.DataFrame
        Columns of `ratd.validation.convergence.COLUMNS`.

    Returns
    -------
    str
        Markdown.
    """
    every, table = table, table[~table["study"].isin(EPSILON_ALONE)]
    fine, large = (every["study"] == study for study in EPSILON_ALONE)
    n = len(table[["material", "type", "a_eff", "seed"]].drop_duplicates())
    sizes = ", ".join(f"{a * 1e9:.0f}" for a in sorted(set(np.round(table["a_eff"], 12))))
    words = [
        "## Convergence",
        f"{n} grains ({', '.join(dict.fromkeys(table['material']))}; {', '.join(dict.fromkeys(table['type']))}; "
        f"{sizes} nm) are spun up with every setting. Each mark is divided by that of the finest run of the same "
        "grain. Given are the median over all grains with its standard error (bootstrap over grains) and, in brackets, "
        "the range of 68 % of the grains. The marks of single grains differ by more than their median does, because "
        "the order of the breaks is chaotic. A run broke down if its values became infinite, if it never ended, or if "
        f"it lost mass below {EARLY:g} times the omega of the finest run; it has no part in the medians.",
        "Spin-up rate, against the slowest:",
    ]
    rows = ratios(table, "epsilon")
    statistics = {mark: summary(rows, mark) for mark in MARKS}
    words.append(_table(statistics, "epsilon"))
    words.append(_recommend(statistics, "epsilon"))
    words += [_cells(rows, mark) for mark in IN_CELLS]
    if fine.any():
        rows = ratios(every, "epsilon_fine")
        words.append(
            "The epsilon of production is another one for each type, "
            + ", ".join(f"{epsilon:g} for {kind}" for kind, epsilon in EPSILON.items())
            + f". {plural(rows['grain'].nunique(), 'grain')} that show it beside slower ones, each over the slowest "
            "run of the same grain; they have no part in the medians above:"
        )
        words += [_cells(rows, mark) for mark in IN_CELLS]
    words += [_production(rows), _limit(rows)]
    if large.any():
        words.append(_large(every))
    rows = ratios(table, "timestep_factor")
    for damping, part in rows.groupby("damping", sort=False):
        words.append(f"Step factor, {damping} damping, against the least f with implicit damping:")
        statistics = {mark: summary(part, mark) for mark in MARKS}
        words.append(_table(statistics, "f"))
        words.append(_recommend(statistics, "f"))
    words.append(_laws(table))
    for study, name, scale, finest in (("xi_c", "xi_c [nm]", 1e9, 0.2e-9), ("T_vis", "T_vis [ps]", 1e12, 5e-12)):
        rows = ratios(table, study, finest)
        failed = int(rows["broken"].sum())
        f = rows["timestep_factor"].iloc[0]
        words.append(
            f"{name} at f = {f:g}: {failed} of {len(rows)} runs broke down. Marks over those at {finest * scale:g}:"
        )
        words.append(_table({mark: summary(rows, mark) for mark in MARKS}, name, scale))
    return "\n\n".join(words)


def _by_cell(rows):
    """Rows of each type and size [nm]."""
    return rows.groupby(["type", rows["a_eff"].mul(1e9).round()])


def _cells(rows, mark):
    """A table: a mark by type and size, against epsilon."""
    values = sorted(rows["x"].unique())
    lines = []
    for (kind, size), part in _by_cell(rows):
        entries = {entry["x"]: entry for entry in summary(part, mark)}
        cells = [measured(entries[x]["median"], entries[x]["error"]) if x in entries else "–" for x in values]
        lines.append([kind, f"{size:g}", part["grain"].nunique(), *cells])
    header = ["type", "size [nm]", "grains", *(f"epsilon = {x:g}" for x in values)]
    return f"{mark} by type and size:\n\n" + markdown_table(header, lines)


def _production(rows, goal=GOAL):
    """A table: marks at the epsilon of production over those of the slowest run, and whether they are near enough."""
    here = rows[np.isclose(rows["x"], rows["type"].map(EPSILON))]
    if not len(here):
        return "No run has the epsilon of production."
    lines = []
    for kind, part in here.groupby("type"):
        cells = [kind, f"{EPSILON[kind]:g}", part["grain"].nunique()]
        for mark in IN_CELLS:
            s = median_of(part[mark], part["grain"])
            cells.append(f"{measured(s['median'], s['error'])}, {within(s, goal)}")
        lines.append(cells)
    return (
        "Marks at the epsilon of production over those of the slowest run, all sizes of a type together; within: the "
        f"shift and one standard error are at most {100 * goal:g} %, off: the shift less one is more, open: neither. "
        "The slowest run is not yet the limit, of which the next table tells:\n\n"
        + markdown_table(["type", "epsilon", "grains", *IN_CELLS], lines)
    )


def shift_from_limit(rows, mark):
    """How far a mark at the epsilon of production is expected to lie above that of an infinitely slow spin-up.

    Parameters
    ----------
    rows : pandas.DataFrame
        From `ratios`, grains of one type.
    mark : str

    Returns
    -------
    dict
        See `median_of`, over the grains: A epsilon^`LAG_POWER`, with A of each grain from a least-squares fit of
        omega = omega_0 (1 + A epsilon^`LAG_POWER`) to first order in the shift.
    """
    shifts = []
    for _, part in rows.groupby("grain"):
        part = part[np.isfinite(part[mark])]
        if len(part) < 2:
            continue
        lag = part["x"].to_numpy() ** LAG_POWER
        u, y = lag - lag.min(), part[mark].to_numpy() - 1.0
        shifts.append((u @ y) / (u @ u) * EPSILON[part["type"].iloc[0]] ** LAG_POWER)
    return median_of(shifts)


def _limit(rows):
    """A table: shifts at the epsilon of production from the limit of a slow spin-up, extrapolated."""
    lines = [[kind, *_percent(part)] for kind, part in rows.groupby("type")]
    return (
        f"If all shifts go with epsilon^{LAG_POWER:.2g}, as the lag of a grain that yields under its load and has to "
        "be moved apart (docs/model.md, The scheme), the marks at the epsilon of production lie above those of an "
        "infinitely slow spin-up by, in percent, medians over the grains:\n\n"
        + markdown_table(["type", *IN_CELLS], lines)
    )


def rate_exponent(shift):
    """d ln omega/d ln(d omega/dt) of a mark whose shift from its slow limit goes with epsilon^`LAG_POWER`.

    Parameters
    ----------
    shift : dict
        From `shift_from_limit`.

    Returns
    -------
    exponent, error : float

    Notes
    -----
    With p = d ln omega/d ln epsilon it is p/(1 + 2 p), because d omega/dt = epsilon omega^2.
    """
    above = 1.0 + shift["median"]
    power, error = LAG_POWER * shift["median"] / above, LAG_POWER * shift["error"] / above**2
    return power / (1.0 + 2.0 * power), error / (1.0 + 2.0 * power) ** 2


def _percent(rows):
    """`shift_from_limit` of each mark of `IN_CELLS`, in percent with its error."""
    return [percent(shift_from_limit(rows, mark)) for mark in IN_CELLS]


def percent(statistic):
    """A median of `ratd.statistics.median_of` in percent with its error, text."""
    return measured(100 * statistic["median"], 100 * statistic["error"])


def large_shifts(table, mark):
    """Shifts of a mark of large grains from the limit of a slow spin-up.

    Parameters
    ----------
    table : pandas.DataFrame or None
        Columns of `ratd.validation.convergence.COLUMNS`; None where the check was not made.
    mark : str

    Returns
    -------
    list of (str, float, dict)
        Type, size [nm], and what `shift_from_limit` gives.
    """
    if table is None:
        return []
    return [
        (kind, size, shift_from_limit(part, mark)) for (kind, size), part in _by_cell(ratios(table, "epsilon_large"))
    ]


def haste(first_loss):
    """How many times faster than epsilon a spin-up is where a grain loses its first mass.

    Parameters
    ----------
    first_loss : array_like of float
        omega of the first loss over the cut bound.

    Returns
    -------
    array_like of float
        (d omega/dt)/(epsilon omega^2) of the law of `ratd.drives.angular_velocity` with constant epsilon.
    """
    return np.maximum(1.0, FIRST_LOSS / first_loss) ** 3


def _large(table):
    """A paragraph and a table: large grains, which lose their first mass where the spin-up is faster than epsilon."""
    rows = ratios(table, "epsilon_large").assign(first=table["omega_first_loss"] / table["cut_bound"])
    lines = []
    for (kind, size), part in _by_cell(rows):
        here = part[np.isclose(part["x"], EPSILON[kind])]
        found = [here["first"], haste(here["first"]), *(here[mark] for mark in IN_CELLS)]
        found = [median_of(values, here["grain"]) for values in found]
        lines.append(
            [kind, f"{size:g}", ", ".join(dict.fromkeys(part["material"])), part["grain"].nunique()]
            + [f"{part['x'].min():g}", *(measured(s["median"], s["error"]) for s in found), *_percent(part)]
        )
    header = ["type", "size [nm]", "material", "grains", "slowest epsilon", "first loss over the cut bound"]
    header += ["(d omega/dt)/(epsilon omega²) there", *(f"{mark} over that of the slowest" for mark in IN_CELLS)]
    return (
        f"The law has its epsilon from {FIRST_LOSS:g} of the cut bound on. Below, its (d omega/dt)/omega² is epsilon "
        f"times ({FIRST_LOSS:g} of the bound over omega)³, and large BAM grains lose their first mass there. "
        f"{plural(rows['grain'].nunique(), 'large grain')} at the epsilon of production of the type, medians over the "
        "grains: where that is, how fast the spin-up is there, the marks over those of the slowest run of the same "
        "grain, and by how many percent they lie above those of an infinitely slow one, as above:\n\n"
        + markdown_table([*header, *(f"{mark} above the limit [%]" for mark in IN_CELLS)], lines)
    )


def within(statistic, goal=GOAL):
    """Whether a median is within the goal of 1, beyond it, or so near to its edge that its error leaves it open."""
    off = abs(statistic["median"] - 1.0)
    if not off <= goal:
        return "off" if off - statistic["error"] > goal else "open"
    return "open" if off + statistic["error"] > goal else "within"


def _laws(table):
    """A paragraph: marks under Eq. 24 over those under the constant-epsilon law."""
    rows = table[table["study"] == "law"].set_index(["material", "type", "a_eff", "seed"])
    constant, exponential = (rows[rows["law"] == law] for law in SPIN_UP_LAWS)
    parts = []
    for mark in MARKS:
        ratio = (exponential[mark] / constant[mark]).dropna()
        s = median_of(ratio.to_numpy(), [" ".join(map(str, grain)) for grain in ratio.index])
        parts.append(f"{mark} {measured(s['median'], s['error'])} ({s['low']:.2f}–{s['high']:.2f}; {s['n']} grains)")
    steps = (exponential["steps"] / constant["steps"]).median()
    epsilon = constant["epsilon"].iloc[0]
    return (
        f"The law of Eq. 24, with epsilon = {epsilon:g} at {FIRST_LOSS:g} of the cut bound, against the law that keeps "
        "this epsilon from there on: " + ", ".join(parts) + ". "
        f"The runs under Eq. 24 were ended after at most {UNSTABLE_STEPS} times the steps of the other run of the same "
        f"grain (median {steps:.1f} times), where some had not reached every mark; to their end, at hundreds of times "
        "the bound, they would take hundreds of times as many."
    )


def _recommend(statistics, name):
    """A sentence: up to where each mark stays within the goal."""
    parts = [f"{coarsest(entries):g} for {mark}" for mark, entries in statistics.items()]
    return (
        f"Greatest {name} up to which no run broke down and the median over all types, its error left aside, differs "
        f"from 1 by no more than {100 * GOAL:g} %: {', '.join(parts)}. Single types may differ by more."
    )
