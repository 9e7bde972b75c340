"""Clusters that are grown for the compression: the stage `grow_cluster` of the pipeline."""

import numpy as np

from ratd.aggregates.clusters import grow_bcca
from ratd.aggregates.radii import RadiusDistribution, lognormal_radii, mrn_radii
from ratd.base.materials import Material
from ratd.experiments.compression.files import cluster_row

__all__ = ["cluster", "grown", "monomer_radii"]


def monomer_radii(n, radii):
    """Radii of n monomers [m], (n,), the quantiles (k + 1/2)/n of a distribution; None where all are equal.

    Parameters
    ----------
    n : int
    radii : dict or None
        ``law`` is "lognormal" (with ``median``, ``sigma_ln``, ``smallest``, ``largest``) or "mrn" (with ``smallest``,
        ``largest``) [m].
    """
    if radii is None:
        return None
    u = (np.arange(n) + 0.5) / n
    own = {name: value for name, value in radii.items() if name != "law"}
    return mrn_radii(u, **own) if radii["law"] == "mrn" else lognormal_radii(u, RadiusDistribution(**own))


def grown(settings, seed):
    """The cluster of a seed, `ratd.Grain`, from its settings: material, n, radius, radii, copies."""
    how = {name: settings[name] for name in ("radius", "copies")}
    radii = monomer_radii(settings["n"], settings["radii"])
    return grow_bcca(settings["n"], Material(**settings["material"]), seed, radii=radii, **how)


def cluster(job):
    """Grow one cluster.

    Parameters
    ----------
    job : ratd.pipeline.jobs.Job
    """
    material = Material(**job.settings["material"])
    seed = int(job.wildcards.seed)
    job.block(job.output[0], "clusters", material, [seed], lambda seed, _: cluster_row(grown(job.settings, seed)))
