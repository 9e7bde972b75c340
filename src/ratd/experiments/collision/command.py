"""``python -m ratd collide``: what is left of an aggregate from a file that hits itself, or another one."""

import time
from dataclasses import asdict
from pathlib import Path

import click
import numpy as np

from ratd.base.errors import InputError
from ratd.base.words import plural
from ratd.experiments.collision.figures.snapshots import PANELS, origin_of, picture, positions
from ratd.experiments.collision.files import collision_row
from ratd.experiments.collision.run import DURATION, GAP, at_rest, collide, too_short
from ratd.experiments.command import OF_STARTS, Finite, aggregate, aggregate_options, answer, part_done, several
from ratd.experiments.collision.stages import contact_of
from ratd.experiments.saved import read_runs
from ratd.laws.chosen import law_of
from ratd.laws.dmt_with_friction import dmt
from ratd.pictures.collision_page import collision_page
from ratd.pictures.style import save
from ratd.pipeline.atomic import write_text
from ratd.pipeline.provenance import provenance, source_hash

__all__ = ["command", "show"]

SET = ("velocity", "impact_parameter", "sample", "n_monomers")
"""What rotations that are averaged have in common."""
ANSWERS = {
    "N_s": "fragmentation, 1 less the mass of the two largest pieces over that of all",
    "X": "agglomeration: 1 where the largest piece has all the mass, 0 where the two largest are alike",
    "n_pieces": "pieces, single spheres included",
}
"""Column -> what it is."""
SNAPSHOTS = 5
"""Records from one snapshot of the first rotation to the next."""


@click.command("collide")
@aggregate_options
@click.option("--velocity", required=True, type=Finite(0, 1e4, min_open=True), help="Of the collision [m/s].")
@click.option(
    "--other",
    type=click.Path(path_type=Path, dir_okay=False),
    help="File with the other aggregate.  [default: the same]",
)
@click.option(
    "--impact-parameter", default=0.0, show_default=True, type=Finite(0, 1, max_open=True),
    help="In the sum of the radii of both, from the centre of mass to the farthest surface.",
)  # fmt: skip
@click.option("--law", default="dmt", show_default=True, type=click.Choice(["dmt", "jkr"]), help="Of the contacts.")
@click.option("--duration", default=DURATION, show_default=True, type=Finite(0, 1e-3, min_open=True), help="[s]")
@click.option("--timestep", type=Finite(0, min_open=True), help="[s]  [default: by smallest sphere, law and velocity]")
def command(file, material, unit, starts, out, velocity, other, impact_parameter, law, duration, timestep):
    """Shoot an aggregate at itself, or at another one.

    Each start is another rotation of both. The answer is the mean over them with their standard deviation. The
    collisions stand in OUT.nc, the first one as pictures in OUT.png and in 3D in OUT.html. After Ctrl-C the same
    command goes on.
    """
    if velocity * duration < 2.0 * GAP:
        raise InputError(too_short(velocity, duration))
    files = [file] if other is None else [file, other]
    grains = [aggregate(path, unit, material) for path in files]
    out = file.with_name(f"{file.stem}_collided") if out is None else out
    how = {"velocity": velocity, "impact_parameter": impact_parameter, "law": law, "duration": duration}
    how |= {} if timestep is None else {"timestep": timestep}
    source = source_hash(modules=["ratd.experiments.collision.run", *OF_STARTS])
    made_with = provenance(source, {"material": asdict(material), "unit": unit, **how}, files)
    contact = contact_of(law_of(law, dmt), material)
    resting = []

    def make(start, checkpoint, progress):
        begun = time.monotonic()
        if not resting:
            resting.extend(at_rest(grain, law) for grain in grains)
        run = collide(
            resting[0],
            resting[-1],
            seed=start,
            relaxed=True,
            snapshot_every=SNAPSHOTS if start == 0 else 0,
            checkpoint=checkpoint,
            progress=lambda now, pieces, energy, to_go: progress(part_done(begun, to_go)),
            **how,
        )
        return collision_row(
            run,
            sample=0,
            law=law,
            cluster=file.stem,
            **contact,
            second_contact=np.nan,
            source=source,
        )

    target = out.with_name(f"{out.name}.nc")
    several(target, "collisions", material, made_with, starts, make)
    click.echo("\n".join([*show(target, out), f"{target} written"]))


def show(path, out):
    """Pictures, page and answers of a file of collisions.

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
    found = [_as_row(run, path) for run in read_runs(path)]
    alike = {}
    for row in found:
        alike.setdefault(tuple(row[name].item() for name in SET), []).append(row)
    lines = [line for key in sorted(alike) for line in _answers(dict(zip(SET, key, strict=True)), alike[key])]
    for row in found:
        if row.sizes.get("snapshot", 0):
            figure, page = Path(f"{out}.png"), Path(f"{out}.html")
            times, place, piece = positions(row)
            save(picture(row, times[-1] / (PANELS - 1)), figure)
            title = f"{row['cluster'].item()}, {row['velocity'].item():g} m/s"
            write_text(page, collision_page(times, place, row["radius"].values, piece, origin_of(piece), title))
            lines += [f"{figure} written", f"{page} written"]
            break
    return lines


def _answers(own, found):
    """What is said of collisions that differ in their rotation alone; `own` has what they share."""
    off = f", impact parameter {own['impact_parameter']:g}" if own["impact_parameter"] else ""
    sample = f", sample {own['sample']:g}" if own["sample"] else ""
    what = f"{plural(len(found), 'rotation')} of {plural(own['n_monomers'], 'sphere')} at {own['velocity']:g} m/s"
    lines = [f"{what}{off}{sample}, mean ± standard deviation:"]
    for name, text in ANSWERS.items():
        lines.append(f"{answer(name, [row[name].item() for row in found], '')}: {text}".replace(" :", ":"))
    return lines


def _as_row(run, path):
    """Row of a file of collisions, also of a run that its user saved."""
    if "impact_energy" not in run.attrs:
        return run
    law = str(run.attrs["law"]).split("(")[0].lower()
    return collision_row(run, sample=0, law=law, cluster=path.stem)
