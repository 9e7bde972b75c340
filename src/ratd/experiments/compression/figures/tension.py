"""Tensile strength of compressed clusters, beside the formula of others and what the spin-up of grains implies."""

import numpy as np
import xarray as xr

from ratd.base.statistics import mean_of
from ratd.aggregates.strength import tensile_strength_tatsuuma2019
from ratd.experiments.compression.figures.common import COLOURS, power
from ratd.pictures.style import ONE_COLUMN, logarithmic, new_figure, styled
from ratd.pipeline import io


def in_units(entries):
    """Strength over gamma/r_0, and the same by the formula, of entries of the kind ``tension_set``."""
    unit = entries["surface_energy"] / entries["monomer_radius"]
    return (entries["strength"] / unit).values, tensile_strength_tatsuuma2019(1.0, 1.0, entries["phi"].values)


@styled
def tension(entries, spun=None):
    """S r_0/gamma against the filling factor at which the pulling began.

    Parameters
    ----------
    entries : xarray.Dataset
        Of the kind ``tension_set``.
    spun : dict, optional
        Grains that were spun up: ``phi``, ``strength``, S a/gamma, and ``type``, (k,) each.
    """
    figure = new_figure(ONE_COLUMN, 0.95 * ONE_COLUMN, "tensile strength")
    axes = figure.subplots()
    if spun is not None:
        for kind, marker, grey in zip(np.unique(spun["type"]), ".x+", ("#777777", "#999999", "#BBBBBB"), strict=False):
            own = spun["type"] == kind
            axes.plot(
                spun["phi"][own], spun["strength"][own], marker, color=grey, ms=3, mew=0.6, label=f"{kind} spun up",
                zorder=0,
            )  # fmt: skip
    how = np.stack([entries["n_axes"].values, entries["strain_rate"].values, entries["n_monomers"].values], axis=1)
    strength, _ = in_units(entries)
    for k, (n_axes, rate, n) in enumerate(np.unique(how, axis=0)[::-1]):
        own = (how == (n_axes, rate, n)).all(axis=1)
        phi = np.round(entries["phi"].values[own], 4)
        places = np.unique(phi)
        mean = np.array([strength[own][phi == place].mean() for place in places])
        error = np.array([mean_of(strength[own][phi == place])[1] for place in places])
        label = f"{'one axis' if n_axes == 1 else 'three axes'}, N = {n:g}, " + rf"$C_\mathrm{{v}} = {power(rate)}$"
        axes.errorbar(
            places, mean, error, marker="os^Dv"[k % 5], color=COLOURS[k % 5], ls="none", capsize=2, label=label
        )
    x = np.geomspace(0.01, 0.6, 20)
    axes.plot(
        x, tensile_strength_tatsuuma2019(1.0, 1.0, x), color="black", lw=0.8, label=r"$0.951\,\phi^{1.8}$ (recalled)"
    )
    axes.set(xscale="log", yscale="log", xlabel=r"filling factor $\phi$", ylabel=r"$S\,r_0/\gamma$")
    logarithmic(axes.xaxis)
    logarithmic(axes.yaxis)
    axes.set_ylim(bottom=2e-5)
    axes.legend(loc="lower right")
    return figure


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return tension(read_pulls(files["pulls"]))


def read_pulls(paths):
    """All entries of some files, xarray.Dataset."""
    return xr.concat([io.read(path, "tension_set") for path in paths], "entry")
