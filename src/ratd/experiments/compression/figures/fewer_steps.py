"""Long steps beside explicit ones."""

import re

from ratd.experiments.compression.figures.common import pressures_over, read_sets, seeds_text, strain_text
from ratd.experiments.compression.strength import of_same_clusters
from ratd.pictures.style import styled


def longest_step(table):
    """The longest step of a set over t_0; None where all are explicit."""
    found = re.match(r"SemiImplicit\(longest=([0-9.e+-]+)", table.attrs["integrator"])
    return None if found is None else float(found[1]) / table["time_unit"].item()


@styled
def fewer_steps(tables):
    """Mean pressures of sets that differ in their steps, and how many these are; below over those of explicit ones."""
    tables, labels = of_same_clusters(tables), []
    for table in tables:
        longest = longest_step(table)
        name = "explicit" if longest is None else rf"at most {longest:.0f} $t_0$"
        labels.append(f"{name}, {float(table['steps'].mean()) / 1e3:,.0f} thousand steps")
    about = f"{tables[0].attrs['material']}, {seeds_text(tables[0])}, {strain_text(tables[0])}"
    explicit = next((k for k, table in enumerate(tables) if longest_step(table) is None), 0)
    return pressures_over(tables, labels, about, explicit, r"$P\,/\,P$(explicit)", (0.5, 1.3))


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return fewer_steps(read_sets(files))
