"""Monomers of unequal radii: which length takes the place of r_0."""

import json

from ratd.experiments.compression.figures.common import PHI_LABEL, looks_by_order, read_sets
from ratd.experiments.compression.monomers import LENGTHS, predicted_pressures
from ratd.experiments.compression.strength import mean_pressure
from ratd.pictures.style import TWO_COLUMNS, logarithmic, new_figure, styled

LAWS = {"lognormal": "lognormal", "mrn": r"$a^{-3.5}$"}
"""Law of the radii in the settings of a set -> its text."""


@styled
def monomers(equal, others, names):
    """P over what each length predicts, one panel a length; a right one brings all curves together."""
    figure = new_figure(TWO_COLUMNS, 0.4 * TWO_COLUMNS, "monomers of unequal radii: pressure over predictions")
    every = figure.subplots(1, len(LENGTHS), sharey=True)
    tables = [equal, *others]
    for axes, (length, text) in zip(every, LENGTHS.items(), strict=True):
        for table, name, (colour, dash) in zip(tables, ("equal", *names), looks_by_order(tables), strict=True):
            mean, error = mean_pressure(table)
            line = predicted_pressures(table, equal)[length] * table["phi"].values ** 3
            axes.plot(table["phi"], mean / line, color=colour, ls=dash, label=name)
            low, high = (mean - error) / line, (mean + error) / line
            axes.fill_between(table["phi"], low.clip(1e-3), high.clip(1e-3), color=colour, alpha=0.2, lw=0)
        axes.axhline(1.0, color="black", lw=0.6)
        axes.set(xscale="log", yscale="log", xlabel=PHI_LABEL, xlim=(0.018, 0.6), ylim=(0.03, 60), title=text)
        logarithmic(axes.xaxis)
        logarithmic(axes.yaxis)
    every[0].set_ylabel("$P$ / prediction")
    figure.legend(*every[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    equal, *others = read_sets(files)
    return monomers(equal, others, [name_of(table) for table in others])


def name_of(table):
    """The set of a table, as its settings name the radii, and how wide they are spread."""
    radii = json.loads(table.attrs["settings"])["radii"]
    if radii is None:
        return "equal"
    ratio = table["mean_radius"].item() / table["monomer_radius"].item()
    law = LAWS[radii["law"]]
    return rf"{law}, $\langle a\rangle$ = {ratio:.2f} $\langle a^3\rangle^{{1/3}}$"
