"""Made-up grains and spin-up runs that fill every variable of the files."""

import numpy as np
import xarray as xr

from ratd.aggregates import files as grain_files
from ratd.aggregates.grain import Grain
from ratd.base.materials import MATERIALS
from ratd.experiments.made_with import made_with
from ratd.experiments.spin_up import run_files
from ratd.experiments.spin_up.files import END_REASONS, RUN_VALUES
from ratd.laws.contact_constants import equilibrium_compression
from ratd.laws.jkr_with_springs import jkr
from ratd.pipeline import blocks, io, kinds


def make_grain(seed=0, n=3, material="q-S"):
    """A straight chain of n monomers whose radii depend on the seed."""
    constants = MATERIALS[material]
    radius = (20 + 5 * np.random.default_rng(seed).random(n)) * 1e-9
    z = [0.0]
    for a, b in zip(radius[:-1], radius[1:], strict=True):
        delta = equilibrium_compression(a * b / (a + b), constants.surface_energy, constants.reduced_modulus)
        z.append(z[-1] + a + b - delta)
    position = np.stack([np.zeros(n), np.zeros(n), z], axis=1)
    return Grain(position, radius, material, type="BA", seed=seed)


def make_run(seed=0, n_records=4, n_fragments=2, n_snapshots=0, n_monomers=3):
    """A run with every variable that a spin-up has; its numbers mean nothing."""
    rng = np.random.default_rng(seed)
    sizes = {"record": n_records, "fragment": n_fragments, "snapshot": n_snapshots, "monomer": n_monomers}
    run = xr.Dataset()
    for name, variable in kinds.kind_of("spinup").variables.items():
        dims = ("snapshot", "monomer") if variable.dims == ("snapshot_monomer",) else variable.dims
        if not dims or dims == (kinds.ROW,) or (n_snapshots == 0 and {"snapshot", "monomer"} & set(dims)):
            continue
        values = 1 + 10 * rng.random([sizes[dimension] for dimension in dims])
        run[name] = (dims, values.astype(variable.dtype), {"units": variable.units, "long_name": variable.long_name})
    numbers = {
        name: int(5 + seed) if variable.dtype != "f8" else 0.5 + seed
        for name, variable in RUN_VALUES.items()
        if not variable.flags
    }
    run.attrs = numbers | {
        "seed": seed,
        "end_reason": END_REASONS[seed % 2],
        "type": "BA",
        "drive": "prescribed",
        "spin_up_law": "quasi-static",
        "stretch": 2e-14,
        "unrest": 0.02,
        "pace": 0.02,
        "drag": 1.0,
        "epsilon": np.nan,
        "integrator": "semi-implicit",
        "displacement": 2e-10,
        "coriolis": "exact",
        "damping": "implicit",
        "timestep_factor": 0.05,
        **made_with(jkr(), [MATERIALS["q-S"]]),
    }
    return run


def grains_file(path, seeds=(0, 1, 2), attributes=None):
    """Write a file of grains with 3, 4, ... monomers."""
    grains = [make_grain(seed, n=3 + place) for place, seed in enumerate(seeds)]
    rows = [grain_files.grain_row(grain, cut_bound=1e8) for grain in grains]
    io.write(path, blocks.block(rows, "grains", MATERIALS["q-S"], attributes), "grains")
    return grains


def runs_file(path):
    """Write a file of three runs of different length, the middle one with snapshots."""
    runs = [make_run(0), make_run(1, n_records=6, n_fragments=0, n_snapshots=2, n_monomers=5), make_run(2, 3, 7)]
    rows = [run_files.run_row(run) for run in runs]
    io.write(path, blocks.block(rows, "spinup", MATERIALS["q-S"], {"code_hash": "0123"}), "spinup")
    return runs
