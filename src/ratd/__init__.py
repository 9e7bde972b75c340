"""ratd: rotational disruption of porous dust aggregates.

>>> import ratd
>>> grain = ratd.grow("BAM2", a_eff=200e-9, material="q-S", seed=7)
>>> run = ratd.spin_up(grain, angular_acceleration=1e14)
>>> ratd.disruption(run)
"""

from importlib import import_module

# Loaded on first use: drawing a figure must not wait for compiled code, and a source hash must not follow this file.
_HOME = {
    "Grain": "aggregates.grain",
    "InputError": "base.errors",
    "FileError": "base.errors",
    "MATERIALS": "base.materials",
    "Material": "base.materials",
    "cut_bound": "experiments.spin_up.cut_bound",
    "disruption": "experiments.spin_up.marks",
    "fit_ensemble": "experiments.spin_up.eq33",
    "grow": "aggregates.growth",
    "mix": "base.materials",
    "spin_up": "experiments.spin_up.run",
}
__all__ = sorted(_HOME)


def __getattr__(name):
    if name in _HOME:
        value = getattr(import_module(f"ratd.{_HOME[name]}"), name)
        globals()[name] = value
        return value
    raise AttributeError(f"module 'ratd' has no attribute {name!r}")


def __dir__():
    return __all__
