"""Fig. 3 of Kataoka et al. (2013): snapshots of a cluster among its copies."""

import numpy as np
from matplotlib.colors import to_rgb

from ratd.pictures.spheres import render, scale_length
from ratd.pictures.style import HIGHLIGHT, TWO_COLUMNS, new_figure, styled
from ratd.pipeline import io

OWN = "#DDE7EE"
"""Colour of the monomers of the box; its copies are orange."""
UM = 1e-6


@styled
def figure3(snapshots):
    """Monomers at some filling factors, seen along z, light; in orange its copies as far as seen; the box black.

    All panels have one scale, that of the first box.
    """
    n = snapshots.sizes["snapshot"]
    title = f"a cluster of {snapshots.sizes['monomer']} monomers among its copies"
    figure = new_figure(TWO_COLUMNS, 0.4 * TWO_COLUMNS, title)
    half = 1.02 * snapshots["box_length"].values.max()
    for k, axes in enumerate(figure.subplots(1, n, squeeze=False)[0]):
        length = snapshots["box_length"].values[k]
        own = np.stack([snapshots[axis].values[k] for axis in "xyz"], axis=1)
        position, colour = [], []
        # a box more than what is seen, since arms reach out of theirs
        reach = range(-int(half / length + 1.5), int(half / length + 1.5) + 1)
        for nx in reach:
            for ny in reach:
                position.append(own + length * np.array([nx, ny, 0]))
                colour.append(np.tile(to_rgb(HIGHLIGHT if nx or ny else OWN), (len(own), 1)))
        radius = np.tile(snapshots["radius"].values, len(reach) ** 2)
        position, colour = np.concatenate(position), np.concatenate(colour)
        seen = (np.abs(position[:, :2]) < half + radius[:, None]).all(axis=1)
        picture = render(position[seen], radius[seen], colour[seen], half, pixels=400)
        edge = half / UM
        axes.imshow(picture, extent=(-edge, edge, -edge, edge), interpolation="antialiased")
        x = 0.5 * length / UM
        axes.plot([-x, x, x, -x, -x], [-x, -x, x, x, -x], color="black", lw=0.8)
        axes.set(xlim=(-edge, edge), ylim=(-edge, edge), aspect="equal")
        axes.set_title(rf"$\phi$ = {snapshots['phi'].values[k]:.2g}, $L$ = {2 * x:.3g} µm")
        axes.set_axis_off()
        if k == 0:
            bar = scale_length(0.5 * edge)
            axes.plot([0.95 * edge - bar, 0.95 * edge], [-0.95 * edge] * 2, color="black", lw=1.6)
            axes.text(
                0.95 * edge - 0.5 * bar, -0.9 * edge, f"{bar:g} µm", ha="center", va="bottom",
                bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.85, "pad": 1.5},
            )  # fmt: skip
    return figure


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return figure3(io.read(files["snapshots"][0], "compression_snapshots"))
