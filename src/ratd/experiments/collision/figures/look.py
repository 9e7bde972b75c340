"""What the figures of the collision share: colours of radii, names of clusters, means with their errors."""

import numpy as np
from matplotlib import colormaps

from ratd.experiments.collision.fragmentation import means
from ratd.experiments.collision.likeness import is_equal
from ratd.experiments.collision.printed import RADII
from ratd.pictures.style import GREY, plain
from ratd.pipeline import io
from ratd.pipeline.blocks import rows

__all__ = [
    "CLUSTERS",
    "MRN_STYLE",
    "SMALLER",
    "cluster_text",
    "clusters_of",
    "collisions_of",
    "colour_of",
    "colour_of_velocity",
    "label_of",
    "looks_of",
    "law_text",
    "plot_means",
    "radii_of",
    "radius_label",
    "shared_legend",
]

CLUSTERS = {
    "353nm": "equal, 0.353 µm",
    "314nm": "equal, 0.314 µm",
    "314nm_giant": "equal, 0.314 µm,\nand one of 1.8 µm",
    "mrn100_to_800": "MRN from 0.1 to 0.8 µm",
    "mrn100_tree": "MRN above 0.1 µm, tree",
    "mrn100": "MRN above 0.1 µm",
    "mrn70": "MRN above 0.07 µm",
    "mrn": "MRN, all",
}
"""Name in config/collision_study.yaml -> text."""
LAWS = {"velocity": "friction by rate", "spring": "friction by springs", "dmt": "DMT", "jkr": "JKR"}
"""Name of a law in the configs and on the command line -> text."""

MRN_STYLE = {"color": "black", "marker": "D", "ls": "-", "lw": 1.4, "ms": 4.0}
"""How an MRN cluster looks."""
MARKERS = "osv^P*X<>"
STYLES = ("-", (0, (6, 1.5)), (0, (3, 1)), (0, (1, 0.8)), (0, (6, 1.5, 1, 1.5)))
SMALLER = (0.22e-6, 0.26e-6)
"""Radii [m] of equal spheres that are smaller than those of the paper."""
TRIED = (*SMALLER, *RADII)
"""Radii [m] of equal spheres from which colours and markers are taken."""
_SCALE = colormaps["viridis"]
_VELOCITIES = colormaps["plasma"]
VELOCITIES = (10.0, 45.0)
"""Velocities [m/s] at the ends of the scale of their colours."""


def colour_of(radius):
    """Colour of a radius, by the place of the nearest of `TRIED`."""
    return _SCALE(0.9 * _place(radius) / (len(TRIED) - 1))


def colour_of_velocity(velocity):
    """Colour of a velocity [m/s], on another scale than that of radii."""
    slow, fast = VELOCITIES
    return _VELOCITIES(float(np.clip((velocity - slow) / (fast - slow), 0.0, 1.0)))


def marker_of(radius):
    """Marker of a radius, likewise."""
    return marker(_place(radius))


def marker(k):
    """Marker of the curve or sample of number `k`; the first ones come again where there are more."""
    return MARKERS[k % len(MARKERS)]


def _place(radius):
    """Place of the nearest of `TRIED`; radii differ by rounding."""
    return int(np.argmin(np.abs(np.array(TRIED) - radius)))


def radius_label(radius):
    """Text of a radius [m], such as "0.314 µm"."""
    return f"{radius * 1e6:.3g} µm"


def cluster_text(name):
    """Text for a cluster of the config."""
    return CLUSTERS.get(name, plain(name).replace("_", " "))


def law_text(name):
    """Text for a law of the config."""
    return LAWS.get(name, f"law {name}")


def collisions_of(files):
    """The table of all collisions, from the files of a job that draws a figure."""
    return io.read(files["table"], "collision_table").to_dataframe()


def radii_of(files):
    """Radii of each sample of a cluster as built, list of (n,) array, from the files of a job that draws a figure."""
    return [row["radius"].values for row in rows(io.read(files["built"][0], "built_clusters"), "built_clusters")]


def clusters_of(settings):
    """Clusters of the panels of a figure: equal spheres, MRN, and if asked for MRN without its smallest spheres."""
    return [settings[name] for name in ("twin", "mrn", "cut") if name in settings]


def label_of(table):
    """Text for the collisions of one cluster: the radius of its spheres, else its name."""
    one = table.iloc[0]
    if is_equal(one):
        return radius_label(one["largest_radius"])
    return cluster_text(one["cluster"])


def plot_means(axes, table, quantity, label, **style):
    """Draw the means of a quantity against velocity, with bars of one standard error."""
    x, y, error = means(table, quantity)
    axes.errorbar(x, y, error, label=label, elinewidth=0.7, capsize=1.5, **style)


def velocity_axis(axes, table):
    """Label and limits of an axis of velocities."""
    axes.set_xlabel("collision velocity $v$ [m s$^{-1}$]")
    axes.set_xlim(0, 1.05 * table["velocity"].max())


def sticking_line(axes, limit):
    """The limit of X below which clusters are said to fragment, a level line, which is returned for a legend."""
    return axes.axhline(limit, color=GREY, lw=0.7, ls=(0, (4, 2)), zorder=0, label="limit of sticking")


def shared_legend(figure, panels):
    """One legend below all panels, each label once."""
    handles = {label: h for axes in panels for h, label in zip(*axes.get_legend_handles_labels(), strict=True)}
    figure.legend(handles.values(), handles, loc="outside lower center", ncols=len(handles) or 1)


def looks_of(velocities):
    """Colours and line styles of some velocities, the same in all panels: float -> dict.

    Parameters
    ----------
    velocities : list of list of float
        Of each panel. The panel with the fewest says which, as many as there are line styles.
    """
    fewest = sorted(set(min((each for each in velocities if len(each)), key=lambda each: len(set(each)), default=[])))
    ends = np.linspace(0, len(fewest) - 1, min(len(fewest), len(STYLES)))
    chosen = [fewest[k] for k in ends.round().astype(int)]
    return {
        velocity: {"color": colour_of_velocity(velocity), "ls": style}
        for velocity, style in zip(chosen, STYLES, strict=False)
    }
