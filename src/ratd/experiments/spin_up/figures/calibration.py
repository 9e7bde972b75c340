"""Where the literal drive starts to take a grain apart, against d omega/dt."""

import numpy as np

from ratd.base.errors import InputError
from ratd.base.words import plural
from ratd.experiments.spin_up.calibration import CALIBRATION_COLUMNS, FIT_VALUES, MARKS, ONSET, PRINTED_STEP, same_rate
from ratd.pictures.style import GREY, ONE_COLUMN, logarithmic, nanometres, new_figure, styled
from ratd.pipeline import io

LOOK = {
    "omega_first_loss": {"color": "#0072B2", "marker": "o", "mfc": "none", "ms": 7},
    "omega_mass_99": {"color": "#D55E00", "marker": "s", "ms": 3.5},
    "omega_mass_75": {"color": "#009E73", "marker": "^", "mfc": "none", "ms": 4.5},
}
SPREAD = 1.014
"""Factor between the places of runs with the same d omega/dt."""


@styled
def calibration(table, fit):
    """Marks of mass loss against d omega/dt, the fit of the onset, and the d omega/dt that gives the wanted onset.

    Parameters
    ----------
    table : pandas.DataFrame
        From `calibration.calibration_table`.
    fit : xarray.Dataset
        From `calibration.calibrate`.

    Returns
    -------
    matplotlib.figure.Figure
        The marks of runs with the same d omega/dt stand side by side about a line at it, in the order of grains and
        steps.

    Raises
    ------
    InputError
        If there are no runs.
    """
    if not len(table):
        raise InputError("calibration: give at least one run")
    first = table.iloc[0]
    runs = f"{plural(len(table), 'run')} of {plural(table['seed'].nunique(), 'grain')}"
    steps = ", ".join(f"{f:g}" for f in sorted(table["timestep_factor"].unique()))
    cell = f"{first['material']} {first['type']} {nanometres(first['a_eff']):.0f} nm"
    figure = new_figure(ONE_COLUMN, ONE_COLUMN, f"{cell}, {runs}\ndrive: literal, f = {steps}")
    axes = figure.subplots()
    for rate in same_rate(table["printed_acceleration"]).unique():
        axes.axvline(rate, color="0.85", lw=0.8, zorder=0)
    places = _side_by_side(table)
    for name, meaning in MARKS.items():
        there = table[name].notna()
        axes.plot(places[there], table.loc[there, name], ls="none", label=meaning, **LOOK[name])
    onset, exponent, calibrated = (float(fit[name]) for name in ("omega_onset", "exponent", "calibrated"))
    axes.axhline(onset, color=GREY, lw=0.8, ls="--", label="onset in Fig. 4 of the paper")
    if np.isfinite(calibrated):
        rates = table["printed_acceleration"]
        # Straight in these axes. More points would be thinned out by their last bits, which differ between processors.
        x = np.array([min(calibrated, rates.min()), max(calibrated, rates.max())])
        axes.plot(x, onset * (x / calibrated) ** exponent, color=LOOK[ONSET]["color"], lw=0.8,
                  label=rf"fit, $(\mathrm{{d}}\omega/\mathrm{{d}}t)^{{{exponent:.2f}}}$")  # fmt: skip
        low, high = float(fit["calibrated_low"]), float(fit["calibrated_high"])
        error = [[calibrated - low], [high - calibrated]] if np.isfinite([low, high]).all() else None
        axes.errorbar(calibrated, onset, xerr=error, color="black", marker="D", ms=4, lw=0.8, capsize=2, ls="none",
                      zorder=3, label=f"calibrated: {_power(calibrated)}")  # fmt: skip
    axes.set_xscale("log")
    axes.set_yscale("log")
    logarithmic(axes.xaxis, least=0.3)
    logarithmic(axes.yaxis, least=0.4)
    scaled = "" if set(table["timestep_factor"]) == {PRINTED_STEP} else rf" \times\ {PRINTED_STEP:g}/f"
    axes.set_xlabel(rf"$\mathrm{{d}}\omega/\mathrm{{d}}t{scaled}$ [rad s$^{{-2}}$]")
    axes.set_ylabel(r"$\omega$ [rad s$^{-1}$]")
    figure.legend(loc="outside lower center", ncols=2)
    return figure


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
