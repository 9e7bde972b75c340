"""``README.md`` and the figures, from the CSV files that are there."""

from typing import NamedTuple

import numpy as np
import pandas as pd

from benchmarks.cost import FASTER, SHORT
from benchmarks.scaling import LINEAR_FROM, exponent
from ratd.base.errors import FileError
from ratd.pictures.style import GREY, TWO_COLUMNS, logarithmic, new_figure, save, styled, type_style
from ratd.pipeline.io import atomic

BLUE, ORANGE = "#0072B2", "#D55E00"
MATERIAL_MARKERS = "osD^vP"


def write(out):
    """Write the report on what a folder of results holds.

    Parameters
    ----------
    out : pathlib.Path
    """
    text = "All of this is written by `python -m benchmarks`; the numbers stand in the CSV files here."
    parts = [f"# Measured speed\n\n{text}\n"]
    parts += [section(out) for section in (_goals_section, _kernel, _cost, _profile, _scaling, _pipeline)]
    with atomic(out / "README.md") as part:
        part.write_text("\n".join(part_ for part_ in parts if part_), encoding="utf-8")


def table(head, rows):
    """A markdown table; cells are texts."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(map(str, line)) + " |" for line in lines) + "\n"


def _read(out, name):
    path = out / f"{name}.csv"
    return pd.read_csv(path, keep_default_na=True) if path.exists() else None


def _where(data):
    lines = []
    for (machine, software, pinned), rows in data.groupby(["machine", "software", "pinned"], sort=False):
        lines.append(f"Machine: {machine}; one core, {pinned}. {software}.")
        if rows["quick"].eq("yes").any():
            lines.append("**A quick run, which only shows that the benchmark works: its numbers mean nothing.**")
        if rows["load"].max() > 1.3:
            lines.append(
                f"**Up to {rows['load'].max():.1f} processes were at work on the machine when this was begun: noisy.**"
            )
    return "\n".join(lines) + "\n"


def _spread(values, digits=1):
    """Median with the least and the greatest."""
    return f"{np.median(values):.{digits}f} ({np.min(values):.{digits}f} - {np.max(values):.{digits}f})"


def pair_ratios(case):
    """LAMMPS over ratd for each pair of a case, (pairs,); empty without LAMMPS."""
    both = case.pivot_table(index="pair", columns="code", values="ns_per_contact_step")
    return (both["LAMMPS"] / both["ratd"]).to_numpy() if "LAMMPS" in both else np.empty(0)


MARKS = ("<!-- speed: written by python -m benchmarks -->\n", "<!-- end of speed -->\n")
"""Between these lines the README of the repository quotes the goals."""


def quote(out, readme):
    """Put the goals, and the machine, into a README between `MARKS`; the rest of it stays.

    Parameters
    ----------
    out : pathlib.Path
        Folder of the results.
    readme : pathlib.Path

    Raises
    ------
    FileError
        If the README lacks the marks.
    """
    text = readme.read_text(encoding="utf-8")
    if not all(mark in text for mark in MARKS):
        raise FileError(f"{readme}: has no lines {MARKS[0].strip()!r} and {MARKS[1].strip()!r} to write between")
    before, rest = text.split(MARKS[0])
    after = rest.split(MARKS[1])[1]
    with atomic(readme) as part:
        part.write_text(f"{before}{MARKS[0]}\n{_goals(out)}\n{MARKS[1]}{after}", encoding="utf-8")


class Goal(NamedTuple):
    """What was aimed at and what was found.

    Attributes
    ----------
    what, unit : str
    value, limit : float
    greatest : bool
        Whether the limit is the greatest value that meets the goal, else the least.
    low, high : float, optional
        Where a projected value may lie; None for a measured one.
    """

    what: str
    unit: str
    value: float
    limit: float
    greatest: bool
    low: float | None = None
    high: float | None = None

    def off(self, value):
        """By what factor a value misses the goal; 1 and less where it meets it."""
        return value / self.limit if self.greatest else self.limit / value

    @property
    def verdict(self):
        """Whether the goal is met."""
        nearest, farthest = sorted(self.off(end) for end in (self.low or self.value, self.high or self.value))
        if farthest <= 1.0:
            return "met"
        if nearest <= 1.0:
            return "left open"
        if self.low is None:
            return f"missed by a factor of {nearest:.2f}"
        return f"missed by a factor of {nearest:.2f} to {farthest:.2f}"

    @property
    def found(self):
        """The value, with its range where it is projected."""
        text = f"{self.value:.3g}"
        return text if self.low is None else f"projected {text} ({self.low:.3g}–{self.high:.3g})"


def goals(out):
    """What was aimed at and what was measured.

    Parameters
    ----------
    out : pathlib.Path
        Folder of the results.

    Returns
    -------
    list of Goal
        What was not measured is left out.
    """
    data, small, runs = _read(out, "kernel"), _read(out, "small"), _read(out, "cost_runs")
    paper, growth, overhead = _read(out, "cost_paper"), _read(out, "scaling"), _read(out, "pipeline")
    found = []
    for (name, motion), case in [] if data is None else data.groupby(["aggregate", "motion"], sort=False):
        own = case.loc[case["code"] == "ratd", "ns_per_contact_step"].median()
        found.append(Goal(f"kernel, {name} {motion}", "ns per contact and step", own, 17.0, True))
        ratio = pair_ratios(case)
        if len(ratio):
            found.append(Goal(f"LAMMPS over ratd, {name} {motion}", "times", float(np.median(ratio)), 10.0, False))
    if small is not None:
        slowest = small.groupby(["aggregate", "motion"])["us_per_step"].median().max()
        found.append(Goal(f"a step of {small['monomers'].iloc[0]} monomers, slowest case", "us", slowest, 1.5, True))
    if runs is not None:
        largest = runs[runs["size_nm"] == runs["size_nm"].max()]
        name = f"growth of a grain of {largest['size_nm'].iloc[0]:g} nm, slowest"
        found.append(Goal(name, "s", largest["growth_seconds"].max(), 0.5, True))
    for row in [] if paper is None else paper.itertuples():
        law = f"drive {row.drive}, {row.pace}, f = {row.timestep_factor:g}"
        found.append(Goal(f"{row.grains} grains, {law}", "core-hours", row.core_hours, 48.0, True, *_projected(row)))
    if overhead is not None:
        share = 1.0 - overhead["seconds_of_work"].sum() / overhead["seconds_of_pipeline"].sum()
        largest = overhead["size_nm"].max()
        found.append(Goal(f"pipeline, sizes up to {largest:g} nm: not work", "%", 100.0 * share, 10.0, True))
    if growth is not None:
        paper_sized = growth[growth["monomers"] <= 3000]
        peak = paper_sized["peak_bytes"].max() / 1e6
        found.append(Goal("memory of a job, up to 3000 monomers", "MB", peak, 400.0, True))
    return found


def _goals(out):
    rows = []
    for goal in goals(out):
        least = "at most" if goal.greatest else "at least"
        rows.append([goal.what, f"{least} {goal.limit:g} {goal.unit}", goal.found, goal.verdict])
    if not rows:
        return ""
    return table(["what", "goal", "found", ""], rows) + "\n" + "\n".join(_machines(out))


def _machines(out):
    """The machines that the goals were measured on, list of str."""
    names = ("kernel", "cost_paper", "scaling", "pipeline")
    tables_ = [data for data in (_read(out, name) for name in names) if data is not None and "machine" in data]
    machines = dict.fromkeys(machine for data in tables_ for machine in data["machine"])
    return [f"Measured on one core of: {machine}." for machine in machines]


def _goals_section(out):
    text = _goals(out)
    return f"## Goals\n\n{text}\n" if text else ""


def _kernel(out):
    data, small = _read(out, "kernel"), _read(out, "small")
    if data is None or small is None:
        return ""
    rows = []
    for (name, motion), case in data.groupby(["aggregate", "motion"], sort=False):
        ratio = pair_ratios(case)
        code = {key: part for key, part in case.groupby("code")}
        own = code["ratd"]
        peer = code.get("LAMMPS")
        rows.append(
            [
                name, motion, case["monomers"].iloc[0], own["contacts"].iloc[-1], len(own),
                _spread(own["ns_per_contact_step"]),
                "-" if peer is None else _spread(peer["ns_per_contact_step"]),
                "-" if peer is None else peer["contacts"].iloc[-1],
                "-" if peer is None else _spread(ratio),
            ]
        )  # fmt: skip
    peers = data[data["code"] == "LAMMPS"]
    if len(peers):
        text = [
            f"LAMMPS {version} (size classes: {classes})"
            for version, classes in peers[["version", "size_classes"]].drop_duplicates().itertuples(index=False)
        ]
        about = (
            f"Peer: {'; '.join(text)}. Both codes step through the same aggregates, with the same step and number of "
            "steps, one after the other on the same core; set-up is not counted. Processor time. "
            "Median (least - greatest) over the pairs; the ratio is taken pair by pair."
        )
    else:
        about = "LAMMPS was not measured: it was not there. Median (least - greatest) of processor time."
    tiny = [
        [kind, motion, case["contacts"].iloc[-1], len(case), _spread(case["us_per_step"], 2)]
        for (kind, motion), case in small.groupby(["aggregate", "motion"], sort=False)
    ]
    draw_kernel(data, small, out / "kernel.png")
    head = ["aggregate", "motion", "monomers", "contacts", "pairs", "ratd [ns]", "LAMMPS [ns]", "its contacts", "ratio"]
    return "\n".join(
        [
            "## Kernel beside LAMMPS: ns per contact and step\n", _where(data), about + "\n", table(head, rows),
            f"### {small['monomers'].iloc[0]} monomers: microseconds per step, all included\n",
            table(["type", "motion", "contacts", "runs", "us per step"], tiny), "![kernel](kernel.png)\n",
        ]
    )  # fmt: skip


def _profile(out):
    data = _read(out, "profile")
    if data is None:
        return ""
    rows = []
    for (kind, size), case in data.groupby(["type", "size_nm"], sort=False):
        parts = zip(case["steps"], case["contact_updates"], strict=True)
        rows.append([kind, f"{size:g}", *[f"{steps:.0%} / {updates:.0%}" for steps, updates in parts]])
    first = data[(data["type"] == data["type"].iloc[0]) & (data["size_nm"] == data["size_nm"].iloc[0])]
    bands = [
        f"omega below {high:g}" if low == 0 else f"{low:g} to {high:g}" if np.isfinite(high) else f"above {low:g}"
        for low, high in zip(first["from_bound"], first["to_bound"], strict=True)
    ]
    about = (
        "Where the steps of a run go, and the updates of contacts: shares of both, by omega in units of the cut bound, "
        f"for one grain of {data['material'].iloc[0]} each, drive `{data['drive'].iloc[0]}`. Counted, not timed.\n"
    )
    return "\n".join(["### Where the steps go\n", about, table(["type", "size [nm]", *bands], rows)])


def _pipeline(out):
    data = _read(out, "pipeline")
    if data is None:
        return ""
    first = data.iloc[0]
    work, wall = data["seconds_of_work"], data["seconds_of_pipeline"]
    rows = [
        [f"{size:g}", grains, f"{a:.1f}", f"{b:.1f}", f"{1 - a / b:.0%}"]
        for size, grains, a, b in zip(data["size_nm"], data["grains"], work, wall, strict=True)
    ]
    share = 1 - work.sum() / wall.sum()
    rows.append(["all", data["grains"].sum(), f"{work.sum():.1f}", f"{wall.sum():.1f}", f"{share:.0%}"])
    about = (
        f"The grains of {first['material']} of all types, drive `{first['drive']}`, in {first['blocks']} blocks a "
        "size: growing and spinning them up in one process, and Snakemake from nothing to their marks of disruption on "
        "the same core, one call a size. The code is compiled before either. Wall time.\n"
    )
    return "\n".join(
        [
            "## What the pipeline adds over small sizes\n", _where(data), about,
            table(["size [nm]", "grains", "work [s]", "pipeline [s]", "not work"], rows),
        ]
    )  # fmt: skip


@styled
def draw_kernel(data, small, path):
    """Every run as a point, beside LAMMPS, and of ten monomers."""
    figure = new_figure(TWO_COLUMNS, 2.6, "Speed of one core: every run is a point")
    left, right = figure.subplots(1, 2, width_ratios=(3, 2))
    cases = list(data.groupby(["aggregate", "motion"], sort=False))
    for place, (_, case) in enumerate(cases):
        for code, colour, marker, shift in (("ratd", BLUE, "o", -0.12), ("LAMMPS", ORANGE, "s", 0.12)):
            y = case.loc[case["code"] == code, "ns_per_contact_step"]
            if len(y):
                x = np.full(len(y), place + shift)
                left.plot(x, y, marker, color=colour, mfc="none", label=code if place == 0 else None)
        ratio = pair_ratios(case)
        if len(ratio):
            own = case.loc[case["code"] == "ratd", "ns_per_contact_step"].median()
            text = f"{np.median(ratio):.1f} times"
            left.annotate(text, (place, own * np.sqrt(np.median(ratio))), ha="center", va="center")
    left.set_yscale("log")
    names = [f"{name.removeprefix('aggregate_')}\n{motion}" for (name, motion), _ in cases]
    left.set_xticks(range(len(cases)), names)
    left.set_xlim(-0.5, len(cases) - 0.5)
    left.tick_params(axis="x", which="both", length=0)
    logarithmic(left.yaxis, 1.0)
    left.set_ylabel("time per contact and step [ns]")
    left.legend(loc="upper center", bbox_to_anchor=(0.5, 1.13), ncols=2)
    cases = list(small.groupby(["aggregate", "motion"], sort=False))
    for place, (_, case) in enumerate(cases):
        right.plot(np.full(len(case), place), case["us_per_step"], "o", color=BLUE, mfc="none")
    right.set_xticks(range(len(cases)), [f"{name}\n{motion.replace(' ', chr(10))}" for (name, motion), _ in cases])
    right.set_xlim(-0.5, len(cases) - 0.5)
    right.set_ylim(0, 1.25 * small["us_per_step"].max())
    right.tick_params(axis="x", which="both", length=0)
    right.set_ylabel(f"time per step of {small['monomers'].iloc[0]} monomers [µs]")
    save(figure, path)


def _projected(row):
    """Core-hours [h], low and high, if all cells not run in full were off together by the scatter of those that were.

    None for both where nothing is known of the scatter.
    """
    scatter = row.full_to_projected_scatter
    if not np.isfinite(scatter):
        return None, None
    rest = (1.0 - row.part_run_in_full) * row.core_hours
    return tuple(row.core_hours - rest + rest * scatter**sign for sign in (-1, 1))


def _cost(out):
    cells, totals, runs = _read(out, "cost_cells"), _read(out, "cost_paper"), _read(out, "cost_runs")
    if runs is None:
        return ""
    if cells is None or totals is None:
        return "## Cost of the paper\n\nNot finished: the same command goes on.\n"
    words = ["## Cost of the paper\n", _where(totals)]
    for row in totals.itertuples():
        compared = (
            f"In the {row.cells_compared} cells that were also run in full, the full run took "
            f"{row.full_to_projected_mean:.2f} times what the fast one projects (geometric mean; scatter from cell to "
            f"cell a factor of {row.full_to_projected_scatter:.2f}, from {row.full_to_projected_min:.2f} to "
            f"{row.full_to_projected_max:.2f}; number of steps, all of them together: {row.full_steps_to_projected:.2f}"
            "). The cells that were not run in full are corrected by this mean. The correction comes from cells that "
            "are cheap, i.e. small, and the expensive ones may differ from them by as much as these differ from each "
            "other."
            if row.cells_compared > 1
            else "Not enough cells were run in full to tell how good the projection is."
        )
        low, high = _projected(row)
        span = (
            ""
            if low is None
            else f" ({low:.1f} to {high:.1f} if all cells not run in full were off by that scatter together)"
        )
        missing = f"**{row.cells_missing} cells are missing: their runs failed.** " if row.cells_missing else ""
        seeds = f"The standard error of the seeds is {row.error_of_seeds:.1f} core-hours. "
        how = (
            f"One grain a cell was run for {SHORT} steps, which tells how long a step takes; the number of steps is "
            "that to the omega at which a solid grain parts. "
            if row.coarse == "short"
            else f"One grain a cell was run {row.coarse} and {FASTER * int(row.coarse)} times as fast as the config "
            "says; what of its time grows with the steps was multiplied up, the rest was not. "
        )
        words.append(
            f"**Drive `{row.drive}`, {row.pace}, f = {row.timestep_factor:g}: {row.core_hours:.1f} "
            f"core-hours** for {row.grains} grains{span}. {how}{missing}{compared} {seeds}"
            f"Without the correction, first seeds only: {row.core_hours_uncorrected:.1f}. Of the total, "
            f"{100 * row.part_run_in_full:.0f} % belong to cells whose grain was run in full.\n"
        )
    by = cells.pivot_table(index=["drive", "type"], columns="size_nm", values="core_hours_cell", aggfunc="sum")
    words.append("Core-hours by type and size, all materials and seeds; growth and spin-up, not the start of jobs:\n")
    words.append(
        table(
            ["drive", "type", *[f"{size:g} nm" for size in by.columns], "all"],
            [[*key, *[f"{v:.2g}" for v in row], f"{row.sum():.3g}"] for key, row in by.iterrows()],
        )
    )
    words.append("Every cell, with its steps and microseconds per step, is in `cost_cells.csv`.\n\n![cost](cost.png)\n")
    draw_cost(cells, out / "cost.png")
    return "\n".join(words)


@styled
def draw_cost(cells, path):
    """Core-hours, steps and time per step of every cell over its size; one row of panels for each drive."""
    drives = list(dict.fromkeys(cells["drive"]))
    kinds = type_style(cells["type"])
    materials = list(dict.fromkeys(cells["material"]))
    title = "Cost of every cell; filled: run in full, open: projected"
    figure = new_figure(TWO_COLUMNS, 0.5 + 2.2 * len(drives), title)
    panels = figure.subplots(len(drives), 3, squeeze=False, sharex=True)
    columns = (
        ("core_hours_cell", "core-hours of all seeds"),
        ("steps", "steps of one grain"),
        ("us_per_step", "time per step [µs]"),
    )
    for line, drive in zip(panels, drives, strict=True):
        for axes, (name, label) in zip(line, columns, strict=True):
            for (kind, material), part in cells[cells["drive"] == drive].groupby(["type", "material"], sort=False):
                part = part.sort_values("size_nm")
                colour = kinds[kind]["color"]
                marker = MATERIAL_MARKERS[materials.index(material) % len(MATERIAL_MARKERS)]
                axes.plot(part["size_nm"], part[name], "-", color=colour, lw=0.6, alpha=0.6)
                full = part["run_in_full"] == "yes"
                axes.plot(part["size_nm"][full], part[name][full], marker, color=colour, ls="none")
                axes.plot(part["size_nm"][~full], part[name][~full], marker, color=colour, mfc="white", ls="none")
            axes.set_yscale("log")
            logarithmic(axes.yaxis)
            axes.set_ylabel(label)
        line[0].annotate(drive, (0.05, 0.95), xycoords="axes fraction", va="top")
    for axes in panels[-1]:
        axes.set_xlabel(r"effective radius $a_\mathrm{eff}$ [nm]")
    handles = []
    for kind, style in kinds.items():
        handles += panels[0, 0].plot([], [], "-", color=style["color"], label=kind, lw=2)
    for k, material in enumerate(materials):
        marker = MATERIAL_MARKERS[k % len(MATERIAL_MARKERS)]
        handles += panels[0, 0].plot([], [], marker, color=GREY, label=material)
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles))
    save(figure, path)


def _scaling(out):
    data = _read(out, "scaling")
    if data is None:
        return ""
    medians = data.groupby("monomers").median(numeric_only=True).reset_index()
    rows = []
    for n, case in data.groupby("monomers"):
        last = case.iloc[-1]
        rows.append(
            [
                n, last["contacts"], _spread(case["us_per_step"], 2), f"{case['ns_per_contact_step'].median():.1f}",
                f"{last['state_bytes'] / n:.0f}", f"{last['peak_bytes'] / 1e6:.0f}",
                f"{(last['peak_bytes'] - last['idle_bytes']) / 1e6:.0f}",
            ]
        )  # fmt: skip
    large = medians[medians["monomers"] >= LINEAR_FROM]
    fit = ""
    if len(large) > 1:
        power = exponent(large["monomers"], large["us_per_step"])
        power_memory = exponent(large["monomers"], large["state_bytes"])
        fit = (
            f"From {large['monomers'].min()} to {large['monomers'].max()} monomers the time per step grows as "
            f"N^{power:.2f}, the state in memory as N^{power_memory:.2f}.\n"
        )
    draw_scaling(data, out / "scaling.png")
    head = ["monomers", "contacts", "us per step", "ns per contact and step", "state [byte per monomer]"]
    head += ["peak memory [MB]", "of that, not Python and its packages [MB]"]
    return "\n".join(
        ["## Growth with the number of monomers (BAM2, slowly turning)\n", _where(data), fit, table(head, rows)]
        + ["![scaling](scaling.png)\n"]
    )


@styled
def draw_scaling(data, path):
    """Time per step and memory over the number of monomers, with lines of slope 1."""
    figure = new_figure(TWO_COLUMNS, 2.6, "Cost over the number of monomers: BAM2, one core")
    left, right = figure.subplots(1, 2)
    left.plot(data["monomers"], data["us_per_step"], "o", color=BLUE, mfc="none", label="measured")
    state = data.groupby("monomers").last().reset_index()
    right.plot(state["monomers"], state["peak_bytes"] / 1e6, "s", color=ORANGE, mfc="none", label="peak of the process")
    right.plot(state["monomers"], state["state_bytes"] / 1e6, "o", color=BLUE, mfc="none", label="state of the engine")
    middle = data.groupby("monomers").median(numeric_only=True)
    x = np.array([data["monomers"].min(), data["monomers"].max()], dtype=float)
    last = x[-1]
    for axes, y in ((left, middle["us_per_step"].loc[last]), (right, middle["state_bytes"].loc[last] / 1e6)):
        axes.plot(x, y * x / last, "--", color=GREY, lw=0.8, label="linear")
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_xlabel("number of monomers")
        logarithmic(axes.xaxis)
        logarithmic(axes.yaxis)
    left.legend(loc="upper left")
    right.legend(loc="center left")
    left.set_ylabel("time per step [µs]")
    right.set_ylabel("memory [MB]")
    save(figure, path)
