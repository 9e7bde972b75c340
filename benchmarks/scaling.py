"""Part (c): time per step and memory from ten to tens of thousands of monomers, BAM2, slowly turning."""

from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import numpy as np

from benchmarks import engine, grains, machine, tables

NUMBERS = (10, 30, 100, 300, 1000, 3000, 10000, 30000)
TURNING = 0.2
LINEAR_FROM = 300
"""Monomers from which the exponent is fitted: below, what every step costs whatever the number shows."""


def measure(out, *, numbers, repeats, updates, about, say):
    """Measure and write ``scaling.csv``.

    Parameters
    ----------
    out : pathlib.Path
        Folder of the results.
    numbers : sequence of int
        Numbers of monomers.
    repeats : int
        Runs of each.
    updates : float
        Contact updates in each run, i.e. contacts times steps.
    about : dict
        Columns that each row gets: the machine and the versions.
    say : callable
        Told how far it is.
    """
    alone(_one, min(numbers), 1, 1e3)  # so that the code is compiled when memory is measured
    rows = []
    for n in numbers:
        grain = alone(grains.grown, "BAM2", n)
        rows += [row | about for row in alone(_one, grain, repeats, updates)]
        latest = rows[-1]
        say(f"scaling: {n} monomers: {latest['us_per_step']:.2f} us per step, {latest['peak_bytes'] / 1e6:.0f} MB")
    tables.write(out / "scaling.csv", rows)


def alone(function, *arguments):
    """Call a function in a fresh process: the greatest memory of a process is never given back."""
    with ProcessPoolExecutor(max_workers=1, mp_context=get_context("spawn")) as pool:
        return pool.submit(function, *arguments).result()


def _one(grain, repeats, updates):
    """Rows of one aggregate (or a number of monomers), list of dict."""
    if isinstance(grain, int):
        grain = grains.grown("BAM2", grain)
    idle = machine.peak_memory()
    steps = max(100, int(updates / max(grain.n_contacts, 50)))
    body, _ = engine.timed(engine.turning(grain, TURNING, relaxed=False), max(1, steps // 10))
    rows = []
    for repeat in range(repeats):
        body, seconds = engine.timed(body, steps)
        rows.append(
            {
                "monomers": grain.n_monomers,
                "contacts": body.contacts,
                "repeat": repeat,
                "steps": steps,
                "seconds": seconds,
                "us_per_step": seconds / steps * 1e6,
                "ns_per_contact_step": seconds / steps / body.contacts * 1e9,
                "state_bytes": body.memory,
                "idle_bytes": idle,
                "peak_bytes": machine.peak_memory(),
            }
        )
    return rows


def exponent(x, y):
    """Slope of log y over log x by least squares, NaN for fewer than two points."""
    return float(np.polyfit(np.log(x), np.log(y), 1)[0]) if len(x) > 1 else np.nan
