"""Beyond the paper: predictors, flattening, fragments, shapes."""

import numpy as np

from ratd.beyond import (
    LEFT_OUT,
    MONOMER_CLASSES,
    PREDICTORS,
    SPLIT,
    fragment_shares,
    oblate_counts,
    power_law,
    slopes,
)
from ratd.fragmentation import STAGES
from ratd.markdown import markdown_table
from ratd.reproduction.bounds import printed_slopes, sizes_of, split_sizes, whole_nm
from ratd.reproduction.shapes import more_oblate
from ratd.reproduction.text import NOTHING, interval, number, with_error
from ratd.spinup import FIRST_LOSS
from ratd.units import NM
from ratd.validation.show.convergence import haste, large_shifts, percent

JUSTIFIED = 0.1
"""Probability below which a power law is not given (Clauset et al. 2009)."""
FEWEST = 50
"""Fragments below which nothing is said of a power law."""


def predictor_section(data):
    """Out-of-sample scatter of Eq. 33 and of the cut bound."""
    parts = [
        "Scatter of ln omega_disr of grains that the prediction was not fitted to (root mean square; 0.1 is about "
        "10 %), with its bootstrap error; all cells count alike. A predictor is named as the least where all others "
        "lie above it by more than two errors of the difference. "
        + "; ".join(f"{name}: {text}" for name, text in PREDICTORS.items())
        + "."
    ]
    for drive, predictions in data.predictions.items():
        rows = []
        for by, how in LEFT_OUT.items():
            found = predictions[by]
            for kind, part in found.groupby("type", sort=False):
                own = part.set_index("predictor")
                cells = [with_error(own.loc[name, "scatter"], own.loc[name, "error"]) for name in PREDICTORS]
                rows.append([how, kind, str(part["n_grains"].iloc[0]), *cells, least_of(part) or NOTHING])
        parts.append(f"Drive `{drive}`:")
        parts.append(markdown_table(["left out", "type", "grains", *PREDICTORS, "least"], rows))
    return "\n\n".join(parts)


def least_of(found):
    """Name of the predictor with the least scatter, None where another one is not beyond two errors of it.

    Parameters
    ----------
    found : pandas.DataFrame
        Rows of one type from `ratd.beyond.cross_validation`.
    """
    known = found[found["scatter"].notna()]
    others = known[known["more"] > 0]
    if len(known) - len(others) != 1 or not (others["more"] > 2 * others["more_error"]).all():
        return None
    return known.loc[known["scatter"].idxmin(), "predictor"]


def flattening_section(data):
    """Whether omega_disr flattens with size, and whether the cut bound does, which is known of all grown grains."""
    sources = [(f"omega_disr, {drive}", slopes(table)) for drive, table in data.tables.items()]
    sources.append(("cut bound", slopes(data.grown, "cut_bound")))
    sources.append(("Eq. 33 with Table 3", printed_slopes(data.grown, data.plan.materials)))
    rows = []
    for name, found in sources:
        for _, row in found.iterrows():
            error = row["change_error"]
            if not np.isfinite(row["change"]):
                verdict = "sizes on one side only"
            elif not np.isfinite(error):
                verdict = "too few grains for an error"
            elif row["change"] > 2 * error:
                verdict = "flatter above"
            elif row["change"] < -2 * error:
                verdict = "steeper above"
            else:
                verdict = "no change beyond two errors"
            cells = [with_error(row[side], row[f"{side}_error"]) for side in ("below", "above", "change")]
            sizes = f"{row['sizes_below']} and {row['sizes_above']}"
            rows.append([name, row["type"], *cells, verdict, sizes, str(row["n_grains"])])
    head = ["omega", "type", "below 300 nm", "above", "change", "", "sizes below and above", "grains"]
    return "\n\n".join(
        [
            "Local slope d ln omega/d ln a_eff (300 nm counts on both sides; materials together, each with a level of "
            "its own; ± from what each grain adds to the slope, the error HC3), of omega_disr, of the cut bound, and "
            "of Eq. 33 with the printed Table 3 for the grains grown here. A tensile strength that depends on nothing "
            "but material gives -1; an asymptotic limit, of which the paper speaks above 300 nm, gives 0, which its "
            "own fit does not have.",
            markdown_table(head, rows),
            *_pace(data),
        ]
    )


def _pace(data):
    """A paragraph: how fast the spin-up is where grains of the drive `prescribed` lose their first mass."""
    table = data.tables.get("prescribed")
    if table is None or data.plan.spin_up_of("prescribed")["epsilon"] is None:
        return []
    times = table.assign(haste=haste(table["omega_first_loss"] / table["cut_bound"]), nm=whole_nm)
    parts = []
    for kind, part in times.groupby("type", sort=False):
        of_size = part.groupby("nm")["haste"].median()
        sizes = [size for size in (round(SPLIT / NM), of_size.index.max()) if size in of_size.index]
        parts.append(f"{kind} " + ", ".join(f"{number(of_size[size])} ({size:g} nm)" for size in dict.fromkeys(sizes)))
    return [
        f"The spin-up of the drive `prescribed` has its epsilon from {FIRST_LOSS:g} of the cut bound on and is faster "
        "below (docs/model.md, The scheme). Where grains lose their first mass (d omega/dt)/omega² is, in medians, so "
        f"many times epsilon: {'; '.join(parts)}. A faster spin-up of BAM grains gives a greater omega"
        f"{_tried(data)}. As this excess grows with size, the fall of omega_disr with size comes out too shallow, not "
        "too steep."
    ]


def _tried(data):
    """Words on how much greater omega_disr is than with an infinitely slow spin-up."""
    found = large_shifts(data.study("convergence"), "omega_disr")
    parts = [f"{kind} {size:g} nm {percent(shift)} %" for kind, size, shift in found]
    if not parts:
        return ""
    return f", above that of an infinitely slow one by {', '.join(parts)} (docs/validation.md, Convergence)"


def fragment_section(data):
    """Sizes of the fragments."""
    if not data.fragments:
        return "The data hold no fragments."
    parts, laws = [], []
    for drive, table in data.fragments.items():
        largest = max((int(t["n_monomers"].max()) for t in data.tables.values()), default=1)
        rows = []
        for stage, text in STAGES.items():
            for part in split_sizes(table) if stage == "half" else [table]:
                rows += [[text, sizes_of(part), *cells] for cells in _shares(part, stage)]
            for kind, own in table[table[stage]].groupby("type", sort=False):
                law = _law(own["fragment_n_monomers"], largest)
                laws += [f"{drive} {kind} {text}: {law}"] if law else []
        head = ["stage", "sizes", "type", "fragments, from grains"]
        head += [f"mass in fragments of {name}" for name in MONOMER_CLASSES]
        parts += [f"Drive `{drive}`:", markdown_table([*head, "number of single monomers"], rows)]
    return "\n\n".join(
        [
            "A fragment counts when it has left for good (it lies outside the sphere around the largest one and "
            "recedes), once. Shares of the mass that left; ± from a bootstrap over grains.",
            *parts,
            "A power law p(n) ~ n^-s of the number of monomers n is justified where made-up samples of that law lie as "
            f"far from their own fit in at least {100 * JUSTIFIED:g} % of cases. It is "
            f"{'so for ' + '; '.join(laws) if laws else 'justified for no drive, type and stage'}.",
        ]
    )


def _shares(table, stage):
    """Rows of a table of fragments, one a type: how many, mass of each class, number of the first class."""
    rows = []
    for kind, part in fragment_shares(table, stage).groupby("type", sort=False):
        own = part.set_index("class")
        cells = [with_error(*own.loc[name, ["mass_share", "mass_share_error"]]) for name in MONOMER_CLASSES]
        counts = f"{own['n_fragments'].iloc[0]} from {own['n_grains'].iloc[0]}"
        rows.append([kind, counts, *cells, number(own.loc[MONOMER_CLASSES[0], "number_share"])])
    return rows


def _law(sizes, largest):
    """Exponent of a power law, text; None where there are too few fragments for one, or it is not justified."""
    found = power_law(sizes, largest)
    if not np.isfinite(found["exponent"]) or found["n"] < FEWEST or found["probability"] < JUSTIFIED:
        return None
    return f"s = {with_error(found['exponent'], found['error'])} (p = {found['probability']:.2g})"


def shape_section(data):
    """Oblate and prolate grains."""
    rows = []
    for drive, table in data.tables.items():
        for _, row in oblate_counts(table, by=("type",)).iterrows():
            cells = [drive, row["type"]]
            for when in ("start", "disr"):
                k, n = row[f"{when}_oblate"], row[f"{when}_known"]
                share = interval(k / n, row[f"{when}_low"], row[f"{when}_high"]) if n else NOTHING
                cells += [f"{k} of {n}", share]
            rows.append(cells)
    answers = {drive: more_oblate(table, None) for drive, table in data.tables.items()}
    found = [f"{own.text} for `{drive}`" for drive, own in answers.items() if own is not None]
    head = ["drive", "type", "oblate at rest", "share", "oblate at omega_disr", "share"]
    return "\n\n".join(
        [
            "Oblate means b/a > c/b, for the ellipsoid with the moments of inertia of the relaxed grain and of the "
            "largest fragment at omega_disr. Shares with Wilson's 95 % interval; all materials and sizes together, "
            "each grain counting once. With cells of one weight the share of oblate BAM grains at omega_disr less that "
            f"at rest is {', '.join(found)}.",
            markdown_table(head, rows),
        ]
    )
