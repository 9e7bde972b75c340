"""On request: the time to an answer. At which omega has a grain lost a quarter of its mass, by ratd and by LAMMPS?

One grain of each type is spun up by `ratd.spin_up`, from the call to the end of the run. LAMMPS drives the same grain
in a frame that turns with it, as the check against it does (`ratd.validation.lammps`): omega grows in steps of `STEP`,
each held for some rotations, and ends where a quarter of the mass is gone. A hold of R rotations is a spin-up with
epsilon = ln(STEP)/(2 pi R). LAMMPS is timed where it is fast. A spin-up that does not wait gives the answer of a slow
one from epsilon = `SLOW` on: `docs/quasi_static.md` has the marks of 18 grains at 0.004 and 0.001. The time of that is
projected, in proportion to 1/epsilon, since the number of steps is.
"""

import math
import time

import numpy as np

from benchmarks import tables
from ratd import disruption, grow, spin_up
from ratd.experiments.relax import relax
from ratd.experiments.spin_up.cut_bound import cut_bound
from ratd.validation.lammps import MARKS, InLammps, driven, threshold

MATERIAL, SEED = "q-S", 1
STEP = 1.02
ROTATIONS = (0.03125,)
"""For how long each omega is held by LAMMPS, in rotations; the last one counts."""
SLOW = 0.001
TYPES = ("BA", "BAM1", "BAM2")


def measure(out, *, size, repeats, about, say):
    """Measure and write ``answer.csv``.

    Parameters
    ----------
    out : pathlib.Path
        Folder of the results.
    size : float
        Effective radius of the grains [m].
    repeats : int
        Runs of ratd, of which the fastest and slowest are written as well.
    about : dict
        Columns that each row gets: the machine and the versions.
    say : callable
        Told how far it is.
    """
    rows = []
    spin_up(grow("BA", 50e-9, MATERIAL, seed=0))  # compiles
    for kind in TYPES:
        grain = grow(kind, size, MATERIAL, seed=SEED)
        seconds = []
        for _ in range(repeats):
            begun = time.perf_counter()
            run = spin_up(grain)
            seconds.append(time.perf_counter() - begun)
        mark = disruption(run)["omega_mass_75"].item()
        own = {
            "type": kind,
            "size_nm": size * 1e9,
            "monomers": grain.n_monomers,
            "code": "ratd",
            "epsilon": math.nan,
            "omega": mark,
            "seconds": float(np.median(seconds)),
            "least": min(seconds),
            "greatest": max(seconds),
        }
        rows.append(own | about)
        say(f"answer: {kind} by ratd: {mark:.3e} rad/s in {own['seconds']:.2f} s")
        for rotations in ROTATIONS:
            row = _by_lammps(grain, rotations)
            rows.append(own | row | about)
            say(f"answer: {kind} by LAMMPS, epsilon {row['epsilon']:.3g}: {row['omega']:.3e} in {row['seconds']:.0f} s")
    tables.write(out / "answer.csv", rows)


def _by_lammps(grain, rotations):
    """omega and wall time of LAMMPS."""
    state = relax(grain)
    begun = time.perf_counter()
    held = driven(lambda: InLammps(state, grain.material, turning=True), cut_bound(grain), STEP, rotations)
    seconds = time.perf_counter() - begun
    omega, _, _, mass = zip(*held, strict=True)
    low, high = threshold(omega, mass, MARKS["25 % of the mass"])
    return {
        "code": "LAMMPS",
        "epsilon": math.log(STEP) / (2 * math.pi * rotations),
        "omega": math.sqrt(low * high),
        "seconds": seconds,
        "least": seconds,
        "greatest": seconds,
    }


def ratios(table):
    """LAMMPS's time at epsilon = `SLOW` over ratd's, by type.

    Parameters
    ----------
    table : pandas.DataFrame
        Rows of ``answer.csv``.

    Returns
    -------
    dict of str to float
    """
    found = {}
    for kind, part in table.groupby("type", sort=False):
        ours = part.loc[part["code"] == "ratd", "seconds"].item()
        slowest = part[part["code"] == "LAMMPS"].sort_values("epsilon").iloc[0]
        found[kind] = slowest["seconds"] * slowest["epsilon"] / SLOW / ours
    return found
