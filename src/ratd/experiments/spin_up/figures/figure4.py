"""Fig. 4: how the grains of one cell come apart."""

import numpy as np

from ratd.base.errors import InputError
from ratd.base.units import NM
from ratd.base.words import plural
from ratd.experiments.spin_up.marks import LOSS, MAJORITY, disruption
from ratd.experiments.spin_up.printed import FIRST_LOSS
from ratd.experiments.spin_up.run_files import read_runs
from ratd.experiments.spin_up.figures.style import type_style
from ratd.pictures.snapshots import drive_of, drive_text
from ratd.pictures.style import GREY, HIGHLIGHT, ONE_COLUMN, logarithmic, new_figure, power_of_ten, styled

LIMITS = (8e6, 2e9)
"""omega [rad s-1] at the ends of the axis for the grains of the paper's figure, whatever turns them."""
DOT = {"marker": "o", "ls": "none", "ms": 3.5, "mfc": HIGHLIGHT, "mec": "black", "mew": 0.4, "zorder": 5}
REMNANT = 0.6
"""Opacity of a line, over that of the grain, once the largest fragment is less than half of it."""


@styled
def figure4(runs, marks=None, drive=None):
    """Mass, number of contacts and total stress of the largest fragment against omega (Fig. 4).

    Parameters
    ----------
    runs : sequence of xarray.Dataset
        The spin-up runs of one cell, see `ratd.spin_up`.
    marks : sequence of xarray.Dataset, optional
        What `ratd.disruption` returns for each run; found here if not given.
    drive : str, optional
        Named in the title; default: what the runs say.

    Returns
    -------
    matplotlib.figure.Figure
        A line a grain, dark for the one of median omega_disr and pale from where less than half of it is left; dots
        where a quarter of the mass or of the contacts is lost and where the stress peaks; an arrow at the peak of the
        number of contacts of the grain that gains most. For the grains of the paper's figure a line at the omega up to
        which the paper has a constant mass.

    Raises
    ------
    InputError
        If there is no run, or not one set of marks a run.

    References
    ----------
    Reissl et al. (2024), A&A 692, A60, Fig. 4.
    """
    runs = list(runs)
    marks = _marks(runs, marks)
    title = f"{_cell(runs)}, {plural(len(runs), 'grain')}\n{drive_text(drive_of(runs) if drive is None else drive)}"
    figure = new_figure(ONE_COLUMN, 1.5 * ONE_COLUMN, title)
    _draw(figure.subplots(3, 1, sharex=True), runs, marks)
    return figure


def _marks(runs, marks):
    """The marks of some runs, found where they are not given."""
    if not runs:
        raise InputError("figure4: give at least one run")
    marks = [disruption(run) for run in runs] if marks is None else list(marks)
    if len(marks) != len(runs):
        raise InputError(f"figure4: {len(runs)} runs, but {len(marks)} sets of marks")
    return marks


def _draw(panels, runs, marks):
    """Three panels of some runs with their marks."""
    mass_power, mass_unit = power_of_ten([run.attrs["initial_mass"] for run in runs])
    stress_power, stress_unit = power_of_ten(np.concatenate([run["total_stress"].values for run in runs]))
    _lines(panels, runs, marks, (10.0**mass_power, 1.0, 10.0**stress_power))
    for axes, text in zip(panels, ("25 % of the mass lost", "25 % of the contacts lost", "peak stress"), strict=True):
        axes.set_title(f"dots: {text}", loc="right", fontsize=7.5, pad=2)
        axes.set_ylim(bottom=0)
    top, middle, bottom = panels
    top.set_ylabel(rf"mass $M$ [{mass_unit}kg]")
    middle.set_ylabel(r"contacts $N_\mathrm{con}$")
    bottom.set_ylabel(rf"total stress $\sigma_\Sigma$ [{stress_unit}Pa]")
    bottom.set_xlabel(r"angular velocity $\omega$ [rad s$^{-1}$]")
    bottom.set_xscale("log")
    bottom.set_xlim(*_omega_limits(runs, marks))
    logarithmic(bottom.xaxis)
    middle.set_ylim(top=1.25 * middle.get_ylim()[1])  # room for the arrow
    _point_at_peak(middle, runs, marks)
    if all(map(_in_the_paper, runs)):
        for axes in panels:
            axes.axvline(FIRST_LOSS[1], color="black", lw=0.8, ls="--", zorder=1)
        _name_the_paper(top)


def _name_the_paper(axes):
    """What the line of the paper is, on the side of it that has more room."""
    low, high = np.log(axes.get_xlim())
    left = np.log(FIRST_LOSS[1]) > 0.5 * (low + high)
    place = {"xytext": (-10 if left else 10, 0), "textcoords": "offset points", "va": "top"}
    place |= {"ha": "right" if left else "left", "xycoords": axes.get_xaxis_transform()}
    axes.annotate("paper: mass\nconstant\nup to here", (FIRST_LOSS[1], 0.9), **place)


def _lines(panels, runs, marks, units):
    """Lines and dots of some runs in three panels."""
    kinds = [str(run.attrs.get("type") or "") for run in runs]
    colour = type_style(kinds)[kinds[0]]["color"]
    shown = _median_of(marks)
    for number, (run, mark) in enumerate(zip(runs, marks, strict=True)):
        dark = number == shown
        look = {"color": colour, "lw": 1.3 if dark else 0.7, "zorder": 3 if dark else 2}
        alpha = 1.0 if dark else 0.35
        omega, mass = run["omega"].values, run["mass"].values
        whole = int(np.argmax(mass < MAJORITY * run.attrs["initial_mass"])) or len(omega)
        values = mass, run["n_contacts"].values, run["total_stress"].values
        left = 1 - LOSS
        dots = (
            (mark["omega_mass_75"], left * run.attrs["initial_mass"]),
            (mark["omega_contacts_75"], left * run.attrs["initial_n_contacts"]),
            (mark["omega_disr"], mark["stress_peak"]),
        )
        for axes, line, (x, y), unit in zip(panels, values, dots, units, strict=True):
            axes.plot(omega[: whole + 1], line[: whole + 1] / unit, **look, alpha=alpha)
            axes.plot(omega[whole:], line[whole:] / unit, **look | {"lw": 0.7}, alpha=REMNANT * alpha)
            axes.plot(x, y / unit, **DOT)


def _median_of(marks):
    """Number of the grain of median omega_disr, None where no grain has it."""
    omega = np.array([float(mark["omega_disr"]) for mark in marks])
    known = np.flatnonzero(np.isfinite(omega))
    return known[np.argsort(omega[known], kind="stable")[(len(known) - 1) // 2]] if len(known) else None


def _in_the_paper(run):
    """Whether a run is of the cell of the paper's figure."""
    material, kind, size = FIRST_LOSS[0]
    own = run.attrs.get("a_eff")
    return (run.attrs.get("material"), run.attrs.get("type")) == (material, kind) and abs(own - size) < 0.5 * NM


def _cell(runs):
    """Name of the cell, several values joined."""

    def joined(name, text):
        return ", ".join(sorted({text(run.attrs[name]) for run in runs if run.attrs.get(name) not in (None, "")}))

    sizes = joined("a_eff", lambda size: f"{float(size) / NM:.4g} nm")
    return " ".join(part for part in (joined("material", str), joined("type", str), sizes) if part) or "grains"


def _omega_limits(runs, marks):
    """From a third of the first loss of mass, or else a hundredth of the end, to the end of the last run.

    For the grains of the paper's figure `LIMITS`, as far as all marks lie in between, so that figures can be compared.
    """
    end = max(run["omega"].values.max() for run in runs)
    first = [float(mark["omega_first_loss"]) for mark in marks]
    first = [omega for omega in first if np.isfinite(omega) and omega > 0]
    low, high = LIMITS
    if all(map(_in_the_paper, runs)) and low < min(first, default=low) and end < high:
        return LIMITS
    return (min(first) / 3 if first else end / 100), 1.1 * end


def _point_at_peak(axes, runs, marks):
    """Arrow at the peak of the number of contacts of the grain that gains most, or a remark that none gains any."""
    gain = [
        float(mark["n_contacts_max"]) / run.attrs["initial_n_contacts"] - 1
        for run, mark in zip(runs, marks, strict=True)
    ]
    k = int(np.argmax(gain))
    if gain[k] <= 0:
        axes.text(0.03, 0.07, "no grain\ngains contacts", transform=axes.transAxes, color=GREY)
        return
    peak = float(marks[k]["omega_contacts_max"])
    low, high = axes.get_xlim()
    place = np.log(peak / low) / np.log(high / low)
    side, start = ("left", 0.0) if place < 0.3 else ("right", 1.0) if place > 0.7 else ("center", 0.5)
    axes.annotate(
        rf"greatest $N_\mathrm{{con}}$, +{100 * gain[k]:.2g} %",
        xy=(peak, float(marks[k]["n_contacts_max"])),
        xytext=(peak, 0.96),
        textcoords=axes.get_xaxis_transform(),
        ha=side,  # keeps the text inside the panel
        va="top",
        arrowprops={"arrowstyle": "-|>", "color": "black", "lw": 0.8, "shrinkA": 0, "shrinkB": 1, "relpos": (start, 0)},
    )


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return figure4([run for path in files["runs"] for run in read_runs(path)], drive=settings["drive"])
