"""Fig. 4: how the grains of one cell come apart."""

import numpy as np

from ratd.base.errors import InputError
from ratd.base.units import NM
from ratd.base.words import plural
from ratd.experiments.spin_up.marks import LOSS, disruption
from ratd.experiments.spin_up.run_files import read_runs
from ratd.pictures.style import (
    GREY,
    HIGHLIGHT,
    ONE_COLUMN,
    drive_of,
    drive_text,
    logarithmic,
    new_figure,
    power_of_ten,
    styled,
    type_style,
)


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
        A line a grain; dots where a quarter of the mass or of the contacts is lost and where the stress peaks; an
        arrow at the peak of the number of contacts of the grain that gains most.

    Raises
    ------
    InputError
        If there is no run, or not one set of marks a run.

    References
    ----------
    Reissl et al. (2024), A&A 692, A60, Fig. 4.
    """
    runs = list(runs)
    marks = [disruption(run) for run in runs] if marks is None else list(marks)
    if not runs:
        raise InputError("figure4: give at least one run")
    if len(marks) != len(runs):
        raise InputError(f"figure4: {len(runs)} runs, but {len(marks)} sets of marks")
    kinds = [str(run.attrs.get("type") or "") for run in runs]
    colour = type_style(kinds)[kinds[0]]["color"]
    thin = {"color": colour, "lw": 0.8, "alpha": max(0.35, 0.9 / np.sqrt(len(runs)))}
    dot = {"marker": "o", "ls": "none", "ms": 3.5, "mfc": HIGHLIGHT, "mec": "black", "mew": 0.4, "zorder": 5}

    title = f"{_cell(runs)}, {plural(len(runs), 'grain')}\n{drive_text(drive_of(runs) if drive is None else drive)}"
    figure = new_figure(ONE_COLUMN, 1.5 * ONE_COLUMN, title)
    top, middle, bottom = figure.subplots(3, 1, sharex=True)
    mass_power, mass_unit = power_of_ten([run.attrs["initial_mass"] for run in runs])
    stress_power, stress_unit = power_of_ten(np.concatenate([run["total_stress"].values for run in runs]))
    for run, mark in zip(runs, marks, strict=True):
        omega = run["omega"].values
        lost = 1 - LOSS
        top.plot(omega, run["mass"].values / 10.0**mass_power, **thin)
        top.plot(mark["omega_mass_75"], lost * run.attrs["initial_mass"] / 10.0**mass_power, **dot)
        middle.plot(omega, run["n_contacts"].values, **thin)
        middle.plot(mark["omega_contacts_75"], lost * run.attrs["initial_n_contacts"], **dot)
        bottom.plot(omega, run["total_stress"].values / 10.0**stress_power, **thin)
        bottom.plot(mark["omega_disr"], mark["stress_peak"] / 10.0**stress_power, **dot)

    dots = {top: "25 % of the mass lost", middle: "25 % of the contacts lost", bottom: "peak stress"}
    for axes, text in dots.items():
        axes.set_title(f"dots: {text}", loc="right", fontsize=7.5, pad=2)
        axes.set_ylim(bottom=0)
    top.set_ylabel(rf"mass $M$ [{mass_unit}kg]")
    middle.set_ylabel(r"contacts $N_\mathrm{con}$")
    bottom.set_ylabel(rf"total stress $\sigma_\Sigma$ [{stress_unit}Pa]")
    bottom.set_xlabel(r"angular velocity $\omega$ [rad s$^{-1}$]")
    bottom.set_xscale("log")
    bottom.set_xlim(*_omega_limits(runs, marks))
    logarithmic(bottom.xaxis)
    middle.set_ylim(top=1.25 * middle.get_ylim()[1])  # room for the arrow
    _point_at_peak(middle, runs, marks)
    return figure


def _cell(runs):
    """Name of the cell, several values joined."""

    def joined(name, text):
        return ", ".join(sorted({text(run.attrs[name]) for run in runs if run.attrs.get(name) not in (None, "")}))

    sizes = joined("a_eff", lambda size: f"{float(size) / NM:.4g} nm")
    return " ".join(part for part in (joined("material", str), joined("type", str), sizes) if part) or "grains"


def _omega_limits(runs, marks):
    """From a third of the first loss of mass, or else a hundredth of the end, to the end of the last run."""
    end = max(run["omega"].values.max() for run in runs)
    first = [float(mark["omega_first_loss"]) for mark in marks]
    first = [omega for omega in first if np.isfinite(omega) and omega > 0]
    return (min(first) / 3 if first else end / 100), 1.1 * end


def _point_at_peak(axes, runs, marks):
    """Arrow at the peak of the number of contacts of the grain that gains most, or a remark that none gains any."""
    gain = [
        float(mark["n_contacts_max"]) / run.attrs["initial_n_contacts"] - 1
        for run, mark in zip(runs, marks, strict=True)
    ]
    k = int(np.argmax(gain))
    if gain[k] <= 0:
        axes.text(0.97, 0.93, "no grain gains contacts", transform=axes.transAxes, ha="right", va="top", color=GREY)
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
