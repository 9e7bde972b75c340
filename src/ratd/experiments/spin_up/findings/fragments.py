"""What leaves a grain: while the first half of its mass does, and up to its last contact."""

import numpy as np

from ratd.base.statistics import mean_of
from ratd.base.measured import Measured
from ratd.experiments.spin_up.cells import size_key
from ratd.experiments.spin_up.fragmentation import exponents, mass_shares, size_class

__all__ = ["of_all_that_left", "of_exponents", "of_shares"]

SMALL = (50, 100, 150)
"""Sizes [nm]."""
FEW = 3
"""Greatest number of monomers of a piece of "a few"."""


def of_shares(letter, fragments):
    """Where the mass goes that leaves while the first half does: shares [%] by type and `size_class`.

    Of the small sizes (`SMALL`) one by one too, since there they fall with size.
    """
    half = fragments[fragments["half"]]
    nm = size_key(half["a_eff"]) / 1000.0
    parts = {f"{size} nm": half[nm == size] for size in SMALL}
    parts |= dict(iter(half.groupby(size_class(half["a_eff"]), observed=True)))
    return {
        f"{letter}.fragments {kind} {name} {monomers}": Measured(100.0 * share.value, 100.0 * share.error)
        for name, part in parts.items()
        for kind, own in part.groupby("type")
        for monomers, share in mass_shares(own).items()
    }


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
