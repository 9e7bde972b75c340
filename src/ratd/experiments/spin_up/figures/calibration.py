"""Where the literal drive starts to take a grain apart, against d omega/dt."""

import itertools

import numpy as np
from matplotlib.lines import Line2D

from ratd.base.errors import InputError
from ratd.base.words import plural
from ratd.experiments.spin_up.calibration import CALIBRATION_COLUMNS, FIT_VALUES, ONSET, PRINTED_STEP, same_rate
from ratd.pictures.snapshots import drive_text
from ratd.pictures.style import GREY, ONE_COLUMN, bar_lengths, logarithmic, nanometres, new_figure, styled
from ratd.pipeline import io

RUN, FIT = "#0072B2", "#D55E00"
STEP_MARKERS = "so^Dv"
"""Of the step factors, the shortest first; the first ones come again where there are more."""
SPREAD = 1.02
"""Factor between the places of runs with the same d omega/dt."""


@styled
def calibration(table, fit):
    """Onset of mass loss against d omega/dt, its fit, and the d omega/dt that gives the wanted onset.

    Parameters
    ----------
    table : pandas.DataFrame
        From `calibration.calibration_table`.
    fit : xarray.Dataset
        From `calibration.calibrate`.

    Returns
    -------
    matplotlib.figure.Figure
        A marker a run where 1 % of the mass is lost, of a form a step factor, with a bar from the first loss of mass to
        the loss of 25 %; thin lines join the runs of a grain. Runs with the same d omega/dt stand side by side about a
        line at it, in the order of grains and steps.

    Raises
    ------
    InputError
        If there are no runs.
    """
    if not len(table):
        raise InputError("calibration: give at least one run")
    first = table.iloc[0]
    runs = f"{plural(len(table), 'run')} of {plural(table['seed'].nunique(), 'grain')}"
    cell = f"{first['material']} {first['type']} {nanometres(first['a_eff']):.0f} nm"
    rates = plural(same_rate(table["printed_acceleration"]).nunique(), "rate")
    figure = new_figure(ONE_COLUMN, 0.95 * ONE_COLUMN, f"{cell}, {runs} at {rates}\n{drive_text('literal')}")
    axes = figure.subplots()
    for rate in same_rate(table["printed_acceleration"]).unique():
        axes.axvline(rate, color="0.88", lw=0.8, zorder=0)
    handles = _runs(axes, table.assign(place=_side_by_side(table)))
    onset, exponent, calibrated = (float(fit[name]) for name in ("omega_onset", "exponent", "calibrated"))
    handles.append(axes.axhline(onset, color=GREY, lw=0.8, ls="--", label="paper, Fig. 4"))
    if np.isfinite(calibrated):
        rates = table["printed_acceleration"]
        # Straight in these axes. More points would be thinned out by their last bits, which differ between processors.
        x = np.array([min(calibrated, rates.min()), max(calibrated, rates.max())])
        text = rf"fit, $(\mathrm{{d}}\omega/\mathrm{{d}}t)^{{{exponent:.2f}}}$"
        handles += axes.plot(x, onset * (x / calibrated) ** exponent, color=FIT, lw=1.0, label=text)
        low, high = float(fit["calibrated_low"]), float(fit["calibrated_high"])
        error = [[calibrated - low], [high - calibrated]] if np.isfinite([low, high]).all() else None
        look = {"color": "black", "marker": "D", "ms": 4, "elinewidth": 0.8, "capsize": 2, "ls": "none", "zorder": 4}
        handles.append(axes.errorbar(calibrated, onset, xerr=error, label=f"calibrated: {_power(calibrated)}", **look))
    axes.set_xscale("log")
    axes.set_yscale("log")
    logarithmic(axes.xaxis, least=0.3)
    logarithmic(axes.yaxis, least=0.2)
    axes.set_xlabel(rf"$\mathrm{{d}}\omega/\mathrm{{d}}t$ at the printed step, $f$ = {PRINTED_STEP:g} [rad s$^{{-2}}$]")
    axes.set_ylabel(r"$\omega$ of 1 % mass loss [rad s$^{-1}$]")
    figure.legend(handles=handles, loc="outside lower center", ncols=2)
    return figure


def _runs(axes, table):
    """Draw the runs; returns entries of the legend."""
    for _, grain in table.groupby("seed"):
        grain = grain[grain[ONSET].notna()].sort_values("printed_acceleration")
        axes.plot(grain["place"], grain[ONSET], color=RUN, lw=0.5, zorder=1)
    look = {"color": RUN, "ls": "none", "elinewidth": 0.8, "capsize": 2, "ms": 3.5, "zorder": 3}
    handles = []
    for factor, marker in zip(sorted(table["timestep_factor"].unique()), itertools.cycle(STEP_MARKERS), strict=False):
        here = table[(table["timestep_factor"] == factor) & table[ONSET].notna()]
        ends = (here[name].fillna(here[ONSET]) for name in ("omega_first_loss", "omega_mass_75"))
        axes.errorbar(here["place"], here[ONSET], bar_lengths(here[ONSET], *ends), marker=marker, **look)
        handles.append(Line2D([], [], color=RUN, ls="none", marker=marker, ms=3.5, label=f"run with $f$ = {factor:g}"))
    handles.append(Line2D([], [], color=RUN, ls="none", marker="|", ms=9, label="first loss to 25 % lost"))
    return handles


def _side_by_side(table):
    """d omega/dt of each run, moved a little so that those with the same one can be told apart."""
    x = table["printed_acceleration"]
    same = same_rate(x)
    order = table.sort_values(["seed", "timestep_factor"]).groupby(same).cumcount()
    return x * SPREAD ** (order - (same.map(same.value_counts()) - 1) / 2)


def _power(value):
    """An angular acceleration in words."""
    digits, exponent = f"{value:.1e}".split("e")
    return rf"${digits}\times10^{{{int(exponent)}}}$ rad s$^{{-2}}$"


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    file = io.read(files["fit"], "calibration")
    return calibration(file[list(CALIBRATION_COLUMNS)].to_dataframe(), file[list(FIT_VALUES)])
