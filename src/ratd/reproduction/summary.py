"""The head of the document: what holds and what does not."""

import numpy as np

from ratd.beyond import cross_validation, slopes
from ratd.composition import table1, table2
from ratd.ensemble import cell_of
from ratd.figures.style import plural
from ratd.reproduction import grown
from ratd.reproduction.argument import calibrated_grains, printed_rate
from ratd.reproduction.bounds import ratios
from ratd.reproduction.text import between, number, with_error
from ratd.statistics import median_of
from ratd.validation.show import lammps


def summary(data, rows):
    """What holds and what does not, from the numbers, as a list in Markdown.

    Parameters
    ----------
    data : ratd.reproduction.data.Data
    rows : list of Row
        The printed numbers with our answers.

    Returns
    -------
    str
    """
    tables = {drive: ratios(table, data.plan.materials) for drive, table in data.tables.items()}
    lines = [_verdict(drive, rows) for drive in tables]
    lines += [_level(f"omega_disr, drive `{drive}`{_rate(data, drive)}", table) for drive, table in tables.items()]
    calibrated = calibrated_grains(data)
    if calibrated is not None and calibrated["printed_over_found"].notna().any():
        name = (
            "Drive `literal` with its one free number fixed on the onset of mass loss in Fig. 4, predicted for a solid "
            "grain from the drive `prescribed`"
        )
        lines.append(_level(name, calibrated))
    lines += [_bound(ratios(data.grown, data.plan.materials)), *_flattening("the bound", data.grown, "cut_bound")]
    lines += _lammps(data)
    lines += [line for drive, table in tables.items() for line in _shape_of_law(drive, table, data.plan.materials)]
    lines += [_composition(), *_grains(data)]
    return "\n".join(f"- {line}" for line in lines)


def _verdict(drive, rows):
    answers = [row.answers.get(drive) or row.answers.get("") for row in rows]
    known = [own.holds for own in answers if own and own.holds is not None]
    return (
        f"**Drive `{drive}`**: {sum(known)} of the {len(known)} printed numbers and findings that these data decide "
        f"hold; {len(rows) - len(known)} are left open."
    )


def _rate(data, drive):
    """Words on the free number of the drive `literal`."""
    rate = printed_rate(data) if drive == "literal" else None
    return "" if rate is None else f" with d omega/dt = {number(rate)} rad/s² at the printed step"


def _level(name, table):
    """omega_disr over Eq. 33 with the printed Table 3."""

    def over(part):
        return median_of(1 / part["printed_over_found"], cell=cell_of(part))

    found = over(table)
    by_type = [f"{kind} {number(over(part)['median'])}" for kind, part in table.groupby("type", sort=False)]
    return (
        f"**{name}**: {with_error(found['median'], found['error'])} times Eq. 33 with the printed "
        f"Table 3, in the median of {plural(found['n'], 'grain')} ({', '.join(by_type)}); middle two thirds "
        f"{between(found['low'], found['high'])}."
    )


def _bound(table):
    known = table["printed_over_bound"].dropna()
    load = median_of(known**2)
    return (
        f"**What the contacts can hold**: the printed Table 3 lies above the bound from cuts through the contacts for "
        f"{int((known > 1).sum())} of {plural(len(known), 'grain')}; there the weakest cut would carry "
        f"{number(load['median'])} times what it holds, in the median of all."
    )


def _lammps(data):
    table = data.study("lammps")
    if table is None:
        return []
    found = median_of([lammps.middle(row["LAMMPS"]) / lammps.middle(row["ratd"]) for row in lammps.thresholds(table)])
    return [
        "**LAMMPS**, an independent code, lets the same grains come apart at "
        f"{with_error(found['median'], found['error'])} times the omega of this one (median of "
        f"{plural(found['n'], 'threshold')})."
    ]


def _shape_of_law(drive, table, materials):
    """How omega_disr depends on size, and what predicts it."""
    lines = _flattening(f"omega_disr, drive `{drive}`,", table, "omega_disr")
    found = cross_validation(table, materials=materials)
    own = found[(found["type"] == "all") & found["scatter"].notna()]
    if len(own):
        best = own.loc[own["scatter"].idxmin()]
        eq33 = own[own["predictor"] == "Eq. 33"].iloc[0]
        lines.append(
            f"**Prediction, drive `{drive}`**: of sizes that were left out of the fit, Eq. 33 misses ln omega_disr by "
            f"{with_error(eq33['scatter'], eq33['error'])}; the best of those compared ({best['predictor']}) by "
            f"{with_error(best['scatter'], best['error'])}."
        )
    return lines


def _flattening(name, table, mark):
    steep = [
        f"{row['type']} {with_error(row['above'], row['above_error'])}"
        for _, row in slopes(table, mark).iterrows()
        if np.isfinite(row["above"])
    ]
    if not steep:
        return []
    return [
        f"**Flattening**: above 300 nm {name} goes with the power of size {', '.join(steep)}; the paper finds 0 for "
        "omega_disr."
    ]


def _composition():
    one = table1()["abundance_over_printed"]
    two = table2().set_index("material").loc["co-S"]
    over = [two[f"{name}_over_printed"] for name in ("youngs_modulus", "poisson_number", "density")]
    return (
        f"**Tables 1 and 2** follow from the minerals: computed over printed {between(one.min(), one.max())} and, for "
        f"E, nu and rho of co-S, {between(min(over), max(over))}."
    )


def _grains(data):
    """Contacts a monomer of the grains of Fig. 1, which their scatter in size does not touch."""
    over = grown.contacts_over_printed(data)
    if not over:
        return []
    return [
        f"**The grains of Fig. 1** have {between(min(over), max(over))} times the printed contacts a monomer "
        f"({plural(len(over), 'grain')})."
    ]
