"""Clusters that are compressed and pulled: the stage `stretch` of the pipeline."""

from pathlib import Path

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
                    "phi_compressed": ("1", "filling factor at which the compression ended"),
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
                {
                    "seed": ("1", "seed"),
                    "n_axes": ("1", "axes pulled"),
                    "n_monomers": ("1", "N"),
                    "unloaded": ("1", "1 where the box first grew until nothing pressed on it any more, else 0"),
                },
                dtype="i8",
            ),
        },
    ),
)


def pulled(grain, settings, phi, *, say=None, checkpoint=None):
    """One entry of the kind ``tension_set``.

    Parameters
    ----------
    grain : Grain
    settings : dict
        Those of the compression, and under ``pull`` strain_rate, axes and unload.
    phi : float
        Filling factor at which the compression ends and the pulling begins.
    say : callable, optional
        From `ratd.pipeline.jobs.Job.progress`.
    checkpoint : path-like, optional
        Where the compression keeps what it needs to go on after a kill; the pull does beside it, in a file of which the
        name ends with ``.pull``.
    """
    progress = None if say is None else told(say)
    compressed = squeezed(
        grain, settings | {"until_phi": phi, "snapshots": []}, checkpoint=checkpoint, progress=progress
    )
    own = settings["pull"]
    run = stretch(
        compressed,
        own["strain_rate"],
        axes=own["axes"],
        unload=own["unload"],
        law=law_of(settings),
        timestep_factor=settings["timestep_factor"],
        checkpoint=None if checkpoint is None else f"{checkpoint}.pull",
        progress=progress,
    )
    entry = {
        "phi_compressed": compressed["phi"].values[-1],
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
        "unloaded": int(own["unload"]),
    }
    return xr.Dataset({name: ("entry", np.array([value])) for name, value in entry.items()})


def run(job):
    """Compress one cluster to a filling factor and pull it.

    Parameters
    ----------
    job : ratd.pipeline.jobs.Job
    """
    grain = read_cluster(job.input[0])
    checkpoint = Path(f"{job.output[0]}.checkpoint")
    say = job.progress(f"seed {grain.seed}")
    entry = pulled(grain, job.settings, float(job.wildcards.phi), say=say, checkpoint=checkpoint)
    job.write("tension_set", entry)
    for path in (checkpoint, Path(f"{checkpoint}.pull")):
        path.unlink(missing_ok=True)
