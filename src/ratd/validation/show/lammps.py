"""Show ratd beside LAMMPS: the normal force of two spheres, and the thresholds of whole grains."""

import numpy as np
import pandas as pd

from ratd.figures.style import GREY, TWO_COLUMNS, TYPE_COLOUR, TYPE_MARKER, logarithmic, new_figure, styled
from ratd.markdown import markdown_table, measured, plural
from ratd.statistics import median_of
from ratd.units import NM
from ratd.validation.lammps import CODES, COMPARISONS, ELASTIC_ROLLING, MARKS, TURNING, threshold
from ratd.validation.peer_lammps import DIFFERENCES

GOAL = 0.15
GRAIN = ["type", "a_eff", "seed"]
FACE = dict(zip(MARKS, ("white", None), strict=True))
"""Open markers for the first loss, filled ones for 25 % of the mass."""
START = {"sudden": "set into rotation at once", "driven": "driven up by an outer torque"}
FRAME = {"LAMMPS": "LAMMPS in the inertial frame", TURNING: "LAMMPS in a frame that turns"}
"""Titles of the panels."""


def thresholds(table, column="mass_left", study="rotation"):
    """Brackets of the thresholds, a row a comparison, grain and mark.

    Parameters
    ----------
    table : pandas.DataFrame
        Columns of `ratd.validation.lammps.COLUMNS`.
    column : str
        When: "mass_left" at the end of the runs, "mass_half_way" after half of their time.
    study : str
        "rotation" or `ELASTIC_ROLLING`, which has the start driven only.

    Returns
    -------
    list of dict
        start, code, type, a_eff, seed, mark, cut_bound [rad/s]; ratd, LAMMPS: (low, high) [rad/s], NaN where there is
        no threshold.
    """
    rows = []
    for start, code in COMPARISONS:
        runs = table[(table["study"] == study) & (table["path"] == start)]
        for grain, part in runs.groupby(GRAIN):
            for mark, limit in MARKS.items():
                row = dict(zip(GRAIN, grain, strict=True)) | dict(start=start, code=code, mark=mark)
                row["cut_bound"] = part["cut_bound"].iloc[0]
                for name, which in zip(CODES, ("ratd", code), strict=True):
                    own = part[part["code"] == which]
                    row[name] = threshold(own["omega"], own[column], limit)
                rows.append(row)
    return rows


def middle(bracket):
    """Geometric mean of a bracket."""
    return float(np.sqrt(bracket[0] * bracket[1]))


@styled
def draw(table):
    """Normal force against compression, and thresholds of LAMMPS against those of ratd.

    Parameters
    ----------
    table : pandas.DataFrame
        Columns of `ratd.validation.lammps.COLUMNS`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = new_figure(TWO_COLUMNS, 0.95 * TWO_COLUMNS, "ratd beside LAMMPS")
    first, *panels = figure.subplots(2, 2).ravel()
    _draw_forces(first, table[table["study"] == "force"])
    found = thresholds(table)
    for axes, (start, code) in zip(panels, COMPARISONS, strict=True):
        _draw_thresholds(axes, [row for row in found if (row["start"], row["code"]) == (start, code)])
        axes.set_title(f"{START[start]}\n{FRAME[code]}")
        axes.set_xlabel(r"$\omega$ of parting, ratd [rad s$^{-1}$]")
        axes.set_ylabel(r"$\omega$ of parting, LAMMPS [rad s$^{-1}$]")
    shown = {}
    for axes in (first, *panels):
        shown |= dict(zip(*reversed(axes.get_legend_handles_labels()), strict=True))
    figure.legend(shown.values(), shown.keys(), loc="outside lower center", ncols=4)
    return figure


def _draw_forces(axes, table):
    """Force over F_C against delta/delta_0, one curve for all pairs."""
    x, y = table["overlap"] / table["equilibrium_overlap"], table["normal_force"] / table["pull_off_force"]
    shown = table["normal_force"].notna() & (table["path"] == "withdrawal")
    for code, look in (("ratd", dict(color="black", lw=1.0)), ("LAMMPS", dict(color=GREY, ls="none", marker="."))):
        chosen = shown & (table["code"] == code)
        if code == "ratd":  # all pairs lie on one curve
            first = table.loc[chosen, ["material", "radius_1", "radius_2"]].head(1).squeeze()
            chosen &= (table[["material", "radius_1", "radius_2"]] == first).all(axis=1)
        axes.plot(x[chosen], y[chosen], label=f"force, {code}", zorder=1 if code == "LAMMPS" else 2, **look)
    axes.axhline(0.0, color=GREY, lw=0.5)
    axes.set_xlabel(r"$\delta/\delta_0$")
    axes.set_ylabel(r"$F_\mathrm{N}/F_\mathrm{C}$")
    axes.set_title("two spheres that are drawn apart")


def _draw_thresholds(axes, rows):
    """Thresholds with their brackets, the line of equality and the goal."""
    for kind in dict.fromkeys(row["type"] for row in rows):
        for mark, face in FACE.items():
            part = [row for row in rows if row["type"] == kind and row["mark"] == mark]
            pairs = np.array([[row[code] for code in CODES] for row in part])  # grain, code, low and high
            pairs = pairs[np.isfinite(pairs).all(axis=(1, 2))]
            if not len(pairs):
                continue
            centre = np.sqrt(pairs.prod(axis=2))
            bars = np.abs(pairs - centre[:, :, None])
            look = dict(color=TYPE_COLOUR.get(kind, "black"), marker=TYPE_MARKER.get(kind, "o"), mfc=face, ls="none")
            # rings, so that both marks are seen where they fall together
            look |= dict(elinewidth=0.6, mew=0.6, ms=3.0 if face is None else 6.0, label=f"{kind}, {mark}")
            axes.errorbar(*centre.T, xerr=bars[:, 0].T, yerr=bars[:, 1].T, **look)
    axes.set_xscale("log")
    axes.set_yscale("log")
    low, high = min(axes.get_xlim()[0], axes.get_ylim()[0]), max(axes.get_xlim()[1], axes.get_ylim()[1])
    line = np.array([low, high])
    axes.plot(line, line, color="black", lw=0.8)
    axes.fill_between(line, line * (1 - GOAL), line * (1 + GOAL), color="0.9", lw=0, label=f"within {100 * GOAL:g} %")
    axes.set_xlim(low, high)
    axes.set_ylim(low, high)
    logarithmic(axes.xaxis)
    logarithmic(axes.yaxis)


def _forces(table):
    """Rows of the table of forces: one a material."""
    rows = []
    for material, part in table.groupby("material", sort=False):
        keys = ["radius_1", "radius_2", "path", "overlap"]
        relative = part.assign(force=part["normal_force"] / part["pull_off_force"])
        wide = relative.pivot_table("force", keys, "code")
        pairs = part[["radius_1", "radius_2"]].drop_duplicates()
        ends = []
        for code in CODES:
            held = part[(part["code"] == code) & part["normal_force"].notna() & (part["path"] == "withdrawal")]
            ends.append((held["overlap"] / held["equilibrium_overlap"]).groupby(held["radius_1"]).min().max())
        rows.append(
            [material, len(pairs), *(f"{-wide[code].min():.6f}" for code in CODES),
             f"{(wide['ratd'] - wide['LAMMPS']).abs().max():.0e}", *(f"{end:.3f}" for end in ends)]
        )  # fmt: skip
    return rows


def _after_half(found, half):
    """A sentence: the thresholds of sudden starts after half of their time beside those at its end."""
    both = {}
    for end, earlier in zip(found, half, strict=True):
        if end["start"] == "sudden":
            for name, code in zip(CODES, ("ratd", end["code"]), strict=True):
                both[*(end[key] for key in GRAIN), end["mark"], code] = middle(end[name]), middle(earlier[name])
    end, earlier = np.array([values for values in both.values() if np.isfinite(values[0])]).reshape(-1, 2).T
    ratio = earlier / end
    higher, same = ratio > 1.0 + 1e-6, ratio <= 1.0 + 1e-6
    up_to = f" (by up to {np.nanmax(ratio):.2f} times)" if higher.any() else ""
    return (
        f"Of {plural(len(ratio), 'threshold')} of sudden starts {int(same.sum())} are the same after half of the time, "
        f"{int(higher.sum())} higher then{up_to}, and {int(np.isnan(ratio).sum())} only reached later."
    )


def farthest_apart(table):
    """Thresholds of the two codes that differ by more than `GOAL`, and what each grain had lost at the lower one.

    Parameters
    ----------
    table : pandas.DataFrame
        Columns of `ratd.validation.lammps.COLUMNS`.

    Returns
    -------
    list of dict
        Rows of `thresholds` with ratio, LAMMPS over ratd; omega, the upper end of the lower bracket [rad/s];
        ratd_left, LAMMPS_left, the part of the mass in the largest fragment at that omega, NaN where it was not tried.
    """
    rows = []
    for row in thresholds(table):
        row["ratio"] = middle(row["LAMMPS"]) / middle(row["ratd"])
        if abs(row["ratio"] - 1.0) > GOAL:
            row["omega"] = min(row[name][1] for name in CODES)
            same = (table["study"] == "rotation") & (table["path"] == row["start"])
            same &= (table[GRAIN] == [row[key] for key in GRAIN]).all(axis=1)
            same &= np.isclose(table["omega"], row["omega"], rtol=1e-9)
            for name, which in zip(CODES, ("ratd", row["code"]), strict=True):
                left = table.loc[same & (table["code"] == which), "mass_left"]
                row[f"{name}_left"] = float(left.iloc[0]) if len(left) else np.nan
            rows.append(row)
    return rows


def _apart(table):
    """Paragraphs: the thresholds of `farthest_apart`, a table; none where there are none."""
    rows = [
        [
            row["start"], row["code"], f"{row['type']} {row['a_eff'] / NM:g} nm, seed {row['seed']:g}", row["mark"],
            f"{row['ratio']:.2f}", f"{row['omega']:.3g}",
            *("–" if np.isnan(row[f"{name}_left"]) else f"{row[f'{name}_left']:.3f}" for name in CODES),
        ]
        for row in farthest_apart(table)
    ]  # fmt: skip
    if not rows:
        return []
    head = ["start", "beside ratd", "grain", "mark", "LAMMPS/ratd", "omega [rad/s]", "left, ratd", "left, LAMMPS"]
    return [
        f"The others, with the part of the mass that each code leaves in the largest fragment at the lower of the two "
        f"thresholds. Mass goes in pieces, so that a mark can lie far off where one code loses a little more than "
        f"{100 * (1 - min(MARKS.values())):g} % at once and the other a little less:",
        markdown_table(head, rows),
    ]


def _agreement(ratio):
    """Cells of a row: median and range of thresholds of LAMMPS over those of ratd, and how many are within `GOAL`."""
    s = median_of(ratio)
    extremes = f"{np.min(ratio):.2f}–{np.max(ratio):.2f}" if len(ratio) else "–"
    good = int((np.abs(ratio - 1.0) <= GOAL).sum())
    return [measured(s["median"], s["error"]), extremes, f"{good} of {len(ratio)}"]


def elastic_rolling(table):
    """Driven grains whose contacts roll elastically for ever, beside the same grains with the limit, at a mark.

    Parameters
    ----------
    table : pandas.DataFrame
        Columns of `ratd.validation.lammps.COLUMNS`.

    Returns
    -------
    pandas.DataFrame
        A row a grain and mark of which both studies have the thresholds of both codes: `GRAIN`, mark; with, without:
        LAMMPS over ratd with and without the limit; ratd, LAMMPS: threshold without the limit over that with it.
    """
    keys = [*GRAIN, "mark"]
    both = [
        {
            tuple(row[key] for key in keys): [middle(row[name]) for name in CODES]
            for row in rows
            if row["start"] == "driven"
        }
        for rows in (thresholds(table), thresholds(table, study=ELASTIC_ROLLING))
    ]
    rows = [
        (*key, theirs / ours, theirs_free / ours_free, ours_free / ours, theirs_free / theirs)
        for key, (ours, theirs) in both[0].items()
        for ours_free, theirs_free in [both[1].get(key, (np.nan, np.nan))]
    ]
    return pd.DataFrame(rows, columns=[*keys, "with", "without", *CODES]).dropna()


def _elastic_rolling(table):
    """Paragraphs: `elastic_rolling`, a table; none where it was not computed."""
    found = elastic_rolling(table)
    cells = []
    for mark, part in found.groupby("mark", sort=False):
        for name, label in (("with", "with its limit"), ("without", "without")):
            cells.append([mark, label, len(part), *_agreement(part[name])])
    if not cells:
        return []
    first = found[found["mark"] == next(iter(MARKS))]
    shift = ", ".join(
        f"{measured(s['median'], s['error'])} ({name})" for name in CODES for s in [median_of(first[name])]
    )
    return [
        "The same grains driven once more, with contacts that roll elastically however far in both codes, so that what "
        "differs in the limit of rolling (see below) is gone:",
        markdown_table(["mark", "rolling", "grains", "LAMMPS/ratd", "range", f"within {100 * GOAL:g} %"], cells),
        f"The threshold of the first loss without the limit over that with it: {shift}. Once the two codes "
        "have lost different pieces they turn different grains, and may lose a quarter of the mass at omega far apart.",
    ]


def tell(table):
    """The section of the report, Markdown."""
    rows = table[table["study"] == "rotation"]
    found = thresholds(table)
    width = 100.0 * (rows[rows["code"] == TURNING].groupby([*GRAIN, "path"])["omega"].pct_change().min())
    cells, within = [], {}
    for start, code in COMPARISONS:
        for kind in dict.fromkeys(row["type"] for row in found):
            for mark in MARKS:
                chosen = (start, code, kind, mark)
                part = [row for row in found if tuple(row[key] for key in ("start", "code", "type", "mark")) == chosen]
                ratio = np.array([middle(row["LAMMPS"]) / middle(row["ratd"]) for row in part])
                bound = [median_of([middle(row[name]) / row["cut_bound"] for row in part]) for name in CODES]
                known = ratio[np.isfinite(ratio)]
                within.setdefault((start, code), []).extend((np.abs(known - 1.0) <= GOAL).tolist())
                cells.append(
                    [start, code, kind, mark, f"{len(known)} of {len(part)}",
                     *(measured(b["median"], b["error"]) for b in bound), *_agreement(known)]
                )  # fmt: skip
    how_long = rows.groupby("path")["rotations"].first()
    grains = rows.drop_duplicates(GRAIN)
    return "\n\n".join(
        [
            "## LAMMPS",
            f"The same spheres in ratd and in LAMMPS ({', '.join(sorted(set(table['version'])))}), with the same "
            "constants for every pair: JKR normal force, viscoelastic damping, linear springs for sliding, rolling and "
            "twisting with their limits.",
            "Two spheres, at rest at given distances, first approaching and then drawn apart; forces over F_C:",
            markdown_table(
                ["material", "pairs", "greatest pull, ratd", "greatest pull, LAMMPS", "greatest difference",
                 "last delta/delta_0 in contact, ratd", "last in LAMMPS"],
                _forces(table[table["study"] == "force"]),
            ),
            f"{plural(len(grains), 'grain')} of q-S with {grains['n_monomers'].min():.0f} to "
            f"{grains['n_monomers'].max():.0f} monomers, relaxed by ratd and damped alike. Sudden: rigid rotation at "
            f"once, free from then on for {how_long['sudden']:g} x 2 pi/omega; in ratd in the inertial frame, in "
            "LAMMPS there and in a frame that turns with omega, the same motion in other coordinates. Both codes "
            "search the same grid of omega by the same bisection. Driven: omega grows in steps of "
            f"{width:.0f} % every {how_long['driven']:g} x 2 pi/omega, and an outer torque keeps the largest fragment "
            "turning with it, as the drive `prescribed` does. A threshold is the middle of its "
            f"bracket, which is {width:.0f} % wide: each carries ±{width / 2:.0f} %. Given are medians over the grains "
            "with standard error, thresholds in units of the bound from the weakest cut. A mark outside the range that "
            "is searched is left out.",
            markdown_table(
                ["start", "beside ratd", "type", "mark", "grains", "ratd over bound", "LAMMPS over bound",
                 "LAMMPS/ratd", "range", f"within {100 * GOAL:g} %"],
                cells,
            ),
            f"Within {100 * GOAL:g} % of each other: "
            + "; ".join(
                f"{start}, {code}: {sum(good)} of {plural(len(good), 'threshold')}"
                for (start, code), good in within.items()
            )
            + ". " + _after_half(found, thresholds(table, "mass_half_way")),
            *_apart(table),
            *_elastic_rolling(table),
            "What differs between the two models, all else being mapped pair by pair:",
            "\n".join(f"- {difference}" for difference in DIFFERENCES),
        ]
    )  # fmt: skip
