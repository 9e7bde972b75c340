"""Clusters that are compressed and pulled: the stage `stretch` of the pipeline."""

import numpy as np
import xarray as xr

from ratd.experiments.compression.files import read_cluster
from ratd.experiments.compression.squeeze import law_of, squeezed, told
from ratd.experiments.compression.stretch import stretch
from ratd.pipeline.kinds import Kind, over, register

__all__ = ["pulled", "run"]

register(
    "tension_set",
    Kind(
        "Compressed clusters pulled until they come apart",
        {
            **over(
                ("entry",),
                {
                    "phi": ("1", "filling factor at which the pulling began"),
                    "strain_rate": ("1", "rate of the pulling in units of the compression: H t_0/2"),
                    "strength": ("Pa", "greatest tension"),
                    "phi_strength": ("1", "filling factor there"),
                    "residual": ("Pa", "pressure left at rest before the pulling"),
                    "surface_energy": ("J m-2", "gamma"),
                    "monomer_radius": ("m", "r_0"),
                },
            ),
            **over(
                ("entry",),
                {"seed": ("1", "seed"), "n_axes": ("1", "axes pulled"), "n_monomers": ("1", "N")},
                dtype="i8",
            ),
        },
    ),
)


def pulled(grain, settings, phi, say=None):
    """One entry of the kind ``tension_set``.

    Parameters
    ----------
    grain : Grain
    settings : dict
        Those of the compression, and under ``pull`` strain_rate and axes.
    phi : float
        Filling factor at which the compression ends and the pulling begins.
    say : callable, optional
        From `ratd.pipeline.jobs.Job.progress`.
    """
    progress = None if say is None else told(say)
    compressed = squeezed(grain, settings | {"until_phi": phi, "snapshots": []}, progress=progress)
    own = settings["pull"]
    how = {"axes": own["axes"], "law": law_of(settings), "progress": progress}
    run = stretch(compressed, own["strain_rate"], timestep_factor=settings["timestep_factor"], **how)
    entry = {
        "phi": run.attrs["phi_start"],
        "strain_rate": run.attrs["strain_rate"],
        "strength": run.attrs["tensile_strength"],
        "phi_strength": run.attrs["phi_strength"],
        "residual": run.attrs["residual_pressure"],
        "surface_energy": grain.material.surface_energy,
        "monomer_radius": run.attrs["monomer_radius"],
        "seed": grain.seed,
        "n_axes": len(own["axes"]),
        "n_monomers": grain.n_monomers,
    }
    return xr.Dataset({name: ("entry", np.array([value])) for name, value in entry.items()})


def run(job):
    """Compress one cluster to a filling factor and pull it.

    Parameters
    ----------
    job : ratd.pipeline.jobs.Job
    """
    grain = read_cluster(job.input[0])
    entry = pulled(grain, job.settings, float(job.wildcards.phi), job.progress(f"seed {grain.seed}"))
    job.write("tension_set", entry)
