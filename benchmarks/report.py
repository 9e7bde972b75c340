"""``README.md`` and the figures, from the CSV files that are there."""

import numpy as np

from benchmarks.answer import SLOW, ratios
from benchmarks.cost import SHORT
from benchmarks.figures import draw_cost, draw_kernel, draw_scaling
from benchmarks.goals import goals
from benchmarks.profile import WAITS
from benchmarks.scaling import LINEAR_FROM, exponent
from benchmarks.tables import frame, markdown_table, pair_ratios, projected_range
from ratd.base.errors import FileError
from ratd.pipeline.io import atomic

MARKS = ("<!-- speed: written by python -m benchmarks -->\n", "<!-- end of speed -->\n")
"""Between these lines docs/speed.md quotes the goals."""


def write(out):
    """Write the report on what a folder of results holds.

    Parameters
    ----------
    out : pathlib.Path
    """
    text = "All of this is written by `python -m benchmarks`; the numbers stand in the CSV files here."
    parts = [f"# Measured speed\n\n{text}\n"]
    sections = _goals_section, _kernel, _answer, _compression, _collision, _cost, _profile, _scaling, _pipeline
    parts += [section(out) for section in sections]
    with atomic(out / "README.md") as part:
        part.write_text("\n".join(part_ for part_ in parts if part_), encoding="utf-8")


def quote(out, page):
    """Put the goals, and the machine, into a page between `MARKS`; the rest of it stays.

    Parameters
    ----------
    out : pathlib.Path
        Folder of the results.
    page : pathlib.Path

    Raises
    ------
    FileError
        If the page lacks the marks.
    """
    text = page.read_text(encoding="utf-8")
    if not all(mark in text for mark in MARKS):
        raise FileError(f"{page}: has no lines {MARKS[0].strip()!r} and {MARKS[1].strip()!r} to write between")
    before, rest = text.split(MARKS[0])
    after = rest.split(MARKS[1])[1]
    with atomic(page) as part:
        part.write_text(f"{before}{MARKS[0]}\n{_goals(out)}\n{MARKS[1]}{after}", encoding="utf-8")


def table(head, rows):
    """A markdown table with an empty line after it."""
    return markdown_table(head, rows) + "\n"


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


def _goals(out):
    """Goals as a table with a column a machine: of the folder, and of those in it, which hold other machines."""
    folders = [out, *sorted({path.parent for path in out.glob("*/*.csv")})]
    found = [goal for folder in folders for goal in goals(folder)]
    if not found:
        return ""
    machines = list(dict.fromkeys(goal.machine for goal in found))
    rows = {}
    for goal in found:
        limit = f"{'at most' if goal.greatest else 'at least'} {goal.limit:g} {goal.unit}"
        rows.setdefault((goal.what, limit), {})[goal.machine] = f"{goal.found}, {goal.verdict}"
    letters = [chr(ord("A") + k) for k in range(len(machines))]
    legend = [f"{letter}: one core of {machine}." for letter, machine in zip(letters, machines, strict=True)]
    cells = [[*what, *(row.get(machine, "") for machine in machines)] for what, row in rows.items()]
    return table(["what", "goal", *letters], cells) + "\n" + "\n".join(legend)


def _goals_section(out):
    text = _goals(out)
    return f"## Goals\n\n{text}\n" if text else ""


def _kernel(out):
    data, small, others = frame(out, "kernel"), frame(out, "small"), frame(out, "combinations")
    if data is None or small is None:
        return ""
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
    more = [] if others is None else ["### Large aggregates, another law, a box\n", _codes(others)]
    return "\n".join(
        [
            "## Kernel: ns per contact and step\n", _where(data), about + "\n", _codes(data), *more,
            f"### {small['monomers'].iloc[0]} monomers: microseconds per step, all included\n",
            table(["type", "motion", "contacts", "runs", "us per step"], tiny), "![kernel](kernel.png)\n",
        ]
    )  # fmt: skip


def _codes(data):
    """A table with a row a case, and columns for the other codes that were timed."""
    codes = [code for code in ("before", "LAMMPS") if code in set(data["code"])]
    rows = []
    for (name, motion), case in data.groupby(["aggregate", "motion"], sort=False):
        of = {code: part for code, part in case.groupby("code")}
        own = of["ratd"]
        row = [name, motion, case["monomers"].iloc[0], own["contacts"].iloc[-1], len(own)]
        row.append(_spread(own["ns_per_contact_step"]))
        for code in codes:
            if code in of:
                row += [_spread(of[code]["ns_per_contact_step"]), of[code]["contacts"].iloc[-1]]
                row.append(_spread(pair_ratios(case, code), 2))
            else:
                row += ["-"] * 3
        rows.append(row)
    head = ["aggregate", "motion", "monomers", "contacts", "pairs", "ratd [ns]"]
    for code in codes:
        head += [f"{code} [ns]", "its contacts", f"{code} over ratd"]
    return table(head, rows)


COST_HEAD = [
    "drive", "spin-up", "grains", "cells missing", "core-hours", "range", "error of the seeds", "uncorrected",
    "run in full", "cells compared", "full over projected", "its scatter", "steps likewise",
]  # fmt: skip
COST_NOTE = f"""
A drive that waits until the grain is quiet is measured: one grain a cell is run as the config says. The others are
projected. One grain a cell is run faster than the config says, and what of its time grows with the steps is multiplied
up. The drive `literal` is run for {SHORT} steps, and theory says how many there are.

Cells that are cheap are run in full as well. *Full over projected* compares them with what was projected: the
geometric mean, the scatter from cell to cell as a factor, and the numbers of steps. This mean corrects the cells that
were not run in full. They are larger, and may differ from it by as much as the scatter. The *range* is for all of them
being off by the scatter together. *Cells missing* are those whose runs failed.
"""


def _cost(out):
    cells, totals, runs = frame(out, "cost_cells"), frame(out, "cost_paper"), frame(out, "cost_runs")
    if runs is None:
        return ""
    if cells is None or totals is None:
        return "## Cost of the paper\n\nNot finished: the same command goes on.\n"
    rows = []
    for row in totals.itertuples():
        low, high = projected_range(row)
        compared = row.cells_compared > 1
        rows.append(
            [
                row.drive,
                f"{row.pace}, f = {row.timestep_factor:g}",
                row.grains,
                row.cells_missing,
                f"{row.core_hours:.1f}",
                "-" if low is None else f"{low:.1f} to {high:.1f}",
                f"{row.error_of_seeds:.1f}",
                f"{row.core_hours_uncorrected:.1f}",
                f"{100 * row.part_run_in_full:.0f} %",
                row.cells_compared,
                f"{row.full_to_projected_mean:.2f}" if compared else "-",
                f"{row.full_to_projected_scatter:.2f}" if compared else "-",
                f"{row.full_steps_to_projected:.2f}" if compared else "-",
            ]
        )
    words = ["## Cost of the paper\n", _where(totals), table(COST_HEAD, rows), COST_NOTE]
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


def _answer(out):
    data = frame(out, "answer")
    if data is None:
        return ""
    found = ratios(data)
    rows = []
    for kind, part in data.groupby("type", sort=False):
        own = part[part["code"] == "ratd"].iloc[0]
        for row in part.itertuples():
            way = "waits" if row.code == "ratd" else f"{row.epsilon:.3g}"
            seconds = (
                f"{row.seconds:.2f} ({row.least:.2f} - {row.greatest:.2f})"
                if row.code == "ratd"
                else f"{row.seconds:.0f}"
            )
            rows.append([kind, row.code, way, f"{row.omega:.3e}", f"{row.omega / own['omega'] - 1:+.1%}", seconds, ""])
        rows[-1][-1] = f"{found[kind]:.0f}"
    size, monomers = data["size_nm"].iloc[0], ", ".join(str(n) for n in data["monomers"].unique())
    about = (
        f"omega at which a grain of {size:g} nm ({monomers} monomers) has lost a quarter of its mass, and the wall "
        "time from the call to the answer. LAMMPS drives the same grain in a frame that turns, without waiting; the "
        f"last column is its time at epsilon = {SLOW:g}, projected from its slowest run here, over that of ratd.\n"
    )
    head = ["type", "code", "epsilon", "omega [rad/s]", "against ratd", "seconds", "LAMMPS over ratd"]
    return "\n".join(["## Time to an answer\n", _where(data), about, table(head, rows)])


def _compression(out):
    data = frame(out, "compression")
    if data is None:
        return ""
    rows = [
        [f"{row.monomers}", row.code, f"{row.ns_per_contact_step:.1f}", f"{row.steps:.2e}", f"{row.hours:.2g}"]
        for row in data.itertuples()
    ]
    about = (
        f"A cluster of ice in a box that shrinks with C_v = {data['strain_rate'].iloc[0]:.0e}, from where it just fits "
        f"to a filling factor of {data['until_phi'].iloc[0]:g}. Explicit steps are 0.2 t0, those of LAMMPS 0.1 t0; the "
        "hours of both are projected from a part of the run, those with long steps measured. The pressures agree: "
        "docs/compression.md.\n"
    )
    head = ["monomers", "code", "ns per contact and step", "steps", "hours"]
    return "\n".join(["## Compression\n", _where(data), about, table(head, rows)])


def _collision(out):
    data = frame(out, "collision")
    if data is None:
        return ""
    data = data[data["code"].notna()]
    rows = [[row.code, row.friction, f"{row.ns_per_contact_step:.1f}", f"{row.steps:.0f}"] for row in data.itertuples()]
    own = data.iloc[0]
    about = (
        f"Two MRN clusters that meet at {own['velocity']:g} m/s, {own['spheres']:.0f} spheres and "
        f"{own['contacts']:.0f} contacts, steps of {1e12 * own['timestep']:g} ps, from where they are 20 nm "
        "apart. The friction of ratd is that of the documents; LAMMPS has none of its kind.\n"
    )
    head = ["code", "friction", "ns per contact and step", "steps"]
    return "\n".join(["## Collision\n", _where(data), about, table(head, rows)])


def _profile(out):
    data = frame(out, "profile")
    if data is None:
        return ""
    rows, waiting = [], []
    for (kind, size), case in data.groupby(["type", "size_nm"], sort=False):
        parts = zip(case["steps"], case["contact_updates"], strict=True)
        rows.append([kind, f"{size:g}", *[f"{steps:.0%} / {updates:.0%}" for steps, updates in parts]])
        waits = zip(*(case[name] for name in WAITS), strict=True)
        waiting.append([kind, f"{size:g}", *[" / ".join(f"{share:.0%}" for share in own) for own in waits]])
    first = data[(data["type"] == data["type"].iloc[0]) & (data["size_nm"] == data["size_nm"].iloc[0])]
    bands = [
        f"omega below {high:g}" if low == 0 else f"{low:g} to {high:g}" if np.isfinite(high) else f"above {low:g}"
        for low, high in zip(first["from_bound"], first["to_bound"], strict=True)
    ]
    about = (
        "Where the steps of a run go, and the updates of contacts: shares of both, by omega in units of the cut bound, "
        f"for one grain of {data['material'].iloc[0]} each, drive `{data['drive'].iloc[0]}`. Counted, not timed.\n"
    )
    parts = ["### Where the steps go\n", about, table(["type", "size [nm]", *bands], rows)]
    if data["stretch"].notna().all():
        text = "What the spin-up waited for meanwhile: unrest / stretch / neither, shares of all updates of the run.\n"
        parts += [text, table(["type", "size [nm]", *bands], waiting)]
    return "\n".join(parts)


def _scaling(out):
    data = frame(out, "scaling")
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


def _pipeline(out):
    data = frame(out, "pipeline")
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
