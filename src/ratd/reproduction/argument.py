"""Why the consistent model lies below print: bound, tensile strength, LAMMPS, step and rate of the literal drive."""

import numpy as np
import pandas as pd

from ratd.calibration import PRINTED_STEP, printed_acceleration, step_ratios
from ratd.ensemble import cell_of
from ratd.figures.style import plural
from ratd.formula_table import FORMULAE, OWN
from ratd.laws.tangential import sliding_limit, sliding_stiffness
from ratd.markdown import markdown_table
from ratd.materials import equilibrium_contact_radius, pull_off_force, reduced_radius
from ratd.parameters import MARKS
from ratd.parameters import OWN as AS_IT_IS
from ratd.reproduction.bounds import by_type_and_size, ratios, sizes_of, table3_omega
from ratd.reproduction.text import NOTHING, between, number, with_error
from ratd.solid import solid_omega
from ratd.statistics import equal_weights, mean_of, median_of, quantiles, slope_error, slope_of
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
        printed = part["printed_over_bound"]
        cells = [_range(part, values) for values in (printed, printed**2, part["strength_over_bound"])]
        rows.append([kind, sizes, str(len(part)), *cells])
    known = first["printed_over_bound"].dropna()
    low, high = sideways(data)
    more = int((known**2 > np.hypot(1.0, high)).sum())
    parts = [
        "Cut the contacts of a grain along any surface. The part cut off, of mass M with its centre of mass at the "
        "distance r from the axis, needs the force M omega² r to stay on its circle, and each contact of the cut pulls "
        "with at most F_C along the line of its centres. Above the omega at which the weakest cut gives way the grain, "
        "as it stands, cannot turn as a whole. This needs no simulation. For trees, i.e. BA without chance contacts, "
        "the weakest cut is found exactly; otherwise it is the weakest of the bridges and planes that were tried, and "
        "the true one can only be weaker. New contacts, made while a grain deforms, may raise the bound; it is "
        "compared, not enforced.",
        f"What a contact holds sideways before it slides is left out, {number(low)} to {number(high)} F_C for equal "
        "monomers of the ensemble: a load sideways rolls the monomers, which takes far less, until it pulls.",
        f"Eq. 33 with the printed Table 3 lies above the bound for {int((known > 1).sum())} of {len(known)} grains; "
        f"the load grows as omega², and for {more} of them it is more than every contact of the cut could hold with "
        "its greatest pull and its greatest sideways force together. The table gives medians with the range of the "
        "middle two thirds, each over the cut bound of the same grain. The tensile strength is 0.951 gamma/a phi^1.8 "
        "(Tatsuuma et al. 2019, from pulled aggregates) set against the mean tension in the mid-plane of a turning "
        "sphere.",
        markdown_table(["type", "sizes", "grains", "Table 3", "its load on the weakest cut", "tensile strength"], rows),
        "Where the spun-up grains come apart, over the bound of the same grain:",
    ]
    rows = []
    for drive, table in data.tables.items():
        for kind, sizes, part in by_type_and_size(table):
            marks = [_range(part, part[mark] / part["cut_bound"]) for mark in OF_DRIVE]
            rows.append([drive, kind, sizes, str(len(part)), *marks, _range(part, part["mass_fraction_disr"])])
    head = ["drive", "type", "sizes", "grains", *OF_DRIVE.values(), "mass left at omega_disr"]
    return "\n\n".join([*parts, markdown_table(head, rows), *_above_bound(data)])


def sideways(data):
    """Force that a contact holds sideways before it slides over its pull-off force, least and greatest.

    Parameters
    ----------
    data : ratd.reproduction.data.Data

    Returns
    -------
    tuple of float
        k_s zeta_c/F_C for two equal monomers of the least and the greatest radius of the ensemble.
    """
    found = []
    for name in data.plan.config["materials"]:
        material = data.plan.materials[name]
        for radius in (data.plan.radii["smallest"], data.plan.radii["largest"]):
            R = reduced_radius(radius, radius)
            r0 = equilibrium_contact_radius(R, material.surface_energy, material.reduced_modulus)
            holds = sliding_stiffness(r0, material.shear_modulus, material.poisson_number)
            holds *= sliding_limit(r0, material.poisson_number)
            found.append(holds / pull_off_force(R, material.surface_energy))
    return min(found), max(found)


def _above_bound(data):
    """How many grains of the consistent model lose their first mass above the bound; paragraphs."""
    if "prescribed" not in data.tables:
        return []
    table = data.tables["prescribed"]
    above = [
        f"{int((part['omega_first_loss'] > part['cut_bound']).sum())} of {len(part)} ({kind})"
        for kind, part in table.groupby("type", sort=False)
    ]
    return [
        "In the drive `prescribed` the first mass leaves below the bound, above it in "
        f"{', '.join(above)} grains, which deform before they part. omega_disr is the peak of the stress of the "
        "largest fragment: where part of the mass has left by then, as in large BA grains, it belongs to a remnant, "
        "and may lie above the bound of the whole grain."
    ]


def _range(table, values):
    """Median of values of the grains of a table, and range of the middle two thirds, text; all cells count alike."""
    found = median_of(values, cell=cell_of(table))
    return f"{number(found['median'])} ({number(found['low'])}–{number(found['high'])})" if found["n"] else NOTHING


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
    ways = []
    for start, code in lammps.COMPARISONS:
        own = lammps_over_ratd([row for row in found if (row["start"], row["code"]) == (start, code)])
        ways.append(f"{lammps.START[start]}, {lammps.FRAME[code]}: {with_error(own['median'], own['error'])}")
    head = ["type", "size", "seed", "mark", "LAMMPS", "ratd", "cut bound", "Table 3", "LAMMPS/ratd", "Table 3/LAMMPS"]
    grains = table[table["study"] == "rotation"].drop_duplicates(["type", "a_eff", "seed"])
    counts = f"{int(grains['n_monomers'].min())} to {int(grains['n_monomers'].max())} monomers"
    return "\n\n".join(
        [
            f"{plural(len(grains), f'{material} grain')} of {counts} ({', '.join(dict.fromkeys(grains['type']))}) were "
            "given to LAMMPS (its granular package), small ones because of its cost: set into rigid rotation at once, "
            "in the inertial frame and in one that turns, and driven up by an outer torque. Each threshold lies "
            "between two omega that were tried, a few per cent apart; their geometric mean is given. LAMMPS over ratd, "
            f"medians, ± from drawing grains: {'; '.join(ways)}. Below are the grains set into rotation at once in the "
            "inertial frame, where no force of a turning frame enters. docs/validation.md tells where the two "
            "codes differ.",
            markdown_table(head, sorted(rows, key=lambda row: (row[0], float(row[1].split()[0]), int(row[2])))),
        ]
    )


def lammps_over_ratd(rows):
    """Median of thresholds of LAMMPS over those of ratd, see `ratd.statistics.median_of`; each grain is drawn as one.

    Parameters
    ----------
    rows : list of dict
        From `lammps.thresholds`.
    """
    ratio = [lammps.middle(row["LAMMPS"]) / lammps.middle(row["ratd"]) for row in rows]
    return median_of(ratio, pd.factorize(pd.Series([(row["type"], row["a_eff"], row["seed"]) for row in rows]))[0])


def _printed_of(data, material):
    """(type, size in nm, seed) -> omega of Eq. 33 with Table 3, for the grains of one material."""
    grains = data.grown[data.grown["material"] == material]
    keys = zip(grains["type"], _whole_nm(grains), grains["seed"].astype(int), strict=True)
    return dict(zip(keys, table3_omega(grains, data.plan.materials), strict=True))


def _whole_nm(table):
    return np.rint(table["a_eff"] / NM).astype(int)


def calibration_section(data):
    """The rate of the literal drive that gives the onset of Fig. 4, and what the literal ensemble has in common."""
    parts = []
    found = data.calibration
    if found is None:
        parts.append("The calibration of d omega/dt on the onset of mass loss in Fig. 4 is not part of the data.")
    else:
        value = {name: found[name].item() for name in ("omega_onset", "calibrated", "exponent", "exponent_error")}
        low, high = found["calibrated_low"].item(), found["calibrated_high"].item()
        runs = found.to_dataframe()
        parts.append(
            "The literal drive has one number that the paper does not give, d omega/dt (the step is printed). The "
            f"onset of mass loss in Fig. 4, {number(value['omega_onset'])} rad/s, fixes it: "
            f"{number(value['calibrated'])} rad/s² ({between(low, high)} for one standard error), from a fit of "
            f"omega ~ (d omega/dt)^p with p = {with_error(value['exponent'], value['exponent_error'])} over "
            f"{plural(int(found.sizes['entry']), 'run')} of {plural(runs['seed'].nunique(), 'grain')}; the errors are "
            "those of leaving out one grain after the other. The onset is the loss of 1 % of the mass. Besides the "
            "radii of the monomers, which give the numbers of Fig. 1, nothing else was fitted to the paper."
        )
        pairs = step_ratios(runs)
        if len(pairs):
            own = median_of(pairs["ratio"], pairs["seed"])
            longer, shorter = (
                ", ".join(f"{f:g}" for f in sorted(pairs[name].unique()))
                for name in ("timestep_factor", "shortest_factor")
            )
            parts.append(
                f"It is the rate at the printed step, f = {PRINTED_STEP:g}. Only d omega/dt over the step counts, so "
                "runs with a longer step and a d omega/dt that is as much greater, which are far cheaper, stand for "
                f"it: in {plural(len(pairs), 'pair')} of runs of the same grain the onset with f = {longer} lies at "
                f"{with_error(own['median'], own['error'])} times that with f = {shorter} "
                f"({between(pairs['ratio'].min(), pairs['ratio'].max())} from least to greatest)."
            )
    parts += [*_shorter_step(data), *solid_parts(data)]
    if "literal" in data.tables:
        law = data.plan.spin_up_of("literal")
        table = ratios(data.tables["literal"], data.plan.materials)
        rate = printed_rate(data)
        stands = "" if rate is None else f", which stands for {number(rate)} rad/s² at the printed step"
        parts.append(
            f"The grains of the drive `literal` here were spun up with {data.plan.pace('literal')} and f = "
            f"{law['timestep_factor']:g}{stands}. The table sets them beside Eq. 33 with Table 3 for the same grains: "
            "level (median of the ratio), and how the types are ordered at the sizes that all of them have, from the "
            "lowest omega to the highest."
        )
        rows = []
        for name, part in table.groupby("material", sort=False):
            levels = [
                f"{kind} {_range(own, 1 / own['printed_over_found'])}" for kind, own in part.groupby("type", sort=False)
            ]
            printed = part.assign(printed=part["printed_over_found"] * part["omega_disr"])
            rows.append([name, "; ".join(levels), _order(printed, "omega_disr"), _order(printed, "printed")])
        parts.append(markdown_table(["material", "omega_disr over Table 3", "order of the types", "in Table 3"], rows))
        parts.append(
            "The level follows from the one number that was fixed. What tests the drive is how omega_disr goes with "
            "type and size: the order of the types is in the table, the fall with size under Does omega_disr flatten "
            "with size?, beside that of Eq. 33 with Table 3."
        )
    return "\n\n".join(parts)


def _shorter_step(data):
    """Grains of Fig. 9 beside themselves in the ensemble, which the literal drive spun up with a longer step."""
    if "literal" not in data.tables or "literal" not in data.parameters:
        return []
    law, figure9, rate = data.plan.spin_up_of("literal"), data.plan.config["figures"]["figure9"], printed_rate(data)
    if figure9 is None or rate is None:
        return []
    other = figure9["literal"]
    if not np.isclose(rate, printed_acceleration(**other), rtol=1e-6, atol=0):
        return []
    short = data.parameters["literal"]
    both = _same_grains(data.tables["literal"], short[short["parameter"] == AS_IT_IS], ("_long", "_short"))
    found = {mark: median_of(both[f"{mark}_long"] / both[f"{mark}_short"]) for mark in MARKS}
    if not all(own["n"] for own in found.values()):
        return []
    words = [
        f"{name} at {with_error(found[mark]['median'], found[mark]['error'])} times "
        f"({between(found[mark]['low'], found[mark]['high'])} for the middle two thirds)"
        for mark, name in (("omega_mass_75", "a quarter of the mass is lost"), ("omega_disr", "the stress is greatest"))
    ]
    return [
        f"The same can be seen in the {plural(len(both), 'grain')} that both the ensemble and Fig. 9 have: with f = "
        f"{law['timestep_factor']:g} {' and '.join(words)} the omega with f = {other['timestep_factor']:g}."
    ]


def _same_grains(table, other, suffixes):
    """Grains that two tables have, with the columns of both; those of one name get a suffix each."""
    key = ["material", "type", "seed", "nm"]
    return table.assign(nm=_whole_nm).merge(other.assign(nm=_whole_nm), on=key, suffixes=suffixes)


def printed_rate(data):
    """d omega/dt [rad/s2] at the printed step that the runs of the drive `literal` stand for; None without one."""
    law = data.plan.spin_up_of("literal")
    rate = law["angular_acceleration"]
    return None if rate is None else printed_acceleration(rate, law["timestep_factor"])


def is_calibrated(data):
    """Whether the drive `literal` was run with the d omega/dt that its calibration gives, within a standard error."""
    rate = printed_rate(data)
    if data.calibration is None or rate is None:
        return False
    return data.calibration["calibrated_low"].item() <= rate <= data.calibration["calibrated_high"].item()


def solid_parts(data):
    """What the literal drive would do at the calibrated rate, from the grains of the drive `prescribed`; paragraphs."""
    table = calibrated_grains(data)
    if table is None:
        return []
    law = data.plan.spin_up_of("literal")
    parts = [
        "What the literal drive gives at another rate needs no run: a solid grain under the printed equations turns "
        "with Omega in the inertial frame, d Omega/dt = s d omega/dt - (1 - s) omega (omega - Omega)² dt, where s is "
        "the share of the monomers' own moments of inertia, and parts where |Omega| is the omega_disr of the drive "
        "`prescribed` for the same grain (docs/validation.md, The literal drive)."
    ]
    rate = law["angular_acceleration"]
    if "literal" in data.tables and rate is not None:
        consistent = with_literal_step(data, law["timestep_factor"])
        both = _same_grains(consistent, data.tables["literal"], ("", "_literal"))
        ratio = median_of(both["omega_disr_literal"] / solid_prediction(both, rate))
        parts[0] += (
            f" In the {plural(ratio['n'], 'grain')} that both drives have here, at {number(rate)} rad/s², omega_disr "
            f"of the run lies at {with_error(ratio['median'], ratio['error'])} times that "
            f"({between(ratio['low'], ratio['high'])} for the middle two thirds)."
        )
    parts.append(
        f"At the calibrated {number(data.calibration['calibrated'].item())} rad/s² and f = {PRINTED_STEP:g} it "
        "gives, for all grains of the drive `prescribed`:"
    )
    rows, flatter, of = [], 0, 0
    for name, part in table.groupby("material", sort=False):
        for kind, own in part.groupby("type", sort=False):
            slope, error = _slope(own)
            sizes = sizes_of(own)
            printed, _ = _slope(own.assign(omega_disr=table3_omega(own, data.plan.materials)))
            of += np.isfinite(printed)
            flatter += slope > printed
            rows.append(
                [
                    name,
                    kind,
                    sizes,
                    _range(own, 1 / own["printed_over_found"]),
                    with_error(slope, error),
                    number(printed),
                ]
            )
        printed = part.assign(printed=table3_omega(part, data.plan.materials))
        rows.append([name, "order", "", f"{_order(part, 'omega_disr')}; Table 3: {_order(printed, 'printed')}", "", ""])
    head = ["material", "type", "sizes", "omega over Table 3", "d ln omega/d ln a_eff", "of Table 3"]
    parts.append(markdown_table(head, rows))
    parts.append(f"It falls less steeply with size than Table 3 in {flatter} of {plural(of, 'case')}.")
    return parts


def with_literal_step(data, timestep_factor):
    """Table of the grains of the drive `prescribed`, with literal_step, the time step [s] for another f."""
    table = data.tables["prescribed"]
    own = data.plan.spin_up_of("prescribed")["timestep_factor"]
    return table.assign(literal_step=table["timestep"] * timestep_factor / own)


def calibrated_grains(data):
    """Grains of the drive `prescribed` with the omega_disr that the calibrated drive `literal` would give them.

    Parameters
    ----------
    data : ratd.reproduction.data.Data

    Returns
    -------
    pandas.DataFrame or None
        As from `ratd.reproduction.bounds.ratios`; None where the data hold no calibration or no such grains.
    """
    if data.calibration is None or "prescribed" not in data.tables:
        return None
    table = with_literal_step(data, PRINTED_STEP)
    omega = solid_prediction(table, data.calibration["calibrated"].item())
    return ratios(table.assign(omega_disr=omega), data.plan.materials)


def solid_prediction(table, acceleration):
    """omega at which solid grains part under the printed equations, from their omega_disr of the consistent model.

    Parameters
    ----------
    table : pandas.DataFrame
        Grains with omega_disr [rad/s] of the drive `prescribed`, spin_share, and literal_step [s], the time step of the
        drive `literal`.
    acceleration : float
        d omega/dt [rad/s2].

    Returns
    -------
    numpy.ndarray
        See `ratd.solid.solid_omega`; NaN where something is not known.
    """
    columns = table[["omega_disr", "spin_share", "literal_step"]].to_numpy(float)
    return np.array(
        [solid_omega(own[0], own[1], acceleration, own[2])[0] if np.isfinite(own).all() else np.nan for own in columns]
    )


def _slope(table):
    """Slope of ln omega_disr against ln a_eff, and its standard error; all cells count alike."""
    known = table[table["omega_disr"].notna()]
    x, y = np.log(known["a_eff"].to_numpy(float)), np.log(known["omega_disr"].to_numpy(float))
    slope, influence = slope_of(x, y, weights=equal_weights(cell_of(known)))
    return slope, slope_error(influence)


def _order(table, column):
    """Types from the lowest to the highest median at the sizes that all types have, text."""
    table = table.assign(nm=_whole_nm(table))
    counts = table.groupby("nm")["type"].nunique()
    common = counts.index[counts == table["type"].nunique()]
    if not len(common) or table["type"].nunique() < 2:
        return NOTHING
    known = table[table["nm"].isin(common) & table[column].notna()]
    medians = {kind: quantiles(part[column], 0.5, equal_weights(cell_of(part))) for kind, part in known.groupby("type")}
    return " < ".join(sorted(medians, key=medians.get))


def formula_section(data):
    """What each printed formula changes: those of the contacts from their study, Eq. 3 from the table of grains."""
    table = data.formulae
    parts = []
    if table is None:
        parts.append("The study of the printed formulae of the contacts, one at a time, is not part of the data.")
    else:
        own = table["formula"] == OWN
        rows = []
        for name, part in table[~own].groupby("formula", sort=False):
            for kind, few in part.groupby("type", sort=False):
                found = [median_of(few[f"{mark}_ratio"]) for mark in ("omega_disr", "omega_mass_75")]
                cells = [with_error(each["median"], each["error"]) for each in found]
                rows.append([FORMULAE.get(name, name), kind, *cells, str(len(few))])
        parts.append(
            f"{plural(int(own.sum()), 'grain')} of the drive `prescribed` were spun up again with one formula as "
            "printed and all else as in the consistent model. Medians of the ratio to the same grain in the consistent "
            "model:"
        )
        head = ["formula as printed", "type", "omega_disr", "omega at 25 % mass loss", "runs"]
        parts.append(markdown_table(head, rows))
        parts.append(
            "Not tried alone are misprints without which nothing runs as it should, or that change no number: the "
            "signs of Eqs. 14 and 17, which would make the springs push apart or measure rolling, and the terms of the "
            "spins that Eq. 30 lacks, whose effect the drive `literal` shows (docs/model.md lists all of them)."
        )
    rows = []
    for kind, part in data.grown.groupby("type", sort=False):
        mean = [mean_of(part["porosity"]), mean_of(printed_porosity(part["porosity"]))]
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
