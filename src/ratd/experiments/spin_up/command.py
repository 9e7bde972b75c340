"""``python -m ratd spin-up``: the angular velocity at which an aggregate from a file comes apart."""

import time
from dataclasses import asdict
from pathlib import Path

import click

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
from ratd.experiments.saved import read_runs
from ratd.experiments.spin_up.figures.figure4 import figure4
from ratd.experiments.spin_up.marks import disruption
from ratd.experiments.spin_up.run import spin_up
from ratd.experiments.spin_up.run_files import run_row
from ratd.pictures.grain_page import grain_page
from ratd.pictures.style import save
from ratd.pipeline.atomic import write_text
from ratd.pipeline.provenance import provenance, source_hash

__all__ = ["command", "show"]

MARKS = {
    "omega_disr": "omega of disruption, where the stress peaks",
    "omega_first_loss": "omega of the first loss of mass",
    "omega_mass_75": "omega where a quarter of the mass is lost",
}
SNAPSHOTS = 10
"""Records from one snapshot of the first start to the next."""


@click.command("spin-up")
@aggregate_options
@click.option(
    "--epsilon",
    type=Finite(0, 1, min_open=True),
    help="Rise with this (d omega/dt)/omega² without waiting: less accurate, seldom faster.  [default: wait]",
)
def command(file, material, unit, starts, out, epsilon):
    """Spin an aggregate up until it comes apart.

    The answer is the mean over several starts, whose monomers are moved by 1e-12 m, with their standard deviation. The
    runs stand in OUT.nc, a figure in OUT.png, the first one in 3D in OUT.html. After Ctrl-C the same command goes on.
    """
    given = aggregate(file, unit, material)
    out = file.with_name(f"{file.stem}_spin_up") if out is None else out
    settings = {"material": asdict(material), "unit": unit, "epsilon": epsilon}
    made_with = provenance(source_hash(modules=["ratd.experiments.spin_up.run", *OF_STARTS]), settings, [file])

    def make(start, checkpoint, progress):
        begun = time.monotonic()
        grain = started(given, start)
        return run_row(
            spin_up(
                grain,
                epsilon=epsilon,
                snapshot_every=SNAPSHOTS if start == 0 else 0,
                checkpoint=checkpoint,
                progress=lambda omega, mass, to_go, steps: progress(part_done(begun, to_go)),
            )
        )

    target = out.with_name(f"{out.name}.nc")
    several(target, "spinup", material, made_with, starts, make)
    click.echo("\n".join([*show(target, out), f"{target} written"]))


def show(path, out):
    """Figure, page and answers of a file of spin-ups.

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
    runs = read_runs(path)
    marks = [disruption(run) for run in runs]
    numbers = sorted({run.attrs["initial_n_monomers"] for run in runs})
    # starts of one grain, or grains that differ
    if len(numbers) == 1:
        what = f"{plural(len(runs), 'start')} of {plural(numbers[0], 'monomer')}"
    else:
        what = f"{plural(len(runs), 'grain')} of {numbers[0]} to {plural(numbers[-1], 'monomer')}"
    lines = [f"{what}, mean ± standard deviation:"]
    lines += [f"{answer(name, [float(mark[name]) for mark in marks], 'rad/s')}: {text}" for name, text in MARKS.items()]
    figure = Path(f"{out}.png")
    save(figure4(runs, marks), figure)
    lines.append(f"{figure} written")
    for run, mark in zip(runs, marks, strict=True):
        if run.sizes.get("snapshot", 0):
            page = Path(f"{out}.html")
            write_text(page, grain_page(run, float(mark["omega_disr"])))
            lines.append(f"{page} written")
            break
    return lines
