"""What is told beside the ensemble: other ways to compute, pairs, printed formulae, LAMMPS, heat, Tables 1 and 2."""

import numpy as np
import pandas as pd
from scipy.constants import Julian_year

from ratd.base.materials import get_material, sphere_mass
from ratd.base.units import NM, PS
from ratd.experiments.spin_up.calibration import PRINTED_STEP
from ratd.experiments.spin_up.cells import GRAIN, MATERIALS, joined, size_key
from ratd.experiments.spin_up.findings.claims import all_of, is_within
from ratd.experiments.spin_up.composition import PROPERTIES, table1, table2
from ratd.experiments.spin_up.contact_law import printed_twist
from ratd.experiments.spin_up.marks import MARK
from ratd.experiments.spin_up.formulae import DAMPING, OWN, formula_effects
from ratd.experiments.spin_up.pairs import eq35_omega, force_controlled_omega
from ratd.experiments.spin_up.parameters import PARAMETERS, effect
from ratd.experiments.spin_up.printed import FIRST_LOSS, PAIR_ERROR, SPIN_UP, VISCOUS_EFFECT
from ratd.experiments.spin_up.radiation import grain_temperature, infrared_of, spin_up_time
from ratd.experiments.spin_up.solid import solid_omega
from ratd.laws import thermal
from ratd.laws.contact_constants import equilibrium_compression, equilibrium_contact_radius
from ratd.laws.johnson_kendall_roberts import dissipation_time
from ratd.base.measured import Measured, geometric_mean, median

__all__ = [
    "beside_all_starts", "composition_tables", "of_formulae", "of_heat", "of_lammps", "of_overlap", "of_pairs",
    "of_printed_twist", "of_printed_pace", "of_printed_pairs", "of_ways",
]  # fmt: skip

ROLLING = 3.2 * NM
"""The greatest rolling limit that experiments gave [m] (Heim et al. 1999), the 0.2 of the model being the least."""
PAIR_RADII = (10 * NM, 100 * NM)
"""The smallest and the largest monomers of Fig. 10."""
PAIR_SHARE = 0.8 / 2.8
"""Share of their own moments of inertia, 2/5 m a^2 each, in that of two touching spheres, m a^2 each besides."""
NEAR_LAMMPS = 0.15
"""Part by which omega of single grains in LAMMPS may be off; neighbouring ones that were tried differ by 4 %."""
SAME = 0.005
"""Part by which two omega differ at most that are the same: those that were tried are 2 % apart at least."""


def of_ways(table):
    """What the rolling limit and the viscous time do to omega_disr, from the table of Fig. 9 of driven grains.

    Of the rolling limits, a type each, the median that is farthest from 1. ``ways.TYPE xi quarter`` is what `ROLLING`
    does to the mark of the document, as a geometric mean. ``xi mean``, ``xi single`` and those of ``viscous``: the
    geometric mean of omega_disr, and the least and the most of single grains, at `ROLLING` and at that time.
    """
    values, held = {}, []
    for kind, rows in effect(table, "xi_c", "omega_disr").groupby("type"):
        found = [Measured(row["median"], row["error"]) for row in rows.to_dict("records")]
        values[f"ways.holds xi {kind}"] = all_of(is_within(ratio, 0.95, 1.05) for ratio in found)
        values[f"ways.{kind} xi"] = max(found, key=lambda ratio: (abs(ratio.value - 1.0), ratio.error))
        held += [is_within(ratio, 0.95, 1.05) for ratio in found]
    values["ways.holds xi"] = all_of(held)
    for kind, rows in table[np.isclose(table[PARAMETERS["xi_c"]], ROLLING, atol=0.0)].groupby("type"):
        values[f"ways.{kind} xi quarter"] = geometric_mean(rows[f"{MARK}_ratio"].dropna())
        values |= _single(f"ways.{kind} xi", rows["omega_disr_ratio"])
    time, printed = VISCOUS_EFFECT
    other = (table["type"] == "BAM2") & np.isclose(table[PARAMETERS["T_vis"]], time, atol=0.0)
    values |= _single("ways.BAM2 viscous", table.loc[other, "omega_disr_ratio"])
    slow = effect(table, "T_vis", "omega_disr")
    (row,) = slow[(slow["type"] == "BAM2") & np.isclose(slow["value"], time, atol=0.0)].to_dict("records")
    values["ways.BAM2 viscous"] = Measured(row["median"] - 1.0, row["error"])
    half = 0.5 * (printed - 1.0)
    values["ways.holds viscous"] = is_within(values["ways.BAM2 viscous"], half, 3.0 * half)
    return values


def _single(start, ratios):
    """Geometric mean of some ratios, and the least and the most of them as a text."""
    return {
        f"{start} mean": geometric_mean(ratios.dropna()),
        f"{start} single": f"{ratios.min():.2f} to {ratios.max():.2f}",
    }


def of_pairs(tables):
    """How near pairs of monomers come to what they should."""
    table = pd.concat(tables)
    off = 1.0 - table["parting_omega"] / table["eq35_omega"]
    own = 1.0 - table["parting_omega"] / table["force_controlled_omega"]
    damped = table["start"] == "damped"
    worst = {"undamped": float(off[~damped].abs().max()), "damped": float(off[damped].abs().max())}
    held = (worst["undamped"] <= PAIR_ERROR, worst["damped"] <= PAIR_ERROR)
    verdicts = {(True, True): "yes", (False, False): "no", (True, False): "undamped only", (False, True): "damped only"}
    return {
        "pairs.n": len(table),
        "pairs.undamped worst": worst["undamped"],
        "pairs.damped worst": worst["damped"],
        "pairs.damped error": float(own[damped].abs().max()),
        "pairs.holds": verdicts[held],
    }


def of_printed_pairs(acceleration, factor):
    """omega at which solid pairs of equal monomers part with the printed terms, over Eq. 35.

    Parameters
    ----------
    acceleration : float
        d omega/dt [rad/s2].
    factor : float
        f of the step.
    """
    found = []
    for name in MATERIALS:
        material = get_material(name)
        for radius in PAIR_RADII:
            mass = sphere_mass(radius, material.density)
            r0 = equilibrium_contact_radius(0.5 * radius, material.surface_energy, material.reduced_modulus)
            step = factor * dissipation_time(mass, 0.5 * radius, r0, material.surface_energy)
            threshold = force_controlled_omega(radius, radius, material)
            omega, _ = solid_omega(threshold, PAIR_SHARE, acceleration, step)
            found.append(omega / eq35_omega(radius, radius, material))
    held = max(abs(ratio - 1.0) for ratio in found) <= PAIR_ERROR
    values = {"pairs.printed least": min(found), "pairs.printed most": max(found)}
    return values | {"pairs.printed holds": "yes" if held else "no"}


def of_printed_pace(driven, printed, acceleration, factor):
    """What the paper's own times give for the cell of its Fig. 4: omega of solid grains with the printed terms.

    Parameters
    ----------
    driven, printed : pandas.DataFrame
        Grains of both drives.
    acceleration, factor : float
        d omega/dt [rad/s2] and f of the step of `printed`.

    Returns
    -------
    dict
        ``pace.hours``, d omega/dt of `SPIN_UP`, beside ``pace.tuned``, both at the printed f; ``pace.omega hours`` and
        ``pace.omega tuned``, the median omega [rad/s] at which grains part by
        `ratd.experiments.spin_up.solid.solid_omega`; ``pace.least``, the same with three times as many hours;
        ``pace.driven`` and ``pace.printed``, the median first loss of the grains of the cell with either drive;
        ``pace.short``, how many times that of hours falls short of the printed omega; ``pace.holds`` and ``pace.holds
        driven``, whether it, and the driven one, is within 25 % of it. ``pace.step`` [ps] and ``pace.steps``, the step
        and how many of them an hour has.
    """
    (material, kind, size), printed_omega = FIRST_LOSS
    own = printed[
        (printed["material"] == material) & (printed["type"] == kind) & np.isclose(printed["a_eff"], size, atol=0.0)
    ]
    grains = joined(own, driven, ["omega_first_loss"], suffix="_driven")
    step = grains["timestep"] * PRINTED_STEP / factor

    def parts(rate):
        columns = zip(grains["omega_first_loss_driven"], grains["spin_share"], step, strict=True)
        return float(np.median([solid_omega(threshold, share, rate, dt)[0] for threshold, share, dt in columns]))

    end, time = SPIN_UP
    tuned, hours = acceleration * PRINTED_STEP / factor, end / time
    of_cell = (driven["material"] == material) & (driven["type"] == kind) & np.isclose(driven["a_eff"], size, atol=0.0)
    omega, known = parts(hours), float(driven.loc[of_cell, "omega_first_loss"].median())
    found = {"": omega, " driven": known}
    return {
        "pace.tuned": tuned,
        "pace.hours": hours,
        "pace.omega tuned": parts(tuned),
        "pace.printed": float(own["omega_first_loss"].median()),
        "pace.driven": known,
        "pace.omega hours": omega,
        "pace.least": parts(hours / 3.0),
        "pace.short": printed_omega / omega,
        **{f"pace.holds{name}": "yes" if 0.8 < own / printed_omega < 1.25 else "no" for name, own in found.items()},
        "pace.step": float(step.median()) / PS,
        "pace.steps": time / float(step.median()),
    }


def of_formulae(table):
    """What each printed formula does alone: medians of each type, the least and the most of them, and single grains."""
    every = formula_effects(table, MARK)
    every = every[every["type"] != "all"]
    contacts = every[every["formula"] != DAMPING]
    single = table.loc[~table["formula"].isin((DAMPING, OWN)), f"{MARK}_ratio"]
    ratios = table.loc[table["formula"] == DAMPING, f"{MARK}_ratio"]
    values = {
        "formulae.contacts least": float(contacts["median"].min()),
        "formulae.contacts most": float(contacts["median"].max()),
        "formulae.grains": int(table.groupby("formula")[f"{MARK}_ratio"].count().drop(OWN, errors="ignore").min()),
        "formulae.single": f"{single.min():.2f} to {single.max():.2f}",
        "formulae.damping": median(ratios),
        "formulae.damping mean": geometric_mean(ratios.dropna()),
        "formulae.damping grains": int(ratios.count()),
        "formulae.damping single": f"{ratios.min():.2f} to {ratios.max():.2f}",
        "formulae.damping gain": float(ratios.max()) - 1.0,
    }
    for (formula, kind), part in table[table["formula"] != OWN].groupby(["formula", "type"]):
        values[f"formulae.{formula} {kind}"] = median(part[f"{MARK}_ratio"])
    return values


def of_lammps(driven, default, starts):
    """LAMMPS over ratd, medians over grains, from the tables of docs/validation.md.

    Parameters
    ----------
    driven : pandas.DataFrame
        Grains that both codes turn in some ways.
    default : pandas.DataFrame
        Grains that LAMMPS drives, beside their spin-up that waits in ratd.
    starts : pandas.DataFrame
        The same beside runs of ratd from several starts that do not wait, with either sort of ``limits``: LAMMPS over
        the ``median`` of the starts.

    Returns
    -------
    dict
    """
    values = {"lammps.near": NEAR_LAMMPS}
    quarter = default[default["mark"] == "25 % of the mass"].dropna(subset="ratio")
    for (kind, size), part in quarter.groupby(["type", size_key(quarter["a_eff"])]):
        values[f"lammps.{kind} {size / 1000:.0f} nm"] = float(part["ratio"].median())
    for (limits, mark), part in starts.dropna(subset="median").groupby(["limits", "mark"]):
        start = f"lammps.starts {limits} {mark}"
        values |= {
            f"{start} grains": len(part),
            f"{start} near": int(((part["median"] - 1.0).abs() <= NEAR_LAMMPS).sum()),
            **{f"{start} {name}": found for name, found in beside_all_starts(part).items()},
        }
    for (way, mark), part in pd.concat([driven, default]).dropna(subset="ratio").groupby(["way", "mark"]):
        values |= {
            f"lammps.{way} {mark}": median(part["ratio"]),
            f"lammps.{way} {mark} range": f"{part['ratio'].min():.2f} to {part['ratio'].max():.2f}",
            f"lammps.{way} {mark} grains": len(part),
            f"lammps.{way} {mark} largest": part["a_eff"].max() / NM,
        }
        values |= {f"lammps.{way} {mark} {kind}": median(own["ratio"]) for kind, own in part.groupby("type")}
    monomers = default.groupby(GRAIN)["n_monomers"].first()
    return values | {"lammps.below 100": int((monomers < 100).sum())}


def beside_all_starts(table):
    """Where LAMMPS lies beside all starts of a grain at once, as one more start would not often.

    Parameters
    ----------
    table : pandas.DataFrame
        LAMMPS over the ``least``, ``median`` and ``most`` of the starts of each grain.

    Returns
    -------
    dict
        ``mean``, the geometric mean of LAMMPS over the median of the starts; ``below`` and ``above``, grains in which
        it is below or above all of them.
    """
    return {
        "mean": geometric_mean(table["median"]),
        "below": int((table["most"] < 1.0 - SAME).sum()),
        "above": int((table["least"] > 1.0 + SAME).sum()),
    }


def of_overlap():
    """By how much two equal monomers of the ensemble overlap at rest [nm], the least and the most."""
    own = [get_material(name) for name in MATERIALS]
    overlaps = [
        equilibrium_compression(0.5 * radius, each.surface_energy, each.reduced_modulus) / NM
        for each in own
        for radius in PAIR_RADII
    ]
    return {"contact.least": min(overlaps), "contact.most": max(overlaps)}


def of_printed_twist():
    """How fast two q-S monomers of 20 nm turn against each other after 1 ns [rad/s] by Eq. 17 as printed."""
    return {"printed.twist": printed_twist(20 * NM, get_material("q-S")) * 1e-9}


def of_heat(size, strength=100.0):
    """What heat does to the contact of two equal q-S spheres: barriers, and what is left of the pull over an hour.

    Parameters
    ----------
    size : float
        Of the smallest grain that light of a strength U tears [m]: the same for the time that this takes, ``thermal.
        light``, beside an hour; ``thermal.grain RADIUS nm omega`` is the share of its omega that a grain of contacts
        such as these keeps at the temperature that it has there.
    strength : float
    """
    quartz = get_material("q-S")
    time = spin_up_time(size, quartz.density, strength, coefficient=infrared_of(quartz.name))
    values = {"thermal.years": time / Julian_year, "thermal.grain": grain_temperature(strength)}
    for word, duration in (("", thermal.HOUR), ("light ", time)):
        for row in thermal.table(("q-S",), duration=duration).to_dict("records"):
            start = f"thermal.{word}{row['law']} {row['radius'] / NM:.0f} nm"
            values[f"{start} eV"] = row["barrier_eV"]
            values[f"{start} life"] = row["life_temperature"]
            values[f"{start} kT {row['temperature']:.0f} K"] = row["barrier_kT"]
            values[f"{start} pull {row['temperature']:.0f} K"] = row["pull_off"]
    warm = thermal.table(("q-S",), temperatures=(values["thermal.grain"],), duration=time)
    for row in warm[warm["law"] == "JKR"].to_dict("records"):
        values[f"thermal.grain {row['radius'] / NM:.0f} nm omega"] = row["omega"]
    lives = [values[f"thermal.light JKR {radius} nm life"] for radius in (10, 30)]
    below = sum(values["thermal.grain"] < life for life in lives)
    return values | {"thermal.grain is": ("above both", "between the two", "below both")[below]}


def composition_tables():
    """Tables 1 and 2 in Markdown."""
    one = []
    for row in table1().to_dict("records"):
        numbers = f"{row['abundance']:.3f} | {row['abundance_printed']:g} | {row['abundance_over_printed']:.3f}"
        one.append(f"| {row['ratio']} | {numbers} |")
    head = ["gamma [mJ/m²]", "E [GPa]", "nu", "rho [kg/m³]"]
    two = []
    for row in table2().to_dict("records"):
        cells = (
            f"{row[name] / unit:.4g} ({row[f'{name}_printed'] / unit:.4g})" for name, (*_, unit) in PROPERTIES.items()
        )
        two.append(f"| {row['material']} | " + " | ".join(cells) + " |")
    return {
        "table1": "\n".join(["| ratio | computed | printed | computed/printed |", "|---|---|---|---|", *one]),
        "table2": "\n".join(
            ["| material, used (printed) | " + " | ".join(head) + " |", "|---|" + "---|" * len(head), *two]
        ),
    }
