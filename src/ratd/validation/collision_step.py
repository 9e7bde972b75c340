"""Small MRN clusters that collide, each collision with several steps: what the step does beside chaos.

The spheres are MRN from the printed 50 nm up, to 1 um only, so that a collision takes a minute and there can be many.
Their smallest spheres, and therefore the times that limit the step, are those of the clusters of docs/collision.md.
"""

import numpy as np

from ratd.aggregates.mrn import mrn
from ratd.aggregates.packed_clusters import build_cluster
from ratd.experiments.collision.fragmentation import fragmentation
from ratd.experiments.collision.run import at_rest, collide
from ratd.laws.dmt_with_friction import dmt
from ratd.validation.tables import GRAIN_COLUMNS, grain_values, table_kind

COLUMNS = {
    **GRAIN_COLUMNS,
    "velocity": ("m s-1", "velocity of one cluster against the other"),
    "rotation": ("1", "seed of the rotations"),
    "timestep": ("s", "time step"),
    "N_s": ("1", "mass outside of the two largest pieces over the whole"),
    "X": ("1", "mass of the largest piece less that of the second over the whole"),
    "n_pieces": ("1", "pieces at the end"),
    "energy_early": ("1", "kinetic energy at the early time over that of the impact"),
    "energy_late": ("1", "the same at the end"),
    "balance": ("1", "greatest error of the balance of energy over the energy of the impact"),
}
table_kind("collision_step", "Collisions of small MRN clusters with several steps", COLUMNS)
LAW = dmt(viscous_time=0.5e-9, friction="velocity")
"""That of most collisions of docs/collision.md."""
MASS_WITHIN, LENGTH_WITHIN = 0.05, 0.1
"""How near a sample is to the mass and the L_5 of the law: few spheres cannot be as near as 5000."""


def cluster(number, largest, filling_factor, second_contact, sample):
    """A small MRN cluster at rest.

    Parameters
    ----------
    number : int
        Of spheres.
    largest : float
        Radius up to which the law goes [m].
    filling_factor : float
        phi, which gives the radius of the cluster.
    second_contact : float
        See `ratd.build_cluster`.
    sample : int

    Returns
    -------
    ratd.Grain
    """
    radii = mrn(number, sample, largest=largest, mass_within=MASS_WITHIN, length_within=LENGTH_WITHIN)
    outer = np.cbrt(np.sum(radii**3) / filling_factor)
    return at_rest(build_cluster(radii, outer, second_contact=second_contact, seed=sample), LAW)


def compute(settings, progress=None):
    """One cluster, velocity and rotation with all steps.

    Parameters
    ----------
    settings : dict
        number, largest [m], filling_factor, second_contact, sample; velocity [m/s], rotation; timestep [s] (list),
        duration, early [s].
    progress : callable, optional
        Called with a sentence after each run.

    Returns
    -------
    list of dict
        Rows of `COLUMNS`.
    """
    own = cluster(*(settings[name] for name in ("number", "largest", "filling_factor", "second_contact", "sample")))
    rows = []
    for timestep in settings["timestep"]:
        run = collide(
            own, own, settings["velocity"], seed=settings["rotation"], law=LAW, duration=settings["duration"],
            timestep=timestep, records=50, snapshot_every=0, relaxed=True,
        )  # fmt: skip
        pieces = fragmentation(run)
        energy = (run["kinetic_translation"] + run["kinetic_spin"]).values / run.attrs["impact_energy"]
        rows.append(
            dict(
                **grain_values(own),
                velocity=settings["velocity"],
                rotation=settings["rotation"],
                timestep=timestep,
                N_s=float(pieces["N_s"]),
                X=float(pieces["X"]),
                n_pieces=len(pieces["piece_mass"]),
                energy_early=float(np.interp(settings["early"], run["time"].values, energy)),
                energy_late=float(energy[-1]),
                balance=run.attrs["balance"],
            )
        )
        if progress is not None:
            progress(f"{timestep * 1e12:g} ps: N_s {rows[-1]['N_s']:.3f}, X {rows[-1]['X']:.3f}")
    return rows
