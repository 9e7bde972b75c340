"""Fig. 13 of Kataoka et al. (2013): the filling factor of silicate against the pressure, beside other work."""

import numpy as np

from ratd.aggregates.strength import (
    compressive_strength_kataoka2013,
    compressive_strength_tatsuuma2023,
    filling_factor_guettler2009,
)
from ratd.experiments.compression.figures.common import (
    COLOURS,
    FEWEST,
    looks_of,
    read_sets,
    seeds_text,
    strain_text,
)
from ratd.experiments.compression.strength import mean_pressure
from ratd.pictures.style import GREY, ONE_COLUMN, logarithmic, new_figure, styled

READ_OFF = {"Kataoka et al. 2013": 0.24, "Seizinger et al. 2012": 0.21, "Güttler et al. 2009": 0.17}
"""Filling factors at 300 Pa that Kataoka et al. (2013) name in Sect. 3.7."""


@styled
def figure13(tables):
    """phi against P, means of sets of one material with one standard error of P, fits, and values named at 300 Pa."""
    figure = new_figure(ONE_COLUMN, 1.3 * ONE_COLUMN, f"{tables[0].attrs['material']}, {strain_text(tables[0])}")
    axes = figure.subplots()
    for table, (colour, dash) in zip(tables, looks_of(tables), strict=True):
        mean, error = mean_pressure(table)
        axes.plot(mean, table["phi"], color=colour, ls=dash, label=f"here, {seeds_text(table)}")
        if table.sizes["seed_number"] >= FEWEST:
            low = np.maximum(mean - error, 0.03 * mean)
            axes.fill_betweenx(table["phi"], low, mean + error, color=colour, alpha=0.2, lw=0)
    phi = np.unique(np.concatenate([table["phi"].values for table in tables]))
    P_0 = tables[0]["rolling_pressure"].values[0]
    axes.plot(compressive_strength_kataoka2013(phi, P_0), phi, color="black", lw=0.8, label=r"$P_0\phi^3$")
    line = compressive_strength_tatsuuma2023(phi, P_0)
    axes.plot(line, phi, color=COLOURS[1], ls="--", label="Tatsuuma et al. 2023 (recalled)")
    pressure = np.geomspace(1, 1e6, 100)
    axes.plot(
        pressure, filling_factor_guettler2009(pressure), color=GREY, ls=":", label="Güttler et al. 2009 (recalled)"
    )
    for marker, (name, value) in zip("osv", READ_OFF.items(), strict=True):
        label = f"at 300 Pa, as printed: {name}"
        axes.plot(300.0, value, marker=marker, ls="none", color=COLOURS[3], mfc="none", label=label)
    axes.set(xscale="log", xlabel="pressure $P$ [Pa]", ylabel=r"filling factor $\phi$", xlim=(1, 1e6), ylim=(0, 0.6))
    logarithmic(axes.xaxis)
    figure.legend(loc="outside lower center", ncols=1)
    return figure


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return figure13(read_sets(files))
