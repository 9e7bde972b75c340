"""What the document tells of the grains that were pulled apart, see `ratd.experiments.spin_up.pulled`."""

from ratd.aggregates.strength import TENSILE_FACTOR
from ratd.base.measured import Measured, geometric_mean
from ratd.base.statistics import mean_of
from ratd.experiments.spin_up.cells import GRAIN, TYPES, cell_of
from ratd.experiments.spin_up.pulled import AXES, MARKS, VARIANTS, WAYS, beside_spin, usual

__all__ = ["of_pulled"]


def of_pulled(table, spun):
    """What a document says of it.

    Parameters
    ----------
    table : pandas.DataFrame
        Of `ratd.experiments.spin_up.pulled.read_pulled`.
    spun : pandas.DataFrame
        Of `ratd.experiments.spin_up.grain_table.spun_up_table`.

    Returns
    -------
    dict
        ``pulled.TYPE SLOT``, also for TYPE ``all``: geometric means over grains, all cells (a material, type and size)
        with the same weight, with standard errors from the scatter within the cells. ``box``, ``ends`` are S <a>/(gamma
        phi^1.8); ``spin`` the same of the tension at the loss of a quarter of the mass; ``over spin``, ``ends over
        spin`` the ratios of the same grains; ``omega`` what the force at the ends stands for, over the omega of the
        mark; these with ``first`` behind them for the first loss. ``box slow``, ``box less``, ``box more``, ``ends
        slow``, ... are strengths of a variant over the usual one of the same grains, ``ends middle``, ``ends shortest``
        those along other axes. ``kept`` and ``new`` (means) say what became of the contacts in the box, ``across`` how
        many held to copies; ``peak`` is what a shorter mean would give over the strength, ``residual`` the pressure
        left over the strength (median).
    """
    own = beside_spin(usual(table), spun)
    grains = table.drop_duplicates(GRAIN)
    values = {
        "pulled.grains": len(grains),
        "pulled.beside": int((own["spin_omega_mass_75"].notna() & (own["way"] == "box")).sum()),
        "pulled.fewest monomers": int(grains["n_monomers"].min()),
        "pulled.most monomers": int(grains["n_monomers"].max()),
        "pulled.unequal": float(own["unequal"].median()),
    }
    for kind in (*(kind for kind in TYPES if (own["type"] == kind).any()), "all"):
        of_kind = {f"pulled.{kind} {name}": value for name, value in _of_type(_only(own, kind)).items()}
        varied = {f"pulled.{kind} {name}": value for name, value in _varied(_only(table, kind)).items()}
        values |= of_kind | varied
    return values


def _only(table, kind):
    return table if kind == "all" else table[table["type"] == kind]


def _of_type(own):
    """Slots of the usual pulls of a type, beside the spin-up."""
    box, ends = (own[own["way"] == way] for way in WAYS)
    values = {"box": _geometric(box, box["ratio"]), "ends": _geometric(ends, ends["ratio"])}
    values["box over formula"] = _geometric(box, box["ratio"] / TENSILE_FACTOR)
    values["ends over formula"] = _geometric(ends, ends["ratio"] / TENSILE_FACTOR)
    for word, mark in MARKS.items():
        values[f"spin{word}"] = _geometric(box, box[f"spin_{mark}"])
        values[f"over spin{word}"] = _geometric(box, box["ratio"] / box[f"spin_{mark}"])
        values[f"ends over spin{word}"] = _geometric(ends, ends["ratio"] / ends[f"spin_{mark}"])
        values[f"omega{word}"] = _geometric(ends, ends["omega"] / ends[mark])
    for column in ("kept", "new", "across"):
        values[column] = Measured(*mean_of(box[column], cell_of(box)))
    values["peak"] = _geometric(box, box["peak"] / box["strength"])
    values["residual"] = float((box["residual"] / box["strength"]).median())
    return values


def _varied(table):
    """Slots of variants over the usual pull of the same grain."""
    keys = ["way", *GRAIN]
    reference = usual(table)[[*keys, "ratio"]].rename(columns={"ratio": "reference"})
    joined = table.merge(reference, on=keys, validate="many_to_one")
    values = {}
    for way in WAYS:
        for word in VARIANTS[1:]:
            part = joined[(joined["way"] == way) & (joined["variant"] == word)]
            values[f"{way} {word}"] = _geometric(part, part["ratio"] / part["reference"])
    for word in AXES[:2]:
        part = joined[(joined["way"] == "ends") & (joined["axis"] == word)]
        values[f"ends {word}"] = _geometric(part, part["ratio"] / part["reference"])
    return values


def _geometric(table, values):
    """Geometric mean of values of grains of a table."""
    return geometric_mean(values, cell_of(table))
