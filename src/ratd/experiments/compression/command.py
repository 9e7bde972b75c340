"""``python -m ratd compress``: the pressure that it takes to compress an aggregate from a file."""

import time
from dataclasses import asdict
from pathlib import Path

import click
import numpy as np

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
from ratd.experiments.compression.figures.page import page_of
from ratd.experiments.compression.files import run_row
from ratd.experiments.compression.run import DENSEST, FASTEST, compress
from ratd.experiments.saved import read_runs
from ratd.pictures.style import GREY, HIGHLIGHT, ONE_COLUMN, logarithmic, new_figure, save, styled
from ratd.pipeline.atomic import write_text
from ratd.pipeline.provenance import provenance, source_hash

__all__ = ["command", "show"]

TOLD = (0.01, 0.03, 0.1, 0.2, 0.3, 0.5)
"""Filling factors at which the pressure is told."""
SNAPSHOTS = 40
"""Filling factors at which the first start is kept for the page."""
SMOOTH = 1.1
"""Ratio of filling factors over which a pressure is a mean."""


@click.command("compress")
@aggregate_options
@click.option(
    "--strain-rate", default=1e-5, show_default=True, type=Finite(0, FASTEST, min_open=True),
    help="C_v: the box shrinks with dL/dt = -2 C_v L/t_0. The smaller, the lower the phi from which it is static.",
)  # fmt: skip
@click.option(
    "--until-phi", default=0.3, show_default=True, type=Finite(0, DENSEST, min_open=True),
    help="Filling factor at which to end.",
)  # fmt: skip
def command(file, material, unit, starts, out, strain_rate, until_phi):
    """Squeeze an aggregate by its own copies in a periodic box that shrinks.

    The answer is the mean over several starts, whose monomers are moved by 1e-12 m, with their standard deviation. The
    runs stand in OUT.nc, a figure in OUT.png, the first one in 3D in OUT.html. After Ctrl-C the same command goes on.
    """
    given = aggregate(file, unit, material)
    out = file.with_name(f"{file.stem}_compressed") if out is None else out
    settings = {"material": asdict(material), "unit": unit, "strain_rate": strain_rate, "until_phi": until_phi}
    made_with = provenance(source_hash(modules=["ratd.experiments.compression.run", *OF_STARTS]), settings, [file])

    def make(start, checkpoint, progress):
        begun = time.monotonic()
        grain = started(given, start)
        run = compress(
            grain,
            strain_rate,
            until_phi,
            snapshots=np.geomspace(0.003, until_phi, SNAPSHOTS) if start == 0 else (),
            checkpoint=checkpoint,
            progress=lambda phi, pressure, to_go: progress(part_done(begun, to_go)),
        )
        return run_row(run)

    target = out.with_name(f"{out.name}.nc")
    several(target, "compression", material, made_with, starts, make)
    click.echo("\n".join([*show(target, out), f"{target} written"]))


def show(path, out):
    """Figure and answers of a file of compressions.

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
    late = first["static_from"] > found[0]["phi"].values[0]
    static = f"phi = {first['static_from']:.3g} on" if late else "the start"
    lines = [
        f"{plural(len(found), 'start')} of {plural(first['n_monomers'], 'monomer')}, mean ± standard deviation (of one "
        f"cluster; others differ by 15 to 20 %); static from {static}, P_0 = {first['rolling_pressure']:.4g} Pa:"
    ]
    for phi in TOLD:
        pressures = [pressure_at(run, phi) for run in found]
        if np.isfinite(pressures).any():
            over = np.nanmean(pressures) / (first["rolling_pressure"] * phi**3)
            unlike = ", not static yet" if phi < first["static_from"] else ""
            lines.append(f"{answer(f'P at phi {phi:g}', pressures, 'Pa')}: {over:.3g} P_0 phi³{unlike}")
    figure = Path(f"{out}.png")
    save(_figure(found), figure)
    lines.append(f"{figure} written")
    for run in found:
        if run.sizes.get("snapshot", 0):
            page = Path(f"{out}.html")
            write_text(page, page_of(run))
            lines.append(f"{page} written")
            break
    return lines


def pressure_at(run, phi):
    """Mean pressure [Pa] of the records within half of `SMOOTH` of a filling factor, NaN where there is none."""
    near = np.abs(np.log(run["phi_mean"].values / phi)) <= 0.5 * np.log(SMOOTH)
    inside = run["phi"].values[0] < phi <= run["phi"].values[-1] * (1 + 1e-9)
    return float(run["pressure"].values[near].mean()) if near.any() and inside else np.nan


@styled
def _figure(found):
    """Pressure of all starts against the filling factor, beside P_0 phi^3."""
    first = found[0].attrs
    title = f"{first['n_monomers']} monomers of {first['material']}, $C_v = {power(first['strain_rate'])}$"
    figure = new_figure(ONE_COLUMN, 0.9 * ONE_COLUMN, title)
    axes = figure.subplots()
    for k, run in enumerate(found):
        pressure = np.where(run["pressure"] > 0.0, run["pressure"], np.nan)
        axes.loglog(run["phi_mean"], pressure, color=HIGHLIGHT, lw=0.7, label=None if k else "starts")
    phi = np.array([found[0]["phi_mean"].values[0], found[0]["phi_mean"].values[-1]])
    axes.loglog(phi, first["rolling_pressure"] * phi**3, color="black", label=r"$P_0\phi^3$")
    axes.axvline(first["static_from"], color=GREY, ls=":", label="static from here")
    axes.set_xlabel(r"filling factor $\phi$")
    axes.set_ylabel("pressure [Pa]")
    logarithmic(axes.xaxis)
    logarithmic(axes.yaxis)
    axes.legend()
    return figure
