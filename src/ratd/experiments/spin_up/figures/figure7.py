"""Fig. 7: the angular velocity of disruption against size."""

import numpy as np
from matplotlib.lines import Line2D

from ratd.base.materials import Material, get_material
from ratd.base.words import plural
from ratd.experiments.spin_up.cells import cell_statistics
from ratd.experiments.spin_up.eq33 import eq33, eq33_omega, radius_of_reading
from ratd.experiments.spin_up.printed import PAPER_MEAN_RADIUS, TABLE_3
from ratd.experiments.spin_up.run_files import read_fit, read_grown, read_table
from ratd.experiments.spin_up.figures.style import (
    mean_and_range,
    middle_and_most,
    offsets,
    open_markers,
    size_limits,
    sizes_label,
    type_style,
)
from ratd.pictures.snapshots import drive_of, drive_text
from ratd.pictures.style import ONE_COLUMN, TWO_COLUMNS, empty, logarithmic, nanometres, new_figure, styled

FIT = {"lw": 1.0, "ls": "-", "zorder": 1}
PRINTED = {"lw": 0.9, "ls": (0, (4, 2)), "zorder": 1}


@styled
def figure7(table, fit=None, drive=None, materials=None, grown=None):
    """omega_disr against size, a column a material, and below over what the paper has for the same grain (Fig. 7).

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
        Above, means as markers, minima to maxima as bars; the fit solid; dashed, with the type's open marker, Eq. 33
        with the printed A and alpha (Table 3, <a_mon> = 20 nm) for the N_con phi of the grown grains, of which the
        legend says how many. Below, medians and the middle two thirds of omega_disr over that Eq. 33 for each grain
        itself, where Table 3 has it.

    References
    ----------
    Reissl et al. (2024), A&A 692, A60, Fig. 7 and Table 3.
    """
    drive = drive_of(table) if drive is None else drive
    n = int(table["omega_disr"].notna().sum())
    grown = table if grown is None else grown
    cells, at_rest = _cells(table), _cells(grown)
    table = table.assign(ratio=table["omega_disr"] / eq33_omega(table, TABLE_3, PAPER_MEAN_RADIUS, materials))
    names = list(dict.fromkeys(cells["material"])) or [""]
    wide = len(names) > 1
    title = f"{plural(n, 'disrupted grain')}, {drive_text(drive)}"
    figure = new_figure(TWO_COLUMNS if wide else ONE_COLUMN, 0.78 * TWO_COLUMNS, title)
    style = type_style(cells["type"])
    shifts = dict(zip(style, offsets(cells["a_eff"], len(style)), strict=True)) if len(cells) else {}
    panels = figure.subplots(2, len(names), sharex=True, sharey="row", squeeze=False, height_ratios=[3, 2])
    for (top, bottom), name in zip(panels.T, names, strict=True):
        top.set_title(name)
        bottom.set_xlabel(sizes_label())
        for axes in (top, bottom):
            axes.set_yscale("log")
        here = table[table["material"] == name]
        if not here["omega_disr"].notna().any():
            empty(top, "no disrupted grains")
        _absolute(top, *(every[every["material"] == name] for every in (cells, at_rest)), fit, style, shifts, materials)
        if here["ratio"].notna().any():
            bottom.axhline(1.0, color="black", lw=0.6)
            for kind, look in style.items():
                own = here[here["type"] == kind]
                middle_and_most(bottom, own["a_eff"] + shifts[kind], own["ratio"], look)
        else:
            empty(bottom, "no grain that Table 3 has")
    for axes, text in zip(panels[:, 0], (r"$\omega_\mathrm{disr}$ [rad s$^{-1}$]", _RATIO), strict=True):
        axes.set_ylabel(text)
        _label(axes)
    if len(cells):
        panels[0, 0].set_xlim(*nanometres(size_limits(cells["a_eff"])))
    _legend(figure, style, len(grown), wide, fit is not None and bool(np.isfinite(fit["A"]).any()))
    return figure


_RATIO = "over Eq. 33 as printed\nfor the same grain"


def _label(axes):
    """Numbers on the logarithmic axis of y; more of them, and room for those near its ends, on less than a decade."""
    low, high = axes.get_ylim()
    if high < 10 * low:
        axes.set_ylim(low / 1.15, 1.15 * high)
        logarithmic(axes.yaxis, labelled=(2, 3, 5, 7))
    else:
        logarithmic(axes.yaxis)


def _absolute(axes, cells, at_rest, fit, style, shifts, materials):
    """omega_disr of one material [rad/s], with the lines of the fit and of the printed Table 3."""
    for kind, look in style.items():
        cell, rest = (every[every["type"] == kind] for every in (cells, at_rest))
        if not len(cell):
            continue
        name = cell["material"].iloc[0]
        material = get_material(name, materials)
        mean_and_range(axes, nanometres(cell["a_eff"] + shifts[kind]), cell, "omega_disr", look)
        if fit is not None and name in fit["material"].values and kind in fit["type"].values:
            reading = fit["mean_radius"].values[0]
            best = fit.sel(mean_radius=reading, material=name, type=kind)
            radius = radius_of_reading(reading) or np.exp(cell["log_radius_mean"])
            line = _line(cell, material, radius, float(best["A"]), float(best["alpha"]))
            axes.plot(nanometres(cell["a_eff"]), line, color=look["color"], **FIT)
        if (name, kind) in TABLE_3:
            line = _line(rest, material, PAPER_MEAN_RADIUS, *TABLE_3[name, kind])
            axes.plot(nanometres(rest["a_eff"]), line, color=look["color"], **PRINTED)
            open_markers(axes, nanometres(rest["a_eff"]), line, look)


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


def _legend(figure, style, n_grown, wide, fitted):
    """One legend for all panels: types, then kinds of line, that of the fit where there is one."""
    handles = [Line2D([], [], ls="none", label=kind, **look) for kind, look in style.items()]
    if fitted:
        handles.append(Line2D([], [], color="black", label="fit of Eq. 33", **FIT))
    text = f"Eq. 33 with Table 3 as printed, {plural(n_grown, 'grown grain')}"
    handles.append(Line2D([], [], color="black", label=text, **PRINTED))
    figure.legend(handles=handles, handlelength=2.5, loc="outside lower center", ncols=5 if wide else 1)


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return figure7(
        read_table(files["table"]),
        read_fit(files["fit"]),
        drive=settings["drive"],
        materials={name: Material(**constants) for name, constants in settings["materials"].items()},
        grown=read_grown(files["grown"]),
    )
