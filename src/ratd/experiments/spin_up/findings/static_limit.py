"""What the document tells of the static limit of grains as grown, see `ratd.experiments.spin_up.static_limit`."""

from ratd.base.errors import InputError
from ratd.base.measured import Measured, geometric_mean
from ratd.experiments.spin_up.cells import TYPES, cell_of, joined
from ratd.experiments.spin_up.findings.ensemble import CLASSES, of_class
from ratd.experiments.spin_up.size_law import size_law

__all__ = ["of_static_limits"]

MARKS = {"omega_first_loss": "first", "omega_mass_75": "quarter"}
"""Mark of a driven grain -> its word in a slot."""


def of_static_limits(limits, driven):
    """What a document says of it.

    Parameters
    ----------
    limits : pandas.DataFrame
        Of `ratd.experiments.spin_up.static_limit.read_limits`.
    driven : pandas.DataFrame
        Driven grains with the printed omega, as `ratd.experiments.spin_up.findings.ensemble.beside_print` returns them.

    Returns
    -------
    dict
        ``static.grains``, how many; ``static.TYPE CLASS SLOT`` with a class of sizes of `CLASSES`: ``over firm``, the
        static limit over the firm bound; ``first`` and ``quarter``, the omega of the mark over the static limit;
        ``printed``, the printed omega over it, geometric means over grains; ``first least`` and ``first most``, single
        ones. ``static.TYPE power`` and ``static.TYPE power first``: power of size from 300 nm on of the limit, and of
        the first loss of the same grains.

    Raises
    ------
    InputError
        If a grain was not spun up.
    """
    table = joined(driven, limits, ["firm_bound", "static_limit"])
    if len(table) < len(limits):
        raise InputError(f"{len(limits) - len(table)} grains with a static limit were not spun up")
    values = {"static.grains": len(table)}
    for kind in TYPES:
        for name in CLASSES:
            own = of_class(table[table["type"] == kind], name)
            limit, start, cell = own["static_limit"], f"static.{kind} {name}", cell_of(own)
            values[f"{start} over firm"] = geometric_mean(limit / own["firm_bound"], cell)
            values[f"{start} printed"] = geometric_mean(own["printed"] / limit, cell)
            for mark, word in MARKS.items():
                known = own[own[mark].notna()]
                values[f"{start} {word}"] = geometric_mean(known[mark] / known["static_limit"], cell_of(known))
            first = own["omega_first_loss"] / limit
            values[f"{start} first least"], values[f"{start} first most"] = first.min(), first.max()
        large = of_class(table[table["type"] == kind], "large")
        for column, word in (("static_limit", ""), ("omega_first_loss", " first")):
            law = size_law(large, column).iloc[0]
            values[f"static.{kind} power{word}"] = Measured(-law["p"], law["p_error"])
    return values
