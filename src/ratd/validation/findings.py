"""Every number that docs/validation.md tells, but for those of LAMMPS, from the tables of the checks.

Each function gives the slots of one check, which begin with its name: numbers, numbers with their standard error, and
a ``verdict``: met, missed, or open where the errors do not decide.
"""

import numpy as np

from ratd.base.measured import Measured, median
from ratd.base.statistics import mean_of, median_of
from ratd.experiments.compression.beside_lammps import EDGES, of_box, of_lammps
from ratd.experiments.compression.beside_lammps import of_dense as dense_over
from ratd.experiments.spin_up.cells import GRAIN, joined
from ratd.experiments.spin_up.how import TIMESTEP_FACTOR
from ratd.experiments.spin_up.printed import VISCOUS_EFFECT
from ratd.experiments.spin_up.solid import solid_omega
from ratd.validation.damping import RATE, RESOLUTION, WAITING

__all__ = [
    "exponents",
    "limits",
    "of_balance",
    "of_box_at_rest",
    "of_collision_step",
    "of_compression",
    "of_damping",
    "of_dense",
    "of_energy",
    "of_energy_step",
    "of_forces",
    "of_frames",
    "of_literal",
    "of_pull_off",
    "of_reference",
    "of_relaxation",
    "of_theory",
    "off_the_answer",
    "ratios",
    "runs_of_solid_grains",
    "verdict",
]

PARTED = 0.01
"""Part by which a pair may part off the exact answer."""
DERIVATIVE, DRIFT = 1e-6, 1e-10
"""Deviation of a force from the derivative; change of a momentum, both over their size."""
APART = 1e-6
"""Distance of a monomer from itself in the other frame, over the mean radius."""
REFERENCE = 2e-3
"""Distance from the spheres of the reference over their way; the same of energies."""
FASTER, SPUN = 1e-2, 2e-2
"""The same of velocities over that of the impact, of spins over the fastest."""
KEPT = 1e-3
"""Error of the energy over the kinetic energy, at `TIMESTEP_FACTOR`."""
CONTACTS = 0.02
"""What the number of contacts in LAMMPS may differ by in a compression, in the mean of its clusters."""
PRESSED = 0.03
"""... and the mean pressure up to phi = 0.03, where no limit of LAMMPS follows the load yet."""
ALIKE = 0.05
"""... and above, also in dense clusters without twisting, or with the limits of LAMMPS in ratd."""
CLOSED = {"compression": 5e-3, "long steps": 2e-2, "collision": 1e-2, "springs": 3e-2, "paced": 5e-3, "waiting": 2e-2}
"""What a balance of energy may lack of the work, or of the energy of an impact; springs are those of DMT."""
STEPPED = 0.05
"""What half the step may change in N_s of collisions, in the mean."""
SHIFTED = 0.01
"""What nothing should change by more."""
SIGMAS = 2.0
"""Errors by which a criterion must be met or missed, else it is open."""
CHANCE = 0.01
"""Least probability of a test that two things are alike."""
SOLID = 0.10
"""Part by which nine of ten runs of the drive literal may be off the answer for a solid grain."""


def limits():
    """What the checks ask for, as slots ``limit.NAME``."""
    found = {
        "parted": PARTED, "derivative": DERIVATIVE, "drift": DRIFT, "apart": APART, "kept": KEPT, "shifted": SHIFTED,
        "sigmas": SIGMAS, "chance": CHANCE, "solid": SOLID, "reference": REFERENCE, "f": TIMESTEP_FACTOR,
        "contacts": CONTACTS, "pressed": PRESSED, "alike": ALIKE,
        "reference velocity": FASTER, "reference spin": SPUN, "stepped": STEPPED,
    }  # fmt: skip
    return {f"limit.{name}": value for name, value in (found | CLOSED).items()}


def verdict(holds):
    """What a page says of a criterion that has no error."""
    return "met" if holds else "missed"


def decided(found, within, near=1.0):
    """Verdict on numbers that should be within so much of another: open where one is `SIGMAS` errors from the edge."""
    off = [abs(each.value - near) for each in found]
    errors = [SIGMAS * each.error for each in found]
    if any(each - error > within for each, error in zip(off, errors, strict=True)):
        return "missed"
    return "met" if all(each + error < within for each, error in zip(off, errors, strict=True)) else "open"


def of_reference(table):
    """Three spheres in this code and in the reference of tests/reference."""
    values = {f"reference.{name}": table[name].max() for name in ("position", "velocity", "spin")}
    energy = table[["box_work", "dissipated", "stored"]].max().max()
    allowed = {"position": REFERENCE, "velocity": FASTER, "spin": SPUN}
    near = energy < REFERENCE and all(values[f"reference.{name}"] < most for name, most in allowed.items())
    return values | {
        "reference.cases": len(table),
        "reference.energy": energy,
        "reference.verdict": verdict(near),
    }


def off_the_answer(table):
    """omega of the pairs over the exact answer, less 1, with the pairs: the columns of the check and ``off``."""
    pairs = table[table["study"] == "pairs"]
    exact = pairs["omega_force"].where(pairs["start"] != "undamped", pairs["omega_adiabatic"])
    return pairs.assign(off=pairs["omega"] / exact - 1.0)


def of_pull_off(table):
    """Pairs of monomers."""
    pairs = off_the_answer(table)
    values = {}
    for start, part in pairs.groupby("start"):
        values[f"pull_off.{start} worst"] = part["off"].abs().max()
    # a pair that never parts is NaN, which is not below
    holds = pairs["off"].abs() < PARTED
    waiting = pairs[pairs["start"] == "waiting"]
    values["pull_off.waiting pairs"] = len(waiting)
    values["pull_off.waiting median"] = waiting["off"].median()
    values["pull_off.waiting verdict"] = verdict(holds[waiting.index].all())
    values["pull_off.not waiting verdict"] = verdict(holds.drop(waiting.index).all())
    values["pull_off.waiting worst from 20"] = waiting.loc[waiting["radius_1"] >= 20e-9, "off"].abs().max()
    undamped = pairs[pairs["start"] == "undamped"]
    values["pull_off.undamped over force"] = (undamped["omega"] / undamped["omega_force"]).median()
    steps = table[table["study"] == "step"]
    off = (steps["omega"] / steps["omega_vibrating"] - 1.0).abs()
    values["pull_off.short step"] = off[steps["timestep_factor"] <= 0.01].max()
    values["pull_off.long step"] = off[steps["timestep_factor"] == steps["timestep_factor"].max()].max()
    return values


def of_forces(table):
    """Forces against the derivatives of the potentials, and the momenta."""
    contacts = table[table["study"] == "derivative"]
    worst = contacts[["force", "torque"]].max().max()
    momenta = table[table["study"] == "momenta"]
    drift = momenta[["linear", "angular"]].max().max()
    dissipated = momenta.filter(like="dissipated_")
    assert (dissipated.groupby([momenta["material"], momenta["type"]]).max() > 0.0).all().all()
    return {
        "forces.contacts": len(contacts) // contacts["mode"].nunique(),
        "forces.worst": worst,
        "forces.reaction": contacts["reaction"].max(),
        "forces.verdict": verdict(worst < DERIVATIVE),
        "forces.grains": len(momenta.groupby(["material", "type"])),
        "forces.drift": drift,
        "forces.momenta verdict": verdict(drift < DRIFT),
    }


def exponents(table, column, up_to=np.inf):
    """Powers with which the greatest magnitude of a column of each grain goes with f.

    Parameters
    ----------
    table : pandas.DataFrame
        With ``timestep_factor``, the columns of a grain and ``column``.
    column : str
    up_to : float
        Greatest f that counts.

    Returns
    -------
    pandas.Series
        Exponent of each grain.
    """
    worst = table[column].abs().groupby([*(table[name] for name in GRAIN), table["timestep_factor"]]).max()
    worst = worst.unstack()
    worst = worst[[f for f in worst.columns if f <= up_to]]
    slopes = np.polyfit(np.log(worst.columns.to_numpy(float)), np.log(worst.to_numpy()).T, 1)[0]
    return worst.assign(exponent=slopes)["exponent"]


def of_frames(table):
    """The same grain in two frames."""
    longest = table[table["timestep_factor"] == table["timestep_factor"].max()]
    return {
        "frames.grains": len(table.groupby(GRAIN)),
        "frames.distance": table["distance"].max(),
        "frames.moved": longest.groupby(GRAIN)["moved"].max().min(),
        "frames.exponent": median(exponents(table, "distance")),
        "frames.verdict": verdict(table["distance"].max() < APART),
    }


def of_energy_step(table):
    """Energy of a free elastic grain against the step."""
    assert (table["dissipated"] == 0.0).all() and (table["contacts_made"] == 0).all()
    at = table[table["timestep_factor"] == TIMESTEP_FACTOR]
    worst = at["error"].abs().max()
    return {
        "energy_step.grains": len(table.groupby(GRAIN)),
        "energy_step.worst": worst,
        "energy_step.exponent": median(exponents(table, "error", TIMESTEP_FACTOR)),
        "energy_step.verdict": verdict(worst < KEPT),
    }  # fmt: skip


def of_collision_step(table):
    """What half the step changes in the same collisions; errors over the clusters, of which each has several."""
    by_step = table.set_index([*GRAIN, "velocity", "rotation", "timestep"]).sort_index().unstack("timestep")
    longest, half = max(table["timestep"]), min(table["timestep"])
    values = {"collision_step.pairs": len(by_step), "collision_step.clusters": table["seed"].nunique()}
    for column in ("N_s", "X", "energy_early", "energy_late"):
        change = by_step[column][half] - by_step[column][longest]
        values[f"collision_step.{column}"] = Measured(*mean_of(change.groupby(GRAIN).mean().to_numpy()))
        values[f"collision_step.{column} scatter"] = change.std(ddof=1)
        values[f"collision_step.{column} mean"] = by_step[column][longest].mean()
    return values | {"collision_step.verdict": decided([values["collision_step.N_s"]], STEPPED, near=0.0)}


def balances(table):
    """What the balance of energy lacks: up to the first loss of mass, at worst up to a quarter and in the whole run."""
    dissipated = table.filter(like="dissipated_").sum(axis=1)
    gap = table["work"] - table["kinetic"] - table["potential"] - dissipated
    return table[[*GRAIN, "epsilon", "omega", "work"]].assign(
        kinetic=table["kinetic"] / table["work"],
        dissipated=dissipated / table["work"],
        gap=gap / table["work"],
        worst_to_quarter=table["worst_to_quarter"],
        worst=table["worst"],
    )


def of_energy(table):
    """Balance of energy of the default spin-up, and of one that does not wait."""
    values, waits = {}, table["epsilon"].isna()
    for name, part in (("waiting", balances(table[waits])), ("paced", balances(table[~waits]))):
        gap = part["gap"].abs()
        values |= {
            f"energy.{name} grains": len(part),
            f"energy.{name} median": gap.median(),
            f"energy.{name} worst": gap.max(),
            f"energy.{name} quarter median": part["worst_to_quarter"].median(),
            f"energy.{name} quarter worst": part["worst_to_quarter"].max(),
            f"energy.{name} quarter within": int((part["worst_to_quarter"] < CLOSED[name]).sum()),
            f"energy.{name} quarter verdict": verdict(part["worst_to_quarter"].max() < CLOSED[name]),
            f"energy.{name} run median": part["worst"].median(),
            f"energy.{name} run worst": part["worst"].max(),
            f"energy.{name} dissipated": part["dissipated"].median(),
            f"energy.{name} dissipated most": part["dissipated"].max(),
            f"energy.{name} verdict": verdict(gap.max() < CLOSED[name]),
        }
    return values


def of_compression(table):
    """Compression beside LAMMPS, see `ratd.experiments.compression.beside_lammps.of_lammps`."""
    found = {name.replace("lammps.", "compression."): value for name, value in of_lammps(table).items()}
    contacts = [found[f"compression.n_contacts_{low:g}"] for low in EDGES[:-1]]
    pressure = [found[f"compression.pressure_{low:g}"] for low in EDGES[:-1]]
    return found | {
        "compression.verdict": decided(contacts, CONTACTS),
        "compression.pressure verdict": decided(pressure[:2], PRESSED),
        "compression.dense verdict": decided(pressure[2:], ALIKE),
    }


def of_dense(table):
    """Dense clusters beside LAMMPS, see `ratd.experiments.compression.beside_lammps.of_dense`."""
    found = dense_over(table)
    bins = ("untwisted_0.05", "untwisted_0.1", "limits_0.1")
    return found | {"dense.verdict": decided([found[f"dense.pressure_{pair}"] for pair in bins], ALIKE)}


def of_box_at_rest(table):
    """Motion in a box at rest over what there can be, see `ratd.experiments.compression.beside_lammps.of_box`."""
    found = {name.replace("box.", "box_at_rest."): value for name, value in of_box(table).items()}
    held = max(found["box_at_rest.ratd most"], found["box_at_rest.LAMMPS most"]) < 1.0
    return found | {"box_at_rest.verdict": verdict(held)}


def of_balance(table):
    """Balance of energy of the production runs of the compression and the collisions."""
    values = {}
    for name, part in table.groupby("experiment"):
        values[f"balance.{name} runs"] = int(part["runs"].sum())
        values[f"balance.{name} worst"] = part["worst"].max()
        values[f"balance.{name} verdict"] = verdict(part["worst"].max() < CLOSED[name])
    return values


def of_relaxation(table):
    """Grains that come to rest."""
    moved = table.loc[table["moved"] > 1e-9, "moved"]
    whole = (table["rested"] == 1).all() and (table["n_parts"] == 1).all() and (table["n_contacts_lost"] == 0).all()
    return {
        "relaxation.grains": len(table),
        "relaxation.undamped": int((table["viscous_time"] == 0.0).sum()),
        "relaxation.rested": int((table["rested"] == 1).sum()),
        "relaxation.not at rest": int((table["moved"] > 1e-9).sum()),
        "relaxation.made": int(table["n_contacts_made"].sum()),
        "relaxation.moved": moved.median(),
        "relaxation.most": moved.max(),
        "relaxation.verdict": verdict(whole and moved.max() < SHIFTED),
    }


def of_theory(table):
    """Whole grains over the bounds that need no simulation."""
    over = table["omega_first_loss"] / table["firm_bound_at_loss"]
    values = {
        "theory.grains": len(table),
        "theory.greatest": over.max(),
        "theory.excess": over.max() - 1.0,
        "theory.verdict": verdict((over <= 1.0 + SHIFTED).all()),
    }
    balance = table["omega_first_loss"] / table["static_limit_at_loss"]
    # BA let go while their arms still swing outward, which is no rest
    trees = table["type"] == "BA"
    rests, swings = balance[~trees], balance[trees]
    values |= {
        "theory.static grains": len(rests),
        "theory.static verdict": verdict((rests <= 1.0 + SHIFTED).all()),
        "theory.static greatest": rests.max(),
        "theory.static excess": rests.max() - 1.0,
        "theory.static swinging": swings.max() - 1.0,
        "theory.BA static above": int((swings > 1.0 + SHIFTED).sum()),
        "theory.trees": len(swings),
        "theory.trees on it": _at_one(over[trees]),
    }
    for kind, part in table.groupby("type"):
        values[f"theory.{kind} at loss"] = median(over[part.index])
        values[f"theory.{kind} static"] = median(balance[part.index])
        values[f"theory.{kind} static on it"] = _at_one(balance[part.index])
    return values


def _at_one(ratio):
    """How many ratios are 1 within `SHIFTED`."""
    return int((np.abs(ratio - 1.0) < SHIFTED).sum())


def ratios(table, mark, times, by):
    """A mark at one viscous time over that of the same grain at another.

    Parameters
    ----------
    table : pandas.DataFrame
        Rows of one study of the check of the damping.
    mark : str
    times : tuple of float
        The two viscous times [ps].
    by : list of str
        What else tells one run of a grain from another.

    Returns
    -------
    pandas.DataFrame
        The columns of a grain, those of `by`, and ``ratio``.
    """
    time = (table["viscous_time"] * 1e12).round(6)
    first, second = (table.loc[time == each, [*GRAIN, *by, mark]] for each in times)
    pairs = first.merge(second, on=[*GRAIN, *by], suffixes=("", "_other"))
    return pairs.assign(ratio=pairs[mark] / pairs[f"{mark}_other"])


def of_damping(table):
    """What the viscous time does."""
    waiting = table[table["study"] == WAITING]
    marks = ("omega_first_loss", "omega_mass_75", "omega_disr")
    worst = max(abs(median_of(ratios(waiting, mark, (9, 1), [])["ratio"])["median"] - 1.0) for mark in marks)
    values = {"damping.waiting worst": worst, "damping.verdict": verdict(worst < SHIFTED)}
    values["damping.printed"] = VISCOUS_EFFECT[1]
    for kind, part in waiting.groupby("type"):
        values[f"damping.{kind} grains"] = len(part.groupby(GRAIN))
    disr = np.abs(np.log(ratios(waiting, "omega_disr", (9, 1), [])["ratio"]))
    values |= {"damping.waiting disr": np.exp(disr.max()), "damping.waiting disr off": int((disr > SHIFTED).sum())}
    dense = table[table["type"] == "BAM2"]
    rate = ratios(dense[dense["study"] == RATE], "omega_disr", (9, 5), ["epsilon"])
    for epsilon in (rate["epsilon"].min(), rate["epsilon"].max()):
        values[f"damping.BAM2 disr {epsilon:g}"] = median(rate.loc[rate["epsilon"] == epsilon, "ratio"])
    resolved = dense[(dense["study"] == RESOLUTION) & np.isclose(dense["viscous_time"], 5e-12, atol=0.0)]
    explicit = resolved[resolved["damping"] == "explicit"]
    finest = explicit[explicit["timestep_factor"] == explicit["timestep_factor"].min()]
    own = resolved[(resolved["damping"] == "implicit") & (resolved["timestep_factor"] == TIMESTEP_FACTOR)]
    both = joined(own, finest, ["omega_mass_75"], suffix="_finest")
    values["damping.BAM2 implicit"] = median(both["omega_mass_75"] / both["omega_mass_75_finest"])
    return values


def _beside_known(table, coriolis):
    """Runs of the drive literal with ``known``, the omega of the first loss of each grain in the consistent model."""
    own = table[table["drive"] == "prescribed"].rename(columns={"omega_first_loss": "known"})
    runs = table[(table["drive"] == "literal") & (table["coriolis"] == coriolis)]
    return joined(runs, own, ["known"]).drop(columns="size")


def runs_of_solid_grains(table):
    """Runs of the drive literal with the late Coriolis force beside what a solid grain gives.

    Returns
    -------
    pandas.DataFrame
        Those of `table` in which a solid grain is turned backwards, with ``known``, the omega of the first loss in the
        consistent model, ``solid``, that of a solid grain under the printed equations, and ``q``,
        (d omega/dt / dt)^(1/3).
    """
    runs = _beside_known(table, "explicit")
    columns = runs[["known", "spin_share", "angular_acceleration", "timestep"]]
    found = [solid_omega(*row) for row in columns.itertuples(index=False)]
    runs = runs.assign(
        solid=[omega for omega, _ in found],
        backwards=[backwards for _, backwards in found],
        q=(runs["angular_acceleration"] / runs["timestep"]) ** (1 / 3),
    )
    return runs[runs["backwards"] & np.isfinite(runs["omega_first_loss"])]


def of_literal(table):
    """The drive with the printed terms of the frame."""
    runs = runs_of_solid_grains(table)
    over = runs["omega_first_loss"] / runs["solid"]
    most = float((over - 1.0).abs().quantile(0.9))
    exact = _beside_known(table, "exact")
    exact = exact[np.isfinite(exact["omega_first_loss"])]
    grain, higher = runs.groupby(GRAIN).ngroup(), runs["omega_first_loss"] / runs["known"]
    bias = {f"literal.{kind} solid": median(part, group=grain[part.index]) for kind, part in over.groupby(runs["type"])}
    values = bias | {
        "literal.runs": len(runs),
        "literal.grains": len(runs.groupby(GRAIN)),
        "literal.solid": median(over, group=grain),
        "literal.nine of ten": most,
        "literal.all": (over - 1.0).abs().max(),
        "literal.verdict": verdict(most < SOLID),
        "literal.higher": median(higher, group=grain),
        "literal.highest": higher.max(),
    }
    for kind, part in exact.groupby("type"):
        values[f"literal.{kind} turns"] = median(part["turned"] / part["known"], group=part.groupby(GRAIN).ngroup())
    return values
