"""Relaxation: whether grains as grown come to rest, and what that changes in them.

A spin-up begins with the grain at rest. One grain that does not come to rest ends its job with an error, and the table
of the paper is not made; so all grains of the ensemble are relaxed, which is quick beside a spin-up.
"""

from dataclasses import replace

import numpy as np

from ratd.aggregates.growth import grow
from ratd.base.errors import GrainError, is_of_one_grain
from ratd.base.materials import get_material
from ratd.engine.fragments import contact_pairs
from ratd.engine.state import positions_as_given
from ratd.experiments.relax import relax
from ratd.geometry.neighbours import connected_components
from ratd.geometry.shape import centre_of_mass, principal_axes
from ratd.validation.tables import GRAIN_COLUMNS, empty_row, grain_values, table_kind

COLUMNS = {
    **GRAIN_COLUMNS,
    "viscous_time": ("s", "T_vis of the damping, 0 without"),
    "rested": ("1", "1 where the grain came to rest, 0 where it did not; what follows is then not known"),
    "n_contacts": ("1", "contacts of the grain as grown"),
    "n_contacts_made": ("1", "contacts at rest that the grain as grown has not"),
    "n_contacts_lost": ("1", "contacts of the grain as grown that it has not at rest"),
    "n_parts": ("1", "parts that hang together at rest, 1 for a whole grain"),
    "moved": ("1", "greatest change of the distance of a monomer from the centre of mass, over the mean radius"),
    "inertia": ("1", "greatest moment of inertia at rest over that as grown"),
}
KIND = table_kind("relaxation", "Grains that come to rest", COLUMNS)


def rest(grain, timestep_factor):
    """What changes in a grain that comes to rest.

    Parameters
    ----------
    grain : ratd.Grain
    timestep_factor : float
        f of Eq. 31.

    Returns
    -------
    dict
        Columns from rested to inertia of `COLUMNS`.

    Raises
    ------
    GrainError
        If the grain comes apart.
    RuntimeError
        If the grain does not come to rest.
    """
    state = relax(grain, timestep_factor=timestep_factor)
    pairs = state.identity[contact_pairs(state)]
    before, after = ({tuple(sorted(pair)) for pair in each.tolist()} for each in (grain.contacts, pairs))
    positions = grain.position, positions_as_given(state)
    distance = [np.linalg.norm(each - centre_of_mass(each, grain.mass), axis=1) for each in positions]
    moments = [principal_axes(each, grain.mass, grain.radius)[0].max() for each in positions]
    return dict(
        rested=1,
        n_contacts=len(before),
        n_contacts_made=len(after - before),
        n_contacts_lost=len(before - after),
        n_parts=connected_components(grain.n_monomers, pairs).max() + 1,
        moved=np.abs(distance[1] - distance[0]).max() / grain.radius.mean(),
        inertia=moments[1] / moments[0],
    )


def compute(settings, progress=None):
    """Relax all grains of one material, type and size.

    Parameters
    ----------
    settings : dict
        material, type, a_eff [m], seeds (number), timestep_factor, damped (whether with the damping of the material).
    progress : callable, optional
        Called with a sentence for each grain that does not come to rest.

    Returns
    -------
    list of dict
        Rows of `COLUMNS`.
    """
    material = get_material(settings["material"])
    if not settings["damped"]:
        material = replace(material, viscous_time=0.0)
    rows = []
    for seed in range(settings["seeds"]):
        grain = grow(settings["type"], settings["a_eff"], material, seed)
        row = empty_row(COLUMNS) | grain_values(grain) | {"viscous_time": material.viscous_time}
        try:
            row |= rest(grain, settings["timestep_factor"])
        except (RuntimeError, GrainError) as error:
            if not is_of_one_grain(error):
                raise
            row |= {"rested": 0, "n_contacts": grain.n_contacts}
            if progress is not None:
                progress(f"seed {seed}: {error}")
        rows.append(row)
    return rows
