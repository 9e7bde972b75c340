"""``python -m ratd show``: what is in a file, as a picture and in numbers."""

from importlib import import_module
from pathlib import Path

import click
import numpy as np
from matplotlib.colors import to_rgb

from ratd.aggregates.files import read_grains
from ratd.aggregates.particles import read_particles
from ratd.base.errors import InputError
from ratd.base.words import plural
from ratd.experiments.command import material_options, out_option, unit_option
from ratd.experiments.saved import kind_in
from ratd.geometry.shape import Shape, centre_of_mass
from ratd.pictures.snapshots import OTHERS
from ratd.pictures.spheres import render, view_axes
from ratd.pictures.spheres import show as draw
from ratd.pictures.style import ONE_COLUMN, new_figure, plain, save, styled

__all__ = ["command", "show"]

VIEW, UP = (0.75, -0.55, 0.37), (0.0, 0.0, 1.0)


@click.command("show")
@click.argument("file", type=click.Path(path_type=Path, dir_okay=False))
@unit_option()
@material_options("Of a file of spheres, to count its contacts")
@out_option("that of FILE")
def command(file, unit, material, out):
    """Show what is in FILE: spheres, or results of ratd."""
    out = file.with_suffix("") if out is None else out
    if file.suffix != ".nc":
        particles = read_particles(file, unit=unit)
        contacts = "" if material is None else f", {plural(particles.grain(material).n_contacts, 'contact')}"
        lines = _picture(particles.position, particles.radius, plain(file.name), out, contacts)
    else:
        if unit is not None or material is not None:
            raise InputError(
                f"{file}: holds results, which know their unit and material; leave out --unit and --material"
            )
        lines = _of_results(file, out)
    click.echo("\n".join(lines))


def _of_results(path, out):
    """Pictures and lines of a file of results."""
    kind, by_ratd = kind_in(path)
    home = import_module(_home(path, kind))
    try:
        return home.show(path, out)
    except (InputError, KeyError) as error:
        if by_ratd:
            raise
        raise InputError(f"{path}: is not the whole of a run, as ratd returned it ({error})") from error


def _home(path, kind):
    """Module that shows files of a kind."""
    from ratd.command import SHOWN

    if kind not in SHOWN:
        what = "holds none of these" if kind is None else f"is a file of {kind}"
        raise InputError(
            f"{path}: {what}; allowed: files of {', '.join(SHOWN)}, what ratd.spin_up, compress, stretch or collide "
            "returned, saved with to_netcdf, or spheres"
        )
    return SHOWN[kind]


def show(path, out):
    """Picture of the first grain of a file of grains, and the numbers of all."""
    grains = read_grains(path)
    lines = [
        f"seed {grain.seed}: {plural(grain.n_monomers, 'monomer')}, {plural(grain.n_contacts, 'contact')}, "
        f"porosity {grain.shape.porosity:.3f}"
        for grain in grains
    ]
    first = grains[0]
    return lines + _picture(first.position, first.radius, f"{first.material.name} {first.type}, seed {first.seed}", out)


@styled
def _figure(position, radius, title):
    """Spheres in perspective shade, with a scale bar."""
    centre = centre_of_mass(position, radius**3)
    place = (position - centre) @ view_axes(VIEW, UP).T
    half_width = 1.05 * float(np.max(np.linalg.norm(place, axis=1) + radius))
    figure = new_figure(ONE_COLUMN, ONE_COLUMN, title)
    picture = render(place, radius, np.tile(to_rgb(OTHERS[4]), (len(radius), 1)), half_width, pixels=720)
    draw(figure.subplots(), picture, half_width)
    return figure


def _picture(position, radius, title, out, contacts=""):
    """Write the picture of an aggregate; what to say of it."""
    shape = Shape.measure(position, radius, 1.0, 0)
    least, greatest = (f"{value * 1e9:.4g}" for value in (radius.min(), radius.max()))
    radii = f"radii {least} to {greatest} nm" if least != greatest else f"radius {least} nm"
    path = Path(f"{out}.png")
    save(_figure(position, radius, title), path)
    return [
        f"{plural(len(radius), 'monomer')}{contacts}, {radii}",
        f"effective radius {np.cbrt(np.sum(radius**3)) * 1e9:.4g} nm, smallest sphere around it "
        f"{shape.enclosing_radius * 1e9:.4g} nm, porosity {shape.porosity:.3f}",
        f"{path} written",
    ]
