"""Fig. 7: the kinetic energy left against time, of equal spheres and of MRN clusters."""

import numpy as np

from ratd.experiments.collision.figures.look import cluster_text, clusters_of, law_text, looks_of, shared_legend
from ratd.experiments.collision.tables import mean_energy, series_of
from ratd.pictures.style import TWO_COLUMNS, empty, new_figure, styled


@styled
def figure7(groups, law):
    """Mean kinetic energy over E_0 with its standard error against time, a panel a cluster, a curve a velocity.

    Parameters
    ----------
    groups : dict of str to list
        Name of the cluster -> its collisions, from `ratd.experiments.collision.tables.series_of`.
    law : str
        Name of their law in the config.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = new_figure(TWO_COLUMNS, 0.42 * TWO_COLUMNS, f"Kinetic energy left, {law_text(law)}")
    panels = figure.subplots(1, len(groups), sharey=True, squeeze=False)[0]
    looks = looks_of([[row["velocity"] for row, _ in series] for series in groups.values()])
    longest = max((s["time"].iloc[-1] for series in groups.values() for _, s in series), default=1e-6)
    for axes, (name, series) in zip(panels, groups.items(), strict=True):
        axes.set_title(cluster_text(name), pad=4)
        axes.set_xlabel("time $t$ [µs]")
        if not series:
            empty(axes, "no collisions")
        for velocity, look in looks.items():
            own = [one for one in series if one[0]["velocity"] == velocity]
            if own:
                time, energy, error = mean_energy(own)
                axes.plot(time * 1e6, energy, label=f"{velocity:g} m s$^{{-1}}$", **look)
                low, high = energy - error, energy + error
                axes.fill_between(time * 1e6, low, high, color=look["color"], alpha=0.2, lw=0)
        axes.set(xlim=(0, longest * 1e6), ylim=(0, 1.02))
    panels[0].set_ylabel("kinetic energy over $E_0$")
    shared_legend(figure, panels)
    return figure


def groups_of(paths, law, clusters):
    """Central collisions of some clusters under a law: `groups` of `figure7`, all of one length in time each."""
    groups = {}
    for name in clusters:

        def wanted(row, name=name):
            same = row["law"].item() == law and row["cluster"].item() == name
            return same and row["impact_parameter"].item() == 0.0

        series = series_of(paths, wanted)
        lengths = {velocity: np.inf for velocity in {row["velocity"] for row, _ in series}}
        for row, table in series:
            lengths[row["velocity"]] = min(lengths[row["velocity"]], len(table))
        groups[name] = [(row, table.iloc[: int(lengths[row["velocity"]])]) for row, table in series]
    return groups


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    law = settings["law"]
    return figure7(groups_of(files["runs"], law, clusters_of(settings)), law)
