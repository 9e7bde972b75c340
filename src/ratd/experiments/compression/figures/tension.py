"""Tensile strength of compressed clusters over the formula of others, and what the spin-up of grains implies."""

import numpy as np
import xarray as xr

from ratd.aggregates.strength import TENSILE_FACTOR, tensile_strength_tatsuuma2019
from ratd.base.statistics import mean_of
from ratd.experiments.compression.tension_findings import HELD, in_units, main_pulls, nominal_phi
from ratd.pictures.style import GREY, ONE_COLUMN, TYPE_COLOUR, logarithmic, new_figure, styled
from ratd.pipeline import io
from ratd.pipeline.provenance import together

WAYS = {(1, 0): "one axis", (1, 1): "unloaded first, one axis", (3, 0): "three axes"}
"""Axes that are pulled and whether the box lets go of the cluster before -> what it is called."""
ASIDE = (1.0, 0.92, 1.0, 1.1, 1.21)
"""Factors of the filling factor by which the signs of these ways, and of other numbers, are moved to be seen."""
LOOKS = (("D", "black"), ("D", "white"), ("X", "black"), ("s", GREY), ("v", "white"))
"""Marker and the colour that fills it, of the same."""
TYPE_MARKS = {"BA": ".", "BAM1": "x", "BAM2": "+"}
"""Marker of grains that were spun up."""
WITHIN = 0.15
"""Half the width of the band about the formula."""


@styled
def tension(entries, spun=None):
    """Strength over the formula against the filling factor at the start of the pull, means of the clusters that hold.

    Parameters
    ----------
    entries : xarray.Dataset
        Of the kind ``tension_set``.
    spun : dict, optional
        Grains that were spun up: ``phi``, ``strength``, S a/gamma, and ``type``, (k,) each.
    """
    title = f"tensile strength, N = {main_pulls(entries)[1]} unless told"
    figure = new_figure(ONE_COLUMN, 1.2 * ONE_COLUMN, title)
    axes = figure.subplots()
    handles = [_formula(axes)]
    for (label, own), (marker, fill), aside in zip(_ways(entries), LOOKS, ASIDE, strict=False):
        phi, mean, error = _over_formula(entries, own)
        if len(phi):
            look = {"marker": marker, "color": "black", "mfc": fill, "ls": "none", "ms": 4, "mew": 0.6}
            handles.append(axes.errorbar(phi * aside, mean, error, capsize=2, elinewidth=0.6, label=label, **look))
    for kind in [] if spun is None else np.unique(spun["type"]):
        own, marker = spun["type"] == kind, TYPE_MARKS.get(kind, "1")
        phi = spun["phi"][own]
        over = spun["strength"][own] / tensile_strength_tatsuuma2019(1.0, 1.0, phi)
        look = {"color": TYPE_COLOUR.get(kind, "black"), "ms": 3, "mew": 0.6, "zorder": 1}
        handles += axes.plot(phi, over, marker, label=f"{kind} spun up", **look)
    axes.set(xscale="log", yscale="log", xlabel=r"filling factor $\phi$ at the start")
    axes.set_ylabel(r"strength / (" + _formula_text() + r"$\,\gamma/r_0$)")
    logarithmic(axes.xaxis, labelled=(2, 5))
    logarithmic(axes.yaxis, labelled=(2, 5))
    figure.legend(handles=handles, loc="outside lower center", ncols=2)
    return figure


def _formula_text():
    """The formula over gamma/r_0 in mathtext."""
    return rf"${TENSILE_FACTOR:g}\,\phi^{{1.8}}$"


def _formula(axes):
    """Draw the line of the formula, which is returned, and a band about it."""
    axes.axhspan(1.0 - WITHIN, 1.0 + WITHIN, color=GREY, alpha=0.25, lw=0, zorder=0)
    return axes.axhline(1.0, color="black", lw=0.8, label="Tatsuuma et al. 2019", zorder=0)


def _ways(entries):
    """What each way of pulling, and each other number of monomers, is called, and which entries it has."""
    rate, n = main_pulls(entries)
    numbers = entries["n_monomers"].values
    how = np.stack([entries["n_axes"].values, entries["unloaded"].values], axis=1)
    alike = entries["strain_rate"].values == rate
    found = [(label, alike & (how == pulling).all(axis=1) & (numbers == n)) for pulling, label in WAYS.items()]
    one_axis = alike & (how == (1, 0)).all(axis=1)
    found += [(f"one axis, N = {other}", one_axis & (numbers == other)) for other in np.unique(numbers[numbers != n])]
    return found


def _over_formula(entries, own):
    """Filling factor, and strength over the formula with its error, at each place, of entries that hold, (k,) each."""
    strength, formula = in_units(entries)
    own = own & (strength > HELD * formula)
    every = nominal_phi(entries)
    groups = [own & (every == place) for place in np.unique(every[own])]
    phi = np.array([entries["phi"].values[group].mean() for group in groups])
    mean, error = np.array([mean_of((strength / formula)[group]) for group in groups]).reshape(-1, 2).T
    return phi, mean, error


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return tension(read_entries(files["pulls"]))


def read_entries(paths):
    """All entries of some files, xarray.Dataset."""
    tables = [io.read(path, "tension_set") for path in paths]
    joined = xr.concat(tables, "entry", combine_attrs="drop")
    return joined.assign_attrs(together(table.attrs for table in tables))
