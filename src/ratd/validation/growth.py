"""Growth: aggregates of equal monomers for tests/reference/growth.py, isotropy, and the two ways to migrate.

Where the small monomers of a grain with the radii of the ensemble lie is measured along with its form.

Arrivals: the second monomer of many pairs comes in alone on the first, so that its straight line is known from its
place and its direction. Directions and places should be uniform over the sphere, squared impact parameters uniform up
to that of a grazing hit.
"""

import numpy as np
from scipy.stats import spearmanr

from ratd.aggregates.ballistic import place_monomers
from ratd.aggregates.growth import MIGRATIONS, TYPES, grow, grow_with_radii
from ratd.base.materials import get_material
from ratd.geometry.directions import random_direction, random_normal
from ratd.laws.contact_constants import equilibrium_compression, reduced_radius
from ratd.validation.tables import empty_row, table_kind

MONOMER_RADIUS = 20e-9
"""Any will do: the form of aggregates of equal monomers depends on it by the compression of the contacts only."""
NOT = "none"
"""Stands for the migration of BA grains, whose monomers stay where they hit."""
COLUMNS = {
    "study": ("", "aggregates: of equal monomers; grains: as in the ensemble; arrivals: one monomer on another"),
    "material": ("", "material"),
    "type": ("", "growth: BA, BAM1 or BAM2"),
    "migration": ("", "where a monomer rolls to, or none"),
    "n_monomers": ("1", "monomers"),
    "seed": ("1", "seed of the aggregate"),
    "n_contacts": ("1", "contacts"),
    "porosity": ("1", "porosity"),
    "enclosing_radius": ("m", "radius of the smallest sphere around all monomers"),
    "a_eff": ("m", "effective radius"),
    "fractal_dimension": ("1", "D_f, Eq. 8"),
    **{f"axis_{axis}": ("m", f"semi-axis {axis} of a grain, a < b < c, Eqs. 4-6") for axis in "abc"},
    "depth_correlation": ("1", "rank correlation of the radius of a monomer with its distance from the centre of mass"),
    "square_x": ("1", "mean square of the x component of the directions of the contacts"),
    "square_y": ("1", "mean square of the y component of the directions of the contacts"),
    "square_z": ("1", "mean square of the z component of the directions of the contacts"),
    "impact": ("1", "squared impact parameter of an arrival over the greatest that hits"),
    **{f"direction_{axis}": ("1", f"{axis} component of the direction of an arrival") for axis in "xyz"},
    **{f"place_{axis}": ("1", f"{axis} component of the direction to where an arrival ended") for axis in "xyz"},
}
table_kind("growth", "Growth", COLUMNS)


def arrival(radius, material, seed):
    """The line and the place of the second of two monomers of equal radius.

    Parameters
    ----------
    radius : float
        [m]
    material : ratd.Material
    seed : int
        Of the random numbers.

    Returns
    -------
    direction, place : (3,) arrays
        Unit vectors: of flight, and from the first monomer to the second.
    impact : float
        Squared distance of the line from the first monomer over the squared contact distance, from the two.

    Raises
    ------
    RuntimeError
        If the place is not where the line that was drawn touches.

    Notes
    -----
    Growth does not tell its directions; they are drawn again with the same random numbers. A try is a direction (2
    numbers), a normal (1) and an impact parameter (1), those that miss included.
    """
    constants = material.surface_energy, material.reduced_modulus
    radii = np.full(2, radius)
    place = place_monomers(radii, *constants, 0, False, np.random.Generator(np.random.PCG64(seed)))[1]
    touching = 2.0 * radius - equilibrium_compression(reduced_radius(radius, radius), *constants)
    again = np.random.Generator(np.random.PCG64(seed))
    aside = np.inf
    while aside >= touching:
        direction = np.array(random_direction(again))
        normal = np.array(random_normal(*direction, again))
        aside = 2.0 * radius * np.sqrt(again.random())
    across = place - (place @ direction) * direction
    if place @ direction > 0.0 or np.linalg.norm(across - aside * normal) > 1e-9 * touching:
        raise RuntimeError(f"the monomer with seed {seed} did not come in on the line that was drawn")
    return direction, place / np.linalg.norm(place), (across @ across) / touching**2


def compute(settings, progress=None):
    """Grow aggregates of equal monomers or grains as in the ensemble, or let monomers come in on one other.

    Parameters
    ----------
    settings : dict
        material, and either arrivals (number), or type, seeds (number), and monomers (number) or a_eff [m] with
        migration (one of `ratd.aggregates.growth.MIGRATIONS`).
    progress : callable, optional
        Called with a sentence.

    Returns
    -------
    list of dict
        Rows of `COLUMNS`.
    """
    grown = grains if "a_eff" in settings else aggregates
    rows = arrivals(settings) if "arrivals" in settings else grown(settings)
    if progress is not None:
        progress(f"{len(rows)} {rows[0]['study']}")
    return rows


def arrivals(settings):
    """Rows of `COLUMNS`, one an arrival."""
    material = get_material(settings["material"])
    rows = []
    for seed in range(settings["arrivals"]):
        direction, place, impact = arrival(MONOMER_RADIUS, material, seed)
        row = empty_row(COLUMNS) | {"study": "arrivals", "material": material.name, "type": "BA", "n_monomers": 2}
        row |= {"seed": seed, "impact": impact}
        for k, axis in enumerate("xyz"):
            row |= {f"direction_{axis}": direction[k], f"place_{axis}": place[k]}
        rows.append(row)
    return rows


def aggregates(settings):
    """Rows of `COLUMNS`, one an aggregate of equal monomers, grown with each of `ways`."""
    kind, material = settings["type"], settings["material"]
    radius = np.full(settings["monomers"], MONOMER_RADIUS)
    rows = []
    for migration, how in ways(kind).items():
        for seed in range(settings["seeds"]):
            grain = grow_with_radii(kind, radius, material, seed, **how)
            rows.append(_row("aggregates", grain, seed, migration) | _mean_squares(grain))
    return rows


def grains(settings):
    """Rows of `COLUMNS`, one a grain with the radii of the ensemble."""
    kind, a_eff, material, migration = (settings[name] for name in ("type", "a_eff", "material", "migration"))
    rows = []
    for seed in range(settings["seeds"]):
        grain = grow(kind, a_eff, material, seed, migration=migration)
        row = _row("grains", grain, seed, migration if TYPES[kind] else NOT)
        row |= {f"axis_{axis}": getattr(grain.shape, axis) for axis in "abc"}
        rows.append(row | {"depth_correlation": depth_correlation(grain)})
    return rows


def ways(kind):
    """How the monomers of a type migrate: name -> what growth has to be told, dict."""
    return {NOT: {}} if not TYPES[kind] else {name: {"migration": name} for name in MIGRATIONS}


def depth_correlation(grain):
    """Spearman's rank correlation of the radius of a monomer with its distance from the centre of mass of the grain.

    Parameters
    ----------
    grain : ratd.Grain

    Returns
    -------
    float
        Above 0 where the smaller monomers lie deeper.
    """
    centre = np.average(grain.position, axis=0, weights=grain.radius**3)
    return float(spearmanr(grain.radius, np.linalg.norm(grain.position - centre, axis=1)).statistic)


def _row(study, grain, seed, migration):
    return empty_row(COLUMNS) | dict(
        study=study,
        material=grain.material.name,
        type=grain.type,
        migration=migration,
        n_monomers=grain.n_monomers,
        seed=seed,
        n_contacts=grain.n_contacts,
        porosity=grain.shape.porosity,
        enclosing_radius=grain.enclosing_radius,
        a_eff=grain.effective_radius,
        fractal_dimension=grain.shape.fractal_dimension,
    )


def _mean_squares(grain):
    """Mean squares of the components of the directions of the contacts."""
    direction = grain.position[grain.contacts[:, 0]] - grain.position[grain.contacts[:, 1]]
    direction /= np.linalg.norm(direction, axis=1)[:, None]
    return {f"square_{axis}": square for axis, square in zip("xyz", (direction**2).mean(axis=0), strict=True)}
