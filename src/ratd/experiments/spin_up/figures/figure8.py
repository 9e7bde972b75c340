"""Fig. 8: the angular velocity of disruption against what tensile strengths predict."""

import numpy as np

from ratd.base.materials import Material, get_material
from ratd.base.units import NM
from ratd.base.words import plural
from ratd.experiments.spin_up.cells import cell_statistics
from ratd.experiments.spin_up.eq33 import eq33_omega, fitted_numbers, radius_of_reading
from ratd.experiments.spin_up.printed import PAPER_MEAN_RADIUS, TABLE_3
from ratd.experiments.spin_up.run_files import read_fit, read_grown, read_table
from ratd.experiments.spin_up.tensile import predictions
from ratd.experiments.spin_up.figures.style import mean_and_range, size_limits, sizes_label, type_style
from ratd.pictures.snapshots import drive_of, drive_text
from ratd.pictures.style import GREY, ONE_COLUMN, empty, label_ends, logarithmic, nanometres, new_figure, styled

BAND = ("S13 low", "T19", "S13 high")
"""Powers of phi from 1.6 to 1.9, which make one band."""
LINES = {
    "G95": (r"G95: $\langle N_\mathrm{con}\rangle\phi$", {"color": GREY, "ls": "-"}),
    "T19 fractal": (r"T19: $\phi^{2/(3-D_\mathrm{f})}$", {"color": GREY, "ls": (0, (1, 1))}),
    "absolute": ("T19, not scaled", {"color": "#000000", "ls": "-"}),
}
"""Lines of tensile strengths, with their names."""


@styled
def figure8(table, material="co-S", kind="BAM2", scaled_at=100e-9, drive=None, materials=None, grown=None, fit=None):
    """omega_disr of one material and type against size, beside Eq. 27 with tensile strengths and Eq. 33 (Fig. 8).

    Parameters
    ----------
    table : pandas.DataFrame
        What `grain_table` returns.
    material, kind : str
        Which grains.
    scaled_at : float
        See `tensile.predictions` [m].
    drive : str, optional
        Named in the title; default: what the table says.
    materials : optional
        Table of materials, handed to `ratd.base.materials.get_material`.
    grown : pandas.DataFrame, optional
        All grains as grown, also those that were not spun up: see `tensile.predictions`; default: those of
        `table`.
    fit : xarray.Dataset, optional
        What `eq33.fit_ensemble` returns; its first reading of <a_mon> is drawn, where there is a fit.

    Returns
    -------
    matplotlib.figure.Figure
        Means as markers, minima to maxima as bars. Grey are the strengths that are scaled: powers of phi from 1.6 to
        1.9 as a band; black that which is not. Of the colour of the grains, Eq. 33 as fitted (solid) and with the
        printed Table 3 (dashed), geometric means over the grown grains. The names stand at the ends of the lines.

    References
    ----------
    Reissl et al. (2024), A&A 692, A60, Fig. 8.
    """
    drive = drive_of(table) if drive is None else drive
    grown = table if grown is None else grown
    table, grown = (every[(every["material"] == material) & (every["type"] == kind)] for every in (table, grown))
    n = int(table["omega_disr"].notna().sum())
    title = f"{material} {kind}, {plural(n, 'disrupted grain')}, {drive_text(drive)}"
    title += f"\nlines: {plural(len(grown), 'grown grain')}"
    figure = new_figure(ONE_COLUMN, 1.05 * ONE_COLUMN, title)
    axes = figure.subplots()
    axes.set_yscale("log")
    axes.set_xlabel(sizes_label())
    axes.set_ylabel(r"$\omega_\mathrm{disr}$ [rad s$^{-1}$]")
    if not len(table):
        empty(axes)
        return figure
    cells = cell_statistics(table)
    look = type_style([kind])[kind]
    ends = _strengths(axes, cells, get_material(material, materials), scaled_at, grown)
    ends += _eq33(axes, grown, (material, kind), fit, look["color"], materials)
    if n:
        mean_and_range(axes, nanometres(cells["a_eff"]), cells, "omega_disr", look)
    logarithmic(axes.yaxis)
    axes.set_xlim(*nanometres(size_limits(cells["a_eff"])))
    label_ends(axes, ends, apart=0.068, at=1.06, end=nanometres(cells["a_eff"].iloc[-1]))
    return figure


def _strengths(axes, cells, constants, scaled_at, grown):
    """Eq. 27 with tensile strengths; returns the ends of the lines for `label_ends`."""
    curves, anchor = predictions(cells, constants, scaled_at, grown)
    x = nanometres(cells["a_eff"])
    lone = {"marker": "_"} if len(cells) == 1 else {}
    ends = []
    for name, (text, look) in LINES.items():
        axes.plot(x, curves[name], lw=0.9, **look, **lone)
        ends.append((text + _where(anchor.get(name, scaled_at), scaled_at), curves[name].iloc[-1], look["color"]))
    band = curves[list(BAND)]
    if band.notna().any(axis=None):
        axes.fill_between(x, band.min(axis=1), band.max(axis=1), color=GREY, alpha=0.45, lw=0.6)
        text = r"S13, T19: $\phi^{1.6...1.9}$" + _where(anchor["T19"], scaled_at)
        ends.append((text, band.iloc[-1].mean(), GREY))
    return ends


def _where(anchor, wanted):
    """Where a line is scaled, if it is elsewhere than wanted [m]."""
    known = np.isfinite(anchor) and abs(anchor - wanted) >= 0.5 * NM
    return f"\n(scaled at {nanometres(anchor):g} nm)" if known else ""


def _eq33(axes, grown, cell, fit, colour, materials):
    """Eq. 33 as fitted and as printed, geometric means over the grown grains; returns the ends of the lines."""
    laws = {}
    if cell in TABLE_3:
        laws["Eq. 33 as printed"] = ("--", {cell: TABLE_3[cell]}, PAPER_MEAN_RADIUS)
    if fit is not None and cell[0] in fit["material"].values and cell[1] in fit["type"].values:
        reading = fit["mean_radius"].values[0]
        laws["Eq. 33 fitted"] = ("-", fitted_numbers(fit, reading), radius_of_reading(reading))
    ends = []
    for text, (line, numbers, radius) in laws.items():
        own = grown.assign(log_omega=np.log(eq33_omega(grown, numbers, radius, materials)))
        mean = cell_statistics(own[["material", "type", "a_eff", "log_omega"]])
        axes.plot(nanometres(mean["a_eff"]), np.exp(mean["log_omega_mean"]), color=colour, ls=line, lw=1.0, zorder=1)
        ends.append((text, float(np.exp(mean["log_omega_mean"].iloc[-1])), colour))
    return ends


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    materials = {name: Material(**constants) for name, constants in settings["materials"].items()}
    which = settings["material"], settings["type"], settings["scaled_at"], settings["drive"]
    return figure8(read_table(files["table"]), *which, materials, read_grown(files["grown"]), read_fit(files["fit"]))
