"""Fig. 8: the kinetic energy left at 0.5 us against the radius of equal spheres, with MRN beside it."""

import numpy as np

from ratd.experiments.collision.figures.look import (
    cluster_text,
    collisions_of,
    colour_of_velocity,
    law_text,
    marker,
)
from ratd.experiments.collision.fragmentation import mean_and_error, means
from ratd.experiments.collision.likeness import of_equal_spheres
from ratd.pictures.style import GREY, ONE_COLUMN, empty, new_figure, styled


@styled
def figure8(table, law, mrn):
    """E(0.5 us)/E_0 against radius, a curve a velocity; MRN as a level with the same marker, open.

    Parameters
    ----------
    table : pandas.DataFrame
        `ratd.experiments.collision.tables.COLUMNS`.
    law, mrn : str
        Names of the law and of the MRN cluster in the config.

    Returns
    -------
    matplotlib.figure.Figure
    """
    table = table[(table["law"] == law) & (table["impact_parameter"] == 0) & table["energy_half"].notna()]
    equal, own = of_equal_spheres(table), table[table["cluster"] == mrn]
    figure = new_figure(ONE_COLUMN, ONE_COLUMN, f"Energy left at 0.5 µs, {law_text(law)}")
    axes = figure.subplots()
    if not len(equal):
        empty(axes, "no collisions")
        return figure
    # velocities that most radii have, and the MRN cluster
    often = equal.groupby("velocity")["largest_radius"].nunique()
    velocities = often[often > 0.5 * often.max()].index
    velocities = np.intersect1d(velocities, own["velocity"]) if len(own) else velocities.sort_values()
    for k, velocity in enumerate(velocities):
        colour = colour_of_velocity(velocity)
        part = equal[equal["velocity"] == velocity].assign(velocity=lambda t: t["largest_radius"])
        radius, mean, error = means(part, "energy_half")
        axes.errorbar(
            radius * 1e6, mean, error, color=colour, marker=marker(k), capsize=1.5, label=f"{velocity:g} m s$^{{-1}}$"
        )
        same = own[own["velocity"] == velocity]
        if len(same):
            mean, error = mean_and_error(same, "energy_half")
            axes.axhline(mean, color=colour, lw=0.8, ls=(0, (4, 2)), zorder=0)
            # the errors side by side, to the right of all radii
            at = equal["largest_radius"].max() * 1e6 * (1.05 + 0.018 * k)
            axes.errorbar(
                at, mean, np.nan_to_num(error), color=colour, marker=marker(k), mfc="white", capsize=1.5, ls="none"
            )
    axes.plot([], [], color=GREY, lw=0.8, ls=(0, (4, 2)), label=f"{cluster_text(mrn)} (open marker)")
    axes.set(xlabel="radius of equal spheres [µm]", ylabel="kinetic energy at 0.5 µs over $E_0$", ylim=(0, None))
    figure.legend(loc="outside lower center", ncols=3)
    return figure


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return figure8(collisions_of(files), settings["law"], settings["mrn"])
