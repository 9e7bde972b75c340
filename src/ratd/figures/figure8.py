"""Fig. 8: the angular velocity of disruption against what tensile strengths predict."""

import numpy as np
import pandas as pd

from ratd.bound import tensile_strength_tatsuuma2019
from ratd.ensemble import cell_statistics, size_key
from ratd.figures.style import (
    GREY,
    ONE_COLUMN,
    drive_of,
    drive_text,
    empty,
    logarithmic,
    mean_and_range,
    nanometres,
    new_figure,
    plural,
    size_limits,
    sizes_label,
    styled,
    type_style,
)
from ratd.materials import get_material
from ratd.tensile import SCALINGS, eq27
from ratd.units import NM

LINES = {"G95": "-", "S13 low": "--", "S13 high": ":", "T19": "-.", "T19 fractal": (0, (5, 1, 1, 1, 1, 1))}
AT_REST = ("n_contacts", "n_monomers", "filling_factor", "fractal_dimension", "mean_monomer_radius")
"""What the strengths depend on."""
ABSOLUTE = {"color": "#000000", "lw": 0.8, "label": r"T19: $0.951\,\gamma\phi^{1.8}/a_\mathrm{mon}$, not scaled"}


def predictions(cells, material, scaled_at, grown=None):
    """omega [rad s-1] of Eq. 27 for each cell, with the strengths of the literature.

    Parameters
    ----------
    cells : pandas.DataFrame
        What `ratd.ensemble.cell_statistics` returns, of one material and type.
    material : ratd.Material
    scaled_at : float
        Size a_eff [m] at which a strength that is known up to a factor is scaled to the mean omega_disr of the cell.
    grown : pandas.DataFrame, optional
        Table of grains as grown, of all cells or more, which N_con, N_mon, phi, a_mon and D_f are taken from; default:
        the means in `cells`.

    Returns
    -------
    curves : pandas.DataFrame
        A column a model, a row a cell: those of `ratd.tensile.SCALINGS`, scaled, and "absolute", the strength of
        Tatsuuma et al. 2019 as it stands, with the mean monomer radius of the cell. NaN where a cell lacks a value.
    anchor : dict of str to float
        Size [m] at which each was scaled: the nearest to `scaled_at` at which both are known; NaN if there is none.

    Notes
    -----
    Strengths are those of the mean N_con/N_mon and phi and of one D_f of a cell: a mean over strengths of single grains
    would rest on the few with D_f near 3, where the exponent 2/(3 - D_f) has no bound. With `grown`, D_f is the median
    of those below 3: no body in space has more, such a value comes from a fit to few monomers.
    """
    size = cells["a_eff"].to_numpy(float)
    found = cells["omega_disr_mean"].to_numpy(float)
    at_rest = _at_rest(cells, grown)
    phi, dimension, radius = (at_rest[name] for name in ("filling_factor", "fractal_dimension", "mean_monomer_radius"))
    contacts = at_rest["n_contacts"] / at_rest["n_monomers"]
    curves, anchor = {}, {}
    for name, (_, strength) in SCALINGS.items():
        shape = eq27(size, strength(contacts, phi, dimension), material.density)
        known = np.flatnonzero(np.isfinite(shape) & np.isfinite(found))
        if not len(known):
            curves[name], anchor[name] = np.full(len(size), np.nan), np.nan
            continue
        k = known[np.argmin(np.abs(size[known] - scaled_at))]
        curves[name], anchor[name] = shape * (found[k] / shape[k]), size[k]
    strength = tensile_strength_tatsuuma2019(material.surface_energy, radius, phi)
    curves["absolute"] = eq27(size, strength, material.density)
    return pd.DataFrame(curves, index=cells.index), anchor


def _at_rest(cells, grown):
    """Name of `AT_REST` -> its value in each cell, see `predictions`."""
    if grown is None:
        return {name: cells[f"{name}_mean"].to_numpy(float) for name in AT_REST}
    keys = ["material", "type", "size"]
    possible = grown["fractal_dimension"].where(grown["fractal_dimension"] < 3)
    groups = grown.assign(size=size_key(grown["a_eff"]), fractal_dimension=possible).groupby(keys)
    wanted = pd.MultiIndex.from_frame(cells.assign(size=size_key(cells["a_eff"]))[keys])
    found = groups[list(AT_REST)].mean().reindex(wanted)
    found["fractal_dimension"] = groups["fractal_dimension"].median()
    return {name: found[name].to_numpy(float) for name in AT_REST}


@styled
def figure8(table, material="co-S", kind="BAM2", scaled_at=100e-9, drive=None, materials=None, grown=None):
    """omega_disr of one material and type against size, beside Eq. 27 with tensile strengths (Fig. 8).

    Parameters
    ----------
    table : pandas.DataFrame
        What `ratd.ensemble.grain_table` returns.
    material, kind : str
        Which grains.
    scaled_at : float
        See `predictions` [m].
    drive : str, optional
        Named in the title; default: what the table says.
    materials : optional
        Table of materials, handed to `ratd.materials.get_material`.
    grown : pandas.DataFrame, optional
        All grains as grown, also those that were not spun up: see `predictions`; default: those of `table`.

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
