"""What leaves a grain while the first half of its mass does."""

from ratd.base.measured import Measured
from ratd.experiments.spin_up.fragmentation import exponents, fragment_shares, size_class

__all__ = ["of_exponents", "of_shares"]


def of_shares(letter, fragments):
    """Where the mass goes that leaves while the first half does: shares [%] by type and `size_class`."""
    values = {}
    for name, part in fragments.groupby(size_class(fragments["a_eff"]), observed=True):
        for row in fragment_shares(part, "half").to_dict("records"):
            start = f"{letter}.fragments {row['type']} {name} {row['class']}"
            values[start] = Measured(100 * row["mass_share"], 100 * row["mass_share_error"])
    return values


def of_exponents(fragments):
    """Exponents of the sizes of the fragments of the first half of the mass, and the large pieces of a grain."""
    values = {}
    for row in exponents(fragments).to_dict("records"):
        start = f"fragments.{row['type']} {row['size_class']}"
        values[f"{start} exponent"] = f"{row['exponent']:.2f} ({row['low']:.2f}–{row['high']:.2f})"
        values[f"{start} pieces"] = Measured(row["large_pieces"], row["large_pieces_error"])
        values[f"{start} justified"] = row["probability"]
    return values
