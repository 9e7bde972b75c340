"""Why the consistent model lies below print: bound, tensile strength, LAMMPS, single formulae, the literal drive."""

import numpy as np
import pandas as pd

from ratd.ensemble import PAPER_MEAN_RADIUS, cell_of, size_key
from ratd.firm_bound import slide_forces
from ratd.formula_table import FORMULAE, OWN, formula_effects
from ratd.markdown import markdown_table, plural
from ratd.materials import pull_off_force, reduced_radius
from ratd.parameters import MARKS
from ratd.reproduction.bounds import (
    PM,
    by_type_and_size,
    median_and_range,
    ratios,
    same_grains,
    table3_omega,
    whole_nm,
)
from ratd.reproduction.text import between, number, with_error
from ratd.statistics import mean_of, median_of
from ratd.units import NM
from ratd.validation.show import lammps, literal

INTRODUCTION = (
    "A grain that turns as a whole with omega needs a torque that raises its angular momentum. The printed equations "
    "of motion have none: in the turning frame they hold the inertial forces alone, so that a grain that obeys them "
    "stays behind the frame, feels little of the centrifugal force, and comes apart at an omega of the frame that says "
    "little of the grain. The drive `prescribed` has the torque (docs/model.md, The two drives).\n\n"
    "Four checks stand beside it that do not rest on spin-ups of whole grains by this code: pairs of monomers, for "
    "which the answer is known in closed form (Fig. 10, and docs/validation.md, Pull-off); a bound from the contacts "
    "alone; the tensile strength of pulled aggregates; and LAMMPS, an independent code. The parts after these show "
    "what the printed equations do instead."
)
OF_DRIVE = {"omega_first_loss": "first loss", "omega_mass_75": "25 % of the mass", "omega_disr": "omega_disr"}
"""Marks that are set beside the bound."""


def bound_section(data):
    """The bound from cuts and the tensile strength, beside Table 3, and where grains come apart."""
    materials = data.plan.materials
    first = ratios(data.grown, materials)
    rows = []
    for kind, sizes, part in by_type_and_size(first):
        firm = part["printed_over_firm"]
        found = [part["firm_bound"] / part["cut_bound"], part["strength_over_bound"], part["printed_over_bound"], firm]
        cells = [median_and_range(part, values) for values in (*found, firm**2)]
        rows.append([kind, sizes, str(len(part)), *cells])
    low, high = sideways(data)
    parts = [
        "Cut the contacts of a grain along any surface. The part cut off, of mass M with its centre of mass at the "
        "distance r from the axis, needs the force M omega² r to stay on its circle, which the contacts of the cut "
        "have to bear. This needs no simulation, and gives two omega for each grain:",
        "- The cut bound, above which the weakest cut asks more of its contacts than F_C each. It leaves out that a "
        f"contact also holds sideways, {number(low)} to {number(high)} F_C for equal monomers of the ensemble before "
        "it slides, and pushes without limit: a grain that is loaded at a slant to its weakest contact can hold more "
        "(`tests/test_firm_bound.py` has one that does, and parts at the firm bound). So it is a yardstick, and no "
        "bound in the strict sense.\n"
        "- The firm bound, with all of that counted. A contact that is alone in its cut bears the part of the load "
        "along its line of centres with F_C, and the part across it sideways. Of several, one whose line of centres "
        "has the angle theta to the load bears F_C cos(theta) and the greatest force sideways times sin(theta) of it, "
        "and one that is pushed any. Above the firm bound no forces that the contacts can bear hold the grain as it "
        "stands.",
        "For trees, i.e. BA without chance contacts, both are exact as far as forces go; otherwise they are the least "
        "of the bridges and planes that were tried, and the true ones can only be less, as they can where torques, "
        "which are left out, count too. New contacts, made while a grain deforms, may raise them; they are compared, "
        "not enforced.",
        _above(first),
        "Medians with the range of the middle two thirds. The tensile strength is 0.951 gamma/a phi^1.8 (Tatsuuma et "
        "al. 2019, from pulled aggregates; a is the mean radius of the monomers of the grain) set against the mean "
        "tension in the mid-plane of a turning sphere of the mass and the filling factor of the grain, i.e. of the "
        "radius a_eff phi^(-1/3).",
        markdown_table(
            ["type", "sizes", "grains", "firm bound over cut bound", "tensile strength over cut bound"]
            + [
                "Table 3 over cut bound",
                "Table 3 over firm bound",
                "load of Table 3 on the weakest cut over what it bears",
            ],
            rows,
        ),
        *_of_strength(data),
        "Where the spun-up grains come apart, over the cut bound of the same grain:",
    ]
    rows = []
    for drive, table in data.tables.items():
        for kind, sizes, part in by_type_and_size(table):
            marks = [median_and_range(part, part[mark] / part["cut_bound"]) for mark in OF_DRIVE]
            rows.append(
                [drive, kind, sizes, str(len(part)), *marks, median_and_range(part, part["mass_fraction_disr"])]
            )
    head = ["drive", "type", "sizes", "grains", *OF_DRIVE.values(), "mass left at omega_disr"]
    return "\n\n".join([*parts, markdown_table(head, rows), *_above_bound(data)])


def printed_above(table, column):
    """How many grains the printed Table 3 lies above a bound for.

    Parameters
    ----------
    table : pandas.DataFrame
        From `ratd.reproduction.bounds.ratios`.
    column : str
        printed_over_bound or printed_over_firm.

    Returns
    -------
    count, known : int
        Grains that it lies above the bound for, of those that both are known of.
    load : float
        Median of the load of the weakest cut over what it bears; all cells count alike.
    """
    there = table[table[column].notna()]
    load = median_of(there[column] ** 2, cell=cell_of(there))["median"]
    return int((there[column] > 1).sum()), len(there), load


def _above(table):
    """A paragraph: how many grains the printed Table 3 lies above the two bounds for."""
    found = []
    for name, column in (("cut", "printed_over_bound"), ("firm", "printed_over_firm")):
        count, known, load = printed_above(table, column)
        if known:
            found.append(
                f"above the {name} bound for {count} of {plural(known, 'grain')} (in the median of all its load on the "
                f"weakest cut is {number(load)} times what that bears)"
            )
    own = table["printed_over_firm"] * np.sqrt(PAPER_MEAN_RADIUS / table["mean_monomer_radius"])
    count, known, _ = printed_above(table.assign(own=own), "own")
    with_own = f" With the grains' own <a_mon> it lies above the firm bound for {count}." if known else ""
    return f"Eq. 33 with the printed Table 3 lies {', and '.join(found)}.{with_own} The load grows as omega²."


def _of_strength(data):
    """A paragraph: the omega of the tensile strength beside the consistent model and Table 3."""
    if "prescribed" not in data.tables:
        return []
    words = [f"{kind} {sizes} {' and '.join(map(number, medians))}" for kind, sizes, medians in over_strength(data)]
    return [
        "The omega of the tensile strength is so many times the omega_disr of the drive `prescribed`, and of Eq. 33 "
        f"with Table 3, in the medians of the same grains: {'; '.join(words)}."
    ]


def over_strength(data):
    """omega of the tensile strength over omega_disr of the drive `prescribed`, and over Eq. 33 with Table 3.

    Parameters
    ----------
    data : ratd.reproduction.data.Data

    Returns
    -------
    list of tuple
        Type, sizes as text, and the two medians over the same grains, all cells counting alike.
    """
    found = []
    for kind, sizes, part in by_type_and_size(ratios(data.tables["prescribed"], data.plan.materials)):
        over = [part["strength_over_bound"] / part[name] for name in ("found_over_bound", "printed_over_bound")]
        found.append((kind, sizes, [median_of(values, cell=cell_of(part))["median"] for values in over]))
    return found


def sideways(data):
    """Force that a contact holds sideways before it slides over its pull-off force, least and greatest.

    Parameters
    ----------
    data : ratd.reproduction.data.Data

    Returns
    -------
    tuple of float
        F_S/F_C for two equal monomers of the least and the greatest radius of the ensemble.
    """
    found = []
    for name in data.plan.config["materials"]:
        material = data.plan.materials[name]
        for radius in (data.plan.radii["smallest"], data.plan.radii["largest"]):
            R = reduced_radius(radius, radius)
            found.append(slide_forces(R, material) / pull_off_force(R, material.surface_energy))
    return min(found), max(found)


def _above_bound(data):
    """How many grains of the consistent model lose their first mass above the bound; paragraphs."""
    if "prescribed" not in data.tables:
        return []
    table = data.tables["prescribed"]
    table = table.assign(over=table["omega_first_loss"] / table["cut_bound"])
    counts = [
        f"{int((part['over'] > 1).sum())} of {len(part)} ({kind})" for kind, part in table.groupby("type", sort=False)
    ]
    known = same_grains(table, data.grown[data.grown["firm_bound"].notna()], ("", "_grown"))
    firm = known[known["omega_first_loss"] > known["firm_bound"]]
    above = table[table["over"] > 1]
    fixed = above[above["n_contacts_max"] <= above["n_contacts"]]
    words = f" Of these {len(above) - len(fixed)} make contacts on the way."
    if len(fixed):
        words += (
            f" The others, of {int(fixed['n_monomers'].min())} to {int(fixed['n_monomers'].max())} monomers, lie above "
            f"it by at most {100 * (fixed['over'].max() - 1):.2g} %: monomers need time to part, while omega goes on "
            "rising (docs/model.md, The scheme)."
        )
    if len(known):
        gain = int((firm["n_contacts_max"] > firm["n_contacts"]).sum())
        words += (
            f" Above the firm bound it leaves in {len(firm)} of {len(known)} grains, {gain} of them with new contacts."
        )
    return [
        "In the drive `prescribed` the first mass leaves below the cut bound but in "
        f"{', '.join(counts)} grains.{words if len(above) else ''} The bound lets all contacts of a cut bear F_C at "
        "once, in a grain that keeps its shape; how much unequal loads and stretching each take off was not separated. "
        "omega_disr is the peak of the stress of the "
        "largest fragment: where part of the mass has left by then, as in large BA grains, it belongs to a remnant, "
        "and may lie above the cut bound of the whole grain."
    ]


def lammps_section(data):
    """Thresholds of whole grains in LAMMPS, beside ratd, the bound and Table 3."""
    table = data.study("lammps")
    if table is None:
        return "The results of the check against LAMMPS are not part of the data."
    found = lammps.thresholds(table)
    material = table.loc[table["study"] == "rotation", "material"].iloc[0]
    printed = _printed_of(data, material)
    rows, shown = [], lammps.COMPARISONS[0]
    for row in found:
        if (row["start"], row["code"]) != shown:
            continue
        ours, theirs = (lammps.middle(row[code]) for code in ("ratd", "LAMMPS"))
        key = (row["type"], round(row["a_eff"] / NM), int(row["seed"]))
        cells = [key[0], f"{key[1]} nm", str(key[2]), row["mark"]]
        values = (theirs, ours, row["cut_bound"], printed.get(key, np.nan))
        rows.append([*cells, *map(number, values), number(theirs / ours), number(values[-1] / theirs)])
    head = ["type", "size", "seed", "mark", "LAMMPS", "ratd", "cut bound", "Table 3", "LAMMPS/ratd", "Table 3/LAMMPS"]
    grains = table[table["study"] == "rotation"].drop_duplicates(["type", "a_eff", "seed"])
    counts = f"{int(grains['n_monomers'].min())} to {int(grains['n_monomers'].max())} monomers"
    return "\n\n".join(
        [
            f"{plural(len(grains), f'{material} grain')} of {counts} ({', '.join(dict.fromkeys(grains['type']))}) were "
            "given to LAMMPS (its granular package): set into rigid rotation at once, "
            "in the inertial frame and in one that turns, and driven up by an outer torque. Each threshold lies "
            "between two omega that were tried, a few per cent apart; their geometric mean is given. LAMMPS over ratd, "
            f"medians, ± from drawing grains: {by_frame_and_type(found)}. Below are the grains set into rotation at "
            "once in the inertial frame, where no force of a turning frame enters; there a contact of LAMMPS that is "
            "parallel to the axis loses some of its load as the grain turns, in a frame that turns it does not "
            f"(docs/validation.md tells where the two codes differ).{rolling_limit(table)}",
            markdown_table(head, sorted(rows, key=lambda row: (row[0], float(row[1].split()[0]), int(row[2])))),
        ]
    )


def rolling_limit(table):
    """A sentence: what is left between the two codes where contacts roll elastically however far.

    Parameters
    ----------
    table : pandas.DataFrame
        Columns of `ratd.validation.lammps.COLUMNS`.
    """
    found = lammps.elastic_rolling(table)
    first = found[found["mark"] == next(iter(lammps.MARKS))]
    if first.empty:
        return ""
    limited, free = (between(first[name].min(), first[name].max()) for name in ("with", "without"))
    return (
        f" At the first loss of mass, LAMMPS over ratd is {limited} in {plural(len(first), 'driven grain')}, and "
        f"{free} where rolling has no limit in either code; LAMMPS lowers that limit where a contact is pulled."
    )


def by_frame_and_type(rows):
    """Medians of thresholds of LAMMPS over those of ratd, text: by how the grain was turned, and by type.

    Parameters
    ----------
    rows : list of dict
        From `lammps.thresholds`.
    """
    ways = []
    for start, code in lammps.COMPARISONS:
        here = [row for row in rows if (row["start"], row["code"]) == (start, code)]
        types = []
        for kind in dict.fromkeys(row["type"] for row in here):
            own = lammps_over_ratd([row for row in here if row["type"] == kind])
            types.append(f"{kind} {with_error(own['median'], own['error'])}")
        ways.append(f"{', '.join(types)} ({lammps.START[start]}, {lammps.FRAME[code]})")
    return "; ".join(ways)


def by_size(rows):
    """Medians of thresholds of LAMMPS over those of ratd, text: by size.

    Parameters
    ----------
    rows : list of dict
        From `lammps.thresholds`.
    """
    sizes = size_key(pd.Series([row["a_eff"] for row in rows]))
    told = []
    for size in sorted(sizes.unique()):
        own = lammps_over_ratd([row for row, its in zip(rows, sizes, strict=True) if its == size])
        told.append(f"{size * PM / NM:g} nm {with_error(own['median'], own['error'])}")
    return ", ".join(told)


def ratios_to_ratd(rows):
    """Each threshold of LAMMPS over that of ratd, list of float; see `lammps_over_ratd`."""
    return [lammps.middle(row["LAMMPS"]) / lammps.middle(row["ratd"]) for row in rows]


def lammps_over_ratd(rows):
    """Median of thresholds of LAMMPS over those of ratd, see `ratd.statistics.median_of`; each grain is drawn as one.

    Parameters
    ----------
    rows : list of dict
        From `lammps.thresholds`.
    """
    grains = pd.Series([(row["type"], row["a_eff"], row["seed"]) for row in rows])
    return median_of(ratios_to_ratd(rows), pd.factorize(grains)[0])


def _printed_of(data, material):
    """(type, size in nm, seed) -> omega of Eq. 33 with Table 3, for the grains of one material."""
    grains = data.grown[data.grown["material"] == material]
    keys = zip(grains["type"], whole_nm(grains), grains["seed"].astype(int), strict=True)
    return dict(zip(keys, table3_omega(grains, data.plan.materials), strict=True))


def _how(data):
    """With what epsilon and step the grains of the study of the formulae were spun up, in words."""
    own = data.plan.config["figures"]["formulae"]
    return f", all with epsilon = {own['epsilon']:g} and f = {own['timestep_factor']:g}" if own else ""


def formula_section(data):
    """What each printed formula changes: those of the contacts from their study, Eq. 3 from the table of grains."""
    table = data.formulae
    parts = []
    if table is None:
        parts.append("The study of the printed formulae of the contacts, one at a time, is not part of the data.")
    else:
        own = table["formula"] == OWN
        effects = [formula_effects(table, mark).query("type != 'all'").to_dict("records") for mark in MARKS]
        rows = []
        for both in zip(*effects, strict=True):
            formula, kind, nm, n = (both[0][name] for name in ("formula", "type", "nm", "n"))
            cells = [with_error(each["median"], each["error"]) for each in both]
            rows.append([FORMULAE.get(formula, formula), kind, f"{nm:g} nm", *cells, str(n)])
        parts.append(
            f"{plural(int(own.sum()), 'grain')} of the drive `prescribed` were spun up again with one formula as "
            f"printed and all else as in the consistent model{_how(data)}. Medians of the "
            "ratio to the same grain in the consistent model:"
        )
        head = ["formula as printed", "type", "size", "omega_disr", "omega at 25 % mass loss", "runs"]
        parts.append(markdown_table(head, rows))
        parts.append(
            "Not tried alone are misprints without which nothing runs as it should, or that change no number: the "
            "signs of Eqs. 14 and 17, which would make the springs push apart or measure rolling, and the terms of the "
            "spins that Eq. 30 lacks, whose effect the drive `literal` shows (docs/model.md lists all of them)."
        )
    rows = []
    for kind, part in data.grown.groupby("type", sort=False):
        mean = [mean_of(values, cell_of(part)) for values in (part["porosity"], printed_porosity(part["porosity"]))]
        rows.append([kind, *(with_error(*own) for own in mean), str(len(part))])
    parts.append(
        "Eq. 3 as printed, 5/(4 pi) in place of 15/(8 pi), makes all three axes shorter by a factor sqrt(2/3) and "
        "changes the porosity alone (mean over all sizes):"
    )
    parts.append(markdown_table(["type", "P", "P with Eq. 3 as printed", "grains"], rows))
    return "\n\n".join(parts)


def printed_porosity(porosity):
    """Porosity with the prefactor 5/(4 pi) of the printed Eq. 3, from that with 15/(8 pi); -0.84 for a solid sphere.

    P = 1 - a_eff^3/(a b c), and each axis goes with the root of the prefactor.
    """
    return 1.0 - (1.0 - porosity) * 1.5**1.5


def literal_section(data):
    """What the literal drive does with step and spin-up rate."""
    table = data.study("literal")
    if table is None:
        return "The results of the check of the literal drive are not part of the data."
    text = literal.tell(table)
    return text.split("\n\n", 1)[1] if text.startswith("#") else text  # its heading is that of docs/validation.md
