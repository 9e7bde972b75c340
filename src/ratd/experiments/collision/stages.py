"""Stages of the pipeline: clusters are built, brought to rest, and shot at each other."""

import numpy as np

from ratd.aggregates.packed_clusters import build_cluster, number_of_equal_mass
from ratd.aggregates.mrn import mrn
from ratd.base.materials import Material
from ratd.experiments.collision.files import cluster_row, clusters_of, collision_row
from ratd.experiments.collision.run import at_rest, collide
from ratd.laws.dmt_with_friction import DMT, FRICTIONS, dmt, viscous_time_of
from ratd.laws.jkr_with_springs import jkr
from ratd.pipeline import io
from ratd.pipeline.jobs import duration

__all__ = ["build", "collide_all", "collided", "contact_of", "law_from", "radii_from", "relax", "told"]


def radii_from(settings, sample):
    """Radii of one sample of a cluster.

    Parameters
    ----------
    settings : dict
        `radii` "mrn" or "equal"; `total_cube`, the sum of the radii cubed [m3], where `number` is None; for "mrn"
        `smallest`, `largest`, `drop_below` [m], `mass_within`, `length_within`; for "equal" `radius` and `giant` [m],
        the radius of one sphere in addition, whose volume the others make room for (None for none).
    sample : int

    Returns
    -------
    (n,) float64 array
        [m]
    """
    if settings["radii"] == "mrn":
        number = settings["number"]
        ends = {name: settings[name] for name in ("smallest", "largest", "mass_within", "length_within")}
        radii = mrn(number, sample, **ends)
        return radii[radii >= settings["drop_below"]]
    giant = settings["giant"]
    left = settings["total_cube"] - (giant or 0.0) ** 3
    radii = np.full(number_of_equal_mass(settings["radius"], left), settings["radius"])
    return radii if giant is None else np.concatenate([[giant], radii])


def law_from(settings):
    """The law of a part of the config: `law`, and for DMT its options."""
    options = {name: value for name, value in settings.items() if name != "law"}
    return dmt(**options) if settings["law"] == "dmt" else jkr(**options)


def contact_of(law, material):
    """What a row of a file of collisions says of a law: ``friction``, and ``damping_time`` [s], 0 but for DMT."""
    if isinstance(law, DMT):
        return {"friction": FRICTIONS[law.friction], "damping_time": viscous_time_of(law, material)}
    return {"friction": "jkr", "damping_time": 0.0}


def built(settings, sample):
    """The cluster of a sample, `ratd.Grain`."""
    radii = radii_from(settings, sample)
    material = Material(**settings["material"])
    return build_cluster(
        radii, settings["cluster_radius"], material, second_contact=settings["second_contact"], seed=sample
    )


def build(job):
    """Build all samples of a cluster, the stage `build`."""
    settings = job.settings

    def make(sample, checkpoint):
        return cluster_row(built(settings, sample), settings["cluster_radius"], settings["name"])

    job.block(job.output[0], "built_clusters", Material(**settings["material"]), settings["samples"], make)


def relax(job):
    """Bring all samples of a cluster to rest under a law, the stage `relax`."""
    file = io.read(job.input[0], "built_clusters")
    clusters, law = clusters_of(file), law_from(job.settings["law"])
    radius = dict(zip(file["seed"].values.tolist(), file["cluster_radius"].values.tolist(), strict=True))

    def make(sample, checkpoint):
        return cluster_row(at_rest(clusters[sample], law), radius[sample], file.attrs["cluster"])

    material = next(iter(clusters.values())).material
    job.block(job.output[0], "built_clusters", material, list(clusters), make)


def told(say):
    """Callback for `ratd.collide` that tells how far a collision is.

    Parameters
    ----------
    say : callable
        From `ratd.pipeline.jobs.Job.progress`.
    """

    def progress(time, pieces, energy_left, seconds_to_go):
        say(
            lambda: (
                f"{time * 1e6:.3f} us, {pieces} pieces, {100 * energy_left:.0f} % of the energy left, "
                f"{duration(seconds_to_go)} to go"
            )
        )

    return progress


def collided(cluster, settings, rotation, *, snapshot_every=0, checkpoint=None, progress=None, source=""):
    """One collision of a cluster at rest with itself, as a row of a file of collisions.

    Parameters
    ----------
    cluster : ratd.Grain
        At rest, its seed being the number of the sample.
    settings : dict
        `law`, `velocity`, `impact_parameter`, `timestep` (None: from the smallest sphere), `duration`, `records`;
        `law_name`, `cluster_name`, `second_contact`.
    rotation : int
    snapshot_every : int
    checkpoint, progress
        As for `ratd.collide`.
    source : str
        Hash of the source.
    """
    law = law_from(settings["law"])
    run = collide(
        cluster, cluster, settings["velocity"], settings["impact_parameter"], rotation, law,
        duration=settings["duration"], timestep=settings["timestep"], records=settings["records"],
        snapshot_every=snapshot_every, relaxed=True, checkpoint=checkpoint, progress=progress,
    )  # fmt: skip
    return collision_row(
        run,
        sample=cluster.seed,
        law=settings["law_name"],
        cluster=settings["cluster_name"],
        **contact_of(law, cluster.material),
        second_contact=settings["second_contact"],
        source=source,
    )


def collide_all(job):
    """All rotations of one cluster at one velocity, the stage `collide`."""
    settings = job.settings
    file = io.read(job.input[0], "built_clusters")
    cluster = clusters_of(file)[settings["sample"]]

    def make(rotation, checkpoint):
        every = settings["snapshots"].get(str(rotation), 0)
        progress = told(job.progress(f"rotation {rotation}"))
        source = job.provenance["code_hash"]
        how = {"snapshot_every": every, "checkpoint": checkpoint, "progress": progress, "source": source}
        return collided(cluster, settings, rotation, **how)

    job.block(job.output[0], "collisions", cluster.material, settings["rotations"], make)
