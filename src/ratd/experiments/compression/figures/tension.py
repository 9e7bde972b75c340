"""Tensile strength of compressed clusters, beside the formula of others and what the spin-up of grains implies."""

import numpy as np
import xarray as xr

from ratd.base.statistics import mean_of
from ratd.aggregates.strength import TENSILE_FACTOR, tensile_strength_tatsuuma2019
from ratd.experiments.compression.figures.common import COLOURS
from ratd.experiments.compression.tension_findings import HELD, in_units, main_pulls, nominal_phi
from ratd.pictures.style import ONE_COLUMN, logarithmic, new_figure, styled
from ratd.pipeline import io


WAYS = {(1, 0): "one axis", (1, 1): "one axis, unloaded first", (3, 0): "three axes"}
"""Axes that are pulled and whether the box lets go of the cluster before -> what it is called."""
ASIDE = (1.0, 0.94, 1.0, 1.09, 1.18)
"""Factors of the filling factor by which the signs of these ways, and of other numbers, are moved to be seen."""


@styled
def tension(entries, spun=None):
    """S r_0/gamma against the filling factor at which the pulling began, means of the clusters that hold.

    Parameters
    ----------
    entries : xarray.Dataset
        Of the kind ``tension_set``.
    spun : dict, optional
        Grains that were spun up: ``phi``, ``strength``, S a/gamma, and ``type``, (k,) each.
    """
    figure = new_figure(
        ONE_COLUMN, 0.95 * ONE_COLUMN, f"tensile strength of {main_pulls(entries)[1]} monomers, unless told"
    )
    axes = figure.subplots()
    if spun is not None:
        for kind, marker, grey in zip(np.unique(spun["type"]), ".x+", ("#444444", "#777777", "#A0A0A0"), strict=False):
            own = spun["type"] == kind
            axes.plot(
                spun["phi"][own], spun["strength"][own], marker, color=grey, ms=3, mew=0.6, label=f"{kind} spun up",
                zorder=0,
            )  # fmt: skip
    rate, n = main_pulls(entries)
    strength, formula = in_units(entries)
    held = (entries["strain_rate"].values == rate) & (strength > HELD * formula)
    phi, numbers = entries["phi"].values, entries["n_monomers"].values
    how = np.stack([entries["n_axes"].values, entries["unloaded"].values], axis=1)
    every = nominal_phi(entries)
    ways = [(label, (how == pulling).all(axis=1) & (numbers == n)) for pulling, label in WAYS.items()]
    ways += [
        (f"one axis, {other} monomers", (how == (1, 0)).all(axis=1) & (numbers == other))
        for other in np.unique(numbers[numbers != n])
    ]
    for (label, own), marker, colour, aside in zip(ways, "os^Dv", COLOURS, ASIDE, strict=False):
        own = own & held
        places = np.unique(every[own])
        groups = [own & (every == place) for place in places]
        mean, error = np.array([mean_of(strength[group]) for group in groups]).reshape(-1, 2).T
        if len(places):
            at = [phi[group].mean() * aside for group in groups]
            axes.errorbar(at, mean, error, marker=marker, color=colour, ls="none", capsize=2, ms=4, label=label)
    x = np.geomspace(0.01, 0.6, 20)
    label = rf"${TENSILE_FACTOR:g}\,\phi^{{1.8}}$ (Tatsuuma et al. 2019)"
    axes.plot(x, tensile_strength_tatsuuma2019(1.0, 1.0, x), color="black", lw=0.8, label=label)
    axes.set(xscale="log", yscale="log", xlabel=r"filling factor $\phi$ at the start", ylabel=r"$S\,r_0/\gamma$")
    logarithmic(axes.xaxis)
    logarithmic(axes.yaxis)
    axes.set_ylim(1e-4, 10.0)
    axes.legend(loc="upper left")
    return figure


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return tension(read_pulls(files["pulls"]))


def read_pulls(paths):
    """All entries of some files, xarray.Dataset."""
    return xr.concat([io.read(path, "tension_set") for path in paths], "entry")
