"""Part (b): what every (material, type, size) of the config costs, and the core-hours of the whole paper.

Under the constant-epsilon law, one grain of each cell, the first seed, is spun up `coarse` times faster than the config
says, and with records thinned by as much, so that the work for records stands in the same proportion to the steps. The
time to any angular velocity is inversely proportional to epsilon, and so is the number of steps. But each contact that
breaks costs a search for fragments and pairs, however fast the grain is spun up. A second run, `FASTER` times faster
still, tells the two apart: seconds = a/coarse + b gives a + b for the full run, next to growth and relaxation, which
are measured by themselves. What this leaves out is that a grain spun up faster breaks later, and that its pieces leave
at other angular velocities.

Under Eq. 24 a grain of the drive literal breaks at an omega that depends on d omega/dt, so that a faster run tells
little. There a run of `SHORT` steps tells how long a step takes, and theory how many there are: up to the omega at
which a solid grain parts (`ratd.experiments.spin_up.solid.solid_omega`).

A spin-up that waits until the grain is quiet takes steps that no faster run foretells. There one grain of each cell is
run in full.

Cells whose full run is cheap are run in full as well; the ratios of both, full to projected, tell the error and correct
the cells that are not run in full.

Each finished run is a row of ``cost_runs.csv``; a run with the same source and settings is not made again.
"""

import math
import time

import numpy as np

from benchmarks import machine, tables
from ratd import grow, spin_up
from ratd.aggregates.radii import RadiusDistribution
from ratd.base.errors import InputError
from ratd.base.units import NM
from ratd.experiments.relax import relax
from ratd.experiments.spin_up.cut_bound import cut_bound
from ratd.experiments.spin_up.how import FIRST_LOSS
from ratd.experiments.spin_up.same_grains import first_step
from ratd.experiments.spin_up.solid import solid_omega

FASTER = 3
"""How much faster still the second run of each cell is."""
SHORT = 20_000
"""Steps of a run that tells how long a step takes."""

PACES = ("stretch", "epsilon", "angular_acceleration")
"""Keys of the config one of which says how slowly a grain is spun up."""
KEY = ("drive", "material", "type", "size_nm", "coarse", "pace", "timestep_factor", "records")
"""Columns that say what was run. Rows of another machine or another source are dropped at the start."""


def measure(out, plan, *, drives, coarse, full_below, seeds, minutes, about, say):
    """Measure and write ``cost_runs.csv``, ``cost_cells.csv`` and ``cost_paper.csv``.

    Parameters
    ----------
    out : pathlib.Path
        Folder of the results.
    plan : ratd.experiments.spin_up.plan.Plan
        The config.
    drives : list of str
    coarse : dict of str to int
        How much faster each drive is spun up.
    full_below : float
        Cells whose projected full run takes less [s] are also run in full.
    seeds : int
        Seeds of a cell whose bound tells how far the grain that was run stands from the mean of its cell.
    minutes : float
        No new run is begun after so long; the next call goes on.
    about : dict
        Columns that each row gets: the machine and the versions.
    say : callable
        Told how far it is.

    Returns
    -------
    bool
        Whether everything is measured.
    """
    path = out / "cost_runs.csv"
    end = time.monotonic() + 60.0 * minutes
    rows = [
        row for row in tables.read(path) if row["source"] == machine.source() and row["machine"] == about["machine"]
    ]
    _compile(plan, drives)
    for drive in drives:
        levels = _levels(plan, drive, coarse[drive])
        for level in dict.fromkeys((*levels, 1)):
            for cell in plan.cells:
                if level not in levels and not _cheap(rows, plan, drive, cell, coarse[drive], full_below):
                    continue
                if _find(rows, plan, drive, cell, level):
                    continue
                if time.monotonic() > end:
                    say("cost: the time is up, the same command goes on from here")
                    return False
                row = _settings(plan, drive, cell, level) | _run(plan, drive, cell, level, say) | about
                rows.append({key: str(value) for key, value in row.items()})
                tables.write(path, rows)
                how = "a short run" if level == "short" else f"{level} times as fast"
                say(
                    f"cost: {drive} {' '.join(cell)} nm, {how}: {row['steps']} steps in {row['seconds']:.1f} s, "
                    f"{row['us_per_step']:.2f} us per step"
                )
    cells = project(rows, plan, drives, coarse, _expected(out, plan, drives, seeds, about, say))
    tables.write(out / "cost_cells.csv", cells)
    tables.write(out / "cost_paper.csv", paper(cells, rows, plan, drives, coarse, about))
    return True


def _by_epsilon(plan, drive):
    """Whether a drive follows the constant-epsilon law, else Eq. 24."""
    return plan.spin_up_of(drive)["epsilon"] is not None


def _waits(plan, drive):
    """Whether a drive waits until the grain is quiet."""
    return plan.spin_up_of(drive)["stretch"] is not None


def _levels(plan, drive, coarse):
    """Runs from which a full one is projected: how many times faster they are (1 for itself), or "short"."""
    if _waits(plan, drive):
        return (1,)
    return (FASTER * coarse, coarse) if _by_epsilon(plan, drive) else ("short",)


def _settings(plan, drive, cell, coarse):
    material, kind, size = cell
    spin = plan.spin_up_of(drive, kind)
    return {
        "drive": drive,
        "material": material,
        "type": kind,
        "size_nm": size,
        "coarse": coarse,
        # the config's own, not multiplied
        "pace": f"{next(spin[name] for name in PACES if spin[name] is not None):g}",
        "timestep_factor": f"{spin['timestep_factor']:g}",
        "records": spin["records"],
        "source": machine.source(),
    }


def grain_of(plan, cell, seed):
    """A grain of the config."""
    material, kind, size = cell
    settings = plan.grow(*cell)
    return grow(
        kind, float(size) * NM, plan.materials[material], seed, distribution=RadiusDistribution(**settings["radii"]),
        migration=settings["migration"],
    )  # fmt: skip


def arguments_of(plan, drive, kind, coarse):
    """Arguments of `ratd.spin_up` for a run of a grain of some type `coarse` times as fast as the config says.

    `coarse` may be "short" for a run of `SHORT` steps.
    """
    spin = plan.spin_up_of(drive, kind)
    arguments = {"drive": drive} | {name: spin[name] for name in (*PACES, "timestep_factor", "records", "max_steps")}
    if coarse == "short":
        return arguments | {"max_steps": SHORT}
    for name in ("epsilon", "angular_acceleration"):
        arguments[name] = None if spin[name] is None else spin[name] * coarse
    return arguments | {"records": max(1, round(spin["records"] / coarse))}


def _compile(plan, drives):
    """Run something small, so that no row holds the time that compiling takes."""
    grain = grow("BAM2", 60 * NM, "q-S", 0)
    for drive in drives:
        spin_up(grain, **arguments_of(plan, drive, grain.type, "short"))


def _run(plan, drive, cell, coarse, say):
    """The first grain of a cell that comes to rest, spun up `coarse` times as fast; processor times [s]."""
    arguments = arguments_of(plan, drive, cell[1], coarse)
    for seed in plan.seeds:
        start = time.process_time()
        grain = grain_of(plan, cell, seed)
        grown = time.process_time()
        try:
            relax(grain, timestep_factor=arguments["timestep_factor"])
        except RuntimeError as error:
            say(f"cost: {' '.join(cell)} nm, seed {seed} is left out: {error}")
            continue
        break
    else:
        raise InputError(f"no grain of {' '.join(cell)} nm comes to rest")
    cut_bound(grain)
    relaxed = time.process_time()
    failed = ""
    try:
        run = spin_up(grain, **arguments)
    except RuntimeError as error:
        # Far too fast a spin-up can break the integration; the report says so.
        failed = f"failed: {error}"
        run = spin_up(grain, **arguments | {"max_steps": 1})
    # spin_up relaxes the grain itself; that part does not scale with the pace.
    seconds = max(time.process_time() - relaxed - (relaxed - grown), 1e-6)
    return {
        "seed": seed,
        "monomers": grain.n_monomers,
        "contacts": grain.n_contacts,
        "cut_bound": run.attrs["cut_bound"],
        "expected_steps": expected_steps(plan, drive, grain),
        "omega_end": float(run["omega"][-1]),
        "end": failed or run.attrs["end_reason"],
        "growth_seconds": grown - start,
        "relaxation_seconds": relaxed - grown,
        "steps": run.attrs["steps"],
        "seconds": seconds,
        "us_per_step": seconds / run.attrs["steps"] * 1e6,
    }


def _find(rows, plan, drive, cell, coarse):
    """The row of a run with the settings of the config, None where it was not made yet."""
    wanted = _settings(plan, drive, cell, coarse)
    return next((row for row in rows if all(row[key] == str(wanted[key]) for key in KEY)), None)


def _cheap(rows, plan, drive, cell, coarse, full_below):
    guess = projected(rows, plan, drive, cell, coarse)
    return guess is not None and guess[0] < full_below


def projected(rows, plan, drive, cell, coarse):
    """Seconds and steps of the full run of a cell after its others; None where one of them is missing."""
    levels = _levels(plan, drive, coarse)
    found = [_find(rows, plan, drive, cell, level) for level in levels]
    if not all(found) or found[-1]["end"].startswith("failed"):
        return None
    if levels == (1,):
        return float(found[0]["seconds"]), float(found[0]["steps"])
    if levels == ("short",):
        steps = float(found[0]["expected_steps"])
        return float(found[0]["us_per_step"]) * 1e-6 * steps, steps
    faster, fast = found
    seconds = float(fast["seconds"])
    steps = int(fast["steps"])
    # a/coarse, which timings that scatter may not make less than nothing or more than all
    stepping = seconds
    if not faster["end"].startswith("failed"):
        stepping = min(max((seconds - float(faster["seconds"])) * FASTER / (FASTER - 1), 0.0), seconds)
    return coarse * stepping + seconds - stepping, coarse * steps


def expected_steps(plan, drive, grain):
    """Steps of a run up to where theory expects the grain to break.

    Under the constant-epsilon law that is at the cut bound omega_c, about 1/(epsilon omega_c dt) steps; what comes
    after takes as many again, or fewer. With the drive literal it is where a solid grain parts that holds to where the
    first monomers leave. Nothing is expected of a spin-up that waits: 1 for every grain.
    """
    if _waits(plan, drive):
        return 1.0
    spin = plan.spin_up_of(drive, grain.type)
    dt, omega = first_step(grain, spin["timestep_factor"]), cut_bound(grain)
    if spin["epsilon"] is not None:
        return 1.0 / (spin["epsilon"] * omega * dt)
    if drive == "literal":
        omega, _ = solid_omega(FIRST_LOSS * omega, grain.shape.spin_share, spin["angular_acceleration"], dt)
    return omega / (spin["angular_acceleration"] * dt)


def _expected(out, plan, drives, seeds, about, say):
    """How many times the work of its first seed the mean of a cell is expected to be, with standard error.

    The work is taken as the number of steps times that of the contacts, and 50 for what else a step has to do.
    """
    path = out / "cost_seeds.csv"
    key = {"seeds": str(min(seeds, len(plan.seeds))), "source": machine.source(), "machine": about["machine"]}
    paces = {drive: plan.pace(drive) for drive in drives}
    rows = [
        row
        for row in tables.read(path)
        if all(row[name] == value for name, value in key.items()) and row["pace"] == paces.get(row["drive"])
    ]
    result = {(row["drive"], row["material"], row["type"], row["size_nm"]): row for row in rows}
    for cell in plan.cells:
        missing = [drive for drive in drives if (drive, *cell) not in result]
        if not missing:
            continue
        grains = [grain_of(plan, cell, seed) for seed in plan.seeds[:seeds]]
        for drive in missing:
            work = np.array([(50 + grain.n_contacts) * expected_steps(plan, drive, grain) for grain in grains])
            error = work.std(ddof=1) / np.sqrt(len(work)) if len(work) > 1 else np.nan
            row = dict(zip(("material", "type", "size_nm"), cell, strict=True), drive=drive, pace=paces[drive], **key)
            row |= {"mean_to_first": work.mean() / work[0], "error": error / work[0]}
            result[drive, *cell] = {name: str(value) for name, value in row.items()}
    tables.write(path, list(result.values()))
    say(f"cost: expected work of {key['seeds']} seeds a cell")
    return {cell: (float(row["mean_to_first"]), float(row["error"])) for cell, row in result.items()}


def ratios(rows, plan, drive, coarse):
    """Full seconds, projected seconds and both numbers of steps of the cells that were run both ways, (k, 4)."""
    table = []
    for cell in plan.cells:
        guess, full = projected(rows, plan, drive, cell, coarse), _find(rows, plan, drive, cell, 1)
        if guess and full:
            table.append([float(full["seconds"]), float(full["steps"]), *guess])
    return np.array(table).reshape(-1, 4)


def project(rows, plan, drives, coarse, expected):
    """Cost of each cell with all its seeds, list of dict."""
    cells = []
    for drive in drives:
        table = ratios(rows, plan, drive, coarse[drive])
        correction = float(np.exp(np.log(table[:, 0] / table[:, 2]).mean())) if len(table) else 1.0
        for cell in plan.cells:
            full = _find(rows, plan, drive, cell, 1)
            best = full or _find(rows, plan, drive, cell, _levels(plan, drive, coarse[drive])[-1])
            guess, guessed_steps = projected(rows, plan, drive, cell, coarse[drive]) or (np.nan, np.nan)
            seconds = float(full["seconds"]) if full else guess * correction
            steps = float(full["steps"]) if full else float(guessed_steps)
            factor, error = expected[drive, *cell]
            fixed = float(best["growth_seconds"]) + float(best["relaxation_seconds"])
            cells.append(
                {
                    "drive": drive,
                    "material": cell[0],
                    "type": cell[1],
                    "size_nm": cell[2],
                    "monomers": int(best["monomers"]),
                    "contacts": int(best["contacts"]),
                    "run_in_full": "yes" if full else "no",
                    "steps": steps,
                    "us_per_step": seconds / steps * 1e6,
                    "seconds_one_grain": seconds + fixed,
                    "uncorrected_seconds_one_grain": guess + fixed,
                    "mean_of_seeds_to_this": factor,
                    "error_of_seeds_to_this": error,
                    "core_hours_cell": len(plan.seeds) * (seconds * factor + fixed) / 3600.0,
                }
            )
    return cells


def paper(cells, rows, plan, drives, coarse, about):
    """Core-hours of the whole config with each drive, and how far they can be trusted, list of dict."""
    result = []
    for drive in drives:
        own = [cell for cell in cells if cell["drive"] == drive]
        table = ratios(rows, plan, drive, coarse[drive])
        logs = np.log(table[:, 0] / table[:, 2]) if len(table) else np.empty(0)
        missing = sum(math.isnan(cell["core_hours_cell"]) for cell in own)
        own = [cell for cell in own if not math.isnan(cell["core_hours_cell"])]
        total = sum(cell["core_hours_cell"] for cell in own)
        first = len(plan.seeds) / 3600.0 * sum(cell["seconds_one_grain"] for cell in own)
        uncorrected = len(plan.seeds) / 3600.0 * sum(cell["uncorrected_seconds_one_grain"] for cell in own)
        errors = [
            cell["core_hours_cell"] * cell["error_of_seeds_to_this"] / cell["mean_of_seeds_to_this"] for cell in own
        ]
        result.append(
            {
                "drive": drive,
                "pace": plan.pace(drive),
                "timestep_factor": plan.spin_up_of(drive)["timestep_factor"],
                "coarse": _levels(plan, drive, coarse[drive])[-1],
                "grains": len(own) * len(plan.seeds),
                "cells_missing": missing,
                "core_hours": float(total),
                "error_of_seeds": float(np.sqrt(np.sum(np.square(errors)))),
                "core_hours_first_seed": float(first),
                "core_hours_uncorrected": float(uncorrected),
                "part_run_in_full": sum(c["core_hours_cell"] for c in own if c["run_in_full"] == "yes") / float(total),
                "cells_compared": len(table),
                "full_to_projected_mean": float(np.exp(logs.mean())) if len(logs) else np.nan,
                "full_to_projected_scatter": float(np.exp(logs.std(ddof=1))) if len(logs) > 1 else np.nan,
                "full_to_projected_min": float(np.exp(logs.min())) if len(logs) else np.nan,
                "full_to_projected_max": float(np.exp(logs.max())) if len(logs) else np.nan,
                "full_steps_to_projected": float(table[:, 1].sum() / table[:, 3].sum()) if len(table) else np.nan,
            }
            | about
        )
    return result
