"""What the subcommands of all experiments share: options, starts, progress, and the answer with its uncertainty.

An aggregate is chaotic where contacts slip and break: a start that differs by less than an atom comes apart otherwise.
So each answer is that of several starts, whose scatter is its uncertainty.
"""

import math
import shutil
import time
from contextlib import suppress
from pathlib import Path

import click
import numpy as np

from ratd.aggregates.grain import Grain
from ratd.aggregates.particles import UNITS, read_particles
from ratd.base.checks import is_number
from ratd.base.errors import InputError
from ratd.base.jit import cache_file
from ratd.base.materials import MATERIALS, Material
from ratd.base.units import NM
from ratd.base.words import plural
from ratd.pipeline import io
from ratd.pipeline.atomic import atomic
from ratd.pipeline.blocks import rows
from ratd.pipeline.config import read_materials
from ratd.pipeline.partial import Block, Pieces, locked

__all__ = [
    "Finite",
    "aggregate",
    "aggregate_options",
    "answer",
    "material_options",
    "moved",
    "out_option",
    "progress_bar",
    "several",
    "started",
    "unit_option",
]

OF_STARTS = (__name__,)
"""Modules of which the hash of the source of a command's runs is made besides those of its experiment."""
SHIFT = 1e-12
"""How far the monomers of a start are moved [m], a hundredth of an atom."""


class Finite(click.FloatRange):
    """A range of numbers without NaN, which every comparison lets pass, and infinity."""

    def convert(self, value, param, ctx):
        number = super().convert(value, param, ctx)
        if not math.isfinite(number):
            self.fail(f"{value} is not a finite number", param, ctx)
        return number


class _OfMaterials(click.ParamType):
    """The name of a material, of ratd or of the file of the user's own, see `material_options`."""

    name = "name"

    def convert(self, value, param, ctx):
        table = ctx.meta.get(__name__, MATERIALS)
        if not isinstance(value, Material) and value not in table:
            own = "" if __name__ in ctx.meta else ", or one of your own in --materials-file"
            self.fail(f"{value!r} is not a material; allowed: {', '.join(table)}{own}", param, ctx)
        return value if isinstance(value, Material) else table[value]


def material_options(use, required=False):
    """The options that say what the monomers are made of, a decorator; the command gets a `Material`.

    Parameters
    ----------
    use : str
        What the material is of.
    required : bool, optional
    """

    def own(context, parameter, path):
        if path is not None:
            table = read_materials(path)
            if table.keys() == MATERIALS.keys():
                raise InputError(f"{path}: holds no material; allowed: names and values, as in config/materials.yaml")
            context.meta[__name__] = table

    def decorate(function):
        # the file is read first, wherever it stands on the line
        file = click.option(
            "--materials-file", type=click.Path(path_type=Path), callback=own, is_eager=True, expose_value=False,
            help="YAML with materials of your own, as config/materials.yaml.",
        )  # fmt: skip
        material = click.option(
            "--material", required=required, type=_OfMaterials(), help=f"{use}: {', '.join(MATERIALS)}, or your own."
        )
        return material(file(function))

    return decorate


def aggregate_options(function):
    """Arguments and options that say which aggregate is meant, of what, and how often; a decorator."""
    for decorate in (
        out_option("that of FILE and what is done"),
        click.option("--starts", default=5, show_default=True, type=click.IntRange(1, 1000), help="Number of starts."),
        unit_option(),
        material_options("Of all monomers", required=True),
        click.argument("file", type=click.Path(path_type=Path, dir_okay=False)),
    ):
        function = decorate(function)
    return function


def unit_option():
    """The option that says in which unit the lengths of a file are."""
    units = click.Choice(list(UNITS))
    return click.option("--unit", type=units, help="Of the lengths in FILE.  [default: what FILE states, or nm]")


def out_option(default):
    """The option that says where to write."""
    path = click.Path(path_type=Path)
    return click.option("--out", type=path, callback=_stem, help=f"Stem of the files written.  [default: {default}]")


def _stem(context, parameter, value):
    """A stem that files can be named after."""
    if value is None:
        return None
    if not value.name or value.is_dir():
        raise click.BadParameter(f"{value} is a folder; allowed: a stem in it, such as {value / 'mine'}")
    return value.with_suffix("") if value.suffix == ".nc" else value


def aggregate(path, unit, material):
    """The aggregate of a file, of which the number of spheres and their radii are said.

    Parameters
    ----------
    path : path-like
    unit : str or None
    material : Material

    Returns
    -------
    Grain

    Raises
    ------
    FileError, InputError
        One sentence with the file.
    """
    particles = read_particles(path, unit=unit)
    try:
        grain = particles.grain(material)
    except InputError as error:
        raise InputError(f"{path}: {error}") from error
    least, most = (f"{extreme / NM:.4g}" for extreme in (grain.radius.min(), grain.radius.max()))
    radii = f"radius {least}" if least == most else f"radii {least} to {most}"
    click.echo(f"{path}: {plural(grain.n_monomers, 'sphere')}, {radii} nm, {plural(grain.n_contacts, 'contact')}")
    return grain


def moved(position, start):
    """Positions of one of several starts.

    Parameters
    ----------
    position : (n, 3) float64 array
        Centres [m].
    start : int
        Its number; those of 0 are not moved.

    Returns
    -------
    (n, 3) float64 array
        Each monomer moved by `SHIFT` in a random direction, the same for the same number.
    """
    if start == 0:
        return position
    direction = np.random.default_rng(start).normal(size=position.shape)
    return position + SHIFT * direction / np.linalg.norm(direction, axis=1, keepdims=True)


def started(grain, start):
    """The aggregate of one of several starts, see `moved`.

    Parameters
    ----------
    grain : Grain
        As it stands in the file.
    start : int

    Returns
    -------
    Grain
    """
    return Grain(moved(grain.position, start), grain.radius, grain.material, type="aggregate", seed=start)


def several(target, kind, material, provenance, starts, make):
    """Write a file with the runs of several starts, unless it is there; a killed command goes on where it was.

    Parameters
    ----------
    target : path-like
        The file.
    kind : str
        Its kind, see `ratd.pipeline.kinds`.
    material : ratd.Material
    provenance : dict
        From `ratd.pipeline.provenance.provenance`.
    starts : int
        Their number.
    make : callable
        ``make(start, checkpoint, progress)`` returns the row of a start (see `ratd.pipeline.blocks`). It calls
        ``progress(part)`` with the part of the work that is done, and may keep what it needs to go on below the path
        `checkpoint`.

    Raises
    ------
    InputError
        If the file holds other runs, or fewer that were made with other packages, or others are not finished.
    """
    block = Block(Path(target), material, list(range(starts)), provenance)
    if _starts_there(block, kind) >= starts:
        return
    if block.others(kind):
        raise InputError(
            f"{block.folder} holds unfinished runs of another aggregate, other settings, or another version of ratd or "
            "of a package; finish them with their own command, remove the folder, or give another --out."
        )
    ran = cache_file(f"{kind}.ran")
    if not ran.exists():
        click.echo("The first call of a new version compiles, which takes a minute or two.")
    with locked(block.folder / "lock", click.echo):
        # the same command may have ended while this one waited
        there = _starts_there(block, kind)
        try:
            if there < starts:
                _make_starts(block, kind, there, make)
                with suppress(OSError):  # of a cache that cannot be written
                    ran.touch()
        except (InputError, RuntimeError):
            # what failed will do so again: only finished starts are worth keeping
            if not any(block.folder.glob("seed_*.nc")):
                shutil.rmtree(block.folder, ignore_errors=True)
            raise
        shutil.rmtree(block.folder, ignore_errors=True)


def _make_starts(block, kind, there, make):
    """Make the starts of a block that are not finished, and join them with those that its file has."""
    if there:
        with atomic(block.piece(0)) as piece:
            shutil.copyfile(block.target, piece)
    pieces = Pieces(block, kind)
    try:
        with progress_bar(len(block.seeds)) as tell:
            for start in block.seeds:
                tell(start, 0.0)
                if start not in pieces:
                    row = make(start, block.checkpoint(start), lambda part, start=start: tell(start, part))
                    pieces.add(start, row)
                tell(start, 1.0)
    finally:
        # also what was finished before a Ctrl-C or an error
        pieces.write()
    pieces.join()


def _starts_there(block, kind):
    """How many of these very runs the file of a block holds; InputError where others cannot stand beside them."""
    if not block.target.exists():
        return 0
    found = io.read(block.target, kind)
    made_with = found.attrs.get("versions")
    instead = "remove it, or give another --out."
    if not io.is_made_with(found, block.provenance | {"versions": made_with}):
        raise InputError(
            f"{block.target} holds runs of another aggregate, other settings or another version of ratd; {instead}"
        )
    there = len(rows(found, kind))
    # a finished file stays good with other packages, but it tells one set of versions for all of its rows
    if there < len(block.seeds) and not io.is_made_with(found, block.provenance):
        raise InputError(
            f"{block.target} holds {plural(there, 'start')} made with {made_with}, to which none of "
            f"{block.provenance['versions']} can be added; {instead}"
        )
    return there


class progress_bar:
    """A bar on the terminal for some starts, as a context that gives ``tell(start, part)``."""

    def __init__(self, starts):
        self._starts = starts
        self._bar = click.progressbar(length=1000 * starts, label=plural(starts, "start"), show_pos=False)
        self._done = 0

    def __enter__(self):
        self._bar.__enter__()
        return self._tell

    def __exit__(self, *error):
        return self._bar.__exit__(*error)

    def _tell(self, start, part):
        self._bar.label = f"start {start + 1} of {self._starts}"
        done = int(1000 * (start + min(max(part, 0.0), 1.0)))
        if done > self._done:  # a guess of the time to go may take some of it back
            self._bar.update(done - self._done)
            self._done = done


def part_done(begun, to_go):
    """Part of a run that is done, from when it began (`time.monotonic`) and the seconds that it has to go."""
    gone = time.monotonic() - begun
    return gone / (gone + to_go) if is_number(to_go) and gone + to_go > 0 else 0.0


def answer(name, values, unit):
    """A quantity with its uncertainty, from that of each start.

    Parameters
    ----------
    name : str
    values : array_like
        One a start; NaN where it has none.
    unit : str

    Returns
    -------
    str
        Such as ``"omega_disr = 3.21e+08 ± 4e+06 rad/s"``, with mean and standard deviation.
    """
    values = np.asarray(values, dtype=float)
    known = values[np.isfinite(values)]
    if not known.size:
        return f"{name}: unknown, no start shows it"
    few = f", known in {known.size} of {values.size} starts" if known.size < values.size else ""
    if known.size == 1:
        return f"{name} = {known[0]:.4g} {unit}{few}"
    return f"{name} = {known.mean():.4g} ± {known.std(ddof=1):.2g} {unit}{few}"
