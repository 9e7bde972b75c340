"""``python -m ratd stretch``: the tensile strength of an aggregate from a file."""

import time
from dataclasses import asdict
from pathlib import Path

import click
import numpy as np

from ratd.aggregates.strength import TENSILE_FACTOR, tensile_strength_tatsuuma2019
from ratd.base.errors import InputError
from ratd.base.words import plural
from ratd.experiments.command import (
    OF_STARTS,
    Finite,
    aggregate,
    aggregate_options,
    answer,
    part_done,
    several,
    started,
)
from ratd.experiments.compression.figures.common import power
from ratd.experiments.compression.files import stretched_row
from ratd.experiments.compression.run import DENSEST, FASTEST, compress
from ratd.experiments.compression.stretch import AXES, doubts, stretch
from ratd.experiments.saved import read_runs
from ratd.pictures.style import GREY, HIGHLIGHT, ONE_COLUMN, new_figure, save, styled
from ratd.pipeline.provenance import provenance, source_hash

__all__ = ["command", "show"]


@click.command("stretch")
@aggregate_options
@click.option(
    "--phi", default=0.1, show_default=True, type=Finite(0, DENSEST, min_open=True),
    help="Filling factor to which the aggregate is compressed first.",
)  # fmt: skip
@click.option(
    "--strain-rate", default=1e-5, show_default=True, type=Finite(0, FASTEST, min_open=True),
    help="C_v: the box shrinks, then grows, with 2 C_v L/t_0.",
)  # fmt: skip
@click.option(
    "--axes", default="x", show_default=True, type=click.Choice(list(AXES)), help="Axes of FILE along which to pull."
)
@click.option("--unload", is_flag=True, help="Let the box go first of the aggregate, which still presses on it.")
def command(file, material, unit, starts, out, phi, strain_rate, axes, unload):
    """Squeeze an aggregate in a periodic box, let it come to rest, and pull it apart.

    The answer is the mean over several starts, whose monomers are moved by 1e-12 m, with their standard deviation. The
    runs stand in OUT.nc, a figure in OUT.png. After Ctrl-C the same command goes on.
    """
    given = aggregate(file, unit, material)
    out = file.with_name(f"{file.stem}_stretched") if out is None else out
    settings = {"material": asdict(material), "unit": unit, "phi": phi, "strain_rate": strain_rate}
    settings |= {"axes": axes, "unload": unload}
    made_with = provenance(source_hash(modules=["ratd.experiments.compression.stretch", *OF_STARTS]), settings, [file])

    def make(start, checkpoint, progress):
        grain = started(given, start)

        def told(half):
            begun = time.monotonic()
            return lambda phi, value, to_go: progress(0.5 * half + 0.5 * part_done(begun, to_go))

        try:
            pressed = compress(grain, strain_rate, phi, snapshots=(), checkpoint=checkpoint, progress=told(0))
        except InputError as error:
            raise InputError(str(error).replace("until_phi is", "--phi is")) from None
        how = {"axes": axes, "unload": unload, "checkpoint": f"{checkpoint}.stretch", "progress": told(1)}
        return stretched_row(stretch(pressed, strain_rate, **how))

    target = out.with_name(f"{out.name}.nc")
    several(target, "stretched", material, made_with, starts, make)
    click.echo("\n".join([*show(target, out), f"{target} written"]))


def show(path, out):
    """Figure and answers of a file of pulls.

    Parameters
    ----------
    path : path-like
        The file.
    out : Path
        Stem of the files to write.

    Returns
    -------
    list of str
        What to say.
    """
    found = read_runs(path)
    first = found[0].attrs
    expected = [formula(run) for run in found]
    names = "tensile_strength", "phi_strength", "residual_pressure"
    strength, phi, pressed = (np.array([run.attrs[name] for run in found]) for name in names)
    ways = "x" if first["axes"] == "x" else "all three axes"
    lines = [
        f"{plural(len(found), 'start')} of {plural(first['n_monomers'], 'monomer')}, compressed to phi = "
        f"{first['phi_start']:.3g} and pulled along {ways}, mean ± standard deviation:",
        f"{answer('tensile strength', strength, 'Pa')}: {np.mean(strength / expected):.3g} of "
        f"{TENSILE_FACTOR:g} gamma/r_0 phi^1.8 (Tatsuuma et al. 2019)",
        answer("phi at the greatest tension", phi, "").rstrip(),
        answer(f"pressure on {ways} at rest before the pull", pressed, "Pa"),
    ]
    doubted = [told for run in found for told in doubts(run.attrs)]
    lines += [f"but {told}" for told in doubted[:1]]
    figure = Path(f"{out}.png")
    save(_figure(found, expected[0], ways), figure)
    return [*lines, f"{figure} written"]


def formula(run):
    """Tensile strength [Pa] by Tatsuuma et al. (2019) of what is pulled, at the start."""
    names = "surface_energy", "monomer_radius", "phi_start"
    return tensile_strength_tatsuuma2019(*[run.attrs[name] for name in names])


@styled
def _figure(found, expected, ways):
    """Tension of all starts against the length of the box, beside the formula."""
    first = found[0].attrs
    title = f"{first['n_monomers']} monomers of {first['material']}, $C_v = {power(first['strain_rate'])}$"
    figure = new_figure(ONE_COLUMN, 0.9 * ONE_COLUMN, title)
    axes = figure.subplots()
    for k, run in enumerate(found):
        # all boxes are cubes before the pull
        length = np.cbrt(run.attrs["phi_start"] / run["phi_mean"].values)
        if ways == "x":
            length = length**3
        axes.plot(length, run["tension"], color=HIGHLIGHT, lw=0.7, label=None if k else "starts")
    axes.axhline(0.0, color="black", lw=0.5)
    axes.axhline(expected, color=GREY, ls=":", label=rf"${TENSILE_FACTOR:g}\,\gamma/r_0\,\phi^{{1.8}}$")
    axes.set_xlabel(f"length along {ways}, over that at the start")
    axes.set_ylabel("tension [Pa]")
    axes.legend()
    return figure
