"""The figures of the report: kernel, cost, scaling."""

import numpy as np

from benchmarks.tables import pair_ratios
from ratd.experiments.spin_up.figures.style import type_style
from ratd.pictures.style import GREY, TWO_COLUMNS, logarithmic, new_figure, save, styled

BLUE, ORANGE = "#0072B2", "#D55E00"
MATERIAL_MARKERS = "osD^vP"


@styled
def draw_kernel(data, small, path):
    """Every run as a point, beside LAMMPS, and of ten monomers."""
    figure = new_figure(TWO_COLUMNS, 2.6, "Speed of one core: every run is a point")
    left, right = figure.subplots(1, 2, width_ratios=(3, 2))
    cases = list(data.groupby(["aggregate", "motion"], sort=False))
    for place, (_, case) in enumerate(cases):
        codes = (("ratd", BLUE, "o", -0.12), ("before", GREY, "^", 0.0), ("LAMMPS", ORANGE, "s", 0.12))
        for code, colour, marker, shift in codes:
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
