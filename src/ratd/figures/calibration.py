"""Where the literal drive starts to take a grain apart, against d omega/dt."""

import numpy as np

from ratd.calibration import MARKS, ONSET, PRINTED_STEP
from ratd.errors import InputError
from ratd.figures.style import GREY, ONE_COLUMN, logarithmic, nanometres, new_figure, plural, styled

LOOK = {
    "omega_first_loss": {"color": "#0072B2", "marker": "o", "mfc": "none", "ms": 7},
    "omega_mass_99": {"color": "#D55E00", "marker": "s", "ms": 3.5},
    "omega_mass_75": {"color": "#009E73", "marker": "^", "mfc": "none", "ms": 4.5},
}


@styled
def calibration(table, fit):
    """Marks of mass loss against d omega/dt, the fit of the onset, and the d omega/dt that gives the wanted onset.

    Parameters
    ----------
    table : pandas.DataFrame
        From `ratd.calibration.calibration_table`.
    fit : xarray.Dataset
        From `ratd.calibration.calibrate`.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If there are no runs.
    """
    if not len(table):
        raise InputError("calibration: give at least one run")
    first = table.iloc[0]
    grains = plural(table["seed"].nunique(), "grain")
    title = (
        f"{first['material']} {first['type']} {nanometres(first['a_eff']):.0f} nm, {grains}, drive: literal, "
        "f = " + ", ".join(f"{f:g}" for f in sorted(table["timestep_factor"].unique()))
    )
    figure = new_figure(ONE_COLUMN, 0.95 * ONE_COLUMN, title)
    axes = figure.subplots()
    for name, meaning in MARKS.items():
        there = table[table[name].notna()]
        axes.plot(there["printed_acceleration"], there[name], ls="none", label=meaning, **LOOK[name])
    onset, exponent, calibrated = (float(fit[name]) for name in ("omega_onset", "exponent", "calibrated"))
    axes.axhline(onset, color=GREY, lw=0.8, ls="--", label="onset in Fig. 4 of the paper")
    if np.isfinite(calibrated):
        rates = table["printed_acceleration"]
        x = np.geomspace(min(calibrated, rates.min()), rates.max(), 50)
        axes.plot(x, onset * (x / calibrated) ** exponent, color=LOOK[ONSET]["color"], lw=0.8,
                  label=rf"fit, $\dot\omega^{{{exponent:.2f}}}$")  # fmt: skip
        low, high = float(fit["calibrated_low"]), float(fit["calibrated_high"])
        error = [[calibrated - low], [high - calibrated]] if np.isfinite([low, high]).all() else None
        axes.errorbar(calibrated, onset, xerr=error, color="black", marker="D", ms=4, lw=0.8, capsize=2, ls="none",
                      label=f"calibrated: {_power(calibrated)}")  # fmt: skip
    axes.set_xscale("log")
    axes.set_yscale("log")
    logarithmic(axes.xaxis)
    logarithmic(axes.yaxis)
    scaled = "" if set(table["timestep_factor"]) == {PRINTED_STEP} else rf" \times\ {PRINTED_STEP:g}/f"
    axes.set_xlabel(rf"$\mathrm{{d}}\omega/\mathrm{{d}}t{scaled}$ [rad s$^{{-2}}$]")
    axes.set_ylabel(r"$\omega$ [rad s$^{-1}$]")
    figure.legend(loc="outside lower center", ncols=2)
    return figure


def _power(value):
    """An angular acceleration in words."""
    digits, exponent = f"{value:.1e}".split("e")
    return rf"${digits}\times10^{{{int(exponent)}}}$ rad s$^{{-2}}$"
