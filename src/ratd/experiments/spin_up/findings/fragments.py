"""What leaves a grain: while the first half of its mass does, and up to its last contact."""

import numpy as np

from ratd.base.statistics import mean_of
from ratd.base.measured import Measured
from ratd.experiments.spin_up.cells import size_key
from ratd.experiments.spin_up.fragmentation import exponents, fragment_shares, size_class

__all__ = ["of_all_that_left", "of_exponents", "of_shares"]

SMALL = (50, 100, 150)
"""Sizes [nm]."""
FEW = 3
"""Greatest number of monomers of a piece of "a few"."""


def of_shares(letter, fragments):
    """Where the mass goes that leaves while the first half does: shares [%] by type and `size_class`.

    Of the small sizes (`SMALL`) one by one too, since there they fall with size.
    """
    values = {}
    sizes = size_key(fragments["a_eff"]) / 1000.0
    for size in SMALL:
        for row in fragment_shares(fragments[sizes == size], "half").to_dict("records"):
            start = f"{letter}.fragments {row['type']} {size} nm {row['class']}"
            values[start] = Measured(100 * row["mass_share"], 100 * row["mass_share_error"])
    for name, part in fragments.groupby(size_class(fragments["a_eff"]), observed=True):
        for row in fragment_shares(part, "half").to_dict("records"):
            start = f"{letter}.fragments {row['type']} {name} {row['class']}"
            values[start] = Measured(100 * row["mass_share"], 100 * row["mass_share_error"])
    return values


def of_all_that_left(letter, runs):
    """Share [%] of the mass that leaves up to the last contact in pieces of at most `FEW` monomers, mean of runs.

    Pieces are counted as they leave the largest one, and not followed on.
    """
    shares = []
    for run in runs:
        mass = run["fragment_mass"].values
        shares.append(100.0 * mass[run["fragment_n_monomers"].values <= FEW].sum() / mass.sum())
    return {f"{letter}.few in the end": Measured(*mean_of(np.array(shares)))}


def of_exponents(fragments):
    """Exponents of the sizes of the fragments of the first half of the mass, and the large pieces of a grain."""
    values = {}
    for row in exponents(fragments).to_dict("records"):
        start = f"fragments.{row['type']} {row['size_class']}"
        values[f"{start} exponent"] = f"{row['exponent']:.2f} ({row['low']:.2f}–{row['high']:.2f})"
        values[f"{start} pieces"] = Measured(row["large_pieces"], row["large_pieces_error"])
        values[f"{start} justified"] = row["probability"]
    return values
