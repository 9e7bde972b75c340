"""Fig. 1: the MRN law and the radii that were drawn from it."""

import numpy as np

from ratd.aggregates.mrn import LARGEST, SMALLEST, part_above
from ratd.experiments.collision.figures.look import radii_of, radius_label
from ratd.pictures.style import ONE_COLUMN, new_figure, styled

BINS = 18
ASIDE = 1.04
"""Samples are drawn aside of each other by this factor."""


def density(radius, smallest=SMALLEST, largest=LARGEST):
    """f(r) = 2.5 r^-3.5/(r_min^-2.5 - r_max^-2.5) [1/m] (Umstaetter & Urbassek 2020, Eqs. 3, 4)."""
    ends = 1.0 - (largest / smallest) ** -2.5
    return 2.5 / smallest * (np.asarray(radius) / smallest) ** -3.5 / ends


@styled
def figure1(samples, smallest=SMALLEST, largest=LARGEST):
    """Density of the MRN law and of samples, in bins of equal width in the logarithm; bars are counting errors.

    Parameters
    ----------
    samples : list of (n,) array
        Radii [m].
    smallest, largest : float
        Ends of the law [m].

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = new_figure(ONE_COLUMN, 0.8 * ONE_COLUMN, f"MRN law and samples of {len(samples[0])} spheres")
    axes = figure.subplots()
    r = np.geomspace(smallest, largest, 200)
    axes.plot(r * 1e6, density(r, smallest, largest) * 1e-6, color="black", label="MRN law")
    edges = np.geomspace(smallest, largest, BINS + 1)
    middle = np.sqrt(edges[1:] * edges[:-1])
    for k, radii in enumerate(samples):
        counts = np.histogram(radii, edges)[0]
        # of a sample whose smallest spheres were left out the others keep their density
        number = len(radii) / part_above(radii.min(), smallest, largest)
        part = counts / number / np.diff(edges) * 1e-6
        there = counts > 0
        colour = ("#D55E00", "#009E73", "#0072B2", "#CC79A7")[k % 4]
        label = f"sample {k + 1}, largest {radius_label(radii.max())}"
        place = middle[there] * 1e6 * ASIDE ** (k - 0.5 * (len(samples) - 1))
        axes.errorbar(
            place, part[there], part[there] / np.sqrt(counts[there]), ls="none", marker="osv^"[k % 4], color=colour,
            mfc="white", elinewidth=0.6, label=label,
        )  # fmt: skip
    axes.set(xscale="log", yscale="log", xlabel="radius $r$ [µm]", ylabel="density $f(r)$ [µm$^{-1}$]")
    axes.legend()
    return figure


def draw(files, settings):
    """The figure of a job of the pipeline, from the cluster of its settings as built."""
    return figure1(radii_of(files), *settings.get("ends", (SMALLEST, LARGEST)))
