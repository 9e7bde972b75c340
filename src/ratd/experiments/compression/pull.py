"""Clusters that are compressed and pulled: the stages `press` and `stretch` of the pipeline."""

from pathlib import Path

import numpy as np
import xarray as xr

from ratd.engine.state import FIELD_TYPES, State
from ratd.experiments.compression.files import PULL, REFERENCE, read_cluster
from ratd.experiments.compression.run import compression_law
from ratd.experiments.compression.squeeze import squeezed, told
from ratd.experiments.compression.stretch import stretch
from ratd.pipeline import io
from ratd.pipeline.kinds import MATERIAL, Kind, Variable, kind_of, over, register

__all__ = ["press", "pressed", "pulled", "run"]

TWO_AXES = ("lost", "material")


def _state_variables():
    """Arrays of a state, as `ratd.experiments.compression.strain.strain_dataset` names them."""
    found = {}
    for name in State._fields:
        dims = tuple(f"{name}_{axis}" for axis in range(1 + (name in TWO_AXES)))
        dtype = FIELD_TYPES[name]
        meaning = f"{name} of the state, numbers in SI units as ratd.engine.state.State lays them out"
        found[f"state_{name}"] = Variable(dims, dtype, "1", meaning, nan=dtype == "f8")
    return found


register(
    "pressed",
    Kind(
        "A cluster compressed to one filling factor, as it is then: the state of the engine",
        {
            **over(("record",), {"phi": ("1", "filling factor")}),
            **over(("record", "axis"), {"box_length": ("m", "edges of the box")}),
            **_state_variables(),
        },
        attributes=("material", *MATERIAL, "law", "monomer_radius", "time_unit", "seed", "n_monomers"),
        references=REFERENCE,
    ),
)
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
                    "strength": ("Pa", "greatest tension, 0 where there is none"),
                    "residual": ("Pa", "pressure left at rest before the pulling"),
                    "surface_energy": ("J m-2", "gamma"),
                    "monomer_radius": ("m", "r_0"),
                },
            ),
            **over(("entry",), {"phi_strength": PULL["phi_strength"]}, nan=True),
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


def press(job):
    """Compress one cluster to the filling factor of the job, and keep the state.

    Parameters
    ----------
    job : ratd.pipeline.jobs.Job
    """
    grain = read_cluster(job.input[0])
    settings = job.settings | {"until_phi": float(job.wildcards.phi), "snapshots": []}
    checkpoint = Path(f"{job.output[0]}.checkpoint")
    compressed = squeezed(grain, settings, checkpoint=checkpoint, progress=told(job.progress(f"seed {grain.seed}")))
    job.write("pressed", pressed(compressed))
    checkpoint.unlink(missing_ok=True)


def pressed(compressed):
    """What a pull needs of a compression, of the kind ``pressed``.

    Parameters
    ----------
    compressed : xarray.Dataset
        From `ratd.compress`.
    """
    layout = kind_of("pressed")
    last = compressed[list(layout.variables)].isel(record=[-1]).drop_vars("axis")
    return xr.Dataset(last.variables, attrs={name: compressed.attrs[name] for name in layout.attributes})


def pulled(compressed, settings, *, progress=None, checkpoint=None):
    """One entry of the kind ``tension_set``.

    Parameters
    ----------
    compressed : xarray.Dataset
        From `ratd.compress`, or of the kind ``pressed``.
    settings : dict
        k_n and timestep_factor, and under ``pull`` strain_rate, axes and unload.
    progress, checkpoint
        As of `ratd.stretch`.
    """
    own = settings["pull"]
    how = {"law": compression_law(settings["k_n"]), "timestep_factor": settings["timestep_factor"]}
    run = stretch(
        compressed,
        own["strain_rate"],
        axes=own["axes"],
        unload=own["unload"],
        checkpoint=checkpoint,
        progress=progress,
        **how,
    )
    entry = {
        "phi_compressed": compressed["phi"].values[-1],
        "phi": run.attrs["phi_start"],
        "strain_rate": run.attrs["strain_rate"],
        "strength": run.attrs["tensile_strength"],
        "phi_strength": run.attrs["phi_strength"],
        "residual": run.attrs["residual_pressure"],
        "surface_energy": compressed.attrs["surface_energy"],
        "monomer_radius": run.attrs["monomer_radius"],
        "seed": run.attrs["seed"],
        "n_axes": len(own["axes"]),
        "n_monomers": run.attrs["n_monomers"],
        "unloaded": int(own["unload"]),
    }
    return xr.Dataset({name: ("entry", np.array([value])) for name, value in entry.items()})


def run(job):
    """Pull one cluster that was compressed to a filling factor.

    Parameters
    ----------
    job : ratd.pipeline.jobs.Job
    """
    compressed = io.read(job.input[0], "pressed")
    checkpoint = Path(f"{job.output[0]}.checkpoint")
    progress = told(job.progress(f"seed {compressed.attrs['seed']}"))
    job.write("tension_set", pulled(compressed, job.settings, progress=progress, checkpoint=checkpoint))
    checkpoint.unlink(missing_ok=True)
