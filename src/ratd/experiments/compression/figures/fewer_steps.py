"""The semi-implicit step beside the explicit one."""

from ratd.experiments.compression.figures.common import pressures, read_sets, strain_text
from ratd.pictures.style import styled


@styled
def fewer_steps(tables):
    """Mean pressures of sets with the explicit and the semi-implicit step, and how many steps they took."""
    labels = []
    for table in tables:
        name = "explicit" if table.attrs["integrator"].startswith("Leapfrog") else "semi-implicit"
        steps = float(table["steps"].mean())
        labels.append(f"{name}, {strain_text(table)}, {steps / 1e6:.2g} million steps")
    return pressures(tables, labels, f"{tables[0].attrs['material']}, N = {tables[0]['n_monomers'].item()}")


def draw(files, settings):
    """The figure of a job of the pipeline, from its files and settings."""
    return fewer_steps(read_sets(files))
