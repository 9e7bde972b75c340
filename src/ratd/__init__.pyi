"""Types of the public names of `ratd`, which are loaded on first use."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

import pandas as pd
import xarray as xr
from numpy.typing import ArrayLike

from ratd import laws as laws
from ratd.aggregates.grain import Grain as Grain
from ratd.aggregates.particles import Particles as Particles
from ratd.aggregates.radii import RadiusDistribution
from ratd.base.errors import FileError as FileError
from ratd.base.errors import InputError as InputError
from ratd.base.materials import Material as Material

__version__: str
MATERIALS: dict[str, Material]

def cut_bound(grain: Grain, axis: ArrayLike | None = None, *, directions: int = 500) -> float: ...
def disruption(run: xr.Dataset) -> xr.Dataset: ...
def evolve(
    position: ArrayLike,
    radius: ArrayLike,
    velocity: ArrayLike | None = None,
    spin: ArrayLike | None = None,
    material: str | Material | Sequence[str | Material] = "q-S",
    *,
    law: Any = None,
    box: Any = None,
    duration: float,
    timestep: float | None = None,
    timestep_factor: float = 0.125,
    damping: Literal["implicit", "explicit"] = "implicit",
    drag: float = 0.0,
    contacts: ArrayLike | None = None,
    records: int = 100,
    balance: float | None = 0.05,
    checkpoint: str | Path | None = None,
    progress: Callable[[float, float, list[float]], object] | None = None,
) -> xr.Dataset: ...
def fit_ensemble(
    table: pd.DataFrame | xr.Dataset,
    mean_monomer_radius: Sequence[float | Literal["own"]] = (2e-08, "own"),
    *,
    mark: str = "omega_disr",
    n_bootstrap: int = 2000,
    confidence: float = 0.95,
    seed: int = 0,
    materials: Mapping[str, Material] | None = None,
) -> xr.Dataset: ...
def grow(
    type: Literal["BA", "BAM1", "BAM2"],
    a_eff: float,
    material: str | Material,
    seed: int,
    *,
    distribution: RadiusDistribution | None = None,
    migration: Literal["random", "nearest"] = "random",
) -> Grain: ...
def mix(name: str, fractions: Mapping[str, float], table: Mapping[str, Material] | None = None) -> Material: ...
def open_space() -> Any: ...
def periodic(
    length: float | ArrayLike,
    rate: float | ArrayLike = 0.0,
    *,
    scheme: Literal["homogeneous", "as_printed"] = "homogeneous",
) -> Any: ...
def read_particles(path: str | Path, unit: str = "nm", frame: int = -1) -> Particles: ...
def spin_up(
    grain: Grain,
    *,
    drive: Literal["prescribed", "torque", "literal"] = "prescribed",
    stretch: float | None = None,
    pace: float = 0.02,
    unrest: float = 0.02,
    drag: float = 1.0,
    epsilon: float | None = None,
    angular_acceleration: float | None = None,
    coriolis: Literal["exact", "explicit"] | None = None,
    timestep_factor: float = 0.125,
    damping: Literal["implicit", "explicit"] = "implicit",
    integrator: Any = None,
    law: Any = None,
    max_steps: int | None = None,
    records: int = 300,
    snapshot_every: int = 0,
    checkpoint: str | Path | None = None,
    progress: Callable[[float, float, float, int], object] | None = None,
) -> xr.Dataset: ...
def write_particles(content: Grain | Particles | xr.Dataset, path: str | Path, unit: str = "nm") -> None: ...
