"""Part (d): the engine on CUDA: ns per contact and step over the whole device, what fills it, the whole paper."""

import time

import numpy as np

from benchmarks import engine, grains, tables
from ratd import grow
from ratd.cuda.advance import PAUSED, advance_grains
from ratd.cuda.arena import CODE, FEWEST, GOALS, RESULTS, SEGMENT_END, STEPS_GOAL, Batch, write_drive
from ratd.cuda.device import SIMULATED, cuda, require, upload
from ratd.cuda.spin_up import spin_up_many, threads_for
from ratd.engine import layout
from ratd.growth import RadiusDistribution
from ratd.units import NM

TYPES = ("BAM2", "BA")
SEED = 0
TURNING = 0.2
"""Angular velocity in units of the bound at which the aggregate must break."""

CHANGING = layout.CONTACT_FIELDS.index("A_I")
"""Fields of a contact that each step reads and writes; those after them are only read."""
BYTES = 8 * (2 * CHANGING + (layout.N_FIELDS - CHANGING) + 2 + 2 * RESULTS)
"""Bytes that a step reads and writes for each contact: its fields, its pair, its results; monomers come on top."""


def about_device(threads):
    """What the compiler and the device say of the kernel with a number of threads, as columns of the results."""
    if SIMULATED:
        return {
            "device": "simulation", "multiprocessors": 1, "registers": 0, "local_bytes": 0, "shared_bytes": 0,
            "blocks_per_multiprocessor": 1, "occupancy": 0.0, "peak_GB_s": 0.0,
        }  # fmt: skip
    device = cuda.get_current_device()
    # one signature, hence one compiled kernel
    (compiled,) = advance_grains.overloads.values()
    function = compiled._codelibrary.get_cufunc()
    blocks = cuda.current_context().get_active_blocks_per_multiprocessor(function, threads, 0)
    name = device.name
    return {
        "device": name.decode() if isinstance(name, bytes) else name,
        "multiprocessors": device.MULTIPROCESSOR_COUNT,
        "registers": compiled.regs_per_thread,
        "local_bytes": compiled.local_mem_per_thread,
        "shared_bytes": compiled.shared_mem_per_block,
        "blocks_per_multiprocessor": blocks,
        "occupancy": blocks * threads / device.MAX_THREADS_PER_MULTIPROCESSOR,
        # two transfers a cycle; the rate of the clock is in kHz, the width of the bus in bits
        "peak_GB_s": 2.0 * device.MEMORY_CLOCK_RATE * 1e3 * device.GLOBAL_MEMORY_BUS_WIDTH / 8.0 / 1e9,
    }


def timed(body, copies, threads, steps):
    """Seconds that so many copies of a turning aggregate take for some steps, all of them in one launch."""
    batch = Batch([body.state] * copies, 1)
    for place in range(copies):
        write_drive(batch.host.drive[place], body.drive)
    task = batch.host.task
    task[:, STEPS_GOAL], task[:, FEWEST], task[:, GOALS] = np.iinfo(np.int64).max, -1, 1
    task[:, SEGMENT_END] = body.state.counter[layout.STEPS] + steps
    batch.host.goal[:] = np.inf
    batch.send_tasks()
    places = upload(np.arange(copies))
    start = time.perf_counter()
    advance_grains[copies, threads](batch.device, places, engine.TIMESTEP_FACTOR, True)
    cuda.synchronize()
    seconds = time.perf_counter() - start
    batch.fetch_tasks()
    if (task[:, CODE] != PAUSED).any():
        raise RuntimeError(f"the engine returned {set(task[:, CODE].tolist())} before {steps} steps were done")
    return seconds


def measure(out, *, monomers, steps, repeats, plan, minutes, about, say):
    """Measure and write ``gpu.csv`` and ``gpu_paper.csv``.

    Parameters
    ----------
    out : pathlib.Path
        Folder of the results.
    monomers : list of int
        Numbers of monomers of the aggregates: each is measured alone, and as often as it fits on the device at once.
    steps : int
        Steps of each run.
    repeats : int
        Runs of each case.
    plan : ratd.config.Plan
        All its grains are spun up, as the pipeline does it.
    minutes : float
        No material and type is begun after so long.
    about : dict
        Columns that each row gets.
    say : callable
        Told how far it is.

    Raises
    ------
    InputError
        If there is no device.
    """
    require()
    rows = []
    for kind in TYPES:
        for n in monomers:
            body = engine.turning(grains.grown(kind, n, SEED), TURNING)
            threads = threads_for(body.contacts)
            timed(body, 1, threads, 1)  # compiles
            device = about_device(threads)
            for copies in (1, device["multiprocessors"] * device["blocks_per_multiprocessor"]):
                for repeat in range(repeats):
                    seconds = timed(body, copies, threads, steps)
                    work = steps * copies * body.contacts
                    rows.append(
                        {
                            "type": kind, "monomers": n, "contacts": body.contacts, "threads": threads,
                            "grains": copies, "repeat": repeat, "steps": steps, "seconds": seconds,
                            "us_per_step": seconds / steps * 1e6, "ns_per_contact_step": seconds / work * 1e9,
                            "GB_s": BYTES * work / seconds / 1e9,
                        } | device | about
                    )  # fmt: skip
                say(f"gpu: {kind}, {copies} times {n} monomers: {rows[-1]['ns_per_contact_step']:.3f} ns")
    tables.write(out / "gpu.csv", rows)
    _measure_paper(out, plan, minutes, about, say)


def _measure_paper(out, plan, minutes, about, say):
    """Spin up all grains of a config, one (drive, material, type) after the other."""
    rows = []
    begun = time.monotonic()
    cells = [
        (drive, material, kind)
        for drive in plan.config["drives"]
        for material in plan.config["materials"]
        for kind in plan.config["types"]
    ]
    for drive, material, kind in cells:
        if time.monotonic() - begun > 60.0 * minutes:
            say(f"gpu: {drive} {material} {kind} is left out, the time is up")
            continue
        settings = plan.grow(material, kind, plan.sizes[0])
        many = [
            grow(
                kind, size * NM, plan.materials[material], seed,
                distribution=RadiusDistribution(**settings["radii"]), migration=settings["migration"],
            )
            for size in plan.config["sizes_nm"]
            for seed in plan.seeds
        ]  # fmt: skip
        start = time.perf_counter()
        runs = spin_up_many(many, drive=drive, **plan.spin_up_of(drive, kind))
        seconds = time.perf_counter() - start
        rows.append(
            {
                "drive": drive, "material": material, "type": kind, "grains": len(many),
                "steps": sum(run.attrs["steps"] for run in runs), "seconds": seconds,
            } | about
        )  # fmt: skip
        say(f"gpu: {drive} {material} {kind}, {len(many)} grains in {seconds:.0f} s")
    if rows:
        tables.write(out / "gpu_paper.csv", rows)
