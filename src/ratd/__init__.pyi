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
from ratd.aggregates.radii import RadiusDistribution as RadiusDistribution
from ratd.base.errors import FileError as FileError
from ratd.base.errors import InputError as InputError
from ratd.base.materials import Material as Material
from ratd.experiments.compression.steps import LongSteps as LongSteps

__version__: str
MATERIALS: dict[str, Material]

def build_cluster(
    radii: ArrayLike, radius: float, material: str | Material = "silica", *, second_contact: float = 0.0, seed: int = 0
) -> Grain: ...
def collide(
    a: Grain,
    b: Grain,
    velocity: float,
    impact_parameter: float = 0.0,
    seed: int = 0,
    law: Any = "dmt",
    *,
    duration: float = 3e-06,
    timestep: float | None = None,
    gap: float = 2e-08,
    records: int = 150,
    snapshot_every: int = 5,
    relaxed: bool = False,
    checkpoint: str | Path | None = None,
    progress: Callable[..., object] | None = None,
) -> xr.Dataset: ...
def compress(
    cluster: Any,
    strain_rate: float = 1e-06,
    until_phi: float = 0.5,
    *,
    material: str | Material | None = None,
    law: Any = None,
    timestep_factor: float = 0.14,
    long_steps: LongSteps | None = LongSteps(),  # noqa: B008
    box_length: float | None = None,
    scheme: Literal["homogeneous", "as_printed"] = "homogeneous",
    snapshots: Sequence[float] = (0.003, 0.01, 0.03, 0.1, 0.3),
    balance: bool = True,
    checkpoint: str | Path | None = None,
    progress: Callable[..., object] | None = None,
) -> xr.Dataset: ...
def compressive_strength(run: Any, low: float = 0.03, high: float = 0.12) -> dict[str, float]: ...
def cut_bound(grain: Grain, axis: ArrayLike | None = None, *, directions: int = 500) -> float: ...
def disruption(run: xr.Dataset, *, majority: float = 0.5, window: int = 5) -> xr.Dataset: ...
def evolve(
    position: ArrayLike,
    radius: ArrayLike,
    velocity: ArrayLike | None = None,
    spin: ArrayLike | None = None,
    material: str | Material | Sequence[str | Material] = "q-S",
    *,
    law: Any = None,
    box: Any = None,
    drive: Any = None,
    duration: float,
    timestep: float | None = None,
    timestep_factor: float | None = None,
    damping: Literal["implicit", "explicit"] | None = None,
    drag: float = 0.0,
    contacts: ArrayLike | None = None,
    records: int = 100,
    snapshot_every: int = 0,
    balance: float | None = 0.05,
    checkpoint: str | Path | None = None,
    progress: Callable[[float, float, dict[str, Any]], object] | None = None,
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
def fragmentation(run: xr.Dataset) -> Any: ...
def fragmentation_velocity(table: pd.DataFrame, *, limit: float = 0.15, samples: int = 1000, seed: int = 0) -> Any: ...
def grow(
    type: Literal["BA", "BAM1", "BAM2"],
    a_eff: float,
    material: str | Material,
    seed: int,
    *,
    distribution: RadiusDistribution | None = None,
    migration: Literal["random", "nearest"] = "random",
) -> Grain: ...
def grow_bcca(
    n: int,
    material: str | Material = "ice",
    seed: int = 0,
    *,
    radius: float | None = None,
    radii: Any = None,
    copies: bool = False,
) -> Grain: ...
def mix(name: str, fractions: Mapping[str, float], table: Mapping[str, Material] | None = None) -> Material: ...
def mrn(
    n: int,
    seed: int,
    *,
    smallest: float = 5e-08,
    largest: float = 2.5e-06,
    mass_within: float | None = 0.02,
    length_within: float | None = 0.05,
) -> Any: ...
def open_space() -> Any: ...
def periodic(
    length: float | ArrayLike,
    rate: float | ArrayLike = 0.0,
    *,
    scheme: Literal["homogeneous", "as_printed"] = "homogeneous",
) -> Any: ...
def read_grains(path: str | Path) -> list[Grain]: ...
def read_materials(path: str | Path) -> dict[str, Material]: ...
def read_runs(path: str | Path) -> list[xr.Dataset]: ...
def read_particles(path: str | Path, unit: str | None = None, frame: int = -1) -> Particles: ...
def read_table(path: str | Path) -> pd.DataFrame: ...
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
def static_limit(grain: Grain, axis: ArrayLike | None = None) -> float: ...
def stretch(
    compressed: Any,
    strain_rate: float = 3e-06,
    *,
    axes: Literal["x", "xyz"] = "x",
    unload: bool = False,
    box_length: Any = None,
    law: Any = None,
    timestep_factor: float = 0.14,
    long_steps: LongSteps | None = None,
    checkpoint: str | Path | None = None,
    progress: Callable[..., object] | None = None,
) -> Any: ...
def write_particles(content: Grain | Particles | xr.Dataset, path: str | Path, unit: str = "nm") -> None: ...
