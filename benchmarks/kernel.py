"""Part (a): ns per contact and step, alternately on one core with LAMMPS and with another checkout of ratd.

Aggregates at rest and slowly turning; large ones beside smaller ones; another law, a box; us per step of ten monomers.
"""

from benchmarks import engine, grains, peer, tables

MOTIONS = {"at rest": 0.0, "slowly turning": 0.2}
"""Angular velocity in units of the bound at which the aggregate must break."""
COMBINATIONS = {"JKR, periodic box": engine.boxed, "DMT with friction": engine.other_law}
TYPES = ("BAM2", "BA")
NUMBERS = (3000, 30_000)
"""Monomers of aggregates that are compared by their number."""
SMALL = 10
SEED = 0


def aggregates(n, files):
    """Name -> aggregate to measure: grown ones of both types, or those of the files.

    Parameters
    ----------
    n : int
        Number of monomers of those that are grown.
    files : list of pathlib.Path
    """
    if files:
        return {path.stem: grains.read(path) for path in files}
    return {kind: grains.grown(kind, n, SEED) for kind in TYPES}


def measure(out, *, pairs, steps, monomers, numbers, small_steps, files, program, before, about, say):
    """Measure and write ``kernel.csv``, ``combinations.csv`` and ``small.csv``.

    Parameters
    ----------
    out : pathlib.Path
        Folder of the results.
    pairs : int
        Runs of each code, in alternation.
    steps, small_steps : int
        Steps of each run, and of each run with ten monomers.
    monomers : int
        Monomers of the aggregates that are grown.
    numbers : sequence of int
        Monomers of those that are compared by their number; they make as many updates of contacts, hence fewer steps.
    files : list of pathlib.Path
        Aggregates to read instead.
    program : str or None
        LAMMPS.
    before : benchmarks.before.Before or None
        Another checkout of ratd.
    about : dict
        Columns that each row gets: the machine and the versions.
    say : callable
        Told how far it is.
    """
    rows, others = [], []
    for name, grain in aggregates(monomers, files).items():
        for motion, part in MOTIONS.items():
            peers = [_other_ratd(before, grain, part, steps)] if before else []
            body = engine.turning(grain, part)
            if program:
                peers.append(_lammps(program, grain, body, steps))
            rows += _alternate(name, motion, grain, body, peers, pairs, steps, say)
        for motion, make in COMBINATIONS.items():
            others += _alternate(name, motion, grain, make(grain), [], pairs, steps, say)
    tables.write(out / "kernel.csv", [row | about for row in rows])

    for n in numbers:
        for kind in TYPES:
            grain, fewer = grains.grown(kind, n, SEED), max(100, steps * monomers // n)
            part = MOTIONS["slowly turning"]
            peers = [_other_ratd(before, grain, part, fewer, relaxed=False)] if before else []
            body = engine.turning(grain, part, relaxed=False)
            others += _alternate(f"{kind} of {n}", "slowly turning", grain, body, peers, pairs, fewer, say)
    tables.write(out / "combinations.csv", [row | about for row in others])

    rows = []
    for kind in TYPES:
        grain = grains.grown(kind, SMALL, SEED)
        for motion, part in MOTIONS.items():
            body = engine.turning(grain, part)
            rows += _alternate(kind, motion, grain, body, [], pairs, small_steps, say)
    tables.write(out / "small.csv", [row | about for row in rows])


def _alternate(name, motion, grain, body, peers, pairs, steps, say):
    """Rows of a body of ratd and of its peers, timed by turns, list of dict.

    A peer is its name and a callable that makes one run and gives the version, the number of size classes, the seconds,
    and the contacts before and after.
    """
    body, _ = engine.timed(body, max(1, steps // 10))  # also compiles
    rows = []
    for pair in range(pairs):
        held = body.contacts
        body, seconds = engine.timed(body, steps)
        found = [("ratd", "", 0, seconds, held, body.contacts)] + [(code, *go()) for code, go in peers]
        rows += [_row(name, motion, grain, pair, steps, *timing) for timing in found]
        latest = ", ".join(f"{row['code']} {row['ns_per_contact_step']:.1f}" for row in rows[-len(found) :])
        say(f"kernel: {name} {motion}, pair {pair + 1} of {pairs}: {latest} ns per contact and step")
    return rows


def _other_ratd(before, grain, part, steps, relaxed=True):
    contacts = before.turn(grain, part, relaxed=relaxed)
    before.go_on(max(1, steps // 10))

    def go():
        seconds, now = before.go_on(steps)
        return before.version, 0, seconds, contacts, now

    return "before", go


def _lammps(program, grain, body, steps):
    classes = peer.best_classes(program, grain, timestep=body.timestep, steps=min(steps, peer.TRIAL_STEPS))

    def go():
        timing = peer.run(
            program, grain, omega=body.omega, timestep=body.timestep, steps=steps, warm=steps // 10, classes=classes
        )
        return timing.version, classes, timing.seconds, timing.contacts_before, timing.contacts

    return "LAMMPS", go


def _row(name, motion, grain, pair, steps, code, version, classes, seconds, before, contacts):
    return {
        "aggregate": name,
        "motion": motion,
        "code": code,
        "version": version,
        "size_classes": classes,
        "pair": pair,
        "monomers": grain.n_monomers,
        "contacts_before": before,
        "contacts": contacts,
        "steps": steps,
        "seconds": seconds,
        "us_per_step": seconds / steps * 1e6,
        "ns_per_contact_step": seconds / steps / contacts * 1e9,
    }
