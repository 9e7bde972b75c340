"""Show what the printed equations give."""

import numpy as np

from ratd.figures.style import TWO_COLUMNS, TYPE_COLOUR, TYPE_MARKER, logarithmic, new_figure, plural, styled
from ratd.validation.literal import MARKS
from ratd.validation.show.text import markdown_table, measured
from ratd.validation.statistics import median_of

MARK = "omega_mass_75"
BELOW = 0.7
"""The law of the explicit term is looked for where it gives less than this part of what the spins alone give."""


def with_reference(table):
    """The literal runs, with the marks of the consistent drive of the same grain in columns ``true_...``."""
    key = ["material", "type", "a_eff", "seed"]
    true = table[table["drive"] == "prescribed"].set_index(key)[list(MARKS)].add_prefix("true_")
    rows = table[table["drive"] == "literal"].join(true, on=key)
    rows["grain"] = [f"{t} {a * 1e9:.0f} {s:.0f}" for t, a, s in rows[["type", "a_eff", "seed"]].values]
    rows["a_eff"] = rows["a_eff"].round(12)  # grains of one size differ by rounding
    return rows


def exponents(rows, mark):
    """Exponents of omega in d omega/dt and in dt, fitted within each grain; list of pairs."""
    found = []
    for _, part in rows.groupby("grain"):
        part = part[np.isfinite(part[mark])]
        if len(part) < 4:
            continue
        x = np.log(part[["angular_acceleration", "timestep"]].to_numpy())
        x = np.column_stack([x, np.ones(len(x))])
        if np.linalg.matrix_rank(x - x.mean(axis=0) + [0, 0, 1]) < 3:
            continue
        found.append(np.linalg.lstsq(x, np.log(part[mark].to_numpy()), rcond=None)[0][:2])
    return found


@styled
def draw(table):
    """Left: explicit Coriolis term, against (d omega/dt / dt)^(1/3). Right: exact, against the reading of the spins.

    Parameters
    ----------
    table : pandas.DataFrame
        Columns of `ratd.validation.literal.COLUMNS`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    rows = with_reference(table)
    figure = new_figure(TWO_COLUMNS, 0.46 * TWO_COLUMNS, "the printed equations (drive: literal)")
    left, right = figure.subplots(1, 2)
    cells = rows.groupby(["type", "a_eff"])
    for k, ((kind, a_eff), part) in enumerate(cells):
        look = dict(color=TYPE_COLOUR.get(kind, "black"), marker=TYPE_MARKER.get(kind, "o"), ls="none")
        look |= dict(mfc="white" if k % 2 else None)
        label = f"{kind} {a_eff * 1e9:.0f} nm"
        here = part[part["coriolis"] == "explicit"]
        left.plot((here["angular_acceleration"] / here["timestep"]) ** (1 / 3), here[MARK], label=label, **look)
        here = part[part["coriolis"] == "exact"]
        right.plot(here[f"true_{MARK}"] / here["spin_share"], here[MARK], **look)
    for axes in (left, right):
        x = np.concatenate([np.asarray(line.get_xdata(), dtype=float) for line in axes.lines])
        x = x[np.isfinite(x)]
        if len(x):
            ends = np.array([x.min() / 1.3, x.max() * 1.3])
            axes.plot(ends, ends, color="black", lw=0.8)
        axes.set_xscale("log")
        axes.set_yscale("log")
        logarithmic(axes.xaxis)
        logarithmic(axes.yaxis)
    left.set_title("explicit Coriolis term")
    left.set_xlabel(r"$(\dot\omega/\Delta t)^{1/3}$ [rad s$^{-1}$]")
    left.set_ylabel(r"$\omega$ at 25 % mass loss [rad s$^{-1}$]")
    right.set_title("exact Coriolis term")
    right.set_xlabel(r"consistent $\omega$ over $I_\mathrm{spin}/(I_\mathrm{orbit}+I_\mathrm{spin})$ [rad s$^{-1}$]")
    figure.legend(*left.get_legend_handles_labels(), loc="outside lower center", ncols=4)
    return figure


def tell(table):
    """The section of the report, Markdown."""
    rows = with_reference(table)
    explicit = rows[rows["coriolis"] == "explicit"]
    exact = rows[rows["coriolis"] == "exact"]
    below = (explicit["angular_acceleration"] / explicit["timestep"]) ** (1 / 3) < BELOW * explicit[
        f"true_{MARK}"
    ] / explicit["spin_share"]
    explicit, all_explicit = explicit[below], explicit
    law = []
    for mark in MARKS:
        fits = np.array(exponents(explicit, mark)).reshape(-1, 2)
        cells = []
        for column in fits.T:
            s = median_of(column)
            cells.append(f"{measured(s['median'], s['error'])} ({s['n']} grains)")
        c = median_of(
            explicit[mark] / (explicit["angular_acceleration"] / explicit["timestep"]) ** (1 / 3), explicit["grain"]
        )
        law.append([mark, *cells, f"{measured(c['median'], c['error'])} ({c['low']:.2f}–{c['high']:.2f})"])
    spins = []
    for (kind, a_eff), part in exact.groupby(["type", "a_eff"]):
        broke = part["outcome"] == "one contact left"
        s = median_of(part[MARK] / part[f"true_{MARK}"] * part["spin_share"], part["grain"])
        over = median_of(part[MARK] / part[f"true_{MARK}"], part["grain"])
        spins.append(
            [kind, f"{a_eff * 1e9:.0f}", f"{int(broke.sum())} of {len(part)}", f"{part['spin_share'].median():.4f}",
             measured(over["median"], over["error"]), measured(s["median"], s["error"])]
        )  # fmt: skip
    shift = median_of(explicit[MARK] / explicit[f"true_{MARK}"], explicit["grain"])
    return "\n\n".join(
        [
            "## The literal drive",
            f"The equations as printed, for {plural(rows['grain'].nunique(), 'grain')} with d omega/dt = "
            + ", ".join(f"{a:.0e}" for a in sorted(set(all_explicit["angular_acceleration"])))
            + " rad/s² and f = "
            + ", ".join(f"{f:g}" for f in sorted(set(all_explicit["timestep_factor"])))
            + ". With the Coriolis force at the old velocity, omega ~ (d omega/dt / dt)^(1/3) would be exponents of "
            f"1/3 and -1/3, as long as that is well below ({BELOW:g}) what the spins alone give (see below), which "
            f"{plural(len(explicit), 'run')} of {len(all_explicit)} are. They are "
            "fitted within each grain; medians over the grains with standard error. The last column is "
            "omega over (d omega/dt / dt)^(1/3).",
            markdown_table(["mark", "exponent of d omega/dt", "exponent of dt", "prefactor"], law),
            f"In these runs a quarter of the mass is lost at {measured(shift['median'], shift['error'])} times the "
            f"omega of the consistent model (68 % of the runs {shift['low']:.1f}–{shift['high']:.1f}).",
            "With the exact Coriolis term a grain turns by its spins alone, with omega I_spin/(I_orbit + I_spin), "
            "because the printed equation of the spins lacks the Euler term. It should then part at the consistent "
            "threshold divided by that share. The last column, the ratio of the two, is 1 if so. "
            "Runs end at 3 times that omega.",
            markdown_table(
                [
                    "type",
                    "size [nm]",
                    "runs that broke",
                    "share of the spins",
                    "omega over consistent",
                    "times the share",
                ],
                spins,
            ),
        ]
    )
