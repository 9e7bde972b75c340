"""ratd: the mechanics of dust aggregates in space, every monomer integrated.

A grain is grown and spun up until it comes apart:

>>> import ratd
>>> grain = ratd.grow("BAM2", a_eff=200e-9, material="q-S", seed=7)
>>> run = ratd.spin_up(grain, angular_acceleration=1e14)
>>> ratd.disruption(run)

Any spheres, by any contact law, in open space or in a periodic box:

>>> law = ratd.laws.dmt(friction="spring")
>>> run = ratd.evolve(position, radius, velocity, material="silica", law=law, duration=1e-8)
"""

from importlib import import_module

__version__ = "1.0.0"

# Loaded on first use: drawing a figure must not wait for compiled code, and a source hash must not follow this file.
_HOME = {
    "Grain": "aggregates.grain",
    "InputError": "base.errors",
    "FileError": "base.errors",
    "MATERIALS": "base.materials",
    "Material": "base.materials",
    "LongSteps": "experiments.compression.steps",
    "Particles": "aggregates.particles",
    "RadiusDistribution": "aggregates.radii",
    "compress": "experiments.compression.run",
    "compressive_strength": "experiments.compression.strength",
    "build_cluster": "aggregates.packed_clusters",
    "collide": "experiments.collision.run",
    "cut_bound": "experiments.spin_up.cut_bound",
    "disruption": "experiments.spin_up.marks",
    "evolve": "experiments.evolve",
    "fragmentation": "experiments.collision.fragmentation",
    "fragmentation_velocity": "experiments.collision.fragmentation",
    "fit_ensemble": "experiments.spin_up.eq33",
    "grow": "aggregates.growth",
    "grow_bcca": "aggregates.clusters",
    "mix": "base.materials",
    "mrn": "aggregates.mrn",
    "open_space": "geometry.box",
    "periodic": "geometry.box",
    "read_grains": "aggregates.files",
    "read_materials": "pipeline.config",
    "read_particles": "aggregates.particles",
    "read_runs": "experiments.saved",
    "read_table": "experiments.spin_up.run_files",
    "spin_up": "experiments.spin_up.run",
    "static_limit": "experiments.spin_up.static_limit",
    "stretch": "experiments.compression.stretch",
    "write_particles": "aggregates.write_particles",
}
__all__ = sorted([*_HOME, "laws"])


def __getattr__(name):
    if name in _HOME:
        value = getattr(import_module(f"ratd.{_HOME[name]}"), name)
        globals()[name] = value
        return value
    if name == "laws":
        return import_module("ratd.laws")
    raise AttributeError(f"module 'ratd' has no attribute {name!r}")


def __dir__():
    return __all__
