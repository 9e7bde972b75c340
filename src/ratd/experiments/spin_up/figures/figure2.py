"""Fig. 2: what the grown grains are like."""

import numpy as np

from ratd.base.words import plural
from ratd.experiments.spin_up.cells import cell_statistics
from ratd.experiments.spin_up.run_files import read_table
from ratd.experiments.spin_up.figures.style import mean_and_range, offsets, size_limits, sizes_label, type_style
from ratd.pictures.snapshots import drive_of, drive_text
from ratd.pictures.style import GREY, TWO_COLUMNS, empty, logarithmic, nanometres, new_figure, styled

PANELS = (
    ("n_monomers", r"number of monomers $N_\mathrm{mon}$", "log"),
    ("n_contacts", r"number of contacts $N_\mathrm{con}$", "log"),
    ("porosity", r"porosity $\mathcal{P}$", "linear"),
    ("fractal_dimension", r"fractal dimension $D_\mathrm{f}$", "linear"),
)
ENOUGH = 30
"""Monomers from which on a fractal dimension is shown: with fewer its fit scatters up to 8, and no body has above 3."""


@styled
def figure2(table, drive=None):
    """Number of monomers and contacts, porosity and fractal dimension against size (Fig. 2).

    Parameters
    ----------
    table : pandas.DataFrame
        What `grain_table` returns.
    drive : str, optional
        Named in the title; default: what the table says. The grown grains do not depend on it.

    Returns
    -------
    matplotlib.figure.Figure
        Means over seeds and materials as markers, minima to maxima as bars; the types are shifted a little. Fractal
        dimensions are those of grains of `ENOUGH` monomers or more.

    References
    ----------
    Reissl et al. (2024), A&A 692, A60, Fig. 2.
    """
    drive = drive_of(table) if drive is None else drive
    grains, materials = plural(len(table), "grain"), plural(table["material"].nunique(), "material")
    known = f" ({drive_text(drive)})" if drive else ""
    figure = new_figure(TWO_COLUMNS, 0.68 * TWO_COLUMNS, f"{grains} of {materials} as grown, at rest{known}")
    panels = figure.subplots(2, 2, sharex=True)
    fitted = table["fractal_dimension"].where(table["n_monomers"] >= ENOUGH)
    cells = cell_statistics(table.assign(fractal_dimension=fitted), by=("type", "a_eff"))
    style = type_style(cells["type"])
    shifts = dict(zip(style, offsets(cells["a_eff"], len(style)), strict=True)) if len(cells) else {}
    for axes, (name, label, scale) in zip(panels.flat, PANELS, strict=True):
        axes.set_yscale(scale)
        axes.set_ylabel(label)
        for kind, look in style.items():
            here = cells[cells["type"] == kind]
            mean_and_range(axes, nanometres(here["a_eff"] + shifts[kind]), here, name, look, label=kind)
        if not cells[f"{name}_count"].any():
            empty(axes, f"no grain of {ENOUGH} monomers" if name == "fractal_dimension" else "no values")
        if scale == "log":
            logarithmic(axes.yaxis)
    if len(cells):
        panels[0, 0].set_xlim(*nanometres(size_limits(cells["a_eff"])))
        panels[0, 0].legend(loc="upper left")
    dimension = panels[1, 1]
    if cells["fractal_dimension_count"].any():
        dimension.axhline(3.0, color=GREY, lw=0.8, ls="--", zorder=0)
        dimension.set_ylim(1.0, max(3.6, 1.03 * np.nanmax(cells["fractal_dimension_maximum"])))
        text = f"grains of {ENOUGH} monomers or more"
        dimension.text(0.97, 0.03, text, transform=dimension.transAxes, ha="right", va="bottom")
        line = dimension.get_yaxis_transform()
        dimension.text(0.97, 3.02, "a solid body", transform=line, ha="right", va="bottom", color=GREY)
    for axes in panels[1]:
        axes.set_xlabel(sizes_label())
    return figure


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return figure2(read_table(files["table"]), drive=settings["drive"])
