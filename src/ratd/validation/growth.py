"""Growth: porosity and contacts of aggregates of equal monomers against an independent generator, and isotropy."""

import numpy as np

from ratd.growth import grow_with_radii
from ratd.validation.tables import table_kind

MONOMER_RADIUS = 20e-9
"""Any will do: the form of aggregates of equal monomers depends on it by the compression of the contacts only."""
COLUMNS = {
    "type": ("", "growth: BA, BAM1 or BAM2"),
    "migration": ("", "where a monomer rolls to"),
    "n_monomers": ("1", "monomers"),
    "seed": ("1", "seed of the aggregate"),
    "n_contacts": ("1", "contacts"),
    "porosity": ("1", "porosity"),
    "enclosing_radius": ("m", "radius of the smallest sphere around all monomers"),
    "a_eff": ("m", "effective radius"),
    "fractal_dimension": ("1", "D_f, Eq. 8"),
    "square_x": ("1", "mean square of the x component of the directions of the contacts"),
    "square_y": ("1", "mean square of the y component of the directions of the contacts"),
    "square_z": ("1", "mean square of the z component of the directions of the contacts"),
}
KIND = table_kind("growth", "Aggregates of equal monomers", COLUMNS)
EXPECTED_POROSITY = {
    ("BA", 32): 0.79, ("BA", 128): 0.845, ("BA", 256): 0.849, ("BA", 512): 0.850,
    ("BAM1", 32): 0.64, ("BAM1", 128): 0.72, ("BAM1", 256): 0.75, ("BAM1", 512): 0.75,
    ("BAM2", 32): 0.46, ("BAM2", 128): 0.55, ("BAM2", 256): 0.58, ("BAM2", 512): 0.61,
}  # fmt: skip
"""Porosities of an independent generator that migrates to the nearest place (physics.md Sect. 2), each +-0.01."""
EXPECTED_CONTACTS = {"BA": (1, 1), "BAM1": (2, 3), "BAM2": (3, 6)}
"""N_con = p N - q without accidental contacts."""


def compute(settings, progress=None):
    """Grow aggregates of equal monomers, migrating to the nearest place.

    Parameters
    ----------
    settings : dict
        material, type, monomers (number), seeds (number).
    progress : callable, optional
        Called with a sentence.

    Returns
    -------
    list of dict
        Rows of `COLUMNS`.
    """
    rows = []
    for seed in range(settings["seeds"]):
        radius = np.full(settings["monomers"], MONOMER_RADIUS)
        grain = grow_with_radii(settings["type"], radius, settings["material"], seed, migration="nearest")
        direction = grain.position[grain.contacts[:, 0]] - grain.position[grain.contacts[:, 1]]
        direction /= np.linalg.norm(direction, axis=1)[:, None]
        square = (direction**2).mean(axis=0)
        rows.append(
            dict(
                type=settings["type"],
                migration="nearest",
                n_monomers=grain.n_monomers,
                seed=seed,
                n_contacts=grain.n_contacts,
                porosity=grain.shape.porosity,
                enclosing_radius=grain.enclosing_radius,
                a_eff=grain.effective_radius,
                fractal_dimension=grain.shape.fractal_dimension,
                square_x=square[0],
                square_y=square[1],
                square_z=square[2],
            )
        )
    if progress is not None:
        progress(f"{len(rows)} aggregates")
    return rows
