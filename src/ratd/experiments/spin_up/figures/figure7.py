"""Fig. 7: the angular velocity of disruption against size."""

import numpy as np
from matplotlib.legend_handler import HandlerTuple
from matplotlib.lines import Line2D

from ratd.base.materials import Material, get_material
from ratd.base.words import plural
from ratd.experiments.spin_up.cells import cell_statistics
from ratd.experiments.spin_up.eq33 import eq33, radius_of_reading
from ratd.experiments.spin_up.printed import PAPER_MEAN_RADIUS, TABLE_3
from ratd.experiments.spin_up.run_files import read_fit, read_grown, read_table
from ratd.pictures.style import (
    GREY,
    ONE_COLUMN,
    TWO_COLUMNS,
    drive_of,
    drive_text,
    empty,
    logarithmic,
    mean_and_range,
    nanometres,
    new_figure,
    offsets,
    size_limits,
    sizes_label,
    styled,
    type_style,
)

BOUND = {"lw": 0.7, "ls": (0, (3, 2)), "ms": 2.8, "mfc": "white", "mew": 0.6}
PRINTED = {"color": GREY, "lw": 0.8, "ms": 2.8, "mfc": "white", "mew": 0.6, "zorder": 1}
"""Lines with open markers, which tell the types apart."""


@styled
def figure7(table, fit=None, drive=None, materials=None, grown=None):
    """omega_disr against size, a panel per material, with the fit of Eq. 33, the cut bound and Table 3 (Fig. 7).

    Parameters
    ----------
    table : pandas.DataFrame
        What `grain_table` returns.
    fit : xarray.Dataset, optional
        What `eq33.fit_ensemble` returns; its first reading of <a_mon> is drawn, where there is a fit.
    drive : str, optional
        Named in the title; default: what the table says.
    materials : optional
        Table of materials, handed to `ratd.base.materials.get_material`.
    grown : pandas.DataFrame, optional
        All grains as grown, also those that were not spun up, for what needs no spin-up; default: those of `table`.

    Returns
    -------
    matplotlib.figure.Figure
        Means as filled markers, minima to maxima as bars; fit as solid lines. Of the grown grains the mean cut bound as
        dashed lines, and Eq. 33 with the printed A and alpha (Table 3, <a_mon> = 20 nm) and their N_con phi as grey
        lines, both with open markers. The legend says how many these are.

    References
    ----------
    Reissl et al. (2024), A&A 692, A60, Fig. 7 and Table 3.
    """
    drive = drive_of(table) if drive is None else drive
    n = int(table["omega_disr"].notna().sum())
    grown = table if grown is None else grown
    cells, at_rest = _cells(table), _cells(grown)
    names = list(dict.fromkeys(cells["material"])) or [""]
    wide = len(names) > 1
    title = f"{plural(n, 'disrupted grain')}, {drive_text(drive)}"
    figure = new_figure(TWO_COLUMNS if wide else ONE_COLUMN, 0.56 * TWO_COLUMNS, title)
    style = type_style(cells["type"])
    shifts = dict(zip(style, offsets(cells["a_eff"], len(style)), strict=True)) if len(cells) else {}
    panels = figure.subplots(1, len(names), sharex=True, sharey=True, squeeze=False)[0]
    for axes, name in zip(panels, names, strict=True):
        axes.set_title(name)
        axes.set_yscale("log")
        axes.set_xlabel(sizes_label())
        here = cells[cells["material"] == name]
        if not here["omega_disr_count"].any():
            empty(axes, "no disrupted grains")
        for kind, look in style.items():
            cell = here[here["type"] == kind]
            if not len(cell):
                continue
            material = get_material(name, materials)
            x = nanometres(cell["a_eff"])
            mean_and_range(axes, x + nanometres(shifts[kind]), cell, "omega_disr", look)
            rest = at_rest[(at_rest["material"] == name) & (at_rest["type"] == kind)]
            axes.plot(nanometres(rest["a_eff"]), rest["cut_bound_mean"], **look | BOUND)
            if fit is not None and name in fit["material"].values and kind in fit["type"].values:
                reading = fit["mean_radius"].values[0]
                best = fit.sel(mean_radius=reading, material=name, type=kind)
                radius = radius_of_reading(reading) or np.exp(cell["log_radius_mean"])
                line = _line(cell, material, radius, float(best["A"]), float(best["alpha"]))
                axes.plot(x, line, color=look["color"], lw=1.0)
            if (name, kind) in TABLE_3:
                line = _line(rest, material, PAPER_MEAN_RADIUS, *TABLE_3[name, kind])
                axes.plot(nanometres(rest["a_eff"]), line, **look | PRINTED)
    logarithmic(panels[0].yaxis)
    panels[0].set_ylabel(r"$\omega_\mathrm{disr}$ [rad s$^{-1}$]")
    if len(cells):
        panels[0].set_xlim(*nanometres(size_limits(cells["a_eff"])))
    _legend(figure, style, len(grown), wide)
    return figure


def _cells(table):
    """Statistics per cell, with those of the logarithms that Eq. 33 needs."""
    return cell_statistics(
        table.assign(
            log_contacts=_log(table["n_contacts"] * table["filling_factor"]),
            log_radius=_log(table["mean_monomer_radius"]),
        )
    )


def _log(values):
    """Logarithm, NaN where it has none."""
    values = np.asarray(values, dtype=float)
    return np.log(values, out=np.full(values.shape, np.nan), where=values > 0)


def _line(cell, material, radius, A, alpha):
    """Eq. 33 at the sizes of the cells, with their geometric mean of N_con phi."""
    contacts = np.exp(cell["log_contacts_mean"])
    return eq33(cell["a_eff"], material.surface_energy, material.density, radius, contacts, 1.0, A, alpha)


def _legend(figure, style, n_grown, wide):
    """One legend for all panels: types, then kinds of line, those with markers once for each type."""

    def each_type(line):
        return tuple(Line2D([], [], **look | line) for look in style.values())

    entries = {kind: Line2D([], [], ls="none", **look) for kind, look in style.items()}
    entries["fit of Eq. 33"] = Line2D([], [], color="black", lw=1.0)
    entries[f"mean cut bound of {plural(n_grown, 'grown grain')}"] = each_type(BOUND)
    entries["Eq. 33 with Table 3 as printed"] = each_type(PRINTED)
    figure.legend(
        entries.values(),
        entries.keys(),
        handler_map={tuple: HandlerTuple(ndivide=None, pad=0.0)},
        handlelength=4.5,
        loc="outside lower center",
        ncols=3 if wide else 1,
    )


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return figure7(
        read_table(files["table"]),
        read_fit(files["fit"]),
        drive=settings["drive"],
        materials={name: Material(**constants) for name, constants in settings["materials"].items()},
        grown=read_grown(files["grown"]),
    )
