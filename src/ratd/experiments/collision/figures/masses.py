"""Beyond the paper: how the mass is spread over the pieces."""

import numpy as np

from ratd.experiments.collision.figures.look import cluster_text, clusters_of, law_text, looks_of, shared_legend
from ratd.experiments.collision.fragmentation import mean_over_samples
from ratd.pictures.style import TWO_COLUMNS, empty, new_figure, styled
from ratd.pipeline import io
from ratd.pipeline.blocks import rows


@styled
def masses(groups, law):
    """Part of the mass in pieces of at least some mass, means with standard errors, a panel a cluster.

    Parameters
    ----------
    groups : dict of str to list of xarray.Dataset
        Name of the cluster -> rows of files of collisions.
    law : str
        Name of their law in the config.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = new_figure(TWO_COLUMNS, 0.42 * TWO_COLUMNS, f"Mass in pieces of at least a mass, {law_text(law)}")
    panels = figure.subplots(1, len(groups), sharey=True, squeeze=False)[0]
    edges = np.geomspace(1e-4, 1.0, 81)
    looks = looks_of([[row["velocity"].item() for row in own] for own in groups.values()])
    for axes, (name, own) in zip(panels, groups.items(), strict=True):
        axes.set_title(cluster_text(name), pad=4)
        axes.set(xscale="log", ylim=(0, 1.02))
        if not own:
            empty(axes, "no collisions")
        for velocity, look in looks.items():
            here = [row for row in own if row["velocity"].item() == velocity]
            if here:
                parts = [row["piece_mass"].values / row["mass"].item() for row in here]
                curves = np.array([[part[part >= edge].sum() for edge in edges] for part in parts])
                samples = [row["sample"].item() if "sample" in row else 0 for row in here]
                mean, error = mean_over_samples(curves, samples)
                axes.plot(edges, mean, drawstyle="steps-pre", label=f"{velocity:g} m s$^{{-1}}$", **look)
                axes.fill_between(edges, mean - error, mean + error, step="pre", color=look["color"], alpha=0.2, lw=0)
    shared_legend(figure, panels)
    panels[0].set_ylabel("part of the mass")
    panels[len(panels) // 2].set_xlabel("mass of a piece over that of both clusters")
    return figure


def rows_by_cluster(paths, law, clusters):
    """Rows of the central collisions of some clusters under a law, dict of str to list."""
    found = {name: [] for name in clusters}
    for path in paths:
        for row in rows(io.read(path, "collisions"), "collisions"):
            name = row["cluster"].item()
            if name in found and row["law"].item() == law and row["impact_parameter"].item() == 0.0:
                found[name].append(row)
    return found


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    law = settings["law"]
    return masses(rows_by_cluster(files["runs"], law, clusters_of(settings)), law)
