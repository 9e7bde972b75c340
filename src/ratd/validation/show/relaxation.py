"""Show which grains come to rest, and what that changes in them."""

from ratd.figures.style import TWO_COLUMNS, TYPE_COLOUR, TYPE_MARKER, logarithmic, new_figure, offsets, styled
from ratd.markdown import markdown_table, plural
from ratd.units import NM

MOVED = 1e-9
"""A grain was not at rest as grown where a monomer moved by more than this, over the mean radius; less is rounding."""


@styled
def draw(table):
    """How many grains are not at rest as grown, and how far their monomers move, against size; with damping.

    Parameters
    ----------
    table : pandas.DataFrame
        Columns of `ratd.validation.relaxation.COLUMNS`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    table = table[(table["viscous_time"] > 0.0) & (table["rested"] > 0)]
    figure = new_figure(TWO_COLUMNS, 0.45 * TWO_COLUMNS, plural(len(table), "grain"))
    share, moved = figure.subplots(1, 2)
    kinds = table.groupby("type")
    for (kind, own), shift in zip(kinds, offsets(table["a_eff"], len(kinds)), strict=True):
        size = own["a_eff"] / NM
        moves = own["moved"] > MOVED
        look = dict(color=TYPE_COLOUR.get(kind, "black"), marker=TYPE_MARKER.get(kind, "o"), label=kind)
        share.plot(moves.groupby(size.round(3)).mean(), **look)
        moved.plot(size[moves] + shift / NM, own["moved"][moves], ls="none", ms=3, mfc="none", mew=0.6, **look)
    moved.set_yscale("log")
    logarithmic(moved.yaxis)
    share.set_ylabel("share of grains that are not at rest as grown")
    moved.set_ylabel("greatest change of a distance from\nthe centre of mass, over the mean radius")
    for axes in (share, moved):
        axes.set_xlabel(r"effective radius $a_\mathrm{eff}$ [nm]")
    figure.legend(*share.get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure


def _row(name, own):
    """A row of the table: one type, with or without damping."""
    rested = own[own["rested"] > 0]
    moves = rested[rested["moved"] > MOVED]
    made, lost = (int(rested[f"n_contacts_{what}"].sum()) for what in ("made", "lost"))
    moved = f"{moves['moved'].median():.2g} ({moves['moved'].max():.2g})" if len(moves) else "–"
    return [
        *name, len(own), len(own) - len(rested), len(moves), int((rested["n_parts"] > 1).sum()), made, lost, moved,
        f"{rested['inertia'].min():.4f}–{rested['inertia'].max():.4f}",
    ]  # fmt: skip


def _restless(table):
    """A sentence: the grains that do not come to rest, by name."""
    left = table[table["rested"] == 0]
    if left.empty:
        return "All of them come to rest."
    names = [
        f"{row.material} {row.type} {row.a_eff / NM:.0f} nm, seed {row.seed:.0f}"
        + ("" if row.viscous_time else " (not damped)")
        for row in left.itertuples()
    ]
    return f"{plural(len(left), 'grain')} never came to rest: {'; '.join(names)}."


def tell(table):
    """The section of the report, Markdown."""
    damped = table["viscous_time"] > 0.0
    rows = [
        _row((kind, word), own)
        for word, part in (("own", table[damped]), ("none", table[~damped]))
        for kind, own in part.groupby("type")
    ]
    counts = " and ".join(
        f"{plural(len(part), 'grain')} of {', '.join(dict.fromkeys(part['material']))}, "
        f"{part['a_eff'].min() / NM:.0f}–{part['a_eff'].max() / NM:.0f} nm, {word}"
        for word, part in (("with their damping", table[damped]), ("without damping", table[~damped]))
        if len(part)
    )
    return "\n\n".join(
        [
            "## Relaxation",
            "A spin-up begins with the grain at rest: no net force on a monomer exceeds a thousandth of the least "
            "pull-off force in the grain. A grain grows with each contact of an arrival at equilibrium; what has to "
            "come to rest is a monomer that touches others by chance as well. "
            f"{counts}. {_restless(table)}",
            markdown_table(
                ["type", "damping", "grains", "never at rest", "not at rest as grown", "in more than one part",
                 "contacts made", "contacts lost", "moved", "greatest moment of inertia, over that as grown"],
                rows,
            ),
            "Contacts made and lost: in all grains together. Moved: greatest change of the distance of a monomer from "
            "the centre of mass, over the mean radius, of the grains that were not at rest as grown: median and, in "
            "brackets, the greatest.",
        ]
    )  # fmt: skip
