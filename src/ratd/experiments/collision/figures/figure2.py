"""Fig. 2: the length that stands for the MRN law, against the moment."""

import numpy as np

from ratd.aggregates.mrn import (
    LARGEST,
    SMALLEST,
    free_samples,
    moment_of_length,
    mrn_length,
    part_above,
    sample_length,
)
from ratd.experiments.collision.figures.look import radii_of
from ratd.experiments.collision.printed import RADII
from ratd.pictures.style import GREY, ONE_COLUMN, new_figure, styled

HIGHEST = 8.0


@styled
def figure2(samples, smallest=SMALLEST, largest=LARGEST):
    """L_q of the law, of samples, and the radii of the equal spheres on it; a band for what free samples scatter by.

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
    figure = new_figure(ONE_COLUMN, 0.8 * ONE_COLUMN, "Length of a moment of the MRN law")
    axes = figure.subplots()
    q = np.linspace(1.0, HIGHEST, 141)
    law = smallest, largest
    number = round(len(samples[0]) / part_above(samples[0].min(), *law))
    lengths = [
        [sample_length(radii, one) * 1e6 for one in q]
        for radii in free_samples(number, smallest=smallest, largest=largest)
    ]
    low, high = np.quantile(lengths, [0.16, 0.84], axis=0)
    axes.fill_between(q, low, high, color="#56B4E9", alpha=0.35, lw=0, label=f"free samples of {number}, 16 to 84 %")
    for k, radii in enumerate(samples):
        # of a sample whose smallest spheres were left out: they count in the mean, and add nothing to it
        whole = part_above(radii.min(), *law)
        own = [sample_length(radii, one) * whole ** (1.0 / one) * 1e6 for one in q]
        axes.plot(q, own, color=GREY, lw=0.8, label="samples used" if k == 0 else None)
    axes.plot(q, [mrn_length(one, *law) * 1e6 for one in q], color="black", label="law")
    moments = [moment_of_length(radius, *law) for radius in RADII]
    axes.plot(moments, np.array(RADII) * 1e6, "o", color="#D55E00", label="radii of equal spheres")
    axes.set(xlabel="moment $q$", ylabel="length $L_q$ [µm]", xlim=(1, HIGHEST), ylim=(0, None))
    axes.legend(loc="upper left")
    return figure


def draw(files, settings):
    """The figure of a job of the pipeline, from the cluster of its settings as built."""
    return figure2(radii_of(files), *settings.get("ends", (SMALLEST, LARGEST)))
