"""Fig. 8: the angular velocity of disruption against what tensile strengths predict."""

import numpy as np

from ratd.base.materials import Material, get_material
from ratd.base.units import NM
from ratd.base.words import plural
from ratd.experiments.spin_up.cells import cell_statistics
from ratd.experiments.spin_up.run_files import read_grown, read_table
from ratd.experiments.spin_up.tensile import SCALINGS, predictions
from ratd.pictures.style import (
    GREY,
    ONE_COLUMN,
    drive_of,
    drive_text,
    empty,
    logarithmic,
    mean_and_range,
    nanometres,
    new_figure,
    size_limits,
    sizes_label,
    styled,
    type_style,
)

LINES = {"G95": "-", "S13 low": "--", "S13 high": ":", "T19": "-.", "T19 fractal": (0, (5, 1, 1, 1, 1, 1))}
ABSOLUTE = {"color": "#000000", "lw": 0.8, "label": r"T19: $0.951\,\gamma\phi^{1.8}/a_\mathrm{mon}$, not scaled"}


@styled
def figure8(table, material="co-S", kind="BAM2", scaled_at=100e-9, drive=None, materials=None, grown=None):
    """omega_disr of one material and type against size, beside Eq. 27 with tensile strengths (Fig. 8).

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

    Returns
    -------
    matplotlib.figure.Figure
        Means as markers, minima to maxima as bars; scaled predictions grey, the absolute one black. The legend says
        how many grown grains the predictions are for.

    References
    ----------
    Reissl et al. (2024), A&A 692, A60, Fig. 8.
    """
    drive = drive_of(table) if drive is None else drive
    grown = table if grown is None else grown
    table, grown = (every[(every["material"] == material) & (every["type"] == kind)] for every in (table, grown))
    constants = get_material(material, materials)
    n = int(table["omega_disr"].notna().sum())
    title = f"{material} {kind}, {plural(n, 'disrupted grain')}\n{drive_text(drive)}"
    figure = new_figure(ONE_COLUMN, 1.25 * ONE_COLUMN, title)
    axes = figure.subplots()
    axes.set_yscale("log")
    axes.set_xlabel(sizes_label())
    axes.set_ylabel(r"$\omega_\mathrm{disr}$ [rad s$^{-1}$]")
    if not len(table):
        empty(axes)
        return figure
    cells = cell_statistics(table)
    curves, anchor = predictions(cells, constants, scaled_at, grown)
    x = nanometres(cells["a_eff"])
    lone = {"marker": "_"} if len(cells) == 1 else {}
    for name, (text, _) in SCALINGS.items():
        if np.isfinite(anchor[name]):
            where = "" if abs(anchor[name] - scaled_at) < 0.5 * NM else f" (scaled at {nanometres(anchor[name]):g} nm)"
            axes.plot(x, curves[name], color=GREY, ls=LINES[name], label=text + where, **lone)
    axes.plot(x, curves["absolute"], **ABSOLUTE, **lone)
    if n:
        mean_and_range(axes, x, cells, "omega_disr", type_style([kind])[kind], label="mean, minimum to maximum")
    logarithmic(axes.yaxis)
    axes.set_xlim(*nanometres(size_limits(cells["a_eff"])))
    figure.legend(loc="outside lower center", ncols=1, title=f"lines: for {plural(len(grown), 'grown grain')}")
    return figure


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    materials = {name: Material(**constants) for name, constants in settings["materials"].items()}
    which = settings["material"], settings["type"], settings["scaled_at"], settings["drive"]
    return figure8(read_table(files["table"]), *which, materials, read_grown(files["grown"]))
